//! The command `kinefront show`: writes a recording of one design.

use std::io::Write;
use std::path::PathBuf;

use kinefront_model::evaluation::GridChoice;
use kinefront_recording::record_design;
use kinefront_scene::Field;

use kinefront_study::PreparedStudy;

use super::subject::{A_DESIGN, SubjectArguments, exactly_one_of};
use super::{Ending, Failure, exists_already};

#[derive(Debug, clap::Args)]
#[command(group = exactly_one_of(A_DESIGN))]
pub struct ShowArguments {
    #[command(flatten)]
    subject: SubjectArguments,
    /// Field whose heatmap is shown first.
    #[arg(long, default_value = Field::DEXTERITY.key(), value_parser = field)]
    field: Field,
    /// Show the proof of the workspace first.
    #[arg(long, conflicts_with = "field")]
    proof: bool,
    /// Recording to write; the file must not exist.
    #[arg(long, value_name = "FILE.rrd")]
    record: PathBuf,
}

fn field(text: &str) -> Result<Field, String> {
    Field::find(text).ok_or_else(|| {
        let known: Vec<&str> = Field::all().map(Field::key).collect();
        format!("expected one of {}", known.join(", "))
    })
}

pub fn run(arguments: &ShowArguments) -> Result<Ending, Failure> {
    if arguments.record.exists() {
        return Err(exists_already(&arguments.record));
    }
    let (study, design, heading) = arguments.subject.read().map_err(Failure::Input)?;
    let study = PreparedStudy::new(study).map_err(Failure::runtime)?;
    let evaluation = study.model().evaluate(&design, GridChoice::Fine);
    let first = (!arguments.proof).then_some(arguments.field);
    record_design(&arguments.record, &study, &evaluation, &heading, first).map_err(Failure::runtime)?;
    writeln!(std::io::stdout(), "wrote {}", arguments.record.display())?;
    Ok(Ending::Done)
}
