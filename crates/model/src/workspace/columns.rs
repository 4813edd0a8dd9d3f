//! Values that the constraints use, at many poses, stored in columns.

use glam::DVec2;
use pulp::{Simd, WithSimd};

use super::batch::splat_arms;
use crate::lanes::{Lanes, MAX_LANES, Planar, Real, padded_length};
use crate::mechanism::Leg;
use crate::pose::{
    Better, CoreLanes, PoseChecker, PoseScalar, PoseScalars, PoseValues, ScalarSet, Thresholds, finite, is_within,
};
use crate::spatial::{LEGS, NUMBER_LIMIT};

/// Positions, one column for each component.
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

    /// Returns the positions with the given indices.
    pub fn chosen(&self, indices: &[usize]) -> Self {
        let [xs, ys] = [&self.xs, &self.ys].map(|column| indices.iter().map(|&index| column[index]).collect());
        Self { xs, ys }
    }

    pub fn extend(&mut self, positions: &[DVec2]) {
        self.xs.extend(positions.iter().map(|position| position.x));
        self.ys.extend(positions.iter().map(|position| position.y));
    }

    /// Replaces the positions by others, with the padding.
    pub fn lay(&mut self, positions: &[DVec2]) {
        self.clear();
        self.extend(positions);
        self.pad();
    }

    /// Returns both columns.
    pub fn columns(&self) -> (&[f64], &[f64]) {
        (&self.xs, &self.ys)
    }

    pub fn truncate(&mut self, count: usize) {
        self.xs.truncate(count);
        self.ys.truncate(count);
    }

    /// Returns the indices of the positions, with those of the padding, as numbers.
    pub fn indices(&self) -> Vec<f64> {
        (0..self.xs.len()).map(|index| index as f64).collect()
    }

    /// Pads the columns to the length that loops read. The padding repeats the first position, which changes no
    /// smallest value.
    pub fn pad(&mut self) {
        let length = padded_length(self.xs.len());
        for column in [&mut self.xs, &mut self.ys] {
            column.resize(length, column.first().copied().unwrap_or(0.0));
        }
    }
}

/// Scalars at many poses, one padded column for each; those that were not computed have no column.
#[derive(Debug, Clone, Default)]
pub struct ValueColumns {
    /// 1 where every leg reaches the pose, 0 elsewhere; there only the limit margin is meaningful.
    reachable: Vec<f64>,
    scalars: PoseScalars<Vec<f64>>,
    computed: ScalarSet,
}

impl ValueColumns {
    fn resize(&mut self, length: usize, computed: ScalarSet) {
        self.computed = computed;
        self.reachable.resize(length, 0.0);
        for &scalar in PoseScalar::ALL {
            let length = if computed.contains(scalar) { length } else { 0 };
            self.scalars[scalar].resize(length, 0.0);
        }
    }

    /// Returns the values of pose `index`.
    ///
    /// # Errors
    /// Returns the limit margin \[m\], which is at most 0, if a leg does not reach the pose.
    pub fn get(&self, index: usize) -> Result<PoseValues, f64> {
        let number = |scalar: PoseScalar| self.scalars[scalar].get(index).copied().unwrap_or(f64::NAN);
        if self.reachable[index] == 0.0 {
            // Where the distance is beyond the number range, `-NUMBER_LIMIT` is reported instead.
            let limit_margin = number(PoseScalar::Reach);
            return Err(if limit_margin > -NUMBER_LIMIT {
                limit_margin.min(0.0)
            } else {
                -NUMBER_LIMIT
            });
        }
        Ok(PoseValues::new(number, self.computed))
    }

    /// Returns whether the pose `index` is reached, has the sign `sign` of `det A` or any other than 0 if there is none yet, and keeps
    /// limits of scalars that were computed; notes its sign.
    pub(crate) fn keeps(&self, index: usize, limits: &[(PoseScalar, f64)], sign: &mut Option<f64>) -> bool {
        if self.reachable[index] == 0.0 {
            return false;
        }
        let value = |scalar: PoseScalar| finite(scalar, self.scalars[scalar][index]);
        let determinant = value(PoseScalar::Determinant);
        determinant != 0.0
            && *sign.get_or_insert(determinant.signum()) == determinant.signum()
            && limits
                .iter()
                .all(|&(scalar, limit)| is_within(scalar, value(scalar), limit))
    }

    /// Returns the ratio of a scalar to its threshold at the first `count` poses, or of the threshold to the scalar where smaller
    /// values are better; of a frequency the square of that, which grows with the bars as a stiffness does. It is `f64::MAX` where a leg
    /// does not reach the pose, because it is not this scalar that is insufficient there.
    fn ratios(&self, scalar: PoseScalar, threshold: f64, count: usize) -> Vec<f64> {
        let is_frequency = scalar.entry().is_frequency;
        let better = scalar.entry().quantity.better;
        let ratio = |value: f64| match better {
            // If one operand is NaN, `max` returns the other one.
            Better::Higher => {
                let ratio = (value / threshold.max(f64::MIN_POSITIVE)).max(0.0);
                if is_frequency { ratio * ratio } else { ratio }
            }
            Better::Lower => threshold / value,
        };
        let column = self.scalars[scalar].iter().zip(&self.reachable).take(count);
        column
            .map(|(value, reachable)| {
                if *reachable > 0.0 {
                    ratio(*value).min(f64::MAX)
                } else {
                    f64::MAX
                }
            })
            .collect()
    }

    /// Returns these ratios for the limited scalars that thicker bars improve, one column each.
    pub(crate) fn bar_ratios(&self, thresholds: &Thresholds, count: usize) -> Vec<Vec<f64>> {
        thresholds
            .iter()
            .filter(|(scalar, _)| scalar.entry().is_of_bars)
            .map(|(scalar, threshold)| self.ratios(scalar, threshold, count))
            .collect()
    }

    /// Returns the column of a scalar, which is empty if it was not computed. Where joints are beyond their limits, the values continue
    /// as functions of the pose; where the inverse kinematics has no solution, the determinant is not a number.
    pub fn column(&self, scalar: PoseScalar) -> &[f64] {
        &self.scalars[scalar]
    }

    #[inline(always)]
    fn writer<S: Simd>(&mut self) -> ColumnWriter<'_, S> {
        ColumnWriter {
            reachable: Lanes::<S>::column_mut(&mut self.reachable),
            scalars: self.scalars.each_mut().map(|column| Lanes::<S>::column_mut(column)),
            computed: self.computed,
        }
    }
}

/// Part of a column that one step of a loop reads or writes.
type Group<S> = [<S as Simd>::f64s; 2];

struct ColumnWriter<'a, S: Simd> {
    reachable: &'a mut [Group<S>],
    scalars: PoseScalars<&'a mut [Group<S>]>,
    computed: ScalarSet,
}

impl<S: Simd> ColumnWriter<'_, S> {
    #[inline(always)]
    fn put(&mut self, group: usize, values: &CoreLanes<Lanes<S>>) {
        let margin = values.scalars[PoseScalar::Reach];
        let (one, zero) = (margin.splat(1.0), margin.splat(0.0));
        one.select(values.reachable, zero).store(&mut self.reachable[group]);
        for &scalar in PoseScalar::ALWAYS {
            if self.computed.contains(scalar) {
                values.scalars[scalar].store(&mut self.scalars[scalar][group]);
            }
        }
    }

    #[inline(always)]
    fn put_on_demand(&mut self, group: usize, scalars: &PoseScalars<Lanes<S>>) {
        for scalar in self.computed.on_demand().iter() {
            scalars[scalar].store(&mut self.scalars[scalar][group]);
        }
    }
}

/// Arms of many poses, one padded column for each component.
#[derive(Debug, Clone, Default)]
pub(crate) struct ArmColumns([Vec<f64>; 2 * LEGS]);

impl ArmColumns {
    /// Returns the padded columns of `arms`.
    pub fn new(arms: impl ExactSizeIterator<Item = [DVec2; LEGS]>) -> Self {
        let mut columns = Self::default();
        for arms in arms {
            columns.push(&arms);
        }
        columns.pad();
        columns
    }

    pub fn clear(&mut self) {
        self.0.iter_mut().for_each(Vec::clear);
    }

    pub fn push(&mut self, arms: &[DVec2; LEGS]) {
        for (leg, arm) in arms.iter().enumerate() {
            self.0[2 * leg].push(arm.x);
            self.0[2 * leg + 1].push(arm.y);
        }
    }

    /// Returns the arms with the given indices, without padding.
    pub fn chosen(&self, indices: &[usize]) -> Self {
        Self(
            self.0
                .each_ref()
                .map(|column| indices.iter().map(|&index| column[index]).collect()),
        )
    }

    /// Appends the same arms `count` times.
    pub fn extend(&mut self, arms: &[DVec2; LEGS], count: usize) {
        for (leg, arm) in arms.iter().enumerate() {
            for (column, value) in [(2 * leg, arm.x), (2 * leg + 1, arm.y)] {
                let length = self.0[column].len() + count;
                self.0[column].resize(length, value);
            }
        }
    }

    pub fn truncate(&mut self, count: usize) {
        self.0.iter_mut().for_each(|column| column.truncate(count));
    }

    /// Pads the columns to the length that loops read. The padding repeats the first arms, which changes no smallest
    /// value.
    pub fn pad(&mut self) {
        for column in &mut self.0 {
            column.resize(padded_length(column.len()), column.first().copied().unwrap_or(0.0));
        }
    }
}

/// The arms at poses: one orientation for all of them, or one for each.
enum PoseArms<'a> {
    Same(&'a [DVec2; LEGS]),
    Columns(&'a ArmColumns),
}

/// Computes the values at many poses.
struct AtPoses<'a, L> {
    checker: &'a PoseChecker<L>,
    xs: &'a [f64],
    ys: &'a [f64],
    arms: PoseArms<'a>,
    values: &'a mut ValueColumns,
}

impl<L: Leg> WithSimd for AtPoses<'_, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let (xs, ys) = (Lanes::<S>::column(self.xs), Lanes::<S>::column(self.ys));
        let zero = Lanes::all(simd, 0.0);
        let (mut arms, columns) = match self.arms {
            PoseArms::Same(arms) => (splat_arms(zero, arms), None),
            PoseArms::Columns(ArmColumns([x0, y0, x1, y1, x2, y2])) => {
                let pair = |x, y| (Lanes::<S>::column(x), Lanes::<S>::column(y));
                (
                    [Planar::new(zero, zero); LEGS],
                    Some([pair(x0, y0), pair(x1, y1), pair(x2, y2)]),
                )
            }
        };
        let computed = self.values.computed;
        let mut writer = self.values.writer::<S>();
        for group in 0..xs.len() {
            let position = Planar::new(Lanes::load(simd, &xs[group]), Lanes::load(simd, &ys[group]));
            if let Some([(x0, y0), (x1, y1), (x2, y2)]) = columns {
                arms = [
                    Planar::new(Lanes::load(simd, &x0[group]), Lanes::load(simd, &y0[group])),
                    Planar::new(Lanes::load(simd, &x1[group]), Lanes::load(simd, &y1[group])),
                    Planar::new(Lanes::load(simd, &x2[group]), Lanes::load(simd, &y2[group])),
                ];
            }
            let checker = self.checker;
            writer.put(group, &checker.core_lanes_with_clearance(position, &arms, computed));
            if !computed.on_demand().is_empty() {
                let mut scalars = PoseScalars::splat(zero);
                checker.fill_on_demand(computed, position, &arms, &mut scalars);
                writer.put_on_demand(group, &scalars);
            }
        }
    }
}

impl<L: Leg> PoseChecker<L> {
    /// Computes the values at many positions in one orientation. The columns have equal lengths, a multiple of
    /// [`MAX_LANES`].
    pub fn at_positions(&self, arms: &[DVec2; LEGS], xs: &[f64], ys: &[f64], values: &mut ValueColumns) {
        self.run_at_poses(xs, ys, PoseArms::Same(arms), values);
    }

    /// Computes the values at many poses, one for each entry of `positions` and `arms`, both padded.
    pub(crate) fn at_poses(&self, positions: &Positions, arms: &ArmColumns, values: &mut ValueColumns) {
        assert!(arms.0.iter().all(|column| column.len() == positions.xs.len()));
        self.run_at_poses(&positions.xs, &positions.ys, PoseArms::Columns(arms), values);
    }

    fn run_at_poses(&self, xs: &[f64], ys: &[f64], arms: PoseArms<'_>, values: &mut ValueColumns) {
        assert!(xs.len() == ys.len() && xs.len().is_multiple_of(MAX_LANES));
        values.resize(xs.len(), self.computed);
        self.instructions.run(AtPoses {
            checker: self,
            xs,
            ys,
            arms,
            values,
        });
    }

    /// Returns the values at one position in many orientations.
    pub(crate) fn in_orientations(&self, position: DVec2, arms: &ArmColumns) -> ValueColumns {
        let count = arms.0[0].len();
        let positions = Positions {
            xs: vec![position.x; count],
            ys: vec![position.y; count],
        };
        let mut values = ValueColumns::default();
        self.at_poses(&positions, arms, &mut values);
        values
    }
}
