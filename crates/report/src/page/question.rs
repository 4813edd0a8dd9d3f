//! What the study asks.

use maud::{Markup, html};

use crate::Report;
use crate::question::sought;
use kinefront_model::evaluation::Bound;
use kinefront_model::workspace::Region;
use kinefront_scene::text::short;

/// States what the study asks.
pub(super) fn asked(report: &Report) -> Markup {
    let (study, question) = (&report.study, &report.question);
    html! {
        div.scroll { table {
            caption { "Objectives." }
            thead { tr { th { "quantity" } th { "goal" } th { "meaning" } } }
            tbody { @for (k, objective) in question.objectives.iter().enumerate() { tr {
                td { (question.label(k)) } td { (sought(objective)) } td { (objective.quantity.entry().meaning) }
            } } }
        } }
        @if study.limits().next().is_some() {
            div.scroll { table {
                caption { "Limits of the study in addition to the thresholds of its requirements." }
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
    let spec = &report.model.settings().workspace;
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
            format!(
                "the polygon with the corners {} m relative to the centre of the workspace",
                corners.join(", ")
            )
        }
    };
    format!(
        "The positions are those of {of_region}; the centre of the workspace is at ({}, {}) m. The orientations span {range}° in total, centred on the home orientation.",
        short(spec.centre.x),
        short(spec.centre.y)
    )
}
