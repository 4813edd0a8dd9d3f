//! The reference designs of the study, and the better designs found.

use maud::{Markup, html};

use super::{cell, optional, percent};
use crate::{EvaluatedReference, Report};
use kinefront_model::evaluation::{Evaluation, Quantity};
use kinefront_model::mechanism::DESIGN_VARIABLES;
use kinefront_study::Column;

/// Lists the reference designs: what their source states, and what this model computes.
pub(super) fn references(report: &Report) -> Markup {
    let quantities: Vec<Quantity> = report
        .question
        .objectives
        .iter()
        .map(|objective| objective.quantity)
        .collect();
    let is_stated = |quantity: &Quantity| {
        report
            .references
            .iter()
            .any(|reference| reference.stated(*quantity).is_some())
    };
    let row = |reference: &EvaluatedReference| {
        let design = &reference.fine.design;
        html! { tr {
            td { (reference.stated.name) } td { (design.architecture()) }
            @for value in design.values() { (cell(value)) }
            @for quantity in &quantities {
                @if is_stated(quantity) { (optional(reference.stated(*quantity))) }
                (optional(reference.coarse.quantities.get(*quantity))) (optional(reference.fine.quantities.get(*quantity)))
            }
            td { (active(&reference.fine)) }
        } }
    };
    html! {
        div.scroll { table {
            caption { "Lengths in m. “Stated” values are from the source of the design; all others are from this model." }
            thead {
                tr {
                    th { "design" } th { "architecture" }
                    @for variable in DESIGN_VARIABLES { th.number { (variable.symbol()) } }
                    @for quantity in &quantities {
                        @let title = Column::Quantity(*quantity).title();
                        @if is_stated(quantity) { th.number { (title) ", stated" } }
                        th.number { (title) ", reference grid" } th.number { (title) ", fine grid" }
                    }
                    th { "active constraints" }
                }
            }
            tbody { @for reference in &report.references { (row(reference)) } }
        } }
        (better(report))
    }
}

/// Lists the design found that is better than each reference design.
fn better(report: &Report) -> Markup {
    let question = &report.question;
    let count = question.objectives.len();
    html! {
        h3 { "Better designs found" }
        div.scroll { table {
            caption {
                "For each reference design, the design found with the best " (question.name(0))
                @if count > 1 { " of those that are at least as good in the other objectives" }
                " (fine grid). Lengths in m."
            }
            thead { tr {
                th { "reference design" } th.number { (question.label(0)) } th { "" } th { "architecture" }
                @for variable in DESIGN_VARIABLES { th.number { (variable.symbol()) } }
                @for k in 0..count { th.number { (question.label(k)) } }
                th.number { "ratio of the " (question.name(0)) }
            } }
            tbody { @for reference in &report.references { tr {
                @let of_reference = question.value(0, &reference.fine);
                td { (reference.stated.name) } (cell(of_reference)) td { "→" }
                @match &reference.better {
                    Some(found) => {
                        td { (found.design.architecture()) }
                        @for value in found.design.values() { (cell(value)) }
                        @for k in 0..count { (cell(question.value(k, found))) }
                        td.number { (percent(question.value(0, found) / of_reference)) }
                    }
                    None => { td colspan=(7 + count) { @if reference.fine.is_feasible() { "no better design found" } @else { "infeasible in this model" } } }
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
