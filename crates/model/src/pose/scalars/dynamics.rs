//! Natural frequency, errors of the pose, and the speeds and forces of the actuators in motion (docs/model.md, section 15).

use super::PoseScalar;
use super::strength::inputs;
use crate::dynamics::{DynamicsInputs, DynamicsModel, LegsJob, LimitJob, MotionJob, MotionValue};
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
    let known = known(checker, position, arms);
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

/// Returns at which of several poses, of those of a mask, all limits are kept that depend on a motion.
#[inline(always)]
pub(in crate::pose) fn keep_limits_of_motion<L: Leg, V: Real>(
    checker: &PoseChecker<L>,
    position: Planar<V>,
    arms: &[Planar<V>; LEGS],
    mut good: V::Mask,
) -> V::Mask {
    let like = position.x;
    let none = like.splat(0.0).exceeds(like.splat(0.0));
    let Some((model, inputs)) = &known(checker, position, arms) else {
        return none;
    };
    let legs = &like.call_apart(LegsJob { model, inputs });
    for value in MotionValue::ALL {
        let Some(limit) = checker.thresholds.get(value.scalar()) else {
            continue;
        };
        if !value.exists(checker.actuator) {
            return none;
        }
        good = like.call_apart(LimitJob {
            model,
            inputs,
            legs,
            value,
            limit,
            good,
        });
        if !V::any(good) {
            break;
        }
    }
    good
}

/// Returns what the motion at several poses follows from, if the design has one.
#[inline(always)]
fn known<'a, L: Leg, V: Real>(
    checker: &'a PoseChecker<L>,
    position: Planar<V>,
    arms: &[Planar<V>; LEGS],
) -> Option<(&'a DynamicsModel, DynamicsInputs<V>)> {
    match (&checker.dynamics, &checker.stiffness) {
        (Some(model), Some(stiffness)) => {
            let legs = inputs(checker, stiffness, position, arms);
            Some((model, DynamicsInputs { position, legs }))
        }
        _ => None,
    }
}
