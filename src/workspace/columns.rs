//! Everything the constraints look at, at many poses, in columns.

use glam::DVec2;
use pulp::{Simd, WithSimd};

use super::batch::Oriented;
use super::{PoseChecker, PoseLanes, PoseValues};
use crate::lanes::{Lanes, MOST_LANES, Planar, Real, padded};
use crate::mechanism::Leg;
use crate::spatial::LEGS;
use crate::stiffness::Rigidity;

/// Positions, a column for each component.
#[derive(Debug, Default)]
pub(crate) struct Positions {
    pub xs: Vec<f64>,
    pub ys: Vec<f64>,
}

impl Positions {
    pub fn clear(&mut self) {
        self.xs.clear();
        self.ys.clear();
    }

    pub fn push(&mut self, position: DVec2) {
        self.xs.push(position.x);
        self.ys.push(position.y);
    }

    /// Fills up to what loops read with the first position, which changes no smallest value.
    pub fn pad(&mut self) {
        let length = padded(self.xs.len());
        for column in [&mut self.xs, &mut self.ys] {
            column.resize(length, column[0]);
        }
    }
}

/// Longest distance that is told \[m\].
const FARTHEST: f64 = 1e100;

/// Values at many poses, a column each, padded.
#[derive(Debug, Clone, Default)]
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
            // Far beyond the number range there is no distance to tell; it is long.
            let slack = self.slack[index];
            return Err(if slack > -FARTHEST { slack.min(0.0) } else { -FARTHEST });
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
        }
        .finite())
    }

    #[inline(always)]
    fn writer<S: Simd>(&mut self) -> Writer<'_, S> {
        Writer {
            reachable: Lanes::<S>::column_mut(&mut self.reachable),
            slack: Lanes::<S>::column_mut(&mut self.slack),
            determinant: Lanes::<S>::column_mut(&mut self.determinant),
            inverse_condition: Lanes::<S>::column_mut(&mut self.inverse_condition),
            k_xy: Lanes::<S>::column_mut(&mut self.k_xy),
            k_z: Lanes::<S>::column_mut(&mut self.k_z),
            k_phi_z: Lanes::<S>::column_mut(&mut self.k_phi_z),
        }
    }
}

/// What one step of a loop reads or writes of a column.
type Group<S> = [<S as Simd>::f64s; 2];

struct Writer<'a, S: Simd> {
    reachable: &'a mut [Group<S>],
    slack: &'a mut [Group<S>],
    determinant: &'a mut [Group<S>],
    inverse_condition: &'a mut [Group<S>],
    k_xy: &'a mut [Group<S>],
    k_z: &'a mut [Group<S>],
    k_phi_z: &'a mut [Group<S>],
}

impl<S: Simd> Writer<'_, S> {
    #[inline(always)]
    fn put(&mut self, group: usize, values: PoseLanes<Lanes<S>>) {
        let (one, zero) = (values.slack.splat(1.0), values.slack.splat(0.0));
        one.where_set(values.reachable, zero).store(&mut self.reachable[group]);
        values.slack.store(&mut self.slack[group]);
        values.determinant.store(&mut self.determinant[group]);
        values.inverse_condition.store(&mut self.inverse_condition[group]);
        values.k_xy.store(&mut self.k_xy[group]);
        values.k_z.store(&mut self.k_z[group]);
        values.k_phi_z.store(&mut self.k_phi_z[group]);
    }
}

/// Values at many positions in one orientation.
struct AtPositions<'a, L> {
    checker: &'a PoseChecker<L>,
    oriented: Oriented<'a>,
    xs: &'a [f64],
    ys: &'a [f64],
    values: &'a mut ValueColumns,
}

impl<L: Leg> WithSimd for AtPositions<'_, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let (arms, _) = self.oriented.lanes(simd);
        let (xs, ys) = (Lanes::<S>::column(self.xs), Lanes::<S>::column(self.ys));
        let mut writer = self.values.writer::<S>();
        for (group, (x, y)) in xs.iter().zip(ys).enumerate() {
            let position = Planar::new(Lanes::load(simd, x), Lanes::load(simd, y));
            writer.put(group, self.checker.lanes(position, &arms));
        }
    }
}

/// Arms of many orientations, a column for each component, padded.
#[derive(Debug, Clone, Default)]
pub(crate) struct ArmColumns([Vec<f64>; 2 * LEGS]);

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
        let (x0, y0) = (Lanes::<S>::column(x0), Lanes::<S>::column(y0));
        let (x1, y1) = (Lanes::<S>::column(x1), Lanes::<S>::column(y1));
        let (x2, y2) = (Lanes::<S>::column(x2), Lanes::<S>::column(y2));
        let mut writer = self.values.writer::<S>();
        for group in 0..x0.len() {
            let arms = [
                Planar::new(Lanes::load(simd, &x0[group]), Lanes::load(simd, &y0[group])),
                Planar::new(Lanes::load(simd, &x1[group]), Lanes::load(simd, &y1[group])),
                Planar::new(Lanes::load(simd, &x2[group]), Lanes::load(simd, &y2[group])),
            ];
            writer.put(group, self.checker.lanes(position, &arms));
        }
    }
}

impl<L: Leg> PoseChecker<L> {
    /// Values at many positions in one orientation. The columns are of equal length, a multiple of
    /// [`MOST_LANES`].
    pub fn at_positions(&self, arms: &[DVec2; LEGS], xs: &[f64], ys: &[f64], values: &mut ValueColumns) {
        assert!(xs.len() == ys.len() && xs.len().is_multiple_of(MOST_LANES));
        values.resize(xs.len());
        self.instructions.run(AtPositions {
            checker: self,
            oriented: Oriented { arms, sign: 1.0 },
            xs,
            ys,
            values,
        });
    }

    /// Values at one position in many orientations.
    pub(crate) fn in_orientations(&self, position: DVec2, arms: &ArmColumns) -> ValueColumns {
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
