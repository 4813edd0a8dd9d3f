//! The numbers of a design as a card, in markdown.

use kinefront_model::evaluation::{Evaluation, Model};
use kinefront_model::mechanism::{DESIGN_VARIABLES, Design, DesignVariable};
use kinefront_scene::text::{self, short};
use kinefront_scene::{EllipsoidSet, Tour};
use kinefront_study::{CertifiedWorkspace, Drivers};

/// Prices below this \[% for 1 %\] are left out.
const FREE: f64 = 0.01;

/// Largest number of prices on a card.
const PRICES: usize = 10;

/// Returns the card of a design; `heading` names the design.
pub(super) fn card(
    heading: &str,
    model: &Model,
    evaluation: &Evaluation,
    ellipsoids: &[EllipsoidSet],
    tour: Option<&Tour>,
    certified: Option<&CertifiedWorkspace>,
    drivers: Option<&Drivers>,
) -> String {
    let design = &evaluation.design;
    let mut card = format!(
        "# {heading}\n\n**{}**, working mode {}\n\n",
        design.architecture(),
        design.working_mode()
    );
    card += &match evaluation.home_phi_deg {
        Some(phi) => format!(
            "**{:.2} kg** in motion (legs {:.2}, platform {:.2}), **R_w = {:.4} m** over {}° about φ_c = {phi}°\n\n",
            evaluation.mass(),
            model.legs_mass(design),
            model.platform_mass(design),
            evaluation.workspace_radius(),
            model.settings().workspace.rotation_range_deg
        ),
        None => format!(
            "**{:.2} kg** in motion, **no regular workspace**: infeasible\n\n",
            evaluation.mass()
        ),
    };
    if let Some(certified) = certified {
        card += &format!("{}\n\n", certified);
    }
    card += &dimensions(design);
    card += &constraints(evaluation);
    if let Some(nearest) = &evaluation.nearest {
        card += &format!("- smallest clearance between members: {}\n", text::clearance(nearest));
    }
    for set in ellipsoids {
        card += &format!("- {}\n", set.scale_text());
    }
    if let Some(tour) = tour {
        card += &format!(
            "- tour of {} poses at radius {:.4} m; forward kinematics reproduces each pose within {:.0e} m\n",
            tour.poses.len(),
            tour.radius,
            tour.forward_error
        );
    }
    if let Some(drivers) = drivers {
        card += &prices(drivers);
    }
    if certified.is_some() {
        card += "\nboxes of the proof, filled by the number of divisions, outlined by the constraint that was proved last: g2 cyan · \
                 g3 blue · g4 red · g5 yellow · g6 green · g7 orange · beyond an infeasible pose: bright red\n";
    }
    card + "\nwhite: regular workspace · magenta: threshold of the field · red: parallel singularity · orange edge: \
            end of a leg's reach (serial singularity) · grey edge: joint limit · red dots: poses at which the active \
            constraints have their smallest values\n"
}

/// Tabulates the dimensions of a design.
fn dimensions(design: &Design) -> String {
    let variables: Vec<DesignVariable> = DESIGN_VARIABLES.into_iter().chain(design.given_variables()).collect();
    let mut card = "|".to_owned();
    card.extend(variables.iter().map(|variable| format!(" {} |", variable.symbol())));
    card += "\n|";
    card += &"---|".repeat(variables.len());
    card += "\n|";
    for variable in variables {
        card += &format!(" {} |", text::variable_value(variable, design.value(variable)));
    }
    card
}

/// Tabulates the constraints of a design.
fn constraints(evaluation: &Evaluation) -> String {
    let mut card =
        "\n\n| | constraint | smallest value | threshold | margin | |\n|---|---|---|---|---|---|\n".to_owned();
    for report in evaluation.constraints.iter().filter(|report| report.required) {
        card += &format!(
            "| {} | {} | {} {} | {} | {:+.1} % | {} |\n",
            report.constraint.id(),
            report.constraint.name().replace('_', " "),
            report.value.map_or_else(|| "–".to_owned(), short),
            report.constraint.unit(),
            short(report.threshold),
            100.0 * report.margin,
            if report.active { "**active**" } else { "" },
        );
    }
    card.push('\n');
    card
}

/// Tabulates what drives the first objective of a design.
fn prices(drivers: &Drivers) -> String {
    let (objective, unit) = drivers.objective_name();
    let dear = drivers.dear(FREE);
    if dear.is_empty() {
        return String::new();
    }
    let mut text = format!("\n| 1 % more of | changes the {objective} by | |\n|---|---|---|\n");
    for price in dear.iter().take(PRICES) {
        text += &format!(
            "| {} | {:+.2} % | {:+.3} {unit} |\n",
            price.label,
            price.price,
            0.01 * price.price * drivers.polished_value
        );
    }
    text
}
