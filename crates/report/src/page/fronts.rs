//! What was found: the architectures side by side, the fronts or the progress, what is proved of them, and designs.

use maud::{Markup, html};

use super::references::active;
use super::{cell, figures, optional};
use crate::{Report, Topic};
use kinefront_model::evaluation::{Evaluation, LimitResult, Quantity};
use kinefront_model::mechanism::DESIGN_VARIABLES;
use kinefront_optimize::{Objectives, spread};
use kinefront_study::{Column, DesignProblem};

/// Largest number of designs that are listed.
const LISTED: usize = 12;

/// Relative margin below which a limit counts as one that binds a design.
const JUST_KEPT: f64 = 1e-3;

/// States what was found.
pub(super) fn fronts(report: &Report) -> Markup {
    let question = &report.question;
    let objectives = 0..question.objectives.len();
    let is_single = question.objectives.len() == 1;
    let grid = &report.study.grid.fine;
    html! {
        p {
            "All designs are feasible on the fine grid (" (grid.phi_step_deg) "° in φ, " (grid.directions) " directions)"
            @if !is_single { " and non-dominated" }
            @if report.moga2.is_some() { ", and pooled from all searches but those with MOGA-II (reimplementation)" }
            @else if report.sources.len() > 1 { ", and pooled from all runs" }
            "."
            @if !is_single {
                " At most " (report.study.optimizer.front_designs) " evenly spread designs of each front are drawn."
            }
            " They are listed in " code { "fronts.csv" } "."
        }
        (proofs(report))
        (figures(report, Topic::Fronts))
        div.scroll { table {
            caption { "The best value found of each objective for each architecture" @if !is_single { ", and the hypervolume of its front" } "." }
            thead { tr {
                th { "architecture" }
                @if !is_single { th.number { "designs" } }
                @for k in objectives.clone() { th.number { (question.label(k)) } }
                @if !is_single {
                    @let unit = report.study.hypervolume_unit();
                    th.number { "hypervolume" @if !unit.is_empty() { " [" (unit) "]" } }
                }
            } }
            tbody { @for (architecture, front) in &report.fronts.alone { tr {
                td { (architecture) }
                @if !is_single { td.number { (front.members.len()) } }
                @for k in objectives.clone() { (optional(front.best(k).map(|best| question.value(k, best)))) }
                @if !is_single { (cell(question.hypervolume(front))) }
            } } }
        } }
        (designs(report))
    }
}

/// Lists evenly spread designs of the front of all architectures; with one objective, the best design of each architecture.
fn designs(report: &Report) -> Markup {
    let question = &report.question;
    let listed: Vec<&Evaluation> = if question.objectives.len() == 1 {
        report
            .fronts
            .alone
            .iter()
            .filter_map(|(_, front)| front.best(0))
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
                @for quantity in &others { th.number { (Column::Quantity(*quantity).title()) } }
                th { "active constraints and limits" }
            } }
            tbody { @for member in listed { tr {
                td { (member.design.architecture()) }
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

/// What is proved about the workspaces of the designs that are drawn, and what the pockets that the fine grid missed would cost.
fn proofs(report: &Report) -> Markup {
    let fronts = report
        .fronts
        .alone
        .iter()
        .filter_map(|(architecture, front)| Some((architecture, front.proofs.as_ref()?)));
    let fronts: Vec<_> = fronts.collect();
    html! {
        @if !fronts.is_empty() {
            p {
                "In a workspace that is proved, every pose satisfies all constraints, not only the poses of a grid; the proofs of the other "
                "workspaces are open. Where a proof found infeasible poses that the fine grid had missed, the design was strengthened: its bars "
                "were made thicker or, for a prescribed region, its lengths were increased. Where that did not suffice, the proved radius replaces "
                "that of the fine grid, or the design is left out. The table gives the loss of R_w that these poses would have caused."
            }
            div.scroll { table {
                thead { tr {
                    th { "architecture" } th.number { "workspaces proved" } th.number { "workspaces open" }
                    th.number { "result of the fine grid refuted" } th.number { "of these, strengthened" }
                    th.number { "largest loss of R_w (lower bound)" } th.number { "largest relative violation of a constraint" }
                } }
                tbody {
                    @for (architecture, proofs) in &fronts {
                        @let thickened = proofs.refuted.iter().filter(|refuted| refuted.thickened.is_some()).count();
                        @let loss = proofs.refuted.iter().map(|refuted| 1.0 - refuted.infeasible_at_m / refuted.fine_radius_m).fold(0.0, f64::max);
                        @let violation = proofs.refuted.iter().map(|refuted| -refuted.margin).fold(0.0, f64::max);
                        tr {
                            td { (architecture) }
                            td.number { (proofs.proved) } td.number { (proofs.open) }
                            td.number { (proofs.refuted.len()) } td.number { (thickened) }
                            td.number { (format!("{:.2} %", 100.0 * loss)) } td.number { (format!("{:.2} %", 100.0 * violation)) }
                        }
                    }
                }
            } }
        }
    }
}
