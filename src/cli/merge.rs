//! The command `kinefront merge`: joins runs of equal studies, such as those of an array of jobs, into one run folder.

use std::path::PathBuf;
use std::sync::Arc;

use kinefront_study::{Merge, MergeError, ReplayError, RunControl, SearchError};

use super::numbers::whole_number;
use super::runs::{RunArguments, perform, write_failure};
use super::signals::interrupt_on_signals;
use super::{Ending, Failure, say};

#[derive(Debug, clap::Args)]
pub struct MergeArguments {
    /// Run folders of one study, which may differ only in seed, budget and name.
    #[arg(required = true, num_args = 2.., value_name = "RUN")]
    runs: Vec<PathBuf>,
    /// Run folder to write; it must not already hold a run.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Keep the non-dominated designs, and every N-th of the others.
    #[arg(long, value_name = "N", default_value_t = 1, allow_negative_numbers = true, value_parser = whole_number::<u64>(1..=100_000_000))]
    keep_every: u64,
    #[command(flatten)]
    run: RunArguments,
}

pub fn run(arguments: &MergeArguments) -> Result<Ending, Failure> {
    let merge = Merge::open(&arguments.runs, arguments.keep_every as usize).map_err(failure)?;
    if !arguments.run.quiet {
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
    let control = Arc::new(RunControl::default());
    interrupt_on_signals(&control, arguments.run.quiet)?;
    let every = arguments.run.record_every(Some(1));
    let (folder, search) = merge
        .start(&arguments.out, every, arguments.run.threads())
        .map_err(failure)?;
    perform(folder, search, &control, &arguments.run)
}

fn failure(error: MergeError) -> Failure {
    match error {
        MergeError::Write(error) => write_failure(error),
        error @ MergeError::Replay(ReplayError::Search(SearchError::Threads(_))) => Failure::runtime(error),
        error => Failure::input(error),
    }
}
