//! Clearance between members, and the cost of requiring it.

use maud::{Markup, html};

use super::{change, figures, optional, percent};
use crate::{ClearanceCost, Front, Report, Topic};
use kinefront_model::evaluation::{Evaluation, PoseScalar};
use kinefront_scene::text::{self, number, short};

pub(super) fn clearance(report: &Report) -> Markup {
    let model = &report.model;
    let worst = |front: &Front| -> Option<String> {
        let found = front.shown().filter_map(|member| Some((member.clearance()?, member)));
        let (_, member) = found.reduce(|worst, next| if next.0 < worst.0 { next } else { worst })?;
        Some(text::clearance(member.nearest.as_ref()?))
    };
    html! {
        p {
            @match model.settings().thresholds.get(PoseScalar::Clearance) {
                Some(least) => {
                    "The study requires a clearance of at least " (short(1e3 * least)) " mm between members that are "
                    "not joined, over the whole regular workspace (g7)."
                }
                None => "The study allows members to collide: the clearance below is reported but not required."
            }
            " A bar is modelled as a cylinder with rounded ends; legs, sliders and the bars of the platform lie in "
            "layers, and a slider must not protrude beyond the end of its rail. A negative clearance means that "
            "members overlap."
        }
        div.scroll { table {
            caption { "Smallest clearance over the regular workspace of each drawn design, on the fine grid." }
            thead { tr {
                th { "architecture" } th.number { "designs" } th.number { "designs with collisions" }
                th.number { "smallest [mm]" } th.number { "median [mm]" } th.number { "largest [mm]" } th { "nearest pair of members of the design with the smallest clearance" }
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

/// Returns the clearances of the drawn designs in ascending order \[m\].
fn sorted(front: &Front) -> Vec<f64> {
    let mut clearances: Vec<f64> = front.shown().filter_map(Evaluation::clearance).collect();
    clearances.sort_by(f64::total_cmp);
    clearances
}

/// Compares the fronts with and without a required clearance.
fn price(report: &Report, cost: &ClearanceCost<'_>) -> Markup {
    let question = &report.question;
    let found = report.fronts.alone.iter().filter_map(|&(architecture, _)| {
        let (with, without) = (cost.with.of(architecture)?, cost.without.of(architecture)?);
        Some((architecture, with, without))
    });
    let clearance = short(1e3 * cost.clearance);
    html! {
        h3 { "Cost of a clearance of " (clearance) " mm" }
        p {
            "Each architecture is searched again on its own with " (report.options.sensitivity.unwrap_or_default())
            " evaluations, once with members that may collide and once with a required clearance of " (clearance) " mm."
        }
        (figures(report, Topic::Clearance))
        @for (architecture, with, without) in found {
            @let levels: Vec<f64> = question.levels(without);
            @let best = |front: &Front| front.best(1).map(|best| question.value(1, best)).unwrap_or_default();
            div.scroll { table {
                caption {
                    (architecture) ": best " (question.label(0)) " of the designs whose " (question.name(1)) " is " (question.bound(1))
                    " the given one. The best " (question.name(1)) " is " (number(best(without))) (question.unit(1)) " without and "
                    (number(best(with))) (question.unit(1)) " with the clearance (" (change(best(with) / best(without))) "). "
                    "Of the " (without.shown.len()) " drawn designs of the front without the required clearance, " (sorted(without).iter().filter(|clearance| **clearance < 0.0).count()) " have collisions."
                }
                thead { tr { th { (question.label(1)) } @for level in &levels { th.number { (short(*level)) } } } }
                tbody {
                    tr { td { "members may collide" } @for level in &levels { (optional(question.cost_at(without, *level))) } }
                    tr { td { (clearance) " mm clearance" } @for level in &levels { (optional(question.cost_at(with, *level))) } }
                    tr { td { "change" } @for level in &levels {
                        td.number { @match (question.cost_at(with, *level), question.cost_at(without, *level)) {
                            (Some(with), Some(without)) => (change(with / without)),
                            _ => "–",
                        } }
                    } }
                }
            } }
        }
    }
}
