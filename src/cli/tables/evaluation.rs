//! Tables of the evaluation of a design.

use comfy_table::Table;
use kinefront_model::evaluation::{Bound, Evaluation, Model, Quantity};
use kinefront_scene::text::{self, number};

use super::{percent, pose_text, table};

/// Formats the evaluation of a design.
pub fn evaluation(evaluation: &Evaluation, model: &Model) -> String {
    let design = &evaluation.design;
    let mut facts = table(["design", &design.to_string()], &[]);
    facts.add_row([
        "mass in motion".to_owned(),
        format!(
            "{:.3} kg (legs {:.3}, platform {:.3})",
            evaluation.mass(),
            // Motors that move have the mass of the selected drive.
            evaluation.mass() - model.platform_mass(design),
            model.platform_mass(design)
        ),
    ]);
    add_workspace(&mut facts, evaluation, model);
    for bar in text::selected_parts(model, evaluation) {
        facts.add_row(bar);
    }
    add_quantities(&mut facts, evaluation, model);
    add_limits(&mut facts, evaluation);
    if let Some(nearest) = &evaluation.nearest {
        let where_least = match (evaluation.home, model.settings().workspace.region.is_prescribed()) {
            (_, true) => "the smallest over the region",
            (Some(_), false) => "the smallest over the workspace",
            (None, false) => "at the centre in the best orientation",
        };
        facts.add_row([
            "clearance".to_owned(),
            format!("{}, {where_least}", text::clearance(nearest)),
        ]);
    }
    format!("{facts}\n{}", constraints(evaluation))
}

fn add_workspace(facts: &mut Table, evaluation: &Evaluation, model: &Model) {
    match (&evaluation.home, evaluation.home_phi_deg) {
        (Some(home), Some(phi_deg)) => {
            let region = &model.settings().workspace.region;
            facts.add_row(if region.is_prescribed() {
                ["region".to_owned(), format!("{}, all of it", text::region(region))]
            } else {
                let radius = evaluation.workspace_radius();
                ["regular workspace".to_owned(), format!("R_w = {radius:.5} m")]
            });
            let centre = home.position;
            facts.add_row([
                "home pose".to_owned(),
                format!("({}, {}) m, φ_c = {phi_deg}°", centre.x, centre.y),
            ]);
        }
        _ => {
            facts.add_row(["regular workspace", "none: the design is infeasible"]);
        }
    }
}

/// Adds the quantities that no other row or table tells.
fn add_quantities(facts: &mut Table, evaluation: &Evaluation, model: &Model) {
    let told_elsewhere = [
        Quantity::Mass,
        Quantity::LegsMass,
        Quantity::PlatformMass,
        Quantity::WorkspaceRadius,
    ];
    let is_fact = |quantity: &Quantity| quantity.constraint().is_none() && !told_elsewhere.contains(quantity);
    let tells = |quantity: &Quantity| match quantity {
        Quantity::Worst(scalar) => model.tells(&evaluation.design, *scalar),
        _ => true,
    };
    for quantity in Quantity::all().filter(is_fact).filter(tells) {
        let entry = quantity.entry();
        if let Some(value) = evaluation.quantities.get(quantity) {
            facts.add_row([entry.label.to_owned(), format!("{} {}", number(value), entry.unit)]);
        }
    }
}

fn add_limits(facts: &mut Table, evaluation: &Evaluation) {
    for result in &evaluation.limits {
        let entry = result.limit.quantity.entry();
        let sign = match result.limit.bound {
            Bound::AtLeast(_) => "≥",
            Bound::AtMost(_) => "≤",
        };
        let limit = format!("{sign} {} {}", number(result.limit.threshold()), entry.unit);
        let limit = limit.trim_end();
        facts.add_row([
            format!("limit of {}", entry.label),
            match result.value {
                Some(value) if result.margin >= 0.0 => format!("{} {limit}: kept", number(value)),
                Some(value) => format!("{} {limit}: missed ({})", number(value), percent(result.margin)),
                // The design has no value where it is examined.
                None => format!("{limit}: not evaluated"),
            },
        ]);
    }
}

fn constraints(evaluation: &Evaluation) -> Table {
    let mut constraints = table(
        [
            "",
            "constraint",
            "worst value",
            "threshold",
            "unit",
            "margin",
            "active",
            "where",
        ],
        &[2, 3, 5],
    );
    for report in evaluation.constraints.iter().filter(|report| report.required) {
        constraints.add_row([
            report.constraint.id().to_owned(),
            report.constraint.name().to_owned(),
            report.value.map(number).unwrap_or_else(|| "–".to_owned()),
            number(report.threshold),
            report.constraint.unit().to_owned(),
            percent(report.margin),
            if report.active { "yes" } else { "" }.to_owned(),
            report.pose.as_ref().map(pose_text).unwrap_or_default(),
        ]);
    }
    constraints
}
