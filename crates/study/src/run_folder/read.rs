//! Reading a run folder.

use std::io::Read;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;

use super::error::RunFolderError;
use super::{Checkpoint, DESIGNS, FRONT, FileSums, MergedRun, PROGRESS, RECORDING, REPORT, RunReport, STUDY};
use crate::{Column, Study, TableContents, TableError, TableFault, TableRow, read_run_table, read_table, table_bytes};
use crate::{Difference, FileSum, ReplayError, SearchError, StudySearch, open_regular, read_regular};

/// Largest `run.json` \[bytes\]: the history of ten million generations.
const LARGEST_JSON: u64 = 1 << 32;

/// A run on disk.
///
/// ```no_run
/// use kinefront_study::RunFolder;
///
/// let run = RunFolder::open("run".as_ref())?;
/// let heaviest = run.designs()?.rows.into_iter().map(|entry| entry.row.mass()).fold(0.0, f64::max);
/// println!("{}: at most {heaviest} kg", run.study().name);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct RunFolder {
    path: PathBuf,
    study: Study,
    state: RunState,
}

/// What a run folder states about its files.
#[derive(Debug, Clone)]
enum RunState {
    /// The run has not ended: a process writes it, or was killed.
    Unfinished(Checkpoint),
    /// The run has ended.
    Ended(Box<RunReport>),
    /// Neither `progress.json` nor `run.json` is there.
    Unknown,
}

impl RunFolder {
    /// Whether a path is a run folder.
    pub fn is_at(path: &Path) -> bool {
        path.join(STUDY).exists() && path.join(DESIGNS).exists()
    }

    /// Opens the run folder at `path` and reads its study.
    ///
    /// # Errors
    /// [`RunFolderError`]; a `study.toml` that was changed after the run is one.
    pub fn open(path: &Path) -> Result<Self, RunFolderError> {
        if !Self::is_at(path) {
            return Err(RunFolderError::NoRun(path.to_owned()));
        }
        let state = RunState::read(path)?;
        let study = path.join(STUDY);
        // A pipe in the place of a file may never end.
        open_regular(&study, u64::MAX).map_err(RunFolderError::at(&study))?;
        if let Some(sum) = state.sums().and_then(|sums| sums.study) {
            check(&study, &sum, false)?;
        }
        let study = Study::read(&study).map_err(Box::new)?;
        Ok(Self {
            path: path.to_owned(),
            study,
            state,
        })
    }

    /// The study as run.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// Path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Path of the table of all designs.
    pub fn designs_path(&self) -> PathBuf {
        self.path.join(DESIGNS)
    }

    /// Path of the table of the front, which exists if the run verified one.
    pub fn front_path(&self) -> PathBuf {
        self.path.join(FRONT)
    }

    /// Path of the report, which exists once the run has ended.
    pub fn report_path(&self) -> PathBuf {
        self.path.join(REPORT)
    }

    /// Path of the recording, which exists unless the run was made without one.
    pub fn recording_path(&self) -> PathBuf {
        self.path.join(RECORDING)
    }

    /// Reads every evaluated design, in the order of the ids.
    ///
    /// # Errors
    /// [`TableError`] with the line that is wrong; a table that is not the one that the run wrote is an error, too.
    pub fn designs(&self) -> Result<TableContents, TableError> {
        let path = self.designs_path();
        let contents = read_run_table(&path, &self.study)?;
        if let Some(sum) = self.designs_sum() {
            compare_table(&path, &sum, self.checkpoint().is_some())?;
        }
        Ok(contents)
    }

    /// Reads the designs to resume the run. Rows that are missing at the end of the table are evaluated again, so that
    /// their absence is no error here but a note.
    ///
    /// # Errors
    /// As [`RunFolder::designs`].
    pub(super) fn designs_to_resume(&self, notes: &mut Vec<String>) -> Result<TableContents, TableError> {
        let path = self.designs_path();
        let sum = self.state.sums().and_then(|sums| sums.designs);
        if let Some(sum) = sum {
            match compare_table(&path, &sum, self.checkpoint().is_some()) {
                Err(TableError {
                    fault: TableFault::Differs(Difference::Shorter { .. }),
                    ..
                }) => notes.push(format!(
                    "{DESIGNS} has lost rows since the run wrote {}; they are evaluated again",
                    sum.rows.unwrap_or(0)
                )),
                result => result?,
            }
        }
        let header = header(&self.study);
        let found = open_regular(&path, u64::MAX).and_then(|file| {
            let mut found = Vec::new();
            file.take(header.len() as u64).read_to_end(&mut found)?;
            Ok(found)
        });
        let failed = TableError::at(&path);
        let found = found.map_err(|error| failed(error.into()))?;
        if found != header && header.starts_with(&found) {
            return Ok(TableContents {
                rows: Vec::new(),
                cut_line: Some(1),
            });
        }
        // Rows are appended in the order of the columns of this version.
        if found != header {
            return Err(failed(TableFault::Header));
        }
        read_run_table(&path, &self.study)
    }

    /// Replays designs of the folder in a search of `study`, which may have another budget than the one of the folder. The inner error is what
    /// is wrong with the designs.
    ///
    /// # Errors
    /// [`RunFolderError::Threads`], which says nothing of the designs.
    pub(super) fn replayed(
        &self,
        study: Study,
        rows: Vec<TableRow>,
        threads: Option<usize>,
    ) -> Result<Result<StudySearch, ReplayError>, RunFolderError> {
        let search = match self.merged() {
            [] => StudySearch::resume(study, rows, threads),
            _ => StudySearch::of_rows(study, rows, threads),
        };
        match search {
            Err(ReplayError::Search(SearchError::Threads(cause))) => Err(RunFolderError::Threads {
                path: self.designs_path(),
                cause,
            }),
            search => Ok(search),
        }
    }

    /// Reads the verified front; `None` for a run that did not verify one.
    ///
    /// # Errors
    /// As [`RunFolder::designs`].
    pub fn front(&self) -> Result<Option<TableContents>, TableError> {
        let path = self.front_path();
        // While a run goes on, a front is that of an earlier, shorter run of the same folder.
        if self.checkpoint().is_some() || !path.exists() {
            return Ok(None);
        }
        let contents = read_table(&path, &self.study)?;
        if let Some(sum) = self.state.sums().and_then(|sums| sums.front) {
            compare_table(&path, &sum, false)?;
        }
        Ok(Some(contents))
    }

    /// Checks that a file of the run is the one that it wrote; any other file, and a table that still grows, passes.
    ///
    /// # Errors
    /// [`RunFolderError::Differs`].
    pub fn check_file(&self, path: &Path) -> Result<(), RunFolderError> {
        let Some(sums) = self.state.sums() else { return Ok(()) };
        let named = |name: &str| path.file_name().is_some_and(|found| found == name);
        match (
            sums.designs.filter(|_| named(DESIGNS)),
            sums.front.filter(|_| named(FRONT)),
        ) {
            (Some(sum), _) => check(path, &sum, self.checkpoint().is_some()),
            (_, Some(sum)) => check(path, &sum, false),
            _ => Ok(()),
        }
    }

    /// Contents of `run.json`; `None` for a run that has not ended.
    pub fn report(&self) -> Option<&RunReport> {
        match &self.state {
            RunState::Ended(report) => Some(report),
            _ => None,
        }
    }

    /// The last checkpoint of a run that has not ended.
    pub fn checkpoint(&self) -> Option<&Checkpoint> {
        match &self.state {
            RunState::Unfinished(checkpoint) => Some(checkpoint),
            _ => None,
        }
    }

    /// The runs whose designs the folder holds; none for a folder of one run.
    pub fn merged(&self) -> &[MergedRun] {
        match &self.state {
            RunState::Ended(report) => &report.merged,
            RunState::Unfinished(checkpoint) => &checkpoint.merged,
            RunState::Unknown => &[],
        }
    }

    /// The version of the program that wrote the run; `None` if the folder states none.
    pub fn version(&self) -> Option<&str> {
        match &self.state {
            RunState::Ended(report) => Some(&report.kinefront_version),
            RunState::Unfinished(checkpoint) => Some(&checkpoint.kinefront_version),
            RunState::Unknown => None,
        }
    }

    /// Requires that this version of the program wrote the run.
    ///
    /// # Errors
    /// [`RunFolderError::Version`]; a run that states no version passes.
    pub(super) fn require_this_version(&self) -> Result<(), RunFolderError> {
        match self.version() {
            Some(found) if found != env!("CARGO_PKG_VERSION") => Err(RunFolderError::Version {
                path: self.path.clone(),
                found: found.to_owned(),
            }),
            _ => Ok(()),
        }
    }

    /// Whether the folder states what its table of designs has to be, so that damage can be told from a shorter run.
    pub fn is_verifiable(&self) -> bool {
        self.designs_sum().is_some()
    }

    /// The sum that the run states of its table of designs.
    pub(super) fn designs_sum(&self) -> Option<FileSum> {
        self.state.sums().and_then(|sums| sums.designs)
    }

    /// Name of the folder, without the path to it, which a published report must not reveal.
    pub fn name(&self) -> String {
        let path = self.path.canonicalize().unwrap_or_else(|_| self.path.clone());
        let name = path.file_name().unwrap_or(path.as_os_str());
        name.to_string_lossy().into_owned()
    }
}

impl RunState {
    fn read(folder: &Path) -> Result<Self, RunFolderError> {
        // While a run goes on, a report is that of an earlier, shorter run of the same folder.
        if let Some(checkpoint) = read_json(&folder.join(PROGRESS))? {
            return Ok(Self::Unfinished(checkpoint));
        }
        Ok(read_json(&folder.join(REPORT))?.map_or(Self::Unknown, |report| Self::Ended(Box::new(report))))
    }

    /// The sums of the files, as far as they are known.
    fn sums(&self) -> Option<FileSums> {
        match self {
            Self::Unfinished(checkpoint) => Some(FileSums {
                study: checkpoint.study,
                designs: Some(checkpoint.designs),
                front: None,
            }),
            Self::Ended(report) => report.files,
            Self::Unknown => None,
        }
    }
}

/// Reads a JSON file of a run; `None` if it is missing.
fn read_json<T: DeserializeOwned>(path: &Path) -> Result<Option<T>, RunFolderError> {
    let text = match read_regular(path, LARGEST_JSON) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(RunFolderError::at(path)(error)),
    };
    let damaged = |cause| RunFolderError::Damaged {
        path: path.to_owned(),
        cause,
    };
    let value: serde_json::Value = serde_json::from_slice(&text).map_err(damaged)?;
    // Another version may have other keys; the keys of this one are known.
    let version = value["kinefront_version"].as_str();
    let other_version = version.filter(|version| *version != env!("CARGO_PKG_VERSION"));
    let other_version = other_version.map(str::to_owned);
    match T::deserialize(value) {
        Ok(contents) => Ok(Some(contents)),
        Err(cause) => Err(match other_version {
            Some(found) => RunFolderError::Version {
                path: path.to_owned(),
                found,
            },
            None => damaged(cause),
        }),
    }
}

/// The header of `designs.csv`.
fn header(study: &Study) -> Vec<u8> {
    table_bytes(Column::of_designs(study), []).unwrap_or_default()
}

fn check(path: &Path, sum: &FileSum, may_grow: bool) -> Result<(), RunFolderError> {
    match sum.compare(path, may_grow).map_err(RunFolderError::at(path))? {
        None => Ok(()),
        Some(difference) => Err(RunFolderError::Differs {
            path: path.to_owned(),
            difference,
        }),
    }
}

fn compare_table(path: &Path, sum: &FileSum, may_grow: bool) -> Result<(), TableError> {
    let fault = match sum.compare(path, may_grow) {
        Ok(None) => return Ok(()),
        Ok(Some(difference)) => difference.into(),
        Err(error) => error.into(),
    };
    Err(TableError::at(path)(fault))
}
