//! Checking a run folder against what follows from its study and its designs.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

use super::merge::ORIGINS;
use super::write::front_table;
use super::{RunFolder, RunFolderError, RunReport};
use crate::conclusion::verify_replayed;
use crate::{EndReason, RunSummary, StudySearch, TableError, TableRow, open_regular};

/// Largest length of a line of the origins of merged designs \[bytes\].
const LONGEST_ORIGIN: u64 = 1024;

/// Something that is wrong in a run folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub message: String,
    /// How it can be repaired without guessing; `None` if it cannot.
    pub repair: Option<Repair>,
}

/// What repairs a run folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Repair {
    /// Nothing but an incomplete last row is cut off; resuming the run does so.
    Cut,
    /// The file follows from the study and the designs and is written anew.
    WriteAnew,
}

/// What a check of a run folder has found.
#[derive(Debug)]
pub struct Inspection {
    /// The folder.
    pub folder: RunFolder,
    /// Everything that is wrong, in the order of the files.
    pub findings: Vec<Finding>,
    /// The designs, unless their table is damaged.
    pub designs: Option<Vec<TableRow>>,
}

impl Inspection {
    /// Checks the study, the tables and the report of the run folder at `path`: that every row is valid and in order, that
    /// the designs are those that the study leads to (some are evaluated again), and that the front and the report follow
    /// from them. The recording is not read.
    ///
    /// # Errors
    /// [`RunFolderError`] if the path is not a run folder, if its study or its report cannot be read, or if the threads that
    /// check the designs cannot be started.
    pub fn new(path: &Path) -> Result<Self, RunFolderError> {
        let folder = RunFolder::open(path)?;
        folder.require_this_version()?;
        let mut inspection = Self {
            folder,
            findings: Vec::new(),
            designs: None,
        };
        inspection.check_designs()?;
        Ok(inspection)
    }

    /// Whether all that is wrong can be repaired without guessing.
    pub fn is_repairable(&self) -> bool {
        self.findings.iter().all(|finding| finding.repair.is_some())
    }

    /// Adds something that is wrong.
    pub fn add(&mut self, path: PathBuf, message: String, repair: Option<Repair>) {
        self.findings.push(Finding { path, message, repair });
    }

    fn add_table_error(&mut self, error: TableError) {
        self.add(error.path, error.fault.to_string(), None);
    }

    fn check_designs(&mut self) -> Result<(), RunFolderError> {
        let contents = match self.folder.designs() {
            Ok(contents) => contents,
            Err(error) => {
                self.add_table_error(error);
                return Ok(());
            }
        };
        let path = self.folder.designs_path();
        if let Some(line) = contents.cut_line {
            let message = format!("line {line} is incomplete");
            self.add(path.clone(), message, Some(Repair::Cut));
        }
        let (study, rows) = (self.folder.study().clone(), contents.rows.clone());
        let search = match self.folder.replayed(study, rows, None)? {
            Ok(search) => search,
            Err(cause) => {
                self.add(path, cause.to_string(), None);
                return Ok(());
            }
        };
        self.check_outcome(contents.rows.len());
        self.check_merged(contents.rows.len());
        self.designs = Some(contents.rows);
        self.check_results(search);
        Ok(())
    }

    /// Checks that a run can have ended as its report says.
    fn check_outcome(&mut self, designs: usize) {
        let Some(outcome) = self.folder.report().map(|report| report.outcome) else {
            return;
        };
        let optimizer = &self.folder.study().optimizer;
        let message = match outcome {
            EndReason::Completed if designs < optimizer.evaluations => format!(
                "the run was completed, but the table has {designs} of the {} designs of the study",
                optimizer.evaluations
            ),
            EndReason::TimeUp if optimizer.time_limit_s.is_none() => {
                "the run reached a time limit, but the study has none".to_owned()
            }
            EndReason::Stagnated if optimizer.stagnation.is_none() => {
                "the run ended by stagnation, but the study has no section [optimizer.stagnation]".to_owned()
            }
            _ => return,
        };
        self.add(
            self.folder.report_path(),
            format!("`outcome` is wrong: {message}"),
            None,
        );
    }

    /// Checks that a folder of several runs has the origins of as many designs.
    fn check_merged(&mut self, designs: usize) {
        if self.folder.merged().is_empty() {
            return;
        }
        let kept: usize = self.folder.merged().iter().map(|run| run.kept).sum();
        if kept != designs {
            let message = format!("`merged` states {kept} designs, but the table has {designs}");
            self.add(self.folder.report_path(), message, None);
        }
        let path = self.folder.path().join(ORIGINS);
        // A line has two numbers and the name of a folder.
        let most = (designs as u64 + 1) * LONGEST_ORIGIN;
        let found = open_regular(&path, most).map(|file| BufReader::new(file).split(b'\n').count());
        let message = match found {
            Ok(lines) if lines == designs + 1 => return,
            Ok(lines) => format!("it has {lines} lines, but the folder holds {designs} designs of several runs"),
            Err(error) => format!("it cannot be read: {error}"),
        };
        // While the runs are joined, the file is not there yet.
        if self.folder.checkpoint().is_none() {
            self.add(path, message, None);
        }
    }

    /// Checks the front and the report of a run that has ended.
    fn check_results(&mut self, search: StudySearch) {
        let Some(report) = self.folder.report().cloned() else {
            return;
        };
        let study = self.folder.study().clone();
        let Some(summary) = verify_replayed(search, report.outcome) else {
            return;
        };
        if summary.verified_front() {
            self.check_front(&study, &summary);
        }
        for (key, stated, found) in differences(&report, &RunReport::new(&study, &summary)) {
            let message = format!("`{key}` is {stated}, but {found} follows from the study and the designs");
            self.add(self.folder.report_path(), message, Some(Repair::WriteAnew));
        }
    }

    fn check_front(&mut self, study: &crate::Study, summary: &RunSummary) {
        let path = self.folder.front_path();
        let message = match self.folder.front() {
            Ok(None) => "it is missing".to_owned(),
            Err(error) => error.fault.to_string(),
            Ok(Some(_)) => match (front_table(study, summary), std::fs::read(&path)) {
                (Ok(expected), Ok(found)) if found != expected => {
                    "it is not the front that follows from the designs".to_owned()
                }
                _ => return,
            },
        };
        self.add(path, message, Some(Repair::WriteAnew));
    }
}

/// Compares two reports on a run; returns key, value and expected value of what differs, but for what may differ.
fn differences(stated: &RunReport, found: &RunReport) -> Vec<(String, String, String)> {
    const MAY_DIFFER: [&str; 6] = [
        "kinefront_version",
        "threads",
        "times",
        "record_every",
        "files",
        "merged",
    ];
    // Reading JSON may change the last bit of a number, so that both are compared as read.
    let as_read = |report: &RunReport| -> serde_json::Result<serde_json::Value> {
        serde_json::from_slice(&serde_json::to_vec(report)?)
    };
    let found = as_read(found).unwrap_or_default();
    let stated = serde_json::to_value(stated).unwrap_or_default();
    let empty = serde_json::Map::new();
    let [stated, found] = [&stated, &found].map(|value| value.as_object().unwrap_or(&empty));
    let differing = stated
        .iter()
        .filter(|(key, value)| !MAY_DIFFER.contains(&key.as_str()) && found.get(*key) != Some(value));
    differing
        .map(|(key, value)| {
            let shorten = |value: Option<&serde_json::Value>| match value {
                Some(list @ serde_json::Value::Array(_)) => format!("a list ({} bytes)", list.to_string().len()),
                Some(value) => value.to_string(),
                None => "no value".to_owned(),
            };
            (key.clone(), shorten(Some(value)), shorten(found.get(key)))
        })
        .collect()
}
