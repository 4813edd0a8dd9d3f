//! How a report was made, and where the paper's figures and tables are.

use maud::{Markup, html};

use super::optional;
use kinefront_model::mechanism::{Architecture, VARIABLES};
use crate::report::Report;

/// Where a reader of the paper finds what.
pub(super) fn guide(report: &Report) -> Markup {
    let whole = report.rivals.is_some();
    let mut places = vec![
        ("Fig. 1, the manipulators", "pictures", "Designs"),
        ("Fig. 2 to 4, flexible models of the legs", "made", "How this was made"),
        ("Fig. 5, a regular workspace", "pictures", "Designs (green)"),
        ("Fig. 6, Pareto front", "fronts", "Pareto fronts, all together"),
        ("Fig. 7, fronts of the three architectures", "fronts", "Pareto fronts"),
        ("Fig. 8, CAD designs", "pictures", "Designs, ID-I to ID-III"),
        ("Fig. 9, R, r, L_b along R_w", "variables", "Design variables"),
        ("Fig. 10, r_j, r_p along R_w", "variables", "Design variables"),
        ("Tab. 1, bounds", "made", "How this was made"),
        ("Tab. 3, three Pareto-optimal designs", "designs", "Reference designs"),
    ];
    if whole {
        places.insert(9, ("Tab. 2, the algorithm's parameters", "made", "How this was made"));
    }
    html! {
        p {
            "Damien Chablat, Stéphane Caro, Raza Ur-Rehman and Philippe Wenger: "
            em { "Comparison of Planar Parallel Manipulator Architectures based on a Multi-objective Design Optimization Approach" }
            ", ASME IDETC/CIE 2010, DETC2010-28650. "
            @if whole { "Its study was run again from nothing; here is each of its figures and tables, and " }
            @else { "This run asks what its study does; below is " }
            a href="#differences" { "where and why the numbers differ" } "."
        }
        details open {
            summary { "Where each figure and table of the paper is" }
            table { tbody { @for (paper, id, here) in places { tr { td { (paper) } td { a href={ "#" (id) } { (here) } } } } } }
        }
    }
}

pub(super) fn made(report: &Report) -> Markup {
    let study = &report.study;
    html! {
        p {
            "Made by Kinefront " (env!("CARGO_PKG_VERSION")) " in " (report.taken.as_secs()) " s on "
            (rayon::current_num_threads()) " threads. "
            @if study.optimizer.time_limit_s.is_some() { "Searches may have ended by time: their results depend on the machine." }
            @else { "One seed gives one result, whatever the number of threads." }
            " A search is repeated by " code { "kinefront optimize" } " on the study below with its algorithm, seed and architectures."
        }
        pre { code { (report.options.command) } }
        div.scroll { table {
            caption { "Searches." }
            thead { tr {
                th { "search" } th { "architectures" } th { "algorithm" } th.number { "seed" }
                th.number { "evaluations" } th.number { "feasible" } th.number { "search [s]" } th.number { "verification [s]" } th { "version" }
            } }
            tbody { @for source in &report.sources { tr {
                td { (source.name) } td { (source.architectures) } td { (source.algorithm) } td.number { (source.seed) }
                td.number { (source.evaluations) } td.number { (source.feasible) } (optional(source.search_s)) (optional(source.verification_s)) td { (source.version) }
            } } }
        } }
        div.scroll { table {
            caption { "Bounds [m]." }
            thead { tr { th { "" } @for variable in VARIABLES { th.number { (variable.symbol()) } } } }
            tbody { @for (name, end) in [("lower", 0), ("upper", 1)] { tr {
                td { (name) } @for variable in VARIABLES { td.number { (study.bounds.range(variable)[end]) } }
            } } }
        } }
        @if report.rivals.is_some() { (parameters(report)) }
        div.scroll { table {
            caption { "The flexible model of each leg: springs from the base to the platform's centre, joined by rigid bodies; two passive revolutes." }
            thead { tr { th { "architecture" } th { "actuator" } th { "leg" } th { "platform" } } }
            tbody { @for (architecture, _) in &report.fronts.alone { tr {
                td { (architecture) } td { (actuator(*architecture)) }
                td { (bars(*architecture)) } td { "bar of length r and radius r_p: 6 springs" }
            } } }
        } }
        details {
            summary { "The study" @if report.sources.len() > 1 { ", of the first search but for the architectures" } }
            pre { code { (toml::to_string(study).unwrap_or_default()) } }
        }
    }
}

/// The parameters that the paper tabulates for its own algorithm, as its stand-in has them here.
fn parameters(report: &Report) -> Markup {
    let settings = &report.study.optimizer.moga2;
    let generations = report.study.optimizer.evaluations / settings.population.max(1);
    let rows: [(&str, String); 8] = [
        ("scheduler", "after MOGA-II".to_owned()),
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
        caption { "Parameters of the paper's algorithm, as its stand-in has them; those of the others are in the study below." }
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
