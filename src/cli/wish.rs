//! The command `kinefront wish`: the nearest design that has what a person wishes.

use std::io::Write;

use kinefront_model::evaluation::Quantity;
use kinefront_study::{CertifiedWorkspace, Condition, DesignProblem, Wish, WishOutcome};
use miette::miette;
use serde::Serialize;

use super::subject::SubjectArguments;
use super::{Ending, Failure, tables, to_json};

#[derive(Debug, clap::Args)]
#[command(after_help = "\
The objectives of the study keep the values that the design has, unless the wish names them; the first objective is improved as far as
the wish allows. The design that is found is verified on the fine grid and proved.")]
pub struct WishArguments {
    #[command(flatten)]
    subject: SubjectArguments,
    /// A quantity that is to be at least or at most a number, as in "k_xy_n_per_m >= 1.2e6"; may be repeated.
    #[arg(long, value_name = "CONDITION", required = true)]
    set: Vec<String>,
    /// A quantity that is not to become worse, as in footprint_m; may be repeated.
    #[arg(long, value_name = "QUANTITY")]
    keep: Vec<String>,
    /// Print the result as one JSON object.
    #[arg(long)]
    json: bool,
}

/// The output of `kinefront wish --json`.
#[derive(Debug, Serialize)]
struct WishJson {
    design: String,
    home_phi_deg: Option<f64>,
    /// `had`, `granted` or `not granted`.
    outcome: &'static str,
    /// Conditions that are not met, each with the value that can be had instead.
    unmet: Vec<UnmetJson>,
    before: serde_json::Map<String, serde_json::Value>,
    after: serde_json::Map<String, serde_json::Value>,
    /// What is proved about the workspace: `proved`, `open`, or absent.
    proof: Option<String>,
    warnings: Vec<String>,
}

#[derive(Debug, Serialize)]
struct UnmetJson {
    condition: String,
    value: f64,
}

pub fn run(arguments: &WishArguments) -> Result<Ending, Failure> {
    let (study, design, heading) = arguments.subject.read().map_err(Failure::Input)?;
    let wish = read(arguments)?;
    let problem = DesignProblem::new(&study).map_err(Failure::runtime)?;
    let outcome = problem.grant(&design, &wish).map_err(Failure::input)?;
    let mut shown = study.shown_quantities();
    let named = wish
        .conditions
        .iter()
        .map(|condition| condition.0.quantity)
        .chain(wish.keep.iter().copied());
    for quantity in named {
        if !shown.contains(&quantity) {
            shown.push(quantity);
        }
    }
    let mut out = std::io::stdout().lock();
    if arguments.json {
        writeln!(out, "{}", to_json(&json(&outcome, &shown)).map_err(Failure::Runtime)?)?;
    } else {
        writeln!(out, "{}", tables::wish(&heading, &outcome, &shown))?;
    }
    Ok(Ending::Done)
}

fn read(arguments: &WishArguments) -> Result<Wish, Failure> {
    let conditions = arguments
        .set
        .iter()
        .map(|text| text.parse::<Condition>().map_err(Failure::input));
    let keep = arguments.keep.iter().map(|key| {
        Quantity::find(key).ok_or_else(|| {
            Failure::Input(miette!(
                "`{key}` is no quantity; quantities are the keys of `objectives` and `constraints`, as footprint_m"
            ))
        })
    });
    Ok(Wish {
        conditions: conditions.collect::<Result<_, _>>()?,
        keep: keep.collect::<Result<_, _>>()?,
    })
}

fn json(outcome: &WishOutcome, shown: &[Quantity]) -> WishJson {
    let found = &outcome.found.evaluation;
    let values = |evaluation: &kinefront_model::evaluation::Evaluation| {
        let value = |quantity: &Quantity| {
            Some((
                quantity.entry().key.to_owned(),
                evaluation.quantities.get(*quantity)?.into(),
            ))
        };
        shown.iter().filter_map(value).collect()
    };
    WishJson {
        design: found.design.to_string(),
        home_phi_deg: found.home_phi_deg,
        outcome: word(outcome),
        unmet: outcome
            .unmet
            .iter()
            .map(|(condition, value)| UnmetJson {
                condition: condition.to_string(),
                value: *value,
            })
            .collect(),
        before: values(&outcome.before),
        after: values(found),
        proof: outcome.found.certified.as_ref().map(proof),
        warnings: outcome
            .left_out
            .iter()
            .map(|quantity| format!("the limit of {} was compared at the end alone", quantity.entry().key))
            .collect(),
    }
}

/// Returns what became of a wish, in a word.
pub fn word(outcome: &WishOutcome) -> &'static str {
    match (outcome.was_true, outcome.unmet.is_empty()) {
        (true, _) => "had",
        (false, true) => "granted",
        (false, false) => "not granted",
    }
}

/// Returns the verdict on a workspace, in a word.
pub fn proof(certified: &CertifiedWorkspace) -> String {
    match certified.is_proved {
        true => CertifiedWorkspace::PROVED.to_owned(),
        false => CertifiedWorkspace::OPEN.to_owned(),
    }
}
