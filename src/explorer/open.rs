//! Opens the results of a run: its folder, one of its tables, or its recording.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::front::front_of;
use super::{FrontEntry, Store};
use crate::recording;
use crate::study::{GenerationSummary, Row, Study, TableError, read_table};

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
    /// The study of the run cannot be read.
    #[error("{0}")]
    Study(String),
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
        let inside = path.with_file_name("designs.csv");
        // A recording beside tables is of the same run, and the tables are more exact.
        return match path.parent() {
            Some(folder) if inside.exists() && folder.join("study.toml").exists() => open_folder(folder),
            _ => open_recording(path),
        };
    }
    let folder = if path.is_dir() { Some(path) } else { path.parent() };
    match folder {
        Some(folder) if folder.join("designs.csv").exists() && folder.join("study.toml").exists() => {
            open_folder(folder)
        }
        _ => Err(OpenError::NoRun(path.to_owned())),
    }
}

fn open_folder(folder: &Path) -> Result<Opened, OpenError> {
    let study = Study::read(&folder.join("study.toml")).map_err(|error| OpenError::Study(error.to_string()))?;
    let mut store = Store::default();
    for entry in read_table(&folder.join("designs.csv"), &study)? {
        store.push(&entry.row);
    }
    let front_path = folder.join("front.csv");
    let front = if front_path.exists() {
        read_table(&front_path, &study)?
            .into_iter()
            .map(|entry| FrontEntry {
                id: entry.id,
                reference_radius: entry.reference_radius.unwrap_or(entry.row.radius),
                row: entry.row,
                verified: true,
            })
            .collect()
    } else {
        front_of(&store)
    };
    Ok(Opened {
        study,
        store,
        front,
        history: history(&folder.join("run.json")),
    })
}

fn open_recording(path: &Path) -> Result<Opened, OpenError> {
    let recorded = recording::read_run(path)?;
    let study = Study::parse(&recorded.study, &path.display().to_string())
        .map_err(|error| OpenError::Study(error.to_string()))?;
    let mut store = Store::default();
    for (index, record) in recorded.designs.iter().enumerate() {
        let text = |name: &str| record.texts.get(name).map(String::as_str);
        let number = |name: &str| record.numbers.get(name).copied();
        let row = Row::read(&study, record.generation, text, number).map_err(|message| TableError {
            path: path.to_owned(),
            message: format!("design #{index}: {message}"),
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

/// Reads the summaries of the generations; a run without them can be opened, because only the curves need them.
fn history(path: &Path) -> Vec<GenerationSummary> {
    #[derive(Deserialize)]
    struct GenerationHistory {
        history: Vec<GenerationSummary>,
    }
    std::fs::read(path)
        .ok()
        .and_then(|bytes| serde_json::from_slice::<GenerationHistory>(&bytes).ok())
        .map(|report| report.history)
        .unwrap_or_default()
}
