//! Writing a run folder.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde::Serialize;

use super::design_table::DesignTable;
use super::lock::open_locked;
use super::{Checkpoint, DESIGNS, FRONT, FileSums, MergedRun, PROGRESS, RECORDING, REPORT, RunReport, STUDY};
use crate::FileSum;
use crate::durable::{remove, sweep, sync_folder};
use crate::table::{Column, table_bytes};
use crate::{Event, RunSummary, Study};
use crate::{WriteError, write_whole};

/// Time between two checkpoints: at most the designs of this time are lost when the power fails.
const CHECKPOINT_INTERVAL: Duration = Duration::from_secs(5);

/// A checkpoint waits until this many times the duration of the last one has passed, so that a slow disk takes at most
/// 2 % of the time of a run.
const CHECKPOINT_SHARE: u32 = 50;

/// A run folder that is being written. It stays locked until the writer is dropped.
#[derive(Debug)]
pub struct RunWriter {
    path: PathBuf,
    study: Study,
    record_every: Option<usize>,
    study_sum: FileSum,
    table: DesignTable,
    checkpoint_at: Instant,
    /// The runs whose designs the folder holds, if they are several.
    merged: Vec<MergedRun>,
}

impl RunWriter {
    /// Prepares `path` for a run of `study`: creates and locks the folder, and writes `study.toml` and the header of
    /// `designs.csv`. The remains of a start that was killed are replaced.
    ///
    /// # Errors
    /// [`WriteError::Occupied`] if the folder already holds a run, [`WriteError::InUse`] if another process prepares it,
    /// [`WriteError::Write`] if it cannot be written.
    pub fn create(path: &Path, study: &Study, record_every: Option<usize>) -> Result<Self, WriteError> {
        let occupied = || {
            let found = [STUDY, FRONT, REPORT, RECORDING]
                .into_iter()
                .find(|file| path.join(file).exists());
            found.map_or(Ok(()), |found| {
                Err(WriteError::Occupied {
                    path: path.to_owned(),
                    found,
                })
            })
        };
        occupied()?;
        fs::create_dir_all(path).map_err(WriteError::at(path))?;
        // The folder itself must survive a power loss, and so must one that was created to hold it. A folder of others may not
        // be open to us; it was not created here then.
        for folder in path.ancestors().skip(1).take(2) {
            match sync_folder(folder) {
                Err(error) if error.kind() != io::ErrorKind::PermissionDenied => {
                    return Err(WriteError::at(folder)(error));
                }
                _ => {}
            }
        }
        // The lock decides between two processes that start at once.
        let file = open_locked(path, true)?;
        occupied()?;
        let mut table = DesignTable::over(file, path, study);
        if !table.is_begun_at_most()? {
            return Err(WriteError::Occupied {
                path: path.to_owned(),
                found: DESIGNS,
            });
        }
        table.begin()?;
        Self::start(path, study, record_every, table)
    }

    /// Starts to write a folder whose table is ready: writes the study and the first checkpoint.
    pub(super) fn start(
        path: &Path,
        study: &Study,
        record_every: Option<usize>,
        table: DesignTable,
    ) -> Result<Self, WriteError> {
        let study_path = path.join(STUDY);
        let text = toml::to_string(study).map_err(|error| WriteError::at(&study_path)(io::Error::other(error)))?;
        let mut writer = Self {
            path: path.to_owned(),
            study: study.clone(),
            record_every,
            study_sum: FileSum::of(text.as_bytes()),
            table,
            checkpoint_at: Instant::now(),
            merged: Vec::new(),
        };
        sweep(path).map_err(WriteError::at(path))?;
        // While the study is replaced, its sum is unknown: a crash between the two files must not look like damage.
        writer.table.synchronize()?;
        writer.write_checkpoint(None)?;
        remove(&path.join(REPORT))?;
        write_whole(&study_path, text.as_bytes())?;
        writer.checkpoint()?;
        Ok(writer)
    }

    /// States the runs whose designs the folder holds.
    pub(super) fn set_merged(&mut self, merged: Vec<MergedRun>) -> Result<(), WriteError> {
        self.merged = merged;
        self.checkpoint()
    }

    /// Returns the path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The path of the recording.
    pub fn recording_path(&self) -> PathBuf {
        self.path.join(RECORDING)
    }

    /// Every how many generations one is recorded; `None` for a run without a recording.
    pub fn record_every(&self) -> Option<usize> {
        self.record_every
    }

    /// Writes the designs of an event, if there is one; the rows that a resumed run already has are not written again. The
    /// rows are handed to the operating system before this function returns, and reach the disk every few seconds.
    ///
    /// # Errors
    /// [`WriteError`]; the table then ends with its last complete row.
    pub fn write(&mut self, event: Option<&Event>) -> Result<(), WriteError> {
        if let Some(Event::Evaluated(batch)) = event
            && batch.first_id >= self.table.sum.rows.unwrap_or(0)
        {
            self.table.append(batch)?;
        }
        if Instant::now() >= self.checkpoint_at {
            self.checkpoint()?;
        }
        Ok(())
    }

    /// Writes `front.csv` and `run.json`.
    ///
    /// # Errors
    /// [`WriteError`] for the first file that cannot be written; files written before are kept.
    pub fn finish(&mut self, summary: &RunSummary) -> Result<(), WriteError> {
        self.checkpoint()?;
        let front_sum = if summary.verified_front() {
            let front_path = self.path.join(FRONT);
            let front = front_table(&self.study, summary).map_err(WriteError::at(&front_path))?;
            write_whole(&front_path, &front)?;
            Some(FileSum {
                rows: Some(summary.front.len()),
                ..FileSum::of(&front)
            })
        } else {
            // What is there is the front of an earlier, shorter run of the folder.
            remove(&self.path.join(FRONT))?;
            None
        };
        let report = RunReport {
            record_every: self.record_every,
            files: Some(FileSums {
                study: Some(self.study_sum),
                designs: Some(self.table.sum),
                front: front_sum,
            }),
            merged: self.merged.clone(),
            ..RunReport::new(&self.study, summary)
        };
        write_json(&self.path.join(REPORT), &report)
    }

    /// Removes `progress.json`, which marks the run as ended: all its files are complete.
    ///
    /// # Errors
    /// [`WriteError`] if the file cannot be removed.
    pub fn conclude(&mut self) -> Result<(), WriteError> {
        remove(&self.path.join(PROGRESS))?;
        sync_folder(&self.path).map_err(WriteError::at(&self.path))
    }

    /// Synchronises the table to the disk and states so in `progress.json`.
    fn checkpoint(&mut self) -> Result<(), WriteError> {
        let start = Instant::now();
        self.table.check()?;
        self.table.synchronize()?;
        self.write_checkpoint(Some(self.study_sum))?;
        self.checkpoint_at = Instant::now() + CHECKPOINT_INTERVAL.max(CHECKPOINT_SHARE * start.elapsed());
        Ok(())
    }

    fn write_checkpoint(&self, study: Option<FileSum>) -> Result<(), WriteError> {
        let checkpoint = Checkpoint {
            kinefront_version: env!("CARGO_PKG_VERSION").to_owned(),
            record_every: self.record_every,
            study,
            designs: self.table.sum,
            merged: self.merged.clone(),
        };
        write_json(&self.path.join(PROGRESS), &checkpoint)
    }
}

/// Writes a JSON file with an end of its last line.
fn write_json(path: &Path, contents: &impl Serialize) -> Result<(), WriteError> {
    let mut text = serde_json::to_vec_pretty(contents).map_err(|error| WriteError::at(path)(error.into()))?;
    text.push(b'\n');
    write_whole(path, &text)
}

/// Returns the verified front as a table.
pub(super) fn front_table(study: &Study, summary: &RunSummary) -> io::Result<Vec<u8>> {
    let catalogues = study.catalogues();
    let rows = summary.front.iter().zip(summary.marks(study)).map(|(member, mark)| {
        let entry = member.row();
        let cell = |column: Column| column.cell_of_front(&entry, &mark, &catalogues);
        Column::of_front(study).map(cell).collect()
    });
    table_bytes(Column::of_front(study), rows)
}
