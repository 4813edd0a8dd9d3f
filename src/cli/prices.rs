//! The command `kinefront prices`: what each requirement of a study costs at a design.

use std::io::Write;

use kinefront_study::{DesignProblem, DriversOptions};

use super::subject::SubjectArguments;
use super::{Ending, Failure, tables, to_json};

#[derive(Debug, clap::Args)]
#[command(after_help = "\
The design is first made the best one near it, with every pose of the region as a constraint and a continuous home orientation. A price
is the change of the first objective in per cent for 1 % of a requirement; the other objectives, as the workspace radius, keep the
values of the design. A requirement that costs nothing there is listed with the amount by which it may rise.")]
pub struct PricesArguments {
    #[command(flatten)]
    subject: SubjectArguments,
    /// Workspace radius that is kept, in metres [default: that of the design on the fine grid].
    #[arg(long, value_name = "R")]
    radius: Option<f64>,
    /// Keep the geometry and the home orientation, and change the bars alone.
    #[arg(long)]
    bars_only: bool,
    /// Optimise the design again after steps of 3, 10 and 20 % of each parameter.
    #[arg(long)]
    steps: bool,
    /// Tell what each requirement would have to give for this mass in kilograms, or this value of the first objective.
    #[arg(long, value_name = "KG")]
    wish_mass: Option<f64>,
    /// Print the result as one JSON object.
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &PricesArguments) -> Result<Ending, Failure> {
    let (study, design, heading) = arguments.subject.read().map_err(Failure::Input)?;
    for (key, value) in [("--radius", arguments.radius), ("--wish-mass", arguments.wish_mass)] {
        above_zero(key, value)?;
    }
    let problem = DesignProblem::new(&study).map_err(Failure::runtime)?;
    let local = problem.local(&design, arguments.radius).map_err(Failure::input)?;
    let options = DriversOptions {
        bars_only: arguments.bars_only,
        steps: arguments.steps,
        wish: arguments.wish_mass,
    };
    let drivers = local.drivers(options).map_err(Failure::input)?;
    let mut out = std::io::stdout().lock();
    if arguments.json {
        writeln!(out, "{}", to_json(&drivers).map_err(Failure::Runtime)?)?;
    } else {
        writeln!(out, "{}", tables::drivers(&heading, &drivers))?;
    }
    Ok(Ending::Done)
}

/// Refuses a number of an argument that is not above 0.
pub fn above_zero(key: &str, value: Option<f64>) -> Result<(), Failure> {
    match value {
        Some(value) if !(value.is_finite() && value > 0.0) => Err(Failure::Input(miette::miette!(
            "{key} is {value}; it must be a number above 0"
        ))),
        _ => Ok(()),
    }
}
