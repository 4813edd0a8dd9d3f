//! Arguments to one of the commands, and errors to exit codes.

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
use kinefront_model::evaluation::GridChoice;
use kinefront::study::{BUILTIN, Builtin, Study};
use miette::{IntoDiagnostic, Report, Result, miette};

/// Design explorer for planar parallel manipulators.
#[derive(Debug, Parser)]
#[command(name = "kinefront", version, arg_required_else_help = cfg!(not(feature = "explorer")))]
struct Arguments {
    /// Without one, the window opens and runs the paper's study.
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Open the window on a study, a run folder or a recording.
    #[cfg(feature = "explorer")]
    Explore(explore::Arguments),
    /// Mass, regular workspace and constraint margins of a design, or of a stream of designs.
    Evaluate(evaluate::Arguments),
    /// Joints, dexterity and stiffness of a design at one pose.
    Pose(pose::Arguments),
    /// Record one design with its overlays and a tour of its workspace.
    Show(show::Arguments),
    /// Write a design for CAD, viewers and simulators, or a run's front as a table.
    Export(export::Arguments),
    /// Search for light designs with a large regular workspace, without a window.
    Optimize(optimize::Arguments),
    /// Make a page of runs: fronts, trends, comparison, pictures, sensitivity.
    Report(report::Arguments),
    /// List, show, check and write study files.
    Study(study::Arguments),
}

/// How a command ends when nothing went wrong with its input.
enum Ending {
    Done,
    Interrupted,
}

/// Why a command did not do what was asked.
enum Failure {
    /// The input was wrong: exit code 2.
    Input(Report),
    /// Something else failed: exit code 1.
    Runtime(Report),
    /// Whoever read our output has left.
    BrokenPipe,
}

impl Failure {
    fn input(error: impl Into<Report>) -> Self {
        Self::Input(error.into())
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

/// Reads the arguments and does what they say.
pub fn run() -> ExitCode {
    let outcome = match Arguments::parse().command {
        #[cfg(feature = "explorer")]
        None => explore::run(&explore::Arguments::default()),
        #[cfg(feature = "explorer")]
        Some(Command::Explore(arguments)) => explore::run(&arguments),
        // Asked for in the arguments' attributes: it ends with the help.
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

/// The study of an argument: a file, the name of one that comes with the program, or the paper's.
fn load_study(argument: Option<&str>) -> Result<Study> {
    let Some(argument) = argument else {
        return Ok(BUILTIN[0].study()?);
    };
    let path = Path::new(argument);
    match Builtin::find(argument) {
        // A folder of that name is no study.
        Some(builtin) if !path.is_file() => Ok(builtin.study()?),
        None if !path.is_file() => Err(miette!(
            help = format!("studies that come with the program: {}", builtin_names()),
            "there is no study file `{argument}`, and no study of that name"
        )),
        _ => Ok(Study::read(path)?),
    }
}

fn builtin_names() -> String {
    BUILTIN.map(|builtin| builtin.name).join(", ")
}

/// The grid of an argument.
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum GridArgument {
    /// The grid that designs are searched on.
    Reference,
    /// The grid that reported designs are verified on.
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
