//! Reading a run folder.

use std::path::{Path, PathBuf};

use super::{DESIGNS, FRONT, REPORT, RunReport, STUDY};
use crate::study::{Study, StudyError, TableError, TableRow, read_table};

/// A run on disk.
///
/// ```no_run
/// use kinefront::study::RunFolder;
///
/// let run = RunFolder::open("run".as_ref())?;
/// let heaviest = run.designs()?.into_iter().map(|entry| entry.row.mass).fold(0.0, f64::max);
/// println!("{}: at most {heaviest} kg", run.study().name);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct RunFolder {
    path: PathBuf,
    study: Study,
}

/// Why a run folder cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum RunFolderError {
    /// The path is not a run folder.
    #[error("{} holds no run: expected a folder with study.toml and designs.csv", .0.display())]
    NoRun(PathBuf),
    /// The study of the run is invalid.
    #[error(transparent)]
    Study(#[from] Box<StudyError>),
}

impl RunFolder {
    /// Whether a path is a run folder.
    pub fn is_at(path: &Path) -> bool {
        path.join(STUDY).exists() && path.join(DESIGNS).exists()
    }

    /// Opens the run folder at `path` and reads its study.
    ///
    /// # Errors
    /// [`RunFolderError::NoRun`] or [`RunFolderError::Study`].
    pub fn open(path: &Path) -> Result<Self, RunFolderError> {
        if !Self::is_at(path) {
            return Err(RunFolderError::NoRun(path.to_owned()));
        }
        let study = Study::read(&path.join(STUDY)).map_err(Box::new)?;
        Ok(Self {
            path: path.to_owned(),
            study,
        })
    }

    /// The study as run.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// Reads every evaluated design, in the order of the ids.
    ///
    /// # Errors
    /// [`TableError`] with the line that is wrong.
    pub fn designs(&self) -> Result<Vec<TableRow>, TableError> {
        read_table(&self.path.join(DESIGNS), &self.study)
    }

    /// Reads the verified front; `None` for a run that did not verify one.
    ///
    /// # Errors
    /// [`TableError`] with the line that is wrong.
    pub fn front(&self) -> Result<Option<Vec<TableRow>>, TableError> {
        let path = self.path.join(FRONT);
        path.exists().then(|| read_table(&path, &self.study)).transpose()
    }

    /// Reads `run.json`. `None` if it is missing, or not of this version: nothing depends on it, because a run that was
    /// killed leaves none.
    pub fn report(&self) -> Option<RunReport> {
        serde_json::from_slice(&std::fs::read(self.path.join(REPORT)).ok()?).ok()
    }

    /// Name of the folder, without the path to it, which a published report must not reveal.
    pub fn name(&self) -> String {
        let path = self.path.canonicalize().unwrap_or_else(|_| self.path.clone());
        let name = path.file_name().unwrap_or(path.as_os_str());
        name.to_string_lossy().into_owned()
    }
}
