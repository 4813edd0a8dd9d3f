//! Transmission of the leg that has the least (docs/model.md, section 6.5).

use crate::lanes::{Planar, Real};
use crate::mechanism::{JointKind, Leg};
use crate::pose::PoseChecker;
use crate::spatial::LEGS;

/// Computes the transmission at several poses at once.
#[inline(always)]
pub(super) fn lanes<L: Leg, V: Real>(checker: &PoseChecker<L>, position: Planar<V>, arms: &[Planar<V>; LEGS]) -> V {
    let legs = checker.leg_lanes(position, arms);
    let lever = match checker.actuator {
        JointKind::Prismatic => 1.0,
        JointKind::Revolute => 1.0 / checker.longest_lever,
    };
    let least = legs[0]
        .transmission
        .abs()
        .smaller(legs[1].transmission.abs().smaller(legs[2].transmission.abs()));
    least * position.x.splat(lever)
}
