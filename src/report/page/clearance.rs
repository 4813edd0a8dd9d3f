//! Bodies that collide, and what it costs to keep them apart.

use maud::{Markup, html};

use super::results::levels;
use super::{change, figures, optional, percent};
use kinefront_model::evaluation::Evaluation;
use crate::report::{ClearanceCost, Front, Report};
use crate::text::{number, short};

pub(super) fn clearance(report: &Report) -> Markup {
    let model = report.study.model();
    let worst = |front: &Front| -> Option<String> {
        let found = front.shown().filter_map(|member| Some((member.clearance()?, member)));
        let (_, member) = found.reduce(|worst, next| if next.0 < worst.0 { next } else { worst })?;
        Some(text::clearance(&model.nearest(member)?))
    };
    html! {
        p {
            @match model.thresholds.clearance {
                Some(least) => { "The study asks that bodies which are not joined keep " (short(1e3 * least)) " mm from each other over the regular workspace (g7)." }
                None => "The study lets bodies collide: the clearance below is told, but nothing is asked of it."
            }
            " A bar is a cylinder with round ends about its axis; legs, sliders and the platform's bars lie in layers, and a slider must not stick out beyond its rail. "
            "Below 0 bodies overlap."
        }
        div.scroll { table {
            caption { "Least clearance over the regular workspace of the designs drawn, on the fine grid." }
            thead { tr {
                th { "architecture" } th.number { "designs" } th.number { "that collide" }
                th.number { "least [mm]" } th.number { "median [mm]" } th.number { "largest [mm]" } th { "the nearest two of the worst" }
            } }
            tbody { @for (architecture, front) in &report.fronts.alone {
                @let clearances = sorted(front);
                @let colliding = clearances.iter().filter(|clearance| **clearance < 0.0).count();
                tr {
                    td { (architecture) }
                    td.number { (front.shown.len()) }
                    td.number { (colliding) @if colliding > 0 { " (" (percent(colliding as f64 / front.shown.len() as f64)) ")" } }
                    (optional(clearances.first().map(|clearance| 1e3 * clearance)))
                    (optional(clearances.get(clearances.len() / 2).map(|clearance| 1e3 * clearance)))
                    (optional(clearances.last().map(|clearance| 1e3 * clearance)))
                    td { (worst(front).unwrap_or_default().replace('_', " ")) }
                }
            } }
        } }
        @if let Some(cost) = ClearanceCost::of(&report.study, &report.variations) { (price(report, &cost)) }
    }
}

/// The clearances of the designs drawn, in order \[m\].
fn sorted(front: &Front) -> Vec<f64> {
    let mut clearances: Vec<f64> = front.shown().filter_map(Evaluation::clearance).collect();
    clearances.sort_by(f64::total_cmp);
    clearances
}

/// The fronts with and without the clearance beside each other.
fn price(report: &Report, cost: &ClearanceCost<'_>) -> Markup {
    let found = report.fronts.alone.iter().filter_map(|&(architecture, _)| {
        let (with, without) = (cost.with.of(architecture)?, cost.without.of(architecture)?);
        Some((architecture, with, without))
    });
    let clearance = short(1e3 * cost.clearance);
    html! {
        h3 { "What " (clearance) " mm cost" }
        p {
            "Every architecture searched anew, alone, with " (report.options.sensitivity.unwrap_or_default())
            " evaluations, once with bodies that may collide and once with " (clearance) " mm between them."
        }
        (figures(report, "clearance"))
        @for (architecture, with, without) in found {
            @let levels: Vec<f64> = levels(without.largest());
            div.scroll { table {
                caption {
                    (architecture) ": mass in motion of the lightest design with at least this workspace radius [kg]; the largest R_w is "
                    (number(without.largest())) " m without and " (number(with.largest())) " m with the clearance (" (change(with.largest() / without.largest())) "). "
                    "Of the " (without.shown.len()) " designs found without it, " (sorted(without).iter().filter(|clearance| **clearance < 0.0).count()) " collide."
                }
                thead { tr { th { "R_w [m]" } @for level in &levels { th.number { (short(*level)) } } } }
                tbody {
                    tr { td { "may collide" } @for level in &levels { (optional(without.lightest(*level).map(|found| found.mass))) } }
                    tr { td { (clearance) " mm" } @for level in &levels { (optional(with.lightest(*level).map(|found| found.mass))) } }
                    tr { td { "difference" } @for level in &levels {
                        td.number { @match (with.lightest(*level), without.lightest(*level)) {
                            (Some(with), Some(without)) => (change(with.mass / without.mass)),
                            _ => "–",
                        } }
                    } }
                }
            } }
        }
    }
}
