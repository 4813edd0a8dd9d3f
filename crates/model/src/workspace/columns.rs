//! Values that the constraints use, at many poses, stored in columns.

use glam::DVec2;
use pulp::{Simd, WithSimd};

use super::further::FurtherValues;
use super::{PoseChecker, PoseLanes, PoseValues, Thresholds};
use crate::clearance::NUMBER_LIMIT;
use crate::lanes::{Lanes, MAX_LANES, Planar, Real, padded_length};
use crate::mechanism::Leg;
use crate::spatial::LEGS;
use crate::stiffness::StiffnessValues;

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

    pub fn truncate(&mut self, count: usize) {
        self.xs.truncate(count);
        self.ys.truncate(count);
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

/// Values at many poses, one padded column for each quantity.
#[derive(Debug, Clone, Default)]
pub struct ValueColumns {
    /// 1 where every leg reaches the pose, 0 elsewhere; there only `limit_margin` is meaningful.
    reachable: Vec<f64>,
    limit_margin: Vec<f64>,
    determinant: Vec<f64>,
    inverse_condition: Vec<f64>,
    k_xy: Vec<f64>,
    k_z: Vec<f64>,
    k_phi_z: Vec<f64>,
    /// Empty if no clearance is required.
    clearance: Vec<f64>,
    /// Transmission and displacement; empty if no limit of further values is required.
    further: [Vec<f64>; 2],
}

impl ValueColumns {
    fn resize(&mut self, length: usize, thresholds: &Thresholds) {
        let length_if = |required: bool| if required { length } else { 0 };
        self.clearance.resize(length_if(thresholds.clearance.is_some()), 0.0);
        for column in &mut self.further {
            column.resize(length_if(thresholds.further.is_some()), 0.0);
        }
        for column in [
            &mut self.reachable,
            &mut self.limit_margin,
            &mut self.determinant,
            &mut self.inverse_condition,
            &mut self.k_xy,
            &mut self.k_z,
            &mut self.k_phi_z,
        ] {
            column.resize(length, 0.0);
        }
    }

    /// Returns the values of pose `index`.
    ///
    /// # Errors
    /// Returns the limit margin \[m\], which is at most 0, if a leg does not reach the pose.
    pub fn get(&self, index: usize) -> Result<PoseValues, f64> {
        if self.reachable[index] == 0.0 {
            // Where the distance is beyond the number range, `-NUMBER_LIMIT` is reported instead.
            let limit_margin = self.limit_margin[index];
            return Err(if limit_margin > -NUMBER_LIMIT {
                limit_margin.min(0.0)
            } else {
                -NUMBER_LIMIT
            });
        }
        Ok(PoseValues {
            limit_margin: self.limit_margin[index],
            determinant: self.determinant[index],
            inverse_condition: self.inverse_condition[index],
            stiffness_values: StiffnessValues {
                k_xy: self.k_xy[index],
                k_z: self.k_z[index],
                k_phi_z: self.k_phi_z[index],
            },
            clearance: self.clearance.get(index).copied(),
            further: self.further[0].get(index).map(|&transmission| FurtherValues {
                transmission,
                displacement: self.further[1][index],
            }),
        }
        .finite())
    }

    /// Returns the ratios of `k_xy`, `k_z` and `k_φz` to their thresholds at the first `count` poses, one column each.
    /// A ratio is `f64::MAX` where a leg does not reach the pose, because it is not the stiffness that is insufficient
    /// there.
    pub(crate) fn stiffness_ratios(&self, thresholds: &Thresholds, count: usize) -> [Vec<f64>; 3] {
        [
            (&self.k_xy, thresholds.k_xy),
            (&self.k_z, thresholds.k_z),
            (&self.k_phi_z, thresholds.k_phi_z),
        ]
        .map(|(column, threshold)| {
            column
                .iter()
                .zip(&self.reachable)
                .take(count)
                .map(|(value, reachable)| {
                    // If one operand is NaN, `max` returns the other one.
                    let fraction = (value / threshold.max(f64::MIN_POSITIVE)).max(0.0);
                    if *reachable > 0.0 {
                        fraction.min(f64::MAX)
                    } else {
                        f64::MAX
                    }
                })
                .collect()
        })
    }

    /// Returns the inverse condition numbers; meaningless where a leg does not reach the pose.
    pub(crate) fn inverse_conditions(&self) -> &[f64] {
        &self.inverse_condition
    }

    /// Returns the ratios of the displacement allowed to that at the first `count` poses, as [`Self::stiffness_ratios`] does
    /// for the stiffness; none if the study does not bound the displacement.
    pub(crate) fn displacement_ratios(&self, thresholds: &Thresholds, count: usize) -> Vec<f64> {
        let Some(limit) = thresholds.further.and_then(|further| further.displacement) else {
            return Vec::new();
        };
        let ratio = |(displacement, reachable): (&f64, &f64)| {
            if *reachable > 0.0 {
                (limit / displacement).min(f64::MAX)
            } else {
                f64::MAX
            }
        };
        self.further[1]
            .iter()
            .zip(&self.reachable)
            .take(count)
            .map(ratio)
            .collect()
    }

    #[inline(always)]
    fn writer<S: Simd>(&mut self) -> ColumnWriter<'_, S> {
        let [transmission, displacement] = &mut self.further;
        ColumnWriter {
            reachable: Lanes::<S>::column_mut(&mut self.reachable),
            limit_margin: Lanes::<S>::column_mut(&mut self.limit_margin),
            determinant: Lanes::<S>::column_mut(&mut self.determinant),
            inverse_condition: Lanes::<S>::column_mut(&mut self.inverse_condition),
            k_xy: Lanes::<S>::column_mut(&mut self.k_xy),
            k_z: Lanes::<S>::column_mut(&mut self.k_z),
            k_phi_z: Lanes::<S>::column_mut(&mut self.k_phi_z),
            clearance: Lanes::<S>::column_mut(&mut self.clearance),
            further: [transmission, displacement].map(|column| Lanes::<S>::column_mut(column)),
        }
    }
}

/// Part of a column that one step of a loop reads or writes.
type Group<S> = [<S as Simd>::f64s; 2];

struct ColumnWriter<'a, S: Simd> {
    reachable: &'a mut [Group<S>],
    limit_margin: &'a mut [Group<S>],
    determinant: &'a mut [Group<S>],
    inverse_condition: &'a mut [Group<S>],
    k_xy: &'a mut [Group<S>],
    k_z: &'a mut [Group<S>],
    k_phi_z: &'a mut [Group<S>],
    clearance: &'a mut [Group<S>],
    further: [&'a mut [Group<S>]; 2],
}

impl<S: Simd> ColumnWriter<'_, S> {
    #[inline(always)]
    fn put(&mut self, group: usize, values: PoseLanes<Lanes<S>>) {
        let (one, zero) = (values.limit_margin.splat(1.0), values.limit_margin.splat(0.0));
        one.select(values.reachable, zero).store(&mut self.reachable[group]);
        values.limit_margin.store(&mut self.limit_margin[group]);
        values.determinant.store(&mut self.determinant[group]);
        values.inverse_condition.store(&mut self.inverse_condition[group]);
        values.k_xy.store(&mut self.k_xy[group]);
        values.k_z.store(&mut self.k_z[group]);
        values.k_phi_z.store(&mut self.k_phi_z[group]);
        if let Some(clearance) = values.clearance {
            clearance.store(&mut self.clearance[group]);
        }
        if let Some(further) = values.further {
            further.transmission.store(&mut self.further[0][group]);
            further.displacement.store(&mut self.further[1][group]);
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
            PoseArms::Same(&[first, second, third]) => {
                let all = |arm| Planar::splat(zero, arm);
                ([all(first), all(second), all(third)], None)
            }
            PoseArms::Columns(ArmColumns([x0, y0, x1, y1, x2, y2])) => {
                let pair = |x, y| (Lanes::<S>::column(x), Lanes::<S>::column(y));
                (
                    [Planar::new(zero, zero); LEGS],
                    Some([pair(x0, y0), pair(x1, y1), pair(x2, y2)]),
                )
            }
        };
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
            writer.put(group, self.checker.lanes(position, &arms));
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
        values.resize(xs.len(), &self.thresholds);
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
