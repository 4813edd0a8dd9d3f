//! Opening what a run left: its folder, one of its tables, or its recording.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::front::front_of;
use super::{FrontEntry, Row, Store};
use crate::evaluation::Constraint;
use crate::mechanism::{Design, VARIABLES};
use crate::recording;
use crate::study::{GenerationSummary, Study};

/// A run that was read back.
#[derive(Debug)]
pub struct Opened {
    /// The study as run.
    pub study: Study,
    /// Every evaluated design.
    pub store: Store,
    /// The front, verified where the run got that far.
    pub front: Vec<FrontEntry>,
    /// State after each generation, where it was kept.
    pub history: Vec<GenerationSummary>,
}

/// Why a run cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum OpenError {
    /// Neither a folder of a run nor a recording.
    #[error("{} is no run: expected a folder with study.toml and designs.csv, or a recording (.rrd)", .0.display())]
    NoRun(PathBuf),
    /// Its study.
    #[error("{0}")]
    Study(String),
    /// A table.
    #[error("{}: {message}", path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// What is wrong, and where.
        message: String,
    },
    /// Its recording.
    #[error(transparent)]
    Recording(#[from] recording::ReadError),
}

/// Reads the run at `path`.
///
/// # Errors
/// [`OpenError`] with the file and what is wrong in it.
pub fn open(path: &Path) -> Result<Opened, OpenError> {
    if path.extension().is_some_and(|extension| extension == "rrd") {
        let inside = path.with_file_name("designs.csv");
        // Beside its tables a recording is the same run, which they tell more exactly.
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
    for (_, row, _) in table(&folder.join("designs.csv"), &study)? {
        store.push(&row);
    }
    let front_path = folder.join("front.csv");
    let front = if front_path.exists() {
        table(&front_path, &study)?
            .into_iter()
            .map(|(id, row, reference)| FrontEntry {
                id,
                reference_radius: reference.unwrap_or(row.radius),
                row,
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
        let row = row(&study, record.generation, text, number).map_err(|message| OpenError::Table {
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

/// Curves are a nicety: a run without them opens all the same.
fn history(path: &Path) -> Vec<GenerationSummary> {
    #[derive(Deserialize)]
    struct Report {
        history: Vec<GenerationSummary>,
    }
    std::fs::read(path)
        .ok()
        .and_then(|bytes| serde_json::from_slice::<Report>(&bytes).ok())
        .map(|report| report.history)
        .unwrap_or_default()
}

/// Id, numbers, and `R_w` on the reference grid where it stands beside.
type TableRow = (usize, Row, Option<f64>);

fn table(path: &Path, study: &Study) -> Result<Vec<TableRow>, OpenError> {
    let fault = |message: String| OpenError::Table {
        path: path.to_owned(),
        message,
    };
    let mut reader = csv::Reader::from_path(path).map_err(|error| fault(error.to_string()))?;
    let header = reader.headers().map_err(|error| fault(error.to_string()))?.clone();
    let place = |name: &str| header.iter().position(|title| title == name);
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = match record {
            Ok(record) => record,
            // The last line of a run that was killed may be half a line.
            Err(error) if matches!(error.kind(), csv::ErrorKind::UnequalLengths { .. }) && !rows.is_empty() => break,
            Err(error) => return Err(fault(error.to_string())),
        };
        let line = record.position().map_or(0, csv::Position::line);
        let text = |name: &str| record.get(place(name)?);
        let number = |name: &str| text(name)?.parse::<f64>().ok();
        let whole = |name: &str| {
            number(name)
                .map(|value| value as usize)
                .ok_or_else(|| fault(format!("line {line}: no `{name}`")))
        };
        let row = row(study, whole("generation")?, text, number)
            .map_err(|message| fault(format!("line {line}: {message}")))?;
        rows.push((whole("id")?, row, number("workspace_radius_reference_m")));
    }
    Ok(rows)
}

/// A row from named texts and numbers, as in `designs.csv`.
fn row<'a>(
    study: &Study,
    generation: usize,
    text: impl Fn(&str) -> Option<&'a str>,
    number: impl Fn(&str) -> Option<f64>,
) -> Result<Row, String> {
    let wanted = |name: &str| number(name).ok_or_else(|| format!("no number `{name}`"));
    let architecture = text("architecture")
        .ok_or("no `architecture`")?
        .parse()
        .map_err(|error| format!("{error}"))?;
    let mode = match text("working_mode") {
        Some(mode) => mode.parse().map_err(|error| format!("{error}"))?,
        None => study.working_mode,
    };
    let mut values = [0.0; VARIABLES.len()];
    for (value, variable) in values.iter_mut().zip(VARIABLES) {
        *value = wanted(variable.key())?;
    }
    let design = Design::new(architecture, mode, values).map_err(|error| error.to_string())?;
    let mut margins = [0.0; Constraint::ALL.len()];
    for (margin, constraint) in margins.iter_mut().zip(Constraint::ALL) {
        *margin = wanted(&format!("margin_{}", constraint.id()))?;
    }
    let active = text("active").unwrap_or_default();
    let active = Constraint::ALL
        .into_iter()
        .filter(|constraint| active.split('+').any(|id| id == constraint.id()))
        .fold(0, |bits, constraint| bits | 1 << constraint as u8);
    Ok(Row {
        generation: generation.try_into().unwrap_or(u32::MAX),
        design,
        mass: wanted("mass_kg")?,
        radius: wanted("workspace_radius_m")?,
        phi: number("phi_deg"),
        violation: wanted("violation")?,
        margins,
        active,
    })
}
