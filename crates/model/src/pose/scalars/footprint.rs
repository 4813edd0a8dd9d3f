//! Footprint: the circle about `O` that the machine needs (docs/model.md, section 6.5).

use crate::lanes::{Planar, Real};
use crate::mechanism::Leg;
use crate::pose::PoseChecker;
use crate::spatial::LEGS;

/// Computes the radius of the smallest circle about `O` that holds all members and, unless it is left out, the base, at several poses at once
/// \[m\].
#[inline(always)]
pub(super) fn lanes<L: Leg, V: Real>(checker: &PoseChecker<L>, position: Planar<V>, arms: &[Planar<V>; LEGS]) -> V {
    let legs = checker.leg_lanes(position, arms);
    let distals = [legs[0].distal(), legs[1].distal(), legs[2].distal()];
    let members = checker
        .bodies
        .outermost(&checker.manipulator.legs, position, arms, &distals);
    let mut farthest = members;
    if checker.leaves_out_base {
        return farthest;
    }
    for leg in &checker.manipulator.legs {
        farthest = position.x.splat(leg.frame().anchor_distance).larger(farthest);
    }
    farthest
}
