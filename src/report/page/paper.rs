//! Comparison with the 2010 paper, in reports on its study: places of its figures and tables, differences of the numbers
//! and their causes, a check of its claims, and the points that it leaves open.

use maud::{Markup, html};

use super::references::active;
use super::results::{levels, unknown};
use super::{change, percent};
use crate::report::reference::lighter;
use crate::report::{Front, Report, Trend, Variation};
use crate::study::sensitivity::{Alternative, LARGER_PLATFORM, LARGER_TORQUE, ONE_PLATFORM_BAR};
use crate::text::number;
use kinefront_model::mechanism::{Architecture, DesignVariable};
use kinefront_optimize::hypervolume;

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

/// Tabulates the parameters that the paper gives for its algorithm, with the values used by MOGA-II (reimplementation).
pub(super) fn parameters(report: &Report) -> Markup {
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

/// Returns what the paper says about an alternative assumption, if it says anything.
pub(super) fn reason(alternative: &Alternative) -> Option<&'static str> {
    Some(match alternative.name {
        LARGER_PLATFORM => "the paper prints this bound, which excludes its own design I",
        LARGER_TORQUE => "the text of the paper has this torque, and its inequality has 10 N·m",
        ONE_PLATFORM_BAR => "the equation of the paper counts one bar",
        _ => return None,
    })
}

/// Returns the trend that the paper claims for a variable and the verdict on it.
pub(super) fn claim(trend: &Trend) -> Markup {
    let (what, word, class) = if trend.variable == DesignVariable::PlatformBarRadius {
        let (word, class) = trend
            .is_quadratic()
            .map_or_else(|| (unknown(trend), "partly"), quadratic_verdict);
        ("quadratic", word, class)
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

/// Computes the hypervolume of a front with respect to the reference mass of the study \[kg·m\].
fn volume(report: &Report, front: &Front) -> f64 {
    let members = front.members.iter();
    let objectives = members.map(|member| [member.mass, -member.workspace_radius]);
    hypervolume(objectives, report.study.hypervolume_reference())
}

/// Finds the variation under which the `R_w` of a reference design is nearest, by ratio, to the stated one; returns it
/// with that `R_w` \[m\].
fn nearest(report: &Report, place: usize, stated: f64) -> Option<(&Variation, f64)> {
    let off = |radius: f64| libm::log(radius.max(f64::MIN_POSITIVE) / stated).abs();
    let radii = report
        .variations
        .iter()
        .filter_map(|variation| Some((variation, *variation.references.get(place)?)));
    radii.min_by(|(_, a), (_, b)| off(*a).total_cmp(&off(*b)))
}

/// Relative difference of `R_w` from the printed value up to which the page gives no explanation.
const NEAR: f64 = 0.05;

/// Explains where and why the numbers differ from those of the paper, and checks its claims.
pub(super) fn differences(report: &Report) -> Markup {
    let masses_agree = report.references.iter().all(|reference| {
        let [low, high] = reference.mass_range;
        reference.stated_mass.is_none_or(|mass| (low..=high).contains(&mass))
    });
    html! {
        ol {
            li {
                strong { "Masses. " }
                @if masses_agree { "Every printed mass lies in the range that follows from bar radii rounded to a millimetre." }
                @else { "Not every printed mass lies in the range that follows from bar radii rounded to a millimetre." }
                " The mass of the platform is that of three bars: the printed equation has one, but the printed masses require three."
            }
            @for (place, reference) in report.references.iter().enumerate() {
                @if let Some(stated) = reference.stated_radius {
                    li {
                        strong { "Workspace of " (reference.name) ". " }
                        @let ratio = reference.fine.workspace_radius / stated;
                        "Printed " (number(stated)) " m, here " (number(reference.fine.workspace_radius)) " m (" (change(ratio)) "); "
                        "the workspace is limited by " (active(&reference.fine)) ". "
                        @if (ratio - 1.0).abs() > NEAR {
                            @if let Some((variation, radius)) = nearest(report, place, stated) {
                                @if variation.alternative.is_none() { "None of the alternative assumptions tried below comes closer. " }
                                @else {
                                    "Of the alternative assumptions tried below, “" (variation.name()) "” comes closest by ratio, with "
                                    (number(radius)) " m (" (change(radius / stated)) "). "
                                }
                            }
                            "The cause of the difference is not known, and no constant of the model was adjusted to remove it. "
                        }
                    }
                }
            }
            @if report.references.iter().any(|reference| reference.lighter.is_some()) { li {
                strong { "Lighter designs exist. " }
                @for reference in &report.references {
                    @if let Some(found) = &reference.lighter {
                        "With at least the workspace of " (reference.name) ": " (number(found.mass)) " kg instead of "
                        (number(reference.fine.mass)) " kg. "
                    }
                }
                @if let Some(moga2_front) = report.moga2.as_ref().and_then(|moga2| moga2.joint.as_ref()) {
                    "A reimplementation of MOGA-II, based on what is publicly known of it (grey in the figures), with the "
                    "settings of the paper, all architectures together and the same number of evaluations per search, "
                    "reaches " (percent(volume(report, moga2_front) / volume(report, &report.fronts.together)))
                    " of the hypervolume of the front of all architectures found here. "
                    @for reference in &report.references {
                        @if let Some(found) = lighter(moga2_front, &reference.fine) {
                            "With at least the workspace of " (reference.name) ", it finds " (number(found.mass)) " kg. "
                        }
                    }
                    "Under this model, therefore, the search of the paper had not converged, or the model of the paper had requirements "
                    "that the paper does not state."
                }
            } }
        }
        h3 { "Claims of the paper and results of this report" }
        (claims(report))
        h3 { "Where the paper is silent or contradicts itself" }
        (silences())
    }
}

fn claims(report: &Report) -> Markup {
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
        .map(|reference| reference.fine.design.architecture)
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
            @let ratios: Vec<f64> = levels(fronts.together.largest()).into_iter().filter_map(|level| {
                Some(front.lightest(level)?.mass / fronts.of(best)?.lightest(level)?.mass)
            }).collect();
            @let low = ratios.iter().copied().fold(f64::INFINITY, f64::min);
            @let high = ratios.iter().copied().fold(0.0, f64::max);
            tr {
                td { "The " (best) " is better than the " (architecture) "." }
                @if ratios.is_empty() {
                    td { "not compared: at no radius do this architecture and the " (best) " both have a design" }
                } @else {
                    @let class = if low > 1.0 { "holds" } else if high > 1.0 { "partly" } else { "fails" };
                    (judged(class, format!("the {architecture} is {low:.2} to {high:.2} times as heavy at the radii of the first table")))
                }
            }
        }
    }
}

/// Points on which the paper is silent or contradicts itself, each with the choice made here.
const SILENCES: [(&str, &str); 11] = [
    (
        "The printed mass of the platform is that of one bar; the printed table of designs requires three.",
        "three bars",
    ),
    (
        "τ_z is 100 N·m in the text, but 10 N·m in the inequality and in g6.",
        "10 N·m",
    ),
    (
        "The table of bounds has r ≥ 0.5 m, but design I has r = 0.319 m.",
        "r ≥ 0.1 m",
    ),
    (
        "The stiffness of the actuators is not given.",
        "1e7 N/m and 1e7 N·m/rad, inferred: the printed R_w of designs II and III require 0.86e7 and 1.14e7",
    ),
    (
        "k_xy, k_z and k_φz are not defined.",
        "k_xy: smaller eigenvalue of the xy block of K; k_z and k_φz: diagonal entries of K",
    ),
    ("The characteristic length is not given.", "r"),
    (
        "The home orientation and the centre of the workspace are not given.",
        "the orientation that gives the largest workspace; centre O",
    ),
    ("G is not given.", "80 GPa"),
    (
        "The length of the beam that models a telescopic leg is not given.",
        "the current length of the leg",
    ),
    (
        "g2 has the travel of the 3-PRR for every architecture, but the text gives the 3-RPR its own range.",
        "for every architecture, the limits of its own legs",
    ),
    (
        "The grid on which poses are checked is not given.",
        "search on a reference grid, verification on a fine grid; both are settings of the study",
    ),
];

fn silences() -> Markup {
    html! { div.scroll { table {
        thead { tr { th.number { "#" } th { "paper" } th { "choice here" } } }
        tbody { @for (index, (paper, here)) in SILENCES.iter().enumerate() {
            tr { td.number { (index + 1) } td { (paper) } td { (here) } }
        } }
    } }
    p { "Every choice except the joint limits of the 3-PRR and 3-RRR is a setting of the study file." } }
}
