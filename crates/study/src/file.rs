//! The contents of a study file, in the units that its keys name.
//!
//! Every key may be omitted and then takes the paper's value. [`Study::model`] converts the contents into the settings
//! of the model.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::settings::{
    ActuatorSection, AlgorithmName, Bounds, GeometrySection, Grids, HypervolumeSection, LengthChoice, Limits,
    MaterialSection, ModelSection, ObjectiveChoice, OptimizerSection, RailSection, ReferenceDesign, RequirementSection,
    SectionsSection, StiffnessChoice, TelescopicBar, Variables, WorkspaceSection,
};
use kinefront_model::clearance::BodySettings;
use kinefront_model::evaluation::{Model, ModelSettings};
use kinefront_model::kinematics::CharacteristicLength;
use kinefront_model::mechanism::{Architecture, Arrangement, BarLength, LegSettings, WorkingMode};
use kinefront_model::stiffness::{ActuatorStiffness, Material, StiffnessDefinition};
use kinefront_model::workspace::{GridError, Thresholds, WorkspaceSpec};

/// A study: the requirements, the manipulators to search, and the settings of the search.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Study {
    /// Short name, which appears in run folders and recordings.
    pub name: String,
    /// Description of the study in one or two sentences.
    pub description: String,
    /// Architectures to search; with more than one, the architecture `d` is a variable.
    pub architectures: Vec<Architecture>,
    /// Working mode of every design.
    pub working_mode: WorkingMode,
    /// Objectives, one to three.
    pub objectives: Vec<ObjectiveChoice>,
    /// Quantities that are reported besides those that the study names otherwise.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub quantities: Vec<String>,
    /// The section `[constraints]`: limits of quantities.
    #[serde(skip_serializing_if = "Limits::is_empty")]
    pub constraints: Limits,
    /// The section `[material]`.
    pub material: MaterialSection,
    /// The section `[sections]`.
    pub sections: SectionsSection,
    /// The section `[rails]`.
    pub rails: RailSection,
    /// The section `[actuators]`.
    pub actuators: ActuatorSection,
    /// The section `[requirements]`.
    pub requirements: RequirementSection,
    /// The section `[workspace]`.
    pub workspace: WorkspaceSection,
    /// The section `[model]`.
    pub model: ModelSection,
    /// The section `[bodies]`.
    pub bodies: BodySettings,
    /// The section `[geometry]`.
    pub geometry: GeometrySection,
    /// The section `[bounds]`.
    pub bounds: Bounds,
    /// The section `[variables]`.
    pub variables: Variables,
    /// The section `[grid]`.
    pub grid: Grids,
    /// The section `[optimizer]`.
    pub optimizer: OptimizerSection,
    /// The section `[hypervolume]`.
    pub hypervolume: HypervolumeSection,
    /// The sections `[[references]]`: reference designs to compare with.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub references: Vec<ReferenceDesign>,
}

impl Default for Study {
    fn default() -> Self {
        Self {
            name: "untitled".to_owned(),
            description: String::new(),
            architectures: Architecture::PAPER.to_vec(),
            working_mode: WorkingMode::ALL_PLUS,
            objectives: ObjectiveChoice::of_paper(),
            quantities: Vec::new(),
            constraints: Limits::new(),
            material: MaterialSection::default(),
            sections: SectionsSection::default(),
            rails: RailSection::default(),
            actuators: ActuatorSection::default(),
            requirements: RequirementSection::default(),
            workspace: WorkspaceSection::default(),
            model: ModelSection::default(),
            bodies: BodySettings::default(),
            geometry: GeometrySection::default(),
            bounds: Bounds::default(),
            variables: Variables::default(),
            grid: Grids::default(),
            optimizer: OptimizerSection::default(),
            hypervolume: HypervolumeSection::default(),
            references: Vec::new(),
        }
    }
}

impl Study {
    /// Returns the study with one architecture alone.
    pub fn with_one_architecture(&self, architecture: Architecture) -> Self {
        Self {
            architectures: vec![architecture],
            ..self.clone()
        }
    }

    /// Builds the model that evaluates the designs of this study, in SI units.
    ///
    /// # Errors
    /// [`GridError`] when a grid does not divide the full turn or the rotation range into whole steps; a study that was
    /// read without faults has none.
    pub fn model(&self) -> Result<Model, GridError> {
        let model = &self.model;
        Model::new(ModelSettings {
            material: Material {
                youngs_modulus: self.material.youngs_modulus_pa,
                shear_modulus: self.material.shear_modulus_pa,
                density: self.material.density_kg_per_m3,
            },
            sections: self.sections.cross_sections(),
            rails: self
                .rails
                .rails(self.sections.rails.cross_section().unwrap_or_default()),
            actuators: ActuatorStiffness {
                prismatic: self.actuators.prismatic_stiffness_n_per_m,
                revolute: self.actuators.revolute_stiffness_nm_per_rad,
            },
            legs: LegSettings {
                telescopic_bar: match model.telescopic_bar {
                    TelescopicBar::Current => BarLength::Current,
                    TelescopicBar::Longest => BarLength::Longest,
                },
                telescopic_shortest: model.telescopic_shortest,
                geometry: Arrangement::from(&self.geometry).into(),
            },
            bodies: self.bodies,
            platform_bars: model.platform_bars,
            stiffness_definition: match model.stiffness_definition {
                StiffnessChoice::Stiffness => StiffnessDefinition::Stiffness,
                StiffnessChoice::Compliance => StiffnessDefinition::Compliance,
            },
            characteristic_length: match model.characteristic_length {
                LengthChoice::PlatformRadius => CharacteristicLength::PlatformRadius,
                LengthChoice::Isotropic => CharacteristicLength::Isotropic,
                // A study that was read without faults has this length.
                LengthChoice::Fixed => CharacteristicLength::Fixed(model.characteristic_length_m.unwrap_or(1.0)),
            },
            thresholds: self.thresholds(),
            in_plane_force: self.requirements.in_plane_force_n,
            objectives: self.objectives(),
            limits: self.limits_of_designs(),
            quantities: self.asked_quantities(),
            workspace: WorkspaceSpec {
                region: self.region(),
                rotation_range_deg: self.workspace.rotation_range_deg,
                centre: DVec2::from_array(self.workspace.centre_m),
                home_phi_deg: self.workspace.home_phi_deg,
            },
            reference_grid: (&self.grid.reference).try_into()?,
            fine_grid: (&self.grid.fine).try_into()?,
        })
    }

    /// Derives the thresholds of the constraints from the requirements.
    pub fn thresholds(&self) -> Thresholds {
        let requirements = &self.requirements;
        let mut thresholds = Thresholds {
            inverse_condition: requirements.inverse_condition_min,
            k_xy: requirements
                .k_xy_min_n_per_m
                .unwrap_or(requirements.in_plane_force_n / requirements.in_plane_displacement_m),
            k_z: requirements
                .k_z_min_n_per_m
                .unwrap_or(requirements.vertical_force_n / requirements.vertical_displacement_m),
            k_phi_z: requirements
                .k_phi_z_min_nm_per_rad
                .unwrap_or(requirements.torque_z_nm / requirements.rotation_z_deg.to_radians()),
            clearance: requirements.clearance_min_m,
            further: None,
        };
        self.bound_poses(&mut thresholds);
        thresholds
    }

    /// Returns the number of candidates of a generation of the study's algorithm.
    pub fn population(&self) -> usize {
        match self.optimizer.algorithm {
            AlgorithmName::FrontDe => self.optimizer.front_de.generation,
            AlgorithmName::Moga2 => self.optimizer.moga2.population,
            AlgorithmName::Nsga2 => self.optimizer.nsga2.population,
            AlgorithmName::CmaEs => self.optimizer.cma_es.population,
        }
    }
}
