//! The command `kinefront explore`, also run by `kinefront` without a command: opens the window.

use std::ffi::OsString;
use std::path::PathBuf;

use kinefront_explorer::{InitialContent, Script, run as open_window};
use kinefront_study::BUILTIN;
use miette::miette;

use super::numbers::whole_number;
use super::signals::at_end_signals;
use super::{Ending, Failure, load_study};

#[derive(Debug, Default, clap::Args)]
pub struct ExploreArguments {
    /// Study file, name of a built-in study, run folder, or Kinefront recording (.rrd) [default: paper].
    subject: Option<OsString>,
    /// Do not start the run of the study.
    #[arg(long)]
    no_run: bool,
    /// Random seed; overrides that of the study.
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = whole_number::<u64>(0..=i64::MAX as u64))]
    seed: Option<u64>,
    /// Number of evaluations; overrides that of the study.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole_number::<u64>(1..=100_000_000))]
    evaluations: Option<u64>,
    /// Script that operates the window, for screenshots and measurements.
    #[arg(long, value_name = "FILE")]
    script: Option<PathBuf>,
}

pub fn run(arguments: &ExploreArguments) -> Result<Ending, Failure> {
    let script = match &arguments.script {
        Some(path) => Some(Script::read(path).map_err(Failure::input)?),
        None => None,
    };
    open_window(subject(arguments)?, script, at_end_signals).map_err(|words| Failure::Runtime(miette!("{words}")))?;
    Ok(Ending::Done)
}

fn subject(arguments: &ExploreArguments) -> Result<InitialContent, Failure> {
    let path = arguments.subject.as_ref().map(PathBuf::from);
    if let Some(path) = path.as_ref().filter(|path| path.exists()) {
        let is_study = path.is_file() && path.extension().is_some_and(|extension| extension == "toml");
        if !is_study {
            // Errors are reported before the window opens.
            kinefront_explorer::open(path).map_err(Failure::input)?;
            return Ok(InitialContent::Run(path.clone()));
        }
    }
    let mut study = load_study(arguments.subject.as_deref()).map_err(Failure::Input)?;
    if let Some(seed) = arguments.seed {
        study.optimizer.seed = seed;
    }
    if let Some(evaluations) = arguments.evaluations {
        study.optimizer.evaluations = evaluations as usize;
    }
    let builtin = BUILTIN
        .iter()
        .any(|builtin| arguments.subject.as_deref() == Some(builtin.name.as_ref()));
    Ok(InitialContent::Study {
        study: Box::new(study),
        path: path.filter(|path| path.exists() && !builtin),
        start: !arguments.no_run,
    })
}
