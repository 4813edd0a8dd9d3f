//! Scalar fields over poses.

use kinefront_model::evaluation::{Constraint, Model};
use kinefront_model::mechanism::Design;
use kinefront_model::stiffness::StiffnessDefinition;
use kinefront_model::workspace::PoseValues;

/// The quantity that a heatmap shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Field {
    /// `κ_F⁻¹`.
    InverseCondition,
    /// `k_xy` \[N/m\].
    StiffnessXy,
    /// `k_z` \[N/m\].
    StiffnessZ,
    /// `k_φz` \[N·m/rad\].
    StiffnessPhiZ,
    /// Displacement under the study's in-plane force in the most compliant direction \[m\].
    Displacement,
    /// Smallest relative margin of g2 … g6, and of g7 if the study requires a clearance.
    WorstMargin,
    /// Smallest clearance between members that are not joined \[m\]; negative where they overlap.
    Clearance,
    /// `det A / ℓ`, whose zeros are the parallel singularities.
    Determinant,
}

/// How a field's range is mapped to the colours of a colour map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Linear in the value.
    Linear,
    /// Linear in the logarithm of the value.
    Logarithmic,
}

impl Field {
    /// The fields that a user can select.
    pub const ALL: [Field; 7] = [
        Field::InverseCondition,
        Field::StiffnessXy,
        Field::StiffnessZ,
        Field::StiffnessPhiZ,
        Field::Displacement,
        Field::WorstMargin,
        Field::Clearance,
    ];

    /// Returns the field with a short name.
    pub fn find(key: &str) -> Option<Field> {
        Self::ALL.into_iter().find(|field| field.key() == key)
    }

    /// Returns the short name, as in entity paths and arguments.
    pub fn key(self) -> &'static str {
        match self {
            Field::InverseCondition => "inverse_condition",
            Field::StiffnessXy => "k_xy",
            Field::StiffnessZ => "k_z",
            Field::StiffnessPhiZ => "k_phi_z",
            Field::Displacement => "displacement",
            Field::WorstMargin => "worst_margin",
            Field::Clearance => "clearance",
            Field::Determinant => "determinant",
        }
    }

    /// Returns the display name with its unit.
    pub fn title(self) -> &'static str {
        match self {
            Field::InverseCondition => "inverse condition number",
            Field::StiffnessXy => "stiffness k_xy [N/m]",
            Field::StiffnessZ => "stiffness k_z [N/m]",
            Field::StiffnessPhiZ => "stiffness k_φz [N·m/rad]",
            Field::Displacement => "displacement under the in-plane force [mm]",
            Field::WorstMargin => "smallest relative margin of g2 … g7",
            Field::Clearance => "clearance between members [mm]",
            Field::Determinant => "det A / ℓ",
        }
    }

    /// Returns the factor from the SI unit to the unit of [`Field::title`].
    pub fn display_factor(self) -> f64 {
        match self {
            Field::Displacement | Field::Clearance => 1e3,
            _ => 1.0,
        }
    }

    /// Returns how the values are mapped to colours.
    pub fn scale(self) -> Scale {
        match self {
            Field::InverseCondition | Field::WorstMargin | Field::Clearance | Field::Determinant => Scale::Linear,
            Field::StiffnessXy | Field::StiffnessZ | Field::StiffnessPhiZ | Field::Displacement => Scale::Logarithmic,
        }
    }

    /// Returns the threshold: the value at which a pose ceases to be feasible.
    pub fn threshold(self, model: &Model) -> f64 {
        let thresholds = &model.thresholds;
        match self {
            Field::InverseCondition => thresholds.inverse_condition,
            Field::StiffnessXy => thresholds.k_xy,
            Field::StiffnessZ => thresholds.k_z,
            Field::StiffnessPhiZ => thresholds.k_phi_z,
            Field::Displacement => model.in_plane_force / thresholds.k_xy,
            Field::Clearance => thresholds.clearance.unwrap_or(0.0),
            Field::WorstMargin | Field::Determinant => 0.0,
        }
    }

    /// Returns the clearance threshold to check poses with; `None` if the field does not depend on the clearance, which
    /// is then not computed.
    pub(super) fn clearance(self, model: &Model) -> Option<f64> {
        match self {
            Field::Clearance => Some(self.threshold(model)),
            Field::WorstMargin => model.thresholds.clearance,
            _ => None,
        }
    }

    /// Returns the definition of the stiffness values that [`Field::value`] uses: the model's, except for a
    /// displacement, which is the compliance with the rotation left free.
    pub(super) fn definition(self, model: &Model) -> StiffnessDefinition {
        match self {
            Field::Displacement => StiffnessDefinition::Compliance,
            _ => model.stiffness_definition,
        }
    }

    /// Evaluates the field at a reachable pose. The value is finite: an unbounded displacement is limited to 1 km.
    pub(super) fn value(self, model: &Model, design: &Design, values: &PoseValues) -> f64 {
        const FARTHEST: f64 = 1e3;
        match self {
            Field::InverseCondition => values.inverse_condition,
            Field::Determinant => values.determinant,
            Field::Clearance => values.clearance.unwrap_or(0.0),
            Field::StiffnessXy => values.stiffness_values.k_xy,
            Field::StiffnessPhiZ => values.stiffness_values.k_phi_z,
            Field::StiffnessZ => values.stiffness_values.k_z,
            Field::Displacement => {
                let softest = values.stiffness_values.k_xy;
                if softest > model.in_plane_force / FARTHEST {
                    model.in_plane_force / softest
                } else {
                    FARTHEST
                }
            }
            Field::WorstMargin => {
                let margin = |constraint: Constraint| {
                    let threshold = constraint.least(&model.thresholds);
                    let value = constraint.value(values, 1.0)?;
                    Some(constraint.margin(value, threshold, design))
                };
                [
                    Constraint::Reach,
                    Constraint::Dexterity,
                    Constraint::StiffnessXy,
                    Constraint::StiffnessZ,
                    Constraint::StiffnessPhiZ,
                    Constraint::Clearance,
                ]
                .into_iter()
                .filter_map(margin)
                .fold(f64::INFINITY, f64::min)
            }
        }
    }
}

/// Computes the translational in-plane stiffness with the rotation left free, `[xx, xy, yy]` \[N/m\]: the inverse of
/// the xy block of `K⁻¹`. `None` if the stiffness against rotation is 0.
pub(super) fn free_stiffness(&[xx, xy, xm, yy, ym, mm]: &[f64; 6]) -> Option<[f64; 3]> {
    (mm > 0.0).then(|| [xx - xm * xm / mm, xy - xm * ym / mm, yy - ym * ym / mm])
}
