//! Studies: the study file, the run of a study on its own thread, and the run folder.

mod builtin;
mod control;
mod error;
mod events;
mod faults;
mod file;
mod optimizer;
mod problem;
mod run;
mod run_folder;
mod sections;
mod stopping;
mod table;

pub use builtin::{BUILTIN, Builtin};
pub use control::RunControl;
pub use error::StudyError;
pub use events::{Batch, EndReason, Event, FrontMember, GenerationSummary, RunSummary, RunTimes, Started, Subscriber};
pub use faults::Fault;
pub use file::Study;
pub use optimizer::{AlgorithmName, HypervolumeSection, OptimizerSection, Stagnation};
pub use problem::DesignProblem;
pub use run::spawn;
pub use run_folder::{FolderError, RunFolder, RunFolderError, RunReport, RunWriter, write_whole};
pub use sections::{
    ActuatorSection, Bounds, GridSection, Grids, LengthChoice, MaterialSection, ModelSection, ReferenceDesign,
    RequirementSection, StiffnessChoice, TelescopicBar, WorkspaceSection,
};
pub use table::{
    Better, Cell, Column, ColumnType, Row, RowError, TableError, TableFault, TableRow, TableWriter, read_table,
    table_bytes,
};
