//! The command `kinefront optimize`: runs a study without a window.

use std::ffi::OsString;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, sync_channel};

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use kinefront_model::mechanism::Architecture;
use kinefront_recording::{Recorder, RunFileError, RunFiles};
use kinefront_study::{
    AlgorithmName, EndReason, Event, ResumeError, Resumption, RunControl, RunFolderError, RunReport, RunSummary,
    RunWriter, Study, StudySearch, WriteError, spawn_search,
};
use miette::miette;

use super::progress::Progress;
use super::signals::interrupt_on_signals;
use super::{Ending, Failure, load_study, say, tables};

/// Capacity of the channel to the progress display; the run waits while it is full.
const CHANNEL: usize = 64;

#[derive(Debug, clap::Args)]
pub struct OptimizeArguments {
    /// Study file, or name of a built-in study [default: paper].
    study: Option<OsString>,
    /// Run folder to continue. With a larger --evaluations, a run that has ended is extended.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["study", "algorithm", "seed", "architectures", "out"])]
    resume: Option<PathBuf>,
    /// Algorithm; overrides that of the study.
    #[arg(long, value_parser = algorithms())]
    algorithm: Option<AlgorithmName>,
    /// Number of evaluations; overrides that of the study.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=100_000_000))]
    evaluations: Option<u64>,
    /// Random seed; overrides that of the study.
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = clap::value_parser!(u64).range(0..=i64::MAX as u64))]
    seed: Option<u64>,
    /// Number of worker threads; the result does not depend on it [default: all cores].
    #[arg(long, value_name = "T", value_parser = clap::value_parser!(u64).range(1..=1024))]
    threads: Option<u64>,
    /// Architectures, as in 3-PRR,3-RRR; override those of the study.
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    architectures: Option<Vec<Architecture>>,
    /// Run folder to write; it must not already hold a run [default: runs/STUDY-seedS].
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Record every N-th generation; beyond 100 000 designs, every 10 N-th, and so on [default: 1].
    #[arg(long, value_name = "N", conflicts_with = "no_recording", value_parser = clap::value_parser!(u64).range(1..=100_000_000))]
    record_every: Option<u64>,
    /// Write no recording.
    #[arg(long)]
    no_recording: bool,
    /// Print run.json to standard output at the end.
    #[arg(long)]
    json: bool,
    /// Print nothing but errors, and JSON if it is requested.
    #[arg(long, short)]
    quiet: bool,
}

pub fn run(arguments: &OptimizeArguments) -> Result<Ending, Failure> {
    let control = Arc::new(RunControl::default());
    let (folder, search) = match &arguments.resume {
        Some(path) => match resume(path, arguments, &control)? {
            Some(resumed) => resumed,
            None => return Ok(Ending::Done),
        },
        None => begin(arguments, &control)?,
    };
    let path = folder.path().to_owned();
    let study = Arc::clone(search.study());
    let mut progress = Progress::new(study.optimizer.evaluations, search.replayed(), arguments.quiet);
    let (ended, failures) = perform(folder, search, &control, &mut progress)?;
    let summary = match ended {
        Ok(summary) => summary,
        // Interrupted while the designs of a resumed run were replayed: the folder states that the run has not ended.
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
    let output = RunOutput {
        json: arguments.json,
        quiet: arguments.quiet,
    };
    match (tell(&study, &summary, &path, output, failures.is_empty()), ending) {
        (Err(failure), Ending::Done) => Err(failure),
        (_, ending) => Ok(ending),
    }
}

/// Runs a search and writes its files; returns its summary, and the errors of its files.
pub fn perform(
    folder: RunWriter,
    search: StudySearch,
    control: &Arc<RunControl>,
    progress: &mut Progress,
) -> Result<(Result<RunSummary, String>, Vec<RunFileError>), Failure> {
    let recorder = Recorder::of_run(&folder, search.study()).map_err(Failure::files)?;
    let (next, events) = sync_channel(CHANNEL);
    let tell = |error: &RunFileError| say(format_args!("error: {error}"));
    let (listeners, files) =
        RunFiles::start(folder, recorder, next, Arc::clone(control), tell).map_err(Failure::runtime)?;
    let worker = spawn_search(search, Arc::clone(control), listeners).map_err(Failure::runtime)?;
    let ended = watch(&events, progress);
    progress.finish();
    let failures = files.join();
    let ended = match worker.join() {
        Ok(()) => ended,
        Err(_) => Err("the worker thread panicked".to_owned()),
    };
    Ok((ended, failures))
}

/// Prepares a new run in its folder.
fn begin(arguments: &OptimizeArguments, control: &Arc<RunControl>) -> Result<(RunWriter, StudySearch), Failure> {
    let study = study(arguments)?;
    let search = StudySearch::new(study, None).map_err(Failure::runtime)?;
    // A signal before there is a folder ends the program as it is; from here on it finds its handler.
    interrupt_on_signals(control, arguments.quiet)?;
    let study = search.study();
    let every = record_every(arguments, Some(1));
    let create = |path: &Path| RunWriter::create(path, study, every);
    let folder = match &arguments.out {
        Some(path) => create(path),
        None => {
            // Another run may take a folder that was free a moment ago.
            let taken = |folder: &Result<RunWriter, WriteError>| {
                matches!(folder, Err(WriteError::Occupied { .. } | WriteError::InUse(_)))
            };
            let mut attempts = folder_names(study).map(|path| create(&path)).skip_while(taken);
            attempts.next().unwrap_or_else(|| create(Path::new("runs")))
        }
    };
    Ok((folder.map_err(write_failure)?, search))
}

/// Prepares a run to be continued; `None` if nothing is left to do.
fn resume(
    path: &Path,
    arguments: &OptimizeArguments,
    control: &Arc<RunControl>,
) -> Result<Option<(RunWriter, StudySearch)>, Failure> {
    let number = |number: Option<u64>| number.map(|number| number as usize);
    let resumption = Resumption::open(path, number(arguments.evaluations), number(arguments.threads)).map_err(
        |error| match error {
            ResumeError::Lock(error) => write_failure(error),
            ResumeError::Folder(error @ RunFolderError::Read { .. }) => Failure::runtime(error),
            error => Failure::input(error),
        },
    )?;
    if !arguments.quiet {
        for note in resumption.notes() {
            say(format_args!("{}: {note}", path.display()));
        }
    }
    if resumption.is_complete() {
        if arguments.json {
            let text = std::fs::read_to_string(resumption.folder().report_path()).map_err(Failure::runtime)?;
            write!(std::io::stdout(), "{text}")?;
        } else if !arguments.quiet {
            writeln!(
                std::io::stdout(),
                "{} is complete: {} evaluations{}",
                path.display(),
                resumption.search().study().optimizer.evaluations,
                // A merged run follows from no search that could go on.
                match resumption.folder().merged().len() {
                    0 => "; a larger --evaluations extends it".to_owned(),
                    runs => format!(" of {runs} runs"),
                }
            )?;
        }
        return Ok(None);
    }
    let every = record_every(arguments, resumption.record_every());
    interrupt_on_signals(control, arguments.quiet)?;
    resumption.start(every).map(Some).map_err(write_failure)
}

/// The arguments' choice of the generations to record, or else `other`.
fn record_every(arguments: &OptimizeArguments, other: Option<usize>) -> Option<usize> {
    match arguments.record_every {
        _ if arguments.no_recording => None,
        Some(every) => Some(every as usize),
        None => other,
    }
}

pub fn write_failure(error: WriteError) -> Failure {
    match error {
        WriteError::Occupied { .. } | WriteError::InUse(_) => Failure::input(error),
        WriteError::Write { .. } | WriteError::Changed { .. } => Failure::files(error),
    }
}

/// Loads the study that the arguments specify and checks it again with the values that they override.
fn study(arguments: &OptimizeArguments) -> Result<Study, Failure> {
    let mut study = load_study(arguments.study.as_deref()).map_err(Failure::Input)?;
    if let Some(algorithm) = arguments.algorithm {
        study.optimizer.algorithm = algorithm;
    }
    if let Some(evaluations) = arguments.evaluations {
        study.optimizer.evaluations = evaluations as usize;
    }
    if let Some(seed) = arguments.seed {
        study.optimizer.seed = seed;
    }
    if let Some(threads) = arguments.threads {
        study.optimizer.threads = Some(threads as usize);
    }
    if let Some(architectures) = &arguments.architectures {
        study.architectures.clone_from(architectures);
    }
    match study.faults().first() {
        None => Ok(study),
        Some(fault) => Err(Failure::Input(miette!("`{}` {}", fault.key, fault.message))),
    }
}

/// Returns the folders `runs/STUDY-seedS`, `runs/STUDY-seedS-2`, and so on.
fn folder_names(study: &Study) -> impl Iterator<Item = PathBuf> {
    let name: String = study
        .name
        .chars()
        .map(|c| {
            if c.is_alphanumeric() || "-_.".contains(c) {
                c
            } else {
                '-'
            }
        })
        .collect();
    let base = format!("{}-seed{}", name.trim_matches('.'), study.optimizer.seed);
    let numbered = (2..).map({
        let base = base.clone();
        move |number: u64| format!("{base}-{number}")
    });
    std::iter::once(base)
        .chain(numbered)
        .map(|name| Path::new("runs").join(name))
}

fn watch(events: &Receiver<Arc<Event>>, progress: &mut Progress) -> Result<RunSummary, String> {
    let mut ended = Err("the worker thread ended without a result".to_owned());
    for event in events {
        match &*event {
            Event::Generation(summary) => progress.generation(summary),
            Event::Verifying { done, total } => progress.verifying(*done, *total),
            Event::Finished(summary) => ended = Ok(summary.clone()),
            Event::Failed(message) => ended = Err(message.clone()),
            Event::Started(_) | Event::Evaluated(_) | Event::Front(_) => {}
        }
    }
    ended
}

/// How the end of a run is told on the standard output.
#[derive(Debug, Clone, Copy)]
pub struct RunOutput {
    /// As `run.json` instead of a table.
    pub json: bool,
    /// Not at all, unless as JSON.
    pub quiet: bool,
}

/// Tells the result of a run.
pub fn tell(
    study: &Study,
    summary: &RunSummary,
    path: &Path,
    output: RunOutput,
    is_written: bool,
) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    if output.json {
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
    } else if !output.quiet {
        let last = summary.history.last();
        if summary.outcome == EndReason::Interrupted {
            writeln!(
                out,
                "interrupted after {} evaluations; kinefront optimize --resume {} continues",
                last.map_or(0, |last| last.evaluations),
                path.display()
            )?;
            return Ok(());
        }
        writeln!(out, "{}", tables::front(study, summary))?;
        if let Some(proofs) = &summary.proofs {
            writeln!(out, "{proofs}")?;
        }
        writeln!(
            out,
            "{} evaluations ({} feasible) in {:.1} s{}, verified in {:.1} s; front: {} of {} verified designs kept, \
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
            summary.front.len(),
            summary.verified,
            summary.dropped,
            summary.verified_hypervolume,
            study.hypervolume_unit(),
        )?;
        if is_written {
            writeln!(out, "wrote {}", path.display())?;
        } else {
            writeln!(
                out,
                "{} is incomplete; kinefront optimize --resume {} continues",
                path.display(),
                path.display()
            )?;
        }
    }
    Ok(())
}

/// Parser of the names of the algorithms, which error messages list.
fn algorithms() -> impl TypedValueParser<Value = AlgorithmName> {
    PossibleValuesParser::new(AlgorithmName::ALL.map(|name| PossibleValue::new(name.name()).help(name.description())))
        .try_map(|name| AlgorithmName::find(&name).ok_or("unknown algorithm"))
}
