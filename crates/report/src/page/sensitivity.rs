//! Sensitivity of fronts and reference designs to assumptions.

use maud::{Markup, html};

use super::{change, figures, optional};
use crate::{Front, Question, Report, Topic, Variation};
use kinefront_model::mechanism::Architecture;
use kinefront_scene::text::{number, short};
use kinefront_study::Column;
use kinefront_study::sensitivity::{ALTERNATIVES, AS_STATED, Alternative};

pub(super) fn sensitivity(report: &Report) -> Markup {
    html! {
        @if !report.nearby.is_empty() { (nearby(report)) }
        (searched(report))
    }
}

/// Tabulates what alternative assumptions change at designs of the fronts.
fn nearby(report: &Report) -> Markup {
    let question = &report.question;
    let objective = question.name(0);
    let compared = question.compared();
    html! {
        p {
            "Under each alternative assumption, a local optimization starts from designs of the fronts, with every pose of the region as a constraint"
            @if question.objectives.len() > 1 { " and the other objectives held" }
            ". The change of the " (objective) " is not due to the random seed, but a distant design may be better under the alternative. Alternatives "
            "that change none of these designs of an architecture are left out."
        }
        @for nearby in &report.nearby {
            h3 { (nearby.architecture) }
            div.scroll { table {
                caption { "Change of the " (objective) " of the local optimum near each design of the front." }
                thead { tr {
                    th { "assumption" }
                    @for design in &nearby.designs {
                        th.number { (question.name(compared)) " " (short(question.value(compared, design))) (question.unit(compared)) }
                    }
                    th { "meaning" }
                } }
                tbody {
                    tr {
                        td { (AS_STATED) }
                        @for stated in &nearby.stated { td.number { (number(*stated)) (question.unit(0)) } }
                        td {}
                    }
                    @for (alternative, found) in &nearby.changed { tr {
                        td { (alternative.name) }
                        @for (stated, found) in nearby.stated.iter().zip(found) { td.number { @match found {
                            Some(found) => (change(found / stated)),
                            None => "no optimum found",
                        } } }
                        td { (alternative.meaning) }
                    } }
                }
            } }
        }
    }
}

/// Tells how fronts that were searched again under alternative assumptions differ.
fn searched(report: &Report) -> Markup {
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
        h3 { "Repeated searches" }
        p {
            "Under each alternative assumption, every architecture is searched again on its own with " (evaluations)
            " evaluations, and its front is verified on the fine grid. Searches with other random seeds show how "
            "large the differences due to chance are; changes within their range are grey."
            @if !left_out.is_empty() {
                " Not tried, because the study already makes the assumption or is invalid with it: "
                (left_out.join(", ")) "."
            }
        }
        (figures(report, Topic::Sensitivity))
        @for (architecture, front) in &base.alone { (varied(report, others, *architecture, front)) }
        @if !report.references.is_empty() { (of_references(report)) }
    }
}

/// Tabulates how the reference designs change with the assumptions.
fn of_references(report: &Report) -> Markup {
    let quantity = report.question.objectives[1].quantity;
    html! {
        h3 { "Reference designs" }
        div.scroll { table {
            caption { (Column::Quantity(quantity).title()) " of the reference designs on the fine grid." }
            thead { tr { th { "assumption" } @for reference in &report.references { th.number { (reference.stated.name) } } } }
            tbody {
                @if report.references.iter().any(|reference| reference.stated(quantity).is_some()) {
                    tr { td { "stated by the source" } @for reference in &report.references { (optional(reference.stated(quantity))) } }
                }
                @for variation in report.variations.iter().filter(|variation| variation.affects_evaluation()) {
                    tr { td { (variation.name()) } @for found in &variation.references { (optional(found.quantities.get(quantity))) } }
                }
            }
        } }
    }
}

/// Returns the best value of the second objective on a front.
fn best_second(question: &Question, front: &Front) -> Option<f64> {
    front.best(1).map(|best| question.value(1, best))
}

/// Returns the ratios of a front to that of the unchanged study: of the first objective at each level, then of the best second one.
fn ratios_to(question: &Question, front: &Front, base: &Front, levels: &[f64]) -> Vec<Option<f64>> {
    let cost = |&level: &f64| Some(question.cost_at(front, level)? / question.cost_at(base, level)?);
    let of_best = best_second(question, front)
        .zip(best_second(question, base))
        .map(|(front, base)| front / base);
    levels.iter().map(cost).chain([of_best]).collect()
}

/// Returns the range of the ratios of each column over all seeds; it includes 1, the result of the unchanged study.
fn ranges(seeds: &[Vec<Option<f64>>], columns: usize) -> Vec<[f64; 2]> {
    let range = |column: usize| {
        let found = seeds.iter().filter_map(|ratios| ratios[column]);
        found.fold([1.0, 1.0], |[low, high]: [f64; 2], ratio| {
            [low.min(ratio), high.max(ratio)]
        })
    };
    (0..columns).map(range).collect()
}

/// Tabulates how the front of an architecture changes with the assumptions.
fn varied(report: &Report, variations: &[Variation], architecture: Architecture, base: &Front) -> Markup {
    let question = &report.question;
    let levels: Vec<f64> = question.levels(base).into_iter().skip(1).step_by(2).collect();
    let best = best_second(question, base);
    let ratios = |variation: &Variation| Some(ratios_to(question, variation.of(architecture)?, base, &levels));
    let seeds: Vec<Vec<Option<f64>>> = variations
        .iter()
        .filter(|other| other.is_chance())
        .filter_map(ratios)
        .collect();
    let chance = ranges(&seeds, levels.len() + 1);
    html! {
        h3 { (architecture) }
        div.scroll { table {
            caption {
                "Best " (question.name(0)) " of the designs whose " (question.name(1)) " is " (question.bound(1)) " the given one, and the best "
                (question.name(1)) " found, relative to the study as given."
            }
            thead { tr {
                th { "assumption" }
                @for level in &levels { th.number { (question.name(1)) " " (question.bound(1)) " " (short(*level)) (question.unit(1)) } }
                th.number { "best " (question.name(1)) } th { "meaning" }
            } }
            tbody {
                tr {
                    td { (AS_STATED) }
                    @for level in &levels { td.number { (question.cost_at(base, *level).map(number).unwrap_or_default()) (question.unit(0)) } }
                    td.number { (best.map(number).unwrap_or_default()) (question.unit(1)) }
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
                        td { @if let Some(alternative) = &variation.alternative { (alternative.meaning) } }
                    }
                }
            }
        } }
    }
}
