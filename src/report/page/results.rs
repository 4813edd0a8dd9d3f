//! What was found: which architecture is best where, fronts, trends, constraints, designs.

use maud::{Markup, html};

use super::{cell, figures, image, percent};
use kinefront_model::evaluation::{Constraint, Evaluation};
use kinefront_model::mechanism::{VARIABLES, Variable};
use crate::report::{AT_BOUND, Fit, Front, Report, Trend, lightest_where};
use crate::text::{number, short};

/// Workspace radii at which architectures are compared, as shares of the largest.
const LEVELS: [f64; 8] = [0.05, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95];

/// Radii to compare at, round, up to the largest \[m\].
pub(super) fn levels(largest: f64) -> Vec<f64> {
    let decade = libm::pow(10.0, libm::floor(libm::log10(largest.max(f64::MIN_POSITIVE))) - 1.0);
    let round = |share: f64| (share * largest / decade).round() * decade;
    let mut levels: Vec<f64> = LEVELS.into_iter().map(round).filter(|&level| level > 0.0).collect();
    levels.dedup();
    levels
}

pub(super) fn comparison(report: &Report) -> Markup {
    let fronts = &report.fronts;
    let stretches = lightest_where(fronts);
    let total = fronts.together.largest();
    let shares = fronts.alone.iter().map(|(architecture, _)| {
        let of = stretches.iter().filter(|(winner, _)| winner == architecture);
        let width: f64 = of.map(|(_, [from, to])| to - from).sum();
        (*architecture, width / total)
    });
    let levels = levels(total);
    html! {
        ul.facts {
            @for (architecture, share) in shares {
                li { b { (percent(share)) } span { "of all workspace radii up to " (number(total)) " m: the " (architecture) " is lightest" } }
            }
        }
        @if stretches.len() <= 12 {
            p {
                "From the smallest workspace to the largest: "
                @for (index, (architecture, [from, to])) in stretches.iter().enumerate() {
                    @if index > 0 { "; " }
                    (architecture) " from " (number(*from)) " to " (number(*to)) " m"
                }
                "."
            }
        }
        div.scroll { table {
            caption { "Mass in motion [kg] of the lightest design found with at least this workspace radius, all verified on the fine grid; in brackets how many times the lightest of all." }
            thead { tr {
                th.number { "R_w [m]" }
                @for (architecture, _) in &fronts.alone { th.number { (architecture) } }
                th { "lightest" }
            } }
            tbody { @for level in levels {
                tr {
                    td.number { (short(level)) }
                    @for (_, front) in &fronts.alone {
                        td.number { @match front.lightest(level) {
                            Some(found) => {
                                (number(found.mass))
                                @if let Some(best) = fronts.together.lightest(level) { " (" (format!("{:.2}", found.mass / best.mass)) ")" }
                            }
                            None => "–",
                        } }
                    }
                    td { @if let Some(best) = fronts.together.lightest(level) { (best.design.architecture) } }
                }
            } }
        } }
    }
}

pub(super) fn fronts(report: &Report) -> Markup {
    let row = |name: String, front: &Front| {
        let ends = front.members.first().zip(front.members.last());
        html! { tr {
            td { (name) }
            td.number { (front.members.len()) }
            @if let Some((lightest, largest)) = ends {
                (cell(lightest.mass)) (cell(lightest.workspace_radius))
                (cell(largest.mass)) (cell(largest.workspace_radius))
            }
        } }
    };
    html! {
        p {
            "Every design drawn is non-dominated and verified on the fine grid ("
            (report.study.grid.fine.phi_step_deg) "° in φ, " (report.study.grid.fine.directions)
            " directions)"
            @if report.sources.len() > 1 { ", and found by any of the searches with the program's own algorithm" }
            ". Of each front at most " (report.study.optimizer.front_designs)
            " evenly spread designs are drawn; they are in " code { "fronts.csv" } "."
        }
        (figures(report, "front"))
        div.scroll { table {
            thead { tr {
                th { "front" } th.number { "designs" }
                th.number { "lightest [kg]" } th.number { "its R_w [m]" }
                th.number { "of the largest [kg]" } th.number { "its R_w [m]" }
            } }
            tbody {
                @for (architecture, front) in &report.fronts.alone { (row(architecture.to_string(), front)) }
                (row("together".to_owned(), &report.fronts.together))
            }
        } }
    }
}

/// A polynomial in `R_w` as text.
fn polynomial(fit: &Fit) -> String {
    let mut text = String::new();
    for (power, &value) in fit.coefficients.iter().enumerate() {
        let size = number(value.abs());
        match (power, value < 0.0) {
            (0, negative) => text += &format!("{}{size}", if negative { "−" } else { "" }),
            (_, negative) => {
                let sign = if negative { "−" } else { "+" };
                let times = if power == 1 { "R_w" } else { "R_w²" };
                text += &format!(" {sign} {size} {times}");
            }
        }
    }
    text
}

/// How well a fit holds, in a word and a class.
pub(super) fn verdict(r_squared: f64) -> (&'static str, &'static str) {
    match r_squared {
        r if r >= 0.95 => ("holds", "holds"),
        r if r >= 0.8 => ("roughly", "partly"),
        _ => ("does not hold", "fails"),
    }
}

/// What the paper says of a variable, and how that holds.
fn said(trend: &Trend) -> Markup {
    let (what, word, class) = if trend.variable == Variable::PlatformBarRadius {
        match trend.is_quadratic() {
            Some(true) => ("quadratic", "holds", "holds"),
            Some(false) => ("quadratic", "a line does as well", "fails"),
            None => ("quadratic", unknown(trend), "partly"),
        }
    } else {
        match &trend.linear {
            Some(fit) => {
                let (word, class) = verdict(fit.r_squared);
                ("linear", word, class)
            }
            None => ("linear", unknown(trend), "partly"),
        }
    };
    html! { (what) ": " span class=(class) { (word) } }
}

/// Why there is no fit.
pub(super) fn unknown(trend: &Trend) -> &'static str {
    if trend.free.len() < trend.points.len() {
        "it stands at a bound"
    } else {
        "too few designs"
    }
}

pub(super) fn variables(report: &Report) -> Markup {
    html! {
        p {
            "Lengths and bar radii of the designs drawn above, over their workspace radius, with least-squares fits: straight lines, and for r_p "
            "a parabola. Designs at which a variable is within " (percent(AT_BOUND)) " of its range from one of its bounds are left out of its fits: it may not go on there. "
            "R² is the share of the variance that a fit explains; the rank correlation is 1 where a variable only grows with R_w."
        }
        (figures(report, "lengths"))
        (figures(report, "bars"))
        div.scroll { table {
            thead { tr {
                th { "architecture" } th { "variable [m]" }
                th.number { "designs off bounds" } th { "straight line" } th.number { "R²" } th { "parabola" } th.number { "R²" }
                th.number { "rank correlation" } th { "said to be" }
            } }
            tbody { @for (architecture, trends) in &report.trends { @for trend in trends {
                tr {
                    td { (architecture) } td { (trend.variable.symbol()) }
                    td.number { (trend.free.len()) " of " (trend.points.len()) }
                    @for fit in [&trend.linear, &trend.quadratic] {
                        @match fit {
                            Some(fit) => { td.formula { (polynomial(fit)) } td.number { (format!("{:.3}", fit.r_squared)) } }
                            None => { td { "–" } td.number { "–" } }
                        }
                    }
                    td.number { (trend.rank_correlation.map_or_else(|| "–".to_owned(), |value| format!("{value:.2}"))) }
                    td { (said(trend)) }
                }
            } } }
        } }
    }
}

pub(super) fn constraints(report: &Report) -> Markup {
    let asked: Vec<Constraint> = Constraint::asked(&report.study.model().thresholds).collect();
    html! {
        p {
            "The constraints that fail first just beyond R_w: what would have to be eased for the workspace to grow. Where several dots stand above "
            "each other, they fail together."
        }
        (figures(report, "active"))
        div.scroll { table {
            caption { "Share of the designs drawn of each front at which a constraint is active." }
            thead { tr {
                th { "architecture" }
                @for &constraint in &asked { th.number { (constraint.id()) } }
            } }
            tbody { @for (architecture, front) in &report.fronts.alone { tr {
                td { (architecture) }
                @for &constraint in &asked {
                    @let count = front.shown().filter(|member| member.active().any(|active| active == constraint)).count();
                    td.number { @if count > 0 { (percent(count as f64 / front.shown.len() as f64)) } @else { "–" } }
                }
            } } }
        } }
        p {
            @for (index, constraint) in asked.iter().enumerate() {
                @if index > 0 { "; " }
                (constraint.id()) ": " (constraint.name().replace('_', " "))
            }
            "."
        }
    }
}

pub(super) fn pictures(report: &Report) -> Markup {
    html! {
        p {
            "The lightest design, the knee and the largest of each front at home, with true bar radii and the regular workspace in green"
            @if !report.references.is_empty() { "; then the reference designs" }
            ". Pictures are cast from the same solids that the recordings and exports hold."
        }
        div.figures.pictures { @for picture in &report.pictures {
            figure id={ "picture-" (picture.name) } {
                (image(picture))
                figcaption { strong { (picture.caption) } (numbers(&picture.evaluation)) }
            }
        } }
    }
}

/// A design's numbers.
fn numbers(evaluation: &Evaluation) -> Markup {
    let values = evaluation.design.values();
    let active: Vec<&str> = evaluation.active().map(|constraint| constraint.id()).collect();
    html! { div.numbers {
        @for (variable, value) in VARIABLES.into_iter().zip(values) {
            span { (variable.symbol()) " " b { (number(value)) } " m" }
        }
        span { "mass " b { (number(evaluation.mass)) } " kg" }
        span { "R_w " b { (number(evaluation.workspace_radius)) } " m" }
        @if let Some(phi) = evaluation.home_phi_deg { span { "φ_c " b { (number(phi)) } "°" } }
        span { "stopped by " b { (active.join(", ")) } }
    } }
}
