//! Natural frequency, errors of the pose, and the speeds and forces of the actuators in motion (docs/model.md, section 15).

use super::strength::inputs;
use crate::dynamics::{DynamicsInputs, MotionJob, MotionValue};
use crate::lanes::{Planar, Real};
use crate::mechanism::Leg;
use crate::pose::PoseChecker;
use crate::spatial::LEGS;

/// Returns a value at several poses at once; where there is none, the worst number, which is infinite.
#[inline(always)]
pub(super) fn lanes<L: Leg, V: Real>(
    checker: &PoseChecker<L>,
    position: Planar<V>,
    arms: &[Planar<V>; LEGS],
    value: MotionValue,
) -> V {
    let like = position.x;
    match (&checker.dynamics, &checker.stiffness) {
        (Some(model), Some(stiffness)) if value.exists(checker.actuator) => {
            let inputs = &DynamicsInputs {
                position,
                legs: inputs(checker, stiffness, position, arms),
            };
            like.call_apart(MotionJob { model, inputs, value })
        }
        _ => like.splat(value.worst()),
    }
}
