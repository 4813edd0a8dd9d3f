//! Poses of a disc, stored in columns, and their places in the disc.

use glam::DVec2;

use crate::mechanism::Leg;
use crate::spatial::LEGS;
use crate::workspace::{ArmColumns, PoseChecker, Positions, ValueColumns};

/// Place of a pose in the disc.
#[derive(Clone, Copy)]
pub(super) struct DiscPose {
    pub orientation: usize,
    pub radius: f64,
    pub angle: f64,
    /// Distances to the neighbours with which it was laid out: along the radius \[m\] and in angle \[rad\].
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

    /// Returns the ratios of the stiffness at the poses to the thresholds: `k_xy`, `k_z`, `k_φz`.
    pub fn ratios<L: Leg>(&self, checker: &PoseChecker<L>, values: &mut ValueColumns) -> [Vec<f64>; 3] {
        self.values(checker, values);
        values.stiffness_ratios(&checker.thresholds, self.count)
    }
}
