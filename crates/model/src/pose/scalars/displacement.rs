//! Displacement under the in-plane force (docs/model.md, section 6.5).

use crate::kinematics::Jacobian;
use crate::lanes::{Planar, Real};
use crate::mechanism::Leg;
use crate::pose::PoseChecker;
use crate::spatial::LEGS;
use crate::stiffness::NoSliders;

/// Computes the displacement at several poses at once \[m\]; infinite for a platform that yields.
#[inline(always)]
pub(super) fn lanes<L: Leg, V: Real>(checker: &PoseChecker<L>, position: Planar<V>, arms: &[Planar<V>; LEGS]) -> V {
    let like = position.x;
    let legs = checker.leg_lanes(position, arms);
    let jacobian = Jacobian::of_lanes(&legs);
    let k_xy = match &checker.stiffness {
        Some(model) if L::MAY_BE_ON_RAILS && model.is_on_bending_rails() => {
            model.compliant_k_xy_lanes(&legs, &checker.slider_lanes(position, arms, &legs), &jacobian)
        }
        Some(model) => model.compliant_k_xy_lanes(&legs, &NoSliders, &jacobian),
        None => like.splat(0.0),
    };
    let force = like.splat(checker.in_plane_force);
    let yields = like.splat(0.0).at_least(k_xy);
    like.splat(f64::INFINITY).select(yields, force / k_xy)
}
