//! The seven chains, one file each, and what several of them share.

mod ppr;
mod prp;
mod prr;
mod rpp;
mod rpr;
mod rrp;
mod rrr;

pub use ppr::PprChain;
pub use prp::PrpChain;
pub use prr::PrrChain;
pub use rpp::RppChain;
pub use rpr::RprChain;
pub use rrp::RrpChain;
pub use rrr::RrrChain;

use glam::DVec2;

use super::{LegSizes, Shortfall};
use crate::enclosure::{Interval, TaylorModel};
use crate::lanes::{Planar, Real};
use crate::spatial::NUMBER_LIMIT;

/// Returns the distance of a value from the nearer of two limits at several poses at once, negative beyond them \[m\].
#[inline(always)]
fn margin_within<V: Real>(value: V, [lower, upper]: [f64; 2]) -> V {
    (value - value.splat(lower)).smaller(value.splat(upper) - value)
}

/// Returns the smaller of the distances of the values of two guides from their limits, a large shortfall where the guides are parallel.
#[inline(always)]
fn margin_within_both<V: Real>([first, second]: [V; 2], travels: [[f64; 2]; 2]) -> V {
    or_far_off(margin_within(first, travels[0]).smaller(margin_within(second, travels[1])))
}

/// Returns by how much a bar reaches beyond a height, which is negative out of reach, and the distance along the ground, which then is NaN,
/// for which every comparison is false.
#[inline(always)]
fn reach_and_foot<V: Real>(bar: V, height: V) -> [V; 2] {
    let height = height.abs();
    let reach = bar - height;
    // (L − h)(L + h) avoids the cancellation of L² − h² near the end of reach.
    [reach, (reach * (bar + height)).sqrt()]
}

/// Returns the same at one pose.
///
/// # Errors
/// Returns the [`Shortfall`] out of reach.
fn try_reach_and_foot(bar: f64, height: f64) -> Result<[f64; 2], Shortfall> {
    let [reach, foot] = reach_and_foot(bar, height);
    if reach < 0.0 {
        return Err(Shortfall::out_of_reach(reach));
    }
    Ok([reach, foot])
}

/// Returns `margin`, or a large shortfall where it is not a number.
#[inline(always)]
fn or_far_off<V: Real>(margin: V) -> V {
    let far = margin.splat(-NUMBER_LIMIT);
    margin.select(margin.at_least(far), far)
}

/// Returns `turn` applied to a vector, where `turn` holds a cosine and a sine.
#[inline(always)]
fn turned<V: Real>(vector: Planar<V>, turn: DVec2) -> Planar<V> {
    let (cosine, sine) = (vector.x.splat(turn.x), vector.x.splat(turn.y));
    Planar::new(cosine * vector.x - sine * vector.y, sine * vector.x + cosine * vector.y)
}

/// Returns `g_i`, the unit vector along the guide on the platform, for `arm` = `C_i − P` at several poses at once.
#[inline(always)]
fn platform_guide<V: Real>(leg: &LegSizes, arm: Planar<V>) -> Planar<V> {
    turned(arm, leg.frame.platform_guide).scaled(arm.x.splat(1.0 / leg.frame.arm_length))
}

/// Encloses the distances of a value from two limits.
fn enclosed_within(value: TaylorModel, [lower, upper]: [Interval; 2]) -> [TaylorModel; 2] {
    [value.plus(-lower), TaylorModel::constant(upper) - value]
}

/// Encloses the absolute value.
fn absolute(value: TaylorModel) -> TaylorModel {
    if value.is_positive() {
        return value;
    }
    if value.is_negative() {
        return -value;
    }
    let [lower, upper] = value.range();
    let largest = if lower.is_nan() || upper.is_nan() {
        f64::NAN
    } else {
        upper.max(-lower)
    };
    TaylorModel::constant(Interval::new(0.0, largest))
}
