//! The command `kinefront why`: why a point above the front cannot be had.

use std::ffi::OsString;
use std::io::Write;
use std::path::PathBuf;

use kinefront_model::mechanism::Design;
use kinefront_study::{DesignProblem, read_designs};
use miette::miette;

use super::prices::above_zero;
use super::subject::{run_of, study_beside};
use super::{Ending, Failure, load_study, tables, to_json};

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Of each architecture, the designs of the front whose radius is nearest are made the best ones for the wished radius. If the lightest of
them is still too heavy, each requirement is relaxed until the wished mass is reached, alone and together with the others; the factor
is solved for, not extrapolated.")]
pub struct WhyArguments {
    /// Table of a front, as run/front.csv.
    #[arg(value_name = "TABLE")]
    table: PathBuf,
    /// Wished mass in kilograms, or value of the first objective.
    #[arg(long, value_name = "KG")]
    mass: f64,
    /// Wished workspace radius in metres; not for a study that prescribes the region.
    #[arg(long, value_name = "R")]
    radius: Option<f64>,
    /// Study file, or name of a built-in study [default: study.toml in the folder of the table, else paper].
    #[arg(long, value_name = "FILE")]
    study: Option<OsString>,
    /// Print the result as one JSON object.
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &WhyArguments) -> Result<Ending, Failure> {
    above_zero("--mass", Some(arguments.mass))?;
    above_zero("--radius", arguments.radius)?;
    let table = &arguments.table;
    let study = match &arguments.study {
        Some(study) => load_study(Some(study)),
        None => match run_of(table).map_err(Failure::Input)? {
            Some(run) => Ok(run.study().clone()),
            None => study_beside(table),
        },
    };
    let study = study.map_err(Failure::Input)?;
    let is_prescribed = study.workspace.region.is_prescribed();
    match arguments.radius {
        Some(_) if is_prescribed => {
            return Err(Failure::Input(miette!(
                "the study prescribes the region; omit --radius"
            )));
        }
        None if !is_prescribed => {
            return Err(Failure::Input(miette!(
                "a point of this study has a workspace radius; add --radius, in metres"
            )));
        }
        _ => {}
    }
    let designs = read_designs(table, &study).map_err(Failure::input)?;
    let designs: Vec<Design> = designs.into_iter().map(|(_, design)| design).collect();
    if designs.is_empty() {
        return Err(Failure::Input(miette!("{} has no designs", table.display())));
    }
    let problem = DesignProblem::new(&study).map_err(Failure::runtime)?;
    let drivers = problem
        .why(&designs, arguments.radius, arguments.mass)
        .map_err(Failure::input)?;
    let mut out = std::io::stdout().lock();
    if arguments.json {
        writeln!(out, "{}", to_json(&drivers).map_err(Failure::Runtime)?)?;
    } else {
        let heading = match arguments.radius {
            Some(radius) => format!("the best design for R_w = {radius} m"),
            None => "the best design for the region".to_owned(),
        };
        writeln!(out, "{}", tables::drivers(&heading, &drivers))?;
    }
    Ok(Ending::Done)
}
