//! Opens the results of a run: its folder, one of its tables, or its recording.

use std::path::{Path, PathBuf};

use crate::data::front_of;
use crate::{FrontEntry, Store};
use kinefront_study::{GenerationSummary, RunFolder, RunFolderError, Study, TableError};

/// A run that was read from its files.
#[derive(Debug)]
pub struct Opened {
    /// Name of its folder, or of its recording.
    pub name: String,
    /// The study of the run.
    pub study: Study,
    /// Every evaluated design.
    pub store: Store,
    /// The front; verified if the run completed the verification.
    pub front: Vec<FrontEntry>,
    /// Summary of each generation; empty if it was not recorded.
    pub history: Vec<GenerationSummary>,
}

/// Why a run cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum OpenError {
    /// The path is neither a run folder nor a recording.
    #[error("{} is not a run: expected a folder with study.toml and designs.csv or a recording (.rrd)", .0.display())]
    NoRun(PathBuf),
    /// The run folder cannot be read.
    #[error(transparent)]
    Folder(#[from] RunFolderError),
    /// A table of the run cannot be read.
    #[error(transparent)]
    Table(#[from] TableError),
    /// The recording of the run cannot be read.
    #[error(transparent)]
    Recording(#[from] kinefront_recording::RecordedRunError),
}

/// Returns the run folder that a path is or lies in.
pub fn run_folder_of(path: &Path) -> Option<&Path> {
    let folder = if path.is_dir() { Some(path) } else { path.parent() };
    folder.filter(|folder| RunFolder::is_at(folder))
}

/// Reads the run at `path`.
///
/// # Errors
/// Returns an [`OpenError`] that names the file and says what is wrong in it.
pub fn open(path: &Path) -> Result<Opened, OpenError> {
    match run_folder_of(path) {
        // A recording beside tables is of the same run, and the tables are more exact.
        Some(folder) => open_folder(folder),
        None if path.extension().is_some_and(|extension| extension == "rrd") => open_recording(path),
        None => Err(OpenError::NoRun(path.to_owned())),
    }
}

fn open_folder(folder: &Path) -> Result<Opened, OpenError> {
    let run = RunFolder::open(folder)?;
    let mut store = Store::default();
    for entry in run.designs()?.rows {
        store.push(&entry.row);
    }
    let front = match run.front()? {
        Some(front) => front.rows.iter().map(|entry| FrontEntry::of_row(entry, true)).collect(),
        None => front_of(&store),
    };
    Ok(Opened {
        name: run.name(),
        study: run.study().clone(),
        store,
        front,
        // A run without a history can be opened, because only the curves need it.
        history: run.report().map(|report| report.history.clone()).unwrap_or_default(),
    })
}

fn open_recording(path: &Path) -> Result<Opened, OpenError> {
    let (study, rows) = kinefront_recording::read_apart(path)?;
    let mut store = Store::default();
    for entry in &rows {
        store.push(&entry.row);
    }
    let front = front_of(&store);
    let name = path.file_name().unwrap_or(path.as_os_str());
    Ok(Opened {
        name: name.to_string_lossy().into_owned(),
        study,
        store,
        front,
        history: Vec::new(),
    })
}
