//! The constraints g1 … g6 and the sign rule, their margins (SPEC section 5), and g7, which a study may ask for.

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
    /// g7: least clearance of bodies that are not joined, where the study asks for one.
    Clearance,
}

impl Constraint {
    /// All constraints: those of the paper, g1 first, then what a study may ask for besides.
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
            Constraint::Clearance => "g7",
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
            Constraint::Clearance => "clearance",
        }
    }

    /// Unit of its value and threshold; empty for a number without one.
    pub fn unit(self) -> &'static str {
        match self {
            Constraint::Assembly | Constraint::Reach | Constraint::Clearance => "m",
            Constraint::Dexterity | Constraint::DeterminantSign => "",
            Constraint::StiffnessXy | Constraint::StiffnessZ => "N/m",
            Constraint::StiffnessPhiZ => "N·m/rad",
        }
    }

    /// Whether it is asked for: g7 is by a study that states a clearance, all others are always.
    pub fn is_asked(self, thresholds: &Thresholds) -> bool {
        self != Constraint::Clearance || thresholds.clearance.is_some()
    }

    /// Those that are asked for.
    pub fn asked(thresholds: &Thresholds) -> impl Iterator<Item = Constraint> {
        Self::ALL
            .into_iter()
            .filter(|constraint| constraint.is_asked(thresholds))
    }

    /// The least value allowed; where g7 is not asked for, the 0 at which bodies touch.
    pub fn threshold(self, design: &Design, thresholds: &Thresholds) -> f64 {
        match self {
            Constraint::Assembly => 0.5 * design.base_radius,
            Constraint::Reach | Constraint::DeterminantSign => 0.0,
            Constraint::Dexterity => thresholds.inverse_condition,
            Constraint::StiffnessXy => thresholds.k_xy,
            Constraint::StiffnessZ => thresholds.k_z,
            Constraint::StiffnessPhiZ => thresholds.k_phi_z,
            Constraint::Clearance => thresholds.clearance.unwrap_or(0.0),
        }
    }

    /// Relative margin of a value: `(value − threshold)/threshold`; where the threshold is 0, `det A / ℓ` as it is; the
    /// distances of g2 and g7 beyond their thresholds as a share of `R`. Negative where the constraint is broken.
    pub fn margin(self, value: f64, threshold: f64, design: &Design) -> f64 {
        match self {
            Constraint::Reach | Constraint::Clearance => (value - threshold) / design.base_radius,
            _ if threshold > 0.0 => (value - threshold) / threshold,
            _ => value - threshold,
        }
    }

    /// The value at a reachable pose, with `det A` counted positive in the sign of the home pose; `None` where nobody
    /// asked for it.
    pub fn value(self, design: &Design, values: &PoseValues, sign: f64) -> Option<f64> {
        let value = match self {
            Constraint::Assembly => design.link_length + design.platform_radius,
            Constraint::Reach => values.slack,
            Constraint::Dexterity => values.inverse_condition,
            Constraint::StiffnessXy => values.rigidity.k_xy,
            Constraint::StiffnessZ => values.rigidity.k_z,
            Constraint::StiffnessPhiZ => values.rigidity.k_phi_z,
            Constraint::DeterminantSign => sign * values.determinant,
            Constraint::Clearance => return values.clearance,
        };
        Some(value)
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
    /// Whether the study asks for it. What is not asked for is never broken and never active.
    pub asked: bool,
    /// Relative margin ([`Constraint::margin`]); −1 where there is no value.
    pub margin: f64,
    /// Whether it is among those that fail first just beyond `R_w` in the home window; for an infeasible design, those
    /// that keep the best window from having a workspace.
    pub active: bool,
    /// Where the value was found; `None` for g1, which holds for the design as a whole.
    pub pose: Option<Pose>,
}

impl ConstraintReport {
    /// The margin, where the study asks for the constraint.
    pub fn asked_margin(&self) -> Option<f64> {
        self.asked.then_some(self.margin)
    }
}
