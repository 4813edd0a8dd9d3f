//! The command `kinefront evaluate`.

use std::ffi::OsString;
use std::io::{BufRead, Read, Write};

use kinefront::export::EvaluationJson;
use kinefront_model::evaluation::{Evaluation, GridChoice, Model};
use kinefront_model::mechanism::{Design, TextError, WorkingMode};

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
    let server = Server {
        model: study.model().map_err(Failure::runtime)?,
        mode: study.working_mode,
        grid: arguments.grid.into(),
    };
    match &arguments.design {
        None => server.serve()?,
        Some(text) => {
            let evaluation = server.evaluate(text).map_err(Failure::input)?;
            let mut out = std::io::stdout().lock();
            if arguments.json {
                writeln!(
                    out,
                    "{}",
                    to_json(&EvaluationJson::new(&evaluation)).map_err(Failure::Runtime)?
                )?;
            } else {
                writeln!(out, "{}", tables::evaluation(&evaluation, &server.model))?;
            }
        }
    }
    Ok(Ending::Done)
}

/// Longest line of a stream \[bytes\]; a design takes about a hundred.
pub const LONGEST_LINE: u64 = 1 << 16;

struct Server {
    model: Model,
    mode: WorkingMode,
    grid: GridChoice,
}

impl Server {
    fn evaluate(&self, text: &str) -> Result<Evaluation, TextError> {
        let design = Design::parse(text, self.mode)?;
        Ok(self.model.evaluate(&design, self.grid))
    }

    /// Writes one line for each line read, in order. For an invalid line it writes an error object and continues.
    fn serve(&self) -> Result<(), Failure> {
        let mut input = std::io::stdin().lock();
        let mut out = std::io::stdout().lock();
        let mut line = Vec::new();
        loop {
            line.clear();
            if (&mut input).take(LONGEST_LINE).read_until(b'\n', &mut line)? == 0 {
                return Ok(());
            }
            let is_whole = line.len() < LONGEST_LINE as usize || line.ends_with(b"\n");
            if !is_whole {
                input.skip_until(b'\n')?;
            }
            let text = match std::str::from_utf8(&line) {
                _ if !is_whole => Err(format!("the line is longer than {LONGEST_LINE} bytes")),
                Ok(text) => Ok(text),
                Err(_) => Err("the line is not UTF-8".to_owned()),
            };
            let answer = text
                .and_then(|text| self.evaluate(text).map_err(|error| error.to_string()))
                .and_then(|evaluation| to_json(&EvaluationJson::new(&evaluation)).map_err(|error| error.to_string()))
                .unwrap_or_else(|message| serde_json::json!({ "error": message }).to_string());
            writeln!(out, "{answer}")?;
            out.flush()?;
        }
    }
}
