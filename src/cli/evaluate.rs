//! The command `kinefront evaluate`.

use std::ffi::OsString;
use std::io::Write;

use kinefront_export::EvaluationJson;
use kinefront_model::evaluation::{Evaluation, GridChoice};
use kinefront_model::mechanism::{Design, TextError};
use kinefront_study::PreparedStudy;

use super::stream::{answer, next_line};
use super::{Ending, Failure, GridArgument, load_study, tables, to_json};

#[derive(Debug, clap::Args)]
pub struct EvaluateArguments {
    /// Design, as in "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056" (metres; optional mode=+++).
    #[arg(long, required_unless_present = "stdin", conflicts_with = "stdin")]
    design: Option<String>,
    /// Study file, or name of a built-in study [default: paper].
    #[arg(long, value_name = "FILE")]
    study: Option<OsString>,
    /// Sampling grid of poses.
    #[arg(long, value_enum, default_value = "reference")]
    grid: GridArgument,
    /// Print the result as one JSON object.
    #[arg(long)]
    json: bool,
    /// Read one design per line from standard input and write one JSON object per line.
    #[arg(long)]
    stdin: bool,
}

pub fn run(arguments: &EvaluateArguments) -> Result<Ending, Failure> {
    let study = load_study(arguments.study.as_deref()).map_err(Failure::Input)?;
    let mut study = PreparedStudy::new(study).map_err(Failure::runtime)?;
    if arguments.design.is_some() {
        // One design is told in full; a stream has what its study names.
        study = study.with_all_quantities();
    }
    let server = Server {
        study,
        grid: arguments.grid.into(),
    };
    match &arguments.design {
        None => server.serve()?,
        Some(text) => {
            let evaluation = server.evaluate(text).map_err(Failure::input)?;
            let mut out = std::io::stdout().lock();
            if arguments.json {
                let json = EvaluationJson::new(&evaluation).with_dynamics(server.study.model(), &evaluation);
                writeln!(out, "{}", to_json(&json).map_err(Failure::Runtime)?)?;
            } else {
                writeln!(out, "{}", tables::evaluation(&evaluation, server.study.model()))?;
            }
        }
    }
    Ok(Ending::Done)
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
                self.evaluate(text).map(|evaluation| EvaluationJson::new(&evaluation))
            });
            writeln!(out, "{answer}")?;
            out.flush()?;
        }
        Ok(())
    }
}
