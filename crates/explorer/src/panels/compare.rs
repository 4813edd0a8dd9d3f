//! The compare panel: up to four pinned designs side by side.

use egui::{Color32, Grid, RichText, ScrollArea, Ui};

use super::named;
use crate::{Named, Session, theme};
use kinefront_model::evaluation::{Better, Constraint, Evaluation, Quantity};
use kinefront_model::mechanism::{DESIGN_VARIABLES, FURTHER_VARIABLES};
use kinefront_scene::text;
use kinefront_study::Column;

/// The panel that compares the pinned designs.
#[derive(Default)]
pub struct ComparePanel;

impl ComparePanel {
    /// Draws the panel.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        let pins = session.document().pins.clone();
        if pins.is_empty() {
            ui.weak("Pin up to four designs (P) to see them side by side.");
            session.view_mut().comparing = false;
            return;
        }
        let mut comparing = session.view().comparing;
        ui.horizontal_wrapped(|ui| {
            ui.checkbox(&mut comparing, "show side by side in 3-D");
            ui.weak(format!(
                "values on the fine grid under the study {}; changes are relative to {}",
                session.study().name,
                pins[0].name
            ));
        });
        session.view_mut().comparing = comparing;
        let evaluations: Vec<Option<Evaluation>> = session
            .pin_evaluations()
            .into_iter()
            .map(Option::<&_>::cloned)
            .collect();
        let (mut unpin, mut choose) = (None, None);
        ScrollArea::both().auto_shrink([false, false]).show(ui, |ui| {
            Grid::new("compare")
                .num_columns(1 + pins.len())
                .striped(true)
                .spacing([14.0, 4.0])
                .show(ui, |ui| {
                    for (index, pin) in names(ui, &pins).into_iter().enumerate() {
                        match pin {
                            Some(PinClick::Name) => choose = Some(index),
                            Some(PinClick::Unpin) => unpin = Some(index),
                            None => {}
                        }
                    }
                    quantities(ui, session, &evaluations);
                    dimensions(ui, &pins);
                    constraints(ui, session, &evaluations);
                });
        });
        if let Some(index) = choose {
            session.select_named(&pins[index]);
        }
        if let Some(index) = unpin {
            session.edit(|document| drop(document.pins.remove(index)));
        }
    }
}

/// What the user clicked in the heading of a pinned design.
#[derive(Clone, Copy)]
enum PinClick {
    Name,
    Unpin,
}

/// Draws the names of the designs and their architectures; returns what was clicked of each.
fn names(ui: &mut Ui, pins: &[Named]) -> Vec<Option<PinClick>> {
    ui.label("");
    let mut clicks = Vec::new();
    for pin in pins {
        let click = ui.horizontal(|ui| {
            let color = theme::architecture(pin.design.architecture(), ui.visuals().dark_mode);
            let name = ui.button(RichText::new(&pin.name).color(color).strong());
            let close = named(ui.small_button("×"), &format!("Unpin {}", pin.name));
            let unpin = close.clicked().then_some(PinClick::Unpin);
            unpin.or_else(|| name.clicked().then_some(PinClick::Name))
        });
        clicks.push(click.inner);
    }
    ui.end_row();
    ui.label("architecture");
    for pin in pins {
        ui.label(text::architecture(pin.design.architecture()));
    }
    ui.end_row();
    clicks
}

fn dimensions(ui: &mut Ui, pins: &[Named]) {
    for variable in DESIGN_VARIABLES.into_iter().chain(FURTHER_VARIABLES) {
        let is_given = |pin: &Named| pin.design.given_variables().any(|given| given == variable);
        if !DESIGN_VARIABLES.contains(&variable) && !pins.iter().any(is_given) {
            continue;
        }
        let of_pin = |pin: &Named| {
            let has_it = pin.design.architecture().has(variable);
            has_it.then(|| pin.design.value(variable))
        };
        let values = pins.iter().map(of_pin).collect();
        row(ui, &Column::Dimension(variable).title(), values, None);
    }
}

/// A value of each design; `None` while its evaluation is not known.
fn values(evaluations: &[Option<Evaluation>], value: impl Fn(&Evaluation) -> Option<f64>) -> Vec<Option<f64>> {
    evaluations.iter().map(|e| value(e.as_ref()?)).collect()
}

fn quantities(ui: &mut Ui, session: &Session, evaluations: &[Option<Evaluation>]) {
    for quantity in session.study().shown_quantities() {
        let of_designs = values(evaluations, |e| e.quantities.get(quantity));
        row(
            ui,
            &Column::Quantity(quantity).title(),
            of_designs,
            Some(quantity.entry().better),
        );
    }
}

/// Draws the margins of the required constraints, the clearance and the active constraints.
fn constraints(ui: &mut Ui, session: &Session, evaluations: &[Option<Evaluation>]) {
    for constraint in Constraint::required(&session.model().settings().thresholds) {
        let margins = values(evaluations, |e| Some(e.constraint(constraint).margin));
        row(ui, &Column::Margin(constraint).title(), margins, Some(Better::Higher));
    }
    let clearance = Column::Quantity(Quantity::of_constraint(Constraint::Clearance));
    let clearances = values(evaluations, Evaluation::clearance);
    row(ui, &clearance.title(), clearances, clearance.better());
    ui.label("active constraints");
    for evaluation in evaluations {
        let active: Vec<&str> = evaluation.iter().flat_map(|e| e.active().map(Constraint::id)).collect();
        ui.label(active.join(" "));
    }
    ui.end_row();
}

fn row(ui: &mut Ui, name: &str, values: Vec<Option<f64>>, better: Option<Better>) {
    ui.label(name);
    let known = values.iter().flatten().copied();
    let target = better.and_then(|better| match better {
        Better::Lower => known.reduce(f64::min),
        Better::Higher => known.reduce(f64::max),
    });
    let several = values.len() > 1;
    let first = values.first().copied().flatten();
    for (place, value) in values.into_iter().enumerate() {
        let text = value.map_or_else(|| "…".to_owned(), theme::number);
        let text = RichText::new(text).monospace();
        let text = if several && value.is_some() && value == target {
            text.color(theme::good(ui)).strong()
        } else {
            text.color(Color32::PLACEHOLDER)
        };
        ui.horizontal(|ui| {
            ui.label(text);
            if let (Some(value), Some(first), true) = (value, first, place > 0) {
                ui.weak(difference(value, first));
            }
        });
    }
    ui.end_row();
}

/// Returns the difference of a value from that of the first design, absolute and in per cent; nothing if there is none.
fn difference(value: f64, first: f64) -> String {
    let difference = value - first;
    if difference == 0.0 {
        return String::new();
    }
    let sign = if difference > 0.0 { "+" } else { "−" };
    let absolute = format!("{sign}{}", theme::number(difference.abs()));
    let percent = 100.0 * difference / first.abs();
    match percent.is_finite() && percent.abs() < 1e4 {
        true => format!("{absolute}, {percent:+.1} %"),
        false => absolute,
    }
}
