//! Why a report cannot be made.

use std::path::PathBuf;

use crate::study::{FolderError, StudyError, TableError};
use kinefront_model::workspace::GridError;

/// Why a report cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The folder holds no run.
    #[error("{} holds no run: expected a folder with study.toml and designs.csv", .0.display())]
    NoRun(PathBuf),
    /// Its study.
    #[error(transparent)]
    Study(#[from] Box<StudyError>),
    /// Its table.
    #[error(transparent)]
    Table(#[from] TableError),
    /// Runs that cannot be compared.
    #[error("{first} and {other} cannot be put in one report: their studies differ in {key}")]
    Differing {
        /// Name of the first run.
        first: String,
        /// Name of the other run.
        other: String,
        /// What they differ in.
        key: &'static str,
    },
    /// No feasible design.
    #[error("no design of the run is feasible: there is no front to report")]
    NothingFeasible,
    /// A search of the report's own broke off.
    #[error("the search \"{name}\" broke off: {message}")]
    Run {
        /// What was searched.
        name: String,
        /// Why.
        message: String,
    },
    /// A grid that does not fit.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// A figure or picture.
    #[error("{name}: {message}")]
    Figure {
        /// Its name.
        name: String,
        /// What went wrong.
        message: String,
    },
    /// The folder holds a report already.
    #[error("{} already holds a report; choose another folder, or replace it with --replace", .0.display())]
    Occupied(PathBuf),
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] FolderError),
}
