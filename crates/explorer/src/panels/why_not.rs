//! The panel that tells why a point beyond the front cannot be had, and what each requirement would have to give for it.

use egui::{ScrollArea, Ui};
use kinefront_scene::text::{number, quantity};
use kinefront_study::{Drivers, RelaxationJson, WhyNotJson};

use super::{button, named};
use crate::{Session, WhyPoint, theme};

/// Distance of what a relaxation comes to from the side \[points\].
const INDENT: f32 = 12.0;

/// The panel.
#[derive(Default)]
pub struct WhyNotPanel;

impl WhyNotPanel {
    /// Draws the panel.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        if session.is_hindered() {
            hindrances(ui, session);
            return;
        }
        let Some(point) = session.why_point() else {
            ui.weak("Click an empty place in the scatter beyond the front to see why no design is there.");
            return;
        };
        ui.horizontal_wrapped(|ui| {
            ui.strong(format!("{}?", words(session, &point)));
            if button(ui, "Dismiss", "removes the question and its mark") {
                session.withdraw_why();
            }
        });
        let Some(answer) = session.why() else {
            ui.weak("Searching for the best design there, and for how much each requirement would have to be relaxed…");
            return;
        };
        match answer.as_ref() {
            Ok(drivers) => {
                ScrollArea::vertical().show(ui, |ui| show(ui, session, drivers));
            }
            Err(message) => {
                ui.label("No answer was found:");
                ui.colored_label(theme::bad(ui), message);
            }
        }
    }
}

/// Tells what stands in the way of a study of which no design is feasible.
fn hindrances(ui: &mut Ui, session: &mut Session) {
    ui.strong("No design of the run is feasible.");
    let Some(answer) = session.hindrances() else {
        ui.weak("Searching for the requirements that prevent a feasible design…");
        return;
    };
    let found = match answer.as_ref() {
        Ok(found) => found,
        Err(message) => {
            ui.colored_label(theme::bad(ui), message);
            return;
        }
    };
    if found.is_empty() {
        ui.label(
            "No single requirement prevents a design: two or more, or the bounds of the design variables, have to be relaxed.",
        );
        return;
    }
    ui.label("One of these changes would suffice, with all other requirements kept:");
    let mut chosen = None;
    ScrollArea::vertical().show(ui, |ui| {
        for hindrance in found {
            if show_design(ui, &hindrance.label) {
                chosen = Some(hindrance.design.clone());
            }
            let [stated, possible] = [hindrance.stated, hindrance.possible].map(number);
            let words = match hindrance.is_enough {
                true => "as stated: search longer".to_owned(),
                false => format!("from {stated} to {possible} {}", hindrance.unit),
            };
            entry(ui, &words);
        }
    });
    if let Some(design) = chosen {
        session.paste(&design);
    }
}

/// Returns the values of a point in words.
fn words(session: &Session, point: &WhyPoint) -> String {
    let first = session.study().objectives().first().map(|objective| objective.quantity);
    let values = first
        .map(|first| (first, point.wished))
        .into_iter()
        .chain(point.held.iter().copied());
    let values: Vec<String> = values.map(|(of, value)| quantity(of, value)).collect();
    values.join(" with ")
}

fn show(ui: &mut Ui, session: &mut Session, drivers: &Drivers) {
    let (objective, unit) = drivers.objective_name();
    let Some(why) = &drivers.why_not else { return };
    let best = format!("{} {unit}", number(drivers.polished_value));
    if why.log_deficit >= 0.0 {
        ui.colored_label(
            theme::good(ui),
            format!("This point is achievable: the best design there has {best}."),
        );
        if ui.button("Select it").clicked() {
            session.paste(&drivers.design);
        }
        return;
    }
    ui.label(format!(
        "The best design there has a {objective} of {best}: {:+.1} % from the desired value. One of these changes would suffice:",
        100.0 * (drivers.polished_value / why.wished - 1.0)
    ));
    relaxations(ui, session, drivers, why, unit);
    for warning in &drivers.warnings {
        ui.colored_label(theme::bad(ui), warning);
    }
}

/// Tabulates what each requirement would have to give.
fn relaxations(ui: &mut Ui, session: &mut Session, drivers: &Drivers, why: &WhyNotJson, unit: &str) {
    let mut chosen = None;
    for relaxation in &why.relaxations {
        let (label, range) = change(drivers, relaxation);
        match relaxation.needed {
            Some(factor) => {
                if show_design(ui, &label) {
                    chosen = Some(relaxation.design.clone());
                }
                let times = format!("times {factor:.3}");
                entry(
                    ui,
                    &range.map_or_else(|| times.clone(), |range| format!("{range}, {times}")),
                );
            }
            None => {
                ui.label(&label);
                entry(ui, &format!("at best {} {unit}", number(relaxation.objective)));
            }
        }
    }
    if let Some(design) = chosen {
        session.paste(&design);
    }
}

/// Shows what a relaxation comes to, below its name.
fn entry(ui: &mut Ui, words: &str) {
    ui.horizontal(|ui| {
        ui.add_space(INDENT);
        ui.weak(words);
    });
}

/// Shows what is relaxed as a link to the design that results; returns whether it was clicked.
fn show_design(ui: &mut Ui, label: &str) -> bool {
    let link = ui.link(label);
    named(link, &format!("Show the design for {label}")).clicked()
}

/// Returns the name of what is relaxed, and its value before and after.
fn change(drivers: &Drivers, relaxation: &RelaxationJson) -> (String, Option<String>) {
    let price = drivers
        .prices
        .iter()
        .find(|price| price.parameter == relaxation.parameter);
    let label = match (price, relaxation.parameter.as_str()) {
        (Some(price), _) => price.label.clone(),
        (None, "all_thresholds") => "all limits by the same factor".to_owned(),
        (None, "least_norm") => "all limits, with the smallest change in total".to_owned(),
        (None, other) => other.to_owned(),
    };
    let stated = price.and_then(|price| Some((price.value?, price.unit)));
    let range = stated
        .zip(relaxation.needed)
        .map(|((value, unit), factor)| format!("from {} to {} {unit}", number(value), number(factor * value)));
    (label, range)
}
