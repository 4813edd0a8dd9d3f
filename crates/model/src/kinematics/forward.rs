//! Forward kinematics: the pose that belongs to given actuator values, in the assembly mode of a starting pose
//! (docs/model.md, section 2.6).

use nalgebra::Vector3;

use super::Jacobian;
use crate::mechanism::{AnyLeg, Architecture, JointKind, Manipulator};
use crate::spatial::{LEGS, Pose};

/// Reason why no pose was found.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ForwardError {
    /// A leg does not reach the pose of an iteration.
    #[error("leg {} is out of reach in an iteration: the actuator values lie outside this assembly mode", .leg + 1)]
    Unreachable {
        /// Index of the leg, from 0.
        leg: usize,
    },
    /// `A` was singular in an iteration (`det A` = 0), or the step was not finite.
    #[error("the iteration reached a parallel singularity")]
    Singular,
    /// The iteration did not converge.
    #[error("no convergence after {0} iterations")]
    NoConvergence(usize),
}

/// Returns the pose with actuator values `target` (m or rad) to which Newton's method converges from `start`.
///
/// Each iteration solves `A Δt = B Δq`. The method stops when the error of every actuator value is at most `tolerance`
/// (m or rad). A parallel manipulator has up to six assembly modes; `start` determines which one is found.
///
/// # Errors
/// Returns a [`ForwardError`] if a leg does not reach the pose of an iteration, if `A` is singular there, or if the
/// method does not converge within 50 iterations.
pub fn forward(
    architecture: Architecture,
    manipulator: &Manipulator<AnyLeg>,
    target: [f64; LEGS],
    start: Pose,
    tolerance: f64,
) -> Result<Pose, ForwardError> {
    const ITERATIONS: usize = 50;
    let driven = architecture.driven();
    let mut pose = start;
    for _ in 0..ITERATIONS {
        let posture = manipulator
            .posture(&pose)
            .map_err(|(leg, _)| ForwardError::Unreachable { leg })?;
        let jacobian = Jacobian::new(&posture);
        let mut error = Vector3::zeros();
        for i in 0..LEGS {
            let mut difference = target[i] - manipulator.legs[i].joint_values(&posture.legs[i])[driven];
            if matches!(architecture.actuator(), JointKind::Revolute) {
                difference = libm::remainder(difference, 2.0 * std::f64::consts::PI);
            }
            error[i] = difference;
        }
        if error.amax() <= tolerance {
            return Ok(pose);
        }
        let rate = Vector3::from_fn(|i, _| jacobian.transmission[i] * error[i]);
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
