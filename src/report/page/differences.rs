//! Against a study's references: the table, the reasons, and what other readings would change.

use maud::{Markup, html};

use super::results::{levels, verdict};
use super::{cell, change, figures, optional, percent};
use crate::mechanism::{VARIABLES, Variable};
use crate::optimize::hypervolume;
use crate::report::{Fronts, Reference, Report, Variation};
use crate::text::{number, short};

pub(super) fn references(report: &Report) -> Markup {
    let stated = |reference: &Reference| {
        let design = &reference.fine.design;
        html! { tr {
            td { (reference.name) } td { (design.architecture) }
            @for value in design.values() { (cell(value)) }
            (optional(reference.stated_mass)) (cell(reference.fine.mass))
            td.number { (number(reference.mass_range[0])) " … " (number(reference.mass_range[1])) }
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
                    th.number { "mass, stated" } th.number { "mass" } th.number { "within rounding of the bars" }
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
                    None => { td colspan="9" { "nothing lighter" } }
                }
            } } }
        } }
    }
}

fn active(reference: &Reference) -> String {
    let active: Vec<&str> = reference.fine.active().map(|constraint| constraint.id()).collect();
    active.join(", ")
}

/// Hypervolume of the fronts together, from the study's reference \[kg·m\].
fn volume(report: &Report, fronts: &Fronts) -> f64 {
    let members = fronts.together.members.iter();
    let objectives = members.map(|member| [member.mass, -member.workspace_radius]);
    hypervolume(objectives, [report.study.hypervolume.reference_mass_kg, 0.0])
}

/// The reading under which a reference design comes nearest to the `R_w` that is stated, and what it has there \[m\].
fn nearest(report: &Report, place: usize, stated: f64) -> Option<(&Variation, f64)> {
    let radii = report
        .variations
        .iter()
        .filter_map(|variation| Some((variation, *variation.references.get(place)?)));
    radii.min_by(|(_, a), (_, b)| (a - stated).abs().total_cmp(&(b - stated).abs()))
}

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
                        @if let Some((variation, radius)) = nearest(report, place, stated) {
                            @if variation.reading.is_none() { "No other reading tried below comes nearer. " }
                            @else {
                                "Of all readings tried below “" (variation.name()) "” comes nearest, with " (number(radius)) " m ("
                                (change(radius / stated)) "). "
                            }
                            @if (radius / stated - 1.0).abs() > 0.05 { "So the cause is not known; no constant was bent for it. " }
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
                @if let Some(rivals) = &report.rivals {
                    "So does an algorithm after what is publicly known of MOGA-II with the paper's settings and as many evaluations (grey in the figures): "
                    @for reference in &report.references {
                        @if let Some(found) = rivals.together.lightest(reference.fine.workspace_radius) {
                            (number(found.mass)) " kg for " (reference.name) ", "
                        }
                    }
                    "and " (percent(volume(report, rivals) / volume(report, &report.fronts))) " of the hypervolume found here. "
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
    let best = report
        .references
        .first()
        .map(|reference| reference.fine.design.architecture);
    let together = &report.fronts.together;
    let share = best.map(|best| {
        let of = together
            .members
            .iter()
            .filter(|member| member.design.architecture == best);
        of.count() as f64 / together.members.len() as f64
    });
    let trends = || {
        report
            .trends
            .iter()
            .flat_map(|(architecture, trends)| trends.iter().map(move |trend| (architecture, trend)))
    };
    let word = |class: &'static str, words: String| html! { td { span class=(class) { (words) } } };
    html! { div.scroll { table {
        thead { tr { th { "the paper" } th { "here" } } }
        tbody {
            @if let (Some(best), Some(share)) = (best, share) {
                tr {
                    td { "All Pareto-optimal designs of the three together are " (best) "." }
                    @let class = if share == 1.0 { "holds" } else if share > 0.5 { "partly" } else { "fails" };
                    (word(class, format!("{} of the front are", percent(share))))
                }
                @for (architecture, front) in report.fronts.alone.iter().filter(|(architecture, _)| *architecture != best) {
                    @let ratios: Vec<f64> = levels(together.largest()).into_iter().filter_map(|level| {
                        Some(front.lightest(level)?.mass / report.fronts.of(best)?.lightest(level)?.mass)
                    }).collect();
                    @let low = ratios.iter().copied().fold(f64::INFINITY, f64::min);
                    @let high = ratios.iter().copied().fold(0.0, f64::max);
                    tr {
                        td { "The " (best) " is better than the " (architecture) "." }
                        @let class = if low > 1.0 { "holds" } else if high > 1.0 { "partly" } else { "fails" };
                        (word(class, format!("the {architecture} weighs {low:.2} to {high:.2} times as much at the radii of the first table")))
                    }
                }
            }
            tr {
                td { "The larger R_w, the larger every design variable." }
                @let ranked: Vec<_> = trends().filter_map(|(architecture, trend)| Some((architecture, trend, trend.rank_correlation?))).collect();
                @if let Some((architecture, trend, least)) = ranked.iter().min_by(|a, b| a.2.total_cmp(&b.2)) {
                    @let class = if *least > 0.95 { "holds" } else if *least > 0.6 { "partly" } else { "fails" };
                    (word(class, format!(
                        "rank correlation at least {least:.2} ({} of the {architecture}); {} of {} above 0.95, variables at a bound left out",
                        trend.variable.symbol(), ranked.iter().filter(|(.., value)| *value > 0.95).count(), ranked.len(),
                    )))
                }
            }
            @for (quadratic, words) in [(false, "R, r, L_b and r_j are almost linear in R_w."), (true, "r_p is rather quadratic in R_w.")] {
                tr {
                    td { (words) }
                    td {
                        @for (index, (architecture, trend)) in trends()
                            .filter(|(_, trend)| (trend.variable == Variable::PlatformBarRadius) == quadratic)
                            .filter(|(_, trend)| trend.linear.is_some() && trend.quadratic.is_some())
                            .enumerate()
                        {
                            @if index > 0 { "; " }
                            @let fit = if quadratic { &trend.quadratic } else { &trend.linear };
                            @if let Some(fit) = fit {
                                @let (_, class) = verdict(fit.r_squared);
                                (trend.variable.symbol()) " of the " (architecture) " "
                                span class=(class) { (format!("{:.2}", fit.r_squared)) }
                                @if let (true, Some(line)) = (quadratic, &trend.linear) { (format!(" (a line {:.2})", line.r_squared)) }
                            }
                        }
                        " (R²)"
                    }
                }
            }
        }
    } } }
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

pub(super) fn sensitivity(report: &Report) -> Markup {
    let Some((base, others)) = report.variations.split_first() else {
        return html! {};
    };
    let evaluations = report.options.sensitivity.unwrap_or_default();
    html! {
        p {
            "Every architecture searched anew, alone, with " (evaluations) " evaluations under each reading, and its front verified on the fine grid. "
            "The reading “another seed” shows how much of a difference is chance."
        }
        (figures(report, "sensitivity"))
        @for (architecture, front) in &base.alone {
            @let levels: Vec<f64> = levels(front.largest()).into_iter().skip(1).step_by(2).collect();
            h3 { (architecture) }
            div.scroll { table {
                caption { "Mass of the lightest design with at least this R_w, and the largest R_w found, against the study as stated." }
                thead { tr {
                    th { "reading" } @for level in &levels { th.number { "R_w ≥ " (short(*level)) " m" } } th.number { "largest R_w" } th { "what it means" }
                } }
                tbody {
                    tr {
                        td { (base.name()) }
                        @for level in &levels { td.number { (front.lightest(*level).map(|found| number(found.mass)).unwrap_or_default()) " kg" } }
                        td.number { (number(front.largest())) " m" }
                        td { "the study" }
                    }
                    @for variation in others { (varied(variation, *architecture, front, &levels)) }
                }
            } }
        }
        @if !report.references.is_empty() {
            h3 { "Reference designs" }
            div.scroll { table {
                caption { "R_w of the reference designs on the fine grid [m]." }
                thead { tr { th { "reading" } @for reference in &report.references { th.number { (reference.name) } } } }
                tbody {
                    @if report.references.iter().any(|reference| reference.stated_radius.is_some()) {
                        tr { td { "as printed" } @for reference in &report.references { (optional(reference.stated_radius)) } }
                    }
                    @for variation in report.variations.iter().filter(|variation| variation.moves_designs()) {
                        tr { td { (variation.name()) } @for radius in &variation.references { (cell(*radius)) } }
                    }
                }
            } }
        }
    }
}

fn varied(
    variation: &Variation,
    architecture: crate::mechanism::Architecture,
    base: &crate::report::Front,
    levels: &[f64],
) -> Markup {
    let front = variation.of(architecture);
    html! { tr {
        td { (variation.name()) }
        @match front {
            Some(front) => {
                @for &level in levels {
                    td.number { @match front.lightest(level).zip(base.lightest(level)) {
                        Some((found, base)) => (change(found.mass / base.mass)),
                        None => "not reached",
                    } }
                }
                td.number { (change(front.largest() / base.largest())) }
            }
            None => { td colspan=(levels.len() + 1) { "nothing feasible" } }
        }
        td { (variation.reading.map(|reading| reading.meaning).unwrap_or_default()) }
    } }
}
