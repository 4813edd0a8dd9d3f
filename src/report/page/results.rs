//! Results: comparison of the architectures, fronts, trends, active constraints and pictures of designs.

use maud::{Markup, html};

use super::references::active;
use super::{cell, figures, image, paper, percent};
use crate::report::{AT_BOUND, Fit, Front, Report, Trend, lightest_intervals};
use crate::text::{self, number, short};
use kinefront_model::evaluation::{Constraint, Evaluation};
use kinefront_model::mechanism::{Architecture, DESIGN_VARIABLES};

/// Workspace radii at which architectures are compared, as fractions of the largest radius.
const LEVELS: [f64; 8] = [0.05, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95];

/// Returns the radii at which architectures are compared, rounded to two digits of the largest radius \[m\].
pub(super) fn levels(largest: f64) -> Vec<f64> {
    let decade = libm::pow(10.0, libm::floor(libm::log10(largest.max(f64::MIN_POSITIVE))) - 1.0);
    let round = |fraction: f64| (fraction * largest / decade).round() * decade;
    let mut levels: Vec<f64> = LEVELS.into_iter().map(round).filter(|&level| level > 0.0).collect();
    levels.dedup();
    levels
}

/// Largest number of architectures each of which has a fact of its own.
const FEW: usize = 4;

pub(super) fn comparison(report: &Report) -> Markup {
    let fronts = &report.fronts;
    let intervals = lightest_intervals(fronts);
    let total = fronts.together.largest();
    let fractions = fronts.alone.iter().map(|(architecture, _)| {
        let of = intervals.iter().filter(|(winner, _)| winner == architecture);
        let width: f64 = of.map(|(_, [from, to])| to - from).sum();
        (*architecture, width / total)
    });
    let levels = levels(total);
    let fractions: Vec<(Architecture, f64)> = fractions.collect();
    // Of many architectures, most are nowhere the lightest.
    let is_shown = |(_, fraction): &&(Architecture, f64)| fractions.len() <= FEW || *fraction > 0.0;
    let shown: Vec<(Architecture, f64)> = fractions.iter().filter(is_shown).copied().collect();
    let rails_are_rigid = report.model.rails.is_none();
    let is_on_rails = |architecture: &Architecture| architecture.chain().is_on_rails();
    let (on_rails, others): (Vec<Architecture>, Vec<Architecture>) = fractions
        .iter()
        .map(|(architecture, _)| *architecture)
        .partition(is_on_rails);
    html! {
        ul.facts {
            @for (architecture, fraction) in &shown {
                li { b { (percent(*fraction)) } span { "of the range of workspace radii up to " (number(total)) " m: the " (text::architecture(*architecture)) " is the lightest" } }
            }
        }
        @if shown.len() < fractions.len() {
            p { "The other " (fractions.len() - shown.len()) " architectures are nowhere the lightest." }
        }
        @if !on_rails.is_empty() && !others.is_empty() {
            p {
                @if rails_are_rigid {
                    "Rails weigh nothing and do not yield in this study, as in the paper. This flatters the architectures whose "
                    "first joint is prismatic ("
                } @else {
                    "The mass contains the rails, which do not move, and the stiffness their bending (the architectures whose first "
                    "joint is prismatic: "
                }
                @for (index, architecture) in on_rails.iter().enumerate() { @if index > 0 { ", " } (text::architecture(*architecture)) }
                @if rails_are_rigid { ") in a comparison with the others." } @else { ")." }
            }
        }
        @if intervals.len() <= 12 {
            p {
                "The lightest architecture, from the smallest workspace radius to the largest: "
                @for (index, (architecture, [from, to])) in intervals.iter().enumerate() {
                    @if index > 0 { "; " }
                    (text::architecture(*architecture)) " from " (number(*from)) " to " (number(*to)) " m"
                }
                "."
            }
        }
        div.scroll { table {
            caption {
                "Mass in motion [kg] of the lightest design found with at least the given workspace radius, verified "
                "on the fine grid. In brackets: its ratio to the mass of the lightest design of any architecture."
            }
            thead { tr {
                th.number { "R_w [m]" }
                @for (architecture, _) in &fronts.alone { th.number { (text::architecture(*architecture)) } }
                th { "lightest architecture" }
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
                    td { @if let Some(best) = fronts.together.lightest(level) { (text::architecture(best.design.architecture)) } }
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
            "All designs drawn are non-dominated and verified on the fine grid ("
            (report.study.grid.fine.phi_step_deg) "° in φ, " (report.study.grid.fine.directions)
            " directions)"
            @if report.moga2.is_some() { ", and pooled from all searches but those with MOGA-II (reimplementation)" }
            @else if report.sources.len() > 1 { ", and pooled from all runs" }
            ". At most " (report.study.optimizer.front_designs)
            " evenly spread designs of each front are drawn; they are listed in " code { "fronts.csv" } "."
        }
        (proofs(report))
        (figures(report, "front"))
        div.scroll { table {
            thead { tr {
                th { "front" } th.number { "designs" }
                th.number { "mass of the lightest design [kg]" } th.number { "its R_w [m]" }
                th.number { "mass of the design with the largest R_w [kg]" } th.number { "its R_w [m]" }
            } }
            tbody {
                @for (architecture, front) in &report.fronts.alone { (row(architecture.to_string(), front)) }
                (row("all architectures".to_owned(), &report.fronts.together))
            }
        } }
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
                "The workspaces of the designs drawn are proved: within the radius that is stated, every pose satisfies all constraints, "
                "not only those of a grid. Where the fine grid had missed infeasible poses, the bars of the design were made thicker, or, "
                "if that does not help, the radius is the one that is proved. The table states what these poses would have cost."
            }
            div.scroll { table {
                thead { tr {
                    th { "front" } th.number { "workspaces proved" } th.number { "open" }
                    th.number { "radius of the fine grid too large" } th.number { "of these with thicker bars" }
                    th.number { "largest loss of R_w, at least" } th.number { "largest violation of a constraint" }
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

/// Formats a polynomial in `R_w`.
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

/// Returns the reason why there is no fit.
pub(super) fn unknown(trend: &Trend) -> &'static str {
    if trend.free.len() < trend.points.len() {
        "the variable is at a bound"
    } else {
        "too few designs"
    }
}

pub(super) fn variables(report: &Report) -> Markup {
    html! {
        p {
            "Lengths and bar radii of the designs drawn above over their workspace radius, with least-squares fits: "
            "straight lines, and a parabola for r_p. Designs at which a variable is within " (percent(AT_BOUND)) " of "
            "its range from one of its bounds are excluded from the fits of that variable, because the bound "
            "determines its value there. R² is the fraction of the variance that a fit explains; the rank correlation "
            "is 1 if a variable increases monotonically with R_w."
        }
        (figures(report, "lengths"))
        (figures(report, "bars"))
        div.scroll { table {
            thead { tr {
                th { "architecture" } th { "variable [m]" }
                th.number { "designs not at a bound" } th { "straight line" } th.number { "R²" } th { "parabola" } th.number { "R²" }
                th.number { "rank correlation" } @if report.of_paper { th { "claim of the 2010 paper" } }
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
                    @if report.of_paper { td { (paper::claim(trend)) } }
                }
            } } }
        } }
    }
}

pub(super) fn constraints(report: &Report) -> Markup {
    let required: Vec<Constraint> = Constraint::required(&report.model.thresholds).collect();
    html! {
        p {
            "The active constraints are those that fail first just beyond R_w: they would have to be relaxed for the "
            "workspace to grow. Dots above each other at the same R_w mark constraints that fail together."
        }
        (figures(report, "active"))
        div.scroll { table {
            caption { "Percentage of the drawn designs of each front at which a constraint is active." }
            thead { tr {
                th { "architecture" }
                @for &constraint in &required { th.number { (constraint.id()) } }
            } }
            tbody { @for (architecture, front) in &report.fronts.alone { tr {
                td { (architecture) }
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

pub(super) fn pictures(report: &Report) -> Markup {
    html! {
        p {
            @if report.question.is_none() { "The lightest design, the knee and the design with the largest workspace" }
            @else { "The best design in each objective and the knee" }
            " of each front at the home pose, with true bar radii and the regular workspace in green"
            @if !report.references.is_empty() { "; then the reference designs" }
            ". The pictures are rendered from the same solids as in the recordings and exports."
        }
        div.figures.pictures { @for picture in &report.pictures {
            figure id={ "picture-" (picture.name) } {
                (image(picture))
                figcaption { strong { (picture.caption) } (numbers(&picture.evaluation)) }
            }
        } }
    }
}

/// Lists the variables, objectives, home orientation and active constraints of a design.
fn numbers(evaluation: &Evaluation) -> Markup {
    html! { div.numbers {
        @for variable in DESIGN_VARIABLES.into_iter().chain(evaluation.design.given_variables()) {
            span {
                (variable.symbol()) " " b { (number(evaluation.design.value(variable))) }
                @if variable.is_angle() { "°" } @else { " m" }
            }
        }
        span { "mass " b { (number(evaluation.mass)) } " kg" }
        span { "R_w " b { (number(evaluation.workspace_radius)) } " m" }
        @if let Some(phi) = evaluation.home_phi_deg { span { "φ_c " b { (number(phi)) } "°" } }
        span { "active constraints " b { (active(evaluation)) } }
    } }
}
