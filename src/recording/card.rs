//! A design's numbers as a card to read, in markdown.

use kinefront_model::evaluation::{Evaluation, Model};
use kinefront_model::mechanism::VARIABLES;
use crate::scene::{EllipsoidSet, Tour};
use crate::text::short;

/// The card of a design; `heading` says which one it is.
pub(super) fn card(
    heading: &str,
    model: &Model,
    evaluation: &Evaluation,
    ellipsoids: &[EllipsoidSet],
    tour: Option<&Tour>,
) -> String {
    let design = &evaluation.design;
    let mut card = format!(
        "# {heading}\n\n**{}**, working mode {}\n\n",
        design.architecture, design.working_mode
    );
    card += &match evaluation.home_phi_deg {
        Some(phi) => format!(
            "**{:.2} kg** in motion (legs {:.2}, platform {:.2}), **R_w = {:.4} m** over {}° about φ_c = {phi}°\n\n",
            evaluation.mass,
            model.legs_mass(design),
            model.platform_mass(design),
            evaluation.workspace_radius,
            model.workspace.rotation_range_deg
        ),
        None => format!(
            "**{:.2} kg** in motion, **no regular workspace**: infeasible\n\n",
            evaluation.mass
        ),
    };
    card += "| R | r | L_b | r_j | r_p |\n|---|---|---|---|---|\n|";
    for (variable, value) in VARIABLES.into_iter().zip(design.values()) {
        card += &if variable.may_be_zero() {
            format!(" {:.2} mm |", 1e3 * value)
        } else {
            format!(" {value:.4} m |")
        };
    }
    card += "\n\n| | constraint | least value | threshold | margin | |\n|---|---|---|---|---|---|\n";
    for report in evaluation.constraints.iter().filter(|report| report.asked) {
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
    if let Some(nearest) = model.nearest(evaluation) {
        card += &format!("- clearance of the bodies: {}\n", text::clearance(&nearest));
    }
    for set in ellipsoids {
        card += &format!("- {}\n", set.scale_text());
    }
    if let Some(tour) = tour {
        card += &format!(
            "- tour of {} poses at radius {:.4} m; forward kinematics gives each of them back to {:.0e} m\n",
            tour.poses.len(),
            tour.radius,
            tour.forward_error
        );
    }
    card + "\nwhite: regular workspace · magenta: threshold of the field · red: parallel singularity · orange edge: legs \
            stretched out (serial singularity) · grey edge: joint limit · red dots: where active constraints are smallest\n"
}
