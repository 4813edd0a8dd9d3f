//! Where the best architecture changes along a front: concave kinks of the objective, which the multipliers of one optimum cannot show.

use kinefront_model::evaluation::Evaluation;
use kinefront_model::mechanism::Architecture;
use kinefront_optimum::{Branch, Meeting};
use rayon::prelude::*;

use super::along::DriversAlong;
use crate::DesignProblem;

/// A place of a front at which another architecture becomes the better one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Value of the quantity along the front.
    pub at: f64,
    /// The first objective, which both architectures have there.
    pub objective: f64,
    /// The architecture that is better below, and that above.
    pub architectures: [Architecture; 2],
    /// Price of the quantity along the front below and above \[% for 1 %\].
    pub prices: [f64; 2],
}

impl Crossing {
    /// Whether an architecture begins or ends there.
    pub fn is_of(&self, architecture: Architecture) -> bool {
        self.architectures.contains(&architecture)
    }
}

impl DesignProblem {
    /// Determines where one architecture takes over from another along a front of two objectives, given its designs with prices. Of more
    /// objectives, two neighbours differ in all, so that there is no such place.
    pub(super) fn crossings(&self, evaluations: &[Evaluation], fronts: &[DriversAlong]) -> Vec<Crossing> {
        if self.model().settings().objectives.len() != 2 {
            return Vec::new();
        }
        let places = fronts.iter().flat_map(|front| &front.designs);
        let mut places: Vec<(f64, usize)> = places.map(|(index, at, _)| (*at, *index)).collect();
        places.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let changes: Vec<[&Evaluation; 2]> = places
            .windows(2)
            .map(|pair| [&evaluations[pair[0].1], &evaluations[pair[1].1]])
            .filter(|[before, after]| before.design.architecture() != after.design.architecture())
            .collect();
        changes.par_iter().filter_map(|change| self.crossing(*change)).collect()
    }

    /// Determines where the architecture of one design takes over from that of another.
    fn crossing(&self, designs: [&Evaluation; 2]) -> Option<Crossing> {
        let along = self.model().settings().objectives.get(1)?.quantity;
        let [before, after] = designs.map(|evaluation| self.local_of(evaluation, &[]).ok());
        let locals = [before?, after?];
        let optima = [locals[0].optimum()?, locals[1].optimum()?];
        let branch = |place: usize| {
            let problem: &kinefront_optimum::LocalProblem = &locals[place].problem;
            Some(Branch {
                problem,
                optimum: &optima[place],
                parameter: problem.parameter_of(along)?,
            })
        };
        let meeting = Meeting::of([branch(0)?, branch(1)?])?;
        Some(Crossing {
            at: meeting.at,
            objective: meeting.objective,
            architectures: designs.map(|evaluation| evaluation.design.architecture()),
            prices: meeting.prices,
        })
    }
}
