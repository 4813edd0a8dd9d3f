//! Forms of the limits on stress, buckling, and the forces of joints and drives (docs/model.md, section 13.3).
//!
//! They are not written apart from the formulas of the evaluation, which are many: the same formulas run on enclosed numbers. What
//! these begin with, the legs and their compliances, is that of the other forms.

use super::{Detail, Enclosures, Forms};
use crate::enclosure::{EnclosedNumber, Interval, PlanarModel, TaylorModel};
use crate::evaluation::{Model, PoseScalar};
use crate::lanes::{Planar, Real};
use crate::mechanism::{Design, JointKind, LegEnclosure, LegFrameEnclosure};
use crate::spatial::LEGS;
use crate::strength::{LegLoadPath, LegStiffness, StrengthInputs, StrengthModel, StrengthSet, StrengthValue};

/// What the limits of the strength need of a design.
pub(super) struct StrengthForms {
    model: StrengthModel,
    limits: Vec<StrengthLimit>,
}

/// The limit of one scalar.
struct StrengthLimit {
    scalar: PoseScalar,
    value: StrengthValue,
    /// The largest demand that keeps it; `None` if no pose does.
    demand: Option<Interval>,
}

impl StrengthForms {
    /// Returns `None` if the study limits nothing that depends on loads.
    pub fn new(model: &Model, design: &Design) -> Option<Self> {
        let strength = model.strength_of(design)?;
        let limits: Vec<StrengthLimit> = model
            .thresholds_of(design)
            .iter()
            .filter_map(|(scalar, limit)| {
                let value = scalar.of_strength()?;
                Some(StrengthLimit {
                    scalar,
                    value,
                    demand: strength.demand_limit(value, limit),
                })
            })
            .collect();
        (!limits.is_empty()).then_some(Self {
            model: strength,
            limits,
        })
    }
}

impl Forms<'_> {
    /// Encloses what the loads of a leg follow from, of which the other forms have multiples of `L_b` and of `r`.
    fn load_path(&self, leg: &LegEnclosure, frame: &LegFrameEnclosure) -> LegLoadPath<EnclosedNumber> {
        let chain = &leg.chain;
        let lever = match self.design.architecture().actuator() {
            JointKind::Prismatic => Interval::exactly(1.0),
            JointKind::Revolute => frame.link,
        };
        let transmission = EnclosedNumber(leg.transmission_square).sqrt();
        let platform_radius = Interval::exactly(self.design.platform_radius());
        LegLoadPath {
            tangent: planar(chain.tangent),
            offset: EnclosedNumber(chain.offset.scaled(frame.link)),
            proximal: chain.proximal.map(|bar| {
                let share = bar.offset.scaled(Interval::exactly(1.0) / frame.proximal);
                (planar(bar.direction), EnclosedNumber(share))
            }),
            guides: chain.guides.map(|guide| guide.map(planar)),
            rail: chain.guides[0].map(|_| planar(frame.rail.axis().map(TaylorModel::constant))),
            u: planar(leg.u),
            moment: EnclosedNumber(leg.moment.scaled(platform_radius)),
            transmission: EnclosedNumber(transmission.0.scaled(lever)),
        }
    }

    /// Encloses by how much the demands of the strength are below their limits.
    pub(super) fn enclose_strength(&self, legs: &[LegEnclosure; LEGS], (detail, found): (Detail, &mut Enclosures)) {
        let Some(strength) = &self.strength else { return };
        let limits = strength.limits.iter();
        let open: Vec<&StrengthLimit> = limits.filter(|limit| found.needs(limit.scalar)).collect();
        let values = open.iter().map(|limit| limit.value);
        let set = values.fold(StrengthSet::default(), StrengthSet::with);
        if set.is_empty() {
            return;
        }
        let is_stress =
            |limit: &&&StrengthLimit| matches!(limit.value, StrengthValue::Stress | StrengthValue::SafetyFactor);
        let stress = open.iter().filter(is_stress);
        let kept = stress
            .filter_map(|limit| limit.demand)
            .map(|most| most.lower())
            .reduce(f64::min)
            .filter(|_| detail == Detail::Limits);
        let demands = strength.model.enclose(&self.load_inputs(legs), set, kept);
        for limit in open {
            let form = match limit.demand {
                Some(most) => TaylorModel::constant(most) - demands[limit.value as usize],
                None => TaylorModel::exactly(-1.0),
            };
            found.push(limit.scalar, form);
        }
    }

    /// Encloses what loads and motions follow from.
    pub(super) fn load_inputs(&self, legs: &[LegEnclosure; LEGS]) -> StrengthInputs<EnclosedNumber> {
        // Legs are large, and `map` would copy them.
        StrengthInputs {
            legs: [0, 1, 2].map(|i| self.load_path(&legs[i], &self.frames[i])),
            arms: [0, 1, 2].map(|i| planar(legs[i].arm.map(|part| part.scaled(self.frames[i].arm_length)))),
            along: [0, 1, 2].map(|i| EnclosedNumber(self.along_line(&legs[i], i).scaled(self.compliance.unit))),
            stiffness: [0, 1, 2].map(|i| self.stiffness_out_of_plane(&legs[i], i)),
        }
    }

    /// Encloses the compliance of a leg out of the plane in the axes of the distal bar, and returns the point relative to `C_i` at which it is:
    /// it varies little over a box in these axes, and at that point, force and moment are almost decoupled.
    pub(super) fn decoupled_bending(&self, leg: &LegEnclosure, index: usize) -> ([f64; 2], [TaylorModel; 6]) {
        let at = decoupled(&self.bending_in_distal_axes(leg, index, [0.0; 2]));
        (at, self.bending_in_distal_axes(leg, index, at))
    }

    /// Encloses the stiffness of a leg out of the plane: its compliance is inverted where force and moment are almost decoupled.
    fn stiffness_out_of_plane(&self, leg: &LegEnclosure, index: usize) -> LegStiffness<EnclosedNumber> {
        let frame = &self.frames[index];
        let (at, compliance) = self.decoupled_bending(leg, index);
        let compliance = compliance.map(EnclosedNumber);
        let stiffness = EnclosedNumber::symmetric_inverse(&compliance).map(|entry| entry.0);
        let (zero, one) = (TaylorModel::exactly(0.0), TaylorModel::exactly(1.0));
        let [tx, ty] = leg.chain.tangent;
        let at_centre = in_other_axes(&stiffness, [[one, zero, zero], [zero, tx, -ty], [zero, ty, tx]]);
        let arm = leg.arm.map(|part| part.scaled(frame.arm_length * frame.to_unit));
        let [x, y] = [
            arm[0] + tx.times(at[0]) - ty.times(at[1]),
            arm[1] + ty.times(at[0]) + tx.times(at[1]),
        ];
        let at_platform = in_other_axes(&at_centre, [[one, zero, zero], [y, one, zero], [-x, zero, one]]);
        let unit = Interval::exactly(1.0) / self.compliance.bending_unit;
        let in_newtons = |[a, b, c, d, e, f]: [TaylorModel; 6]| {
            let [lift, tilt] = [unit / frame.link.square(), unit / frame.link];
            [(a, lift), (b, tilt), (c, tilt), (d, unit), (e, unit), (f, unit)]
                .map(|(entry, unit)| EnclosedNumber(entry.scaled(unit)))
        };
        let centre = [x, y].map(|part| part.scaled(frame.link));
        LegStiffness {
            at_platform: in_newtons(at_platform),
            at_centre: Some((planar(centre), in_newtons(at_centre))),
        }
    }
}

/// Returns a stiffness for displacements of which the given columns are the images in those of the stiffness.
pub(super) fn in_other_axes(stiffness: &[TaylorModel; 6], columns: [[TaylorModel; 3]; 3]) -> [TaylorModel; 6] {
    let [a, b, c, d, e, f] = *stiffness;
    let applied = columns.map(|[p, q, r]| [a * p + b * q + c * r, b * p + d * q + e * r, c * p + e * q + f * r]);
    [[0, 0], [0, 1], [0, 2], [1, 1], [1, 2], [2, 2]].map(|[i, k]| {
        let ([p, q, r], [u, v, w]) = (columns[i], applied[k]);
        p * u + q * v + r * w
    })
}

/// Returns the point at which, in the middle of a box, a moment moves nothing along z; `C_i` if there is none.
fn decoupled(compliance: &[TaylorModel; 6]) -> [f64; 2] {
    let [_, b, c, d, e, f] = compliance.map(|entry| entry.constant);
    let determinant = d * f - e * e;
    let at = [(d * c - e * b) / determinant, (e * c - f * b) / determinant];
    if at.iter().all(|part| part.is_finite()) {
        at
    } else {
        [0.0; 2]
    }
}

pub(super) fn planar([x, y]: PlanarModel) -> Planar<EnclosedNumber> {
    Planar::new(EnclosedNumber(x), EnclosedNumber(y))
}
