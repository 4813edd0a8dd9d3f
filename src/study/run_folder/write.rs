//! Writing a run folder.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::Receiver;

use super::{DESIGNS, FRONT, RECORDING, REPORT, RunReport, STUDY};
use crate::study::table::{Cell, Column, Row, TableRow, TableWriter, table_bytes};
use crate::study::{Batch, Event, RunSummary, Study};

/// Error of writing a run folder.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The folder already holds a run.
    #[error("{} already holds a run ({found}); choose another folder, or move that one away", path.display())]
    Occupied {
        /// Path of the folder.
        path: PathBuf,
        /// Name of a file of the run that it holds.
        found: &'static str,
    },
    /// A file cannot be written.
    #[error("cannot write {}: {cause}", path.display())]
    Write {
        /// Path of the file.
        path: PathBuf,
        /// Cause of the error.
        cause: io::Error,
    },
}

/// Names of the files of a run.
const FILES: [&str; 5] = [STUDY, DESIGNS, FRONT, REPORT, RECORDING];

/// A run folder that is being written.
#[derive(Debug)]
pub struct RunWriter {
    path: PathBuf,
    designs: TableWriter<BufWriter<File>>,
}

impl RunWriter {
    /// Prepares `path` for a run of `study`: creates the folder, writes `study.toml` and the header of `designs.csv`.
    ///
    /// # Errors
    /// [`WriteError::Occupied`] if the folder already holds a run, [`WriteError::Write`] if it cannot be written.
    pub fn create(path: &Path, study: &Study) -> Result<Self, WriteError> {
        if let Some(found) = FILES.into_iter().find(|file| path.join(file).exists()) {
            return Err(WriteError::Occupied {
                path: path.to_owned(),
                found,
            });
        }
        let at = |path: &Path| {
            let path = path.to_owned();
            move |cause| WriteError::Write { path, cause }
        };
        fs::create_dir_all(path).map_err(at(path))?;
        let study_path = path.join(STUDY);
        let text = toml::to_string(study).map_err(|error| at(&study_path)(io::Error::other(error)))?;
        write_whole(&study_path, text.as_bytes())?;
        let designs_path = path.join(DESIGNS);
        let file = File::create_new(&designs_path).map_err(at(&designs_path))?;
        let designs = TableWriter::new(BufWriter::new(file), Column::of_designs()).map_err(at(&designs_path))?;
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
    /// [`WriteError::Write`] for the first file that cannot be written; files written before are kept.
    pub fn follow(mut self, events: &Receiver<Arc<Event>>, study: &Study) -> Result<(), WriteError> {
        for event in events {
            match &*event {
                Event::Evaluated(batch) => self.append(batch)?,
                Event::Finished(summary) => self.finish(study, summary)?,
                _ => {}
            }
        }
        Ok(())
    }

    fn append(&mut self, batch: &Batch) -> Result<(), WriteError> {
        let mut write = || -> io::Result<()> {
            for (offset, evaluation) in batch.evaluations.iter().enumerate() {
                let entry = TableRow {
                    id: batch.first_id + offset,
                    row: Row::new(batch.generation, evaluation),
                    reference_radius: None,
                };
                self.designs
                    .write(Column::of_designs().map(|column| column.cell(&entry)))?;
            }
            self.designs.flush()
        };
        write().map_err(|cause| WriteError::Write {
            path: self.path.join(DESIGNS),
            cause,
        })
    }

    fn finish(&mut self, study: &Study, summary: &RunSummary) -> Result<(), WriteError> {
        let front_path = self.path.join(FRONT);
        let rows = summary.front.iter().zip(summary.marks()).map(|(member, mark)| {
            let entry = TableRow {
                id: member.id,
                row: Row::new(member.generation, &member.evaluation),
                reference_radius: Some(member.reference_radius),
            };
            let cell = |column| match column {
                Column::Mark => Cell::Text(mark.into()),
                column => column.cell(&entry),
            };
            Column::of_front().map(cell).collect()
        });
        let table = table_bytes(Column::of_front(), rows).map_err(|cause| WriteError::Write {
            path: front_path.clone(),
            cause,
        })?;
        write_whole(&front_path, &table)?;

        let report_path = self.path.join(REPORT);
        let mut report =
            serde_json::to_vec_pretty(&RunReport::new(study, summary)).map_err(|error| WriteError::Write {
                path: report_path.clone(),
                cause: error.into(),
            })?;
        report.push(b'\n');
        write_whole(&report_path, &report)
    }
}

/// Writes a file atomically: writes a temporary file in the same folder and renames it, so that the file is either
/// complete or unchanged.
///
/// # Errors
/// [`WriteError::Write`].
pub fn write_whole(path: &Path, contents: &[u8]) -> Result<(), WriteError> {
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
    write().map_err(|cause| {
        // The partial file is useless; failing to remove it does not justify a second error.
        let _ = fs::remove_file(&partial);
        WriteError::Write {
            path: path.to_owned(),
            cause,
        }
    })
}
