//! The constraints g1 … g6, the sign rule, and their margins (SPEC section 5).

use crate::mechanism::Design;
use crate::spatial::Pose;
use crate::workspace::{PoseValues, Thresholds};

/// One constraint of the study.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Constraint {
    /// g1: `L_b + r ≥ R/2`.
    Assembly,
    /// g2: least distance to a joint limit or to the end of reach ≥ 0.
    Reach,
    /// g3: `κ_F⁻¹`.
    Dexterity,
    /// g4: `k_xy`.
    StiffnessXy,
    /// g5: `k_z`.
    StiffnessZ,
    /// g6: `k_φz`.
    StiffnessPhiZ,
    /// One sign of `det A` over the workspace.
    DeterminantSign,
}

impl Constraint {
    /// All constraints, g1 first.
    pub const ALL: [Constraint; 7] = [
        Constraint::Assembly,
        Constraint::Reach,
        Constraint::Dexterity,
        Constraint::StiffnessXy,
        Constraint::StiffnessZ,
        Constraint::StiffnessPhiZ,
        Constraint::DeterminantSign,
    ];

    /// Short id, as in JSON and CSV.
    pub fn id(self) -> &'static str {
        match self {
            Constraint::Assembly => "g1",
            Constraint::Reach => "g2",
            Constraint::Dexterity => "g3",
            Constraint::StiffnessXy => "g4",
            Constraint::StiffnessZ => "g5",
            Constraint::StiffnessPhiZ => "g6",
            Constraint::DeterminantSign => "det_sign",
        }
    }

    /// Name, as in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Constraint::Assembly => "assembly",
            Constraint::Reach => "reach_and_limits",
            Constraint::Dexterity => "dexterity",
            Constraint::StiffnessXy => "stiffness_xy",
            Constraint::StiffnessZ => "stiffness_z",
            Constraint::StiffnessPhiZ => "stiffness_phi_z",
            Constraint::DeterminantSign => "determinant_sign",
        }
    }

    /// Unit of its value and threshold; empty for a number without one.
    pub fn unit(self) -> &'static str {
        match self {
            Constraint::Assembly | Constraint::Reach => "m",
            Constraint::Dexterity | Constraint::DeterminantSign => "",
            Constraint::StiffnessXy | Constraint::StiffnessZ => "N/m",
            Constraint::StiffnessPhiZ => "N·m/rad",
        }
    }

    /// The least value allowed.
    pub fn threshold(self, design: &Design, thresholds: &Thresholds) -> f64 {
        match self {
            Constraint::Assembly => 0.5 * design.base_radius,
            Constraint::Reach | Constraint::DeterminantSign => 0.0,
            Constraint::Dexterity => thresholds.inverse_condition,
            Constraint::StiffnessXy => thresholds.k_xy,
            Constraint::StiffnessZ => thresholds.k_z,
            Constraint::StiffnessPhiZ => thresholds.k_phi_z,
        }
    }

    /// Relative margin of a value: `(value − threshold)/threshold`; where the threshold is 0, the distance of g2 as a
    /// share of `R`, and `det A / ℓ` as it is. Negative where the constraint is broken.
    pub fn margin(self, value: f64, threshold: f64, design: &Design) -> f64 {
        match self {
            Constraint::Reach => value / design.base_radius,
            _ if threshold > 0.0 => (value - threshold) / threshold,
            _ => value - threshold,
        }
    }

    /// The value at a reachable pose, with `det A` counted positive in the sign of the home pose.
    pub fn value(self, design: &Design, values: &PoseValues, sign: f64) -> f64 {
        match self {
            Constraint::Assembly => design.link_length + design.platform_radius,
            Constraint::Reach => values.slack,
            Constraint::Dexterity => values.inverse_condition,
            Constraint::StiffnessXy => values.rigidity.k_xy,
            Constraint::StiffnessZ => values.rigidity.k_z,
            Constraint::StiffnessPhiZ => values.rigidity.k_phi_z,
            Constraint::DeterminantSign => sign * values.determinant,
        }
    }

    /// Whether a value satisfies the constraint: `det A` must not vanish, every other value may equal its threshold.
    pub fn holds(self, value: f64, threshold: f64) -> bool {
        match self {
            Constraint::DeterminantSign => value > threshold,
            _ => value >= threshold,
        }
    }
}

/// One constraint of one design: its smallest value over the regular workspace and where that is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConstraintReport {
    /// Which.
    pub constraint: Constraint,
    /// Smallest value; `None` where no pose is reachable at which there is one.
    pub value: Option<f64>,
    /// Least value allowed.
    pub threshold: f64,
    /// Relative margin ([`Constraint::margin`]); −1 where there is no value.
    pub margin: f64,
    /// Whether it is among those that fail first just beyond `R_w` in the home window; for an infeasible design, those
    /// that keep the best window from having a workspace.
    pub active: bool,
    /// Where the value was found; `None` for g1, which holds for the design as a whole.
    pub pose: Option<Pose>,
}
