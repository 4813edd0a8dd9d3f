//! Where the best architecture changes along a front: concave kinks of the objective, which the multipliers of one optimum cannot show.

use kinefront_model::evaluation::Evaluation;
use kinefront_model::mechanism::Architecture;
use kinefront_optimize::{Outcome, non_dominated_ranks};
use kinefront_optimum::{Branch, LocalProblem, Meeting};
use rayon::prelude::*;
use serde::Serialize;

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

/// A crossing, as other programs read it.
#[derive(Debug, Clone, Serialize)]
pub struct CrossingJson {
    /// Value of the quantity along the front.
    pub at: f64,
    /// The first objective of both architectures there.
    pub objective: f64,
    /// The architecture that is better below.
    pub below: String,
    /// The architecture that is better above.
    pub above: String,
    /// Price of the quantity along the front below.
    pub price_below: f64,
    /// The same above.
    pub price_above: f64,
}

impl Crossing {
    /// Whether an architecture begins or ends there.
    pub fn is_of(&self, architecture: Architecture) -> bool {
        self.architectures.contains(&architecture)
    }

    /// Returns what other programs read.
    pub fn to_json(self) -> CrossingJson {
        let [below, above] = self.architectures.map(|architecture| architecture.to_string());
        CrossingJson {
            at: self.at,
            objective: self.objective,
            below,
            above,
            price_below: self.prices[0],
            price_above: self.prices[1],
        }
    }
}

impl DesignProblem {
    /// Determines where one architecture takes over from another along a front of two objectives, given designs with their places, of which
    /// some may be dominated by a design of another architecture. Of more objectives, two neighbours differ in all, so that there is no such
    /// place.
    pub(super) fn crossings(&self, mut designs: Vec<(f64, &Evaluation)>) -> Vec<Crossing> {
        if self.model().settings().objectives.len() != 2 {
            return Vec::new();
        }
        let outcomes: Vec<Outcome> = designs
            .iter()
            .map(|(_, evaluation)| Self::outcome(evaluation))
            .collect();
        let mut ranks = non_dominated_ranks(&outcomes).into_iter();
        designs.retain(|_| ranks.next() == Some(0));
        designs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let changes: Vec<[&Evaluation; 2]> = designs
            .windows(2)
            .map(|pair| [pair[0].1, pair[1].1])
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
            let problem: &LocalProblem = &locals[place].problem;
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
