//! The sections of a study file, each with the paper's values as defaults.

use serde::{Deserialize, Serialize};

use super::RegionSection;
use super::declare::{Check, Initial, section};
use kinefront_model::evaluation::Quantity;
use kinefront_model::mechanism::{
    Architecture, Arrangement, CrossSection, DESIGN_VARIABLES, Design, DesignVariable, FURTHER_VARIABLES, TextError,
    WorkingMode,
};
use kinefront_model::spatial::LEGS;
use kinefront_model::stiffness::{RailSettings, RailSupports};

/// Support of the rails of the base.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RailSupportChoice {
    /// Supports that hold position and slope.
    Clamped,
    /// Supports that hold the position alone, at both ends.
    Pinned,
}

section! {
    /// Rails of the base, on which the sliders of PRR, PRP and PPR legs move.
    pub struct RailSection in "rails" {
        /// What the supports of a rail hold: position and slope (`clamped`), or the position alone (`pinned`).
        supports: RailSupportChoice = RailSupportChoice::Clamped, Check::Choice(&["clamped", "pinned"]);
        /// Number of equally long spans between the supports of a rail.
        spans: u32 = 1, Check::Count(1, 100);
        optional {
            /// Outer radius of a rail, or half of its outer width; if omitted, rails are rigid and have no mass.
            radius_m: f64, Check::Within(1e-4, 10.0, ", or be omitted if rails are rigid"), Initial::Number(0.03);
        }
    }
}

section! {
    /// Stiffness of the actuators.
    pub struct ActuatorSection in "actuators" {
        /// Stiffness `K_act` of prismatic actuators.
        prismatic_stiffness_n_per_m: f64 = 1e7, Check::Positive;
        /// Stiffness `K_act` of revolute actuators.
        revolute_stiffness_nm_per_rad: f64 = 1e7, Check::Positive;
    }
}

section! {
    /// Requirements. The stiffness thresholds follow from a wrench and the accuracy required under it; a threshold that is
    /// set directly takes precedence.
    pub struct RequirementSection in "requirements" {
        /// Smallest permitted inverse condition number `κ_F⁻¹` (g3).
        inverse_condition_min: f64 = 0.1, Check::HalfOpen(0.0, 1.0);
        /// Force in the plane, in any direction (g4).
        in_plane_force_n: f64 = 100.0, Check::Positive;
        /// Largest permitted displacement under the force in the plane.
        in_plane_displacement_m: f64 = 1e-4, Check::Positive;
        /// Force along z (g5).
        vertical_force_n: f64 = 100.0, Check::Positive;
        /// Largest permitted displacement under the force along z.
        vertical_displacement_m: f64 = 1e-3, Check::Positive;
        /// Torque about z (g6).
        torque_z_nm: f64 = 10.0, Check::Positive;
        /// Largest permitted rotation under the torque about z.
        rotation_z_deg: f64 = 1.0, Check::Positive;
        optional {
            /// Threshold of g4, if it is set directly.
            k_xy_min_n_per_m: f64, Check::NonNegative, Initial::Number(1e6);
            /// Threshold of g5, if it is set directly.
            k_z_min_n_per_m: f64, Check::NonNegative, Initial::Number(1e5);
            /// Threshold of g6, if it is set directly.
            k_phi_z_min_nm_per_rad: f64, Check::NonNegative, Initial::Number(573.0);
            /// Threshold of g7: smallest permitted clearance between members that are not joined; if omitted, they may collide.
            clearance_min_m: f64, Check::Within(0.0, 1e3, ", or be omitted if members may collide"), Initial::Number(0.005);
        }
    }
}

section! {
    /// Required regular workspace.
    pub struct WorkspaceSection in "workspace" {
        /// Rotation range `Δφ`.
        rotation_range_deg: f64 = 20.0, Check::Within(0.0, 350.0, "");
        /// Centre of the disc, in the base frame.
        centre_m: [f64; 2] = [0.0, 0.0], Check::Finite;
        /// Whether the workspaces of the front are proved, so that the reported radii hold for every pose.
        certify: bool = true, Check::Any;
        optional {
            /// Home orientation; if omitted, the best one is determined for each design.
            home_phi_deg: f64, Check::Within(-360.0, 360.0, ""), Initial::Number(0.0);
        }
        nested {
            /// Region of positions.
            region: RegionSection;
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

section! {
    /// Modelling choices that the paper leaves open or states inconsistently (docs/model.md, section 11).
    pub struct ModelSection in "model" {
        /// Definition of the stiffness values: from the blocks of `K`, or from the inverses of the blocks of `K⁻¹`.
        stiffness_definition: StiffnessChoice = StiffnessChoice::Stiffness, Check::Choice(&["stiffness", "compliance"]);
        /// Definition of the characteristic length; `fixed` requires `characteristic_length_m`.
        characteristic_length: LengthChoice = LengthChoice::PlatformRadius,
            Check::Choice(&["platform_radius", "isotropic", "fixed"]);
        /// Number of bars of length `r` in the mass of the platform: 3, or 1 as printed in the paper.
        platform_bars: u32 = 3, Check::Count(1, 3);
        /// Beam length of a telescopic leg: its current length, or its longest length `L_b`.
        telescopic_bar: TelescopicBar = TelescopicBar::Current, Check::Choice(&["current", "longest"]);
        /// Length of the shortest telescopic leg as a fraction of `L_b`.
        telescopic_shortest: f64 = 0.5, Check::HalfOpen(0.0, 1.0);
        optional {
            /// Value of a fixed characteristic length.
            characteristic_length_m: f64, Check::Positive, Initial::Number(1.0);
        }
    }
}

section! {
    /// Bounds of the design variables in the search, as `[lower, upper]`.
    #[allow(non_snake_case, reason = "keys are the paper's symbols")]
    pub struct Bounds in "bounds" {
        /// Base radius `R`.
        R_m: [f64; 2] = [0.5, 4.0], Check::Any;
        /// Platform radius `r`.
        r_m: [f64; 2] = [0.1, 4.0], Check::Any;
        /// Link length `L_b`.
        Lb_m: [f64; 2] = [0.5, 4.0], Check::Any;
        /// Radius `r_j` of the leg bars.
        rj_m: [f64; 2] = [0.0, 0.1], Check::Any;
        /// Radius `r_p` of the platform bars.
        rp_m: [f64; 2] = [0.0, 0.1], Check::Any;
        optional {
            /// Length `L_a` of the bar from the base joint to the next one, for chains that have it; if omitted, it equals `L_b`.
            La_m: [f64; 2], Check::Any, Initial::AsText;
            /// Angle `α` of the rails to the sides of the base; if omitted, 0°.
            alpha_deg: [f64; 2], Check::Within(-360.0, 360.0, ""), Initial::AsText;
            /// Angle `β` between the two guides of a leg; if omitted, 90°.
            beta_deg: [f64; 2], Check::Any, Initial::AsText;
            /// Angle `γ` of the guides on the platform to its bars; if omitted, 0°.
            gamma_deg: [f64; 2], Check::Within(-360.0, 360.0, ""), Initial::AsText;
        }
    }
}

section! {
    /// Arrangement of the base and platform joints, and travel of the prismatic joints.
    pub struct GeometrySection in "geometry" {
        /// Directions of the base joints from `O`.
        base_angles_deg: [f64; LEGS] = Arrangement::PAPER.base_angles_deg, Check::Within(-360.0, 360.0, "");
        /// Distances of the base joints from `O`, as multiples of `R`.
        base_radii: [f64; LEGS] = Arrangement::PAPER.base_radii, Check::Within(0.01, 100.0, "");
        /// Directions of the platform joints from `P`, in the platform frame.
        platform_angles_deg: [f64; LEGS] = Arrangement::PAPER.platform_angles_deg, Check::Within(-360.0, 360.0, "");
        /// Distances of the platform joints from `P`, as multiples of `r`.
        platform_radii: [f64; LEGS] = Arrangement::PAPER.platform_radii, Check::Within(0.01, 100.0, "");
        /// Rotation of each rail, in addition to `α`.
        rail_turn_deg: [f64; LEGS] = Arrangement::PAPER.rail_turn_deg, Check::Within(-360.0, 360.0, "");
        /// Travel of a slider, as fractions of the distance between neighbouring base joints.
        rail: [f64; 2] = Arrangement::PAPER.rail, Check::Within(-100.0, 100.0, "");
        /// Travel on every other guide, as fractions of `L_b`, or of `L_a` on the guide at the base of an RPP leg.
        guide: [f64; 2] = Arrangement::PAPER.guide, Check::Within(-100.0, 100.0, "");
    }
}

impl RailSection {
    /// Returns the rails of a study without faults; `None` if they are rigid.
    pub fn rails(&self, section: CrossSection) -> Option<RailSettings> {
        self.radius_m.map(|radius| RailSettings {
            section,
            radius,
            supports: match self.supports {
                RailSupportChoice::Clamped => RailSupports::Clamped { spans: self.spans },
                RailSupportChoice::Pinned => RailSupports::Pinned,
            },
        })
    }
}

impl From<&GeometrySection> for Arrangement {
    fn from(section: &GeometrySection) -> Self {
        Self {
            base_angles_deg: section.base_angles_deg,
            base_radii: section.base_radii,
            platform_angles_deg: section.platform_angles_deg,
            platform_radii: section.platform_radii,
            rail_turn_deg: section.rail_turn_deg,
            rail: section.rail,
            guide: section.guide,
        }
    }
}

impl Bounds {
    /// Returns the range of a variable; one that has no bounds keeps its default, and `L_a` that of `L_b`.
    pub fn range(&self, variable: DesignVariable) -> [f64; 2] {
        match variable {
            DesignVariable::ProximalLength => self.La_m.unwrap_or(self.Lb_m),
            DesignVariable::RailAngle => self.alpha_deg.unwrap_or([0.0; 2]),
            DesignVariable::GuideAngle => self.beta_deg.unwrap_or([90.0; 2]),
            DesignVariable::PlatformGuideAngle => self.gamma_deg.unwrap_or([0.0; 2]),
            DesignVariable::BaseRadius => self.R_m,
            DesignVariable::PlatformRadius => self.r_m,
            DesignVariable::LinkLength => self.Lb_m,
            DesignVariable::LegBarRadius => self.rj_m,
            DesignVariable::PlatformBarRadius => self.rp_m,
        }
    }

    /// Returns the variables beyond the five dimensions that have bounds.
    pub fn further_variables(&self) -> impl Iterator<Item = DesignVariable> + use<> {
        let all = FURTHER_VARIABLES
            .into_iter()
            .zip(self.clone().further().map(|bounds| *bounds));
        all.filter(|(_, bounds)| bounds.is_some()).map(|(variable, _)| variable)
    }

    /// The bounds of the variables beyond the five dimensions, in the order of [`FURTHER_VARIABLES`].
    fn further(&mut self) -> [&mut Option<[f64; 2]>; FURTHER_VARIABLES.len()] {
        [
            &mut self.La_m,
            &mut self.alpha_deg,
            &mut self.beta_deg,
            &mut self.gamma_deg,
        ]
    }

    /// Omits the bounds of variables that no architecture has.
    pub(crate) fn omit_unused(&mut self, architectures: &[Architecture]) {
        for (variable, bounds) in FURTHER_VARIABLES.into_iter().zip(self.further()) {
            if !architectures.iter().any(|architecture| architecture.has(variable)) {
                *bounds = None;
            }
        }
    }

    /// Adds the bounds of other variables, which these lack.
    pub(crate) fn add_missing(&mut self, mut other: Self) {
        for (bounds, theirs) in self.further().into_iter().zip(other.further()) {
            *bounds = bounds.or(*theirs);
        }
    }

    /// Returns the key of the range of a variable.
    pub fn key(variable: DesignVariable) -> String {
        match variable.is_angle() {
            true => variable.key().to_owned(),
            false => format!("{}_m", variable.key()),
        }
    }

    /// Iterates over the five dimensions, each with the key of its range.
    pub fn keys() -> impl Iterator<Item = (DesignVariable, String)> {
        DESIGN_VARIABLES
            .into_iter()
            .map(|variable| (variable, Self::key(variable)))
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

    /// Iterates over the quantities that the source of the design states.
    pub fn stated(&self) -> impl Iterator<Item = (Quantity, f64)> {
        let stated = [
            (Quantity::Mass, self.mass_kg),
            (Quantity::WorkspaceRadius, self.workspace_radius_m),
        ];
        stated
            .into_iter()
            .filter_map(|(quantity, value)| Some((quantity, value?)))
    }
}
