//! Studies: the study file, the run of a study on its own thread, and the run folder.

mod builtin;
mod control;
mod error;
mod events;
mod file;
mod problem;
mod run;
mod run_folder;
mod settings;
mod stopping;
mod table;

pub use builtin::{BUILTIN, Builtin};
pub use control::RunControl;
pub use error::StudyError;
pub use events::{Batch, EndReason, Event, FrontMember, GenerationSummary, RunSummary, RunTimes, Started, Subscriber};
pub use file::Study;
pub use problem::DesignProblem;
pub use run::spawn;
pub use run_folder::{HypervolumeReference, RunFolder, RunFolderError, RunReport, RunWriter, WriteError, write_whole};
pub use settings::{
    ActuatorSection, AlgorithmName, Bounds, Check, Fault, GridSection, Grids, HypervolumeSection, Initial,
    LengthChoice, MaterialSection, ModelSection, OptimizerSection, ReferenceDesign, RequirementSection, Setting,
    Stagnation, StiffnessChoice, TelescopicBar, WorkspaceSection, settings,
};
pub use table::{
    Better, Cell, Column, ColumnType, Row, RowError, TableError, TableFault, TableRow, TableWriter, read_designs,
    read_table, table_bytes,
};
