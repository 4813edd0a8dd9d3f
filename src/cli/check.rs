//! The command `kinefront check`: checks a run folder and repairs it where nothing has to be guessed.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use kinefront_recording::{RecordedRunError, is_recorded, read_apart};
use kinefront_study::{EndReason, Inspection, Repair, ResumeOptions, Resumption, RunControl, TableRow};
use miette::miette;

use super::progress::Progress;
use super::runs::search_and_write;
use super::{Ending, Failure, say, shown};

#[derive(Debug, clap::Args)]
#[command(after_help = "\
The exit code is 0 if the folder is sound, 2 if something is wrong, and 1 if no file states the expected size and checksum of the designs. A repair removes an incomplete last row, and
regenerates the files that follow from the study and the designs: the front, run.json, and the recording.")]
pub struct CheckArguments {
    /// Run folder.
    folder: PathBuf,
    /// Repair the errors that can be repaired without guessing.
    #[arg(long)]
    repair: bool,
    /// Print nothing but errors.
    #[arg(long, short)]
    quiet: bool,
}

pub fn run(arguments: &CheckArguments) -> Result<Ending, Failure> {
    let path = &arguments.folder;
    let inspection = inspect(path)?;
    let mut out = std::io::stdout().lock();
    if inspection.findings.is_empty() && !inspection.folder.is_verifiable() {
        return Err(unverifiable(path, &inspection));
    }
    if inspection.findings.is_empty() {
        if !arguments.quiet {
            writeln!(out, "{}", soundness(path, &inspection))?;
        }
        return Ok(Ending::Done);
    }
    for finding in &inspection.findings {
        let remedy = match finding.repair {
            Some(Repair::Cut) => " (can be repaired: the row is removed)",
            Some(Repair::WriteAnew) => " (can be repaired: it is regenerated)",
            None => "",
        };
        let line = format!("{}: {}{remedy}", finding.path.display(), finding.message);
        writeln!(out, "{}", shown(&line))?;
    }
    if !arguments.repair {
        let folder = path.display();
        let message = match inspection.is_repairable() {
            true => format!("`kinefront check {folder} --repair` repairs it"),
            false => "this cannot be repaired from the folder itself".to_owned(),
        };
        return Err(Failure::Input(miette!("{folder} is not sound; {message}")));
    }
    if !inspection.is_repairable() {
        return Err(Failure::Input(miette!(
            "{} cannot be repaired without guessing",
            path.display()
        )));
    }
    drop(out);
    repair(path)?;
    let again = inspect(path)?;
    if let Some(finding) = again.findings.first() {
        return Err(Failure::Runtime(miette!(
            "{} is still not sound: {}: {}",
            path.display(),
            finding.path.display(),
            finding.message
        )));
    }
    if !arguments.quiet {
        writeln!(std::io::stdout(), "repaired; {}", soundness(path, &again))?;
    }
    Ok(Ending::Done)
}

/// Returns the failure of a run folder in which lost rows would not be noticed.
fn unverifiable(path: &Path, inspection: &Inspection) -> Failure {
    let count = inspection.designs.as_ref().map_or(0, Vec::len);
    Failure::Runtime(miette!(
        help = format!(
            "`kinefront optimize --resume {} --accept-unverified` completes the run with these designs",
            path.display()
        ),
        "{} cannot be verified: its {count} designs follow from the study, but no file states their number and their \
         checksum ({}), so lost rows would go unnoticed",
        path.display(),
        match inspection.folder.report() {
            Some(_) => "run.json has no `files`",
            None => "run.json and progress.json are missing",
        }
    ))
}

fn soundness(path: &Path, inspection: &Inspection) -> String {
    let count = inspection.designs.as_ref().map_or(0, Vec::len);
    let state = match (inspection.folder.report(), inspection.folder.checkpoint()) {
        (Some(report), _) if report.outcome == EndReason::Interrupted => "the run was interrupted and can be resumed",
        (Some(_), _) => "the run has ended",
        (None, Some(_)) => "the run has not ended: another process is searching, or it can be resumed",
        (None, None) => "it is not known whether the run has ended",
    };
    format!("{} is sound: {count} designs; {state}", path.display())
}

fn inspect(path: &Path) -> Result<Inspection, Failure> {
    let mut inspection = Inspection::new(path).map_err(|error| match error {
        error if error.is_of_system() => Failure::runtime(error),
        error => Failure::input(error),
    })?;
    check_recording(&mut inspection)?;
    Ok(inspection)
}

/// Compares the recording with the table. That of a run that has not ended may be behind.
fn check_recording(inspection: &mut Inspection) -> Result<(), Failure> {
    let path = inspection.folder.recording_path();
    let (every, has_ended) = match (inspection.folder.report(), inspection.folder.checkpoint()) {
        (Some(report), _) if report.files.is_some() => (report.record_every, true),
        (Some(_), _) => (path.exists().then_some(1), true),
        (None, Some(checkpoint)) => (checkpoint.record_every, false),
        (None, None) => (path.exists().then_some(1), false),
    };
    let (Some(every), Some(designs)) = (every, inspection.designs.as_deref()) else {
        return Ok(());
    };
    let generations = designs.chunk_by(|a, b| a.row.generation == b.row.generation);
    let recorded = |rows: &&[TableRow]| is_recorded(rows[0].row.generation as usize, rows[0].id, every);
    let expected: Vec<&TableRow> = generations.filter(recorded).flatten().collect();
    let read = path.exists().then(|| read_apart(&path));
    let wrong = match read {
        None => Some("it is missing".to_owned()),
        // That it cannot be read here says nothing about the recording.
        Some(Err(error @ (RecordedRunError::Process { .. } | RecordedRunError::Write(_)))) => {
            return Err(Failure::runtime(error));
        }
        Some(Err(error)) => Some(error.to_string()),
        Some(Ok((_, rows))) => {
            let differing = rows
                .iter()
                .zip(&expected)
                .position(|(found, entry)| found.row != entry.row);
            match differing {
                Some(place) => Some(format!(
                    "design #{} differs from the one in the table",
                    expected[place].id
                )),
                None if rows.len() > expected.len() || has_ended && rows.len() < expected.len() => Some(format!(
                    "it has {} designs, but the table has {}",
                    rows.len(),
                    expected.len()
                )),
                None => None,
            }
        }
    };
    // A run that has not ended writes its recording anew when it is resumed.
    if let Some(message) = wrong.filter(|_| has_ended) {
        inspection.add(path, message, Some(Repair::WriteAnew));
    }
    Ok(())
}

/// Cuts an incomplete row off, and writes anew what follows from the study and the designs.
fn repair(path: &Path) -> Result<(), Failure> {
    let resumption = Resumption::open(path, &ResumeOptions::default()).map_err(|error| match error {
        error if error.is_of_system() => Failure::runtime(error),
        error => Failure::input(error),
    })?;
    let Some(outcome) = resumption.folder().report().map(|report| report.outcome) else {
        // The run has not ended: its other files are written when it is resumed.
        return resumption.cut().map_err(Failure::runtime);
    };
    let every = resumption.record_every();
    let (folder, mut search) = resumption.start(every).map_err(Failure::runtime)?;
    search.end_after_replay(outcome);
    let control = Arc::new(RunControl::default());
    match search_and_write(folder, search, &control, &mut Progress::Quiet) {
        Ok((Ok(_), failures)) if failures.is_empty() => Ok(()),
        Ok(_) => Err(Failure::Runtime(miette!("{} could not be repaired", path.display()))),
        Err(Failure::Files(report)) => Err(Failure::Runtime(report)),
        Err(failure) => Err(failure),
    }
}

#[derive(Debug, clap::Args)]
pub struct UnpackArguments {
    /// Recording.
    recording: PathBuf,
    /// Folder to write to.
    folder: PathBuf,
}

/// Unpacks a recording; what is wrong with it is printed as one line.
pub fn unpack(arguments: &UnpackArguments) -> Result<Ending, Failure> {
    match kinefront_recording::unpack(&arguments.recording, &arguments.folder) {
        Ok(()) => Ok(Ending::Done),
        Err(error) => {
            say(error);
            Ok(Ending::Refused)
        }
    }
}
