//! The command line: dispatches the arguments to a command and converts errors into exit codes.

mod certify;
mod check;
mod completions;
mod evaluate;
#[cfg(feature = "explorer")]
mod explore;
mod export;
mod manual;
mod merge;
mod numbers;
mod optimize;
mod pose;
mod prices;
mod progress;
mod question;
mod report;
mod runs;
mod show;
mod signals;
mod stream;
mod study;
mod study_keys;
mod subject;
mod tables;
mod task;
mod version;
mod why;
mod wish;

pub use signals::keep_going_at_limits;

use std::ffi::OsStr;
use std::io::Write;
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use clap::{Parser, Subcommand};
use kinefront_recording::{UNPACK_COMMAND, unpack_with};
use kinefront_study::{BUILTIN, FileScope, Study, is_shown};
use miette::{IntoDiagnostic, Report, Result, miette};

/// Design explorer for planar parallel manipulators.
#[derive(Debug, Parser)]
#[command(
    name = "kinefront",
    version = version::version(),
    arg_required_else_help = cfg!(not(feature = "explorer")),
    after_help = "The tutorial (docs/tutorial.md, in the sources and in the program archives) takes you from a question to a first machine in ten minutes."
)]
struct ProgramArguments {
    /// Command; without one, the window opens and runs the paper's study.
    #[command(subcommand)]
    command: Option<Command>,
    /// Let a study name files outside its folder, such as a catalogue of bars.
    #[arg(long, global = true)]
    outside_files: bool,
}

/// Whether studies may name files outside their folder.
static OUTSIDE_FILES: AtomicBool = AtomicBool::new(false);

#[derive(Debug, Subcommand)]
enum Command {
    /// Open a study, a run folder or a recording in the window.
    #[cfg(feature = "explorer")]
    Explore(explore::ExploreArguments),
    /// Say that this build has no window.
    #[cfg(not(feature = "explorer"))]
    #[command(hide = true)]
    Explore(NoWindowArguments),
    /// Compute mass, regular workspace and constraint margins of a design, or of a stream of designs.
    Evaluate(evaluate::EvaluateArguments),
    /// Prove bounds of the workspace radius of a design, or of a stream of designs.
    Certify(certify::CertifyArguments),
    /// Compute joint values, dexterity and stiffness of a design at one pose.
    Pose(pose::PoseArguments),
    /// Compute the speeds, forces, power and energy of the actuators of a design over the motion of a study.
    Task(task::TaskArguments),
    /// Show what each requirement costs at a design, and the relaxation that a desired mass would require.
    Prices(prices::PricesArguments),
    /// Find the nearest design that meets the given conditions, verified and proved.
    Wish(wish::WishArguments),
    /// Explain why a desired point beyond the front is not achievable, and by how much each requirement would have to be relaxed.
    Why(why::WhyArguments),
    /// Write a recording of one design with its overlays and a tour of its workspace.
    Show(show::ShowArguments),
    /// Export a design for CAD, viewers and simulators, or the front of a run as a table.
    Export(export::ExportArguments),
    /// Search for light designs with a large regular workspace, without a window.
    Optimize(optimize::OptimizeArguments),
    /// Merge runs that differ in seed into one run folder, and verify their combined front.
    Merge(merge::MergeArguments),
    /// Check a run folder: its tables, the files derived from them, and its recording.
    Check(check::CheckArguments),
    /// Write a report on one or more runs: fronts, trends, comparison, pictures, sensitivity.
    Report(report::ReportArguments),
    /// List, show, create and check study files.
    Study(study::StudyArguments),
    /// Print a script that completes the commands of Kinefront in a shell.
    Completions(completions::CompletionsArguments),
    /// Write the manual pages into a folder.
    Manual(manual::ManualArguments),
    /// Unpack a recording, for the process that asked for it.
    #[command(name = UNPACK_COMMAND, hide = true)]
    UnpackRecording(check::UnpackArguments),
}

impl Command {
    /// Whether the command opens the window. Its drivers abort for reasons of their own, which tools for crashes are to see.
    fn opens_window(&self) -> bool {
        matches!(self, Command::Explore(_))
    }

    /// Whether the command computes on the threads that the whole program shares. Those that do not start without them; unpacking a
    /// recording has little memory for their stacks, too.
    fn shares_threads(&self) -> bool {
        !matches!(
            self,
            Command::Evaluate(_)
                | Command::Certify(_)
                | Command::Pose(_)
                | Command::Task(_)
                | Command::Study(_)
                | Command::Completions(_)
                | Command::Manual(_)
                | Command::UnpackRecording(_)
        )
    }
}

/// What follows `explore` in a build without the window.
#[cfg(not(feature = "explorer"))]
#[derive(Debug, clap::Args)]
struct NoWindowArguments {
    #[arg(hide = true, trailing_var_arg = true, allow_hyphen_values = true)]
    _anything: Vec<std::ffi::OsString>,
}

/// How a command that did not fail has ended.
enum Ending {
    Done,
    /// A signal ended the run.
    Interrupted,
    /// The input is invalid, as was said.
    Refused,
    /// A file of a run could not be written, as was said when it happened; the run can be resumed.
    FilesIncomplete,
}

/// Exit code of a run whose files are incomplete.
const FILES_INCOMPLETE: u8 = 3;

/// Reason why a command failed.
enum Failure {
    /// The input is invalid: exit code 2.
    Input(Report),
    /// A file of a run cannot be written: exit code 3.
    Files(Report),
    /// Something else failed: exit code 1.
    Runtime(Report),
    /// The reader of standard output has closed the pipe: exit code 0.
    BrokenPipe,
}

impl Failure {
    fn input(error: impl std::error::Error + Send + Sync + 'static) -> Self {
        Self::Input(Report::from_err(error))
    }

    fn files(error: impl std::error::Error + Send + Sync + 'static) -> Self {
        Self::Files(Report::from_err(error))
    }

    fn runtime(error: impl std::error::Error + Send + Sync + 'static) -> Self {
        Self::Runtime(Report::from_err(error))
    }
}

impl From<std::io::Error> for Failure {
    fn from(error: std::io::Error) -> Self {
        match error.kind() {
            std::io::ErrorKind::BrokenPipe => Self::BrokenPipe,
            _ => Self::Runtime(miette!("cannot write to standard output: {error}")),
        }
    }
}

/// Parses the arguments and runs the command.
pub fn run() -> ExitCode {
    let arguments = match ProgramArguments::try_parse() {
        Ok(arguments) => arguments,
        Err(message) => return print_message(&message),
    };
    if let Ok(program) = std::env::current_exe() {
        unpack_with(program);
    }
    OUTSIDE_FILES.store(arguments.outside_files, Ordering::Relaxed);
    if arguments
        .command
        .as_ref()
        .is_some_and(|command| !command.opens_window())
    {
        signals::end_without_memory(FILES_INCOMPLETE);
    }
    let outcome = match &arguments.command {
        Some(command) if !command.shares_threads() => Ok(()),
        _ => start_threads(),
    };
    let outcome = outcome.and_then(|()| run_command(arguments.command));
    // What the standard output still holds may not be writable either.
    let outcome = match (outcome, std::io::stdout().flush()) {
        (Ok(Ending::Done), Err(error)) => Err(error.into()),
        (outcome, _) => outcome,
    };
    match outcome {
        Ok(Ending::Done) | Err(Failure::BrokenPipe) => ExitCode::SUCCESS,
        Ok(Ending::Interrupted) => ExitCode::from(signals::INTERRUPTED),
        Ok(Ending::Refused) => ExitCode::from(2),
        Ok(Ending::FilesIncomplete) => ExitCode::from(FILES_INCOMPLETE),
        Err(Failure::Input(report)) => {
            say(format_args!("{report:?}"));
            ExitCode::from(2)
        }
        Err(Failure::Files(report)) => {
            say(format_args!("{report:?}"));
            ExitCode::from(FILES_INCOMPLETE)
        }
        Err(Failure::Runtime(report)) => {
            say(format_args!("{report:?}"));
            ExitCode::from(1)
        }
    }
}

/// Runs a command; without one, the window opens.
fn run_command(command: Option<Command>) -> Result<Ending, Failure> {
    match command {
        #[cfg(feature = "explorer")]
        None => explore::run(&explore::ExploreArguments::default()),
        #[cfg(feature = "explorer")]
        Some(Command::Explore(arguments)) => explore::run(&arguments),
        // Not reached: `arg_required_else_help` prints the help if there is no command.
        #[cfg(not(feature = "explorer"))]
        None => Ok(Ending::Done),
        #[cfg(not(feature = "explorer"))]
        Some(Command::Explore(_)) => Err(Failure::Input(miette!(
            help = "use a build with the window, or open a recording with `rerun run/recording.rrd`",
            "this build of Kinefront is for servers and has no window"
        ))),
        Some(Command::Evaluate(arguments)) => evaluate::run(&arguments),
        Some(Command::Certify(arguments)) => certify::run(&arguments),
        Some(Command::Pose(arguments)) => pose::run(&arguments),
        Some(Command::Task(arguments)) => task::run(&arguments),
        Some(Command::Prices(arguments)) => prices::run(&arguments),
        Some(Command::Wish(arguments)) => wish::run(&arguments),
        Some(Command::Why(arguments)) => why::run(&arguments),
        Some(Command::Show(arguments)) => show::run(&arguments),
        Some(Command::Export(arguments)) => export::run(&arguments),
        Some(Command::Optimize(arguments)) => optimize::run(&arguments),
        Some(Command::Merge(arguments)) => merge::run(&arguments),
        Some(Command::Check(arguments)) => check::run(&arguments),
        Some(Command::UnpackRecording(arguments)) => check::unpack(&arguments),
        Some(Command::Report(arguments)) => report::run(&arguments),
        Some(Command::Study(arguments)) => study::run(&arguments),
        Some(Command::Completions(arguments)) => completions::run(&arguments),
        Some(Command::Manual(arguments)) => manual::run(&arguments),
    }
}

/// Number of times that the start of a thread is tried again, after 10 ms each.
const THREAD_PATIENCE: u32 = 20;

/// Starts the threads that commands share: a system that has none to spare says so here, not in the middle of the work.
fn start_threads() -> Result<(), Failure> {
    let spawn = |thread: rayon::ThreadBuilder| {
        // A start that fails drops what it was given: the thread that does start takes it.
        let slot = Arc::new(Mutex::new(Some(thread)));
        let mut patience = THREAD_PATIENCE;
        loop {
            let taken = Arc::clone(&slot);
            let started = std::thread::Builder::new()
                .name("kinefront-worker".to_owned())
                .spawn(move || {
                    if let Some(thread) = taken.lock().ok().and_then(|mut slot| slot.take()) {
                        thread.run();
                    }
                });
            match started {
                Ok(_) => return Ok(()),
                Err(error) if patience == 0 => return Err(error),
                Err(_) => std::thread::sleep(Duration::from_millis(10)),
            }
            patience -= 1;
        }
    };
    let pool = rayon::ThreadPoolBuilder::new().spawn_handler(spawn);
    pool.build_global()
        .map_err(|error| Failure::Runtime(miette!("cannot start the worker threads: {error}")))
}

/// Prints the help, the version, or what is wrong with the arguments.
fn print_message(message: &clap::Error) -> ExitCode {
    let printed = message.print().and_then(|()| std::io::stdout().flush());
    match printed {
        Err(error) if !message.use_stderr() && error.kind() != std::io::ErrorKind::BrokenPipe => {
            say(format_args!("cannot write to standard output: {error}"));
            ExitCode::from(1)
        }
        _ => ExitCode::from(u8::try_from(message.exit_code()).unwrap_or(2)),
    }
}

/// Prints a line to the standard error. What is said never stops the work, even if nobody can read it.
fn say(line: impl std::fmt::Display) {
    let _ = writeln!(std::io::stderr(), "{}", shown(&line.to_string()));
}

/// Returns a text as it can be shown on a terminal: names and contents of files may hold characters that would move the cursor,
/// change the title of the window, or hide what follows. Colours and the ends of lines stay.
fn shown(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(next) = rest.chars().next() {
        let after = &rest[next.len_utf8()..];
        rest = after;
        if next == '\u{1b}'
            && let Some(end) = color(after)
        {
            shown.push(next);
            shown.push_str(&after[..end]);
            rest = &after[end..];
        } else if is_shown(next) {
            shown.push(next);
        } else {
            shown.extend(next.escape_unicode());
        }
    }
    shown
}

/// Returns the length of what follows an escape character if it sets a colour.
fn color(text: &str) -> Option<usize> {
    let parameters = text.strip_prefix('[')?;
    let end = parameters.find(|c: char| !c.is_ascii_digit() && c != ';')?;
    parameters[end..].starts_with('m').then_some(end + 2)
}

/// The refusal to overwrite a file.
fn exists_already(path: &Path) -> Failure {
    Failure::Input(miette!(
        "{} already exists; choose another file name, or move the existing file",
        path.display()
    ))
}

/// Loads the study that an argument specifies: a study file or the name of a built-in study; without an argument, the
/// paper's study.
fn load_study(argument: Option<&OsStr>) -> Result<Study> {
    let Some(argument) = argument else {
        return Ok(BUILTIN[0].study()?);
    };
    let scope = match OUTSIDE_FILES.load(Ordering::Relaxed) {
        true => FileScope::Anywhere,
        false => FileScope::BesideStudy,
    };
    Ok(Study::load_within(argument, scope)?)
}

fn to_json(value: &impl serde::Serialize) -> Result<String> {
    serde_json::to_string(value).into_diagnostic()
}

/// Prints what a command has found: as one JSON object where that is asked for, otherwise as tables.
fn print(json: Option<impl serde::Serialize>, tables: impl FnOnce() -> String) -> Result<Ending, Failure> {
    let text = match json {
        Some(found) => to_json(&found).map_err(Failure::Runtime)?,
        None => tables(),
    };
    writeln!(std::io::stdout(), "{text}")?;
    Ok(Ending::Done)
}
