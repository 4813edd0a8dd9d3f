//! The run folder: `study.toml`, `designs.csv`, `front.csv`, `run.json`, and beside them `recording.rrd`, which the recorder
//! writes.
//!
//! `study.toml` is written at the start, and `designs.csv` grows as designs are evaluated. While the run goes on,
//! `progress.json` states what is known to be on the disk. At the end `front.csv` and `run.json` are written, and
//! `progress.json` is removed. All files except `designs.csv` and the recording appear only when they are complete.
//!
//! `designs.csv` is locked as long as a process writes the run; the lock ends with the process.

mod check;
mod checkpoint;
mod design_table;
mod error;
mod lock;
mod merge;
mod read;
mod report;
mod resume;
mod write;

pub use check::{Finding, Inspection, Repair};
pub use checkpoint::Checkpoint;
pub use error::RunFolderError;
pub use merge::{Merge, MergeError};
pub use read::RunFolder;
pub use report::{FileSums, HypervolumeReference, MergedRun, RunReport};
pub use resume::{ResumeError, ResumeOptions, Resumption};
pub use write::RunWriter;

/// File of the study as run.
const STUDY: &str = "study.toml";
/// Table of every evaluated design.
const DESIGNS: &str = "designs.csv";
/// Table of the verified front.
const FRONT: &str = "front.csv";
/// Random seed, counts, times and history.
const REPORT: &str = "run.json";
/// Recording for the Rerun viewer.
const RECORDING: &str = "recording.rrd";
/// What is on the disk, while a run goes on.
const PROGRESS: &str = "progress.json";
