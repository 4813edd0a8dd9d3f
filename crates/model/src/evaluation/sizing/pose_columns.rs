//! Poses of a region, stored in columns, and their places in the region.

use glam::DVec2;

use super::lightest::Ratios;
use crate::mechanism::Leg;
use crate::pose::PoseChecker;
use crate::spatial::LEGS;
use crate::workspace::{ArmColumns, Positions, ValueColumns};

/// Place of a pose in the region.
#[derive(Clone, Copy)]
pub(super) struct PlacedPose {
    pub orientation: usize,
    /// Distance from the centre \[m\] and direction \[rad\] in a disc; position relative to the centre \[m\] in a polygon.
    pub place: [f64; 2],
    /// Distances to the neighbours with which it was laid out, in the units of the place.
    pub spacing: [f64; 2],
    pub refined: bool,
}

/// Poses, stored in columns.
#[derive(Default)]
pub(super) struct PoseColumns {
    /// Number of poses, without padding.
    pub count: usize,
    pub positions: Positions,
    pub arms: ArmColumns,
}

impl PoseColumns {
    pub fn clear(&mut self) {
        self.count = 0;
        self.positions.clear();
        self.arms.clear();
    }

    pub fn push(&mut self, position: DVec2, arms: &[DVec2; LEGS]) {
        self.count += 1;
        self.positions.push(position);
        self.arms.push(arms);
    }

    /// Appends poses with the same arms at every position.
    pub fn extend(&mut self, positions: &[DVec2], arms: &[DVec2; LEGS]) {
        self.count += positions.len();
        self.positions.extend(positions);
        self.arms.extend(arms, positions.len());
    }

    /// Removes the padding of the columns.
    pub fn unpad(&mut self) {
        self.positions.truncate(self.count);
        self.arms.truncate(self.count);
    }

    pub fn pad(&mut self) {
        self.positions.pad();
        self.arms.pad();
    }

    /// Returns the poses with the given indices, padded.
    pub fn chosen(&self, poses: &[usize]) -> Self {
        let mut chosen = Self {
            count: poses.len(),
            positions: self.positions.chosen(poses),
            arms: self.arms.chosen(poses),
        };
        chosen.pad();
        chosen
    }

    /// Computes the values of the design in `checker` at the poses.
    pub fn values<L: Leg>(&self, checker: &PoseChecker<L>, values: &mut ValueColumns) {
        checker.at_poses(&self.positions, &self.arms, values);
    }

    /// Returns the ratios by which bars are sized at the poses ([`Ratios`]).
    pub fn ratios<L: Leg>(&self, checker: &PoseChecker<L>, values: &mut ValueColumns) -> Ratios {
        self.values(checker, values);
        values.bar_ratios(&checker.thresholds, self.count)
    }
}
