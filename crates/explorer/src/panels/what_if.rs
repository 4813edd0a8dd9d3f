//! A modified design beside the one that it was modified from: what changed, the way back, and a verdict in one line.

use egui::{Color32, RichText, Ui};
use kinefront_model::certify::Verdict;
use kinefront_model::mechanism::{Design, DesignVariable};
use kinefront_scene::text;
use kinefront_study::{Column, Row};

use super::button;
use crate::{DesignOrigin, Known, Session, theme};

/// Returns the design of the run from which the selected one was modified, with its id.
pub(super) fn original(session: &Session) -> Option<(usize, Row)> {
    match session.document().selected.as_ref()?.origin {
        DesignOrigin::Modified { from: Some(id) } => Some((id, session.row(id)?)),
        _ => None,
    }
}

/// Tells what a variable was before, and by how much it changed; nothing if it did not.
pub(super) fn change(ui: &mut Ui, variable: DesignVariable, value: f64, original: Option<&Design>) {
    let Some(before) = original.map(|original| original.value(variable)) else {
        return;
    };
    if before == value {
        return;
    }
    let was = text::variable_value(variable, before);
    let percent = 100.0 * (value / before - 1.0);
    let words = match !variable.is_angle() && percent.is_finite() {
        true => format!("was {was}, {percent:+.1} %"),
        false => format!("was {was}"),
    };
    ui.weak(words);
}

/// Shows a button back to the design from which the selected one was modified.
pub(super) fn back(ui: &mut Ui, session: &mut Session) {
    let hint = "selects the design from which this one was modified";
    if let Some((id, _)) = original(session)
        && button(ui, format!("Back to #{id}"), hint)
    {
        session.select(id);
    }
}

/// Returns what is proved about the workspace of the selected design, in a word with its colour, once it is known. What the front reports
/// is the proved radius, whatever the fine grid gave.
pub(super) fn proof_in_a_word(ui: &Ui, session: &Session) -> Option<(Color32, &'static str)> {
    if session.certified().is_some_and(|certified| certified.is_proved) {
        return Some((theme::good(ui), "proved"));
    }
    Some(match session.proof()?.certificate.verdict {
        Verdict::Proved => (theme::good(ui), "proved"),
        Verdict::Refuted => (theme::bad(ui), "refuted"),
        Verdict::OpenBudget | Verdict::OpenPrecision => (theme::active(ui), "open"),
    })
}

/// Tells in one line whether the selected design is feasible, proved, and free of collisions, and what changed of the quantities of the study.
pub(super) fn verdict(ui: &mut Ui, session: &Session, known: &Known) {
    let evaluation = &known.evaluation;
    ui.horizontal_wrapped(|ui| {
        match evaluation.is_feasible() {
            true => ui.colored_label(theme::good(ui), RichText::new("feasible").strong()),
            false => ui.colored_label(theme::bad(ui), RichText::new("infeasible").strong()),
        };
        if evaluation.is_feasible() && session.study().workspace.certify {
            match proof_in_a_word(ui, session) {
                Some((color, word)) => ui.colored_label(color, word),
                None => ui.weak("proving…"),
            };
        }
        match evaluation.clearance() {
            Some(clearance) if clearance < 0.0 => {
                let words = format!("members overlap by {:.0} mm", -1e3 * clearance);
                ui.colored_label(theme::bad(ui), words);
            }
            Some(clearance) => {
                ui.label(format!("{:.0} mm clear", 1e3 * clearance));
            }
            None => {}
        }
    });
    let Some((id, before)) = original(session) else { return };
    let changes = session.study().shown_quantities().into_iter().filter_map(|quantity| {
        let was = before.number(Column::Quantity(quantity))?;
        let is = evaluation.quantities.get(quantity)?;
        let percent = 100.0 * (is / was - 1.0);
        percent.is_finite().then(|| {
            let entry = quantity.entry();
            format!("{} {} {} ({percent:+.1} %)", entry.short, theme::number(is), entry.unit)
        })
    });
    let changes: Vec<String> = changes.collect();
    if !changes.is_empty() {
        ui.label(format!("instead of #{id}: {}", changes.join(", ")));
    }
}
