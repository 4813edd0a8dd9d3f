//! The command `kinefront optimize`: runs a study without a window.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, sync_channel};
use std::sync::{Arc, OnceLock};
use std::thread::{Builder, JoinHandle};

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use kinefront::recording::Recorder;
use kinefront::study::{AlgorithmName, EndReason, Event, RunControl, RunReport, RunSummary, RunWriter, Study, spawn};
use kinefront_model::mechanism::Architecture;
use miette::{Report, miette};

use super::progress::Progress;
use super::{Ending, Failure, load_study, tables};

/// Capacity of the event channel of a listener; the worker thread waits while a channel is full.
const CHANNEL: usize = 64;

#[derive(Debug, clap::Args)]
pub struct OptimizeArguments {
    /// Study file, or name of a built-in study [default: paper].
    study: Option<String>,
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
    /// Print run.json to standard output at the end.
    #[arg(long)]
    json: bool,
    /// Print nothing but errors, and JSON if it is requested.
    #[arg(long, short)]
    quiet: bool,
}

pub fn run(arguments: &OptimizeArguments) -> Result<Ending, Failure> {
    let study = study(arguments)?;
    let path = arguments.out.clone().unwrap_or_else(|| free_folder(&study));
    let folder = RunWriter::create(&path, &study).map_err(Failure::input)?;
    let recorder = Recorder::create(&path.join("recording.rrd"), &study).map_err(Failure::input)?;

    let control = Arc::new(RunControl::default());
    stop_on_interrupt(&control, arguments.quiet)?;
    let (to_tables, tables) = sync_channel(CHANNEL);
    let (to_recorder, recording) = sync_channel(CHANNEL);
    let (to_terminal, terminal) = sync_channel(CHANNEL);
    let table_study = study.clone();
    let tables = listener("kinefront-tables", move || {
        folder.follow(&tables, &table_study).map_err(Report::from_err)
    })?;
    let recording = listener("kinefront-recorder", move || {
        recorder.follow(&recording).map_err(Report::from_err)
    })?;
    let worker = spawn(study.clone(), control, vec![to_tables, to_recorder, to_terminal])?;
    let mut progress = Progress::new(study.optimizer.evaluations, arguments.quiet);
    let ended = watch(&terminal, &mut progress);
    progress.finish();
    let mut failures: Vec<Report> = Vec::new();
    for thread in [tables, recording] {
        failures.extend(join(thread).err());
    }
    if worker.join().is_err() {
        failures.push(miette!("the worker thread panicked"));
    }
    let summary = match ended {
        Ok(summary) => summary,
        Err(message) => return Err(Failure::Runtime(miette!("the run failed: {message}"))),
    };
    if let Some(report) = failures.pop() {
        for other in failures {
            eprintln!("{other:?}");
        }
        return Err(Failure::Runtime(report));
    }
    tell(&study, &summary, &path, arguments)?;
    Ok(match summary.outcome {
        EndReason::Completed | EndReason::TimeUp | EndReason::Stagnated => Ending::Done,
        EndReason::Stopped => Ending::Interrupted,
    })
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

/// Returns the folder `runs/STUDY-seedS`, with a number appended if that folder exists.
fn free_folder(study: &Study) -> PathBuf {
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
    let runs = Path::new("runs");
    std::iter::once(base.clone())
        .chain((2..).map(|number| format!("{base}-{number}")))
        .map(|name| runs.join(name))
        .find(|path| !path.exists())
        .unwrap_or_else(|| runs.join(base))
}

/// Installs a handler for Ctrl-C: the first Ctrl-C stops the run, which still verifies and writes its front; the second
/// exits the program immediately.
fn stop_on_interrupt(control: &Arc<RunControl>, quiet: bool) -> Result<(), Failure> {
    // A handler can be set only once in a process, and a process runs this command only once.
    static INTERRUPTED: OnceLock<AtomicBool> = OnceLock::new();
    let interrupted = INTERRUPTED.get_or_init(|| AtomicBool::new(false));
    let control = Arc::clone(control);
    ctrlc::set_handler(move || {
        if interrupted.swap(true, Ordering::SeqCst) {
            std::process::exit(130);
        }
        if !quiet {
            eprintln!(
                "\nstopping: finishing the generation and verifying the front (Ctrl-C again to quit immediately)"
            );
        }
        control.stop();
    })
    .map_err(Failure::runtime)
}

type Listener = JoinHandle<Result<(), Report>>;

fn listener(name: &str, work: impl FnOnce() -> Result<(), Report> + Send + 'static) -> Result<Listener, Failure> {
    Ok(Builder::new().name(name.to_owned()).spawn(work)?)
}

fn join(thread: Listener) -> Result<(), Report> {
    thread
        .join()
        .unwrap_or_else(|_| Err(miette!("a thread that writes the files of the run panicked")))
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

fn tell(study: &Study, summary: &RunSummary, path: &Path, arguments: &OptimizeArguments) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    if arguments.json {
        let report = serde_json::to_string_pretty(&RunReport::new(study, summary)).map_err(Failure::runtime)?;
        writeln!(out, "{report}")?;
    } else if !arguments.quiet {
        let last = summary.history.last();
        writeln!(out, "{}", tables::front(summary))?;
        writeln!(
            out,
            "{} evaluations ({} feasible) in {:.1} s{}, verified in {:.1} s; front: {} of {} verified designs kept, \
             {} dropped by verification; hypervolume {:.1} kg m",
            last.map_or(0, |last| last.evaluations),
            last.map_or(0, |last| last.feasible),
            summary.times.search_s,
            match summary.outcome {
                EndReason::Completed | EndReason::Stopped => "",
                EndReason::TimeUp => " (time limit reached)",
                EndReason::Stagnated => " (stagnated)",
            },
            summary.times.verification_s,
            summary.front.len(),
            summary.verified,
            summary.dropped,
            summary.verified_hypervolume,
        )?;
        writeln!(out, "wrote {}", path.display())?;
    }
    Ok(())
}

/// Parser of the names of the algorithms, which error messages list.
fn algorithms() -> impl TypedValueParser<Value = AlgorithmName> {
    PossibleValuesParser::new(AlgorithmName::ALL.map(|name| PossibleValue::new(name.name()).help(name.description())))
        .try_map(|name| AlgorithmName::find(&name).ok_or("unknown algorithm"))
}
