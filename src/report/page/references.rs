//! The reference designs of the study, and the lighter designs found.

use maud::{Markup, html};

use super::{cell, optional, percent};
use crate::report::{EvaluatedReference, Report};
use crate::text::number;
use kinefront_model::evaluation::Evaluation;
use kinefront_model::mechanism::DESIGN_VARIABLES;

pub(super) fn references(report: &Report) -> Markup {
    let stated = |reference: &EvaluatedReference| {
        let design = &reference.fine.design;
        html! { tr {
            td { (reference.name) } td { (design.architecture) }
            @for value in design.values() { (cell(value)) }
            (optional(reference.stated_mass)) (cell(reference.fine.mass))
            @if report.of_paper { td.number { (number(reference.mass_range[0])) " … " (number(reference.mass_range[1])) } }
            (optional(reference.stated_radius)) (cell(reference.coarse.workspace_radius)) (cell(reference.fine.workspace_radius))
            td { (active(&reference.fine)) }
        } }
    };
    html! {
        div.scroll { table {
            caption { "Masses in kg, lengths in m. “Stated” values are from the source of the design; all others are from this model." }
            thead {
                tr {
                    th { "design" } th { "architecture" }
                    @for variable in DESIGN_VARIABLES { th.number { (variable.symbol()) } }
                    th.number { "mass, stated" } th.number { "mass" }
                    @if report.of_paper { th.number { "mass range for the rounded bar radii" } }
                    th.number { "R_w, stated" } th.number { "R_w, reference grid" } th.number { "R_w, fine grid" } th { "active constraints" }
                }
            }
            tbody { @for reference in &report.references { (stated(reference)) } }
        } }
        @if report.question.is_none() { (lighter(report)) }
    }
}

/// Lists the lightest design found for the workspace radius of each reference design.
fn lighter(report: &Report) -> Markup {
    html! {
        h3 { "Lighter designs found" }
        div.scroll { table {
            caption { "The lightest design found with at least the workspace radius of each reference design (fine grid)." }
            thead { tr {
                th { "reference design" } th.number { "mass" } th { "" } th { "architecture" }
                @for variable in DESIGN_VARIABLES { th.number { (variable.symbol()) } }
                th.number { "mass" } th.number { "R_w" } th.number { "ratio of the masses" }
            } }
            tbody { @for reference in &report.references { tr {
                td { (reference.name) } (cell(reference.fine.mass)) td { "→" }
                @match &reference.lighter {
                    Some(found) => {
                        td { (found.design.architecture) }
                        @for value in found.design.values() { (cell(value)) }
                        (cell(found.mass)) (cell(found.workspace_radius))
                        td.number { (percent(found.mass / reference.fine.mass)) }
                    }
                    None => { td colspan="9" { @if reference.fine.is_feasible() { "no lighter design found" } @else { "infeasible in this model" } } }
                }
            } } }
        } }
    }
}

/// Lists the ids of the constraints that limit the workspace of a design.
pub(super) fn active(evaluation: &Evaluation) -> String {
    let active: Vec<&str> = evaluation.active().map(|constraint| constraint.id()).collect();
    active.join(", ")
}
