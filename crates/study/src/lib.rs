//! Studies: the study file, the run of a study on its own thread, and the run folder.

mod builtin;
mod control;
mod error;
mod events;
mod file;
mod front;
mod problem;
mod prove;
mod replay;
mod run;
mod run_folder;
mod search;
pub mod sensitivity;
mod settings;
mod stopping;
mod table;

pub use builtin::{BUILTIN, Builtin};
pub use control::RunControl;
pub use error::StudyError;
pub use events::{Batch, EndReason, Event, GenerationSummary, RunSummary, RunTimes, Started, Subscriber, front_marks};
pub use file::Study;
pub use front::{CertifiedRadius, FrontMember, FrontProofs, RefutedDesign, ThickenedDesign};
pub use problem::DesignProblem;
pub use prove::FrontProver;
pub use replay::ReplayError;
pub use run::{spawn, spawn_search};
pub use run_folder::{
    Checkpoint, Difference, FileSum, FileSums, Finding, HypervolumeReference, Inspection, Merge, MergeError, MergedRun,
    Repair, ResumeError, Resumption, RunFolder, RunFolderError, RunReport, RunWriter, WriteError, partial_path,
    write_whole,
};
pub use search::{SearchError, StudySearch, keep_runners_up};
pub use settings::{
    ActuatorSection, AlgorithmName, Bounds, BuiltinCatalogue, CATALOGUES, CatalogueChoice, CatalogueFault,
    CatalogueRow, Check, Fault, GridSection, Grids, HypervolumeSection, Initial, LengthChoice, LimitChoice, Limits,
    MaterialSection, ModelSection, ObjectiveChoice, OptimizerSection, ReferenceDesign, RegionKind, RegionSection,
    RequirementSection, SectionChoice, SectionKind, SectionsSection, Setting, Stagnation, StiffnessChoice,
    TelescopicBar, Tie, VariableChoice, Variables, WorkspaceSection, settings,
};
pub use table::{
    Cell, Column, ColumnType, Row, RowError, TableContents, TableError, TableFault, TableRow, read_design,
    read_designs, read_run_table, read_table, table_bytes,
};
