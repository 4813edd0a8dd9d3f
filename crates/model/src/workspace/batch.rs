//! Feasibility of many poses and the smallest values over them, computed in loops that are compiled for every
//! instruction set.
//!
//! Positions are passed as two columns that can be read up to a multiple of [`MAX_LANES`]; entries beyond the
//! requested poses are computed and ignored.

use glam::DVec2;
use pulp::{Simd, WithSimd};

use crate::lanes::{Lanes, MAX_LANES, Planar, Real, padded_length};
use crate::mechanism::Leg;
use crate::pose::{PoseChecker, PoseScalar, PoseScalars, ScalarSet};
use crate::spatial::LEGS;

/// Orientation in which poses are evaluated.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OrientationLanes<'a> {
    /// `C_i − P` in base axes \[m\].
    pub arms: &'a [DVec2; LEGS],
    /// Required sign of `det A`.
    pub sign: f64,
}

impl OrientationLanes<'_> {
    #[inline(always)]
    pub(super) fn lanes<S: Simd>(&self, simd: S) -> ([Planar<Lanes<S>>; LEGS], Lanes<S>) {
        let sign = Lanes::all(simd, self.sign);
        (splat_arms(sign, self.arms), sign)
    }
}

/// Returns the arms in as many lanes as `like` has.
#[inline(always)]
pub(super) fn splat_arms<V: Real>(like: V, arms: &[DVec2; LEGS]) -> [Planar<V>; LEGS] {
    [
        Planar::splat(like, arms[0]),
        Planar::splat(like, arms[1]),
        Planar::splat(like, arms[2]),
    ]
}

/// Determines which poses are feasible. The result is the number of poses before the first infeasible one, or `count` if all are
/// feasible or `marks` are written.
struct Feasible<'a, L, const ALL: bool> {
    checker: &'a PoseChecker<L>,
    oriented: OrientationLanes<'a>,
    xs: &'a [f64],
    ys: &'a [f64],
    count: usize,
    /// Receives 1 for each feasible pose and 0 for each infeasible one. Without it, the loop ends at the first infeasible pose.
    marks: Option<&'a mut [f64]>,
}

impl<L: Leg, const ALL: bool> WithSimd for Feasible<'_, L, ALL> {
    type Output = usize;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> usize {
        let (arms, sign) = self.oriented.lanes(simd);
        let (one, zero) = (sign.splat(1.0), sign.splat(0.0));
        let (xs, ys) = (Lanes::<S>::column(self.xs), Lanes::<S>::column(self.ys));
        let mut marks = self.marks.map(|marks| Lanes::<S>::column_mut(marks));
        let groups = self.count.div_ceil(Lanes::<S>::COUNT);
        let limited = self.checker.computed;
        for (group, (x, y)) in xs.iter().zip(ys).take(groups).enumerate() {
            let position = Planar::new(Lanes::load(simd, x), Lanes::load(simd, y));
            let good = self.checker.feasible_lanes::<_, ALL>(position, &arms, sign, limited);
            if let Some(marks) = &mut marks {
                one.select(good, zero).store(&mut marks[group]);
                continue;
            }
            let count_leading_set = good.count_leading_set();
            if count_leading_set < Lanes::<S>::COUNT {
                return (group * Lanes::<S>::COUNT + count_leading_set).min(self.count);
            }
        }
        self.count
    }
}

/// Smallest value of a quantity over many poses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Minimum {
    /// The value; infinite if no pose has one.
    pub value: f64,
    /// Index of the pose, the first one among equals.
    pub index: usize,
}

/// Number of scalars that every evaluation determines.
const SCALARS: usize = PoseScalar::ALWAYS.len();

/// Smallest values of the scalars that every evaluation determines, in their order: `det A / ℓ` multiplied by the required sign, and
/// the clearance whether g7 is required or not.
pub(crate) type Minima = [Minimum; SCALARS];

struct Smallest<'a, L> {
    checker: &'a PoseChecker<L>,
    oriented: OrientationLanes<'a>,
    xs: &'a [f64],
    ys: &'a [f64],
    /// Indices 0, 1, 2, … of the poses.
    indices: &'a [f64],
    /// Clearances that are not below this value need not be determined \[m\].
    clearance: f64,
}

impl<L: Leg> WithSimd for Smallest<'_, L> {
    type Output = Minima;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Minima {
        let (arms, sign) = self.oriented.lanes(simd);
        let infinite = sign.splat(f64::INFINITY);
        let mut values = [infinite; SCALARS];
        values[PoseScalar::Clearance as usize] = sign.splat(self.clearance);
        let mut indices = [sign.splat(0.0); SCALARS];
        let (xs, ys) = (Lanes::<S>::column(self.xs), Lanes::<S>::column(self.ys));
        for ((x, y), index) in xs.iter().zip(ys).zip(Lanes::<S>::column(self.indices)) {
            let position = Planar::new(Lanes::load(simd, x), Lanes::load(simd, y));
            let index = Lanes::load(simd, index);
            let (found, distals) = self.checker.core_lanes(position, &arms);
            let reachable = found.reachable;
            // Only a clearance below the smallest one so far matters, and none matters at an unreachable pose.
            let limit = values[PoseScalar::Clearance as usize].select(reachable, sign.splat(f64::NEG_INFINITY));
            let clearance = self.checker.compute_clearance_up_to(position, &arms, &distals, limit);
            // Where a leg does not reach the pose, nothing but the limit margin is known.
            let mut scalars = found.scalars;
            scalars[PoseScalar::Determinant] = scalars[PoseScalar::Determinant] * sign;
            scalars[PoseScalar::Clearance] = clearance;
            for k in 0..SCALARS {
                let scalar = PoseScalar::ALWAYS[k];
                let value = match scalar {
                    PoseScalar::Reach => scalars[scalar],
                    _ => scalars[scalar].select(reachable, infinite),
                };
                let smaller = values[k].exceeds(value);
                values[k] = value.select(smaller, values[k]);
                indices[k] = index.select(smaller, indices[k]);
            }
        }
        let mut minima = [Minimum::NONE; SCALARS];
        for (minimum, (value, index)) in minima.iter_mut().zip(values.into_iter().zip(indices)) {
            *minimum = Minimum::over_lanes(value, index);
        }
        minima
    }
}

/// Determines the worst values of scalars that are computed on demand.
struct Worst<'a, L> {
    checker: &'a PoseChecker<L>,
    arms: &'a [DVec2; LEGS],
    set: ScalarSet,
    xs: &'a [f64],
    ys: &'a [f64],
    indices: &'a [f64],
}

impl<L: Leg> WithSimd for Worst<'_, L> {
    type Output = [Minimum; PoseScalar::COUNT];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let zero = Lanes::all(simd, 0.0);
        let arms = splat_arms(zero, self.arms);
        let mut least = [zero.splat(f64::INFINITY); PoseScalar::COUNT];
        let mut least_index = [zero; PoseScalar::COUNT];
        let (xs, ys) = (Lanes::<S>::column(self.xs), Lanes::<S>::column(self.ys));
        for ((x, y), index) in xs.iter().zip(ys).zip(Lanes::<S>::column(self.indices)) {
            let position = Planar::new(Lanes::load(simd, x), Lanes::load(simd, y));
            let mut scalars = PoseScalars::splat(zero);
            self.checker.fill_on_demand(self.set, position, &arms, &mut scalars);
            for scalar in self.set.iter() {
                let sign = zero.splat(scalar.entry().quantity.better.sign());
                let (k, value) = (scalar as usize, scalars[scalar] * sign);
                let smaller = least[k].exceeds(value);
                least[k] = value.select(smaller, least[k]);
                least_index[k] = Lanes::load(simd, index).select(smaller, least_index[k]);
            }
        }
        let mut minima = [Minimum::NONE; PoseScalar::COUNT];
        for scalar in self.set.iter() {
            let k = scalar as usize;
            minima[k] = Minimum::over_lanes(least[k], least_index[k]);
        }
        minima
    }
}

impl Minimum {
    const NONE: Minimum = Minimum {
        value: f64::INFINITY,
        index: 0,
    };

    /// Returns the smallest of the values in all lanes, with the smallest index among equals.
    #[inline(always)]
    fn over_lanes<S: Simd>(value: Lanes<S>, index: Lanes<S>) -> Self {
        let mut lanes = [[0.0; MAX_LANES]; 2];
        value.store(&mut Lanes::<S>::column_mut(&mut lanes[0])[0]);
        index.store(&mut Lanes::<S>::column_mut(&mut lanes[1])[0]);
        let mut minimum = Self::NONE;
        for lane in 0..Lanes::<S>::COUNT {
            let (value, index) = (lanes[0][lane], lanes[1][lane] as usize);
            if value < minimum.value || (value == minimum.value && index < minimum.index) {
                minimum = Minimum { value, index };
            }
        }
        minimum
    }
}

impl<L: Leg> PoseChecker<L> {
    /// Returns the number of poses, among the first `count` positions, before the first infeasible one; `count` if all
    /// are feasible.
    pub(super) fn count_leading_feasible(
        &self,
        oriented: OrientationLanes<'_>,
        xs: &[f64],
        ys: &[f64],
        count: usize,
    ) -> usize {
        // A column that ends early must not be mistaken for one of feasible poses.
        assert!(xs.len() == ys.len() && xs.len() >= padded_length(count));
        self.mark_and_count(oriented, xs, ys, count, None)
    }

    /// Writes 1 for each position at which the pose is feasible and 0 for every other position.
    pub(super) fn mark_feasible(&self, oriented: OrientationLanes<'_>, xs: &[f64], ys: &[f64], good: &mut [f64]) {
        assert!(xs.len() == ys.len() && xs.len() == good.len() && xs.len().is_multiple_of(MAX_LANES));
        self.mark_and_count(oriented, xs, ys, xs.len(), Some(good));
    }

    fn mark_and_count(
        &self,
        oriented: OrientationLanes<'_>,
        xs: &[f64],
        ys: &[f64],
        count: usize,
        marks: Option<&mut [f64]>,
    ) -> usize {
        macro_rules! run {
            ($all:literal) => {
                self.instructions.run(Feasible::<L, $all> {
                    checker: self,
                    oriented,
                    xs,
                    ys,
                    count,
                    marks,
                })
            };
        }
        if self.examines_all { run!(true) } else { run!(false) }
    }

    /// Returns the smallest values over many positions in one orientation; `indices` numbers the positions from 0. The
    /// columns have equal lengths, a multiple of [`MAX_LANES`]. Only clearances below `clearance` are determined; if
    /// there are none, `clearance` itself is returned.
    pub(crate) fn smallest(
        &self,
        oriented: OrientationLanes<'_>,
        xs: &[f64],
        ys: &[f64],
        indices: &[f64],
        clearance: f64,
    ) -> Minima {
        assert!(xs.len() == ys.len() && xs.len() == indices.len() && xs.len().is_multiple_of(MAX_LANES));
        self.instructions.run(Smallest {
            checker: self,
            oriented,
            xs,
            ys,
            indices,
            clearance,
        })
    }

    /// Returns the worst values of scalars that are computed on demand over many positions in one orientation, as [`Self::smallest`]
    /// does for the others, and with their signs reversed where smaller values are better. Those that are not in `set` are infinite.
    pub(crate) fn worst(
        &self,
        set: ScalarSet,
        arms: &[DVec2; LEGS],
        xs: &[f64],
        ys: &[f64],
        indices: &[f64],
    ) -> [Minimum; PoseScalar::COUNT] {
        assert!(xs.len() == ys.len() && xs.len() == indices.len() && xs.len().is_multiple_of(MAX_LANES));
        if set.is_empty() {
            return [Minimum::NONE; PoseScalar::COUNT];
        }
        self.instructions.run(Worst {
            checker: self,
            arms,
            set,
            xs,
            ys,
            indices,
        })
    }
}
