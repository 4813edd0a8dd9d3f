//! Where the best kind of design changes along a front: concave kinks of the objective, which the multipliers of one optimum cannot show.

use kinefront_model::evaluation::Evaluation;
use kinefront_model::mechanism::{Architecture, DESIGN_VARIABLES, Design, DesignVariable};
use kinefront_optimize::{Outcome, non_dominated_ranks};
use kinefront_optimum::{Branch, Meeting, Polished};
use rayon::prelude::*;
use serde::Serialize;

use super::LocalDesign;
use crate::DesignProblem;

/// Home orientations that differ by less than this are one \[°\].
const SAME_HOME_DEG: f64 = 0.1;

/// Largest change of the logarithms of lengths and of angles \[rad\] between neighbours of one family at the same place of the front.
const ALIKE: f64 = 0.02;

/// What is added to it for each unit of the logarithm of the quantity along the front.
const STEEP: f64 = 3.0;

/// A design of a front with the optimum near it.
pub(super) struct Placed<'a> {
    /// Its value of the quantity along the front.
    pub at: f64,
    pub evaluation: &'a Evaluation,
    pub local: LocalDesign,
    pub optimum: Polished,
}

impl Placed<'_> {
    /// Returns whether the optimum of another design is of another architecture, or differs by more than optima of one family do, whose
    /// lengths grow about as the quantity along the front does.
    fn is_of_another_family(&self, other: &Placed<'_>) -> bool {
        let [own, others] = [self, other].map(|placed| placed.optimum.design);
        let change = |variable: &DesignVariable| match variable.is_angle() {
            true => (own.value(*variable) - others.value(*variable)).to_radians().abs(),
            false => libm::log(own.value(*variable) / others.value(*variable)).abs(),
        };
        let variables = DESIGN_VARIABLES.iter().chain(own.architecture().further_variables());
        let turn = libm::remainder(self.optimum.home - other.optimum.home, std::f64::consts::TAU).abs();
        let largest = variables.map(change).fold(turn, f64::max);
        own.architecture() != others.architecture() || largest > ALIKE + STEEP * libm::log(self.at / other.at).abs()
    }
}

/// A place of a front at which designs of another architecture, or of another family of the same architecture, become the better ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Value of the quantity along the front.
    pub at: f64,
    /// The first objective, which both designs have there.
    pub objective: f64,
    /// The design that is better below, and the one that is better above, at that place.
    pub designs: [Design; 2],
    /// Their home orientations \[°\].
    pub homes_deg: [f64; 2],
    /// Price of the quantity along the front below and above \[% for 1 %\].
    pub prices: [f64; 2],
}

/// A crossing, as other programs read it.
#[derive(Debug, Clone, Serialize)]
pub struct CrossingJson {
    /// Value of the quantity along the front.
    pub at: f64,
    /// The first objective of both designs there.
    pub objective: f64,
    /// The architecture that is better below.
    pub below: String,
    /// The architecture that is better above.
    pub above: String,
    /// Price of the quantity along the front below.
    pub price_below: f64,
    /// The same above.
    pub price_above: f64,
    /// The design that is better below.
    pub design_below: String,
    /// The design that is better above.
    pub design_above: String,
    /// Home orientation of the design that is better below \[°\].
    pub home_phi_below_deg: f64,
    /// The same above \[°\].
    pub home_phi_above_deg: f64,
}

impl Crossing {
    /// Returns the architecture that is better below and the one that is better above.
    fn architectures(&self) -> [Architecture; 2] {
        self.designs.map(|design| design.architecture())
    }

    /// Whether an architecture, or one of its families, begins or ends there.
    pub fn is_of(&self, architecture: Architecture) -> bool {
        self.architectures().contains(&architecture)
    }

    /// Returns which design takes over from which, as the beginning of a sentence.
    pub(super) fn change(&self) -> String {
        let [before, after] = self.architectures();
        if before != after {
            return format!("The {after} takes over from the {before}");
        }
        format!("Another family of the {after} ({}) takes over", self.difference())
    }

    /// Returns how the two designs differ, for a person: the home orientation if it differs, otherwise the dimension that differs most.
    fn difference(&self) -> String {
        let [below, above] = self.homes_deg;
        if libm::remainder(above - below, 360.0).abs() >= SAME_HOME_DEG {
            return format!("home orientation {above:.2}° instead of {below:.2}°");
        }
        let change = |variable: DesignVariable| {
            let [below, above] = self.designs.map(|design| design.value(variable));
            (above - below).abs() / above.abs().max(below.abs()).max(f64::MIN_POSITIVE)
        };
        let further = self.designs[0].architecture().further_variables().iter().copied();
        let variables = DESIGN_VARIABLES.into_iter().chain(further);
        let most = variables.max_by(|a, b| change(*a).total_cmp(&change(*b)));
        most.map_or_else(String::new, |most| {
            let [below, above] = self.designs.map(|design| design.value(most));
            format!("{} {above:.4} {} instead of {below:.4}", most.symbol(), most.unit())
        })
    }

    /// Returns what other programs read.
    pub fn to_json(self) -> CrossingJson {
        let [below, above] = self.architectures().map(|architecture| architecture.to_string());
        let [design_below, design_above] = self.designs.map(|design| design.to_string());
        CrossingJson {
            at: self.at,
            objective: self.objective,
            below,
            above,
            price_below: self.prices[0],
            price_above: self.prices[1],
            design_below,
            design_above,
            home_phi_below_deg: self.homes_deg[0],
            home_phi_above_deg: self.homes_deg[1],
        }
    }
}

impl DesignProblem {
    /// Determines where one architecture, or one family of designs, takes over from another along a front of two objectives, given designs
    /// of which some may be dominated by a design of another architecture. Of more objectives, two neighbours differ in all, so that there
    /// is no such place.
    pub(super) fn crossings(&self, mut designs: Vec<&Placed<'_>>) -> Vec<Crossing> {
        if self.model().settings().objectives.len() != 2 {
            return Vec::new();
        }
        let outcomes: Vec<Outcome> = designs.iter().map(|placed| Self::outcome(placed.evaluation)).collect();
        let mut ranks = non_dominated_ranks(&outcomes).into_iter();
        designs.retain(|_| ranks.next() == Some(0));
        designs.sort_by(|a, b| a.at.total_cmp(&b.at));
        let neighbours: Vec<[&Placed<'_>; 2]> = designs
            .windows(2)
            .map(|pair| [pair[0], pair[1]])
            .filter(|[before, after]| before.is_of_another_family(after))
            .collect();
        let crossing = |neighbours: &[&Placed<'_>; 2]| self.crossing(*neighbours);
        neighbours.par_iter().filter_map(crossing).collect()
    }

    /// Determines where the kind of one design takes over from that of another.
    fn crossing(&self, placed: [&Placed<'_>; 2]) -> Option<Crossing> {
        let along = self.model().settings().objectives.get(1)?.quantity;
        let branch = |place: usize| {
            let Placed { local, optimum, .. } = placed[place];
            Some(Branch {
                problem: &local.problem,
                optimum,
                parameter: local.problem.parameter_of(along)?,
            })
        };
        let meeting = Meeting::of([branch(0)?, branch(1)?])?;
        Some(Crossing {
            at: meeting.at,
            objective: meeting.objective,
            designs: meeting.designs,
            homes_deg: meeting.homes.map(f64::to_degrees),
            prices: meeting.prices,
        })
    }
}
