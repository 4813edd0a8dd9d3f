//! The controls of the scatter: its axes and colours, what dragging does, the filter, and the marked designs.

use std::sync::Arc;

use egui::{ComboBox, Ui, WidgetInfo, WidgetType};

use super::super::{button, named, range};
use super::{Scatter, ScatterAxis};
use crate::{MarkedCounts, Session, theme};
use kinefront_model::mechanism::Architecture;
use kinefront_scene::text;
use kinefront_study::Column;

impl Scatter {
    /// Shows what the scatter shows and how, the filter, and the marked designs.
    pub(super) fn controls(&mut self, ui: &mut Ui, session: &mut Session) {
        // A row that is wider than the panel would widen the plot as well.
        let width = ui.available_width();
        ui.horizontal_wrapped(|ui| {
            self.axis_field(ui, session, 0, "x");
            if width < 465.0 {
                ui.end_row();
            }
            self.axis_field(ui, session, 1, "y");
            if button(ui, "Fit", "fits the view to the feasible designs (or double-click)") {
                self.fitted = true;
            }
        });
        ui.horizontal_wrapped(|ui| {
            self.coloring.ui(ui, session.study().named_quantities());
            if width < 350.0 {
                ui.end_row();
            } else {
                ui.separator();
            }
            self.tool.ui(ui);
        });
        ui.horizontal_wrapped(|ui| {
            for architecture in session.study().architectures.clone() {
                include(ui, session, architecture);
            }
        });
        chips(ui, session);
        self.marked(ui, session);
    }

    /// Shows the fields of an axis.
    fn axis_field(&mut self, ui: &mut Ui, session: &Session, k: usize, name: &str) {
        let axis = &mut self.axes[k];
        let before = *axis;
        let label = ui.label(name);
        ComboBox::from_id_salt(("axis", k))
            .selected_text(axis.quantity.title())
            .width(130.0)
            .show_ui(ui, |ui| {
                for quantity in Column::quantities(session.study().named_quantities()) {
                    if ui
                        .selectable_label(axis.quantity == quantity, quantity.title())
                        .clicked()
                    {
                        *axis = ScatterAxis::usual(quantity);
                    }
                }
            })
            .response
            .labelled_by(label.id);
        let log = ui.checkbox(&mut axis.log, "log");
        log.widget_info(|| WidgetInfo::selected(WidgetType::Checkbox, true, axis.log, format!("{name} logarithmic")));
        if before != *axis {
            self.fitted = true;
        }
    }

    /// Tells how many designs are marked, and what can be done with them.
    fn marked(&mut self, ui: &mut Ui, session: &mut Session) {
        let marked = Arc::clone(&session.document().marked);
        if marked.is_empty() {
            return;
        }
        let front = session.front_number();
        let is_counted =
            |counted: &(Arc<Vec<usize>>, u64, MarkedCounts)| Arc::ptr_eq(&counted.0, &marked) && counted.1 == front;
        if !self.counted.as_ref().is_some_and(is_counted) {
            self.counted = Some((Arc::clone(&marked), front, session.count_marked()));
        }
        let Some((_, _, counts)) = &self.counted else { return };
        ui.horizontal_wrapped(|ui| {
            ui.strong(format!("{} marked", counts.all));
            let of = counts.of.iter().filter(|(_, count)| *count > 0);
            let of: Vec<String> = of
                .map(|(found, count)| format!("{} {count}", text::architecture(*found)))
                .collect();
            ui.label(format!(
                "{} feasible, {} on the front; {}",
                counts.feasible,
                counts.on_front,
                of.join(", ")
            ));
            let hint = "filters to the ranges of the marked designs on both axes";
            if button(ui, "Filter", hint) {
                self.filter_to_marked(session);
            }
            if button(ui, "Unmark", "clears all marks") {
                session.mark(Arc::default());
            }
        });
    }

    /// Sets the filter to the ranges of the marked designs on both axes.
    fn filter_to_marked(&self, session: &mut Session) {
        let of_axis = |axis: &ScatterAxis| {
            let ids = session.document().marked.iter();
            let values = ids.filter_map(|&id| session.number(id, axis.quantity));
            (axis.quantity, range(values))
        };
        let ranges = self.axes.each_ref().map(of_axis);
        session.edit(|document| {
            for (quantity, [low, high]) in ranges.into_iter().filter(|(_, [low, high])| low <= high) {
                document.filter.set_range(quantity, Some([low, high]));
            }
        });
    }
}

/// Shows an architecture, with which the user excludes its designs or includes them again.
fn include(ui: &mut Ui, session: &mut Session, architecture: Architecture) {
    let dark = ui.visuals().dark_mode;
    let hidden = session.document().filter.hidden.contains(&architecture);
    let color = if hidden {
        theme::infeasible(dark)
    } else {
        theme::architecture(architecture, dark)
    };
    let mark = ["●", "■", "▲", "◆"][theme::index(architecture) % 4];
    let text = egui::RichText::new(format!("{mark} {}", text::architecture(architecture))).color(color);
    let text = if hidden { text.strikethrough() } else { text };
    let hover = "click to exclude this architecture (dimmed in all panels) or to include it again";
    let button = ui.add(egui::Button::new(text).frame(false)).on_hover_text(hover);
    let label = format!("include {architecture}");
    button.widget_info(|| WidgetInfo::selected(WidgetType::Checkbox, true, !hidden, label.clone()));
    if button.clicked() {
        session.edit(|document| {
            let hidden = &mut document.filter.hidden;
            match hidden.iter().position(|&other| other == architecture) {
                Some(place) => drop(hidden.remove(place)),
                None => hidden.push(architecture),
            }
        });
    }
}

/// Tells how many designs of the front pass the filter, with a button that removes each criterion.
fn chips(ui: &mut Ui, session: &mut Session) {
    let filter = session.document().filter.clone();
    if filter.is_empty() {
        return;
    }
    let mut kept = filter.clone();
    ui.horizontal_wrapped(|ui| {
        ui.strong(format!("{} of {} pass", session.passing().len(), session.front().len()));
        let chip = |ui: &mut Ui, words: &str, name: &str| {
            let button = ui.button(format!("{words}  ×"));
            named(button, &format!("Remove the filter: {name}")).clicked()
        };
        if filter.feasible_only && chip(ui, "feasible", "feasible only") {
            kept.feasible_only = false;
        }
        for (key, [low, high]) in &filter.ranges {
            let title = Column::find_quantity(key).map_or_else(|| key.clone(), |column| column.title());
            let words = format!("{title} {} … {}", theme::number(*low), theme::number(*high));
            if chip(ui, &words, &title) {
                kept.ranges.remove(key);
            }
        }
        if !filter.hidden.is_empty() {
            let names: Vec<String> = filter.hidden.iter().map(|hidden| text::architecture(*hidden)).collect();
            if chip(ui, &format!("without {}", names.join(", ")), "architectures") {
                kept.hidden.clear();
            }
        }
    });
    if kept != filter {
        session.edit(|document| document.filter = kept);
    }
}
