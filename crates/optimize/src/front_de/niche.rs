//! The niches: one population for each combination of the categorical variables.

use super::Success;
use super::learner::Learner;
use crate::dominance::order;
use crate::population::{PopulationMember, ranked};
use crate::selection::{scaled, squared_distance};
use crate::{Evaluated, Objectives};

/// Candidates of one combination of the categorical variables.
#[derive(Debug, Clone)]
pub struct Niche {
    /// Values of the categorical variables, in the order of the variables.
    pub categories: Vec<f64>,
    /// Members in the order of the front: feasible members by the first objective, then infeasible ones by violation.
    pub population: Vec<PopulationMember>,
    /// With three objectives, the members that are nearest to each member, itself first; otherwise empty.
    pub nearest: Vec<Vec<usize>>,
    pub evaluated: usize,
    pub success: Success,
    /// What the niche has learned, if the problem completes its candidates.
    pub learner: Option<Learner>,
}

impl Niche {
    /// Starts the population of a combination of the categorical variables.
    pub fn new(categories: Vec<f64>) -> Self {
        Self {
            categories,
            population: Vec::new(),
            nearest: Vec::new(),
            evaluated: 0,
            success: Success::UNKNOWN,
            learner: None,
        }
    }

    /// Whether there are three objectives, as far as the population shows.
    pub fn is_on_surface(&self) -> bool {
        !self.nearest.is_empty()
    }

    /// Whether the niche has learned enough to propose candidates.
    pub fn can_propose(&self) -> bool {
        self.learner.as_ref().is_some_and(Learner::can_propose)
    }
}

/// Returns the `count` members that are nearest to each member in three objectives; nothing for fewer objectives.
pub fn nearest(population: &[PopulationMember], count: usize) -> Vec<Vec<usize>> {
    let objectives: Vec<Objectives> = population
        .iter()
        .map(|member| member.candidate.outcome.objectives)
        .collect();
    if objectives.first().is_none_or(|first| first.len() < 3) {
        return Vec::new();
    }
    let points = scaled(&objectives);
    let of = |point: &Vec<f64>| {
        let mut order: Vec<(f64, usize)> = points
            .iter()
            .map(|other| squared_distance(point, other))
            .zip(0..)
            .collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        order.into_iter().take(count).map(|(_, place)| place).collect()
    };
    points.iter().map(of).collect()
}

/// Ranks the candidates and sorts them along the front: feasible ones by the first objective, then infeasible ones by
/// violation.
pub fn along_front(candidates: Vec<Evaluated>) -> Vec<PopulationMember> {
    let mut members = ranked(candidates);
    members.sort_by(|a, b| order(&a.candidate.outcome, &b.candidate.outcome));
    members
}
