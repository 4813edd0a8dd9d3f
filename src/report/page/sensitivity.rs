//! Sensitivity of fronts and reference designs to assumptions.

use maud::{Markup, html};

use super::results::levels;
use super::{cell, change, figures, optional, paper};
use crate::report::{Front, Report, Variation};
use crate::study::sensitivity::{ALTERNATIVES, AS_STATED, Alternative};
use crate::text::{number, short};
use kinefront_model::mechanism::Architecture;

pub(super) fn sensitivity(report: &Report) -> Markup {
    let Some((base, others)) = report.variations.split_first() else {
        return html! {};
    };
    let evaluations = report.options.sensitivity.unwrap_or_default();
    let tried = |alternative: &&Alternative| others.iter().any(|other| other.name() == alternative.name);
    let left_out: Vec<&str> = ALTERNATIVES
        .iter()
        .filter(|alternative| !tried(alternative))
        .map(|alternative| alternative.name)
        .collect();
    html! {
        p {
            "Under each alternative assumption, every architecture is searched again on its own with " (evaluations)
            " evaluations, and its front is verified on the fine grid. Searches with other random seeds show how "
            "large the differences due to chance are; changes within their range are grey."
            @if !left_out.is_empty() {
                " Not tried, because the study already makes the assumption or is invalid with it: "
                (left_out.join(", ")) "."
            }
        }
        (figures(report, "sensitivity"))
        @for (architecture, front) in &base.alone { (varied(report, others, *architecture, front)) }
        @if !report.references.is_empty() {
            h3 { "Reference designs" }
            div.scroll { table {
                caption { "R_w of the reference designs on the fine grid [m]." }
                thead { tr { th { "assumption" } @for reference in &report.references { th.number { (reference.name) } } } }
                tbody {
                    @if report.references.iter().any(|reference| reference.stated_radius.is_some()) {
                        tr { td { "stated by the source" } @for reference in &report.references { (optional(reference.stated_radius)) } }
                    }
                    @for variation in report.variations.iter().filter(|variation| variation.affects_evaluation()) {
                        tr { td { (variation.name()) } @for radius in &variation.references { (cell(*radius)) } }
                    }
                }
            } }
        }
    }
}

/// Tabulates how the front of an architecture changes with the assumptions.
fn varied(report: &Report, variations: &[Variation], architecture: Architecture, base: &Front) -> Markup {
    let levels: Vec<f64> = levels(base.largest()).into_iter().skip(1).step_by(2).collect();
    // Ratios to the unchanged study: of the mass at each level, then of the largest radius.
    let ratios = |variation: &Variation| -> Option<Vec<Option<f64>>> {
        let front = variation.of(architecture)?;
        let mass = |&level: &f64| Some(front.lightest(level)?.mass / base.lightest(level)?.mass);
        let largest = Some(front.largest() / base.largest());
        Some(levels.iter().map(mass).chain([largest]).collect())
    };
    let seeds: Vec<Vec<Option<f64>>> = variations
        .iter()
        .filter(|other| other.is_chance())
        .filter_map(ratios)
        .collect();
    // The range includes 1, the result of the unchanged study.
    let chance: Vec<[f64; 2]> = (0..=levels.len())
        .map(|column| {
            let found = seeds.iter().filter_map(|ratios| ratios[column]);
            found.fold([1.0, 1.0], |[low, high]: [f64; 2], ratio| {
                [low.min(ratio), high.max(ratio)]
            })
        })
        .collect();
    html! {
        h3 { (architecture) }
        div.scroll { table {
            caption { "Mass of the lightest design with at least the given R_w, and the largest R_w found, relative to the study as given." }
            thead { tr {
                th { "assumption" }
                @for level in &levels { th.number { "R_w ≥ " (short(*level)) " m" } }
                th.number { "largest R_w" } th { "meaning" }
            } }
            tbody {
                tr {
                    td { (AS_STATED) }
                    @for level in &levels { td.number { (base.lightest(*level).map(|found| number(found.mass)).unwrap_or_default()) " kg" } }
                    td.number { (number(base.largest())) " m" }
                    td { }
                }
                @if !seeds.is_empty() {
                    tr.chance {
                        td { (seeds.len()) " other random seeds" }
                        @for [low, high] in &chance { td.number { (change(*low)) " … " (change(*high)) } }
                        td { "chance alone: the reference for all other changes" }
                    }
                }
                @for variation in variations.iter().filter(|variation| !variation.is_chance()) {
                    tr {
                        td { (variation.name()) }
                        @match ratios(variation) {
                            Some(ratios) => @for (ratio, [low, high]) in ratios.iter().zip(&chance) {
                                @match ratio {
                                    Some(ratio) => {
                                        @let class = if (*low..=*high).contains(ratio) { "number chance" } else { "number" };
                                        td class=(class) { (change(*ratio)) }
                                    }
                                    None => td.number { "not reached" }
                                }
                            },
                            None => td colspan=(levels.len() + 1) { "no feasible design" }
                        }
                        td { @if let Some(alternative) = &variation.alternative { (meaning(report, alternative)) } }
                    }
                }
            }
        } }
    }
}

/// Returns what an alternative assumption is and, in a report on the paper, what the paper says about it.
fn meaning(report: &Report, alternative: &Alternative) -> String {
    match paper::reason(alternative).filter(|_| report.of_paper) {
        Some(reason) => format!("{}; {reason}", alternative.meaning),
        None => alternative.meaning.to_owned(),
    }
}
