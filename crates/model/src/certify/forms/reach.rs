//! Form of a limit of the distance to the joint limits (docs/model.md, section 13.3).
//!
//! Where no limit is stated, the forms of the reach tell only its sign. The distance itself is that of the evaluation, whose formulas
//! run on enclosed numbers.

use super::strength::planar;
use super::{Enclosures, Forms};
use crate::enclosure::{Interval, PoseEnclosure};
use crate::evaluation::{Model, PoseScalar};
use crate::mechanism::{AnyLeg, Design, Leg, LegEnclosure, Manipulator};
use crate::spatial::LEGS;

/// Part of the size of a design by which the directions of its frame may be off: they are rounded numbers of about 1.
const OF_FRAMES: f64 = 1e-13;

/// What the limit needs of a design.
pub(super) struct ReachForms {
    legs: [AnyLeg; LEGS],
    limit: f64,
    /// By how much a distance may be off because of the rounded frames \[m\].
    slack: f64,
}

impl ReachForms {
    /// Returns `None` if the study states no such limit.
    pub fn new(model: &Model, design: &Design) -> Option<Self> {
        let limit = model.settings().thresholds.get(PoseScalar::Reach)?;
        Some(Self {
            limit,
            ..Self::without_limit(model, design)
        })
    }

    /// Returns what the distance itself needs.
    pub fn without_limit(model: &Model, design: &Design) -> Self {
        Self {
            legs: Manipulator::new(design, &model.settings().legs).legs,
            limit: 0.0,
            slack: OF_FRAMES * model.extent(design),
        }
    }
}

impl Forms<'_> {
    /// Encloses the distance to the joint limits less its limit.
    pub(super) fn enclose_reach(&self, pose: &PoseEnclosure, legs: &[LegEnclosure; LEGS], found: &mut Enclosures) {
        let Some(reach) = &self.reach else { return };
        let position = planar(pose.position);
        for (index, leg) in reach.legs.iter().enumerate() {
            let arm = legs[index].arm.map(|part| part.scaled(self.frames[index].arm_length));
            let margin = leg.lanes(position, planar(arm)).chain.limit_margin;
            let off = Interval::new(-reach.slack, reach.slack) - Interval::exactly(reach.limit);
            found.push(PoseScalar::Reach, margin.0.plus(off));
        }
    }
}
