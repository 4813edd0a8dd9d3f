//! Feasibility of many poses and the smallest values over them, computed in loops that are compiled for every
//! instruction set.
//!
//! Positions are passed as two columns that can be read up to a multiple of [`MAX_LANES`]; entries beyond the
//! requested poses are computed and ignored.

use glam::DVec2;
use pulp::{Simd, WithSimd};

use super::PoseChecker;
use crate::lanes::{Lanes, MAX_LANES, Planar, Real, padded_length};
use crate::mechanism::Leg;
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
        (
            [
                Planar::splat(sign, self.arms[0]),
                Planar::splat(sign, self.arms[1]),
                Planar::splat(sign, self.arms[2]),
            ],
            sign,
        )
    }
}

/// Determines which poses are feasible. The result is the number of poses before the first infeasible one, or `count` if all are
/// feasible or `marks` are written.
struct Feasible<'a, L, const FURTHER: bool> {
    checker: &'a PoseChecker<L>,
    oriented: OrientationLanes<'a>,
    xs: &'a [f64],
    ys: &'a [f64],
    count: usize,
    /// Receives 1 for each feasible pose and 0 for each infeasible one. Without it, the loop ends at the first infeasible pose.
    marks: Option<&'a mut [f64]>,
}

impl<L: Leg, const FURTHER: bool> WithSimd for Feasible<'_, L, FURTHER> {
    type Output = usize;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> usize {
        let (arms, sign) = self.oriented.lanes(simd);
        let (one, zero) = (sign.splat(1.0), sign.splat(0.0));
        let (xs, ys) = (Lanes::<S>::column(self.xs), Lanes::<S>::column(self.ys));
        let mut marks = self.marks.map(|marks| Lanes::<S>::column_mut(marks));
        let groups = self.count.div_ceil(Lanes::<S>::COUNT);
        for (group, (x, y)) in xs.iter().zip(ys).take(groups).enumerate() {
            let position = Planar::new(Lanes::load(simd, x), Lanes::load(simd, y));
            let good = self.checker.feasible_lanes::<_, FURTHER>(position, &arms, sign);
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

/// Number of quantities whose smallest value is determined.
const QUANTITIES: usize = 7;

/// Smallest limit margin, `κ_F⁻¹`, `k_xy`, `k_z`, `k_φz`, `det A / ℓ` (multiplied by the required sign) and clearance,
/// which is determined whether g7 is required or not.
pub(crate) type Minima = [Minimum; QUANTITIES];

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
        let mut values = [infinite; QUANTITIES];
        values[QUANTITIES - 1] = sign.splat(self.clearance);
        let mut indices = [sign.splat(0.0); QUANTITIES];
        let (xs, ys) = (Lanes::<S>::column(self.xs), Lanes::<S>::column(self.ys));
        for ((x, y), index) in xs.iter().zip(ys).zip(Lanes::<S>::column(self.indices)) {
            let position = Planar::new(Lanes::load(simd, x), Lanes::load(simd, y));
            let index = Lanes::load(simd, index);
            let (found, distals) = self.checker.lanes_without_clearance(position, &arms);
            let reachable = found.reachable;
            // Only a clearance below the smallest one so far matters, and none matters at an unreachable pose.
            let limit = values[6].select(reachable, sign.splat(f64::NEG_INFINITY));
            let clearance = self.checker.compute_clearance_up_to(position, &arms, &distals, limit);
            macro_rules! lower {
                ($($k:literal: $value:expr,)+) => {$({
                    let smaller = values[$k].exceeds($value);
                    values[$k] = $value.select(smaller, values[$k]);
                    indices[$k] = index.select(smaller, indices[$k]);
                })+};
            }
            lower! {
                0: found.limit_margin,
                1: found.inverse_condition.select(reachable, infinite),
                2: found.k_xy.select(reachable, infinite),
                3: found.k_z.select(reachable, infinite),
                4: found.k_phi_z.select(reachable, infinite),
                5: (found.determinant * sign).select(reachable, infinite),
                6: clearance.select(reachable, infinite),
            }
        }
        let mut minima = [Minimum {
            value: f64::INFINITY,
            index: 0,
        }; QUANTITIES];
        let mut lanes = [[0.0; MAX_LANES]; 2];
        for (minimum, (value, index)) in minima.iter_mut().zip(values.into_iter().zip(indices)) {
            value.store(&mut Lanes::<S>::column_mut(&mut lanes[0])[0]);
            index.store(&mut Lanes::<S>::column_mut(&mut lanes[1])[0]);
            for lane in 0..Lanes::<S>::COUNT {
                let (value, index) = (lanes[0][lane], lanes[1][lane] as usize);
                if value < minimum.value || (value == minimum.value && index < minimum.index) {
                    *minimum = Minimum { value, index };
                }
            }
        }
        minima
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
            ($further:literal) => {
                self.instructions.run(Feasible::<L, $further> {
                    checker: self,
                    oriented,
                    xs,
                    ys,
                    count,
                    marks,
                })
            };
        }
        if self.thresholds.further.is_some() {
            run!(true)
        } else {
            run!(false)
        }
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
}
