//! Evaluation of one design at one pose.

use nalgebra::Matrix6;

use super::{Constraint, Model, PoseScalar, PoseValues};
use crate::clearance::Clearance;
use crate::kinematics::Jacobian;
use crate::lanes::Planar;
use crate::mechanism::{AnyLeg, Design, ReachReason, Shortfall};
use crate::pose::{PoseChecker, ScalarSet};
use crate::spatial::{LEGS, Pose};
use crate::strength::StrengthReport;

/// Values of a design at a reachable pose.
#[derive(Debug, Clone)]
pub struct PoseEvaluation {
    /// Actuator values \[m or rad\].
    pub actuators: [f64; LEGS],
    /// `B_i` in the base frame \[m\]; `A_i` for a telescopic leg.
    pub b: [[f64; 2]; LEGS],
    /// `C_i` in the base frame \[m\].
    pub c: [[f64; 2]; LEGS],
    /// All scalars.
    pub values: PoseValues,
    /// The nearest pair of members that are not joined.
    pub nearest: Clearance,
    /// Stiffness matrix `K` at `P` in base axes, linear components first.
    pub stiffness: Matrix6<f64>,
}

/// Reason why a pose is unreachable, displayed as a message.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("leg {}: {}", .leg + 1, words(.shortfall))]
pub struct Unreachable {
    /// Index of the leg, from 0.
    pub leg: usize,
    /// Distance by which the leg fails to reach the pose, and the reason.
    pub shortfall: Shortfall,
}

fn words(shortfall: &Shortfall) -> String {
    let distance = -shortfall.limit_margin;
    match shortfall.reason {
        ReachReason::OutOfReach => format!("out of reach by {distance:.6} m"),
        ReachReason::BelowLimit => format!("prismatic joint {distance:.6} m below its lower limit"),
        ReachReason::AboveLimit => format!("prismatic joint {distance:.6} m above its upper limit"),
        ReachReason::Degenerate => "two of its joints coincide, or its guides are parallel".to_owned(),
    }
}

impl Model {
    /// Returns the margin of the limit of a scalar at a pose, in doubles; at a pose that is not reached, it is the shortfall of the
    /// leg. The margin of `det A` is the absolute value; without a limit, the limit is 0.
    pub fn margin_at(&self, design: &Design, pose: &Pose, scalar: PoseScalar) -> f64 {
        let posed = self.posed(design);
        match posed.at(pose) {
            Err(unreachable) => PoseScalar::Reach.margin(unreachable.shortfall.limit_margin, 0.0, design),
            Ok(found) => posed.margin(&found, scalar),
        }
    }

    /// Evaluates `design` at `pose`.
    ///
    /// # Errors
    /// The leg that does not reach the pose, and why.
    pub fn pose(&self, design: &Design, pose: &Pose) -> Result<PoseEvaluation, Unreachable> {
        self.posed(design).at(pose)
    }

    /// Prepares `design` for its evaluation at many poses.
    pub fn posed(&self, design: &Design) -> PosedDesign {
        PosedDesign {
            design: *design,
            checker: self.complete_checker(design),
        }
    }
}

/// A design that is prepared for its evaluation at many poses: what does not depend on the pose is computed once.
#[derive(Debug)]
pub struct PosedDesign {
    design: Design,
    checker: PoseChecker<AnyLeg>,
}

impl PosedDesign {
    /// Evaluates the design at `pose`.
    ///
    /// # Errors
    /// The leg that does not reach the pose, and why.
    pub fn at(&self, pose: &Pose) -> Result<PoseEvaluation, Unreachable> {
        let checker = &self.checker;
        let driven = self.design.architecture().driven();
        let posture = checker
            .manipulator
            .posture(pose)
            .map_err(|(leg, shortfall)| Unreachable { leg, shortfall })?;
        let jacobian = Jacobian::new(&posture);
        Ok(PoseEvaluation {
            actuators: [0, 1, 2].map(|i| checker.manipulator.legs[i].joint_values(&posture.legs[i])[driven]),
            b: posture.legs.map(|leg| leg.chain.b.to_array()),
            c: posture.arms.map(|arm| (pose.position + arm).to_array()),
            values: checker.values_at(pose.position, &posture, &jacobian, ScalarSet::all()),
            nearest: checker.nearest(pose.position, &posture),
            stiffness: checker.stiffness_at(&posture, &jacobian).matrix(),
        })
    }

    /// Returns the strength of the design at `pose`, under a single wrench instead of the loads of the study if one is given; `None` for
    /// an infinitely compliant design and at a singularity.
    ///
    /// # Errors
    /// The leg that does not reach the pose, and why.
    pub fn strength_at(&self, pose: &Pose, wrench: Option<[f64; 6]>) -> Result<Option<StrengthReport>, Unreachable> {
        let checker = &self.checker;
        let posture = checker
            .manipulator
            .posture(pose)
            .map_err(|(leg, shortfall)| Unreachable { leg, shortfall })?;
        let (Some(strength), Some(stiffness)) = (&checker.strength, &checker.stiffness) else {
            return Ok(None);
        };
        let strength = wrench.map_or(*strength, |wrench| strength.with_wrench(wrench));
        let arms = posture.arms.map(Planar::from);
        let inputs = checker.strength_inputs(stiffness, pose.position.into(), &arms);
        Ok(strength.report(&inputs))
    }

    /// Returns the margins of all constraints at a pose that is reached, in the order of [`Constraint::ALL`]; that of `det_sign` is
    /// the absolute value.
    pub fn margins(&self, found: &PoseEvaluation) -> [f64; Constraint::COUNT] {
        Constraint::ALL.map(|constraint| match constraint.scalar() {
            None => {
                let assembly = &self.checker.assembly;
                constraint.margin(assembly.value, assembly.threshold, &self.design)
            }
            Some(scalar) => self.margin(found, scalar),
        })
    }

    /// Returns the margin of the limit of a scalar at a pose that is reached; without a limit, the limit is 0.
    fn margin(&self, found: &PoseEvaluation, scalar: PoseScalar) -> f64 {
        let value = match scalar {
            PoseScalar::Determinant => found.values[scalar].abs(),
            _ => found.values[scalar],
        };
        let limit = self.checker.thresholds.get(scalar).unwrap_or(0.0);
        scalar.margin(value, limit, &self.design)
    }
}
