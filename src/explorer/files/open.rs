//! Opens the results of a run: its folder, one of its tables, or its recording.

use std::path::{Path, PathBuf};

use crate::explorer::data::front_of;
use crate::explorer::{FrontEntry, Store};
use crate::recording;
use crate::study::{
    Column, GenerationSummary, Row, RunFolder, RunFolderError, Study, StudyError, TableError, TableFault,
};

/// A run that was read from its files.
#[derive(Debug)]
pub struct Opened {
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
    /// The study in a recording is invalid.
    #[error(transparent)]
    Study(#[from] Box<StudyError>),
    /// A table of the run cannot be read.
    #[error(transparent)]
    Table(#[from] TableError),
    /// The recording of the run cannot be read.
    #[error(transparent)]
    Recording(#[from] recording::ReadError),
}

/// Reads the run at `path`.
///
/// # Errors
/// Returns an [`OpenError`] that names the file and says what is wrong in it.
pub fn open(path: &Path) -> Result<Opened, OpenError> {
    if path.extension().is_some_and(|extension| extension == "rrd") {
        // A recording beside tables is of the same run, and the tables are more exact.
        return match path.parent() {
            Some(folder) if RunFolder::is_at(folder) => open_folder(folder),
            _ => open_recording(path),
        };
    }
    let folder = if path.is_dir() { Some(path) } else { path.parent() };
    match folder {
        Some(folder) if RunFolder::is_at(folder) => open_folder(folder),
        _ => Err(OpenError::NoRun(path.to_owned())),
    }
}

fn open_folder(folder: &Path) -> Result<Opened, OpenError> {
    let run = RunFolder::open(folder)?;
    let mut store = Store::default();
    for entry in run.designs()? {
        store.push(&entry.row);
    }
    let front = match run.front()? {
        Some(front) => front
            .into_iter()
            .map(|entry| FrontEntry {
                id: entry.id,
                reference_radius: entry.reference_radius.unwrap_or(entry.row.radius),
                row: entry.row,
                verified: true,
                evaluation: None,
            })
            .collect(),
        None => front_of(&store),
    };
    Ok(Opened {
        study: run.study().clone(),
        store,
        front,
        // A run without a history can be opened, because only the curves need it.
        history: run.report().map(|report| report.history).unwrap_or_default(),
    })
}

fn open_recording(path: &Path) -> Result<Opened, OpenError> {
    let recorded = recording::read_run(path)?;
    let study = Study::parse(&recorded.study, &path.display().to_string()).map_err(Box::new)?;
    let mut store = Store::default();
    for (index, record) in recorded.designs.iter().enumerate() {
        let text = |column: Column| record.texts.get(&*column.name()).map(String::as_str);
        let number = |column: Column| record.numbers.get(&*column.name()).copied();
        let row = Row::read(&study, record.generation, text, number).map_err(|error| TableError {
            path: path.to_owned(),
            fault: TableFault::Design { index, error },
        })?;
        store.push(&row);
    }
    let front = front_of(&store);
    Ok(Opened {
        study,
        store,
        front,
        history: Vec::new(),
    })
}
