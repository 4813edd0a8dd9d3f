//! Errors of reports.

use crate::AnyError;
use std::path::PathBuf;

use crate::study::{RunFolderError, TableError, WriteError};
use kinefront_model::workspace::GridError;

/// Reason why a report cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A run folder cannot be read.
    #[error(transparent)]
    Folder(#[from] RunFolderError),
    /// A table of a run cannot be read.
    #[error(transparent)]
    Table(#[from] TableError),
    /// The runs cannot be compared because their studies differ.
    #[error("{first} and {other} cannot be put in one report: their studies differ in {key}")]
    Differing {
        /// Name of the first run.
        first: String,
        /// Name of the other run.
        other: String,
        /// Section or key of the study in which they differ.
        key: String,
    },
    /// A run has another question than the one under which assumptions can be varied.
    #[error(
        "{0} has other objectives than mass and the largest workspace radius, for which alone a report varies assumptions; leave out \
         --sensitivity"
    )]
    Sensitivity(String),
    /// The runs have no feasible design.
    #[error("no design of the run is feasible: there is no front to report")]
    NothingFeasible,
    /// A search that the report ran itself failed.
    #[error("the search \"{name}\" failed: {message}")]
    Run {
        /// Name of the search.
        name: String,
        /// Reason of the failure.
        message: String,
    },
    /// The step of a grid does not divide the full turn or half the rotation range.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// A figure, a picture or `fronts.csv` cannot be created.
    #[error("cannot create {name}: {cause}")]
    Figure {
        /// Name of the figure, picture or file.
        name: String,
        /// Reason of the failure.
        cause: AnyError,
    },
    /// The folder already holds a report, and replacing it was not requested.
    #[error("{} already holds a report; choose another folder, or replace it with --replace", .0.display())]
    Occupied(PathBuf),
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}
