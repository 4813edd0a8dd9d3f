//! The command `kinefront why`: why a point beyond the front cannot be had, or why no design is feasible.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use kinefront_model::evaluation::Quantity;
use kinefront_model::mechanism::Design;
use kinefront_scene::text::quantity as quantity_text;
use kinefront_study::{DesignProblem, Hindrance, Study, read_table};
use miette::{Result, miette};

use super::prices::above_zero;
use super::subject::{designs_of, study_of, without_designs};
use super::{Ending, Failure, print, tables};

#[derive(Debug, clap::Args)]
#[command(after_help = "\
For each architecture, Kinefront locally optimizes the front designs whose other objectives are nearest, for the desired values of these objectives.
If the lightest of them is still too heavy, each requirement is relaxed until the desired mass is reached, separately and together with the
others; the factor is solved for, not extrapolated.

Without --mass, the table must be that of a run that found no feasible design, such as run/designs.csv: each requirement is listed with its nearest
achievable value while all others are kept.")]
pub struct WhyArguments {
    /// Table of a front, such as run/front.csv; without --mass, of any designs, such as run/designs.csv.
    #[arg(value_name = "TABLE")]
    table: PathBuf,
    /// Desired mass in kilograms, or desired value of the first objective.
    #[arg(long, value_name = "KG")]
    mass: Option<f64>,
    /// Desired workspace radius in metres; not allowed if the study prescribes the region.
    #[arg(long, value_name = "R")]
    radius: Option<f64>,
    /// Desired value of another objective, as in k_xy_n_per_m=1.2e6; may be repeated [default: that of the nearest design].
    #[arg(long, value_name = "QUANTITY=VALUE")]
    at: Vec<String>,
    /// Study file, or name of a built-in study [default: study.toml in the folder of the table, else paper].
    #[arg(long, value_name = "FILE")]
    study: Option<OsString>,
    /// Print the result as one JSON object.
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &WhyArguments) -> std::result::Result<Ending, Failure> {
    above_zero("--mass", arguments.mass)?;
    above_zero("--radius", arguments.radius)?;
    let table = &arguments.table;
    let study = study_of(table, arguments.study.as_deref()).map_err(Failure::Input)?;
    let Some(mass) = arguments.mass else {
        return tell_hindrances(arguments, &study);
    };
    let held = held(arguments, &study).map_err(Failure::Input)?;
    let designs = designs_of(table, &study).map_err(Failure::Input)?;
    let designs: Vec<Design> = designs.into_iter().map(|(_, design)| design).collect();
    let problem = DesignProblem::new(&study).map_err(Failure::runtime)?;
    let drivers = problem.why(&designs, &held, mass).map_err(Failure::input)?;
    let heading = match held.as_slice() {
        [] => "the best design for the region".to_owned(),
        held => {
            let values = held.iter().map(|(quantity, value)| quantity_text(*quantity, *value));
            format!("the best design for {}", values.collect::<Vec<_>>().join(", "))
        }
    };
    print(arguments.json.then_some(&drivers), || {
        tables::drivers(&heading, &drivers)
    })
}

/// Tells what stands in the way of a study of which no design is feasible.
fn tell_hindrances(arguments: &WhyArguments, study: &Study) -> std::result::Result<Ending, Failure> {
    if arguments.radius.is_some() || !arguments.at.is_empty() {
        let words = "--radius and --at specify a point beyond the front; add --mass";
        return Err(Failure::Input(miette!("{words}")));
    }
    let found = hindrances(&arguments.table, study)?;
    print(arguments.json.then_some(&found), || tables::hindrances(&found))
}

/// Returns what stands in the way of the designs of a table.
pub fn hindrances(table: &Path, study: &Study) -> std::result::Result<Vec<Hindrance>, Failure> {
    let rows = read_table(table, study).map_err(Failure::input)?.rows;
    let designs: Vec<(f64, Design)> = rows
        .iter()
        .map(|entry| (entry.row.violation, entry.row.design))
        .collect();
    if designs.is_empty() {
        return Err(Failure::Input(without_designs(table)));
    }
    if let Some(feasible) = rows.iter().find(|entry| entry.row.is_feasible()) {
        let (id, table) = (feasible.id, table.display());
        let words =
            format!("design #{id} of {table} is feasible, so no requirement prevents a feasible design; add --mass");
        return Err(Failure::Input(miette!("{words}")));
    }
    let problem = DesignProblem::new(study).map_err(Failure::runtime)?;
    Ok(problem.hindrances(&designs))
}

/// Returns the wished values of the objectives after the first one.
fn held(arguments: &WhyArguments, study: &Study) -> Result<Vec<(Quantity, f64)>> {
    let others: Vec<Quantity> = study
        .objectives()
        .iter()
        .skip(1)
        .map(|objective| objective.quantity)
        .collect();
    let has_radius = others.contains(&Quantity::WorkspaceRadius);
    let mut held: Vec<(Quantity, f64)> = Vec::new();
    match arguments.radius {
        Some(radius) if has_radius => held.push((Quantity::WorkspaceRadius, radius)),
        Some(_) => {
            return Err(miette!(
                "the workspace radius is not an objective of the study; omit --radius"
            ));
        }
        None => {}
    }
    for text in &arguments.at {
        let (quantity, value) = read_point(text, &others)?;
        if held.iter().any(|(other, _)| *other == quantity) {
            return Err(miette!("{} is stated twice; state it once", quantity.entry().key));
        }
        held.push((quantity, value));
    }
    if has_radius && !held.iter().any(|(quantity, _)| *quantity == Quantity::WorkspaceRadius) {
        return Err(miette!(
            "a point in the objectives of this study includes a workspace radius; add --radius, in metres"
        ));
    }
    Ok(held)
}

/// Reads the value of an objective, as in `k_xy_n_per_m=1.2e6`.
fn read_point(text: &str, others: &[Quantity]) -> Result<(Quantity, f64)> {
    let stated = text.split_once('=').and_then(|(key, value)| {
        let value = value.trim().parse::<f64>().ok()?;
        let quantity = others.iter().find(|other| other.entry().key == key.trim())?;
        Some((*quantity, value)).filter(|_| value.is_finite() && value > 0.0)
    });
    stated.ok_or_else(|| {
        let keys: Vec<&str> = others.iter().map(|other| other.entry().key).collect();
        let known = match keys.as_slice() {
            [] => "the study has only one objective, so --at does not apply".to_owned(),
            keys => format!("the objectives after the first one are {}", keys.join(", ")),
        };
        miette!("--at `{text}` is not QUANTITY=VALUE with an objective of the study and a number above 0; {known}")
    })
}
