//! The question of a study in the study panel: its objectives and limits.

use egui::{ComboBox, DragValue, Ui};

use super::{named, typed};
use kinefront_model::evaluation::{Better, PoseScalar, Quantity};
use kinefront_study::{LimitChoice, ObjectiveChoice, Study};

/// Shows the objectives and limits of a study, and changes them.
pub(super) fn ui(ui: &mut Ui, study: &mut Study) {
    objectives(ui, study);
    ui.separator();
    limits(ui, study);
}

/// A combination box of the quantities; returns the one that is chosen.
fn quantities(ui: &mut Ui, id: impl std::hash::Hash + std::fmt::Debug, shown: &str) -> Option<Quantity> {
    let mut chosen = None;
    ComboBox::from_id_salt(id)
        .selected_text(shown)
        .width(170.0)
        .show_ui(ui, |ui| {
            for quantity in Quantity::all() {
                let entry = quantity.entry();
                if ui
                    .selectable_label(entry.key == shown, entry.key)
                    .on_hover_text(entry.meaning)
                    .clicked()
                {
                    chosen = Some(quantity);
                }
            }
        });
    chosen
}

fn choice(quantity: Quantity, goal: Better) -> ObjectiveChoice {
    let key = quantity.entry().key.to_owned();
    match goal {
        Better::Lower => ObjectiveChoice::Minimize(key),
        Better::Higher => ObjectiveChoice::Maximize(key),
    }
}

fn objectives(ui: &mut Ui, study: &mut Study) {
    ui.strong("Objectives");
    let mut removed = None;
    let several = study.objectives.len() > 1;
    for (place, objective) in study.objectives.iter_mut().enumerate() {
        ui.horizontal(|ui| {
            let minimizes = matches!(objective, ObjectiveChoice::Minimize(_));
            let name = if minimizes { "minimize" } else { "maximize" };
            let turn = ui
                .button(name)
                .on_hover_text("click to minimize or to maximize the quantity");
            if turn.clicked() {
                let key = objective.key().to_owned();
                *objective = if minimizes {
                    ObjectiveChoice::Maximize(key)
                } else {
                    ObjectiveChoice::Minimize(key)
                };
            }
            let shown = objective.key().to_owned();
            if let Some(quantity) = quantities(ui, ("objective", place), &shown) {
                *objective = choice(quantity, quantity.entry().better);
            }
            if several && named(ui.small_button("×"), "Remove this objective").clicked() {
                removed = Some(place);
            }
        });
    }
    if let Some(place) = removed {
        study.objectives.remove(place);
    }
    if study.objectives.len() < 3 {
        let add = ui.button("Add an objective").on_hover_text("up to three objectives");
        let named = |quantity: &Quantity| study.objectives.iter().any(|other| other.key() == quantity.entry().key);
        let mut next = [
            Quantity::Worst(PoseScalar::Footprint),
            Quantity::Mass,
            Quantity::DexterityMean,
        ]
        .into_iter();
        if let Some(quantity) = next.find(|quantity| !named(quantity)).filter(|_| add.clicked()) {
            study.objectives.push(choice(quantity, quantity.entry().better));
        }
    }
}

fn limits(ui: &mut Ui, study: &mut Study) {
    ui.strong("Limits");
    let mut removed = None;
    for (key, limit) in &mut study.constraints {
        ui.horizontal(|ui| {
            let label = ui.label(key.as_str());
            for (sign, bound) in [("≥", &mut limit.at_least), ("≤", &mut limit.at_most)] {
                if let Some(value) = bound {
                    ui.label(sign);
                    let speed = (value.abs() * 0.01).max(1e-4);
                    ui.add(typed(ui, DragValue::new(value)).speed(speed).max_decimals(6))
                        .labelled_by(label.id);
                }
            }
            if named(ui.small_button("×"), "Remove this limit").clicked() {
                removed = Some(key.clone());
            }
        });
    }
    if let Some(key) = removed {
        study.constraints.remove(&key);
    }
    if let Some(quantity) = quantities(ui, "limit", "add a limit") {
        let entry = quantity.entry();
        let limit = match entry.better {
            Better::Lower => LimitChoice {
                at_most: Some(1.0),
                at_least: None,
            },
            Better::Higher => LimitChoice {
                at_least: Some(0.1),
                at_most: None,
            },
        };
        study.constraints.entry(entry.key.to_owned()).or_insert(limit);
    }
}
