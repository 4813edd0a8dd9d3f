//! Studies: the study file, the run of a study on its own thread, and the run folder.
//!
//! ```
//! use std::sync::Arc;
//! use std::sync::mpsc::sync_channel;
//!
//! use kinefront_study::{Event, RunControl, Study, spawn};
//!
//! let study = Study::parse("architectures = [\"3-PRR\"]\n[optimizer]\nevaluations = 60", "mine")?;
//! let (sender, events) = sync_channel(64);
//! let worker = spawn(study, Arc::new(RunControl::default()), vec![sender])?;
//! let mut evaluated = 0;
//! for event in events {
//!     match &*event {
//!         Event::Evaluated(batch) => evaluated += batch.rows.len(),
//!         Event::Finished(summary) => assert!(summary.front.len() > 1),
//!         _ => {}
//!     }
//! }
//! worker.join().expect("the worker ends");
//! assert_eq!(evaluated, 60);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod builtin;
mod certified;
mod conclusion;
mod control;
mod durable;
mod events;
mod front;
mod levels;
mod local;
mod overrides;
mod pool;
mod prepared;
mod problem;
mod prove;
mod replay;
mod run;
mod run_folder;
mod search;
pub mod sensitivity;
mod settings;
mod stopping;
mod study;
mod sum;
mod sync;
mod table;

pub use builtin::{BUILTIN, Builtin};
pub use certified::CertifiedWorkspace;
pub use control::RunControl;
pub use durable::{WriteError, open_regular, read_regular, replace, write_whole};
pub use events::{
    Batch, ConclusionPart, EndReason, Event, GenerationSummary, RunSummary, RunTimes, Started, Subscriber,
};
pub use front::{FrontMember, FrontProofs, RefutedDesign, ThickenedDesign};
pub use kinefront_optimum::ParameterKind;
pub use levels::{EqualLevel, equal_levels, levels_between};
pub use local::{
    ActiveJson, AlongJson, AlternativeJson, Condition, ConditionError, Crossing, CrossingJson, DrivenPart, Drivers,
    DriversAlong, DriversOptions, Hindrance, InactiveJson, LocalDesign, LocalFault, PriceCurve, PriceJson,
    PricedDesignJson, RelaxationJson, UnmetJson, WhyNotJson, Wish, WishFault, WishJson, WishOutcome, stacked,
    usual_range,
};
pub use overrides::Overrides;
pub use pool::PoolWorkers;
pub use prepared::PreparedStudy;
pub use problem::DesignProblem;
pub use prove::{FrontProver, proved_front};
pub use replay::ReplayError;
pub use run::{spawn, spawn_search};
pub use run_folder::{
    Checkpoint, FileSums, Finding, HypervolumeReference, Inspection, Merge, MergeError, MergedRun, Repair, ResumeError,
    ResumeOptions, Resumption, RunFolder, RunFolderError, RunReport, RunWriter,
};
pub use search::{SearchError, StudySearch, keep_runners_up};
pub use settings::{
    ActuatorSection, AlgorithmName, Bounds, BuiltinCatalogue, BuiltinMaterial, CATALOGUES, CatalogueChoice,
    CatalogueFault, CatalogueRow, Check, DRIVE_CATALOGUES, DriveKind, DriveRow, DriveSection, FileScope, GridSection,
    Grids, HypervolumeSection, Initial, JointSection, LengthChoice, LimitChoice, Limits, LoadSection, LoadShapeChoice,
    MATERIALS, MaterialSection, ModelSection, ObjectiveChoice, ObstacleSection, OptimizerSection, PayloadSection,
    ReferenceDesign, RegionKind, RegionSection, RequirementSection, SectionChoice, SectionKind, SectionsSection,
    Setting, Stagnation, StiffnessChoice, StrengthSection, TaskSection, TaskShapeChoice, TelescopicBar, Tie,
    ToleranceSection, VariableChoice, Variables, WHOLE_FRONT, WorkspaceSection, is_shown, settings,
    settings_of_surroundings,
};
pub use study::{Catalogues, Fault, SettingDifference, Study, StudyError, UnlistedValue};
pub use sum::{Difference, FileSum};
pub use table::{
    Cell, Column, ColumnType, Row, RowError, TableContents, TableError, TableFault, TableRow, front_marks, is_row_name,
    named_row, read_design, read_designs, read_run_table, read_table, row_names, table_bytes,
};
