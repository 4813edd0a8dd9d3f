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
            "The table lists designs of the fronts and what the motion of the study requires of their actuators. In the shortest cycle, a design just \
             satisfies all limits of the motion, with the same path and the same rests; a shorter cycle would violate the limit of the limiting \
             quantity. A motion is proved if the design follows it within all its limits of speed, force and distance at every moment, not only \
             at its samples; it is refuted if this is wrong at some moment, and otherwise open."
        }
        @if let Some(sentence) = fastest(report) { p { (sentence) } }
        div.scroll { table {
            caption {
                "Speed, force and RMS force are the largest of the three actuators. Power is the largest force times the largest speed. "
                "Energy is that of all three drives per cycle; they share the energy that they recover."
            }
            thead { tr {
                th { "architecture" }
                @for objective in 0..question.objectives.len() { th.number { (question.label(objective)) } }
                th.number { "cycle [s]" } th.number { "speed" } th.number { "force" } th.number { "RMS force" }
                th.number { "power [W]" } th.number { "energy [J]" }
                @if has_drives { th { "drive" } }
                th.number { "shortest cycle [s]" } th { "limiting quantity" } th { "proof" }
            } }
            tbody { @for motion in &report.motions { tr {
                td { (text::architecture(motion.architecture())) }
                @for value in &motion.objectives { (cell(*value)) }
                @match &motion.figures {
                    Some(figures) => (asked(motion, figures)),
                    None => { td colspan="6" { "does not follow the motion" } }
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
