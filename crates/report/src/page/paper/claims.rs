//! The claims of the 2010 paper, judged by what was found.

use maud::{Markup, html};

use super::super::percent;
use crate::{Report, Trend};
use kinefront_model::mechanism::{Architecture, DesignVariable};

/// Judges the claim that a variable is linear in `R_w`: the CSS class of the verdict, and its words. `None` without a fit.
fn linear_verdict(trend: &Trend) -> Option<(&'static str, String)> {
    let r_squared = trend.linear.as_ref()?.r_squared;
    let (class, word) = match r_squared {
        r if r >= 0.95 => ("holds", "holds"),
        r if r >= 0.8 => ("partly", "holds roughly"),
        _ => ("fails", "does not hold"),
    };
    Some((class, format!("{r_squared:.2}, {word}")))
}

/// Judges in the same way the claim that a variable is quadratic in `R_w`.
fn quadratic_verdict(trend: &Trend) -> Option<(&'static str, String)> {
    let (class, words) = match trend.is_quadratic()? {
        true => ("holds", "holds"),
        false => ("fails", "an upward parabola is not clearly better"),
    };
    let [parabola, line] = [trend.quadratic.as_ref()?, trend.linear.as_ref()?].map(|fit| fit.r_squared);
    Some((class, format!("{parabola:.3} and {line:.3}, {words}")))
}

/// Returns the reason why there is no fit.
fn unknown(trend: &Trend) -> &'static str {
    if trend.free.len() < trend.points.len() {
        "the variable is at a bound"
    } else {
        "too few designs"
    }
}

/// Iterates over the trends of all variables along the fronts of all architectures.
fn trends(report: &Report) -> impl Iterator<Item = (&Architecture, &Trend)> {
    let of_each = report.trends.iter();
    of_each.flat_map(|(architecture, trends)| trends.iter().map(move |trend| (architecture, trend)))
}

/// Lists how well fits to the bars of the platform or to the other variables hold, or why there is no fit.
fn fits(report: &Report, to_platform_bars: bool, judge: fn(&Trend) -> Option<(&'static str, String)>) -> Markup {
    let is_listed = |(_, trend): &(&Architecture, &Trend)| {
        (trend.variable == DesignVariable::PlatformBarRadius) == to_platform_bars
    };
    html! {
        @for (index, (architecture, trend)) in trends(report).filter(is_listed).enumerate() {
            @if index > 0 { "; " }
            @if !to_platform_bars { (trend.variable.symbol()) " of the " }
            (architecture) " "
            @match judge(trend) {
                Some((class, words)) => span class=(class) { (words) }
                None => (unknown(trend))
            }
        }
    }
}

/// Checks the claims of the paper.
pub(super) fn claims(report: &Report) -> Markup {
    html! { div.scroll { table {
        thead { tr { th { "claim of the paper" } th { "result here" } } }
        tbody {
            (comparisons(report))
            tr {
                td { "Every design variable increases with R_w." }
                @let ranked: Vec<_> = trends(report).filter_map(|(architecture, trend)| Some((architecture, trend, trend.rank_correlation?))).collect();
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
                td { "R² of straight lines: " (fits(report, false, linear_verdict)) }
            }
            tr {
                td { "r_p is quadratic rather than linear in R_w." }
                td { "R² of the parabola and of the straight line: " (fits(report, true, quadratic_verdict)) }
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
