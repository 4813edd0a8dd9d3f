//! The sections of a study file, each with the paper's values as defaults.

use serde::{Deserialize, Serialize};

use kinefront_model::evaluation::Model;
use kinefront_model::mechanism::{DESIGN_VARIABLES, Design, DesignVariable, TextError, WorkingMode};
use kinefront_model::stiffness::Material;
use kinefront_model::workspace::{Grid, GridError};

/// Material of every bar.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MaterialSection {
    /// Young's modulus `E`.
    pub youngs_modulus_pa: f64,
    /// Shear modulus `G`.
    pub shear_modulus_pa: f64,
    /// Density `ν`.
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
    /// Stiffness `K_act` of prismatic actuators.
    pub prismatic_stiffness_n_per_m: f64,
    /// Stiffness `K_act` of revolute actuators.
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

/// Requirements. The stiffness thresholds follow from a wrench and the accuracy required under it; a threshold that is
/// set directly takes precedence.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RequirementSection {
    /// Smallest permitted inverse condition number `κ_F⁻¹` (g3).
    pub inverse_condition_min: f64,
    /// Force in the plane, in any direction.
    pub in_plane_force_n: f64,
    /// Largest permitted displacement under this force.
    pub in_plane_displacement_m: f64,
    /// Force along z.
    pub vertical_force_n: f64,
    /// Largest permitted displacement under this force.
    pub vertical_displacement_m: f64,
    /// Torque about z.
    pub torque_z_nm: f64,
    /// Largest permitted rotation under this torque.
    pub rotation_z_deg: f64,
    /// Threshold of g4, if it is set directly.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub k_xy_min_n_per_m: Option<f64>,
    /// Threshold of g5, if it is set directly.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub k_z_min_n_per_m: Option<f64>,
    /// Threshold of g6, if it is set directly.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub k_phi_z_min_nm_per_rad: Option<f64>,
    /// Threshold of g7: smallest permitted clearance of members that are not joined; if omitted, they may collide.
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

/// Required regular workspace.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WorkspaceSection {
    /// Rotation range `Δφ`.
    pub rotation_range_deg: f64,
    /// Centre of the disc.
    pub centre_m: [f64; 2],
    /// Home orientation; if omitted, the best one is determined for each design.
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

/// Definition of the stiffness values `k_xy`, `k_z` and `k_φz`: from `K` or from `K⁻¹`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StiffnessChoice {
    /// Values from the blocks of `K`.
    Stiffness,
    /// Values from the inverses of the blocks of `K⁻¹`.
    Compliance,
}

/// Definition of the characteristic length.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LengthChoice {
    /// The platform radius `r`.
    PlatformRadius,
    /// The isotropic length `√2·max|w|`.
    Isotropic,
    /// The value of the key `characteristic_length_m`.
    Fixed,
}

/// Definition of the beam length of a telescopic leg.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TelescopicBar {
    /// The current leg length `ρ_i`.
    Current,
    /// The longest leg length `L_b`.
    Longest,
}

/// Modelling choices that the paper leaves open or states inconsistently (docs/model.md, section 11).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ModelSection {
    /// Definition of the stiffness values.
    pub stiffness_definition: StiffnessChoice,
    /// Definition of the characteristic length.
    pub characteristic_length: LengthChoice,
    /// Value of a fixed characteristic length.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub characteristic_length_m: Option<f64>,
    /// Number of bars of length `r` in the mass of the platform: 3, or 1 as printed in the paper.
    pub platform_bars: u32,
    /// Definition of the beam length of a telescopic leg.
    pub telescopic_bar: TelescopicBar,
    /// Length of the shortest telescopic leg as a fraction of `L_b`.
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

/// Bounds of the design variables in the search, as `[lower, upper]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[allow(non_snake_case, reason = "keys are the paper's symbols")]
pub struct Bounds {
    /// Base radius `R`.
    pub R_m: [f64; 2],
    /// Platform radius `r`.
    pub r_m: [f64; 2],
    /// Link length `L_b`.
    pub Lb_m: [f64; 2],
    /// Radius `r_j` of the leg bars.
    pub rj_m: [f64; 2],
    /// Radius `r_p` of the platform bars.
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
    /// Returns the range of a variable.
    pub fn range(&self, variable: DesignVariable) -> [f64; 2] {
        match variable {
            DesignVariable::BaseRadius => self.R_m,
            DesignVariable::PlatformRadius => self.r_m,
            DesignVariable::LinkLength => self.Lb_m,
            DesignVariable::LegBarRadius => self.rj_m,
            DesignVariable::PlatformBarRadius => self.rp_m,
        }
    }

    /// Iterates over the variables, each with the key of its range.
    pub fn keys() -> impl Iterator<Item = (DesignVariable, String)> {
        DESIGN_VARIABLES
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
    /// Number of directions over the full turn.
    pub directions: usize,
    /// Number of steps of a ray per length `R`.
    pub ray_steps: usize,
    /// Number of halvings of the first failing step of a ray.
    pub halvings: u32,
}

impl From<Grid> for GridSection {
    fn from(grid: Grid) -> Self {
        Self {
            phi_step_deg: grid.phi_step_deg(),
            directions: grid.directions(),
            ray_steps: grid.ray_steps(),
            halvings: grid.halvings(),
        }
    }
}

impl TryFrom<&GridSection> for Grid {
    type Error = GridError;

    fn try_from(section: &GridSection) -> Result<Self, GridError> {
        Grid::new(
            section.phi_step_deg,
            section.directions,
            section.ray_steps,
            section.halvings,
        )
    }
}

/// Grids for the search and for the verification.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Grids {
    /// Reference grid, used in the search.
    pub reference: GridSection,
    /// Fine grid, on which reported designs are verified.
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

/// A reference design to compare with, shown as a mark beside the front.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReferenceDesign {
    /// Name of the design.
    pub name: String,
    /// The design as text.
    pub design: String,
    /// Mass as stated by the source of the design.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass_kg: Option<f64>,
    /// Workspace radius `R_w` as stated by the source of the design.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub workspace_radius_m: Option<f64>,
}

impl ReferenceDesign {
    /// Parses the design; `default_mode` is used if the text does not name a working mode.
    ///
    /// # Errors
    /// [`TextError`]; this does not occur for a study that was read without faults.
    pub fn parse(&self, default_mode: WorkingMode) -> Result<Design, TextError> {
        Design::parse(&self.design, default_mode)
    }
}
