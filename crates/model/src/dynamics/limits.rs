//! Whether poses keep the limits of a motion, by fewer operations than the limited values take (docs/model.md, section 15.8).

use super::DynamicsModel;
use super::displacement::Own;
use super::effort::MotionValue;
use super::error::LegErrors;
use super::legs::{DynamicsInputs, MovingLeg};
use crate::lanes::{LaneJob, Real};
use crate::spatial::LEGS;

/// Relative distance from a limit within which the value itself decides, because of the rounding of both.
const CLOSE: f64 = 1e-9;

/// Determines at which of several poses, of those of a mask, the limit of a value is kept, as a function of its own.
pub(crate) struct LimitJob<'a, V: Real> {
    pub model: &'a DynamicsModel,
    pub inputs: &'a DynamicsInputs<V>,
    pub legs: &'a [MovingLeg<V>; LEGS],
    pub value: MotionValue,
    pub limit: f64,
    pub good: V::Mask,
}

/// The legs at several poses at once, as a function of its own.
pub(crate) struct LegsJob<'a, V: Real> {
    pub model: &'a DynamicsModel,
    pub inputs: &'a DynamicsInputs<V>,
}

impl<V: Real> LaneJob for LegsJob<'_, V> {
    type Output = [MovingLeg<V>; LEGS];

    #[inline(always)]
    fn run(self) -> [MovingLeg<V>; LEGS] {
        self.model.legs(self.inputs)
    }
}

impl<V: Real> LaneJob for LimitJob<'_, V> {
    type Output = V::Mask;

    #[inline(always)]
    fn run(self) -> V::Mask {
        let Self {
            model, inputs, legs, ..
        } = self;
        let (good, most) = (self.good, legs[0].transmission.splat(self.limit));
        match self.value {
            MotionValue::NaturalFrequency => model.vibrates_above(inputs, legs, most, good),
            MotionValue::PositionError => model.errs_within(&model.leg_errors(inputs, legs), most, good),
            value => good & most.at_least(model.demand(inputs, legs, value)),
        }
    }
}

impl DynamicsModel {
    /// Returns at which of several poses the error of the position is within a limit. Where a bound of it is, its directions are not
    /// examined.
    #[inline(always)]
    fn errs_within<V: Real>(&self, errors: &[LegErrors<V>; LEGS], most: V, good: V::Mask) -> V::Mask {
        let bound = self.position_bound(errors) * most.splat(1.0 + CLOSE);
        // What is not a number is not within.
        let bound = bound.select(most.at_least(bound), most.splat(f64::INFINITY));
        if V::any(good & bound.exceeds(most)) {
            good & most.at_least(self.worst_position(errors).0)
        } else {
            good
        }
    }

    /// Returns at which of several poses all natural frequencies are above a limit: there `K − (2πf)² M` is positive definite.
    #[inline(always)]
    fn vibrates_above<V: Real>(
        &self,
        inputs: &DynamicsInputs<V>,
        legs: &[MovingLeg<V>; LEGS],
        least: V,
        mut good: V::Mask,
    ) -> V::Mask {
        let (zero, one) = (least.splat(0.0), least.splat(1.0));
        if self.is_on_bending_rails {
            return zero.exceeds(zero);
        }
        let rate = least * least.splat(2.0 * std::f64::consts::PI);
        let square = rate * rate;
        for block in 0..2 {
            let (stiffness, mass) = if block == 0 {
                (inputs.legs.in_plane(), self.mass_in_plane(inputs, legs, Own))
            } else {
                (inputs.legs.out_of_plane(), self.mass_out_of_plane(inputs, legs, Own))
            };
            let above = is_stiff(&stiffness, &mass, square * least.splat(1.0 + CLOSE));
            let not_below = is_stiff(&stiffness, &mass, square * least.splat(1.0 - CLOSE));
            let is_close = one.select(not_below, zero).exceeds(one.select(above, zero));
            if V::any(good & is_close) {
                return good & self.lowest_frequency(inputs, legs).at_least(least);
            }
            good = good & above;
            if !V::any(good) {
                break;
            }
        }
        good
    }
}

/// Returns whether `K − s M` is positive definite, where both matrices are upper triangles.
#[inline(always)]
fn is_stiff<V: Real>(stiffness: &[V; 6], mass: &[V; 6], square: V) -> V::Mask {
    let mut less = *stiffness;
    for (entry, mass) in less.iter_mut().zip(mass) {
        *entry = *entry - square * *mass;
    }
    let [first, _, _, second, _, third] = V::cholesky(&less);
    let zero = square.splat(0.0);
    // The root of a negative number is no number, and exceeds nothing.
    first.exceeds(zero) & second.exceeds(zero) & third.exceeds(zero)
}
