//! Constraints g1 … g6, the sign rule, and g7, which a study may require; their values and margins (docs/model.md,
//! section 6).

use crate::mechanism::{Assembly, Design};
use crate::spatial::Pose;
use crate::workspace::{PoseValues, Thresholds};

/// One constraint of the study.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Constraint {
    /// g1: a leg and the platform bridge the distance from the base to `O`, for example `L_b + r ≥ R/2`.
    Assembly,
    /// g2: limit margin (smallest distance to a joint limit or to the end of reach) ≥ 0.
    Reach,
    /// g3: `κ_F⁻¹`.
    Dexterity,
    /// g4: `k_xy`.
    StiffnessXy,
    /// g5: `k_z`.
    StiffnessZ,
    /// g6: `k_φz`.
    StiffnessPhiZ,
    /// Sign rule: `det A` keeps one sign over the workspace.
    DeterminantSign,
    /// g7: smallest clearance between members that are not joined, if the study requires a clearance.
    Clearance,
}

impl Constraint {
    /// All constraints: those of the paper, beginning with g1, then the one that a study may require in addition.
    pub const ALL: [Constraint; 8] = [
        Constraint::Assembly,
        Constraint::Reach,
        Constraint::Dexterity,
        Constraint::StiffnessXy,
        Constraint::StiffnessZ,
        Constraint::StiffnessPhiZ,
        Constraint::DeterminantSign,
        Constraint::Clearance,
    ];

    /// Returns the short id, as in JSON and CSV.
    pub fn id(self) -> &'static str {
        match self {
            Constraint::Assembly => "g1",
            Constraint::Reach => "g2",
            Constraint::Dexterity => "g3",
            Constraint::StiffnessXy => "g4",
            Constraint::StiffnessZ => "g5",
            Constraint::StiffnessPhiZ => "g6",
            Constraint::DeterminantSign => "det_sign",
            Constraint::Clearance => "g7",
        }
    }

    /// Returns the name, as in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Constraint::Assembly => "assembly",
            Constraint::Reach => "reach_and_limits",
            Constraint::Dexterity => "dexterity",
            Constraint::StiffnessXy => "stiffness_xy",
            Constraint::StiffnessZ => "stiffness_z",
            Constraint::StiffnessPhiZ => "stiffness_phi_z",
            Constraint::DeterminantSign => "determinant_sign",
            Constraint::Clearance => "clearance",
        }
    }

    /// Returns the unit of the value and the threshold; empty for a dimensionless number.
    pub fn unit(self) -> &'static str {
        match self {
            Constraint::Assembly | Constraint::Reach | Constraint::Clearance => "m",
            Constraint::Dexterity | Constraint::DeterminantSign => "",
            Constraint::StiffnessXy | Constraint::StiffnessZ => "N/m",
            Constraint::StiffnessPhiZ => "N·m/rad",
        }
    }

    /// Returns whether the constraint is required: g7 is required if the study states a clearance, all others always
    /// are.
    pub fn is_required(self, thresholds: &Thresholds) -> bool {
        self != Constraint::Clearance || thresholds.clearance.is_some()
    }

    /// Returns the constraints that are required.
    pub fn required(thresholds: &Thresholds) -> impl Iterator<Item = Constraint> {
        Self::ALL
            .into_iter()
            .filter(|constraint| constraint.is_required(thresholds))
    }

    /// Returns the smallest value allowed; if g7 is not required, its threshold is 0, at which members touch.
    pub fn threshold(self, assembly: &Assembly, thresholds: &Thresholds) -> f64 {
        match self {
            Constraint::Assembly => assembly.threshold,
            _ => self.least(thresholds),
        }
    }

    /// Returns the smallest value that a constraint allows at a pose; 0 for those without a threshold of the study.
    pub fn least(self, thresholds: &Thresholds) -> f64 {
        match self {
            Constraint::Assembly | Constraint::Reach | Constraint::DeterminantSign => 0.0,
            Constraint::Dexterity => thresholds.inverse_condition,
            Constraint::StiffnessXy => thresholds.k_xy,
            Constraint::StiffnessZ => thresholds.k_z,
            Constraint::StiffnessPhiZ => thresholds.k_phi_z,
            Constraint::Clearance => thresholds.clearance.unwrap_or(0.0),
        }
    }

    /// Returns the relative margin of a value, which is negative where the constraint is violated. It is
    /// `(value − threshold)/threshold`, except for g2 and g7, whose excess over the threshold is divided by `R`, and
    /// for a threshold of 0, where it is the value itself, such as `det A / ℓ`.
    pub fn margin(self, value: f64, threshold: f64, design: &Design) -> f64 {
        match self {
            Constraint::Reach | Constraint::Clearance => (value - threshold) / design.base_radius,
            _ if threshold > 0.0 => (value - threshold) / threshold,
            _ => value - threshold,
        }
    }

    /// Returns the value at a reachable pose, with `det A / ℓ` multiplied by `sign`, that of the home pose; `None` for g1, which
    /// applies to a design as a whole, and for a clearance that was not computed because it is not required.
    pub fn value(self, values: &PoseValues, sign: f64) -> Option<f64> {
        let value = match self {
            Constraint::Assembly => return None,
            Constraint::Reach => values.limit_margin,
            Constraint::Dexterity => values.inverse_condition,
            Constraint::StiffnessXy => values.stiffness_values.k_xy,
            Constraint::StiffnessZ => values.stiffness_values.k_z,
            Constraint::StiffnessPhiZ => values.stiffness_values.k_phi_z,
            Constraint::DeterminantSign => sign * values.determinant,
            Constraint::Clearance => return values.clearance,
        };
        Some(value)
    }

    /// Returns whether a value satisfies the constraint: `det A` must not vanish, every other value may equal its
    /// threshold.
    pub fn holds(self, value: f64, threshold: f64) -> bool {
        match self {
            Constraint::DeterminantSign => value > threshold,
            _ => value >= threshold,
        }
    }
}

/// One constraint of one design: its smallest value over the regular workspace, and the pose at which it occurs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConstraintResult {
    /// The constraint.
    pub constraint: Constraint,
    /// Smallest value; `None` if no reachable pose has one.
    pub value: Option<f64>,
    /// Smallest value allowed.
    pub threshold: f64,
    /// Whether the study requires the constraint. A constraint that is not required is never violated and never active.
    pub required: bool,
    /// Relative margin ([`Constraint::margin`]); −1 if there is no value.
    pub margin: f64,
    /// Whether the constraint is among those that fail first just beyond `R_w` in the home window; for an infeasible
    /// design, among those that prevent the best window from having a workspace.
    pub active: bool,
    /// Pose at which the value occurs; `None` for g1, which applies to the design as a whole.
    pub pose: Option<Pose>,
}

impl ConstraintResult {
    /// Returns the margin, if the study requires the constraint.
    pub fn required_margin(&self) -> Option<f64> {
        self.required.then_some(self.margin)
    }
}
