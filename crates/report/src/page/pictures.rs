//! Pictures of designs with their numbers.

use maud::{Markup, html};

use super::image;
use super::references::active;
use crate::Report;
use kinefront_model::evaluation::Evaluation;
use kinefront_model::mechanism::DESIGN_VARIABLES;
use kinefront_scene::text::number;

/// Shows the pictures.
pub(super) fn pictures(report: &Report) -> Markup {
    html! {
        p {
            "The pictures show the best design in each objective and the knee of each front"
            @if !report.references.is_empty() { ", and then the reference designs," }
            " at the home pose, with true bar radii and the regular workspace in green. The solids are those of the recordings and exports."
        }
        div.figures.pictures { @for picture in &report.pictures {
            figure id={ "picture-" (picture.name) } {
                (image(picture))
                figcaption { strong { (picture.caption) } (numbers(&picture.evaluation)) }
            }
        } }
    }
}

/// Lists the variables, objectives, home orientation and active constraints of a design.
fn numbers(evaluation: &Evaluation) -> Markup {
    html! { div.numbers {
        @for variable in DESIGN_VARIABLES.into_iter().chain(evaluation.design.given_variables()) {
            span {
                (variable.symbol()) " " b { (number(evaluation.design.value(variable))) }
                @if variable.is_angle() { "°" } @else { " m" }
            }
        }
        span { "mass " b { (number(evaluation.mass())) } " kg" }
        span { "R_w " b { (number(evaluation.workspace_radius())) } " m" }
        @if let Some(phi) = evaluation.home_phi_deg { span { "φ_c " b { (number(phi)) } "°" } }
        span { "active constraints " b { (active(evaluation)) } }
    } }
}
