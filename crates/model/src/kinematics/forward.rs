//! Forward kinematics: actuator values to the pose on the assembly branch of a starting pose.

use nalgebra::Vector3;

use super::Jacobian;
use crate::mechanism::{Leg, Manipulator};
use crate::spatial::{LEGS, Pose};

/// Why no pose was found.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ForwardError {
    /// An iterate left the reach of a leg.
    #[error("leg {} cannot follow: the actuator values lie outside the reach of this assembly mode", .leg + 1)]
    Unreachable {
        /// Index of the leg, from 0.
        leg: usize,
    },
    /// `det A` vanished on the way.
    #[error("the iteration met a parallel singularity")]
    Singular,
    /// No convergence.
    #[error("no convergence after {0} iterations")]
    NoConvergence(usize),
}

/// The pose with actuator values `target` (m or rad) that Newton's method reaches from `start`.
///
/// The iteration solves `A Δt = B Δq`; it stops when no actuator value is off by more than `tolerance` (m or rad).
/// A parallel manipulator has up to six assembly modes: `start` chooses the one.
///
/// # Errors
/// [`ForwardError`] when an iterate cannot be reached, is singular, or 50 iterations do not suffice.
pub fn forward<L: Leg>(
    manipulator: &Manipulator<L>,
    target: [f64; LEGS],
    start: Pose,
    tolerance: f64,
) -> Result<Pose, ForwardError> {
    const ITERATIONS: usize = 50;
    let mut pose = start;
    for _ in 0..ITERATIONS {
        let posture = manipulator
            .posture(&pose)
            .map_err(|(leg, _)| ForwardError::Unreachable { leg })?;
        let jacobian = Jacobian::new(&posture);
        let mut error = Vector3::zeros();
        for i in 0..LEGS {
            let mut difference = target[i] - manipulator.legs[i].actuator(&posture.legs[i]);
            if matches!(L::ACTUATOR, crate::mechanism::Actuator::Revolute) {
                difference = libm::remainder(difference, 2.0 * std::f64::consts::PI);
            }
            error[i] = difference;
        }
        if error.amax() <= tolerance {
            return Ok(pose);
        }
        let rate = Vector3::from_fn(|i, _| jacobian.drive[i] * error[i]);
        let step = jacobian
            .direct()
            .try_inverse()
            .map(|inverse| inverse * rate)
            .filter(|step| step.iter().all(|component| component.is_finite()))
            .ok_or(ForwardError::Singular)?;
        pose.position.x += step[0];
        pose.position.y += step[1];
        pose.phi += step[2];
    }
    Err(ForwardError::NoConvergence(ITERATIONS))
}
