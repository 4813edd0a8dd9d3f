//! The command line: dispatches the arguments to a command and converts errors into exit codes.

mod evaluate;
#[cfg(feature = "explorer")]
mod explore;
mod export;
mod optimize;
mod pose;
mod progress;
mod report;
mod show;
mod study;
mod subject;
mod tables;

use std::path::Path;
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use kinefront::study::{BUILTIN, Builtin, Study};
use kinefront_model::evaluation::GridChoice;
use miette::{IntoDiagnostic, Report, Result, miette};

/// Design explorer for planar parallel manipulators.
#[derive(Debug, Parser)]
#[command(name = "kinefront", version, arg_required_else_help = cfg!(not(feature = "explorer")))]
struct ProgramArguments {
    /// Command; without one, the window opens and runs the paper's study.
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Open a study, a run folder or a recording in the window.
    #[cfg(feature = "explorer")]
    Explore(explore::ExploreArguments),
    /// Compute mass, regular workspace and constraint margins of a design, or of a stream of designs.
    Evaluate(evaluate::EvaluateArguments),
    /// Compute joint values, dexterity and stiffness of a design at one pose.
    Pose(pose::PoseArguments),
    /// Write a recording of one design with its overlays and a tour of its workspace.
    Show(show::ShowArguments),
    /// Export a design for CAD, viewers and simulators, or the front of a run as a table.
    Export(export::ExportArguments),
    /// Search for light designs with a large regular workspace, without a window.
    Optimize(optimize::OptimizeArguments),
    /// Write a report on one or more runs: fronts, trends, comparison, pictures, sensitivity.
    Report(report::ReportArguments),
    /// List, show, create and check study files.
    Study(study::StudyArguments),
}

/// How a command that did not fail has ended.
enum Ending {
    Done,
    Interrupted,
}

/// Reason why a command failed.
enum Failure {
    /// The input is invalid: exit code 2.
    Input(Report),
    /// Something else failed: exit code 1.
    Runtime(Report),
    /// The reader of standard output has closed the pipe: exit code 0.
    BrokenPipe,
}

impl Failure {
    fn input(error: impl std::error::Error + Send + Sync + 'static) -> Self {
        Self::Input(Report::from_err(error))
    }

    fn runtime(error: impl std::error::Error + Send + Sync + 'static) -> Self {
        Self::Runtime(Report::from_err(error))
    }
}

impl From<std::io::Error> for Failure {
    fn from(error: std::io::Error) -> Self {
        match error.kind() {
            std::io::ErrorKind::BrokenPipe => Self::BrokenPipe,
            _ => Self::runtime(error),
        }
    }
}

/// Parses the arguments and runs the command.
pub fn run() -> ExitCode {
    let outcome = match ProgramArguments::parse().command {
        #[cfg(feature = "explorer")]
        None => explore::run(&explore::ExploreArguments::default()),
        #[cfg(feature = "explorer")]
        Some(Command::Explore(arguments)) => explore::run(&arguments),
        // Not reached: `arg_required_else_help` prints the help if there is no command.
        #[cfg(not(feature = "explorer"))]
        None => Ok(Ending::Done),
        Some(Command::Evaluate(arguments)) => evaluate::run(&arguments),
        Some(Command::Pose(arguments)) => pose::run(&arguments),
        Some(Command::Show(arguments)) => show::run(&arguments),
        Some(Command::Export(arguments)) => export::run(&arguments),
        Some(Command::Optimize(arguments)) => optimize::run(&arguments),
        Some(Command::Report(arguments)) => report::run(&arguments),
        Some(Command::Study(arguments)) => study::run(&arguments),
    };
    match outcome {
        Ok(Ending::Done) | Err(Failure::BrokenPipe) => ExitCode::SUCCESS,
        Ok(Ending::Interrupted) => ExitCode::from(130),
        Err(Failure::Input(report)) => {
            eprintln!("{report:?}");
            ExitCode::from(2)
        }
        Err(Failure::Runtime(report)) => {
            eprintln!("{report:?}");
            ExitCode::from(1)
        }
    }
}

/// The refusal to overwrite a file.
fn exists_already(path: &Path) -> Failure {
    Failure::Input(miette!(
        "{} exists already; choose another file, or move that one away",
        path.display()
    ))
}

/// Loads the study that an argument specifies: a study file or the name of a built-in study; without an argument, the
/// paper's study.
fn load_study(argument: Option<&str>) -> Result<Study> {
    let Some(argument) = argument else {
        return Ok(BUILTIN[0].study()?);
    };
    let path = Path::new(argument);
    match Builtin::find(argument) {
        // A folder of that name does not take precedence over the built-in study.
        Some(builtin) if !path.is_file() => Ok(builtin.study()?),
        None if !path.is_file() => Err(miette!(
            help = format!("the built-in studies are: {}", builtin_names()),
            "there is neither a study file nor a built-in study named `{argument}`"
        )),
        _ => Ok(Study::read(path)?),
    }
}

fn builtin_names() -> String {
    BUILTIN.map(|builtin| builtin.name).join(", ")
}

/// The grid that an argument specifies.
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum GridArgument {
    /// The grid used in the search.
    Reference,
    /// The grid on which reported designs are verified.
    Fine,
}

impl From<GridArgument> for GridChoice {
    fn from(argument: GridArgument) -> Self {
        match argument {
            GridArgument::Reference => GridChoice::Reference,
            GridArgument::Fine => GridChoice::Fine,
        }
    }
}

fn to_json(value: &impl serde::Serialize) -> Result<String> {
    serde_json::to_string(value).into_diagnostic()
}
