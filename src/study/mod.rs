//! Studies: the study file, the run of a study on its own thread, and the run folder.

mod builtin;
mod control;
mod error;
mod events;
mod faults;
mod file;
mod folder;
mod optimizer;
mod problem;
mod run;
mod sections;
mod stopping;
mod table;

pub use builtin::{BUILTIN, Builtin};
pub use control::RunControl;
pub use error::StudyError;
pub use events::{Batch, EndReason, Event, FrontMember, GenerationSummary, RunSummary, RunTimes, Started, Subscriber};
pub use faults::Fault;
pub use file::Study;
pub use folder::{FolderError, RunFolder, RunReport, TABLE_HEADER, front_table, write_whole};
pub use optimizer::{AlgorithmName, HypervolumeSection, OptimizerSection, Stagnation};
pub use problem::DesignProblem;
pub use run::spawn;
pub use sections::{
    ActuatorSection, Bounds, GridSection, Grids, LengthChoice, MaterialSection, ModelSection, ReferenceDesign,
    RequirementSection, StiffnessChoice, TelescopicBar, WorkspaceSection,
};
pub use table::{Row, TableError, TableRow, read_table};
