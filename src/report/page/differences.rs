//! Against a study's references and the paper: the table, the reasons, the claims.

use maud::{Markup, html};

use super::results::{levels, unknown, verdict};
use super::{cell, change, optional, percent};
use kinefront_model::mechanism::{Architecture, VARIABLES, Variable};
use kinefront_optimize::hypervolume;
use crate::report::{Front, Reference, Report, Variation};
use crate::text::number;

pub(super) fn references(report: &Report) -> Markup {
    let stated = |reference: &Reference| {
        let design = &reference.fine.design;
        html! { tr {
            td { (reference.name) } td { (design.architecture) }
            @for value in design.values() { (cell(value)) }
            (optional(reference.stated_mass)) (cell(reference.fine.mass))
            @if report.of_paper { td.number { (number(reference.mass_range[0])) " … " (number(reference.mass_range[1])) } }
            (optional(reference.stated_radius)) (cell(reference.coarse.workspace_radius)) (cell(reference.fine.workspace_radius))
            td { (active(reference)) }
        } }
    };
    html! {
        div.scroll { table {
            caption { "Masses in kg, lengths in m. “Stated” is what the source of the design prints, the rest is this model." }
            thead {
                tr {
                    th { "design" } th { "architecture" }
                    @for variable in VARIABLES { th.number { (variable.symbol()) } }
                    th.number { "mass, stated" } th.number { "mass" }
                    @if report.of_paper { th.number { "within rounding of the bars" } }
                    th.number { "R_w, stated" } th.number { "R_w, reference grid" } th.number { "R_w, fine grid" } th { "active" }
                }
            }
            tbody { @for reference in &report.references { (stated(reference)) } }
        } }
        h3 { "What was found instead" }
        div.scroll { table {
            caption { "The lightest design found with at least the workspace of each (fine grid)." }
            thead { tr {
                th { "instead of" } th.number { "mass" } th { "" } th { "architecture" }
                @for variable in VARIABLES { th.number { (variable.symbol()) } }
                th.number { "mass" } th.number { "R_w" } th.number { "of its mass" }
            } }
            tbody { @for reference in &report.references { tr {
                td { (reference.name) } (cell(reference.fine.mass)) td { "→" }
                @match &reference.beaten_by {
                    Some(found) => {
                        td { (found.design.architecture) }
                        @for value in found.design.values() { (cell(value)) }
                        (cell(found.mass)) (cell(found.workspace_radius))
                        td.number { (percent(found.mass / reference.fine.mass)) }
                    }
                    None => { td colspan="9" { @if reference.fine.is_feasible() { "nothing lighter" } @else { "not feasible here" } } }
                }
            } } }
        } }
    }
}

fn active(reference: &Reference) -> String {
    let active: Vec<&str> = reference.fine.active().map(|constraint| constraint.id()).collect();
    active.join(", ")
}

/// Hypervolume of a front, from the study's reference \[kg·m\].
fn volume(report: &Report, front: &Front) -> f64 {
    let members = front.members.iter();
    let objectives = members.map(|member| [member.mass, -member.workspace_radius]);
    hypervolume(objectives, [report.study.hypervolume.reference_mass_kg, 0.0])
}

/// The reading under which a reference design comes nearest, by the ratio, to the `R_w` that is stated, and what it has
/// there \[m\].
fn nearest(report: &Report, place: usize, stated: f64) -> Option<(&Variation, f64)> {
    let off = |radius: f64| libm::log(radius.max(f64::MIN_POSITIVE) / stated).abs();
    let radii = report
        .variations
        .iter()
        .filter_map(|variation| Some((variation, *variation.references.get(place)?)));
    radii.min_by(|(_, a), (_, b)| off(*a).total_cmp(&off(*b)))
}

/// How far an `R_w` may be from the printed one without calling for an explanation.
const NEAR: f64 = 0.05;

pub(super) fn explained(report: &Report) -> Markup {
    let masses_agree = report.references.iter().all(|reference| {
        let [low, high] = reference.mass_range;
        reference.stated_mass.is_none_or(|mass| (low..=high).contains(&mass))
    });
    html! {
        ol {
            li {
                strong { "Masses. " }
                @if masses_agree { "Every printed mass lies within what the printed bar radii, rounded to a millimetre, allow." }
                @else { "Not every printed mass lies within what the printed bar radii, rounded to a millimetre, allow." }
                " The platform counts three bars: the printed equation has one, the printed table needs three."
            }
            @for (place, reference) in report.references.iter().enumerate() {
                @if let Some(stated) = reference.stated_radius {
                    li {
                        strong { "Workspace of " (reference.name) ". " }
                        @let ratio = reference.fine.workspace_radius / stated;
                        "Printed " (number(stated)) " m, here " (number(reference.fine.workspace_radius)) " m (" (change(ratio)) "); "
                        (active(reference)) " stops it. "
                        @if (ratio - 1.0).abs() > NEAR {
                            @if let Some((variation, radius)) = nearest(report, place, stated) {
                                @if variation.reading.is_none() { "No other reading tried below comes nearer. " }
                                @else {
                                    "Of the readings tried below, “" (variation.name()) "” comes nearest by the ratio, with "
                                    (number(radius)) " m (" (change(radius / stated)) "). "
                                }
                            }
                            "Its cause is not known, and no constant was bent for it. "
                        }
                    }
                }
            }
            li {
                strong { "Far lighter designs exist. " }
                @for reference in &report.references {
                    @if let Some(found) = &reference.beaten_by {
                        "With at least the workspace of " (reference.name) ": " (number(found.mass)) " kg instead of "
                        (number(reference.fine.mass)) " kg. "
                    }
                }
                @if let Some(rival) = report.rivals.as_ref().and_then(|rivals| rivals.joint.as_ref()) {
                    "So does an algorithm after what is publicly known of MOGA-II, with the paper's settings, all architectures together and as many "
                    "evaluations (grey in the figures): "
                    @for reference in &report.references {
                        @if let Some(found) = rival.lightest(reference.fine.workspace_radius) {
                            (number(found.mass)) " kg for " (reference.name) ", "
                        }
                    }
                    "and " (percent(volume(report, rival) / volume(report, &report.fronts.together))) " of the hypervolume found here. "
                    "Under this model, then, the paper's search had not converged; or the paper's model asked for more than the paper says."
                }
            }
        }
        h3 { "What the paper says, and what is found" }
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
        thead { tr { th { "the paper" } th { "here" } } }
        tbody {
            (comparisons(report))
            tr {
                td { "The larger R_w, the larger every design variable." }
                @let ranked: Vec<_> = trends().filter_map(|(architecture, trend)| Some((architecture, trend, trend.rank_correlation?))).collect();
                @match ranked.iter().min_by(|a, b| a.2.total_cmp(&b.2)) {
                    Some((architecture, trend, least)) => {
                        @let class = if *least > 0.95 { "holds" } else if *least > 0.6 { "partly" } else { "fails" };
                        (judged(class, format!(
                            "rank correlation at least {least:.2} ({} of the {architecture}); {} of {} above 0.95, variables at a bound left out",
                            trend.variable.symbol(), ranked.iter().filter(|(.., value)| *value > 0.95).count(), ranked.len(),
                        )))
                    }
                    None => td { "too few designs to say" }
                }
            }
            tr {
                td { "R, r, L_b and r_j are almost linear in R_w." }
                td {
                    "R² of straight lines: "
                    @for (index, (architecture, trend)) in trends()
                        .filter(|(_, trend)| trend.variable != Variable::PlatformBarRadius)
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
                td { "r_p is rather quadratic in R_w." }
                td {
                    "R² of parabola and line: "
                    @for (index, (architecture, trend)) in trends()
                        .filter(|(_, trend)| trend.variable == Variable::PlatformBarRadius)
                        .enumerate()
                    {
                        @if index > 0 { "; " }
                        (architecture) " "
                        @match (&trend.quadratic, &trend.linear, trend.is_quadratic()) {
                            (Some(parabola), Some(line), Some(holds)) => {
                                @let (class, word) = if holds { ("holds", "holds") } else { ("fails", "a line does as well") };
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

/// A cell with a verdict in words and colour.
fn judged(class: &'static str, words: String) -> Markup {
    let verdict = match class {
        "holds" => "holds: ",
        "partly" => "partly: ",
        _ => "does not hold: ",
    };
    html! { td { span class=(class) { (verdict) } (words) } }
}

/// What the paper says of the architectures against each other.
fn comparisons(report: &Report) -> Markup {
    let fronts = &report.fronts;
    let Some(best) = report
        .references
        .first()
        .map(|reference| reference.fine.design.architecture)
    else {
        return html! {};
    };
    let class = |share: f64| {
        if share == 1.0 {
            "holds"
        } else if share > 0.5 {
            "partly"
        } else {
            "fails"
        }
    };
    let others = fronts.alone.iter().filter(|(architecture, _)| *architecture != best);
    html! {
        tr {
            td { "All Pareto-optimal designs of the three together are " (best) "." }
            @if fronts.alone.len() < Architecture::ALL.len() {
                td { "not compared: not all architectures were searched" }
            } @else {
                @let share = fronts.together.share(best);
                @let rival = report.rivals.as_ref().and_then(|rivals| rivals.joint.as_ref());
                (judged(class(share), format!(
                    "{} of all that is non-dominated here are{}{}", percent(share),
                    report.joint.as_ref().map(|joint| format!(", {} of the one search over all", percent(joint.share(best)))).unwrap_or_default(),
                    rival.map(|rival| format!(", {} of that after MOGA-II", percent(rival.share(best)))).unwrap_or_default(),
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
                    td { "not compared: there is no " (best) " here" }
                } @else {
                    @let class = if low > 1.0 { "holds" } else if high > 1.0 { "partly" } else { "fails" };
                    (judged(class, format!("the {architecture} weighs {low:.2} to {high:.2} times as much at the radii of the first table")))
                }
            }
        }
    }
}

/// What is open in the paper, and what was chosen.
const SILENCES: [(&str, &str); 11] = [
    (
        "The platform's mass is printed as that of one bar; the printed table needs three.",
        "three bars",
    ),
    ("τ_z is 100 N·m in the text, 10 in the inequality and in g6.", "10 N·m"),
    (
        "The table of bounds has r ≥ 0.5 m, but design I has 0.319 m.",
        "r ≥ 0.1 m",
    ),
    (
        "The actuators' stiffness is not given.",
        "1e7 N/m and 1e7 N·m/rad, inferred: the printed workspaces of designs II and III need 0.86e7 and 1.14e7",
    ),
    (
        "k_xy, k_z and k_φz are not defined.",
        "smaller eigenvalue of the xy block of K, and its diagonal entries",
    ),
    ("The characteristic length is not given.", "r"),
    (
        "Home posture and centre are not given.",
        "centre O; the orientation that gives the largest workspace",
    ),
    ("G is not given.", "80 GPa"),
    (
        "The beam length of a telescopic leg is not given.",
        "its current length",
    ),
    (
        "g2 is printed for the 3-PRR only.",
        "the leg's own limits for every architecture",
    ),
    (
        "The grid on which poses are checked is not given.",
        "searched on a reference grid, verified on a fine one; both are in the study",
    ),
];

fn silences() -> Markup {
    html! { div.scroll { table {
        thead { tr { th.number { "#" } th { "the paper" } th { "here" } } }
        tbody { @for (index, (paper, here)) in SILENCES.iter().enumerate() {
            tr { td.number { (index + 1) } td { (paper) } td { (here) } }
        } }
    } }
    p { "Each choice is a setting of the study file." } }
}
