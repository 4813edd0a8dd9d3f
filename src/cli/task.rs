//! The command `kinefront task`.

use std::io::Write;

use kinefront_export::{MotionProofJson, TaskJson, TaskRow};
use kinefront_scene::text;
use miette::miette;
use serde::Serialize;

use super::subject::{A_DESIGN, GridArgument, SubjectArguments, exactly_one_of};
use super::{Ending, Failure, say, tables, to_json};

#[derive(Debug, clap::Args)]
#[command(
    group = exactly_one_of(A_DESIGN),
    after_help = "The section `[task]` of the study defines the motion."
)]
pub struct TaskArguments {
    #[command(flatten)]
    subject: SubjectArguments,
    /// Sampling grid that determines the workspace to which the motion is scaled [default: reference, and fine for a design of a table].
    #[arg(long, value_enum)]
    grid: Option<GridArgument>,
    /// Print the curves over time as CSV, a row for each sample.
    #[arg(long, conflicts_with = "json")]
    csv: bool,
    /// Print figures and curves as one JSON object.
    #[arg(long)]
    json: bool,
}

/// The output of `kinefront task --json`.
#[derive(Debug, Serialize)]
struct TaskReportJson {
    design: String,
    study: String,
    #[serde(flatten)]
    task: TaskJson,
    /// Time of the shortest cycle that the limits of the study allow, and the quantity whose limit sets it.
    shortest_cycle_s: Option<f64>,
    shortest_cycle_set_by: Option<&'static str>,
    samples: Vec<TaskRow>,
    /// What is proved about the motion at every moment; nothing if the design does not follow it.
    proof: Option<MotionProofJson>,
}

pub fn run(arguments: &TaskArguments) -> Result<Ending, Failure> {
    let (study, design, _) = arguments.subject.read().map_err(Failure::Input)?;
    let model = study.model().map_err(Failure::runtime)?;
    let evaluation = model.evaluate(&design, arguments.subject.grid(arguments.grid));
    let Some((outcome, samples)) = model.follow_task(&evaluation) else {
        return Err(Failure::Input(miette!(
            help = "add a section [task], for example with shape = \"pick-and-place\" and cycle_time_s = 2.0, and name the file \
                    with --study",
            "the study `{}` defines no motion",
            study.name
        )));
    };
    let shortest = || model.shortest_cycle(&evaluation);
    let proof = || model.certify_motion(&design, &outcome);
    let catalogue = &model.settings().drive_catalogue;
    let mut out = std::io::stdout().lock();
    // A motion that ends early has no curves that stop in the middle.
    let is_complete = outcome.figures().is_some();
    let rows = samples.iter().filter(|_| is_complete).map(TaskRow::from);
    if arguments.json {
        let shortest = shortest();
        let json = TaskReportJson {
            design: design.to_string(),
            study: study.name.clone(),
            task: TaskJson::new(&outcome, catalogue),
            shortest_cycle_s: shortest.map(|shortest| shortest.time),
            shortest_cycle_set_by: shortest.map(|shortest| shortest.limit.quantity.entry().key),
            samples: rows.collect(),
            proof: proof().as_ref().map(MotionProofJson::from),
        };
        writeln!(out, "{}", to_json(&json).map_err(Failure::Runtime)?)?;
    } else if arguments.csv {
        write_rows(&mut out, rows)?;
        if let Some(reason) = text::motion_fault(&outcome) {
            say(format_args!("{design}: {reason}"));
        }
    } else {
        let fault = text::motion_fault(&outcome);
        writeln!(
            out,
            "{}",
            tables::task(&design, &outcome, catalogue, fault, (shortest(), proof()))
        )?;
    }
    Ok(Ending::Done)
}

fn write_rows(out: &mut impl Write, rows: impl Iterator<Item = TaskRow>) -> Result<(), Failure> {
    let mut writer = csv::WriterBuilder::new().from_writer(out);
    for row in rows {
        writer.serialize(row).map_err(|error| match error.into_kind() {
            csv::ErrorKind::Io(error) => Failure::from(error),
            other => Failure::Runtime(miette!("cannot write a sample: {other:?}")),
        })?;
    }
    writer.flush()?;
    Ok(())
}
