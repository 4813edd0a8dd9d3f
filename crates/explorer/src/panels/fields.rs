//! The fields of the settings of a study. They follow from the settings as they are declared, so that a new one appears in its section
//! without a change here.

mod dependent;

use std::sync::LazyLock;

use egui::{CollapsingHeader, DragValue, TextEdit, Ui};
use toml::{Table, Value};

use self::dependent::{initial_value, settle};
use super::sketch::Sketch;
use super::{named, typed};
use crate::{Session, theme};
use kinefront_study::{Check, Fault, Setting, Study, settings};

/// The sections of a study in the order in which a designer thinks of them: heading, and names of the sections.
const GROUPS: [(&str, &[&str]); 7] = [
    ("Mechanism", &["", "geometry", "rails", "bodies", "bodies.layers"]),
    ("Workspace", &["workspace", "workspace.region"]),
    (
        "Loads and accuracy",
        &["requirements", "strength", "tolerances", "model"],
    ),
    (
        "Payload and motion",
        &["payload", "drives", "loads", "task", "anywhere"],
    ),
    (
        "Material, bars and drives",
        &[
            "material",
            "sections.legs",
            "sections.platform",
            "sections.rails",
            "actuators",
            "joints",
        ],
    ),
    ("Bounds", &["bounds", "variables"]),
    (
        "Search",
        &[
            "optimizer",
            "optimizer.stagnation",
            "optimizer.front_de",
            "optimizer.moga2",
            "optimizer.nsga2",
            "optimizer.cma_es",
            "grid.reference",
            "grid.fine",
            "hypervolume",
        ],
    ),
];

/// Largest number of points that are edited as fields; more are edited as text.
const MOST_POINTS: usize = 200;

/// What the fields of a study are shown with.
struct Context<'a> {
    /// The paper's study, which has the defaults.
    defaults: &'a Table,
    faults: &'a [Fault],
}

/// Shows a field for every setting of the study, in groups.
pub(super) fn all(ui: &mut Ui, session: &mut Session, faults: &[Fault], sketch: Option<&Sketch>) {
    edited(ui, session, faults, |ui, session, table, context| {
        let before = table.clone();
        at_times(ui, !session.store().is_empty(), |ui| differences(ui, session, &before));
        for (heading, sections) in GROUPS {
            CollapsingHeader::new(heading)
                .default_open(matches!(heading, "Mechanism" | "Loads and accuracy" | "Bounds"))
                .show(ui, |ui| {
                    if let Some(sketch) = sketch.filter(|_| heading == "Bounds") {
                        sketch.ui(ui);
                    }
                    for path in sections {
                        section(ui, path, table, context);
                    }
                });
        }
    });
}

/// Tells the faults of a study, or that it is valid.
pub(super) fn verdict(ui: &mut Ui, faults: &[Fault]) {
    // What is below keeps its identity, and with it the focus and the cursor, however many faults there are.
    ui.vertical(|ui| {
        for fault in faults {
            ui.colored_label(theme::bad(ui), format!("`{}` {}", fault.key, fault.message));
        }
        if faults.is_empty() {
            ui.colored_label(theme::good(ui), "valid");
        }
    });
}

/// Tells whether the study is valid, and shows the fields of some sections.
pub(super) fn of_sections(ui: &mut Ui, session: &mut Session, sections: &[&str]) {
    let faults: Vec<Fault> = session.editor().faults().cloned().collect();
    verdict(ui, &faults);
    edited(ui, session, &faults, |ui, _, table, context| {
        for path in sections {
            section(ui, path, table, context);
        }
    });
}

/// Shows fields of the study being edited, and takes what was changed.
fn edited(
    ui: &mut Ui,
    session: &mut Session,
    faults: &[Fault],
    show: impl FnOnce(&mut Ui, &Session, &mut Table, &Context<'_>),
) {
    // The defaults do not change from frame to frame.
    static DEFAULTS: LazyLock<Table> = LazyLock::new(|| Table::try_from(Study::default()).unwrap_or_default());
    let Ok(before) = Table::try_from(session.editor().study()) else {
        return;
    };
    let mut table = before.clone();
    let context = Context {
        defaults: &DEFAULTS,
        faults,
    };
    show(ui, session, &mut table, &context);
    settle(&mut table);
    if table != before {
        match table.try_into::<Study>() {
            Ok(mut study) => {
                study.task.settle(&session.editor().study().task);
                session.editor_mut().change(|edited| *edited = study);
            }
            // Only a text that must be a known name but is none, such as a working mode, leads here: the field keeps
            // its last valid value.
            Err(error) => session.notify_error(format!("invalid study: {}", error.message())),
        }
    }
}

/// Tells which settings differ from those of the study that was run.
fn differences(ui: &mut Ui, session: &Session, edited: &Table) {
    let Ok(run) = Table::try_from(session.study()) else {
        return;
    };
    let differs = |setting: &&Setting| setting.value(&run) != setting.value(edited);
    let changed: Vec<String> = settings().filter(differs).map(Setting::path).collect();
    if !changed.is_empty() {
        ui.colored_label(
            theme::active(ui),
            format!("differs from the study that was run: {}", changed.join(", ")),
        );
    }
}

/// Draws something that is not always there, so that what follows keeps its identity, and with it the focus.
fn at_times(ui: &mut Ui, is_shown: bool, draw: impl FnOnce(&mut Ui)) {
    if is_shown {
        ui.scope(draw);
    } else {
        ui.skip_ahead_auto_ids(1);
    }
}

/// Shows the name of a section within its group; the first one needs none.
fn subheading(ui: &mut Ui, path: &str) {
    let is_first = GROUPS.iter().any(|(_, sections)| sections.first() == Some(&path));
    if !is_first {
        ui.add_space(4.0);
        ui.weak(path.replace(['_', '.'], " "));
    }
}

/// Shows a tick for each optional setting of a section.
fn optional_settings(ui: &mut Ui, path: &str, table: &mut Table) {
    // A fixed characteristic length has its value by the choice of its definition alone.
    let follows = |setting: &&Setting| setting.key == "characteristic_length_m";
    let settings = settings().filter(|setting| setting.section == path);
    for setting in settings.filter(|setting| !follows(setting)) {
        let Some(initial) = setting.initial.and_then(initial_value) else {
            continue;
        };
        let mut stated = table.contains_key(setting.key);
        let tick = ui.checkbox(&mut stated, format!("set {}", setting.title()));
        if tick.on_hover_text(setting.description.trim()).changed() {
            if stated {
                table.insert(setting.key.to_owned(), initial);
            } else {
                table.remove(setting.key);
            }
        }
    }
}

/// Shows a tick for each name that may be selected.
fn selection(ui: &mut Ui, names: &mut Vec<Value>, all: &[&str]) {
    for name in all {
        let value = Value::String((*name).to_owned());
        let mut selected = names.contains(&value);
        if ui.checkbox(&mut selected, *name).changed() {
            // The names stay in their usual order; the last one cannot be deselected.
            let others = names.len() > 1;
            if selected {
                names.push(value);
            } else if others {
                names.retain(|found| *found != value);
            }
            names.sort_by_key(|found| all.iter().position(|name| found.as_str() == Some(name)));
        }
    }
}

/// Shows the settings of a section in the order in which they are declared.
fn section(ui: &mut Ui, path: &str, table: &mut Table, context: &Context<'_>) {
    let table = if path.is_empty() {
        Some(table)
    } else {
        path.split('.')
            .try_fold(table, |table, part| table.get_mut(part)?.as_table_mut())
    };
    let Some(table) = table else { return };
    subheading(ui, path);
    optional_settings(ui, path, table);
    // The question has fields of its own.
    let has_field = |setting: &&Setting| !["objectives", "constraints", "quantities"].contains(&setting.key);
    for setting in settings().filter(|setting| setting.section == path).filter(has_field) {
        if let Some(value) = table.get_mut(setting.key) {
            field(ui, setting, value, context);
        }
    }
}

/// Shows a setting: its name with the unit, its value, whether it differs from the default, and its faults.
fn field(ui: &mut Ui, setting: &Setting, value: &mut Value, context: &Context<'_>) {
    // A name is no value to return to.
    let default = setting
        .value(context.defaults)
        .filter(|_| !matches!(setting.key, "name" | "description"));
    let is_changed = default.is_some_and(|default| default != value);
    let hint = hint(setting, default);
    ui.horizontal(|ui| {
        let name = egui::RichText::new(setting.title());
        let name = if is_changed { name.strong() } else { name };
        let label = ui.label(name).on_hover_text(&hint);
        edit(ui, setting, value, label.id);
        if let Some(default) = default.filter(|_| is_changed)
            && named(
                ui.small_button("⟲"),
                &format!("{} back to {}", setting.title(), short_value(default)),
            )
            .clicked()
        {
            *value = default.clone();
        }
    });
    let path = setting.path();
    let faults = || context.faults.iter().filter(|fault| fault.key == path);
    at_times(ui, faults().next().is_some(), |ui| {
        for fault in faults() {
            ui.colored_label(theme::bad(ui), &fault.message);
        }
    });
}

/// Returns what a setting means, which values are valid, and its default.
fn hint(setting: &Setting, default: Option<&Value>) -> String {
    let mut hint = format!("{}\n{}", setting.description.trim(), setting.path());
    if let Some(range) = setting.check.range() {
        hint.push_str(&format!("\nvalid: {range}"));
    }
    if let Some(default) = default {
        hint.push_str(&format!("\ndefault: {}", short_value(default)));
    }
    hint
}

/// Writes a value as in a study file, on one line.
fn short_value(value: &Value) -> String {
    value.to_string().replace('\n', " ")
}

/// Shows the fields of a value.
fn edit(ui: &mut Ui, setting: &Setting, value: &mut Value, label: egui::Id) {
    match (setting.check, value) {
        (Check::Selection(all), Value::Array(names)) => {
            ui.horizontal_wrapped(|ui| selection(ui, names, &all()));
        }
        (_, Value::Array(items)) if items.iter().all(|item| item.is_float() || item.is_integer()) => {
            for item in items {
                number(ui, item).labelled_by(label);
            }
        }
        (_, Value::Array(rows)) if (1..=MOST_POINTS).contains(&rows.len()) && rows.iter().all(is_point) => {
            points(ui, setting, rows);
        }
        // Other arrays are edited as text.
        (_, Value::Array(_) | Value::Table(_) | Value::Datetime(_)) => {
            ui.weak("see Text");
        }
        (_, value @ (Value::Float(_) | Value::Integer(_))) => {
            number(ui, value).labelled_by(label);
        }
        (Check::Choice(choices), Value::String(text)) => {
            for choice in choices {
                ui.selectable_value(text, (*choice).to_owned(), choice.replace('_', " "));
            }
        }
        (_, Value::String(text)) => {
            ui.add(TextEdit::singleline(text).desired_width(220.0))
                .labelled_by(label);
        }
        (_, Value::Boolean(flag)) => {
            ui.checkbox(flag, "").labelled_by(label);
        }
    }
}

/// Whether a value is a point, such as a corner of a polygon or a waypoint.
fn is_point(value: &Value) -> bool {
    let numbers = value.as_array();
    numbers.is_some_and(|numbers| numbers.iter().all(|number| number.is_float() || number.is_integer()))
}

/// Shows a line for each of several points, which can be removed and repeated.
fn points(ui: &mut Ui, setting: &Setting, rows: &mut Vec<Value>) {
    let (mut removed, mut repeated) = (None, None);
    ui.vertical(|ui| {
        for (place, row) in rows.iter_mut().enumerate() {
            let name = format!("{} {}", setting.title(), place + 1);
            ui.horizontal(|ui| {
                for value in row.as_array_mut().into_iter().flatten() {
                    let field = number(ui, value);
                    ui.ctx()
                        .accesskit_node_builder(field.id, |node| node.set_label(name.as_str()));
                }
                if named(ui.small_button("×"), &format!("remove {name}")).clicked() {
                    removed = Some(place);
                }
                if named(ui.small_button("+"), &format!("repeat {name}")).clicked() {
                    repeated = Some(place);
                }
            });
        }
    });
    if let Some(place) = removed {
        rows.remove(place);
    }
    if let Some(place) = repeated {
        rows.insert(place + 1, rows[place].clone());
    }
}

fn number(ui: &mut Ui, value: &mut Value) -> egui::Response {
    match value {
        Value::Integer(number) => ui.add(typed(ui, DragValue::new(number)).speed(0.2)),
        Value::Float(number) => {
            let speed = (number.abs() * 0.01).max(1e-4);
            ui.add(typed(ui, DragValue::new(number)).speed(speed).max_decimals(9))
        }
        _ => ui.label(""),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_setting_has_its_place() {
        for setting in settings() {
            let groups = GROUPS
                .iter()
                .filter(|(_, sections)| sections.contains(&setting.section));
            assert_eq!(groups.count(), 1, "{}", setting.path());
        }
    }

    #[test]
    fn names_have_their_units_and_hints_their_ranges() {
        let named = |path: &str| settings().find(|setting| setting.path() == path).expect("a setting");
        for (path, title) in [
            ("material.youngs_modulus_pa", "youngs modulus [Pa]"),
            ("requirements.k_phi_z_min_nm_per_rad", "k phi z min [N·m/rad]"),
            ("bounds.R_m", "R [m]"),
            ("bounds.alpha_deg", "alpha [°]"),
            ("workspace.rotation_range_deg", "rotation range [°]"),
            ("optimizer.seed", "seed"),
        ] {
            assert_eq!(named(path).title(), title);
        }
        let defaults = Table::try_from(Study::default()).expect("a table");
        let range = named("workspace.rotation_range_deg");
        let hint = hint(range, range.value(&defaults));
        assert!(
            hint.contains("valid: 0 to 350") && hint.contains("default: 20"),
            "{hint}"
        );
    }
}
