//! The command `kinefront export`: writes a design for other programs, or the front of a run as a table.

use std::io::Write;
use std::path::{Path, PathBuf};

use kinefront_export::{ExportError, ExportSubject, Format, export, front_to_parquet};
use kinefront_model::evaluation::GridChoice;
use kinefront_model::spatial::Pose;
use kinefront_study::{PreparedStudy, read_regular, read_table, write_whole};
use miette::{IntoDiagnostic, Result, WrapErr, miette};

use super::subject::{A_DESIGN, SubjectArguments, exactly_one_of, run_of, study_beside};
use super::{Ending, Failure, exists_already, say};

#[derive(Debug, clap::Args)]
#[command(after_help = after_help())]
#[command(group = exactly_one_of(A_DESIGN))]
pub struct ExportArguments {
    #[command(flatten)]
    subject: SubjectArguments,
    /// Format [default: determined by the extension of FILE].
    #[arg(long, value_name = "FORMAT", value_parser = target)]
    format: Option<ExportTarget>,
    /// Pose in which the design is written, as in "x=0.1 y=0.2 phi_deg=30" [default: home pose].
    #[arg(long, value_parser = |text: &str| text.parse::<Pose>())]
    pose: Option<Pose>,
    /// File to write, which must not exist; `-` means standard output.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

/// The examples of the help.
const EXAMPLES: &str = "\
Examples:
  kinefront export --design \"3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056\" --out design.glb
  kinefront export run/front.csv#12 --format mjcf --out design.xml
  kinefront export run/front.csv#12 --out parts.csv
  kinefront export run/front.csv#12 --format csv-trajectory --out trajectory.csv
  kinefront export run --out front.parquet";

/// The formats, each with its file extension and its use.
fn after_help() -> String {
    let mut text = String::from("Formats of a design:\n");
    for format in Format::ALL {
        text += &format!("  {:<15} .{:<5} {}\n", format.key(), format.extension(), format.title());
    }
    text += "Formats of a front: csv, parquet; specify the run folder instead of a design.\n\n";
    text + EXAMPLES
}

/// Content and format of the exported file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ExportTarget {
    Design(Format),
    Csv,
    Parquet,
}

fn target(text: &str) -> Result<ExportTarget, String> {
    match text {
        "csv" => Ok(ExportTarget::Csv),
        "parquet" => Ok(ExportTarget::Parquet),
        _ => Format::find(text).map(ExportTarget::Design).ok_or_else(|| {
            let known: Vec<&str> = Format::ALL.iter().map(|format| format.key()).collect();
            format!("expected one of {}, csv, parquet", known.join(", "))
        }),
    }
}

impl ExportArguments {
    fn target(&self) -> Result<ExportTarget> {
        if let Some(target) = self.format {
            return Ok(target);
        }
        let extension = self
            .out
            .extension()
            .unwrap_or_default()
            .to_string_lossy()
            .to_lowercase();
        let design = || {
            Format::ALL
                .iter()
                .copied()
                .find(|format| format.extension() == extension)
        };
        match extension.as_ref() {
            // A front and the parts of a design have one extension.
            "csv" if !self.subject.is_design() => Ok(ExportTarget::Csv),
            "parquet" => Ok(ExportTarget::Parquet),
            _ => design().map(ExportTarget::Design).ok_or_else(|| {
                let mut known: Vec<&str> = Format::ALL.iter().map(Format::extension).collect();
                known.sort_unstable();
                known.dedup();
                miette!(
                    help = format!(
                        "give --format, or a file that ends in .{} or .parquet",
                        known.join(", .")
                    ),
                    "cannot determine the format of {}",
                    self.out.display()
                )
            }),
        }
    }

    /// Refuses arguments that do not fit the target: options that would be ignored, and a file extension that belongs
    /// to another format.
    fn check(&self, target: ExportTarget) -> Result<()> {
        let is_gltf = self
            .out
            .extension()
            .is_some_and(|extension| extension.eq_ignore_ascii_case("gltf"));
        match target {
            ExportTarget::Design(format) if is_gltf && format.extension() == "glb" => Err(miette!(
                help = "use the file extension .glb",
                "{} has the extension of text-based glTF, but Kinefront writes binary glTF",
                self.out.display()
            )),
            ExportTarget::Csv | ExportTarget::Parquet if self.pose.is_some() || self.subject.study.is_some() => Err(
                miette!("--pose and --study do not apply to a front, which is exported as the run wrote it"),
            ),
            _ => Ok(()),
        }
    }
}

pub fn run(arguments: &ExportArguments) -> Result<Ending, Failure> {
    let target = arguments.target().map_err(Failure::Input)?;
    arguments.check(target).map_err(Failure::Input)?;
    let to_stdout = arguments.out == Path::new("-");
    if !to_stdout && arguments.out.exists() {
        return Err(exists_already(&arguments.out));
    }
    let bytes = match target {
        ExportTarget::Design(format) => design(arguments, format)?,
        ExportTarget::Csv | ExportTarget::Parquet => front(arguments, target).map_err(Failure::Input)?,
    };
    if to_stdout {
        std::io::stdout().write_all(&bytes)?;
    } else {
        write_whole(&arguments.out, &bytes).map_err(Failure::runtime)?;
    }
    if let ExportTarget::Design(format) = target
        && let Some(lost) = format.lost()
    {
        say(format_args!("not in {}: {lost}", format.name()));
    }
    if to_stdout {
        return Ok(Ending::Done);
    }
    writeln!(std::io::stdout(), "wrote {}", arguments.out.display())?;
    Ok(Ending::Done)
}

fn design(arguments: &ExportArguments, format: Format) -> Result<Vec<u8>, Failure> {
    let (study, design, _) = arguments.subject.read().map_err(Failure::Input)?;
    let study = PreparedStudy::new(study)
        .map_err(Failure::runtime)?
        .with_all_quantities();
    let evaluation = study.model().evaluate(&design, GridChoice::Fine);
    let subject = ExportSubject {
        study: &study,
        evaluation: &evaluation,
        pose: arguments.pose,
    };
    export(&subject, format).map_err(|error| match error {
        ExportError::Unreachable { .. }
        | ExportError::NoBar(_)
        | ExportError::NoMotion(_)
        | ExportError::NotFinite(_) => Failure::input(error),
        ExportError::Format { .. } => Failure::runtime(error),
    })
}

/// Reads the front of the run that the row argument specifies by the run folder or by one of its tables.
fn front(arguments: &ExportArguments, target: ExportTarget) -> Result<Vec<u8>> {
    let Some(run) = arguments
        .subject
        .row
        .as_ref()
        .filter(|_| !arguments.subject.is_design())
    else {
        return Err(miette!(
            help = "kinefront export run --out front.parquet",
            "csv and parquet hold the front of a run: specify the run folder, not a design"
        ));
    };
    let path = Path::new(run);
    let table = if path.is_dir() {
        path.join("front.csv")
    } else {
        path.to_owned()
    };
    check_table(&table)?;
    let text = read_regular(&table, u64::MAX)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot read {}", table.display()))?;
    match target {
        ExportTarget::Parquet => front_to_parquet(&text).map_err(|message| miette!("{}: {message}", table.display())),
        _ => Ok(text),
    }
}

/// Checks that a table is the one that its run wrote, and that all its rows are complete and valid.
fn check_table(table: &Path) -> Result<()> {
    let study = match run_of(table)? {
        Some(run) if !run.is_verifiable() => {
            return Err(miette!(
                help = "kinefront check reports what is missing",
                "{} cannot be verified: no file states the expected size and checksum of its tables",
                run.path().display()
            ));
        }
        Some(run) => run.study().clone(),
        None => study_beside(table)?,
    };
    let contents = read_table(table, &study).into_diagnostic()?;
    match contents.cut_line {
        None => Ok(()),
        Some(line) => Err(miette!("{}: line {line} is incomplete", table.display())),
    }
}
