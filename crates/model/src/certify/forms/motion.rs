//! Forms of the limits on natural frequencies, errors of the pose, and the speeds and forces of actuators in motion (docs/model.md,
//! section 13.3). The formulas of the evaluation run on enclosed numbers, as those of the strength do.

use super::strength::{in_other_axes, planar};
use super::{Enclosures, Forms};
use crate::dynamics::{DynamicsInputs, DynamicsModel, MotionValue};
use crate::enclosure::{EnclosedNumber, Interval, PoseEnclosure, TaylorModel};
use crate::evaluation::{Model, PoseScalar};
use crate::mechanism::{Design, LegEnclosure};
use crate::spatial::{LEGS, inverse_factor};

/// What the limits of a motion need of a design.
pub(super) struct MotionForms {
    model: DynamicsModel,
    limits: Vec<(PoseScalar, MotionValue, f64)>,
}

impl MotionForms {
    /// Returns `None` if the study limits nothing of a motion.
    pub fn new(model: &Model, design: &Design) -> Option<Self> {
        let thresholds = model.thresholds_of(design);
        let limits = thresholds.iter();
        let limits: Vec<_> = limits
            .filter_map(|(scalar, limit)| Some((scalar, scalar.of_motion()?, limit)))
            .collect();
        if limits.is_empty() {
            return None;
        }
        Some(Self {
            model: model.dynamics_of(design)?,
            limits,
        })
    }
}

impl Forms<'_> {
    /// Encloses by how much the values of a motion keep their limits.
    pub(super) fn enclose_motion(&self, pose: &PoseEnclosure, legs: &[LegEnclosure; LEGS], found: &mut Enclosures) {
        let Some(motion) = &self.motion else { return };
        let open = |scalar: PoseScalar| found.needs(scalar);
        let open: Vec<_> = motion.limits.iter().filter(|(scalar, ..)| open(*scalar)).collect();
        if open.is_empty() {
            return;
        }
        let inputs = DynamicsInputs {
            position: planar(pose.position),
            legs: self.load_inputs(legs),
        };
        let legs = motion.model.legs(&inputs);
        for &&(scalar, value, limit) in &open {
            if !self.model.has(self.design, scalar) {
                found.push(scalar, TaylorModel::exactly(-1.0));
            } else if value == MotionValue::NaturalFrequency {
                let blocks = motion.model.enclose_stiffness_above(&inputs, &legs, limit);
                for form in blocks.into_iter().flat_map(minors) {
                    found.push(scalar, form);
                }
            } else {
                let limit = TaylorModel::constant(Interval::exactly(limit));
                for demand in motion.model.enclose(&inputs, &legs, value) {
                    found.push(scalar, limit - demand);
                }
            }
        }
    }
}

/// Encloses the leading minors of a symmetric matrix, given as an upper triangle, which are all positive where it is positive definite.
///
/// Differences of large products would lose the sign. The matrix is therefore brought near the identity first, by the Cholesky factor of
/// its middle, which changes no definiteness; a middle that has none is left as it is.
fn minors(matrix: [EnclosedNumber; 6]) -> [TaylorModel; 3] {
    let middle = matrix.map(|entry| entry.0.constant);
    let matrix = matrix.map(|entry| entry.0);
    let [a, b, c, d, e, f] = match inverse_factor(&middle) {
        Some(rows) => in_other_axes(&matrix, rows.map(|row| row.map(TaylorModel::exactly))),
        None => matrix,
    };
    [
        a,
        a * d - b * b,
        a * (d * f - e * e) - b * (b * f - c * e) + c * (b * e - c * d),
    ]
}
