//! The scalars of one design at poses, whatever its legs are.

use glam::DVec2;

use super::ValueColumns;
use crate::kinematics::Jacobian;
use crate::lanes::{InstructionSet, Planar};
use crate::mechanism::{Leg, ReachReason};
use crate::pose::{PoseChecker, PoseScalar, PoseScalars, PoseValues, ScalarSet, Thresholds};
use crate::spatial::{LEGS, NUMBER_LIMIT, Rotation};

/// One design, prepared for evaluation at many poses, whatever its legs are.
///
/// The loops over poses are compiled for every type of legs and every instruction set once, in this crate; all others use them
/// through this trait. A position that a leg does not reach has no values but its limit margin \[m\], which is at most 0.
pub trait PoseEvaluator: Sync {
    /// Returns `C_i − P` in base axes \[m\] at the platform orientation `rotation`.
    fn arms(&self, rotation: &Rotation) -> [DVec2; LEGS];

    /// Returns the limits of the scalars.
    fn thresholds(&self) -> &Thresholds;

    /// Computes a scalar besides those that every evaluation determines and those that are limited.
    fn ask_for(&mut self, scalar: PoseScalar);

    /// Leaves the base out of the footprint, for methods that follow each of the two where both reach equally far.
    fn leave_out_base(&mut self);

    /// Selects an instruction set, which changes no bit of a result.
    fn use_instructions(&mut self, instructions: InstructionSet);

    /// Computes the values at many positions \[m\] in the orientation of `arms`. The columns have equal lengths, a multiple of
    /// [`MAX_LANES`](crate::lanes::MAX_LANES).
    fn evaluate_positions(&self, arms: &[DVec2; LEGS], xs: &[f64], ys: &[f64], values: &mut ValueColumns);

    /// Returns the values at one position \[m\], which are those of [`PoseEvaluator::evaluate_positions`] to the bit.
    ///
    /// # Errors
    /// The limit margin of a position that is not reached.
    fn evaluate_position(&self, arms: &[DVec2; LEGS], position: DVec2) -> Result<PoseValues, f64>;

    /// Returns the values at one position \[m\], also where joints are beyond their limits: functions that continue there, for methods
    /// that approach the limits from both sides. Those of `set` are computed besides those that every evaluation determines, and any
    /// other value has no meaning; where the inverse kinematics has no solution, the determinant is not a number, and the distance from
    /// the limits alone has a meaning.
    fn evaluate_beyond_limits(&self, arms: &[DVec2; LEGS], position: DVec2, set: ScalarSet) -> PoseScalars<f64>;

    /// Returns the values at one position \[m\] by the closed form as it is defined, with which the others are compared.
    ///
    /// # Errors
    /// The limit margin of a position that is not reached.
    fn evaluate_plainly(&self, arms: &[DVec2; LEGS], position: DVec2) -> Result<PoseValues, f64>;

    /// Returns the sign of `det A` at a position \[m\] by the closed form as it is defined, if the pose is feasible in every other
    /// respect.
    fn feasible_sign(&self, arms: &[DVec2; LEGS], position: DVec2) -> Option<f64>;

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

    fn thresholds(&self) -> &Thresholds {
        &self.thresholds
    }

    fn ask_for(&mut self, scalar: PoseScalar) {
        PoseChecker::ask_for(self, scalar);
    }

    fn leave_out_base(&mut self) {
        self.leaves_out_base = true;
    }

    fn use_instructions(&mut self, instructions: InstructionSet) {
        self.instructions = instructions;
    }

    fn evaluate_positions(&self, arms: &[DVec2; LEGS], xs: &[f64], ys: &[f64], values: &mut ValueColumns) {
        self.at_positions(arms, xs, ys, values);
    }

    #[expect(
        clippy::manual_clamp,
        reason = "a margin that is not a number becomes the largest shortfall"
    )]
    fn evaluate_position(&self, arms: &[DVec2; LEGS], position: DVec2) -> Result<PoseValues, f64> {
        let computed = self.computed;
        let found = self.lanes(position.into(), &arms.map(Planar::from), computed);
        if found.reachable {
            Ok(PoseValues::new(|scalar| found.scalars[scalar], computed))
        } else {
            Err(found.scalars[PoseScalar::Reach].max(-NUMBER_LIMIT).min(0.0))
        }
    }

    fn evaluate_beyond_limits(&self, arms: &[DVec2; LEGS], position: DVec2, set: ScalarSet) -> PoseScalars<f64> {
        self.lanes(position.into(), &arms.map(Planar::from), set).scalars
    }

    fn evaluate_plainly(&self, arms: &[DVec2; LEGS], position: DVec2) -> Result<PoseValues, f64> {
        let posture = self.manipulator.posture_at(position, arms);
        let posture = posture.map_err(|(_, shortfall)| shortfall.limit_margin)?;
        Ok(self.values_at(position, &posture, &Jacobian::new(&posture), self.computed))
    }

    fn feasible_sign(&self, arms: &[DVec2; LEGS], position: DVec2) -> Option<f64> {
        PoseChecker::feasible_sign(self, position, arms)
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
