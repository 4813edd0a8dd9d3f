//! The choose panel: knee and extreme designs, weighted ranking, representatives of the front, filter, kept designs.

use egui::{DragValue, ScrollArea, Slider, Ui};
use kinefront_study::Column;

use super::{add_named, button, named, range, typed};
use crate::{Filter, Purpose, Session, theme};
use kinefront_model::evaluation::{Better, Objective};
use kinefront_optimize::{Objectives, groups, ranking};
use kinefront_scene::text;

/// The panel that supports the choice of a design.
pub struct ChoosePanel {
    /// Weights of the objectives in the ranking, in \[0, 1\]. With two objectives, that of the second is the rest of the first.
    weights: [f64; Objectives::MOST],
    groups: usize,
    /// Number of the front, the filter, number of groups, and ids of the groups' representatives, as last computed.
    middles: Option<(u64, Filter, usize, Vec<usize>)>,
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

impl ChoosePanel {
    /// Draws the panel.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
            if session.front().is_empty() {
                ui.weak(
                    "Designs are proposed here once a run has found a front: start a run in the panel Run, or open one.",
                );
                ui.separator();
            }
            ui.strong("Knee and extreme designs");
            ui.horizontal_wrapped(|ui| {
                // A front of one objective is a single design.
                if session.study().objectives.len() > 1 {
                    let hover = "the design beyond which more of one objective costs much of the others (K)";
                    if button(ui, "Knee", hover) {
                        session.select_knee();
                    }
                }
                for (objective, id) in bests(session) {
                    let more = match objective.goal {
                        Better::Lower => "smallest",
                        Better::Higher => "largest",
                    };
                    let hover = format!("the design with the {more} {}", objective.quantity.entry().short);
                    let name = theme::capitalized(&objective.best_name());
                    if button(ui, name, &hover) {
                        session.select(id);
                    }
                }
            });
            ui.separator();
            self.weighted(ui, session);
            ui.separator();
            self.clusters(ui, session);
            ui.separator();
            filter(ui, session);
            ui.separator();
            kept(ui, session);
        });
    }

    fn weighted(&mut self, ui: &mut Ui, session: &mut Session) {
        ui.strong("Weighted ranking");
        let names: Vec<&str> = session
            .study()
            .objectives()
            .iter()
            .map(|objective| objective.quantity.entry().short)
            .collect();
        // The weight of the last of two objectives follows from that of the first.
        let sliders = if names.len() > 2 { names.len() } else { names.len() - 1 };
        for (weight, name) in self.weights.iter_mut().zip(&names).take(sliders) {
            let percent = |weight: f64, _| format!("{:.0} % {name}", 100.0 * weight);
            let slider = Slider::new(weight, 0.0..=1.0).custom_formatter(percent);
            add_named(ui, slider, &format!("Weight of the {name}"));
        }
        let weights = match names.len() {
            2 => vec![self.weights[0], 1.0 - self.weights[0]],
            _ => self.weights.to_vec(),
        };
        let (ids, objectives) = passing(session);
        let ranked = ranking(&objectives, &weights).into_iter().take(5);
        let best: Vec<usize> = ranked.map(|place| ids[place]).collect();
        designs(ui, session, &best);
    }

    fn clusters(&mut self, ui: &mut Ui, session: &mut Session) {
        ui.horizontal(|ui| {
            ui.strong("Groups of similar designs");
            let field = typed(ui, DragValue::new(&mut self.groups)).range(2..=12).speed(0.05);
            add_named(ui, field, "Number of groups");
        });
        let front = session.front_number();
        let middles = match self.middles.take() {
            Some((of, filter, groups, middles))
                if of == front && groups == self.groups && filter == session.document().filter =>
            {
                middles
            }
            _ => representatives(session, self.groups),
        };
        designs(ui, session, &middles);
        self.middles = Some((front, session.document().filter.clone(), self.groups, middles));
    }
}

fn designs(ui: &mut Ui, session: &mut Session, ids: &[usize]) {
    for &id in ids {
        let Some(row) = session.row(id) else {
            continue;
        };
        let color = theme::architecture(row.design.architecture(), ui.visuals().dark_mode);
        let text = format!(
            "#{id} {}  {}",
            row.design.architecture(),
            text::quantities(session.study().shown_quantities(), &row.quantities)
        );
        if ui.link(egui::RichText::new(text).color(color)).clicked() {
            session.select(id);
        }
    }
}

fn filter(ui: &mut Ui, session: &mut Session) {
    ui.strong("Filter");
    let mut edited: Filter = session.document().filter.clone();
    ui.checkbox(&mut edited.feasible_only, "feasible only")
        .on_hover_text("dims designs that are not feasible in all panels (F)");
    ranges(ui, &mut edited);
    egui::ComboBox::from_id_salt("add range")
        .selected_text("add a range")
        .show_ui(ui, |ui| add_range(ui, session, &mut edited));
    if edited != session.document().filter {
        session.drag("filter", |document| document.filter = edited);
    }
    ui.horizontal_wrapped(|ui| {
        if ui.button("Clear").clicked() {
            session.edit(|document| document.filter = Filter::default());
        }
        if ui.button("Copy filter").clicked() {
            ui.ctx().copy_text(session.document().filter.to_text());
        }
        if ui.button("Save filter…").clicked() {
            session.request_file(Purpose::SaveFilter);
        }
        if ui.button("Open filter…").clicked() {
            session.request_file(Purpose::OpenFilter);
        }
    });
}

/// The ranges of a filter, each with its ends and a button that removes it.
fn ranges(ui: &mut Ui, edited: &mut Filter) {
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
                ui.add(typed(ui, DragValue::new(low)).speed(speed).max_decimals(4))
                    .labelled_by(label.id);
                ui.label("to");
                ui.add(typed(ui, DragValue::new(high)).speed(speed).max_decimals(4))
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
}

/// The quantities that have no range yet; one that is clicked gets that of all designs.
fn add_range(ui: &mut Ui, session: &Session, edited: &mut Filter) {
    for quantity in Column::quantities(session.study().named_quantities()) {
        if !edited.ranges.contains_key(&*quantity.name()) && ui.selectable_label(false, quantity.title()).clicked() {
            let column = session.store().column(quantity).iter().copied();
            let [low, high] = range(column.filter(|value| value.is_finite()));
            edited.set_range(quantity, Some(if low <= high { [low, high] } else { [0.0, 1.0] }));
        }
    }
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
    let (ids, objectives) = passing(session);
    groups(&objectives, count)
        .into_iter()
        .map(|group| ids[group[(group.len() - 1) / 2]])
        .collect()
}

/// Returns the designs of the front that pass the filter, with their objectives.
fn passing(session: &Session) -> (Vec<usize>, Vec<Objectives>) {
    let entries = session.passing().into_iter().map(|place| &session.front()[place]);
    entries.map(|entry| (entry.id, entry.objectives())).unzip()
}

/// Returns the objectives with the id of the best design of the front in each.
fn bests(session: &Session) -> Vec<(Objective, usize)> {
    let (ids, points) = passing(session);
    let best = |place: usize| {
        let places = (0..ids.len()).min_by(|&a, &b| points[a][place].total_cmp(&points[b][place]));
        places.map(|found| ids[found])
    };
    let objectives = session.study().objectives().into_iter().enumerate();
    objectives
        .filter_map(|(place, objective)| Some((objective, best(place)?)))
        .collect()
}
