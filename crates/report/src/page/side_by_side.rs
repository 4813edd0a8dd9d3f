//! The page of runs of different studies side by side.

use maud::{Markup, html};

use super::{Section, change, drawing, section};
use crate::SideBySide;
use kinefront_model::evaluation::Better;
use kinefront_scene::text::{number, short};
use kinefront_study::EqualLevel;

/// Returns the sections of the page.
pub(super) fn sections(found: &SideBySide) -> Vec<Section> {
    let mut sections = vec![section("differences", "What differs", differences(found))];
    if !found.figures.is_empty() {
        sections.push(section("fronts", "Fronts", fronts(found)));
    }
    if !found.levels.is_empty() {
        sections.push(section("levels", "Comparison of the best values", levels(found)));
    }
    sections.push(section("made", "How this page was made", made(found)));
    sections
}

fn differences(found: &SideBySide) -> Markup {
    let (first, others) = (&found.runs[0], &found.runs[1..]);
    html! {
        @for (other, differences) in others.iter().zip(&found.differences) {
            @if differences.is_empty() {
                p { (first.name) " and " (other.name) " state the same problem." }
            } @else {
                div.scroll { table {
                    caption { "Settings in which the studies differ, apart from those of the search." }
                    thead { tr { th { "key" } th { (first.name) } th { (other.name) } } }
                    tbody { @for difference in differences { tr {
                        td { code { (difference.key) } }
                        @for value in &difference.values { td { (value.as_deref().unwrap_or("–")) } }
                    } } }
                } }
            }
        }
    }
}

fn fronts(found: &SideBySide) -> Markup {
    html! {
        div.figures { @for figure in &found.figures {
            figure id={ "figure-" (figure.name) } { (drawing(figure)) figcaption { (figure.caption) } }
        } }
    }
}

/// Tabulates the first objective of each front at equal values of the second one.
fn levels(found: &SideBySide) -> Markup {
    let first = found.objectives[0].quantity.entry();
    html! {
        @for other in 1..found.runs.len() {
            @if let Some(sentence) = compared(found, other) { p { (sentence) } }
        }
        div.scroll { table {
            caption {
                "Best " (first.label) " [" (first.unit) "]"
                @if let Some(second) = found.objectives.get(1) {
                    @let bound = match second.goal { Better::Lower => "at most", Better::Higher => "at least" };
                    " of the designs whose " (second.quantity.entry().label) " is " (bound) " the given one"
                }
                ", with the change relative to " (found.runs[0].name) "."
            }
            thead { tr {
                @if let Some(second) = found.objectives.get(1) { th.number { (second.quantity.entry().label) " [" (second.quantity.entry().unit) "]" } }
                @for (place, run) in found.runs.iter().enumerate() {
                    th.number { (run.name) }
                    @if place > 0 { th.number { "change" } }
                }
            } }
            tbody { @for level in &found.levels { tr {
                @if let Some(at) = level.at { td.number { (short(at)) } }
                @for (place, cost) in level.costs.iter().enumerate() {
                    td.number { (cost.map_or_else(|| "not reached".to_owned(), number)) }
                    @if place > 0 { td.number { @if let (Some(cost), Some(base)) = (cost, level.costs[0]) { (change(cost / base)) } } }
                }
            } } }
        } }
    }
}

/// Says in words how the front of a run lies to that of the first one.
fn compared(found: &SideBySide, other: usize) -> Option<String> {
    let second = found.objectives.get(1)?;
    let (entry, names) = (second.quantity.entry(), [&found.runs[0].name, &found.runs[other].name]);
    let at = |level: &EqualLevel| Some([level.at?, level.costs[other]? / level.costs[0]?]);
    let ratios: Vec<[f64; 2]> = found.levels.iter().filter_map(at).collect();
    let least = ratios.iter().min_by(|a, b| a[1].total_cmp(&b[1]))?;
    let most = ratios.iter().max_by(|a, b| a[1].total_cmp(&b[1]))?;
    let place = |[level, ratio]: &[f64; 2]| format!("{} at {} {}", change(*ratio), short(*level), entry.unit);
    let mut words = format!(
        "The {} of {} differs from that of {} by {} to {}.",
        found.objectives[0].quantity.entry().label,
        names[1],
        names[0],
        place(least).trim_end(),
        place(most).trim_end()
    );
    for (run, name) in [(0, names[0]), (other, names[1])] {
        let missed: Vec<f64> = found
            .levels
            .iter()
            .filter(|level| level.costs[run].is_none() && level.costs.iter().any(Option::is_some))
            .filter_map(|level| level.at)
            .collect();
        if let Some(first) = missed.first() {
            let level = format!("{} {}", short(*first), entry.unit);
            let more = if missed.len() > 1 { " and beyond" } else { "" };
            words += &format!(" {name} has no design at {}{more}.", level.trim_end());
        }
    }
    Some(words)
}

fn made(found: &SideBySide) -> Markup {
    html! {
        p {
            "This page was made by Kinefront " (env!("CARGO_PKG_VERSION")) ". The fronts are those of " code { "front.csv" }
            " of each run. Runs of the same study are combined in one report instead."
        }
        pre { code { (found.command) } }
        div.scroll { table {
            caption { "The runs." }
            thead { tr { th { "run" } th { "study" } th { "algorithm" } th.number { "evaluations" } th.number { "random seed" } th.number { "designs" } } }
            tbody { @for run in &found.runs { tr {
                td { (run.name) } td { (run.study.name) } td { (run.study.optimizer.algorithm) }
                td.number { (run.study.optimizer.evaluations) } td.number { (run.study.optimizer.seed) } td.number { (run.front.len()) }
            } } }
        } }
    }
}
