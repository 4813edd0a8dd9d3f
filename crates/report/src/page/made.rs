//! How a report was made.

use maud::{Markup, html};

use super::optional;
use crate::Report;
use kinefront_model::mechanism::{Architecture, DESIGN_VARIABLES};
use kinefront_scene::text;

pub(super) fn made(report: &Report) -> Markup {
    let study = &report.study;
    html! {
        p {
            "This report was made by Kinefront " (env!("CARGO_PKG_VERSION")) " in " (report.duration.as_secs()) " s on "
            (rayon::current_num_threads()) " threads. "
            @if study.optimizer.time_limit_s.is_some() { "Searches may have ended at their time limit, so their results depend on the machine." }
            @else { "The results depend on the random seed but not on the number of threads." }
            " To repeat a search, run " code { "kinefront optimize" } " on the study below with the algorithm, the "
            "random seed and the architectures of the search."
        }
        pre { code { (report.options.command) } }
        div.scroll { table {
            caption { "Searches that this report covers." }
            thead { tr {
                th { "search" } th { "architectures" } th { "algorithm" } th.number { "random seed" }
                th.number { "evaluations" } th.number { "feasible designs" } th.number { "search [s]" } th.number { "verification [s]" } th { "version" }
            } }
            tbody { @for source in &report.sources { tr {
                td { (source.name) } td { (source.architectures) } td { (source.algorithm) } td.number { (source.seed) }
                td.number { (source.evaluations) } td.number { (source.feasible) } (optional(source.search_s)) (optional(source.verification_s)) td { (source.version) }
            } } }
        } }
        div.scroll { table {
            caption { "Bounds of the design variables [m]." }
            thead { tr { th { "" } @for variable in DESIGN_VARIABLES { th.number { (variable.symbol()) } } } }
            tbody { @for (name, end) in [("lower", 0), ("upper", 1)] { tr {
                td { (name) } @for variable in DESIGN_VARIABLES { td.number { (study.bounds.range(variable)[end]) } }
            } } }
        } }
        div.scroll { table {
            caption {
                "The flexible model of each leg: a chain of springs from the base to the centre of the platform, "
                "connected by rigid bodies, with two passive joints."
            }
            thead { tr { th { "architecture" } th { "actuator" } th { "leg" } th { "platform" } } }
            tbody { @for (architecture, _) in &report.fronts.alone { tr {
                td { (text::architecture(*architecture)) } td { (actuator(*architecture)) }
                td { (bars(*architecture, report.model.settings().rails.is_some())) } td { "bar of length r and radius r_p: 6 springs" }
            } } }
        } }
        details {
            summary { "The study" @if report.sources.len() > 1 { ", as in the first search except for the architectures" } }
            pre { code { (toml::to_string(study).unwrap_or_default()) } }
        }
    }
}

fn actuator(architecture: Architecture) -> String {
    let kind = match architecture.actuator() {
        kinefront_model::mechanism::JointKind::Prismatic => "prismatic",
        kinefront_model::mechanism::JointKind::Revolute => "revolute",
    };
    format!("{kind}: 1 spring")
}

fn bars(architecture: Architecture, rails_bend: bool) -> String {
    let bars = match architecture.bars_per_leg() {
        1 => "bar of radius r_j: 6 springs".to_owned(),
        count => format!("{count} bars of radius r_j: 6 springs each"),
    };
    if rails_bend && architecture.chain().is_on_rails() {
        format!("rail: 5 springs; {bars}")
    } else {
        bars
    }
}
