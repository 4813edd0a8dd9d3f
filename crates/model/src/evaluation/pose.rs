//! Evaluation of one design at one pose.

use glam::DVec2;
use nalgebra::Matrix6;

use super::{Constraint, Model, PoseScalar, PoseValues};
use crate::clearance::Clearance;
use crate::dynamics::{DynamicsInputs, DynamicsModel, DynamicsReport, Motion, Response, VibratingBar};
use crate::kinematics::Jacobian;
use crate::lanes::Planar;
use crate::mechanism::{AnyLeg, Design, JointKind, Posture, ReachReason, Shortfall};
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

    /// Returns the lowest natural frequency of the frame of finite elements of a design at a pose \[Hz\]; `None` where the design does not
    /// reach the pose or has none.
    pub(super) fn frame_frequency(&self, design: &Design, pose: &Pose) -> Option<f64> {
        let posed = self.posed(design);
        let [in_plane, out_of_plane] = posed.dynamics_at(pose).ok()??.frame_frequencies()?;
        Some(in_plane.min(out_of_plane))
    }

    /// Gives a prepared design motors of a mass \[kg\] and rotors of an inertia \[kg or kg·m²\] in place of those of the study.
    pub(super) fn set_drive(&self, posed: &mut PosedDesign, mass: f64, inertia: f64) {
        let (settings, joints) = self.driven(posed.actuator(), mass, inertia);
        let stiffness = posed.checker.stiffness.as_ref();
        posed.checker.dynamics =
            stiffness.map(|stiffness| self.dynamics_with(&posed.design, stiffness, &settings, joints));
    }

    /// Prepares `design` for its evaluation at many poses.
    pub fn posed(&self, design: &Design) -> PosedDesign {
        PosedDesign {
            design: *design,
            checker: self.checker_of(design, ScalarSet::all()),
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
        let posture = self.posture(pose)?;
        let jacobian = Jacobian::new(&posture);
        Ok(PoseEvaluation {
            actuators: self.actuators(&posture),
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
        let posture = self.posture(pose)?;
        let (Some(strength), Some(stiffness)) = (&checker.strength, &checker.stiffness) else {
            return Ok(None);
        };
        let strength = wrench.map_or(*strength, |wrench| strength.with_wrench(wrench));
        let arms = posture.arms.map(Planar::from);
        let inputs = checker.strength_inputs(stiffness, pose.position.into(), &arms);
        Ok(strength.report(&inputs))
    }

    /// Returns the motion of the design at `pose`, and what its actuators do during a motion; `None` for an infinitely compliant design
    /// and at a singularity.
    ///
    /// # Errors
    /// The leg that does not reach the pose, and why.
    pub fn dynamics_at(&self, pose: &Pose) -> Result<Option<PosedDynamics<'_>>, Unreachable> {
        let checker = &self.checker;
        let posture = self.posture(pose)?;
        let (Some(dynamics), Some(stiffness)) = (&checker.dynamics, &checker.stiffness) else {
            return Ok(None);
        };
        let arms = posture.arms.map(Planar::from);
        Ok(Some(PosedDynamics {
            dynamics,
            inputs: DynamicsInputs {
                position: pose.position.into(),
                legs: checker.strength_inputs(stiffness, pose.position.into(), &arms),
            },
            pose: *pose,
            legs: &checker.manipulator.legs,
            actuators: self.actuators(&posture),
            posture,
        }))
    }

    /// Solves the inverse kinematics at `pose`.
    fn posture(&self, pose: &Pose) -> Result<Posture, Unreachable> {
        let posture = self.checker.manipulator.posture(pose);
        posture.map_err(|(leg, shortfall)| Unreachable { leg, shortfall })
    }

    /// Returns the kind of the actuators.
    pub fn actuator(&self) -> JointKind {
        self.design.architecture().actuator()
    }

    /// Returns the values of the actuated joints at a posture.
    fn actuators(&self, posture: &Posture) -> [f64; LEGS] {
        let driven = self.design.architecture().driven();
        let legs = &self.checker.manipulator.legs;
        [0, 1, 2].map(|leg| legs[leg].joint_values(&posture.legs[leg])[driven])
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

/// A design at a pose, prepared for its motion.
#[derive(Clone, Copy)]
pub struct PosedDynamics<'a> {
    dynamics: &'a DynamicsModel,
    inputs: DynamicsInputs<f64>,
    pose: Pose,
    legs: &'a [AnyLeg; LEGS],
    actuators: [f64; LEGS],
    posture: Posture,
}

impl PosedDynamics<'_> {
    /// Returns the values of the actuators \[m or rad\].
    pub fn actuators(&self) -> [f64; LEGS] {
        self.actuators
    }

    /// Returns the distance to a joint limit or to the end of reach \[m\].
    pub fn limit_margin(&self) -> f64 {
        self.posture.limit_margin
    }

    /// Returns `A_i`, `B_i` and `C_i` of all legs \[m\].
    pub fn joints(&self) -> impl Iterator<Item = DVec2> {
        let chains = self.posture.legs.iter().map(|leg| &leg.chain);
        chains.flat_map(|chain| [chain.a, chain.b, chain.c])
    }

    /// Returns `det A` \[m\].
    pub fn determinant(&self) -> f64 {
        Jacobian::new(&self.posture).determinant()
    }

    /// Returns what the actuators do during a motion.
    pub fn response(&self, motion: &Motion) -> Response {
        self.dynamics.response(&self.inputs, motion)
    }

    /// Returns how the bars move with the platform in a vibration.
    pub fn vibrating_bars(&self) -> Vec<VibratingBar> {
        self.dynamics.vibrating_bars(&self.inputs)
    }

    /// Returns the lowest natural frequencies of the frame of finite elements, in the plane and out of it \[Hz\]; `None` on rails that
    /// bend, and at a singular pose.
    pub fn frame_frequencies(&self) -> Option<[f64; 2]> {
        self.dynamics.frame_frequencies(&self.inputs)
    }

    /// Returns frequencies, masses, gains and errors; `None` at a singular pose.
    pub fn report(&self) -> Option<DynamicsReport> {
        self.dynamics
            .report(&self.inputs, &self.pose, self.legs, &self.actuators)
    }
}
