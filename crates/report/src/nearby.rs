//! Sensitivity to assumptions at designs of the fronts: each is optimized again near itself under every alternative assumption.

use kinefront_model::evaluation::{Evaluation, Quantity};
use kinefront_model::mechanism::Architecture;
use kinefront_optimize::{Objectives, spread};
use kinefront_study::sensitivity::{self, Alternative, Effect};
use kinefront_study::{DesignProblem, Study};
use rayon::prelude::*;

use super::{Front, Fronts, ReportError};

/// Largest number of designs of a front.
const DESIGNS: usize = 5;

/// What alternative assumptions change at designs of the front of an architecture.
#[derive(Debug, Clone)]
pub struct Nearby {
    /// The architecture.
    pub architecture: Architecture,
    /// The designs.
    pub designs: Vec<Evaluation>,
    /// The first objective of the best design near each under the study as given; `None` if none was found.
    pub stated: Vec<Option<f64>>,
    /// The same under each alternative, with the other objectives held.
    pub changed: Vec<(Alternative, Vec<Option<f64>>)>,
}

/// Optimizes designs of each front again under every alternative assumption that changes the evaluation of a design.
///
/// # Errors
/// [`ReportError`] if a grid does not fit an alternative study.
pub(super) fn all(
    study: &Study,
    problem: &DesignProblem,
    fronts: &Fronts,
    tell: &mut dyn FnMut(&str),
) -> Result<Vec<Nearby>, ReportError> {
    let mut all: Vec<Nearby> = fronts
        .alone
        .iter()
        .map(|(architecture, front)| {
            let designs = chosen(front);
            Nearby {
                architecture: *architecture,
                stated: best_near(problem, problem, &designs),
                designs,
                changed: Vec::new(),
            }
        })
        .collect();
    let studies = sensitivity::studies(study, study.optimizer.evaluations);
    for (alternative, changed) in studies {
        let Some(alternative) = alternative.filter(|alternative| alternative.effect == Effect::Evaluation) else {
            continue;
        };
        tell(&format!("sensitivity: {}", alternative.name));
        let changed = DesignProblem::new(&changed)?;
        for nearby in &mut all {
            let found = best_near(&changed, problem, &nearby.designs);
            nearby.changed.push((alternative, found));
        }
    }
    // An alternative may concern other architectures alone.
    for nearby in &mut all {
        let stated = nearby.stated.clone();
        nearby.changed.retain(|(_, found)| *found != stated);
    }
    all.retain(|nearby| nearby.stated.iter().any(Option::is_some));
    Ok(all)
}

/// Returns designs of a front that are evenly spread.
fn chosen(front: &Front) -> Vec<Evaluation> {
    let objectives: Vec<Objectives> = front
        .shown()
        .map(|member| DesignProblem::outcome(member).objectives)
        .collect();
    let mut places = spread(&objectives, DESIGNS);
    places.sort_unstable();
    places.into_iter().map(|place| front.shown[place].clone()).collect()
}

/// Returns the first objective of the best design near each of some, under a problem; the other objectives are held at the values that
/// the designs have under the problem `of`.
fn best_near(problem: &DesignProblem, of: &DesignProblem, designs: &[Evaluation]) -> Vec<Option<f64>> {
    let objectives = &of.model().settings().objectives;
    let best = |evaluation: &Evaluation| {
        let held = objectives.iter().zip(&evaluation.objectives).skip(1);
        let held: Vec<(Quantity, f64)> = held
            .map(|(objective, value)| (objective.quantity, objective.value(*value)))
            .collect();
        let best = problem.local_of(evaluation, &held).ok()?.best().ok()?;
        best.is_optimal().then_some(best.objective)
    };
    designs.par_iter().map(best).collect()
}
