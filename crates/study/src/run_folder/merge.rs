//! Joining the runs of equal studies into one run folder.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::{MergedRun, RunFolder, RunFolderError, RunWriter};
use crate::table::archive_of;
use crate::{FileSum, ReplayError, Row, Study, StudySearch, TableError, TableRow};
use crate::{WriteError, write_whole};

/// Name of the file that states from which run each design of a merged folder comes.
pub(super) const ORIGINS: &str = "origins.csv";

/// Why runs cannot be joined.
#[derive(Debug, thiserror::Error)]
pub enum MergeError {
    /// A folder cannot be read.
    #[error(transparent)]
    Folder(#[from] RunFolderError),
    /// The table of the designs of a run is damaged.
    #[error(transparent)]
    Table(#[from] TableError),
    /// A folder does not state what its table has to be.
    #[error(
        "{} does not state the size and the checksum of its designs, so lost rows would go unnoticed; kinefront optimize \
         --resume --accept-unverified completes it",
        .0.display()
    )]
    Unverified(PathBuf),
    /// Two runs ask different questions.
    #[error(
        "{} and {} are runs of different studies: `{key}` differs; only the seed, the budget and the name of the study may differ",
        first.display(),
        path.display()
    )]
    Study {
        /// Path of the first run.
        first: PathBuf,
        /// Path of the other run.
        path: PathBuf,
        /// The setting that differs.
        key: String,
    },
    /// A run is given twice.
    #[error("{} and {} hold the same designs; list each run once", first.display(), path.display())]
    Twice {
        /// Path of the first run.
        first: PathBuf,
        /// Path of the other run.
        path: PathBuf,
    },
    /// No run holds a design.
    #[error("the runs hold no designs")]
    Empty,
    /// The rows are not those of runs of the study.
    #[error(transparent)]
    Replay(#[from] ReplayError),
    /// The merged folder cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// The designs of several runs of equal studies, ready to be written to a folder.
///
/// The rows are sorted by generation, then by run, so that the history of the merged run is that of islands that were searched side
/// by side.
#[derive(Debug)]
pub struct Merge {
    study: Study,
    rows: Vec<TableRow>,
    /// Index of the run and id in the run, of each row.
    origins: Vec<(usize, usize)>,
    runs: Vec<MergedRun>,
    notes: Vec<String>,
}

impl Merge {
    /// Reads the run folders at `paths`, and keeps every design that no other dominates and every `every`-th of the others.
    ///
    /// # Errors
    /// [`MergeError`].
    pub fn open(paths: &[PathBuf], every: usize) -> Result<Self, MergeError> {
        let mut opened: Vec<(RunFolder, Vec<TableRow>)> = Vec::new();
        let mut notes = Vec::new();
        for path in paths {
            let (folder, rows) = read(path, &mut notes)?;
            if let Some((first, _)) = opened.first()
                && let Some(key) = first.study().key_of_other_search(folder.study())
            {
                return Err(MergeError::Study {
                    first: first.path().to_owned(),
                    path: path.clone(),
                    key,
                });
            }
            // A run that was continued elsewhere begins with the designs of the other, and a merged run holds those of its runs.
            let sums: Vec<FileSum> = sums_of(&folder).collect();
            let is_same = |(other, others): &&(RunFolder, Vec<TableRow>)| {
                let both = rows.len().min(others.len());
                let begins_alike = both > 0
                    && rows[..both]
                        .iter()
                        .zip(&others[..both])
                        .all(|(a, b)| a.row.design == b.row.design);
                begins_alike || sums_of(other).any(|sum| sums.contains(&sum))
            };
            if let Some((first, _)) = opened.iter().find(is_same) {
                return Err(MergeError::Twice {
                    first: first.path().to_owned(),
                    path: path.clone(),
                });
            }
            opened.push((folder, rows));
        }
        Self::of(opened, notes, every.max(1))
    }

    fn of(opened: Vec<(RunFolder, Vec<TableRow>)>, notes: Vec<String>, every: usize) -> Result<Self, MergeError> {
        let all = opened.iter().enumerate();
        let mut placed: Vec<(usize, TableRow)> = all
            .flat_map(|(run, (_, rows))| rows.iter().map(move |row| (run, *row)))
            .collect();
        placed.par_sort_by_key(|(run, entry)| (entry.row.generation, *run, entry.id));
        let is_kept = kept(&placed, every);
        let mut keep = is_kept.iter();
        placed.retain(|_| keep.next().copied().unwrap_or(true));
        let Some((folder, _)) = opened.first().filter(|_| !placed.is_empty()) else {
            return Err(MergeError::Empty);
        };
        let mut study = folder.study().clone();
        study.optimizer.evaluations = placed.len();
        study.optimizer.threads = None;
        study.optimizer.time_limit_s = None;
        study.optimizer.stagnation = None;
        let count = |run: usize| placed.iter().filter(|(of, _)| *of == run).count();
        let runs = opened.iter().enumerate().map(|(place, (folder, rows))| MergedRun {
            run: folder.name(),
            seed: folder.study().optimizer.seed,
            evaluations: rows.len(),
            kept: count(place),
            designs: folder.designs_sum(),
        });
        let runs = runs.collect();
        // Generations of which nothing is kept leave no gap.
        let (mut generation, mut before) = (0, None);
        let mut number = |row: Row| {
            if before.replace(row.generation) != Some(row.generation) {
                generation += 1;
            }
            Row { generation, ..row }
        };
        let rows = placed.iter().enumerate().map(|(id, (_, entry))| TableRow {
            id,
            row: number(entry.row),
            ..*entry
        });
        Ok(Self {
            rows: rows.collect(),
            origins: placed.iter().map(|(run, entry)| (*run, entry.id)).collect(),
            study,
            runs,
            notes,
        })
    }

    /// What was found in the folders that their user should know.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The runs in the order of their arguments.
    pub fn runs(&self) -> &[MergedRun] {
        &self.runs
    }

    /// Begins to write the merged folder at `path`, and returns the search whose replay sends the designs and verifies their front.
    ///
    /// # Errors
    /// [`MergeError`] if the folder cannot be written, or if a design is not as the study evaluates it.
    pub fn start(
        self,
        path: &Path,
        record_every: Option<usize>,
        threads: Option<usize>,
    ) -> Result<(RunWriter, StudySearch), MergeError> {
        let search = StudySearch::of_rows(self.study, self.rows, threads)?;
        let mut writer = RunWriter::create(path, search.study(), record_every)?;
        let mut text = String::from("id,run,run_id\n");
        for (id, (run, run_id)) in self.origins.iter().enumerate() {
            let name = &self.runs[*run].run;
            // The name of a folder may hold a comma or a quotation mark, or begin as a formula of a spreadsheet does.
            let quoted = format!("\"{}\"", as_text(name).replace('"', "\"\""));
            text += &format!("{id},{quoted},{run_id}\n");
        }
        write_whole(&path.join(ORIGINS), text.as_bytes())?;
        writer.set_merged(self.runs)?;
        Ok((writer, search))
    }
}

/// The sums of the tables whose designs a folder holds: its own, and those of the runs that were joined in it.
fn sums_of(folder: &RunFolder) -> impl Iterator<Item = FileSum> {
    let merged = folder.merged().iter().filter_map(|run| run.designs);
    folder.designs_sum().into_iter().chain(merged)
}

/// Reads a folder and its designs; a run that has not ended gives those that it has.
fn read(path: &Path, notes: &mut Vec<String>) -> Result<(RunFolder, Vec<TableRow>), MergeError> {
    let folder = RunFolder::open(path)?;
    folder.require_this_version()?;
    if !folder.is_verifiable() {
        return Err(MergeError::Unverified(path.to_owned()));
    }
    let contents = folder.designs()?;
    if folder.checkpoint().is_some()
        || folder
            .report()
            .is_none_or(|report| report.outcome == crate::EndReason::Interrupted)
    {
        notes.push(format!(
            "{} has not ended; its {} designs so far are used",
            path.display(),
            contents.rows.len()
        ));
    }
    if let Some(line) = contents.cut_line {
        notes.push(format!(
            "line {line} of the table of {} is incomplete; it is left out",
            path.display()
        ));
    }
    Ok((folder, contents.rows))
}

/// Returns whether each design is kept: those that no other dominates, and every `every`-th of the others.
fn kept(placed: &[(usize, TableRow)], every: usize) -> Vec<bool> {
    if every == 1 {
        return vec![true; placed.len()];
    }
    let archive = archive_of(placed.iter().map(|(_, entry)| entry));
    let mut kept: Vec<bool> = (0..placed.len()).map(|place| place % every == 0).collect();
    for member in archive.iter() {
        kept[member.id] = true;
    }
    kept
}

/// Returns a text of others as a cell that no spreadsheet takes for a formula: one that begins like a formula, or with an apostrophe,
/// gets an apostrophe in front, which spreadsheets do not show.
fn as_text(text: &str) -> Cow<'_, str> {
    match text.starts_with(['=', '+', '-', '@', '\'', '\t', '\r']) {
        true => Cow::Owned(format!("'{text}")),
        false => Cow::Borrowed(text),
    }
}
