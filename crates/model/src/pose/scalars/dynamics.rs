//! Natural frequency, errors of the pose, and the speeds and forces of the actuators in motion (docs/model.md, section 15).

use super::PoseScalar;
use super::strength::inputs;
use crate::dynamics::{DynamicsInputs, MotionJob};
use crate::lanes::{Planar, Real};
use crate::mechanism::Leg;
use crate::pose::{PoseChecker, PoseScalars, ScalarSet};
use crate::spatial::LEGS;

/// Computes those scalars of a set that depend on a motion, at several poses at once; where there is none, the worst number, which is
/// infinite.
#[inline(always)]
pub(super) fn fill<L: Leg, V: Real>(
    checker: &PoseChecker<L>,
    set: ScalarSet,
    position: Planar<V>,
    arms: &[Planar<V>; LEGS],
    scalars: &mut PoseScalars<V>,
) {
    let like = position.x;
    let model = checker.dynamics.as_ref();
    let known = match (model, &checker.stiffness) {
        (Some(model), Some(stiffness)) => {
            let legs = inputs(checker, stiffness, position, arms);
            Some((model, DynamicsInputs { position, legs }))
        }
        _ => None,
    };
    for &scalar in PoseScalar::OF_MOTION {
        let Some(value) = scalar.of_motion().filter(|_| set.contains(scalar)) else {
            continue;
        };
        scalars[scalar] = match &known {
            Some((model, inputs)) if value.exists(checker.actuator) => {
                like.call_apart(MotionJob { model, inputs, value })
            }
            _ => like.splat(value.worst()),
        };
    }
}
