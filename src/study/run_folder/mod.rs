//! The run folder: `study.toml`, `designs.csv`, `front.csv`, `run.json`, and beside them `recording.rrd`, which the recorder
//! writes.
//!
//! `study.toml` is written at the start, `designs.csv` grows as designs are evaluated, and `front.csv` and `run.json`
//! are written at the end. All files except `designs.csv` appear only when they are complete.

mod read;
mod report;
mod write;

pub use read::{RunFolder, RunFolderError};
pub use report::{HypervolumeReference, RunReport};
pub use write::{RunWriter, WriteError, write_whole};

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
