//! The settings of a study: each is declared once, and the study file, its faults, the fields of the window and the comparison
//! of studies follow.

mod bars;
mod catalogue;
mod declare;
mod drives;
mod grid;
mod joints;
mod list;
mod material;
mod optimizer;
mod question;
mod region;
mod sections;
mod strength;
mod surroundings;
mod task;
mod variables;

pub use bars::{CATALOGUES, CatalogueRow, SectionChoice, SectionKind, SectionsSection};
pub(crate) use catalogue::LoadCatalogue;
pub use catalogue::{BuiltinCatalogue, CatalogueChoice, CatalogueFault, FileScope};
pub(crate) use declare::wrong_name;
pub use declare::{Check, Initial, Setting, is_shown};
pub use drives::{DRIVE_CATALOGUES, DriveKind, DriveRow, DriveSection};
pub use grid::{GridSection, Grids};
pub use joints::JointSection;
pub use list::settings;
pub use material::{BuiltinMaterial, MATERIALS, MaterialSection};
pub use optimizer::{AlgorithmName, HypervolumeSection, OptimizerSection, Stagnation, WHOLE_FRONT};
pub(crate) use question::unknown_quantity;
pub use question::{LimitChoice, Limits, ObjectiveChoice};
pub use region::{RegionKind, RegionSection};
pub use sections::{
    ActuatorSection, Bounds, GeometrySection, LengthChoice, ModelSection, RailSection, RailSupportChoice,
    ReferenceDesign, RequirementSection, StiffnessChoice, TelescopicBar, WorkspaceSection,
};
pub use strength::{LoadShapeChoice, StrengthSection};
pub use surroundings::{ObstacleSection, RoomSection, settings_of_surroundings};
pub use task::{AnywhereSection, LoadSection, PayloadSection, TaskSection, TaskShapeChoice, ToleranceSection};
pub use variables::{Tie, VariableChoice, Variables};
