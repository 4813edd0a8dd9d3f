//! Why a run folder cannot be read.

use std::path::{Path, PathBuf};

use crate::{Difference, StudyError};

/// Why a run folder cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum RunFolderError {
    /// The path is not a run folder.
    #[error("{} holds no run: expected a folder with study.toml and designs.csv", .0.display())]
    NoRun(PathBuf),
    /// The study of the run is invalid.
    #[error(transparent)]
    Study(#[from] Box<StudyError>),
    /// A file cannot be read.
    #[error("cannot read {}: {cause}", path.display())]
    Read {
        /// Path of the file.
        path: PathBuf,
        /// Cause of the error.
        cause: std::io::Error,
    },
    /// The designs cannot be checked, because the system has no threads to spare.
    #[error("{}: cannot start the worker threads: {cause}", path.display())]
    Threads {
        /// Path of the table of the designs.
        path: PathBuf,
        /// Cause of the error.
        cause: rayon::ThreadPoolBuildError,
    },
    /// A file is not JSON, or lacks a key.
    #[error("{} is damaged: {cause}", path.display())]
    Damaged {
        /// Path of the file.
        path: PathBuf,
        /// What is wrong in it.
        cause: serde_json::Error,
    },
    /// The run was written by another version of the program.
    #[error(
        "{} was written by Kinefront {found}, but this is {}; evaluations may differ between versions, so use that version",
        path.display(),
        env!("CARGO_PKG_VERSION")
    )]
    Version {
        /// Path of the folder, or of the file in it that this version cannot read.
        path: PathBuf,
        /// Version that wrote it.
        found: String,
    },
    /// A file is not the one that the run wrote.
    #[error("{} is not the file of the run: {difference}", path.display())]
    Differs {
        /// Path of the file.
        path: PathBuf,
        /// How it differs.
        difference: Difference,
    },
}

impl RunFolderError {
    /// Converts an I/O error of the file at `path`.
    pub(super) fn at(path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        move |cause| Self::Read {
            path: path.to_owned(),
            cause,
        }
    }

    /// Whether the system is the reason, and not what is in the folder.
    pub fn is_of_system(&self) -> bool {
        matches!(self, Self::Read { .. } | Self::Threads { .. })
    }
}
