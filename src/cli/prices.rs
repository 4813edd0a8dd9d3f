//! The command `kinefront prices`: what each requirement of a study costs at a design, or along a front.

use std::io::Write;
use std::path::PathBuf;

use kinefront_model::evaluation::{Evaluation, Quantity};
use kinefront_model::mechanism::Design;
use kinefront_recording::record_prices;
use kinefront_study::{
    AlongJson, Column, DesignProblem, Drivers, DriversAlong, DriversOptions, PriceJson, Row, Study, TableRow,
};
use miette::miette;

use super::subject::{A_DESIGN, SubjectArguments, exactly_one_of};
use super::{Ending, Failure, exists_already, print, tables, to_json};

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Kinefront first optimizes the design locally, with every pose of the region as a constraint and a continuous home orientation. A price
is the change of the first objective in per cent for +1 % of a requirement; the other objectives, such as the workspace radius, keep the
values of the design. A requirement that is not active is listed with the amount by which it can increase at no cost.

Without #ID, the command computes the prices of all designs of the table and prints, in sentences, what drives the first objective along the front; with
--csv, it prints the table of the designs with a column price_* for each parameter, and with --record it also writes a recording of the designs with
their prices along the front.")]
#[command(group = exactly_one_of(A_DESIGN))]
pub struct PricesArguments {
    #[command(flatten)]
    subject: SubjectArguments,
    /// Workspace radius to keep, in metres [default: that of the design on the fine grid].
    #[arg(long, value_name = "R")]
    radius: Option<f64>,
    /// Keep the geometry and the home orientation, and change only the bars.
    #[arg(long)]
    bars_only: bool,
    /// Optimize the design again after steps of 3, 10 and 20 % of each parameter.
    #[arg(long)]
    steps: bool,
    /// Show by how much each requirement would have to be relaxed for this mass in kilograms, or this value of the first objective.
    #[arg(long, value_name = "KG")]
    wish_mass: Option<f64>,
    /// Print the designs of a front with their prices as CSV.
    #[arg(long, conflicts_with = "json")]
    csv: bool,
    /// Print the result as one JSON object.
    #[arg(long)]
    json: bool,
    /// Also write a recording of a front with its prices; the file must not exist.
    #[arg(long, value_name = "FILE.rrd")]
    record: Option<PathBuf>,
}

pub fn run(arguments: &PricesArguments) -> Result<Ending, Failure> {
    for (key, value) in [("--radius", arguments.radius), ("--wish-mass", arguments.wish_mass)] {
        above_zero(key, value)?;
    }
    if !arguments.subject.is_design() {
        return along_front(arguments);
    }
    for (is_given, words) in [
        (arguments.csv, "--csv prints the designs of a front"),
        (arguments.record.is_some(), "--record writes a recording of a front"),
    ] {
        if is_given {
            return Err(Failure::Input(miette!("{words}; name the table without #ID")));
        }
    }
    let (study, design, heading) = arguments.subject.read().map_err(Failure::Input)?;
    let problem = DesignProblem::new(&study).map_err(Failure::runtime)?;
    let held: Vec<(Quantity, f64)> = arguments
        .radius
        .map(|radius| (Quantity::WorkspaceRadius, radius))
        .into_iter()
        .collect();
    let local = problem.local(&design, &held).map_err(Failure::input)?;
    let options = DriversOptions {
        bars_only: arguments.bars_only,
        steps: arguments.steps,
        alternatives: !arguments.bars_only,
        wish: arguments.wish_mass,
    };
    let drivers = local.drivers(options).map_err(Failure::input)?;
    print(arguments.json.then_some(&drivers), || {
        tables::drivers(&heading, &drivers)
    })
}

/// Determines the prices of all designs of a table.
fn along_front(arguments: &PricesArguments) -> Result<Ending, Failure> {
    let is_asked = arguments.bars_only || arguments.steps;
    if is_asked || arguments.radius.is_some() || arguments.wish_mass.is_some() {
        let words = "--radius, --bars-only, --steps and --wish-mass require a single design; specify it as TABLE#ID";
        return Err(Failure::Input(miette!("{words}")));
    }
    if let Some(path) = arguments.record.as_deref().filter(|path| path.exists()) {
        return Err(exists_already(path));
    }
    let (study, designs) = arguments.subject.read_table().map_err(Failure::Input)?;
    let problem = DesignProblem::new(&study).map_err(Failure::runtime)?;
    let (ids, designs): (Vec<usize>, Vec<Design>) = designs.into_iter().unzip();
    let evaluations = problem.evaluate_on_fine_grid(&designs);
    let along = problem.drivers_along(&evaluations);
    if let Some(path) = &arguments.record {
        record_prices(path, &study.name, problem.model(), &evaluations, &ids, &along).map_err(Failure::runtime)?;
        let _ = writeln!(std::io::stderr(), "wrote {}", path.display());
    }
    let mut out = std::io::stdout().lock();
    if arguments.json {
        let all: Vec<AlongJson<'_>> = along.iter().map(|along| along.to_json(&ids)).collect();
        writeln!(out, "{}", to_json(&all).map_err(Failure::Runtime)?)?;
    } else if arguments.csv {
        write_table(&study, &along, &ids, &evaluations, out)?;
    } else {
        for along in &along {
            writeln!(out, "{}", tables::drivers_along(along))?;
        }
    }
    Ok(Ending::Done)
}

/// Writes the designs in the order of the table, each with the price of each parameter; a parameter that has none is an empty cell.
fn write_table(
    study: &Study,
    along: &[DriversAlong],
    ids: &[usize],
    evaluations: &[Evaluation],
    out: impl Write,
) -> Result<(), Failure> {
    let mut parameters: Vec<&str> = Vec::new();
    let mut drivers: Vec<Option<&Drivers>> = vec![None; evaluations.len()];
    for (index, _, of_design) in along.iter().flat_map(|along| &along.designs) {
        drivers[*index] = Some(of_design);
        for price in &of_design.prices {
            if !parameters.contains(&price.parameter.as_str()) {
                parameters.push(&price.parameter);
            }
        }
    }
    let columns: Vec<Column> = Column::of_designs(study).collect();
    let names = columns.iter().map(|column| column.name());
    let names = names.chain(parameters.iter().map(|parameter| format!("price_{parameter}").into()));
    let mut table = csv::Writer::from_writer(out);
    let failed = |error: csv::Error| Failure::from(std::io::Error::from(error));
    table.write_record(names.map(|name| name.to_string())).map_err(failed)?;
    for (place, evaluation) in evaluations.iter().enumerate() {
        let row = TableRow::new(ids[place], Row::new(0, evaluation));
        let price = |parameter: &&str| {
            let mut prices = drivers[place].into_iter().flat_map(|drivers| &drivers.prices);
            let own = prices.find(|price| price.parameter == **parameter);
            own.map_or(String::new(), |own: &PriceJson| own.price.to_string())
        };
        let cells = columns.iter().map(|column| column.cell(&row).to_string());
        table
            .write_record(cells.chain(parameters.iter().map(price)))
            .map_err(failed)?;
    }
    Ok(table.flush()?)
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
