//! `kinefront report`: a run, or the paper, as a page with figures and pictures.

use std::io::Write;
use std::path::PathBuf;

use indicatif::ProgressBar;
use kinefront::report::{Options, Report, ReportError, Source, free};
use miette::Report as Words;

use super::{Ending, Failure};

const SENSITIVITY: u32 = 2000;
const PICTURE_WIDTH: u32 = 800;
const SCALE: f32 = 2.0;

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  kinefront report run                          the run's page in run/report
  kinefront report prr rpr rrr --out compared   several runs that ask for the same
  kinefront report --paper --out paper          the 2010 comparison from nothing")]
pub struct Arguments {
    /// Folders of runs; several must ask for the same, apart from architectures and search.
    #[arg(value_name = "RUN", required_unless_present = "paper", conflicts_with = "paper")]
    runs: Vec<PathBuf>,
    /// Run the paper's study from nothing, each architecture alone and all together, and report on it.
    #[arg(long)]
    paper: bool,
    /// Folder for the report [default: RUN/report, or paper-report].
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace the report that is there.
    #[arg(long)]
    replace: bool,
    /// Evaluations for each search under another reading of an assumption; 0: none are made.
    #[arg(long, value_name = "N", default_value_t = SENSITIVITY, value_parser = clap::value_parser!(u32).range(0..=10_000_000))]
    sensitivity: u32,
    /// Width of the pictures of designs in pixels.
    #[arg(long, value_name = "PIXELS", default_value_t = PICTURE_WIDTH, value_parser = clap::value_parser!(u32).range(160..=8000))]
    picture_width: u32,
    /// Pixels of a figure's PNG per unit; a figure is 640 units wide.
    #[arg(long, value_name = "SCALE", default_value_t = SCALE, value_parser = scale)]
    scale: f32,
    /// No progress.
    #[arg(long, short)]
    quiet: bool,
}

fn scale(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(scale) if (0.25..=10.0).contains(&scale) => Ok(scale),
        _ => Err("expected a number from 0.25 to 10".to_owned()),
    }
}

impl Arguments {
    fn folder(&self) -> PathBuf {
        match (&self.out, self.runs.first()) {
            (Some(out), _) => out.clone(),
            (None, Some(run)) => run.join("report"),
            (None, None) => PathBuf::from("paper-report"),
        }
    }

    /// The command, without where files lie.
    fn command(&self) -> String {
        let mut command = "kinefront report".to_owned();
        if self.paper {
            command += " --paper";
        }
        for run in &self.runs {
            command += &format!(" {}", run.file_name().unwrap_or(run.as_os_str()).to_string_lossy());
        }
        if self.sensitivity != SENSITIVITY {
            command += &format!(" --sensitivity {}", self.sensitivity);
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

pub fn run(arguments: &Arguments) -> Result<Ending, Failure> {
    let folder = arguments.folder();
    free(&folder, arguments.replace).map_err(failure)?;
    let options = Options {
        sensitivity: (arguments.sensitivity > 0).then_some(arguments.sensitivity as usize),
        picture: [arguments.picture_width, arguments.picture_width * 3 / 4],
        scale: arguments.scale,
        command: arguments.command(),
    };
    let spinner = if arguments.quiet {
        ProgressBar::hidden()
    } else {
        ProgressBar::new_spinner()
    };
    spinner.enable_steady_tick(std::time::Duration::from_millis(200));
    let mut tell = |words: &str| spinner.set_message(words.to_owned());
    let report = if arguments.paper {
        Report::of_paper(options, &mut tell)
    } else {
        let sources: Result<Vec<Source>, ReportError> = arguments.runs.iter().map(|run| Source::read(run)).collect();
        sources.and_then(|sources| Report::make(&sources, options, &mut tell))
    };
    let written = report.and_then(|report| report.write(&folder, arguments.replace));
    spinner.finish_and_clear();
    written.map_err(failure)?;
    writeln!(std::io::stdout(), "wrote {}", folder.join("index.html").display())?;
    Ok(Ending::Done)
}

/// What a person can mend in what was asked is a matter of input, the rest is not.
fn failure(error: ReportError) -> Failure {
    let input = matches!(
        error,
        ReportError::NoRun(_)
            | ReportError::Study(_)
            | ReportError::Table(_)
            | ReportError::Differing { .. }
            | ReportError::NothingFeasible
            | ReportError::Occupied(_)
    );
    let report = Words::from_err(error);
    if input {
        Failure::Input(report)
    } else {
        Failure::Runtime(report)
    }
}
