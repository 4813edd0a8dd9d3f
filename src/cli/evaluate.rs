//! The command `kinefront evaluate`.

use std::io::Write;

use kinefront_export::EvaluationJson;
use kinefront_model::evaluation::{Evaluation, GridChoice};
use kinefront_model::mechanism::{Design, TextError};
use kinefront_study::PreparedStudy;

use super::stream::{answer, next_line};
use super::subject::{DESIGN_OR_STREAM, GridArgument, SubjectArguments, exactly_one_of};
use super::{Ending, Failure, load_study, print, tables};

#[derive(Debug, clap::Args)]
#[command(group = exactly_one_of(DESIGN_OR_STREAM))]
pub struct EvaluateArguments {
    #[command(flatten)]
    subject: SubjectArguments,
    /// Sampling grid of poses [default: reference, and fine for a design of a table].
    #[arg(long, value_enum)]
    grid: Option<GridArgument>,
    /// Print the result as one JSON object.
    #[arg(long)]
    json: bool,
    /// Read one design per line from standard input and write one JSON object per line.
    #[arg(long)]
    stdin: bool,
}

pub fn run(arguments: &EvaluateArguments) -> Result<Ending, Failure> {
    let grid = arguments.subject.grid(arguments.grid);
    if arguments.stdin {
        let study = load_study(arguments.subject.study.as_deref()).map_err(Failure::Input)?;
        let study = PreparedStudy::new(study).map_err(Failure::runtime)?;
        Server { study, grid }.serve()?;
        return Ok(Ending::Done);
    }
    let (study, design, _) = arguments.subject.read().map_err(Failure::Input)?;
    // One design is told in full; a stream has what its study names.
    let study = PreparedStudy::new(study)
        .map_err(Failure::runtime)?
        .with_all_quantities();
    let model = study.model();
    let evaluation = model.evaluate_in_full(&design, grid);
    let json = || EvaluationJson::new(&evaluation, model).with_dynamics(model, &evaluation);
    print(arguments.json.then(json), || tables::evaluation(&evaluation, model))
}

struct Server {
    study: PreparedStudy,
    grid: GridChoice,
}

impl Server {
    fn evaluate(&self, text: &str) -> Result<Evaluation, TextError> {
        let design = Design::parse(text, self.study.study().working_mode)?;
        Ok(self.study.model().evaluate(&design, self.grid))
    }

    /// Writes one line for each line read, in order. For an invalid line it writes an error object and continues.
    fn serve(&self) -> Result<(), Failure> {
        let mut input = std::io::stdin().lock();
        let mut out = std::io::stdout().lock();
        while let Some(line) = next_line(&mut input)? {
            let answer = answer(line, |text| {
                let found = self.evaluate(text);
                found.map(|evaluation| EvaluationJson::new(&evaluation, self.study.model()))
            });
            writeln!(out, "{answer}")?;
            out.flush()?;
        }
        Ok(())
    }
}
