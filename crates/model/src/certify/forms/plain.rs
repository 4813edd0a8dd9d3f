//! The limits that take long to enclose, in plain numbers at a single pose.

use glam::DVec2;

use super::{Forms, ProvedForms};
use crate::enclosure::PoseEnclosure;
use crate::evaluation::PoseScalar;
use crate::lanes::Planar;
use crate::pose::{PoseScalars, ScalarSet, is_within};
use crate::spatial::Rotation;

impl Forms<'_> {
    /// Adds the limits that take long and that a pose, a box without width, keeps in plain numbers: no enclosure shows that it violates them,
    /// unless by less than the rounding of these numbers. It proves nothing, but almost all poses that are tried keep these limits.
    pub(super) fn with_those_kept_at(&self, proved: ProvedForms, pose: &PoseEnclosure) -> ProvedForms {
        let Some(checker) = &self.slow else { return proved };
        let is_open = |scalar: &PoseScalar| !proved.contains(*scalar);
        let open: ScalarSet = checker.slow_limits().iter().filter(is_open).collect();
        let [x, y] = pose.position.map(|coordinate| coordinate.constant);
        let direction = DVec2::new(pose.cosine.constant, pose.sine.constant);
        let arms = checker.manipulator.arms(&Rotation::by(direction));
        let mut scalars = PoseScalars::splat(f64::NAN);
        checker.fill_on_demand(open, Planar::new(x, y), &arms.map(Planar::from), &mut scalars);
        // What is not a number keeps no limit.
        let is_kept = |scalar: &PoseScalar| is_within(*scalar, scalars[*scalar], checker.thresholds.bound(*scalar));
        ProvedForms(proved.0.or(open.iter().filter(is_kept).collect()))
    }
}
