//! The run folder with the files `study.toml`, `designs.csv`, `front.csv` and `run.json`. The recording is written by
//! another listener.
//!
//! `study.toml` is written at the start, `designs.csv` grows as designs are evaluated, and `front.csv` and `run.json`
//! are written at the end. All files except `designs.csv` appear only when they are complete.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::Receiver;

use serde::Serialize;

use super::{AlgorithmName, Batch, EndReason, Event, GenerationSummary, RunSummary, RunTimes, Study};
use kinefront_model::evaluation::{Constraint, Evaluation};

/// First columns of `designs.csv` and `front.csv`; margins, values, active constraints and violation follow.
pub const TABLE_HEADER: [&str; 13] = [
    "id",
    "generation",
    "architecture",
    "working_mode",
    "R",
    "r",
    "Lb",
    "rj",
    "rp",
    "mass_kg",
    "workspace_radius_m",
    "phi_deg",
    "feasible",
];

/// Error of writing a run folder.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// The folder already holds a run.
    #[error("{} already holds a run ({found}); choose another folder, or move that one away", path.display())]
    Occupied {
        /// Path of the folder.
        path: PathBuf,
        /// Name of a file of the run that it holds.
        found: &'static str,
    },
    /// A file cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// Path of the file.
        path: PathBuf,
        /// Cause of the error.
        source: io::Error,
    },
}

/// Names of the files of a run.
const FILES: [&str; 5] = ["study.toml", "designs.csv", "front.csv", "run.json", "recording.rrd"];

/// A run folder that is being written.
#[derive(Debug)]
pub struct RunFolder {
    path: PathBuf,
    designs: csv::Writer<BufWriter<File>>,
}

/// Contents of `run.json`.
#[derive(Debug, Serialize)]
pub struct RunReport<'a> {
    kinefront_version: &'static str,
    study: &'a str,
    algorithm: AlgorithmName,
    architectures: Vec<&'static str>,
    seed: u64,
    threads: usize,
    outcome: EndReason,
    evaluations: usize,
    feasible: usize,
    generations: usize,
    front_size: usize,
    front_dropped_by_verification: usize,
    front_verified: usize,
    hypervolume_reference: HypervolumeReference,
    hypervolume_kg_m: f64,
    verified_hypervolume_kg_m: f64,
    times: RunTimes,
    history: &'a [GenerationSummary],
}

#[derive(Debug, Serialize)]
struct HypervolumeReference {
    mass_kg: f64,
    workspace_radius_m: f64,
}

impl<'a> RunReport<'a> {
    /// Creates the report on a run of `study`.
    pub fn new(study: &'a Study, summary: &'a RunSummary) -> Self {
        let last = summary.history.last();
        Self {
            kinefront_version: env!("CARGO_PKG_VERSION"),
            study: &study.name,
            algorithm: study.optimizer.algorithm,
            architectures: study
                .architectures
                .iter()
                .map(|architecture| architecture.name())
                .collect(),
            seed: study.optimizer.seed,
            threads: summary.threads,
            outcome: summary.outcome,
            evaluations: last.map_or(0, |last| last.evaluations),
            feasible: last.map_or(0, |last| last.feasible),
            generations: summary.history.len(),
            front_size: summary.front.len(),
            front_dropped_by_verification: summary.dropped,
            front_verified: summary.verified,
            hypervolume_reference: HypervolumeReference {
                mass_kg: study.hypervolume.reference_mass_kg,
                workspace_radius_m: 0.0,
            },
            hypervolume_kg_m: last.map_or(0.0, |last| last.hypervolume),
            verified_hypervolume_kg_m: summary.verified_hypervolume,
            times: summary.times,
            history: &summary.history,
        }
    }
}

impl RunFolder {
    /// Prepares `path` for a run of `study`: creates the folder, writes `study.toml` and the header of `designs.csv`.
    ///
    /// # Errors
    /// [`FolderError::Occupied`] if the folder already holds a run, [`FolderError::Write`] if it cannot be written.
    pub fn create(path: &Path, study: &Study) -> Result<Self, FolderError> {
        if let Some(found) = FILES.into_iter().find(|file| path.join(file).exists()) {
            return Err(FolderError::Occupied {
                path: path.to_owned(),
                found,
            });
        }
        let at = |path: &Path| {
            let path = path.to_owned();
            move |source| FolderError::Write { path, source }
        };
        fs::create_dir_all(path).map_err(at(path))?;
        let study_path = path.join("study.toml");
        let text = toml::to_string(study).map_err(|error| at(&study_path)(io::Error::other(error)))?;
        write_whole(&study_path, text.as_bytes())?;
        let designs_path = path.join("designs.csv");
        let file = File::create_new(&designs_path).map_err(at(&designs_path))?;
        let mut designs = csv::Writer::from_writer(BufWriter::new(file));
        designs
            .write_record(header())
            .and_then(|()| designs.flush().map_err(csv::Error::from))
            .map_err(|error| at(&designs_path)(io::Error::other(error)))?;
        Ok(Self {
            path: path.to_owned(),
            designs,
        })
    }

    /// Returns the path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Receives the events of a run and writes its files until the run ends.
    ///
    /// # Errors
    /// [`FolderError::Write`] for the first file that cannot be written; files written before are kept.
    pub fn follow(mut self, events: &Receiver<Arc<Event>>, study: &Study) -> Result<(), FolderError> {
        for event in events {
            match &*event {
                Event::Evaluated(batch) => self.append(batch)?,
                Event::Finished(summary) => self.finish(study, summary)?,
                _ => {}
            }
        }
        Ok(())
    }

    fn append(&mut self, batch: &Batch) -> Result<(), FolderError> {
        let mut write = || -> Result<(), csv::Error> {
            for (offset, evaluation) in batch.evaluations.iter().enumerate() {
                self.designs
                    .write_record(row(batch.first_id + offset, batch.generation, evaluation))?;
            }
            Ok(self.designs.flush()?)
        };
        write().map_err(|error| FolderError::Write {
            path: self.path.join("designs.csv"),
            source: io::Error::other(error),
        })
    }

    fn finish(&mut self, study: &Study, summary: &RunSummary) -> Result<(), FolderError> {
        let front_path = self.path.join("front.csv");
        let table = || -> Result<Vec<u8>, csv::Error> {
            let mut table = csv::Writer::from_writer(Vec::new());
            table.write_record(header().chain(["workspace_radius_reference_m", "mark"].map(str::to_owned)))?;
            for (member, mark) in summary.front.iter().zip(summary.marks()) {
                let record = row(member.id, member.generation, &member.evaluation);
                let more = [member.reference_radius.to_string(), mark.to_owned()];
                table.write_record(record.into_iter().chain(more))?;
            }
            table
                .into_inner()
                .map_err(|error| io::Error::other(error.to_string()).into())
        };
        let table = table().map_err(|error| FolderError::Write {
            path: front_path.clone(),
            source: io::Error::other(error),
        })?;
        write_whole(&front_path, &table)?;

        let report_path = self.path.join("run.json");
        let mut report =
            serde_json::to_vec_pretty(&RunReport::new(study, summary)).map_err(|error| FolderError::Write {
                path: report_path.clone(),
                source: error.into(),
            })?;
        report.push(b'\n');
        write_whole(&report_path, &report)
    }
}

fn header() -> impl Iterator<Item = String> {
    let named = |prefix: &'static str| Constraint::ALL.into_iter().map(move |c| format!("{prefix}_{}", c.id()));
    TABLE_HEADER
        .into_iter()
        .map(str::to_owned)
        .chain(named("margin"))
        .chain(named("value"))
        .chain(["active".to_owned(), "violation".to_owned()])
}

/// Returns a row of a table. Each number is written as the shortest text that parses to the same floating-point value.
fn row(id: usize, generation: usize, evaluation: &Evaluation) -> Vec<String> {
    let design = &evaluation.design;
    let optional = |number: Option<f64>| number.map(|number| number.to_string()).unwrap_or_default();
    let mut row = vec![
        id.to_string(),
        generation.to_string(),
        design.architecture.to_string(),
        design.working_mode.to_string(),
    ];
    row.extend(design.values().map(|value| value.to_string()));
    row.push(evaluation.mass.to_string());
    row.push(evaluation.workspace_radius.to_string());
    row.push(optional(evaluation.home_phi_deg));
    row.push(evaluation.is_feasible().to_string());
    row.extend(
        evaluation
            .constraints
            .iter()
            .map(|report| optional(report.required_margin())),
    );
    row.extend(evaluation.constraints.iter().map(|report| optional(report.value)));
    let active: Vec<&str> = evaluation.active().map(Constraint::id).collect();
    row.push(active.join("+"));
    row.push(evaluation.violation.to_string());
    row
}

/// Returns a CSV table of designs of several fronts. The designs are numbered; the columns are those of `designs.csv`,
/// and a last column says whether the design is on the joint front.
///
/// # Errors
/// A message that describes what went wrong.
pub fn front_table<'a>(members: impl Iterator<Item = (&'a Evaluation, bool)>) -> Result<Vec<u8>, String> {
    let mut table = csv::Writer::from_writer(Vec::new());
    let mut write = |record: Vec<String>| table.write_record(record).map_err(|error| error.to_string());
    write(header().chain(["on_joint_front".to_owned()]).collect())?;
    for (id, (evaluation, joint)) in members.enumerate() {
        write(row(id, 0, evaluation).into_iter().chain([joint.to_string()]).collect())?;
    }
    table.into_inner().map_err(|error| error.to_string())
}

/// Writes a file atomically: writes a temporary file in the same folder and renames it, so that the file is either
/// complete or unchanged.
///
/// # Errors
/// [`FolderError::Write`].
pub fn write_whole(path: &Path, contents: &[u8]) -> Result<(), FolderError> {
    let mut name = std::ffi::OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(".partial");
    let partial = path.with_file_name(name);
    let write = || -> io::Result<()> {
        let mut file = File::create(&partial)?;
        file.write_all(contents)?;
        file.sync_all()?;
        fs::rename(&partial, path)
    };
    write().map_err(|source| {
        // The partial file is useless; failing to remove it does not justify a second error.
        let _ = fs::remove_file(&partial);
        FolderError::Write {
            path: path.to_owned(),
            source,
        }
    })
}
