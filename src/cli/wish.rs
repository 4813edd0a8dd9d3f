//! The command `kinefront wish`: the nearest design that has what a person wishes.

use kinefront_study::{Condition, DesignProblem, Wish};

use super::subject::{A_DESIGN, SubjectArguments, exactly_one_of};
use super::{Ending, Failure, print, tables};

#[derive(Debug, clap::Args)]
#[command(after_help = "\
The objectives keep the values of the given design unless a condition names them; the first objective is then improved as much as
the conditions allow. The resulting design is verified on the fine grid and proved.")]
#[command(group = exactly_one_of(A_DESIGN))]
pub struct WishArguments {
    #[command(flatten)]
    subject: SubjectArguments,
    /// Condition that a quantity be at least or at most a number, as in "k_xy_n_per_m >= 1.2e6"; may be repeated.
    #[arg(long, value_name = "CONDITION", required = true)]
    set: Vec<String>,
    /// Quantity that must not become worse, such as footprint_m; may be repeated.
    #[arg(long, value_name = "QUANTITY")]
    keep: Vec<String>,
    /// Print the result as one JSON object.
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &WishArguments) -> Result<Ending, Failure> {
    let (study, design, heading) = arguments.subject.read().map_err(Failure::Input)?;
    let wish = read(arguments)?;
    let problem = DesignProblem::new(&study).map_err(Failure::runtime)?;
    let outcome = problem.grant(&design, &wish).map_err(Failure::input)?;
    let shown = wish.shown(&study);
    let json = arguments.json.then(|| outcome.to_json(&shown));
    print(json, || tables::wish(&heading, &outcome, &shown))
}

fn read(arguments: &WishArguments) -> Result<Wish, Failure> {
    let conditions = arguments
        .set
        .iter()
        .map(|text| text.parse::<Condition>().map_err(Failure::input));
    let keep = arguments
        .keep
        .iter()
        .map(|key| Wish::quantity(key).map_err(Failure::input));
    Ok(Wish {
        conditions: conditions.collect::<Result<_, _>>()?,
        keep: keep.collect::<Result<_, _>>()?,
    })
}
