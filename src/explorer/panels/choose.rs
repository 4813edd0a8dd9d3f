//! The choose panel: knee and extreme designs, weighted ranking, representatives of the front, filter, kept designs.

use crate::study::{Column, Row};
use egui::{DragValue, ScrollArea, Slider, Ui};

use super::named;
use crate::explorer::{Filter, Session, theme};
use kinefront_model::evaluation::{Better, Quantity};
use kinefront_optimize::{Objectives, groups, ranking};

/// The panel that supports the choice of a design.
pub struct ChoosePanel {
    /// Weights of the objectives in the ranking, in \[0, 1\]. With two objectives, that of the second is the rest of the first.
    weights: [f64; Objectives::MOST],
    groups: usize,
    /// Number of the front, number of groups, and ids of the groups' representatives, as last computed.
    middles: Option<(u64, usize, Vec<usize>)>,
}

impl Default for ChoosePanel {
    fn default() -> Self {
        Self {
            weights: [0.5; Objectives::MOST],
            groups: 5,
            middles: None,
        }
    }
}

/// Request of the panel for a dialog on a filter file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FilterFile {
    /// Save the filter.
    Save,
    /// Open a filter.
    Open,
}

impl ChoosePanel {
    /// Draws the panel. Returns the filter file that it requests, if any.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) -> Option<FilterFile> {
        let mut requested = None;
        ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
            if session.front().is_empty() {
                ui.weak(
                    "Designs are proposed here once a run has found a front: start one in the panel Run, or open one.",
                );
                ui.separator();
            }
            ui.strong("Knee and extreme designs");
            ui.horizontal_wrapped(|ui| {
                let hover = "the design beyond which more of one objective costs much of the others (K)";
                if ui.button("Knee").on_hover_text(hover).clicked() {
                    session.select_knee();
                }
                for (name, id) in bests(session) {
                    if ui.button(name).clicked() {
                        session.select(id);
                    }
                }
            });
            ui.separator();
            self.weighted(ui, session);
            ui.separator();
            self.clusters(ui, session);
            ui.separator();
            requested = filter(ui, session);
            ui.separator();
            kept(ui, session);
        });
        requested
    }

    fn weighted(&mut self, ui: &mut Ui, session: &mut Session) {
        ui.strong("Weighted ranking");
        let names: Vec<&str> = session
            .study()
            .objectives()
            .iter()
            .map(|objective| short_name(objective.quantity))
            .collect();
        // The weight of the last of two objectives follows from that of the first.
        let sliders = if names.len() > 2 { names.len() } else { names.len() - 1 };
        for (weight, name) in self.weights.iter_mut().zip(&names).take(sliders) {
            let slider = ui.add(
                Slider::new(weight, 0.0..=1.0).custom_formatter(|weight, _| format!("{:.0} % {name}", 100.0 * weight)),
            );
            ui.ctx()
                .accesskit_node_builder(slider.id, |node| node.set_label(format!("Weight of the {name}")));
        }
        let weights = match names.len() {
            2 => vec![self.weights[0], 1.0 - self.weights[0]],
            _ => self.weights.to_vec(),
        };
        let objectives: Vec<Objectives> = session.front().iter().map(|entry| entry.objectives()).collect();
        let best: Vec<usize> = ranking(&objectives, &weights)
            .into_iter()
            .take(5)
            .map(|place| session.front()[place].id)
            .collect();
        designs(ui, session, &best);
    }

    fn clusters(&mut self, ui: &mut Ui, session: &mut Session) {
        ui.horizontal(|ui| {
            ui.strong("Groups of similar designs");
            let field = ui.add(DragValue::new(&mut self.groups).range(2..=12).speed(0.05));
            ui.ctx()
                .accesskit_node_builder(field.id, |node| node.set_label("Number of groups"));
        });
        let front = session.front_number();
        let middles = match self.middles.take() {
            Some((of, groups, middles)) if of == front && groups == self.groups => middles,
            _ => representatives(session, self.groups),
        };
        designs(ui, session, &middles);
        self.middles = Some((front, self.groups, middles));
    }
}

fn designs(ui: &mut Ui, session: &mut Session, ids: &[usize]) {
    for &id in ids {
        let Some(row) = session.row(id) else {
            continue;
        };
        let color = theme::architecture(row.design.architecture, ui.visuals().dark_mode);
        let text = format!("#{id} {}  {}", row.design.architecture, values(session, &row));
        if ui.link(egui::RichText::new(text).color(color)).clicked() {
            session.select(id);
        }
    }
}

fn filter(ui: &mut Ui, session: &mut Session) -> Option<FilterFile> {
    let mut requested = None;
    ui.strong("Filter");
    let mut edited: Filter = session.document().filter.clone();
    ui.checkbox(&mut edited.feasible_only, "feasible only")
        .on_hover_text("dims designs that are not feasible in all panels (F)");
    let keys: Vec<String> = edited.ranges.keys().cloned().collect();
    for key in keys {
        let Some(quantity) = Column::find_quantity(&key) else {
            continue;
        };
        ui.horizontal(|ui| {
            let label = ui.label(quantity.title());
            let mut lift = false;
            if let Some([low, high]) = edited.ranges.get_mut(&key) {
                let speed = ((*high - *low).abs() * 0.01).max(1e-4);
                ui.add(DragValue::new(low).speed(speed).max_decimals(4))
                    .labelled_by(label.id);
                ui.label("to");
                ui.add(DragValue::new(high).speed(speed).max_decimals(4))
                    .labelled_by(label.id);
                lift = named(
                    ui.small_button("×"),
                    &format!("Remove the range of {}", quantity.title()),
                )
                .clicked();
            }
            if lift {
                edited.ranges.remove(&key);
            }
        });
    }
    egui::ComboBox::from_id_salt("add range")
        .selected_text("add a range")
        .show_ui(ui, |ui| {
            for quantity in Column::quantities(session.study().named_quantities()) {
                if !edited.ranges.contains_key(&*quantity.name())
                    && ui.selectable_label(false, quantity.title()).clicked()
                {
                    let column = session.store().column(quantity);
                    let range = column
                        .iter()
                        .filter(|value| value.is_finite())
                        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &value| {
                            [low.min(value), high.max(value)]
                        });
                    edited.set_range(quantity, Some(if range[0] <= range[1] { range } else { [0.0, 1.0] }));
                }
            }
        });
    if edited != session.document().filter {
        session.history.drag("filter", |document| document.filter = edited);
    }
    ui.horizontal_wrapped(|ui| {
        if ui.button("Clear").clicked() {
            session.history.edit(|document| document.filter = Filter::default());
        }
        if ui.button("Copy filter").clicked() {
            ui.ctx().copy_text(session.document().filter.to_text());
        }
        if ui.button("Save filter…").clicked() {
            requested = Some(FilterFile::Save);
        }
        if ui.button("Open filter…").clicked() {
            requested = Some(FilterFile::Open);
        }
    });
    requested
}

fn kept(ui: &mut Ui, session: &mut Session) {
    ui.strong("Kept designs");
    let kept = session.document().kept.clone();
    if kept.is_empty() {
        ui.weak("modified designs that you keep are listed here");
    }
    for named in &kept {
        if ui.link(format!("{}: {}", named.name, named.design)).clicked() {
            session.select_named(named);
        }
    }
}

/// Divides the front into `count` groups of similar designs and returns the id of the middle design of each.
fn representatives(session: &Session, count: usize) -> Vec<usize> {
    let objectives: Vec<Objectives> = session.front().iter().map(|entry| entry.objectives()).collect();
    groups(&objectives, count)
        .into_iter()
        .map(|group| session.front()[group[(group.len() - 1) / 2]].id)
        .collect()
}

/// Returns the name of a quantity in a row of text.
fn short_name(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Mass => "mass",
        quantity => quantity.entry().label,
    }
}

/// Returns mass and workspace radius of a design, and the values of the other objectives.
fn values(session: &Session, row: &Row) -> String {
    let mut text = format!("{} kg  R_w {} m", theme::number(row.mass), theme::number(row.radius));
    for (objective, minimised) in session.study().objectives().into_iter().zip(row.objectives.iter()) {
        let entry = objective.quantity.entry();
        if !matches!(objective.quantity, Quantity::Mass | Quantity::WorkspaceRadius) {
            let value = theme::number(objective.value(*minimised));
            text += &format!("  {} {value} {}", entry.label, entry.unit);
        }
    }
    text
}

/// Returns the best design of the front in each objective, with the name of its button.
fn bests(session: &Session) -> Vec<(String, usize)> {
    let best = |place: usize| {
        let entries = session.front().iter();
        entries
            .min_by(|a, b| a.row.objectives[place].total_cmp(&b.row.objectives[place]))
            .map(|entry| entry.id)
    };
    let objectives = session.study().objectives().into_iter().enumerate();
    objectives
        .filter_map(|(place, objective)| {
            let name = match (objective.quantity, objective.goal) {
                (Quantity::Mass, Better::Lower) => "Lightest".to_owned(),
                (Quantity::WorkspaceRadius, Better::Higher) => "Largest R_w".to_owned(),
                (quantity, Better::Lower) => format!("Least {}", quantity.entry().label),
                (quantity, Better::Higher) => format!("Most {}", quantity.entry().label),
            };
            Some((name, best(place)?))
        })
        .collect()
}
