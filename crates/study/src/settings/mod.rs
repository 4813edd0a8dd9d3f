//! The settings of a study: each is declared once, and the study file, its faults, the fields of the window and the comparison
//! of studies follow.

mod bars;
mod declare;
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

pub use bars::{
    BuiltinCatalogue, CATALOGUES, CatalogueChoice, CatalogueFault, CatalogueRow, FileScope, SectionChoice, SectionKind,
    SectionsSection,
};
pub(crate) use declare::wrong_name;
pub use declare::{Check, Initial, Setting, is_shown};
pub use joints::JointSection;
pub use list::settings;
pub use material::{BuiltinMaterial, MATERIALS, MaterialSection};
pub use optimizer::{AlgorithmName, HypervolumeSection, OptimizerSection, Stagnation, WHOLE_FRONT};
pub(crate) use question::unknown_quantity;
pub use question::{LimitChoice, Limits, ObjectiveChoice};
pub use region::{RegionKind, RegionSection};
pub use sections::{
    ActuatorSection, Bounds, GeometrySection, GridSection, Grids, LengthChoice, ModelSection, RailSection,
    RailSupportChoice, ReferenceDesign, RequirementSection, StiffnessChoice, TelescopicBar, WorkspaceSection,
};
pub use strength::{LoadShapeChoice, StrengthSection};
pub use surroundings::{ObstacleSection, RoomSection};
pub use task::{
    AnywhereSection, DriveSection, DynamicsSections, LoadSection, PayloadSection, TaskSection, TaskShapeChoice,
    ToleranceSection,
};
pub use variables::{Tie, VariableChoice, Variables};
