//! Studies: the file, the run of one on its own thread, and the folder it leaves.

mod builtin;
mod error;
mod file;
mod folder;
mod problem;
mod run;

pub use builtin::{BUILTIN, Builtin};
pub use error::{Fault, StudyError};
pub use file::{
    ActuatorSection, AlgorithmName, Bounds, GridSection, Grids, HypervolumeSection, LengthChoice, MaterialSection,
    ModelSection, OptimizerSection, RequirementSection, StiffnessChoice, Study, TelescopicBar, WorkspaceSection,
};
pub use folder::{FolderError, RunFolder, RunReport, TABLE_HEADER};
pub use problem::{CandidateError, DesignProblem};
pub use run::{
    Batch, Event, FrontMember, GenerationSummary, Outcome, RunControl, RunSummary, RunTimes, Started, Subscriber, spawn,
};
