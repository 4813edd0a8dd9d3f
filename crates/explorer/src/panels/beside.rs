//! The panel that compares the front with that of another run: what differs in the studies, and the first objective at equal values.

use egui::{Grid, RichText, ScrollArea, Ui};
use kinefront_scene::text::{number, short};
use kinefront_study::{Column, EqualLevel};

use super::{headings, named};
use crate::{Purpose, Session, theme};

/// The panel.
#[derive(Default)]
pub struct BesidePanel;

impl BesidePanel {
    /// Draws the panel.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        let Some(beside) = session.beside() else {
            ui.weak(
                "Open another run with the same objectives to draw both fronts in the scatter and compare them here.",
            );
            if ui.button("Compare with run…").clicked() {
                session.request_file(Purpose::OpenBeside);
            }
            return;
        };
        let name = beside.name.clone();
        let close = ui
            .horizontal(|ui| {
                ui.strong(format!("{} and {name}", session.study().name));
                named(ui.small_button("×"), &format!("Close {name}")).clicked()
            })
            .inner;
        ui.columns(2, |columns| {
            if let [left, right] = columns {
                ScrollArea::both()
                    .id_salt("levels")
                    .show(left, |ui| levels(ui, session, &name));
                ScrollArea::both()
                    .id_salt("differences")
                    .show(right, |ui| differences(ui, session, &name));
            }
        });
        if close {
            session.close_beside();
        }
    }
}

/// Tabulates the first objective of both fronts at equal values of the second one.
fn levels(ui: &mut Ui, session: &Session, name: &str) {
    let objectives = session.study().objectives();
    let levels: Vec<EqualLevel> = session.levels_beside();
    let [first, rest @ ..] = objectives.as_slice() else {
        return;
    };
    if levels.is_empty() {
        ui.weak("Fronts of more than two objectives are drawn in the scatter but are not compared here.");
        return;
    }
    Grid::new("levels").num_columns(4).striped(true).show(ui, |ui| {
        let at = rest.first().map(|second| Column::Quantity(second.quantity).title());
        let cost = Column::Quantity(first.quantity).title();
        headings(ui, [&*at.unwrap_or_default(), &*cost, name, "change"]);
        for level in &levels {
            ui.label(level.at.map_or_else(|| "best".to_owned(), short));
            for cost in &level.costs {
                ui.label(cost.map_or_else(|| "not reached".to_owned(), number));
            }
            if let [Some(own), Some(other)] = level.costs.as_slice() {
                let change = 100.0 * (other / own - 1.0);
                ui.label(format!("{change:+.1} %"));
            }
            ui.end_row();
        }
    });
}

/// Lists the settings in which the studies differ.
fn differences(ui: &mut Ui, session: &Session, name: &str) {
    let Some(beside) = session.beside() else { return };
    if beside.differences.is_empty() {
        ui.colored_label(theme::good(ui), "Both studies have the same settings.");
        return;
    }
    Grid::new("settings").num_columns(3).striped(true).show(ui, |ui| {
        headings(ui, ["setting", &session.study().name, name]);
        for difference in &beside.differences {
            ui.label(RichText::new(&difference.key).monospace());
            for value in &difference.values {
                let value = value.as_deref().unwrap_or("–");
                ui.label(value.parse().map_or_else(|_| value.to_owned(), number));
            }
            ui.end_row();
        }
    });
}
