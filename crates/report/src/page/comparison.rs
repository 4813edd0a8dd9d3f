//! The architectures side by side, where a study has two objectives.

use maud::{Markup, html};

use super::percent;
use crate::{Fronts, Question, Report, best_intervals};
use kinefront_model::mechanism::Architecture;
use kinefront_scene::text::{self, number, short};

/// Largest number of architectures each of which has a fact of its own.
const FEW: usize = 4;

/// Compares the first objective of the architectures at values of the second one.
pub(super) fn comparison(report: &Report) -> Markup {
    let (fronts, question) = (&report.fronts, &report.question);
    let Some(span) = question.span(&fronts.together) else {
        return html! {};
    };
    let compared = &question.objectives[1];
    let intervals = best_intervals(fronts, span.map(|value| compared.minimised(Some(value))));
    let intervals: Vec<(Architecture, [f64; 2])> = intervals
        .into_iter()
        .map(|(architecture, ends)| (architecture, ends.map(|end| compared.value(end))))
        .collect();
    let fractions = fronts.alone.iter().map(|(architecture, _)| {
        let of = intervals.iter().filter(|(winner, _)| winner == architecture);
        let width: f64 = of.map(|(_, [from, to])| (to - from).abs()).sum();
        (*architecture, width / (span[1] - span[0]).abs().max(f64::MIN_POSITIVE))
    });
    let fractions: Vec<(Architecture, f64)> = fractions.collect();
    // Of many architectures, most are nowhere the best.
    let is_shown = |(_, fraction): &&(Architecture, f64)| fractions.len() <= FEW || *fraction > 0.0;
    let shown: Vec<(Architecture, f64)> = fractions.iter().filter(is_shown).copied().collect();
    let (cost, name) = (question.name(0), question.name(1));
    let unit = question.unit(1);
    html! {
        ul.facts {
            @for (architecture, fraction) in &shown {
                li { b { (percent(*fraction)) } span {
                    "of the range of " (name) " from " (number(span[0])) " to " (number(span[1])) (unit) ": the "
                    (text::architecture(*architecture)) " has the best " (cost)
                } }
            }
        }
        @if shown.len() < fractions.len() {
            p { "The other architectures (" (fractions.len() - shown.len()) ") are not the best at any value of " (name) "." }
        }
        (rails(report, &fractions))
        (motors(report, &fractions))
        (notation(&fractions))
        @if intervals.len() <= 12 {
            p {
                "The best architecture, in the order of improving " (name) ": "
                @for (index, (architecture, [from, to])) in intervals.iter().enumerate() {
                    @if index > 0 { "; " }
                    (text::architecture(*architecture)) " from " (number(*from)) " to " (number(*to)) (unit)
                }
                "."
            }
        }
        (at_levels(fronts, question))
    }
}

/// Tabulates the best first objective of each architecture at some values of the second one.
fn at_levels(fronts: &Fronts, question: &Question) -> Markup {
    let (name, bound) = (question.name(1), question.bound(1));
    html! {
        div.scroll { table {
            caption {
                "Best " (question.label(0)) " of the designs found whose " (name) " is " (bound) " the given one, verified "
                "on the fine grid. The number in brackets is the ratio to the best value of any architecture."
            }
            thead { tr {
                th.number { (question.label(1)) }
                @for (architecture, _) in &fronts.alone { th.number { (text::architecture(*architecture)) } }
                th { "best architecture" }
            } }
            tbody { @for level in question.levels(&fronts.together) {
                @let best = question.cost_at(&fronts.together, level);
                tr {
                    td.number { (short(level)) }
                    @for (_, front) in &fronts.alone {
                        td.number { @match question.cost_at(front, level) {
                            Some(found) => {
                                (number(found))
                                @if let Some(best) = best { " (" (format!("{:.2}", found / best)) ")" }
                            }
                            None => "–",
                        } }
                    }
                    td { @if let Some(best) = question.best_at(&fronts.together, level) { (text::architecture(best.design.architecture())) } }
                }
            } }
        } }
    }
}

/// Names the architectures that have a property, if only some of those that are compared have it.
fn names_of_some(fractions: &[(Architecture, f64)], has: impl Fn(Architecture) -> bool) -> Option<String> {
    let architectures = fractions.iter().map(|(architecture, _)| *architecture);
    let having = architectures.filter(|architecture| has(*architecture));
    let names: Vec<String> = having.map(text::architecture).collect();
    (!names.is_empty() && names.len() < fractions.len()).then(|| names.join(", "))
}

/// States what rails weigh and how they bend, where only some of the architectures have them.
fn rails(report: &Report, fractions: &[(Architecture, f64)]) -> Markup {
    let on_rails = names_of_some(fractions, |architecture| architecture.chain().is_on_rails());
    html! {
        @if let Some(on_rails) = on_rails {
            p {
                @if report.model.settings().rails.is_none() {
                    "Rails weigh nothing and do not bend in this study. This favours the architectures whose "
                    "first joint is prismatic (" (on_rails) ") in a comparison with the others."
                } @else {
                    "The mass includes the rails although they do not move, and the stiffness includes their bending (architectures whose first "
                    "joint is prismatic: " (on_rails) ")."
                }
            }
        }
    }
}

/// States which motors move, where those of only some of the architectures do, and motors weigh nothing.
fn motors(report: &Report, fractions: &[(Architecture, f64)]) -> Markup {
    let settings = report.model.settings();
    let moves = |architecture: Architecture| {
        settings
            .joints
            .of_leg(architecture)
            .any(|part| part.is_motor && part.moves)
    };
    let weigh_nothing = settings.joints.motor <= 0.0 && settings.drive_catalogue.is_empty();
    let moving = names_of_some(fractions, moves).filter(|_| weigh_nothing);
    html! {
        @if let Some(moving) = moving {
            p {
                "Motors weigh nothing in this study. This favours the architectures whose motors move with the legs (" (moving)
                ") in a comparison with the others."
            }
        }
    }
}

/// States how the actuated joint is marked, where the name of an architecture on the page has such a mark.
fn notation(fractions: &[(Architecture, f64)]) -> Markup {
    let mut architectures = fractions.iter().map(|(architecture, _)| *architecture);
    let underlined = architectures.find(|architecture| !Architecture::PAPER.contains(architecture));
    html! {
        @if let Some(underlined) = underlined {
            p { "The underlined joint is actuated; studies and tables write " (text::architecture(underlined)) " as " (underlined.name()) "." }
        }
    }
}
