//! The sections of a study file, each with the paper's values as its default.

use serde::{Deserialize, Serialize};

use kinefront_model::evaluation::Model;
use kinefront_model::mechanism::{Design, TextError, VARIABLES, Variable, WorkingMode};
use kinefront_model::stiffness::Material;
use kinefront_model::workspace::Grid;

/// Material of every bar.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MaterialSection {
    /// `E`.
    pub youngs_modulus_pa: f64,
    /// `G`.
    pub shear_modulus_pa: f64,
    /// `ν`.
    pub density_kg_per_m3: f64,
}

impl Default for MaterialSection {
    fn default() -> Self {
        Self {
            youngs_modulus_pa: Material::STEEL.youngs_modulus,
            shear_modulus_pa: Material::STEEL.shear_modulus,
            density_kg_per_m3: Material::STEEL.density,
        }
    }
}

/// Stiffness of the actuators.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ActuatorSection {
    /// `K_act` of prismatic actuators.
    pub prismatic_stiffness_n_per_m: f64,
    /// `K_act` of revolute actuators.
    pub revolute_stiffness_nm_per_rad: f64,
}

impl Default for ActuatorSection {
    fn default() -> Self {
        let actuators = Model::default().actuators;
        Self {
            prismatic_stiffness_n_per_m: actuators.prismatic,
            revolute_stiffness_nm_per_rad: actuators.revolute,
        }
    }
}

/// Wrench and accuracy, from which the stiffness thresholds follow; a threshold given outright wins.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RequirementSection {
    /// Least `κ_F⁻¹` (g3).
    pub inverse_condition_min: f64,
    /// Force in the plane, in any direction.
    pub in_plane_force_n: f64,
    /// Displacement it may cause.
    pub in_plane_displacement_m: f64,
    /// Force along z.
    pub vertical_force_n: f64,
    /// Displacement it may cause.
    pub vertical_displacement_m: f64,
    /// Torque about z.
    pub torque_z_nm: f64,
    /// Rotation it may cause.
    pub rotation_z_deg: f64,
    /// Threshold of g4 outright.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub k_xy_min_n_per_m: Option<f64>,
    /// Threshold of g5 outright.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub k_z_min_n_per_m: Option<f64>,
    /// Threshold of g6 outright.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub k_phi_z_min_nm_per_rad: Option<f64>,
    /// Threshold of g7: least clearance of bodies that are not joined; they may collide where it is left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance_min_m: Option<f64>,
}

impl Default for RequirementSection {
    fn default() -> Self {
        Self {
            inverse_condition_min: 0.1,
            in_plane_force_n: 100.0,
            in_plane_displacement_m: 1e-4,
            vertical_force_n: 100.0,
            vertical_displacement_m: 1e-3,
            torque_z_nm: 10.0,
            rotation_z_deg: 1.0,
            k_xy_min_n_per_m: None,
            k_z_min_n_per_m: None,
            k_phi_z_min_nm_per_rad: None,
            clearance_min_m: None,
        }
    }
}

/// The regular workspace asked for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WorkspaceSection {
    /// `Δφ`.
    pub rotation_range_deg: f64,
    /// Centre of the disc.
    pub centre_m: [f64; 2],
    /// Home orientation; the best one where it is left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub home_phi_deg: Option<f64>,
}

impl Default for WorkspaceSection {
    fn default() -> Self {
        Self {
            rotation_range_deg: 20.0,
            centre_m: [0.0, 0.0],
            home_phi_deg: None,
        }
    }
}

/// `k_xy`, `k_z`, `k_φz` from `K` or from `K⁻¹`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StiffnessChoice {
    /// Blocks of `K`.
    Stiffness,
    /// Inverses of blocks of `K⁻¹`.
    Compliance,
}

/// Characteristic length.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LengthChoice {
    /// `r`.
    PlatformRadius,
    /// `√2·max|w|`.
    Isotropic,
    /// `characteristic_length_m`.
    Fixed,
}

/// Beam length of a telescopic leg.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TelescopicBar {
    /// `ρ_i`.
    Current,
    /// `L_b`.
    Longest,
}

/// Choices where the paper is silent or contradicts itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ModelSection {
    /// Definition of the stiffness values.
    pub stiffness_definition: StiffnessChoice,
    /// Kind of characteristic length.
    pub characteristic_length: LengthChoice,
    /// Its value where it is fixed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub characteristic_length_m: Option<f64>,
    /// Bars of length `r` in the platform's mass: 3, or 1 as the paper prints it.
    pub platform_bars: u32,
    /// Beam length of a telescopic leg.
    pub telescopic_bar: TelescopicBar,
    /// Shortest telescopic leg as a share of `L_b`.
    pub telescopic_shortest: f64,
}

impl Default for ModelSection {
    fn default() -> Self {
        Self {
            stiffness_definition: StiffnessChoice::Stiffness,
            characteristic_length: LengthChoice::PlatformRadius,
            characteristic_length_m: None,
            platform_bars: 3,
            telescopic_bar: TelescopicBar::Current,
            telescopic_shortest: 0.5,
        }
    }
}

/// Ranges that the optimizer searches, `[lower, upper]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[allow(non_snake_case, reason = "keys are the paper's symbols")]
pub struct Bounds {
    /// `R`.
    pub R_m: [f64; 2],
    /// `r`.
    pub r_m: [f64; 2],
    /// `L_b`.
    pub Lb_m: [f64; 2],
    /// `r_j`.
    pub rj_m: [f64; 2],
    /// `r_p`.
    pub rp_m: [f64; 2],
}

impl Default for Bounds {
    fn default() -> Self {
        Self {
            R_m: [0.5, 4.0],
            r_m: [0.1, 4.0],
            Lb_m: [0.5, 4.0],
            rj_m: [0.0, 0.1],
            rp_m: [0.0, 0.1],
        }
    }
}

impl Bounds {
    /// The range of one variable.
    pub fn range(&self, variable: Variable) -> [f64; 2] {
        match variable {
            Variable::BaseRadius => self.R_m,
            Variable::PlatformRadius => self.r_m,
            Variable::LinkLength => self.Lb_m,
            Variable::LegBarRadius => self.rj_m,
            Variable::PlatformBarRadius => self.rp_m,
        }
    }

    /// Each variable with the key of its range.
    pub fn keys() -> impl Iterator<Item = (Variable, String)> {
        VARIABLES
            .into_iter()
            .map(|variable| (variable, format!("{}_m", variable.key())))
    }
}

/// One sampling grid.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GridSection {
    /// Spacing of orientations.
    pub phi_step_deg: f64,
    /// Directions over the full turn.
    pub directions: usize,
    /// Steps of a ray per `R`.
    pub ray_steps: usize,
    /// Halvings of the failing step.
    pub halvings: u32,
}

impl From<Grid> for GridSection {
    fn from(grid: Grid) -> Self {
        Self {
            phi_step_deg: grid.phi_step_deg,
            directions: grid.directions,
            ray_steps: grid.ray_steps,
            halvings: grid.halvings,
        }
    }
}

impl From<&GridSection> for Grid {
    fn from(section: &GridSection) -> Self {
        Self {
            phi_step_deg: section.phi_step_deg,
            directions: section.directions,
            ray_steps: section.ray_steps,
            halvings: section.halvings,
        }
    }
}

/// Grids for searching and for verifying.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Grids {
    /// Designs are searched on this one.
    pub reference: GridSection,
    /// What is reported is verified on this one.
    pub fine: GridSection,
}

impl Default for Grids {
    fn default() -> Self {
        Self {
            reference: Grid::REFERENCE.into(),
            fine: Grid::FINE.into(),
        }
    }
}

/// A design to compare with: it stands as a mark beside the front.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReferenceDesign {
    /// What it is called.
    pub name: String,
    /// The design as text.
    pub design: String,
    /// Mass as its source states it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass_kg: Option<f64>,
    /// `R_w` as its source states it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub workspace_radius_m: Option<f64>,
}

impl ReferenceDesign {
    /// The design; `default_mode` holds where the text names no working mode.
    ///
    /// # Errors
    /// [`TextError`]; a study that was read without faults has none.
    pub fn parse(&self, default_mode: WorkingMode) -> Result<Design, TextError> {
        Design::parse(&self.design, default_mode)
    }
}
