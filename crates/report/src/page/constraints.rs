//! The constraints that limit the designs.

use maud::{Markup, html};

use super::{figures, percent};
use crate::{Report, Topic};
use kinefront_model::evaluation::Constraint;
use kinefront_model::workspace::Region;

/// Shows at which designs each constraint is active.
pub(super) fn constraints(report: &Report) -> Markup {
    let required: Vec<Constraint> = Constraint::required(&report.model.settings().thresholds).collect();
    let is_prescribed = report.model.settings().workspace.region != Region::Largest;
    html! {
        p {
            @if is_prescribed {
                "The active constraints are those with the smallest margin over all poses of the region: they would have to be relaxed "
                "for a better design."
            } @else {
                "The active constraints are those that fail first just beyond R_w: they would have to be relaxed for the workspace to grow."
            }
            @if !report.trends.is_empty() { " Dots at the same abscissa mark constraints that are active at the same design." }
        }
        (figures(report, Topic::Active))
        div.scroll { table {
            caption { "Percentage of the drawn designs of each front at which each constraint is active." }
            thead { tr {
                th { "architecture" } th.number { "designs" }
                @for constraint in &required { th.number { (constraint.id()) } }
            } }
            tbody { @for (architecture, front) in &report.fronts.alone { tr {
                td { (architecture) } td.number { (front.shown.len()) }
                @for &constraint in &required {
                    @let count = front.shown().filter(|member| member.active().any(|active| active == constraint)).count();
                    td.number { @if count > 0 { (percent(count as f64 / front.shown.len() as f64)) } @else { "–" } }
                }
            } } }
        } }
        p {
            @for (index, constraint) in required.iter().enumerate() {
                @if index > 0 { "; " }
                (constraint.id()) ": " (constraint.name().replace('_', " "))
            }
            "."
        }
    }
}
