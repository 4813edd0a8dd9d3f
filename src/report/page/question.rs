//! The sections of a report on another question than the paper's: the question, what was found, and the variables along the front.

use maud::{Markup, html};

use super::references::active;
use super::{cell, figures, optional};
use crate::report::Report;
use crate::report::question::{Question, sought};
use crate::study::{Column, DesignProblem};
use crate::text::short;
use kinefront_model::evaluation::{Bound, Constraint, Evaluation, LimitResult, Quantity};
use kinefront_model::mechanism::DESIGN_VARIABLES;
use kinefront_model::workspace::Region;
use kinefront_optimize::{Objectives, spread};

/// Largest number of designs that are listed.
const LISTED: usize = 12;

/// Relative margin below which a limit counts as one that binds a design.
const JUST_KEPT: f64 = 1e-3;

/// States what the study asks.
pub(super) fn asked(report: &Report, question: &Question) -> Markup {
    let study = &report.study;
    html! {
        div.scroll { table {
            caption { "Objectives." }
            thead { tr { th { "quantity" } th { "sought" } th { "meaning" } } }
            tbody { @for (k, objective) in question.objectives.iter().enumerate() { tr {
                td { (question.label(k)) } td { (sought(objective)) } td { (objective.quantity.entry().meaning) }
            } } }
        } }
        @if study.limits().next().is_some() {
            div.scroll { table {
                caption { "Limits that the study states besides the thresholds of its requirements." }
                thead { tr { th { "quantity" } th { "limit" } th { "meaning" } } }
                tbody { @for limit in study.limits() {
                    @let entry = limit.quantity.entry();
                    tr {
                        td { (entry.label) }
                        td { @match limit.bound {
                            Bound::AtLeast(value) => { "at least " (short(value)) " " (entry.unit) }
                            Bound::AtMost(value) => { "at most " (short(value)) " " (entry.unit) }
                        } }
                        td { (entry.meaning) }
                    }
                } }
            } }
        }
        p { (region(report)) }
    }
}

/// States the region over which every pose must be feasible.
fn region(report: &Report) -> String {
    let spec = &report.model.workspace;
    let range = short(spec.rotation_range_deg);
    let of_region = match &spec.region {
        Region::Largest => "the largest disc that each design allows".to_owned(),
        Region::Disc(radius) => format!("a disc with a radius of {} m", short(*radius)),
        Region::Polygon(polygon) => {
            let corners: Vec<String> = polygon
                .corners()
                .iter()
                .map(|corner| format!("({}, {})", short(corner.x), short(corner.y)))
                .collect();
            format!("the polygon with the corners {} m", corners.join(", "))
        }
    };
    format!(
        "Region of positions: {of_region}, about ({}, {}) m; orientations: a range of {range}° about the home orientation.",
        short(spec.centre.x),
        short(spec.centre.y)
    )
}

/// What was found: the architectures side by side, the fronts or the progress, and designs.
pub(super) fn found(report: &Report, question: &Question) -> Markup {
    let objectives = 0..question.objectives.len();
    let is_single = question.objectives.len() == 1;
    html! {
        p {
            "All designs are feasible on the fine grid (" (report.study.grid.fine.phi_step_deg) "° in φ, "
            (report.study.grid.fine.directions) " directions)"
            @if !is_single { " and non-dominated" }
            @if report.sources.len() > 1 { ", and pooled from all runs" }
            ". They are listed in " code { "fronts.csv" } "."
        }
        div.scroll { table {
            caption { "The best value of each objective that was found for each architecture" @if !is_single { ", and the hypervolume of its front" } "." }
            thead { tr {
                th { "architecture" }
                @if !is_single { th.number { "designs" } }
                @for k in objectives.clone() { th.number { (question.label(k)) } }
                @if !is_single { th.number { "hypervolume" } }
            } }
            tbody { @for (architecture, front) in &report.fronts.alone { tr {
                td { (architecture) }
                @if !is_single { td.number { (front.members.len()) } }
                @for k in objectives.clone() { (optional(question.best(k, front).map(|best| question.value(k, best)))) }
                @if !is_single { (cell(question.hypervolume(front))) }
            } } }
        } }
        (figures(report, "front"))
        (designs(report, question))
    }
}

/// Lists evenly spread designs of the front of all architectures; with one objective, the best design of each architecture.
fn designs(report: &Report, question: &Question) -> Markup {
    let listed: Vec<&Evaluation> = if question.objectives.len() == 1 {
        report
            .fronts
            .alone
            .iter()
            .filter_map(|(_, front)| question.best(0, front))
            .collect()
    } else {
        let shown: Vec<&Evaluation> = report.fronts.together.shown().collect();
        let objectives: Vec<Objectives> = shown
            .iter()
            .map(|member| DesignProblem::outcome(member).objectives)
            .collect();
        spread(&objectives, LISTED)
            .into_iter()
            .map(|place| shown[place])
            .collect()
    };
    let is_objective = |quantity: &Quantity| question.objectives.iter().any(|other| other.quantity == *quantity);
    let mut others: Vec<Quantity> = report
        .study
        .named_quantities()
        .iter()
        .filter(|quantity| !is_objective(quantity))
        .collect();
    others.dedup();
    html! {
        div.scroll { table {
            caption {
                @if question.objectives.len() == 1 { "The best design of each architecture." }
                @else { "Designs of the front of all architectures together, evenly spread." }
                " Lengths in m."
            }
            thead { tr {
                th { "architecture" }
                @for variable in DESIGN_VARIABLES { th.number { (variable.symbol()) } }
                @for k in 0..question.objectives.len() { th.number { (question.label(k)) } }
                @for quantity in &others { th.number { (Column::of_quantity(*quantity).title()) } }
                th { "active constraints and limits" }
            } }
            tbody { @for member in listed { tr {
                td { (member.design.architecture) }
                @for value in member.design.values() { (cell(value)) }
                @for k in 0..question.objectives.len() { (cell(question.value(k, member))) }
                @for quantity in &others { (optional(member.quantities.get(*quantity))) }
                td { (binding(member)) }
            } } }
        } }
    }
}

/// Lists the active constraints of a design and the limits that the study states and that it just keeps.
fn binding(evaluation: &Evaluation) -> String {
    let kept = |limit: &&LimitResult| (0.0..JUST_KEPT).contains(&limit.margin);
    let limits = evaluation
        .limits
        .iter()
        .filter(kept)
        .map(|limit| limit.limit.quantity.entry().label.to_owned());
    let constraints = Some(active(evaluation)).filter(|constraints| !constraints.is_empty());
    let all: Vec<String> = constraints.into_iter().chain(limits).collect();
    if all.is_empty() {
        "–".to_owned()
    } else {
        all.join(", ")
    }
}

/// The design variables along the front, over the first objective.
pub(super) fn variables(report: &Report, question: &Question) -> Markup {
    html! {
        p { "Lengths and bar radii of the designs of each front, over the " (question.objectives[0].quantity.entry().label) "." }
        (figures(report, "lengths"))
        (figures(report, "bars"))
    }
}

/// The constraints that bind the designs.
pub(super) fn constraints(report: &Report) -> Markup {
    let required: Vec<Constraint> = Constraint::required(&report.model.thresholds).collect();
    let is_prescribed = report.model.workspace.region != Region::Largest;
    html! {
        p {
            @if is_prescribed {
                "The active constraints are those whose margin at the weakest pose of the region is the smallest: they would have to be relaxed "
                "for a better design."
            } @else {
                "The active constraints are those that fail first just beyond R_w: they would have to be relaxed for the workspace to grow."
            }
        }
        div.scroll { table {
            caption { "Number of the designs drawn of each front at which a constraint is active." }
            thead { tr {
                th { "architecture" } th.number { "designs" }
                @for constraint in &required { th.number { (constraint.id()) " " (constraint.name().replace('_', " ")) } }
            } }
            tbody { @for (architecture, front) in &report.fronts.alone { tr {
                td { (architecture) } td.number { (front.shown.len()) }
                @for constraint in &required {
                    td.number { (front.shown().filter(|member| member.active().any(|active| active == *constraint)).count()) }
                }
            } } }
        } }
    }
}
