//! Resuming a run from its folder.

use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::{Path, PathBuf};

use super::design_table::DesignTable;
use super::lock::open_locked;
use super::{DESIGNS, RECORDING, RunFolder, RunFolderError, RunWriter};
use crate::WriteError;
use crate::durable::remove;
use crate::{EndReason, ReplayError, Study, StudySearch, TableError};

/// A run that can be resumed: its folder is locked, and its designs were replayed.
///
/// The algorithms are deterministic, so that the table of the designs determines their state: an algorithm is asked for
/// each generation and told the outcomes that the table holds. Nothing in the folder is changed before
/// [`Resumption::start`].
#[derive(Debug)]
pub struct Resumption {
    folder: RunFolder,
    table: DesignTable,
    search: StudySearch,
    /// Complete rows.
    evaluated: usize,
    /// Rows of complete generations, which are kept.
    kept: usize,
    record_every: Option<usize>,
    notes: Vec<String>,
    is_complete: bool,
}

/// How a run is resumed.
#[derive(Debug, Clone, Copy, Default)]
pub struct ResumeOptions {
    /// Number of evaluations; that of the study if `None`.
    pub evaluations: Option<usize>,
    /// Number of worker threads; that of the study if `None`.
    pub threads: Option<usize>,
    /// Whether a folder that states nothing of its table is resumed with the rows that are there.
    pub accept_unverified: bool,
}

/// Why a run cannot be resumed.
#[derive(Debug, thiserror::Error)]
pub enum ResumeError {
    /// The folder cannot be read.
    #[error(transparent)]
    Folder(#[from] RunFolderError),
    /// Another process writes the run, or the folder cannot be locked.
    #[error(transparent)]
    Lock(WriteError),
    /// The table of the designs is damaged.
    #[error(transparent)]
    Table(#[from] TableError),
    /// The folder does not state what its table has to be.
    #[error(
        "{} does not state the size and the checksum of its designs, so lost rows would go unnoticed; --accept-unverified \
         resumes it with the rows that it contains",
        .0.display()
    )]
    Unverified(PathBuf),
    /// The budget is smaller than what was evaluated.
    #[error("{} already holds {evaluated} evaluations; --evaluations must be at least that many, not {asked}", path.display())]
    Budget {
        /// Path of the folder.
        path: PathBuf,
        /// Evaluations of the run.
        evaluated: usize,
        /// Evaluations asked for.
        asked: usize,
    },
    /// The folder holds the designs of several runs.
    #[error(
        "{} holds the designs of several runs, which no single search can continue; resume one of the runs and merge again",
        .0.display()
    )]
    Merged(PathBuf),
    /// The rows are not those of a run of the study.
    #[error("{}: {cause}", path.display())]
    Replay {
        /// Path of the table.
        path: PathBuf,
        /// The first difference.
        cause: ReplayError,
    },
}

impl ResumeError {
    /// Whether the system is the reason, and not what is in the folder.
    pub fn is_of_system(&self) -> bool {
        matches!(self, Self::Folder(error) if error.is_of_system())
    }
}

impl Resumption {
    /// Locks the run folder at `path` and replays its designs.
    ///
    /// # Errors
    /// [`ResumeError`]; the folder is unchanged.
    pub fn open(path: &Path, options: &ResumeOptions) -> Result<Self, ResumeError> {
        let ResumeOptions {
            evaluations,
            threads,
            accept_unverified,
        } = *options;
        if !RunFolder::is_at(path) {
            return Err(RunFolderError::NoRun(path.to_owned()).into());
        }
        let file = open_locked(path, false).map_err(ResumeError::Lock)?;
        let folder = RunFolder::open(path)?;
        folder.require_this_version()?;
        if !folder.is_verifiable() && !accept_unverified {
            return Err(ResumeError::Unverified(path.to_owned()));
        }
        let mut notes = Vec::new();
        let table = DesignTable::over(file, path, folder.study());
        let contents = folder.designs_to_resume(&mut notes)?;
        let evaluated = contents.rows.len();
        let study = study_to_resume(&folder, evaluations, evaluated)?;
        if let Some(line) = contents.cut_line {
            notes.push(format!("line {line} of {DESIGNS} was incomplete and was removed"));
        }
        let search = folder.replayed(study, contents.rows, threads)?;
        let search = search.map_err(|cause| ResumeError::Replay {
            path: folder.designs_path(),
            cause,
        })?;
        let kept = search.replayed();
        if kept < evaluated {
            notes.push(format!(
                "the last generation was incomplete; {} designs are evaluated again",
                evaluated - kept
            ));
        }
        let is_complete = folder.report().is_some_and(|report| {
            report.outcome == EndReason::Completed && report.evaluations == search.study().optimizer.evaluations
        }) && kept == evaluated
            && evaluated == search.study().optimizer.evaluations;
        let record_every = match (folder.checkpoint(), folder.report()) {
            (Some(checkpoint), _) => checkpoint.record_every,
            (_, Some(report)) if report.files.is_some() => report.record_every,
            _ => Some(1),
        };
        Ok(Self {
            folder,
            table,
            search,
            evaluated,
            kept,
            record_every,
            notes,
            is_complete,
        })
    }

    /// The search, with the designs of the complete generations replayed.
    pub fn search(&self) -> &StudySearch {
        &self.search
    }

    /// Whether nothing is left to do: the run used its budget and stated that its files are complete.
    pub fn is_complete(&self) -> bool {
        self.is_complete
    }

    /// The run as its folder describes it.
    pub fn folder(&self) -> &RunFolder {
        &self.folder
    }

    /// Every how many generations one was recorded; `None` for a run without a recording.
    pub fn record_every(&self) -> Option<usize> {
        self.record_every
    }

    /// What was found in the folder that its user should know.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Removes an incomplete last row, and nothing else.
    ///
    /// # Errors
    /// [`WriteError`] if the table cannot be cut.
    pub fn cut(mut self) -> Result<(), WriteError> {
        let path = self.folder.designs_path();
        match end_of_row(&path, self.evaluated).map_err(WriteError::at(&path))? {
            Some(end) => self.table.keep(self.evaluated, end),
            None => self.table.begin(),
        }
    }

    /// Begins to write the folder again: cuts the table after its last complete generation, and removes the recording, which
    /// follows from the designs and is regenerated.
    ///
    /// # Errors
    /// [`WriteError`] if a file cannot be written; the run can still be resumed.
    pub fn start(self, record_every: Option<usize>) -> Result<(RunWriter, StudySearch), WriteError> {
        let Self {
            folder,
            mut table,
            search,
            kept,
            ..
        } = self;
        let path = folder.path();
        let end = end_of_row(&folder.designs_path(), kept).map_err(WriteError::at(&folder.designs_path()))?;
        match end {
            Some(end) => table.keep(kept, end)?,
            None => table.begin()?,
        }
        let mut writer = RunWriter::start(path, search.study(), record_every, table)?;
        if !folder.merged().is_empty() {
            writer.set_merged(folder.merged().to_vec())?;
        }
        // The recording is rewritten from its beginning. The front stays until there is a new one.
        remove(&path.join(RECORDING))?;
        Ok((writer, search))
    }
}

/// Returns the study of a folder with the number of evaluations that is asked for, if the folder's designs allow it.
fn study_to_resume(folder: &RunFolder, asked: Option<usize>, evaluated: usize) -> Result<Study, ResumeError> {
    let mut study = folder.study().clone();
    if let Some(asked) = asked {
        if asked < evaluated {
            return Err(ResumeError::Budget {
                path: folder.path().to_owned(),
                evaluated,
                asked,
            });
        }
        study.optimizer.evaluations = asked;
    }
    // A merged folder is complete, or its merge was killed; nothing can be searched in it.
    if !folder.merged().is_empty() && study.optimizer.evaluations != evaluated {
        return Err(ResumeError::Merged(folder.path().to_owned()));
    }
    Ok(study)
}

/// Returns the byte at which row `rows` of a table ends, where 0 is the header; `None` if the header is incomplete.
fn end_of_row(path: &Path, rows: usize) -> io::Result<Option<u64>> {
    let mut reader = BufReader::new(File::open(path)?);
    let mut line = Vec::new();
    let mut end = 0;
    for _ in 0..=rows {
        line.clear();
        let count = reader.read_until(b'\n', &mut line)?;
        if line.last() != Some(&b'\n') {
            return Ok(None);
        }
        end += count as u64;
    }
    Ok(Some(end))
}
