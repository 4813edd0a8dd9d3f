//! A design that was made the best one near its start.

use kinefront_model::mechanism::Design;

use super::multipliers::Multipliers;
use super::place::Place;
use super::problem::LocalProblem;
use super::requirement::Critical;

/// A design that is the best near the one that it started from.
#[derive(Debug, Clone)]
pub struct Polished {
    /// The design.
    pub design: Design,
    /// Home orientation \[rad\].
    pub home: f64,
    /// Value of the objective.
    pub objective: f64,
    /// Largest amount by which a requirement is missed at any pose, as a logarithm or a share of `R`.
    pub missed: f64,
    /// Amount by which requirements may be missed, because of rounding or of the slack that is asked for.
    pub(crate) allowed: f64,
    /// Where the requirements are nearest to being missed.
    pub critical: Vec<Critical>,
    /// What the active requirements and bounds cost.
    pub multipliers: Multipliers,
    pub(crate) unknowns: Vec<f64>,
}

impl Polished {
    /// Returns whether the design keeps every requirement; of a slack that is asked for, half is enough.
    pub fn is_feasible(&self) -> bool {
        self.missed <= self.allowed
    }

    /// Returns whether the design is an optimum: it keeps every requirement, and its multipliers explain why it cannot be better.
    pub fn is_optimal(&self) -> bool {
        self.is_feasible() && self.multipliers.explain()
    }
}

impl LocalProblem {
    /// Returns the pose of a place of an optimum: x \[m\], y \[m\] and the orientation \[deg\].
    pub fn pose(&self, polished: &Polished, place: &Place) -> [f64; 3] {
        let Some(prepared) = self.prepare(&polished.unknowns) else {
            return [0.0; 3];
        };
        let (position, _) = prepared.located(place);
        [position.x, position.y, prepared.orientation(place.turn).to_degrees()]
    }
}
