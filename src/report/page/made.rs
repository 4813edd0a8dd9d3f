//! How a report was made, and where the page shows the figures and tables of the paper.

use maud::{Markup, html};

use super::optional;
use crate::report::Report;
use kinefront_model::mechanism::{Architecture, DESIGN_VARIABLES};

/// Lists where a reader of the paper finds each of its figures and tables on the page.
pub(super) fn guide(report: &Report) -> Markup {
    let whole = report.moga2.is_some();
    let mut places = vec![
        ("Fig. 1, the manipulators", "pictures", "Pictures of designs"),
        (
            "Fig. 2 to 4, flexible models of the legs",
            "made",
            "How this report was made",
        ),
        ("Fig. 5, a regular workspace", "pictures", "Pictures of designs (green)"),
        (
            "Fig. 6, Pareto front",
            "fronts",
            "Pareto fronts, all architectures together",
        ),
        ("Fig. 7, fronts of the three architectures", "fronts", "Pareto fronts"),
        ("Fig. 8, CAD designs", "pictures", "Pictures of designs, ID-I to ID-III"),
        (
            "Fig. 9, R, r and L_b over R_w",
            "variables",
            "Trends of the design variables",
        ),
        (
            "Fig. 10, r_j and r_p over R_w",
            "variables",
            "Trends of the design variables",
        ),
        ("Tab. 1, bounds", "made", "How this report was made"),
        ("Tab. 3, three Pareto-optimal designs", "designs", "Reference designs"),
    ];
    if whole {
        places.insert(
            9,
            (
                "Tab. 2, the parameters of the algorithm",
                "made",
                "How this report was made",
            ),
        );
    }
    html! {
        p {
            "Damien Chablat, Stéphane Caro, Raza Ur-Rehman and Philippe Wenger: "
            em { "Comparison of Planar Parallel Manipulator Architectures based on a Multi-objective Design Optimization Approach" }
            ", ASME IDETC/CIE 2010, DETC2010-28650. "
            @if whole { "The study of the paper was repeated from scratch. This page has each of its figures and tables, and explains " }
            @else { "The model, requirements and bounds of this run are those of the paper. A section below explains " }
            a href="#differences" { "where and why the numbers differ" } "."
        }
        details open {
            summary { "Where to find each figure and table of the paper" }
            table { tbody { @for (paper, id, here) in places { tr { td { (paper) } td { a href={ "#" (id) } { (here) } } } } } }
        }
    }
}

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
        @if report.moga2.is_some() { (parameters(report)) }
        div.scroll { table {
            caption {
                "The flexible model of each leg: a chain of springs from the base to the centre of the platform, "
                "connected by rigid bodies, with two passive revolute joints."
            }
            thead { tr { th { "architecture" } th { "actuator" } th { "leg" } th { "platform" } } }
            tbody { @for (architecture, _) in &report.fronts.alone { tr {
                td { (architecture) } td { (actuator(*architecture)) }
                td { (bars(*architecture)) } td { "bar of length r and radius r_p: 6 springs" }
            } } }
        } }
        details {
            summary { "The study" @if report.sources.len() > 1 { ", as in the first search except for the architectures" } }
            pre { code { (toml::to_string(study).unwrap_or_default()) } }
        }
    }
}

/// Tabulates the parameters that the paper gives for its algorithm, with the values used by MOGA-II (reimplementation).
fn parameters(report: &Report) -> Markup {
    let settings = &report.study.optimizer.moga2;
    let generations = report.study.optimizer.evaluations / settings.population.max(1);
    let rows: [(&str, String); 8] = [
        ("scheduler", "MOGA-II (reimplementation)".to_owned()),
        ("number of iterations", generations.to_string()),
        (
            "directional cross-over probability",
            settings.directional_crossover.to_string(),
        ),
        ("selection probability", settings.selection.to_string()),
        ("mutation probability", settings.mutation.to_string()),
        ("DNA string mutation ratio", settings.mutation_ratio.to_string()),
        (
            "DOE algorithm, number of designs",
            format!("Sobol, {}", settings.population),
        ),
        (
            "total number of iterations",
            report.study.optimizer.evaluations.to_string(),
        ),
    ];
    html! { div.scroll { table {
        caption {
            "Parameters of MOGA-II as tabulated in the paper, with the values used by the reimplementation. The "
            "parameters of the other algorithms are in the study below."
        }
        tbody { @for (name, value) in rows { tr { td { (name) } td.number { (value) } } } }
    } } }
}

fn actuator(architecture: Architecture) -> String {
    let kind = match architecture.actuator() {
        kinefront_model::mechanism::Actuator::Prismatic => "prismatic",
        kinefront_model::mechanism::Actuator::Revolute => "revolute",
    };
    format!("{kind}: 1 spring")
}

fn bars(architecture: Architecture) -> String {
    match architecture.bars_per_leg() {
        1 => "bar of radius r_j: 6 springs".to_owned(),
        count => format!("{count} bars of length L_b and radius r_j: 6 springs each"),
    }
}
