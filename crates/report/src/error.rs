//! Errors of reports.

/// An error of a library, whose message is shown with the name of what could not be written.
pub(crate) type AnyError = Box<dyn std::error::Error + Send + Sync>;
use std::path::PathBuf;

use kinefront_model::workspace::GridError;
use kinefront_study::{RunFolderError, TableError, WriteError};

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
    #[error("{first} and {other} cannot be combined in one report: their studies differ in {key}")]
    Differing {
        /// Name of the first run.
        first: String,
        /// Name of the other run.
        other: String,
        /// Section or key of the study in which they differ.
        key: String,
    },
    /// A report varies assumptions only where the fronts are curves.
    #[error(
        "a report varies assumptions only for two objectives, whose fronts it can compare, but {name} has {count}. Leave out --sensitivity"
    )]
    Sensitivity {
        /// Name of the run.
        name: String,
        /// Number of its objectives.
        count: usize,
    },
    /// A run has no reported front.
    #[error("{0} has no front.csv with designs; finish the run first: kinefront optimize --resume")]
    NoFront(String),
    /// The runs have no feasible design.
    #[error(
        "no design of the run is feasible, so there is no front to report; `kinefront why RUN/designs.csv` lists the requirements that prevent one"
    )]
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

impl ReportError {
    /// Returns what makes an error of a figure, a picture or a file from its cause.
    pub(crate) fn of(name: &str) -> impl FnOnce(AnyError) -> Self {
        let name = name.to_owned();
        |cause| Self::Figure { name, cause }
    }
}
