//! Input of a report: a search with the designs that it evaluated.

use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::sync_channel;

use super::ReportError;
use kinefront_study::{Event, Row, RunControl, RunFolder, RunTimes, Study, spawn};

/// A search with all the designs that it evaluated.
#[derive(Debug, Clone)]
pub struct Source {
    /// Name of the run folder or of the search.
    pub name: String,
    /// Study of the search.
    pub study: Study,
    /// All evaluated designs.
    pub rows: Vec<Row>,
    /// Times taken by the stages of the search, if known \[s\].
    pub times: Option<RunTimes>,
    /// Version of the program that ran the search; empty if unknown.
    pub version: String,
    /// Line of an incomplete last row of the table, which was left out.
    pub cut_line: Option<u64>,
}

impl Source {
    /// Reads a run folder.
    ///
    /// # Errors
    /// [`ReportError`] if the folder is not a run folder or one of its files is invalid.
    pub fn read(folder: &Path) -> Result<Self, ReportError> {
        let run = RunFolder::open(folder)?;
        let report = run.report();
        let designs = run.designs()?;
        Ok(Self {
            name: run.name(),
            study: run.study().clone(),
            cut_line: designs.cut_line,
            rows: designs.rows.into_iter().map(|entry| entry.row).collect(),
            times: report.map(|report| report.times),
            version: report
                .map(|report| report.kinefront_version.clone())
                .unwrap_or_default(),
        })
    }

    /// Searches a study and collects its designs; what the run would report of them is not verified.
    ///
    /// # Errors
    /// [`ReportError::Run`] if the run fails.
    pub fn search(name: &str, study: Study) -> Result<Self, ReportError> {
        let mut searched = study.clone();
        // The least that a run reports: the designs of a search do not depend on it.
        searched.optimizer.front_designs = 3;
        searched.workspace.certify = false;
        Ok(Self {
            study,
            ..Self::run(name, searched)?
        })
    }

    /// Runs a study to its end and collects its designs.
    ///
    /// # Errors
    /// [`ReportError::Run`] if the run fails.
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
                Event::Evaluated(batch) => rows.extend(&batch.rows),
                Event::Finished(summary) => times = Some(summary.times),
                Event::Failed(message) => broken = Some(message.clone()),
                Event::Started(_) | Event::Generation(_) | Event::Front(_) | Event::Concluding { .. } => {}
            }
        }
        if worker.join().is_err() {
            broken = broken.or_else(|| Some("the worker thread panicked".to_owned()));
        }
        match broken {
            Some(message) => Err(failed(message)),
            None => Ok(Self {
                name: name.to_owned(),
                study,
                rows,
                times,
                version: env!("CARGO_PKG_VERSION").to_owned(),
                cut_line: None,
            }),
        }
    }
}
