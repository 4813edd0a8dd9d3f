//! The command `kinefront merge`: joins runs of equal studies, such as those of an array of jobs, into one run folder.

use std::path::PathBuf;
use std::sync::Arc;

use kinefront_study::{EndReason, Merge, MergeError, RunControl};
use miette::miette;

use super::optimize::{RunOutput, perform, tell, write_failure};
use super::progress::Progress;
use super::signals::interrupt_on_signals;
use super::{Ending, Failure, say};

#[derive(Debug, clap::Args)]
pub struct MergeArguments {
    /// Run folders of one study, which differ in seed, budget and name at most.
    #[arg(required = true, num_args = 2.., value_name = "RUN")]
    runs: Vec<PathBuf>,
    /// Run folder to write; it must not already hold a run.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Keep the designs that no other dominates, and every N-th of the others.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=100_000_000))]
    keep_every: u64,
    /// Number of worker threads; the result does not depend on it [default: all cores].
    #[arg(long, value_name = "T", value_parser = clap::value_parser!(u64).range(1..=1024))]
    threads: Option<u64>,
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

pub fn run(arguments: &MergeArguments) -> Result<Ending, Failure> {
    let merge = Merge::open(&arguments.runs, arguments.keep_every as usize).map_err(failure)?;
    if !arguments.quiet {
        for note in merge.notes() {
            say(note);
        }
        for run in merge.runs() {
            say(format_args!(
                "{}: seed {}, {} of {} designs kept",
                run.run, run.seed, run.kept, run.evaluations
            ));
        }
    }
    let every = match (arguments.no_recording, arguments.record_every) {
        (true, _) => None,
        (false, every) => Some(every.map_or(1, |every| every as usize)),
    };
    let threads = arguments.threads.map(|threads| threads as usize);
    let control = Arc::new(RunControl::default());
    interrupt_on_signals(&control, arguments.quiet)?;
    let (folder, search) = merge.start(&arguments.out, every, threads).map_err(failure)?;
    let study = Arc::clone(search.study());
    let mut progress = Progress::new(study.optimizer.evaluations, 0, arguments.quiet);
    let (ended, failures) = perform(folder, search, &control, &mut progress)?;
    let summary = match ended {
        Ok(summary) => summary,
        Err(_) if control.is_interrupted() => return Ok(Ending::Interrupted),
        Err(message) => return Err(Failure::Runtime(miette!("the runs could not be merged: {message}"))),
    };
    let output = RunOutput {
        json: arguments.json,
        quiet: arguments.quiet,
    };
    tell(&study, &summary, &arguments.out, output, failures.is_empty())?;
    Ok(match summary.outcome {
        EndReason::Interrupted => Ending::Interrupted,
        _ if !failures.is_empty() => Ending::FilesIncomplete,
        _ => Ending::Done,
    })
}

fn failure(error: MergeError) -> Failure {
    match error {
        MergeError::Write(error) => write_failure(error),
        error => Failure::input(error),
    }
}
