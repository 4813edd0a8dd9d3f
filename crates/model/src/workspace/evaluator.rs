//! The values of one design at poses, for callers that are not written over the type of its legs.

use glam::DVec2;

use super::{PoseChecker, PoseValues, ValueColumns};
use crate::lanes::Planar;
use crate::mechanism::{Leg, ReachReason};
use crate::spatial::{LEGS, Rotation};

/// Computes the values of one design at poses, whatever its legs are.
///
/// A [`PoseChecker`] does the same for callers that know the type of the legs. Its loops are compiled once more, for every type and
/// every instruction set, in each crate that calls them; through this trait, all crates share those of this one.
pub trait PoseEvaluator: Sync {
    /// Returns `C_i − P` in base axes \[m\] at the platform orientation `rotation`.
    fn arms(&self, rotation: &Rotation) -> [DVec2; LEGS];

    /// Computes the values at many positions \[m\] in the orientation of `arms`. The columns have equal lengths, a multiple of
    /// [`MAX_LANES`](crate::lanes::MAX_LANES).
    fn evaluate_positions(&self, arms: &[DVec2; LEGS], xs: &[f64], ys: &[f64], values: &mut ValueColumns);

    /// Returns the values at one position \[m\], which are those of [`PoseEvaluator::evaluate_positions`] to the bit; `None` if a
    /// leg does not reach it.
    fn evaluate_position(&self, arms: &[DVec2; LEGS], position: DVec2) -> Option<PoseValues>;

    /// Returns whether every leg reaches a position \[m\].
    fn reaches(&self, arms: &[DVec2; LEGS], position: DVec2) -> bool;

    /// Returns why a position \[m\] is unreachable; one within rounding of the edge of reach may have no reason.
    fn reason(&self, arms: &[DVec2; LEGS], position: DVec2) -> Option<ReachReason>;

    /// Returns the lower and upper corner of a box that contains every reachable position \[m\]; `None` if there is none.
    fn reach_box(&self, arms: &[DVec2; LEGS]) -> Option<[DVec2; 2]>;
}

impl<L: Leg> PoseEvaluator for PoseChecker<L> {
    fn arms(&self, rotation: &Rotation) -> [DVec2; LEGS] {
        self.manipulator.arms(rotation)
    }

    fn evaluate_positions(&self, arms: &[DVec2; LEGS], xs: &[f64], ys: &[f64], values: &mut ValueColumns) {
        self.at_positions(arms, xs, ys, values);
    }

    fn evaluate_position(&self, arms: &[DVec2; LEGS], position: DVec2) -> Option<PoseValues> {
        self.lanes(position.into(), &arms.map(Planar::from)).reached()
    }

    fn reaches(&self, arms: &[DVec2; LEGS], position: DVec2) -> bool {
        let legs = self.leg_lanes(position.into(), &arms.map(Planar::from));
        legs.iter().all(|leg| leg.chain.reachable)
    }

    fn reason(&self, arms: &[DVec2; LEGS], position: DVec2) -> Option<ReachReason> {
        let posture = self.manipulator.posture_at(position, arms);
        posture.err().map(|(_, shortfall)| shortfall.reason)
    }

    fn reach_box(&self, arms: &[DVec2; LEGS]) -> Option<[DVec2; 2]> {
        let boxes = self.manipulator.legs.iter().zip(arms).map(|(leg, arm)| {
            let [low, high] = leg.reach_box();
            [low - *arm, high - *arm]
        });
        let [low, high] = boxes.reduce(|[a, b], [c, d]| [a.max(c), b.min(d)])?;
        (low.x < high.x && low.y < high.y).then_some([low, high])
    }
}
