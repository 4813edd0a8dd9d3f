//! What the motion of the study asks of designs of the fronts.

use maud::{Markup, html};

use super::{cell, optional};
use crate::Report;
use crate::motions::{DesignMotion, MotionFigures};
use kinefront_model::certify::MotionVerdict;
use kinefront_scene::text::{self, number};

pub(super) fn motion(report: &Report) -> Markup {
    let question = &report.question;
    let has_drives = !report.model.settings().drive_catalogue.is_empty();
    html! {
        p {
            "Designs of the fronts follow the motion of the study. The shortest cycle is the one in which a design just keeps all limits of the motion, with the same path and the same rests; a \
             shorter one would miss the limit that is named. A motion is proved if it is followed, with all its limits of speed, force and distance, at \
             every moment and not only at its samples."
        }
        @if let Some(sentence) = fastest(report) { p { (sentence) } }
        div.scroll { table {
            caption { "Of the three actuators, the one that has to give most counts." }
            thead { tr {
                th { "design" }
                @for objective in 0..question.objectives.len() { th.number { (question.label(objective)) } }
                th.number { "cycle [s]" } th.number { "speed" } th.number { "force" } th.number { "RMS force" }
                th.number { "power [W]" } th.number { "energy [J]" }
                @if has_drives { th { "drive" } }
                th.number { "shortest cycle [s]" } th { "set by" } th { "at every moment" }
            } }
            tbody { @for motion in &report.motions { tr {
                td { (text::architecture(motion.architecture())) }
                @for value in &motion.objectives { (cell(*value)) }
                @match &motion.figures {
                    Some(figures) => (asked(motion, figures)),
                    None => { td colspan="6" { "does not follow it" } }
                }
                @if has_drives { td { (motion.drive.as_deref().unwrap_or("none")) } }
                (optional(motion.shortest.map(|shortest| shortest.time)))
                td { (motion.shortest.map_or("–", |shortest| shortest.limit.quantity.entry().label)) }
                td { (motion.proof.as_ref().map_or("–", MotionVerdict::name)) }
            } } }
        } }
    }
}

/// Tabulates what the motion asks of the actuators of a design.
fn asked(motion: &DesignMotion, figures: &MotionFigures) -> Markup {
    let (unit, effort) = (motion.actuator().unit(), motion.actuator().effort_unit());
    html! {
        (cell(figures.cycle_time))
        td.number { (number(figures.speed)) " " (unit) "/s" }
        td.number { (number(figures.force)) " " (effort) }
        td.number { (number(figures.rms_force)) " " (effort) }
        (cell(figures.power))
        (cell(figures.energy))
    }
}

/// Says which design allows the shortest cycle, and what sets it.
fn fastest(report: &Report) -> Option<String> {
    let with_cycle = report
        .motions
        .iter()
        .filter_map(|motion| Some((motion, motion.shortest?)));
    let (motion, shortest) = with_cycle.min_by(|a, b| a.1.time.total_cmp(&b.1.time))?;
    Some(format!(
        "The shortest cycle of these designs is {} s, that of a {} whose {} is {}{}. The limit of the {} sets it.",
        number(shortest.time),
        text::architecture(motion.architecture()),
        report.question.name(0),
        number(motion.objectives[0]),
        report.question.unit(0),
        shortest.limit.quantity.entry().label,
    ))
}
