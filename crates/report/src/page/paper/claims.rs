//! The claims of the 2010 paper, judged by what was found.

use maud::{Markup, html};

use super::super::percent;
use crate::{Report, Trend};
use kinefront_model::mechanism::{Architecture, DesignVariable};

/// Returns how well a fit holds, in words and as a CSS class.
fn verdict(r_squared: f64) -> (&'static str, &'static str) {
    match r_squared {
        r if r >= 0.95 => ("holds", "holds"),
        r if r >= 0.8 => ("holds roughly", "partly"),
        _ => ("does not hold", "fails"),
    }
}

/// Returns the verdict on the claim that a variable is quadratic in `R_w`, and its style.
fn quadratic_verdict(holds: bool) -> (&'static str, &'static str) {
    if holds {
        ("holds", "holds")
    } else {
        ("an upward parabola is not clearly better", "fails")
    }
}

/// Returns the reason why there is no fit.
fn unknown(trend: &Trend) -> &'static str {
    if trend.free.len() < trend.points.len() {
        "the variable is at a bound"
    } else {
        "too few designs"
    }
}

/// Checks the claims of the paper.
pub(super) fn claims(report: &Report) -> Markup {
    let trends = || {
        report
            .trends
            .iter()
            .flat_map(|(architecture, trends)| trends.iter().map(move |trend| (architecture, trend)))
    };
    html! { div.scroll { table {
        thead { tr { th { "claim of the paper" } th { "result here" } } }
        tbody {
            (comparisons(report))
            tr {
                td { "Every design variable increases with R_w." }
                @let ranked: Vec<_> = trends().filter_map(|(architecture, trend)| Some((architecture, trend, trend.rank_correlation?))).collect();
                @match ranked.iter().min_by(|a, b| a.2.total_cmp(&b.2)) {
                    Some((architecture, trend, least)) => {
                        @let class = if *least > 0.95 { "holds" } else if *least > 0.6 { "partly" } else { "fails" };
                        (judged(class, format!(
                            "smallest rank correlation {least:.2} ({} of the {architecture}); {} of {} above 0.95, variables at a bound excluded",
                            trend.variable.symbol(), ranked.iter().filter(|(.., value)| *value > 0.95).count(), ranked.len(),
                        )))
                    }
                    None => td { "not determined: too few designs" }
                }
            }
            tr {
                td { "R, r, L_b and r_j are almost linear in R_w." }
                td {
                    "R² of straight lines: "
                    @for (index, (architecture, trend)) in trends()
                        .filter(|(_, trend)| trend.variable != DesignVariable::PlatformBarRadius)
                        .enumerate()
                    {
                        @if index > 0 { "; " }
                        (trend.variable.symbol()) " of the " (architecture) " "
                        @match &trend.linear {
                            Some(fit) => {
                                @let (word, class) = verdict(fit.r_squared);
                                span class=(class) { (format!("{:.2}, {word}", fit.r_squared)) }
                            }
                            None => (unknown(trend))
                        }
                    }
                }
            }
            tr {
                td { "r_p is quadratic rather than linear in R_w." }
                td {
                    "R² of the parabola and of the straight line: "
                    @for (index, (architecture, trend)) in trends()
                        .filter(|(_, trend)| trend.variable == DesignVariable::PlatformBarRadius)
                        .enumerate()
                    {
                        @if index > 0 { "; " }
                        (architecture) " "
                        @match (&trend.quadratic, &trend.linear, trend.is_quadratic()) {
                            (Some(parabola), Some(line), Some(holds)) => {
                                @let (word, class) = quadratic_verdict(holds);
                                span class=(class) { (format!("{:.3} and {:.3}, {word}", parabola.r_squared, line.r_squared)) }
                            }
                            _ => (unknown(trend))
                        }
                    }
                }
            }
        }
    } } }
}

/// Returns a table cell with a verdict in words and colour.
fn judged(class: &'static str, words: String) -> Markup {
    let verdict = match class {
        "holds" => "holds: ",
        "partly" => "holds in part: ",
        _ => "does not hold: ",
    };
    html! { td { span class=(class) { (verdict) } (words) } }
}

/// Checks the claims of the paper on how the architectures compare.
fn comparisons(report: &Report) -> Markup {
    let fronts = &report.fronts;
    let Some(best) = report
        .references
        .first()
        .map(|reference| reference.fine.design.architecture())
    else {
        return html! {};
    };
    let class = |fraction: f64| {
        if fraction == 1.0 {
            "holds"
        } else if fraction > 0.5 {
            "partly"
        } else {
            "fails"
        }
    };
    let others = fronts.alone.iter().filter(|(architecture, _)| *architecture != best);
    html! {
        tr {
            td { "All Pareto-optimal designs of the three architectures together are of type " (best) "." }
            @if fronts.alone.len() < Architecture::PAPER.len() {
                td { "not compared: not all architectures were searched" }
            } @else {
                @let fraction = fronts.together.fraction(best);
                @let moga2_front = report.moga2.as_ref().and_then(|moga2| moga2.joint.as_ref());
                (judged(class(fraction), format!(
                    "{} of the designs of the front of all architectures{}{}", percent(fraction),
                    report.joint.as_ref().map(|joint| format!(", {} of those of the single search over all architectures", percent(joint.fraction(best)))).unwrap_or_default(),
                    moga2_front.map(|moga2_front| format!(", {} of those of MOGA-II (reimplementation)", percent(moga2_front.fraction(best)))).unwrap_or_default(),
                )))
            }
        }
        @for (architecture, front) in others {
            @let ratios: Vec<f64> = report.question.levels(&fronts.together).into_iter().filter_map(|level| {
                Some(report.question.cost_at(front, level)? / report.question.cost_at(fronts.of(best)?, level)?)
            }).collect();
            @let low = ratios.iter().copied().fold(f64::INFINITY, f64::min);
            @let high = ratios.iter().copied().fold(0.0, f64::max);
            tr {
                td { "The " (best) " is better than the " (architecture) "." }
                @if ratios.is_empty() {
                    td { "not compared: at no radius do this architecture and the " (best) " both have a design" }
                } @else {
                    @let class = if low > 1.0 { "holds" } else if high > 1.0 { "partly" } else { "fails" };
                    (judged(class, format!("the {architecture} is {low:.2} to {high:.2} times as heavy at the radii of the table in “Comparison of the architectures”")))
                }
            }
        }
    }
}
