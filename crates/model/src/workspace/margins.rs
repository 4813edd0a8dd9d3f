//! The worst margins of the limits over many positions in one orientation, in loops that are compiled for every instruction set.

use pulp::{Simd, WithSimd};

use super::batch::OrientationLanes;
use crate::lanes::{Lanes, MAX_LANES, Planar, Real};
use crate::mechanism::Leg;
use crate::pose::{Better, EXAMINED_ALWAYS, MarginUnit, PoseChecker, PoseScalar, PoseScalars, ScalarSet};
use crate::spatial::LEGS;

/// What many positions in one orientation have shown.
pub(super) struct Examined {
    /// The worst margin of the limits.
    pub margin: f64,
    /// The worst values of the objective and of the limited scalars that take long, with their signs reversed where smaller values are
    /// better; infinite for all others.
    pub kept: PoseScalars<f64>,
}

/// Determines the worst margin over many positions in one orientation, and the worst values of some scalars: of all limits, or of those that
/// take long alone if `SLOW` says so.
struct WorstMargin<'a, L, const SLOW: bool> {
    checker: &'a PoseChecker<L>,
    oriented: OrientationLanes<'a>,
    xs: &'a [f64],
    ys: &'a [f64],
    base_radius: f64,
    /// Scalars whose worst values are kept.
    kept: ScalarSet,
}

impl<L: Leg, const SLOW: bool> WithSimd for WorstMargin<'_, L, SLOW> {
    type Output = Examined;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Examined {
        let (arms, sign) = self.oriented.lanes(simd);
        let mut least = sign.splat(f64::INFINITY);
        let mut least_kept = PoseScalars::splat(least);
        let (checker, base_radius, computed) = (self.checker, self.base_radius, self.checker.computed);
        let (xs, ys) = (Lanes::<S>::column(self.xs), Lanes::<S>::column(self.ys));
        for (x, y) in xs.iter().zip(ys) {
            let position = Planar::new(Lanes::load(simd, x), Lanes::load(simd, y));
            let kept = (self.kept, &mut least_kept);
            let margin = if SLOW {
                checker.slow_margin_lanes(position, &arms, base_radius, kept)
            } else {
                checker.margin_lanes(position, &arms, sign, base_radius, computed, kept)
            };
            least = margin.smaller(least);
        }
        let mut kept = PoseScalars::splat(f64::INFINITY);
        for scalar in self.kept.iter() {
            kept[scalar] = least_lane(least_kept[scalar]);
        }
        Examined {
            margin: least_lane(least),
            kept,
        }
    }
}

/// Keeps the value of a scalar if it is the worst so far, with its sign reversed where smaller values are better.
#[inline(always)]
fn keep_least<V: Real>(least: &mut PoseScalars<V>, scalar: PoseScalar, value: V) {
    let reversed = value.splat(scalar.entry().quantity.better.sign());
    least[scalar] = (value * reversed).smaller(least[scalar]);
}

/// Returns the least number of all lanes.
#[inline(always)]
fn least_lane<S: Simd>(numbers: Lanes<S>) -> f64 {
    let mut lanes = [0.0; MAX_LANES];
    numbers.store(&mut Lanes::<S>::column_mut(&mut lanes)[0]);
    lanes[..Lanes::<S>::COUNT].iter().copied().fold(f64::INFINITY, f64::min)
}

impl<L: Leg> PoseChecker<L> {
    /// Returns what many positions in one orientation show, in the columns of equal lengths, a multiple of [`MAX_LANES`], of all limits or
    /// of those that take long alone; `kept` are the scalars whose worst values are returned, which then are those of these limits.
    pub(super) fn worst_margin<const SLOW: bool>(
        &self,
        oriented: OrientationLanes<'_>,
        (xs, ys): (&[f64], &[f64]),
        base_radius: f64,
        kept: ScalarSet,
    ) -> Examined {
        assert!(xs.len() == ys.len() && xs.len().is_multiple_of(MAX_LANES));
        self.instructions.run(WorstMargin::<L, SLOW> {
            checker: self,
            oriented,
            xs,
            ys,
            base_radius,
            kept,
        })
    }

    /// Returns the worst margin of some limits that take long at several poses at once, no less than −1; it means nothing where a leg does
    /// not reach the pose. Margins of lengths are divided by `base_radius`, and the worst values so far are kept.
    #[inline(always)]
    fn slow_margin_lanes<V: Real>(
        &self,
        position: Planar<V>,
        arms: &[Planar<V>; LEGS],
        base_radius: f64,
        (slow, least_kept): (ScalarSet, &mut PoseScalars<V>),
    ) -> V {
        let like = position.x;
        let none = like.splat(-1.0);
        let per_length = like.splat(1.0 / base_radius);
        let mut scalars = PoseScalars::splat(like);
        self.fill_on_demand(slow, position, arms, &mut scalars);
        let mut worst = like.splat(f64::INFINITY);
        for scalar in slow.iter() {
            let margin = limit_margin(scalar, scalars[scalar], self.thresholds.bound(scalar), per_length);
            worst = worst.smaller(margin.larger(none));
            keep_least(least_kept, scalar, scalars[scalar]);
        }
        // A clearance is examined no further than to the distance that has the worst margin, which rounds that margin: here as there.
        if let Some(threshold) = self.thresholds.get(PoseScalar::Clearance) {
            let distance = worst * like.splat(base_radius) + like.splat(threshold);
            worst = worst.smaller(((distance - like.splat(threshold)) * per_length).larger(none));
        }
        worst
    }

    /// Returns the worst margin of the limits at several poses at once, no less than −1, and less than −1 where a leg does not reach
    /// the pose. Margins of lengths are divided by `base_radius`. `set` are the scalars that are limited; of those in `kept`, the worst
    /// values so far are kept.
    #[inline(always)]
    fn margin_lanes<V: Real>(
        &self,
        position: Planar<V>,
        arms: &[Planar<V>; LEGS],
        sign: V,
        base_radius: f64,
        set: ScalarSet,
        (kept, least_kept): (ScalarSet, &mut PoseScalars<V>),
    ) -> V {
        let (values, distals) = self.core_lanes(position, arms);
        let scalars = &values.scalars;
        let none = sign.splat(-1.0);
        let per_length = sign.splat(1.0 / base_radius);
        // A margin that is not a number counts as a constraint that is missed entirely.
        let mut worst = (scalars[PoseScalar::Reach] * per_length).larger(none);
        let unreached = none + worst.smaller(sign.splat(0.0));
        for scalar in [
            PoseScalar::Dexterity,
            PoseScalar::StiffnessXy,
            PoseScalar::StiffnessPhiZ,
            PoseScalar::StiffnessZ,
        ] {
            let margin = limit_margin(scalar, scalars[scalar], self.thresholds.bound(scalar), per_length);
            worst = worst.smaller(margin.larger(none));
        }
        // The determinant must not vanish, so that a margin of 0 is one that is missed.
        let determinant = scalars[PoseScalar::Determinant] * sign;
        let vanishing = sign.splat(-f64::MIN_POSITIVE);
        worst = worst.smaller(
            determinant
                .select(determinant.exceeds(sign.splat(0.0)), determinant.smaller(vanishing))
                .larger(none),
        );
        if self.examines_all {
            let mut scalars = PoseScalars::of_core(scalars);
            self.fill_on_demand(set, position, arms, &mut scalars);
            for &scalar in PoseScalar::ALL {
                if let Some(threshold) = self.thresholds.get(scalar)
                    && !EXAMINED_ALWAYS.contains(&scalar)
                {
                    let margin = limit_margin(scalar, scalars[scalar], threshold, per_length);
                    worst = worst.smaller(margin.larger(none));
                }
            }
            for scalar in kept.iter() {
                keep_least(least_kept, scalar, scalars[scalar]);
            }
        } else {
            // Of those that every loop over poses determines, larger values are better.
            for scalar in kept.iter() {
                least_kept[scalar] = scalars[scalar].smaller(least_kept[scalar]);
            }
        }
        if let Some(threshold) = self.thresholds.get(PoseScalar::Clearance) {
            let limit = worst * sign.splat(base_radius) + sign.splat(threshold);
            let limit = limit.select(values.reachable, sign.splat(f64::NEG_INFINITY));
            let clearance = self.compute_clearance_apart(position, arms, &distals, limit);
            worst = worst.smaller(((clearance - sign.splat(threshold)) * per_length).larger(none));
        }
        worst.select(values.reachable, unreached)
    }
}

/// Returns the margin of a limit at several poses at once, as [`PoseScalar::margin`] defines it; infinite without a limit.
#[inline(always)]
fn limit_margin<V: Real>(scalar: PoseScalar, value: V, threshold: f64, per_length: V) -> V {
    let entry = scalar.entry();
    let limit = value.splat(threshold);
    let excess = match entry.quantity.better {
        Better::Higher => value - limit,
        Better::Lower => limit - value,
    };
    match entry.margin {
        MarginUnit::BaseRadius => excess * per_length,
        MarginUnit::Threshold if threshold > 0.0 => excess * value.splat(1.0 / threshold),
        MarginUnit::Threshold => excess,
    }
}
