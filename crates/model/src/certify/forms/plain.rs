//! The limits that take long to enclose, in plain numbers at a single pose.

use super::{Forms, ProvedForms};
use crate::evaluation::{Model, PoseScalar};
use crate::lanes::Planar;
use crate::mechanism::{AnyLeg, Design};
use crate::pose::{PoseChecker, PoseScalars, ScalarSet, is_within};
use crate::spatial::{Pose, Rotation};

/// What the limits that take long need of a design.
pub(super) struct PlainLimits {
    checker: PoseChecker<AnyLeg>,
    /// The scalars that are limited and take long.
    limited: ScalarSet,
}

impl PlainLimits {
    /// Returns `None` if the study limits nothing that takes long.
    pub fn new(model: &Model, design: &Design) -> Option<Self> {
        let thresholds = model.thresholds_of(design);
        let limited = thresholds.iter().map(|(scalar, _)| scalar);
        let limited: ScalarSet = limited.filter(|scalar| scalar.takes_long()).collect();
        (!limited.is_empty()).then(|| Self {
            checker: model.checker(design),
            limited,
        })
    }
}

impl Forms<'_> {
    /// Adds the limits that take long and that a pose keeps in plain numbers: no enclosure shows that it violates them, unless by less than
    /// the rounding of these numbers. It proves nothing, but almost all poses that are tried keep these limits.
    pub fn with_those_kept_at(&self, proved: ProvedForms, pose: &Pose) -> ProvedForms {
        let Some(plain) = &self.plain else { return proved };
        let open: ScalarSet = plain
            .limited
            .iter()
            .filter(|scalar| !proved.contains(*scalar))
            .collect();
        if open.is_empty() {
            return proved;
        }
        let checker = &plain.checker;
        let arms = checker.manipulator.arms(&Rotation::new(pose.phi));
        let mut scalars = PoseScalars::splat(f64::NAN);
        checker.fill_on_demand(open, pose.position.into(), &arms.map(Planar::from), &mut scalars);
        let limit = |scalar: PoseScalar| checker.thresholds.get(scalar);
        // What is not a number keeps no limit.
        let is_kept =
            |scalar: &PoseScalar| limit(*scalar).is_some_and(|limit| is_within(*scalar, scalars[*scalar], limit));
        ProvedForms(proved.0.or(open.iter().filter(is_kept).collect()))
    }
}
