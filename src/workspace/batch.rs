//! Loops over many poses of one design, compiled for every instruction set.
//!
//! Positions come as two columns that can be read up to a multiple of [`MOST_LANES`](crate::lanes::MOST_LANES); what
//! stands past `count` is computed and not looked at.

use glam::DVec2;
use pulp::{Simd, WithSimd};

use super::{PoseChecker, PoseLanes, PoseValues};
use crate::lanes::{Lanes, Planar, Real, padded};
use crate::mechanism::Leg;
use crate::spatial::LEGS;
use crate::stiffness::Rigidity;

/// An orientation in which poses are asked for.
#[derive(Debug, Clone, Copy)]
pub struct Turned<'a> {
    /// `C_i − P` in base axes \[m\].
    pub arms: &'a [DVec2; LEGS],
    /// Sign that `det A` must have.
    pub sign: f64,
}

impl Turned<'_> {
    #[inline(always)]
    fn lanes<S: Simd>(&self, simd: S) -> ([Planar<Lanes<S>>; LEGS], Lanes<S>) {
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

/// Number of poses before the first that is not good; `count` where all are.
struct Leading<'a, L> {
    checker: &'a PoseChecker<L>,
    turned: Turned<'a>,
    xs: &'a [f64],
    ys: &'a [f64],
    count: usize,
}

impl<L: Leg> WithSimd for Leading<'_, L> {
    type Output = usize;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> usize {
        let (arms, sign) = self.turned.lanes(simd);
        let (xs, ys) = (S::as_simd_f64s(self.xs).0, S::as_simd_f64s(self.ys).0);
        let mut at = 0;
        for (&x, &y) in xs.iter().zip(ys) {
            if at >= self.count {
                break;
            }
            let position = Planar::new(Lanes::new(simd, x), Lanes::new(simd, y));
            let leading = self.checker.good_lanes(position, &arms, sign).leading();
            if leading < S::F64_LANES {
                return (at + leading).min(self.count);
            }
            at += S::F64_LANES;
        }
        self.count
    }
}

/// Writes 1 for each pose that is good and 0 for each that is not.
struct Good<'a, L> {
    checker: &'a PoseChecker<L>,
    turned: Turned<'a>,
    xs: &'a [f64],
    ys: &'a [f64],
    good: &'a mut [f64],
}

impl<L: Leg> WithSimd for Good<'_, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let (arms, sign) = self.turned.lanes(simd);
        let (one, zero) = (sign.splat(1.0), sign.splat(0.0));
        let (xs, ys) = (S::as_simd_f64s(self.xs).0, S::as_simd_f64s(self.ys).0);
        for ((&x, &y), good) in xs.iter().zip(ys).zip(S::as_mut_simd_f64s(self.good).0) {
            let position = Planar::new(Lanes::new(simd, x), Lanes::new(simd, y));
            *good = one
                .where_set(self.checker.good_lanes(position, &arms, sign), zero)
                .values();
        }
    }
}

/// Values at many poses, a column each, padded.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ValueColumns {
    /// 1 where every leg reaches, 0 elsewhere: there only the slack has a meaning.
    reachable: Vec<f64>,
    slack: Vec<f64>,
    determinant: Vec<f64>,
    inverse_condition: Vec<f64>,
    k_xy: Vec<f64>,
    k_z: Vec<f64>,
    k_phi_z: Vec<f64>,
}

impl ValueColumns {
    fn resize(&mut self, length: usize) {
        for column in [
            &mut self.reachable,
            &mut self.slack,
            &mut self.determinant,
            &mut self.inverse_condition,
            &mut self.k_xy,
            &mut self.k_z,
            &mut self.k_phi_z,
        ] {
            column.resize(length, 0.0);
        }
    }

    /// Values of pose `index`.
    ///
    /// # Errors
    /// The distance to the nearest limit that is passed \[m\], ≤ 0, where a leg does not reach.
    pub fn get(&self, index: usize) -> Result<PoseValues, f64> {
        if self.reachable[index] == 0.0 {
            return Err(self.slack[index]);
        }
        Ok(PoseValues {
            slack: self.slack[index],
            determinant: self.determinant[index],
            inverse_condition: self.inverse_condition[index],
            rigidity: Rigidity {
                k_xy: self.k_xy[index],
                k_z: self.k_z[index],
                k_phi_z: self.k_phi_z[index],
            },
        })
    }

    #[inline(always)]
    fn writer<S: Simd>(&mut self) -> Writer<'_, S> {
        Writer {
            reachable: S::as_mut_simd_f64s(&mut self.reachable).0,
            slack: S::as_mut_simd_f64s(&mut self.slack).0,
            determinant: S::as_mut_simd_f64s(&mut self.determinant).0,
            inverse_condition: S::as_mut_simd_f64s(&mut self.inverse_condition).0,
            k_xy: S::as_mut_simd_f64s(&mut self.k_xy).0,
            k_z: S::as_mut_simd_f64s(&mut self.k_z).0,
            k_phi_z: S::as_mut_simd_f64s(&mut self.k_phi_z).0,
        }
    }
}

struct Writer<'a, S: Simd> {
    reachable: &'a mut [S::f64s],
    slack: &'a mut [S::f64s],
    determinant: &'a mut [S::f64s],
    inverse_condition: &'a mut [S::f64s],
    k_xy: &'a mut [S::f64s],
    k_z: &'a mut [S::f64s],
    k_phi_z: &'a mut [S::f64s],
}

impl<S: Simd> Writer<'_, S> {
    #[inline(always)]
    fn put(&mut self, register: usize, values: PoseLanes<Lanes<S>>) {
        let (one, zero) = (values.slack.splat(1.0), values.slack.splat(0.0));
        self.reachable[register] = one.where_set(values.reachable, zero).values();
        self.slack[register] = values.slack.values();
        self.determinant[register] = values.determinant.values();
        self.inverse_condition[register] = values.inverse_condition.values();
        self.k_xy[register] = values.k_xy.values();
        self.k_z[register] = values.k_z.values();
        self.k_phi_z[register] = values.k_phi_z.values();
    }
}

/// Values at many positions in one orientation.
struct AtPositions<'a, L> {
    checker: &'a PoseChecker<L>,
    turned: Turned<'a>,
    xs: &'a [f64],
    ys: &'a [f64],
    values: &'a mut ValueColumns,
}

impl<L: Leg> WithSimd for AtPositions<'_, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let (arms, _) = self.turned.lanes(simd);
        let (xs, ys) = (S::as_simd_f64s(self.xs).0, S::as_simd_f64s(self.ys).0);
        let mut writer = self.values.writer::<S>();
        for (register, (&x, &y)) in xs.iter().zip(ys).enumerate() {
            let position = Planar::new(Lanes::new(simd, x), Lanes::new(simd, y));
            writer.put(register, self.checker.lanes(position, &arms));
        }
    }
}

/// Arms of many orientations, a column for each component, padded.
#[derive(Debug, Clone, Default)]
pub struct ArmColumns([Vec<f64>; 2 * LEGS]);

impl ArmColumns {
    /// The columns of `arms`.
    pub fn new(arms: impl ExactSizeIterator<Item = [DVec2; LEGS]>) -> Self {
        let length = padded(arms.len());
        let mut columns: [Vec<f64>; 2 * LEGS] = std::array::from_fn(|_| Vec::with_capacity(length));
        for arms in arms {
            for (leg, arm) in arms.iter().enumerate() {
                columns[2 * leg].push(arm.x);
                columns[2 * leg + 1].push(arm.y);
            }
        }
        for column in &mut columns {
            column.resize(length, 0.0);
        }
        Self(columns)
    }
}

/// Values at one position in many orientations.
struct InOrientations<'a, L> {
    checker: &'a PoseChecker<L>,
    position: DVec2,
    arms: &'a ArmColumns,
    values: &'a mut ValueColumns,
}

impl<L: Leg> WithSimd for InOrientations<'_, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let position = Planar::splat(Lanes::all(simd, 0.0), self.position);
        let [x0, y0, x1, y1, x2, y2] = &self.arms.0;
        let (x0, y0) = (S::as_simd_f64s(x0).0, S::as_simd_f64s(y0).0);
        let (x1, y1) = (S::as_simd_f64s(x1).0, S::as_simd_f64s(y1).0);
        let (x2, y2) = (S::as_simd_f64s(x2).0, S::as_simd_f64s(y2).0);
        let mut writer = self.values.writer::<S>();
        for register in 0..x0.len() {
            let arms = [
                Planar::new(Lanes::new(simd, x0[register]), Lanes::new(simd, y0[register])),
                Planar::new(Lanes::new(simd, x1[register]), Lanes::new(simd, y1[register])),
                Planar::new(Lanes::new(simd, x2[register]), Lanes::new(simd, y2[register])),
            ];
            writer.put(register, self.checker.lanes(position, &arms));
        }
    }
}

impl<L: Leg> PoseChecker<L> {
    /// The poses at the first `count` positions before the first that is not good; `count` where all are.
    pub(super) fn leading(&self, turned: Turned<'_>, xs: &[f64], ys: &[f64], count: usize) -> usize {
        self.instructions.run(Leading {
            checker: self,
            turned,
            xs,
            ys,
            count,
        })
    }

    /// Writes 1 for each position at which the pose is good and 0 for each other one.
    pub(super) fn mark_good(&self, turned: Turned<'_>, xs: &[f64], ys: &[f64], good: &mut [f64]) {
        self.instructions.run(Good {
            checker: self,
            turned,
            xs,
            ys,
            good,
        });
    }

    /// Values at many positions in one orientation. The columns are of equal length, a multiple of
    /// [`MOST_LANES`](crate::lanes::MOST_LANES).
    pub fn at_positions(&self, arms: &[DVec2; LEGS], xs: &[f64], ys: &[f64], values: &mut ValueColumns) {
        values.resize(xs.len());
        self.instructions.run(AtPositions {
            checker: self,
            turned: Turned { arms, sign: 1.0 },
            xs,
            ys,
            values,
        });
    }

    /// Values at one position in many orientations.
    pub fn in_orientations(&self, position: DVec2, arms: &ArmColumns) -> ValueColumns {
        let mut values = ValueColumns::default();
        values.resize(arms.0[0].len());
        self.instructions.run(InOrientations {
            checker: self,
            position,
            arms,
            values: &mut values,
        });
        values
    }
}
