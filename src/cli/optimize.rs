//! The command `kinefront optimize`: runs a study without a window.

use std::ffi::OsString;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use kinefront_model::mechanism::Architecture;
use kinefront_study::{
    AlgorithmName, Builtin, Overrides, ResumeError, ResumeOptions, Resumption, RunControl, RunFolder, RunWriter, Study,
    StudySearch, WHOLE_FRONT, WriteError,
};
use miette::miette;

use super::numbers::whole_number;
use super::runs::{RunArguments, perform, write_failure};
use super::signals::interrupt_on_signals;
use super::{Ending, Failure, load_study, say};

#[derive(Debug, clap::Args)]
pub struct OptimizeArguments {
    /// Study file, or name of a built-in study [default: paper].
    study: Option<OsString>,
    /// Run folder to continue. With a larger --evaluations, a run that has ended is extended.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["study", "algorithm", "seed", "front", "architectures", "out"])]
    resume: Option<PathBuf>,
    /// Resume a folder that does not state the size and checksum of its designs, with the rows that it contains.
    #[arg(long, requires = "resume", conflicts_with_all = ["study", "algorithm", "seed", "front", "architectures", "out"])]
    accept_unverified: bool,
    /// Algorithm; overrides that of the study.
    #[arg(long, value_parser = algorithms())]
    algorithm: Option<AlgorithmName>,
    /// Number of evaluations; overrides that of the study.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole_number::<u64>(1..=100_000_000))]
    evaluations: Option<u64>,
    /// Random seed; overrides that of the study.
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = whole_number::<u64>(0..=i64::MAX as u64))]
    seed: Option<u64>,
    /// Number of designs that are reported, or `all` for the whole verified front; overrides that of the study.
    #[arg(long, value_name = "N|all", value_parser = front_size)]
    front: Option<usize>,
    /// Architectures, as in 3-PRR,3-RRR; override those of the study.
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    architectures: Option<Vec<Architecture>>,
    /// Run folder to write; it must not already hold a run [default: runs/STUDY-seedS].
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    run: RunArguments,
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
    perform(folder, search, &control, &arguments.run)
}

/// Prepares a new run in its folder.
fn begin(arguments: &OptimizeArguments, control: &Arc<RunControl>) -> Result<(RunWriter, StudySearch), Failure> {
    let study = study(arguments)?;
    let search = StudySearch::new(study, None).map_err(Failure::runtime)?;
    // A signal before there is a folder ends the program as it is; from here on it finds its handler.
    interrupt_on_signals(control, arguments.run.quiet)?;
    let study = search.study();
    let every = arguments.run.record_every(Some(1));
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
    let options = ResumeOptions {
        evaluations: arguments.evaluations.map(|number| number as usize),
        threads: arguments.run.threads(),
        accept_unverified: arguments.accept_unverified,
    };
    let resumption = Resumption::open(path, &options).map_err(|error| match error {
        ResumeError::Lock(error) => write_failure(error),
        error if error.is_of_system() => Failure::runtime(error),
        error => Failure::input(error),
    })?;
    if !arguments.run.quiet {
        for note in resumption.notes() {
            say(format_args!("{}: {note}", path.display()));
        }
    }
    if resumption.is_complete() {
        if arguments.run.json {
            let text = std::fs::read_to_string(resumption.folder().report_path()).map_err(Failure::runtime)?;
            write!(std::io::stdout(), "{text}")?;
        } else if !arguments.run.quiet {
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
    let every = arguments.run.record_every(resumption.record_every());
    interrupt_on_signals(control, arguments.run.quiet)?;
    resumption.start(every).map(Some).map_err(write_failure)
}

/// Loads the study that the arguments specify and checks it again with the values that they override.
fn study(arguments: &OptimizeArguments) -> Result<Study, Failure> {
    let named = arguments.study.as_deref();
    // A folder with the name of a built-in study does not hide it.
    let is_builtin = named.and_then(|name| Builtin::find(name.to_str()?)).is_some();
    if let Some(run) = named
        .map(Path::new)
        .filter(|path| !is_builtin && RunFolder::is_at(path))
    {
        return Err(Failure::Input(miette!(
            help = format!(
                "kinefront optimize --resume {0} continues the run; kinefront optimize {0}/study.toml starts a new run of its study",
                run.display()
            ),
            "{} is a run folder, not a study",
            run.display()
        )));
    }
    let study = load_study(arguments.study.as_deref()).map_err(Failure::Input)?;
    let overrides = Overrides {
        algorithm: arguments.algorithm,
        evaluations: arguments.evaluations.map(|evaluations| evaluations as usize),
        seed: arguments.seed,
        threads: arguments.run.threads(),
        front_designs: arguments.front,
        architectures: arguments.architectures.clone(),
    };
    let study = overrides.apply(study);
    study.map_err(|fault| Failure::Input(miette!("`{}` {}", fault.key, fault.message)))
}

fn front_size(text: &str) -> Result<usize, String> {
    match (text, text.parse()) {
        ("all", _) => Ok(WHOLE_FRONT),
        (_, Ok(count @ 3..=WHOLE_FRONT)) => Ok(count),
        _ => Err(format!("it must be 3 to {WHOLE_FRONT}, or `all`")),
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

/// Parser of the names of the algorithms, which error messages list.
fn algorithms() -> impl TypedValueParser<Value = AlgorithmName> {
    PossibleValuesParser::new(AlgorithmName::ALL.map(|name| PossibleValue::new(name.name()).help(name.description())))
        .try_map(|name| AlgorithmName::find(&name).ok_or("unknown algorithm"))
}
