//! The compare panel: up to four pinned designs side by side.

use egui::{Color32, Grid, RichText, ScrollArea, Ui};

use crate::explorer::{Session, theme};
use kinefront_model::evaluation::{Constraint, Evaluation};
use kinefront_model::mechanism::DESIGN_VARIABLES;

/// The panel that compares the pinned designs.
#[derive(Default)]
pub struct ComparePanel;

impl ComparePanel {
    /// Draws the panel.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        let pins = session.document().pins.clone();
        if pins.is_empty() {
            ui.weak("Pin up to four designs (P) to see them side by side.");
            session.staging.comparing = false;
            return;
        }
        let mut comparing = session.staging.comparing;
        ui.checkbox(&mut comparing, "show side by side in 3-D");
        session.staging.comparing = comparing;
        let evaluations: Vec<Option<Evaluation>> = session
            .pin_evaluations()
            .into_iter()
            .map(Option::<&_>::cloned)
            .collect();
        let (mut lift, mut choose) = (None, None);
        ScrollArea::both().auto_shrink([false, false]).show(ui, |ui| {
            Grid::new("compare")
                .num_columns(1 + pins.len())
                .striped(true)
                .spacing([14.0, 4.0])
                .show(ui, |ui| {
                    ui.label("");
                    for (index, pin) in pins.iter().enumerate() {
                        ui.horizontal(|ui| {
                            let dark = ui.visuals().dark_mode;
                            let color = theme::architecture(pin.design.architecture, dark);
                            if ui.button(RichText::new(&pin.name).color(color).strong()).clicked() {
                                choose = Some(index);
                            }
                            let close = ui.small_button("×");
                            close.widget_info(|| {
                                egui::WidgetInfo::labeled(egui::WidgetType::Button, true, format!("Unpin {}", pin.name))
                            });
                            if close.clicked() {
                                lift = Some(index);
                            }
                        });
                    }
                    ui.end_row();
                    ui.label("architecture");
                    for pin in &pins {
                        ui.label(pin.design.architecture.to_string());
                    }
                    ui.end_row();
                    let each = |value: fn(&Evaluation) -> f64| {
                        evaluations.iter().map(move |e| e.as_ref().map(value)).collect()
                    };
                    row(ui, "mass [kg]", each(|e| e.mass), Some(Best::Smallest));
                    row(ui, "R_w [m]", each(|e| e.workspace_radius), Some(Best::Largest));
                    row(
                        ui,
                        "R_w / mass [mm/kg]",
                        each(|e| 1e3 * e.workspace_radius / e.mass.max(1e-9)),
                        Some(Best::Largest),
                    );
                    for (index, variable) in DESIGN_VARIABLES.into_iter().enumerate() {
                        let values = pins.iter().map(|pin| Some(pin.design.values()[index])).collect();
                        row(ui, &format!("{} [m]", variable.symbol()), values, None);
                    }
                    for constraint in Constraint::required(&session.model().thresholds) {
                        let margins = evaluations
                            .iter()
                            .map(|e| e.as_ref().map(|e| e.constraint(constraint).margin))
                            .collect();
                        row(ui, &format!("margin {}", constraint.id()), margins, Some(Best::Largest));
                    }
                    let clearances = evaluations.iter().map(|e| e.as_ref()?.clearance());
                    row(ui, "clearance [m]", clearances.collect(), Some(Best::Largest));
                    ui.label("active constraints");
                    for evaluation in &evaluations {
                        let active: Vec<&str> =
                            evaluation.iter().flat_map(|e| e.active().map(Constraint::id)).collect();
                        ui.label(active.join(" "));
                    }
                    ui.end_row();
                });
        });
        if let Some(index) = choose {
            session.select_named(&pins[index]);
        }
        if let Some(index) = lift {
            session.history.edit(|document| drop(document.pins.remove(index)));
        }
    }
}

#[derive(Clone, Copy)]
enum Best {
    Smallest,
    Largest,
}

fn row(ui: &mut Ui, name: &str, values: Vec<Option<f64>>, best: Option<Best>) {
    ui.label(name);
    let known = values.iter().flatten().copied();
    let target = best.and_then(|best| match best {
        Best::Smallest => known.reduce(f64::min),
        Best::Largest => known.reduce(f64::max),
    });
    let several = values.len() > 1;
    for value in values {
        let text = value.map_or_else(|| "…".to_owned(), theme::number);
        let text = RichText::new(text).monospace();
        let text = if several && value.is_some() && value == target {
            text.color(theme::SATISFIED).strong()
        } else {
            text.color(Color32::PLACEHOLDER)
        };
        ui.label(text);
    }
    ui.end_row();
}
