//! The command `kinefront report`: writes a page with figures and pictures on runs or on the paper's study.

use std::io::Write;
use std::path::PathBuf;

use indicatif::ProgressBar;
use kinefront_report::{Options, Report, ReportError, SideBySide, Source, free};
use miette::Report as Words;

use super::numbers::whole_number;
use super::progress::keep_ticking;
use super::{Ending, Failure, load_study, say};

const SENSITIVITY: usize = 2000;
const PICTURE_WIDTH: u32 = 800;
const SCALE: f32 = 2.0;

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  kinefront report run                          report on one run in run/report
  kinefront report prr rpr rrr --out compared   report on several runs with the same requirements
  kinefront report steel aluminium --out both   runs of different studies side by side
  kinefront report --paper --out paper          comparison with the 2010 paper, with new runs of its study")]
pub struct ReportArguments {
    /// Run folders. Runs whose studies differ only in architectures and search are combined in one report; others are shown side by
    /// side, if their objectives are the same.
    #[arg(value_name = "RUN", required_unless_present = "paper", conflicts_with = "paper")]
    runs: Vec<PathBuf>,
    /// Run the paper's study again, each architecture separately and all together, and report on it.
    #[arg(long)]
    paper: bool,
    /// Folder for the report [default: RUN/report, or paper-report].
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace an existing report.
    #[arg(long)]
    replace: bool,
    /// Number of evaluations of each search for the sensitivity to assumptions of a study with two objectives; 0 omits the
    /// sensitivity [default: 2000 with --paper, otherwise 0].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole_number::<u32>(0..=10_000_000))]
    sensitivity: Option<u32>,
    /// Width in pixels of the pictures of designs.
    #[arg(long, value_name = "PIXELS", default_value_t = PICTURE_WIDTH, allow_negative_numbers = true, value_parser = whole_number::<u32>(160..=8000))]
    picture_width: u32,
    /// Scale of the figures' PNG files in pixels per unit; a figure is 640 units wide.
    #[arg(long, value_name = "SCALE", default_value_t = SCALE, value_parser = scale)]
    scale: f32,
    /// Print nothing but errors.
    #[arg(long, short)]
    quiet: bool,
}

fn scale(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(scale) if (0.25..=10.0).contains(&scale) => Ok(scale),
        _ => Err("expected a number from 0.25 to 10".to_owned()),
    }
}

impl ReportArguments {
    fn folder(&self) -> PathBuf {
        match (&self.out, self.runs.first()) {
            (Some(out), _) => out.clone(),
            (None, Some(run)) => run.join("report"),
            (None, None) => PathBuf::from("paper-report"),
        }
    }

    /// Returns the command line for the report, without the paths of files and folders.
    fn command(&self) -> String {
        let mut command = "kinefront report".to_owned();
        if self.paper {
            command += " --paper";
        }
        for run in &self.runs {
            command += &format!(" {}", run.file_name().unwrap_or(run.as_os_str()).to_string_lossy());
        }
        if let Some(evaluations) = self.sensitivity {
            command += &format!(" --sensitivity {evaluations}");
        }
        if self.picture_width != PICTURE_WIDTH {
            command += &format!(" --picture-width {}", self.picture_width);
        }
        if self.scale != SCALE {
            command += &format!(" --scale {}", self.scale);
        }
        command
    }
}

/// Returns the number of evaluations for the sensitivity; 0 omits it.
fn evaluations(asked: u32) -> Option<usize> {
    (asked > 0).then_some(asked as usize)
}

pub fn run(arguments: &ReportArguments) -> Result<Ending, Failure> {
    let folder = arguments.folder();
    free(&folder, arguments.replace).map_err(failure)?;
    let options = Options {
        sensitivity: match arguments.sensitivity {
            Some(asked) => evaluations(asked),
            None => arguments.paper.then_some(SENSITIVITY),
        },
        picture: [arguments.picture_width, arguments.picture_width * 3 / 4],
        scale: arguments.scale,
        command: arguments.command(),
    };
    let spinner = if arguments.quiet {
        ProgressBar::hidden()
    } else {
        ProgressBar::new_spinner()
    };
    keep_ticking(&spinner);
    let mut tell = |words: &str| match spinner.is_hidden() && !arguments.quiet {
        // A file or a pipe, where no line is drawn again: each part of the work has one of its own.
        true => say(words),
        false => spinner.set_message(words.to_owned()),
    };
    let report = if arguments.paper {
        let study = load_study(None).map_err(Failure::Input)?;
        Report::from_scratch(&study, options, &mut tell)
    } else {
        let sources: Result<Vec<Source>, ReportError> = arguments.runs.iter().map(|run| Source::read(run)).collect();
        sources.and_then(|sources| {
            for source in &sources {
                if let Some(line) = source.cut_line {
                    say(format_args!(
                        "{}: line {line} of designs.csv is incomplete and was left out",
                        source.name
                    ));
                }
            }
            Report::make(&sources, options, &mut tell)
        })
    };
    let written = match report {
        Err(ReportError::Differing { .. }) => SideBySide::read(&arguments.runs, arguments.command())
            .and_then(|found| found.write(&folder, arguments.replace)),
        report => report.and_then(|report| report.write(&folder, arguments.replace)),
    };
    spinner.finish_and_clear();
    written.map_err(failure)?;
    if !arguments.quiet {
        writeln!(std::io::stdout(), "wrote {}", folder.join("index.html").display())?;
    }
    Ok(Ending::Done)
}

/// Classifies an error: those that the user can correct by other input are input errors, all others are runtime errors.
fn failure(error: ReportError) -> Failure {
    let input = matches!(
        error,
        ReportError::Folder(_)
            | ReportError::Table(_)
            | ReportError::Differing { .. }
            | ReportError::NothingFeasible
            | ReportError::NoFront(_)
            | ReportError::Sensitivity { .. }
            | ReportError::Occupied(_)
    );
    let report = Words::from_err(error);
    if input {
        Failure::Input(report)
    } else {
        Failure::Runtime(report)
    }
}
