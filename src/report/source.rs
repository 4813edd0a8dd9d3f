//! What a report is made of: designs that a search evaluated.

use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::sync_channel;

use super::ReportError;
use kinefront_model::evaluation::Evaluation;
use crate::study::{Event, Row, RunControl, RunTimes, Study, read_table, spawn};

/// A search with all designs that it evaluated.
#[derive(Debug, Clone)]
pub struct Source {
    /// Where it comes from: a folder, or what was searched.
    pub name: String,
    /// Its study.
    pub study: Study,
    /// Its designs.
    pub rows: Vec<Row>,
    /// Where its time went, if it is known \[s\].
    pub times: Option<RunTimes>,
    /// Version of the program that made it, if it is known.
    pub version: String,
}

impl Source {
    /// Reads a run's folder.
    ///
    /// # Errors
    /// [`ReportError`] when it holds no run, or a file of it is wrong.
    pub fn read(folder: &Path) -> Result<Self, ReportError> {
        let (study, designs) = (folder.join("study.toml"), folder.join("designs.csv"));
        if !study.exists() || !designs.exists() {
            return Err(ReportError::NoRun(folder.to_owned()));
        }
        let study = Study::read(&study).map_err(|error| ReportError::Study(Box::new(error)))?;
        let rows = read_table(&designs, &study)?
            .into_iter()
            .map(|entry| entry.row)
            .collect();
        // Its name alone: where it lies is nothing to publish.
        let name = folder.canonicalize().ok();
        let name = name
            .as_deref()
            .unwrap_or(folder)
            .file_name()
            .unwrap_or(folder.as_os_str());
        let told = told(&folder.join("run.json"));
        Ok(Self {
            name: name.to_string_lossy().into_owned(),
            times: told.as_ref().map(|told| told.times),
            version: told.map(|told| told.kinefront_version).unwrap_or_default(),
            study,
            rows,
        })
    }

    /// Runs a study to its end.
    ///
    /// # Errors
    /// [`ReportError::Run`] when it breaks off.
    pub fn run(name: &str, study: Study) -> Result<Self, ReportError> {
        let failed = |message: String| ReportError::Run {
            name: name.to_owned(),
            message,
        };
        let (sender, events) = sync_channel(64);
        let worker = spawn(study.clone(), Arc::new(RunControl::default()), vec![sender])
            .map_err(|error| failed(error.to_string()))?;
        let (mut rows, mut times, mut broken) = (Vec::new(), None, None);
        for event in events {
            match &*event {
                Event::Evaluated(batch) => {
                    let row = |evaluation: &Evaluation| Row::new(batch.generation, evaluation);
                    rows.extend(batch.evaluations.iter().map(row));
                }
                Event::Finished(summary) => times = Some(summary.times),
                Event::Failed(message) => broken = Some(message.clone()),
                Event::Started(_) | Event::Generation(_) | Event::Front(_) | Event::Verifying { .. } => {}
            }
        }
        if worker.join().is_err() {
            broken = broken.or_else(|| Some("its thread panicked".to_owned()));
        }
        match broken {
            Some(message) => Err(failed(message)),
            None => Ok(Self {
                name: name.to_owned(),
                study,
                rows,
                times,
                version: env!("CARGO_PKG_VERSION").to_owned(),
            }),
        }
    }
}

/// What a report takes of `run.json`.
#[derive(serde::Deserialize)]
struct Told {
    times: RunTimes,
    kinefront_version: String,
}

/// A report does without: a run that was killed has none.
fn told(path: &Path) -> Option<Told> {
    serde_json::from_slice(&std::fs::read(path).ok()?).ok()
}
