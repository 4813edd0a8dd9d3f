//! Sensitivity to assumptions at designs of the fronts: each is optimized again near itself under every alternative assumption.

use kinefront_model::evaluation::{Evaluation, Quantity};
use kinefront_model::mechanism::Architecture;
use kinefront_study::sensitivity::{self, Alternative, Effect};
use kinefront_study::{DesignProblem, Study};
use rayon::prelude::*;

use super::{Front, Fronts, ReportError};

/// Largest number of designs of a front.
const DESIGNS: usize = 3;

/// Relative difference up to which an optimum is the same.
const SAME: f64 = 1e-7;

/// What alternative assumptions change at designs of the front of an architecture.
#[derive(Debug, Clone)]
pub struct Nearby {
    /// The architecture.
    pub architecture: Architecture,
    /// The designs near which there is an optimum.
    pub designs: Vec<Evaluation>,
    /// The first objective of the optimum near each under the study as given.
    pub stated: Vec<f64>,
    /// The same under each alternative, with the other objectives held; `None` where there is no optimum near.
    pub changed: Vec<(Alternative, Vec<Option<f64>>)>,
    optima: Vec<Optimum>,
}

/// An optimum near a design of a front, under the study as given.
#[derive(Debug, Clone)]
struct Optimum {
    /// The evaluation of the design, with the optimum in its place.
    at: Evaluation,
    /// Values of the objectives after the first one.
    held: Vec<(Quantity, f64)>,
    value: f64,
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
    tell("sensitivity: the study as given");
    let mut all: Vec<Nearby> = fronts
        .alone
        .iter()
        .map(|(architecture, front)| Nearby::new(*architecture, problem, front))
        .filter(|nearby| !nearby.designs.is_empty())
        .collect();
    for (alternative, changed) in sensitivity::studies(study, study.optimizer.evaluations) {
        let Some(alternative) = alternative.filter(|alternative| alternative.effect == Effect::Evaluation) else {
            continue;
        };
        tell(&format!("sensitivity: {}", alternative.name));
        let changed = DesignProblem::new(&changed)?;
        for nearby in &mut all {
            let found: Vec<Option<f64>> = nearby
                .optima
                .par_iter()
                .map(|optimum| optimum.under(&changed))
                .collect();
            let differs =
                |(found, stated): (&Option<f64>, &f64)| found.is_none_or(|found| (found / stated - 1.0).abs() > SAME);
            // An alternative may concern other architectures alone.
            if found.iter().zip(&nearby.stated).any(differs) {
                nearby.changed.push((alternative, found));
            }
        }
    }
    Ok(all)
}

impl Nearby {
    /// Finds the optima near designs of a front that are evenly spread.
    fn new(architecture: Architecture, problem: &DesignProblem, front: &Front) -> Self {
        let found: Vec<(Evaluation, Optimum)> = front
            .spread(DESIGNS)
            .into_par_iter()
            .filter_map(|design| Optimum::near(problem, &design).map(|optimum| (design, optimum)))
            .collect();
        let (designs, optima): (Vec<Evaluation>, Vec<Optimum>) = found.into_iter().unzip();
        Self {
            architecture,
            designs,
            stated: optima.iter().map(|optimum| optimum.value).collect(),
            changed: Vec::new(),
            optima,
        }
    }
}

impl Optimum {
    fn near(problem: &DesignProblem, design: &Evaluation) -> Option<Self> {
        let objectives = &problem.model().settings().objectives;
        let values = objectives.iter().zip(&design.objectives).skip(1);
        let held: Vec<(Quantity, f64)> = values
            .map(|(objective, value)| (objective.quantity, objective.value(*value)))
            .collect();
        let best = problem.local_of(design, &held).ok()?.optimum()?;
        Some(Self {
            at: Evaluation {
                design: best.design,
                home_phi_deg: Some(best.home.to_degrees()),
                ..design.clone()
            },
            held,
            value: best.objective,
        })
    }

    /// Returns the first objective of the optimum near this one under another problem.
    fn under(&self, problem: &DesignProblem) -> Option<f64> {
        let found = problem.local_of(&self.at, &self.held).ok()?.optimum()?;
        Some(found.objective)
    }
}
