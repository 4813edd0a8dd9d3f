//! What the commands that run a search share: their arguments, the run with its files, and what it tells at its end.

use std::io::Write;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, sync_channel};

use kinefront_recording::{Recorder, RunFileError, RunFiles};
use kinefront_study::{
    EndReason, Event, RunControl, RunReport, RunSummary, RunWriter, Study, StudySearch, WriteError, spawn_search,
};
use miette::miette;

use super::numbers::whole_number;
use super::progress::Progress;
use super::why::hindrances;
use super::{Ending, Failure, say, tables};

/// Capacity of the channel to the progress display; the run waits while it is full.
const CHANNEL: usize = 64;

#[derive(Debug, clap::Args)]
pub struct RunArguments {
    /// Number of worker threads; the result does not depend on it [default: all cores].
    #[arg(long, value_name = "T", allow_negative_numbers = true, value_parser = whole_number::<u64>(1..=1024))]
    threads: Option<u64>,
    /// Record every N-th generation; beyond 100 000 designs, every 10 N-th, and so on [default: 1].
    #[arg(long, value_name = "N", conflicts_with = "no_recording", allow_negative_numbers = true, value_parser = whole_number::<u64>(1..=100_000_000))]
    record_every: Option<u64>,
    /// Write no recording.
    #[arg(long)]
    no_recording: bool,
    /// Print run.json to standard output at the end.
    #[arg(long)]
    pub json: bool,
    /// Print nothing but errors, and JSON if it is requested.
    #[arg(long, short)]
    pub quiet: bool,
}

impl RunArguments {
    pub fn threads(&self) -> Option<usize> {
        self.threads.map(|threads| threads as usize)
    }

    /// Every how many generations one is recorded, or else `other`; `None` if there is no recording.
    pub fn record_every(&self, other: Option<usize>) -> Option<usize> {
        match self.record_every {
            _ if self.no_recording => None,
            Some(every) => Some(every as usize),
            None => other,
        }
    }
}

/// Runs a search, writes its files, and tells its result.
pub fn perform(
    folder: RunWriter,
    search: StudySearch,
    control: &Arc<RunControl>,
    arguments: &RunArguments,
) -> Result<Ending, Failure> {
    let path = folder.path().to_owned();
    let study = Arc::clone(search.study());
    let mut progress = Progress::new(study.optimizer.evaluations, search.replayed(), arguments.quiet);
    let (ended, failures) = search_and_write(folder, search, control, &mut progress)?;
    let summary = match ended {
        Ok(summary) => summary,
        // Interrupted while the designs of a run were replayed: the folder states that the run has not ended.
        Err(_) if control.is_interrupted() => return Ok(Ending::Interrupted),
        Err(message) => return Err(Failure::Runtime(miette!("the run failed: {message}"))),
    };
    let ending = match summary.outcome {
        EndReason::Interrupted => Ending::Interrupted,
        _ if control.is_interrupted() && !failures.is_empty() => Ending::Interrupted,
        _ if !failures.is_empty() => Ending::FilesIncomplete,
        EndReason::Completed | EndReason::TimeUp | EndReason::Stagnated | EndReason::Stopped => Ending::Done,
    };
    // The front is printed even if it could not be written. That nobody reads it changes nothing about a run that did not end
    // well.
    match (tell(&study, &summary, &path, arguments, failures.is_empty()), ending) {
        (Err(failure), Ending::Done) => Err(failure),
        (_, ending) => Ok(ending),
    }
}

/// Runs a search and writes its files; returns its summary, and the errors of its files.
pub fn search_and_write(
    folder: RunWriter,
    search: StudySearch,
    control: &Arc<RunControl>,
    progress: &mut Progress,
) -> Result<(Result<RunSummary, String>, Vec<RunFileError>), Failure> {
    let study = Arc::clone(search.study());
    let recorder = Recorder::of_run(&folder, &study).map_err(Failure::files)?;
    let (next, events) = sync_channel(CHANNEL);
    let tell = |error: &RunFileError| say(format_args!("error: {error}"));
    let (listeners, files) =
        RunFiles::start(folder, recorder, next, Arc::clone(control), tell).map_err(Failure::runtime)?;
    let worker = spawn_search(search, Arc::clone(control), listeners).map_err(Failure::runtime)?;
    let ended = watch(&events, &study, progress);
    progress.finish();
    let failures = files.join();
    let ended = match worker.join() {
        Ok(()) => ended,
        Err(_) => Err("the worker thread panicked".to_owned()),
    };
    Ok((ended, failures))
}

fn watch(events: &Receiver<Arc<Event>>, study: &Study, progress: &mut Progress) -> Result<RunSummary, String> {
    let mut ended = Err("the worker thread ended without a result".to_owned());
    for event in events {
        match &*event {
            Event::Generation(summary) => progress.generation(study, summary),
            Event::Concluding { part, done, total } => progress.conclusion(*part, *done, *total),
            Event::Finished(summary) => ended = Ok(summary.clone()),
            Event::Failed(message) => ended = Err(message.clone()),
            Event::Started(_) | Event::Evaluated(_) | Event::Front(_) => {}
        }
    }
    ended
}

/// Tells the result of a run.
fn tell(
    study: &Study,
    summary: &RunSummary,
    path: &Path,
    output: &RunArguments,
    is_written: bool,
) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    if output.json {
        return tell_json(&mut out, study, summary, path, is_written);
    }
    if output.quiet {
        return Ok(());
    }
    let last = summary.history.last();
    let resume = format!("kinefront optimize --resume {} continues the run", path.display());
    if summary.outcome == EndReason::Interrupted {
        let evaluations = last.map_or(0, |last| last.evaluations);
        writeln!(out, "interrupted after {evaluations} evaluations; {resume}")?;
        return Ok(());
    }
    writeln!(out, "{}", tables::front(study, summary))?;
    if let Some(proofs) = &summary.proofs {
        writeln!(out, "{proofs}")?;
    }
    writeln!(out, "{}", figures(study, summary))?;
    if !is_written {
        writeln!(out, "{} is incomplete; {resume}", path.display())?;
        return Ok(());
    }
    writeln!(out, "wrote {}", path.display())?;
    if last.is_some_and(|last| last.feasible == 0) {
        // The answer takes seconds.
        writeln!(out, "No design is feasible.")?;
        // It is told beside the run: that it cannot be told makes no run fail.
        if let Ok(found) = hindrances(&path.join("designs.csv"), study) {
            writeln!(out, "{}", tables::hindrances(&found))?;
        }
    }
    Ok(())
}

/// Tells the report of a run as JSON.
fn tell_json(
    out: &mut impl Write,
    study: &Study,
    summary: &RunSummary,
    path: &Path,
    is_written: bool,
) -> Result<(), Failure> {
    // The text is that of the file, if there is one: reading JSON may change the last bit of a number.
    let written = is_written
        .then(|| std::fs::read_to_string(path.join("run.json")).ok())
        .flatten();
    match written {
        Some(text) => write!(out, "{text}")?,
        None => {
            let report = serde_json::to_string_pretty(&RunReport::new(study, summary));
            writeln!(out, "{}", report.map_err(Failure::runtime)?)?;
        }
    }
    Ok(())
}

/// Returns the figures of a run in one line.
fn figures(study: &Study, summary: &RunSummary) -> String {
    let last = summary.history.last();
    format!(
        "{} evaluations ({} feasible) in {:.1} s{}, verified in {:.1} s{}; front: {} of {} verified designs kept, \
         {} dropped by verification; hypervolume {:.1} {}",
        last.map_or(0, |last| last.evaluations),
        last.map_or(0, |last| last.feasible),
        summary.times.search_s,
        match summary.outcome {
            EndReason::Completed | EndReason::Stopped | EndReason::Interrupted => "",
            EndReason::TimeUp => " (time limit reached)",
            EndReason::Stagnated => " (stagnated)",
        },
        summary.times.verification_s,
        match &summary.proofs {
            Some(_) => format!(", proved in {:.1} s", summary.times.certification_s),
            None => String::new(),
        },
        summary.front.len(),
        summary.verified,
        summary.dropped,
        summary.verified_hypervolume,
        study.hypervolume_unit(),
    )
}

pub fn write_failure(error: WriteError) -> Failure {
    match error {
        WriteError::Occupied { .. } | WriteError::InUse(_) | WriteError::NotAFile(_) => Failure::input(error),
        WriteError::Write { .. } | WriteError::Changed { .. } => Failure::files(error),
    }
}
