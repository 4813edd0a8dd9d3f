//! The contents of a study file, in the units that its keys name.
//!
//! Every key may be omitted and then takes the paper's value. What follows from the contents stands in the files below: the
//! question, the ranges of the variables, the region, the model that evaluates designs, and what is invalid.

mod compare;
mod error;
mod faults;
mod model;
mod open;
mod question;
mod read;
mod region;
mod surroundings;
mod variables;

pub use compare::SettingDifference;
pub use error::StudyError;
pub use faults::Fault;
pub use variables::UnlistedValue;

use serde::{Deserialize, Serialize};

use crate::settings::{
    ActuatorSection, AlgorithmName, AnywhereSection, Bounds, DriveSection, GeometrySection, Grids, HypervolumeSection,
    JointSection, Limits, LoadCatalogue, LoadSection, MaterialSection, ModelSection, ObjectiveChoice, ObstacleSection,
    OptimizerSection, PayloadSection, RailSection, ReferenceDesign, RequirementSection, RoomSection, SectionsSection,
    StrengthSection, TaskSection, ToleranceSection, Variables, WorkspaceSection,
};
use kinefront_model::clearance::BodySettings;
use kinefront_model::dynamics::DriveCatalogue;
use kinefront_model::mechanism::{Architecture, CrossSections, WorkingMode};

/// What the bars and drives of designs are selected from.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Catalogues {
    /// Cross-sections of the bars, with their catalogues.
    pub sections: CrossSections,
    /// Drives.
    pub drives: DriveCatalogue,
}

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
    /// The section `[joints]`.
    pub joints: JointSection,
    /// The section `[requirements]`.
    pub requirements: RequirementSection,
    /// The section `[strength]`.
    pub strength: StrengthSection,
    /// The section `[payload]`.
    pub payload: PayloadSection,
    /// The section `[drives]`.
    pub drives: DriveSection,
    /// The section `[loads]`.
    pub loads: LoadSection,
    /// The section `[task]`.
    pub task: TaskSection,
    /// The section `[anywhere]`.
    pub anywhere: AnywhereSection,
    /// The section `[tolerances]`.
    pub tolerances: ToleranceSection,
    /// The section `[workspace]`.
    pub workspace: WorkspaceSection,
    /// The section `[model]`.
    pub model: ModelSection,
    /// The section `[bodies]`.
    pub bodies: BodySettings,
    /// The sections `[[obstacles]]`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub obstacles: Vec<ObstacleSection>,
    /// The section `[room]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub room: Option<RoomSection>,
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
            objectives: ObjectiveChoice::defaults(),
            quantities: Vec::new(),
            constraints: Limits::new(),
            material: MaterialSection::default(),
            sections: SectionsSection::default(),
            rails: RailSection::default(),
            actuators: ActuatorSection::default(),
            joints: JointSection::default(),
            requirements: RequirementSection::default(),
            strength: StrengthSection::default(),
            payload: PayloadSection::default(),
            drives: DriveSection::default(),
            loads: LoadSection::default(),
            task: TaskSection::default(),
            anywhere: AnywhereSection::default(),
            tolerances: ToleranceSection::default(),
            workspace: WorkspaceSection::default(),
            model: ModelSection::default(),
            bodies: BodySettings::default(),
            obstacles: Vec::new(),
            room: None,
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
    /// The catalogues that the study names, with their keys.
    fn catalogue_choices(&mut self) -> impl Iterator<Item = (&'static str, &mut dyn LoadCatalogue)> {
        let of_bars = self.sections.catalogues();
        let of_bars = of_bars.map(|(key, choice)| (key, choice as &mut dyn LoadCatalogue));
        let of_drives = self.drives.catalogue.as_mut();
        of_bars.chain(of_drives.map(|choice| ("drives.catalogue", choice as &mut dyn LoadCatalogue)))
    }

    /// Returns what the designs of a study without faults are selected from.
    pub fn catalogues(&self) -> Catalogues {
        Catalogues {
            sections: self.sections.cross_sections(),
            drives: self.drives.drives().unwrap_or_default(),
        }
    }

    /// Returns the study with one architecture alone.
    pub fn with_one_architecture(&self, architecture: Architecture) -> Self {
        Self {
            architectures: vec![architecture],
            ..self.clone()
        }
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
