//! The wish panel: what is wished of the selected design, and the nearest design that has it.

use std::collections::BTreeMap;

use egui::{Align, Checkbox, Grid, Layout, ScrollArea, Slider, Ui};
use kinefront_model::evaluation::{Bound, Evaluation, PoseScalar, Quantity};
use kinefront_model::mechanism::Design;
use kinefront_scene::text::number;
use kinefront_study::{Column, Condition, Wish, WishOutcome};

use super::{add_named, button_if, headings};
use crate::{Session, theme};

/// Range of the sliders \[%\].
const RANGE: [f64; 2] = [-50.0, 100.0];

/// Width \[points\] of the value of a slider and the box beside it.
const BESIDE_SLIDER: f32 = 130.0;

/// What is wished of a quantity.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Wanted {
    /// Change \[%\].
    change: f64,
    /// Whether it is not to become worse.
    keep: bool,
}

/// The wish panel.
#[derive(Default)]
pub struct WishPanel {
    /// The design of which something is wished.
    of: Option<Design>,
    wanted: BTreeMap<Quantity, Wanted>,
}

impl WishPanel {
    /// Draws the panel.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        let Some(name) = session.selected_name() else {
            ui.weak("Click a design in the scatter, then set here what should change.");
            return;
        };
        let Some(known) = session.known().filter(|known| known.verified).cloned() else {
            ui.weak(format!("{name}: waiting for the fine grid…"));
            return;
        };
        if self.of.replace(known.evaluation.design) != Some(known.evaluation.design) {
            self.wanted.clear();
        }
        ScrollArea::vertical().show(ui, |ui| {
            if !known.evaluation.is_feasible() {
                ui.label(format!(
                    "{name} is infeasible; a wish must start from a feasible design."
                ));
                return;
            }
            ui.strong(format!("What should change in {name}?"));
            self.quantities(ui, session, &known.evaluation);
            self.buttons(ui, session, &known.evaluation);
            ui.separator();
            answer(ui, session);
        });
    }

    /// Shows a slider for each quantity.
    fn quantities(&mut self, ui: &mut Ui, session: &Session, evaluation: &Evaluation) {
        for quantity in wishable(session) {
            let Some(value) = evaluation.quantities.get(quantity).filter(|value| *value > 0.0) else {
                continue;
            };
            let entry = quantity.entry();
            let wanted = self.wanted.entry(quantity).or_default();
            ui.horizontal(|ui| {
                ui.label(entry.label).on_hover_text(entry.meaning);
                let sought = match wanted.change == 0.0 {
                    true => format!("{} {}", number(value), entry.unit),
                    false => words(wished(quantity, value, wanted.change)),
                };
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| ui.label(sought));
            });
            let range = RANGE[0]..=RANGE[1];
            let slider = Slider::new(&mut wanted.change, range)
                .step_by(1.0)
                .custom_formatter(|change, _| format!("{change:+.0} %"))
                .custom_parser(|text| text.replace(['%', ' '], "").replace('−', "-").parse().ok());
            ui.horizontal(|ui| {
                ui.spacing_mut().slider_width = (ui.available_width() - BESIDE_SLIDER).max(60.0);
                add_named(ui, slider, &format!("Desired change of {}", entry.label));
                let keep = Checkbox::new(&mut wanted.keep, "keep");
                add_named(ui, keep, &format!("Keep {}", entry.label)).on_hover_text("must not become worse");
            });
        }
    }

    fn buttons(&mut self, ui: &mut Ui, session: &mut Session, evaluation: &Evaluation) {
        let wish = self.wish(evaluation);
        let is_stated = !wish.conditions.is_empty();
        ui.horizontal(|ui| {
            let hints = [
                "finds the nearest design with these values, proved if the study requires proofs; undo removes it (Ctrl+Z)",
                "move a slider first",
            ];
            let can_find = is_stated && !session.is_wishing();
            if button_if(ui, can_find, theme::primary("Find the design"), hints) {
                session.wish(wish);
            }
            let reset = egui::Button::new("Reset");
            if ui.add_enabled(!self.wanted.is_empty(), reset).clicked() {
                self.wanted.clear();
            }
        });
    }

    /// Returns the wish that the sliders state.
    fn wish(&self, evaluation: &Evaluation) -> Wish {
        let changed = self.wanted.iter().filter(|(_, wanted)| wanted.change != 0.0);
        let conditions = changed.filter_map(|(quantity, wanted)| {
            let value = evaluation.quantities.get(*quantity)?;
            Some(wished(*quantity, value, wanted.change))
        });
        let kept = self
            .wanted
            .iter()
            .filter(|(_, wanted)| wanted.keep && wanted.change == 0.0);
        Wish {
            conditions: conditions.collect(),
            keep: kept.map(|(quantity, _)| *quantity).collect(),
        }
    }
}

/// Returns the quantities of which something may be wished: those that the study names, the constrained ones, and the footprint.
fn wishable(session: &Session) -> Vec<Quantity> {
    let mut quantities = session.study().shown_quantities();
    if session.study().workspace.region.is_prescribed() {
        quantities.retain(|quantity| *quantity != Quantity::WorkspaceRadius);
    }
    let thresholds = session.model().settings().thresholds;
    let limited = thresholds
        .iter()
        .map(|(scalar, _)| scalar)
        .filter(|scalar| *scalar != PoseScalar::Reach);
    for quantity in limited.chain([PoseScalar::Footprint]).map(Quantity::Worst) {
        if !quantities.contains(&quantity) {
            quantities.push(quantity);
        }
    }
    quantities
}

/// Returns the condition that a change of a value by some per cent means.
fn wished(quantity: Quantity, value: f64, change: f64) -> Condition {
    Condition::no_worse_than(quantity, value * (1.0 + 0.01 * change))
}

/// Returns the bound of a condition in words.
fn words(Condition(limit): Condition) -> String {
    let (sign, value) = match limit.bound {
        Bound::AtLeast(value) => ("≥", value),
        Bound::AtMost(value) => ("≤", value),
    };
    format!("{sign} {} {}", number(value), limit.quantity.entry().unit)
}

/// Tells what became of the last wish.
fn answer(ui: &mut Ui, session: &mut Session) {
    let Some(answer) = session.wish_answer() else {
        if session.is_wishing() {
            ui.weak("Searching for the nearest design with these values…");
        } else {
            ui.weak("The result is a separate design in the scatter; undo removes it (Ctrl+Z).");
        }
        return;
    };
    match answer.as_ref() {
        Ok(outcome) => outcome_of(ui, session, outcome),
        Err(message) => {
            ui.colored_label(theme::bad(ui), format!("No such design was found: {message}"));
        }
    }
}

fn outcome_of(ui: &mut Ui, session: &mut Session, outcome: &WishOutcome) {
    if outcome.was_true {
        ui.colored_label(theme::good(ui), "The design already has these values.");
        return;
    }
    if outcome.unmet.is_empty() {
        ui.colored_label(theme::good(ui), "All conditions are met.");
    } else {
        ui.colored_label(
            theme::bad(ui),
            "Not all conditions can be met; this design comes closest.",
        );
    }
    for (condition, value) in &outcome.unmet {
        let entry = condition.0.quantity.entry();
        ui.label(format!(
            "{}: {} {} is the best achievable value.",
            entry.label,
            number(*value),
            entry.unit
        ));
    }
    for changed in &outcome.changed_entries {
        ui.label(format!("{changed}."));
    }
    let found = &outcome.found;
    Grid::new("granted").num_columns(4).striped(true).show(ui, |ui| {
        headings(ui, ["", "before", "after", "change"]);
        for quantity in wishable(session) {
            let values = [&outcome.before, &found.evaluation].map(|evaluation| evaluation.quantities.get(quantity));
            let [Some(before), Some(after)] = values else { continue };
            ui.label(Column::Quantity(quantity).title());
            ui.label(number(before));
            ui.label(number(after));
            let change = 100.0 * (after / before - 1.0);
            ui.label(if change.is_finite() {
                format!("{change:+.1} %")
            } else {
                String::new()
            });
            ui.end_row();
        }
    });
    ui.label(match found.certified {
        Some(certified) if certified.is_proved => "Its workspace is proved.",
        Some(_) => "Its workspace is verified on the fine grid, but not proved.",
        None => "Its workspace is verified on the fine grid; the study does not require a proof.",
    });
}
