//! The study panel: the settings as fields or as the text of the study file; both are checked as they are typed.

use egui::{CollapsingHeader, DragValue, ScrollArea, TextEdit, Ui};
use toml::{Table, Value};

use super::question;
use crate::explorer::{Session, theme};
use crate::study::{Check, Fault, Initial, Setting, Study, settings};

/// The study panel.
#[derive(Default)]
pub struct StudyPanel {
    as_text: bool,
    /// The text as typed, while it is invalid.
    typed: Option<String>,
}

impl StudyPanel {
    /// Draws the panel. Returns whether it requests to save the study.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) -> bool {
        let mut save = false;
        ui.horizontal(|ui| {
            ui.selectable_value(&mut self.as_text, false, "Fields");
            ui.selectable_value(&mut self.as_text, true, "Text");
            ui.separator();
            save = ui.button("Save study…").clicked();
            if let Some(path) = session.editor.path() {
                ui.weak(path.display().to_string());
            }
        });
        let faults: Vec<Fault> = session.editor.faults().cloned().collect();
        for fault in &faults {
            ui.colored_label(theme::BAD, format!("`{}` {}", fault.key, fault.message));
        }
        if faults.is_empty() {
            ui.colored_label(theme::GOOD, "valid");
            self.typed = None;
        }
        ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
            if self.as_text {
                let mut text = self.typed.clone().unwrap_or_else(|| session.editor.text().to_owned());
                let field = ui.add(
                    TextEdit::multiline(&mut text)
                        .code_editor()
                        .desired_width(f32::INFINITY),
                );
                ui.ctx()
                    .accesskit_node_builder(field.id, |node| node.set_label("Study text"));
                if field.changed() {
                    session.editor.set_text(text.clone());
                    self.typed = Some(text);
                }
            } else {
                CollapsingHeader::new("question").default_open(true).show(ui, |ui| {
                    let mut study = session.editor.study().clone();
                    question::ui(ui, &mut study);
                    session.editor.change(|edited| *edited = study);
                });
                fields(ui, session, &faults);
            }
        });
        save
    }
}

/// Shows a field for every value of the study. The fields follow from the study's own TOML table, so a new setting
/// appears without a change here.
fn fields(ui: &mut Ui, session: &mut Session, faults: &[Fault]) {
    let Ok(before) = Table::try_from(session.editor.study()) else {
        return;
    };
    let mut table = before.clone();
    section(ui, "", &mut table, faults);
    follow_characteristic_length(&mut table);
    follow_sections(&mut table);
    follow_region(&mut table);
    if table != before {
        match table.try_into::<Study>() {
            Ok(study) => session.editor.change(|edited| *edited = study),
            // Only a text that must be a known name but is none, such as a working mode, leads here: the field keeps
            // its last valid value.
            Err(error) => session.notify_error(format!("invalid study: {}", error.message())),
        }
    }
}

/// A fixed characteristic length needs its value, and any other must not have one.
fn follow_characteristic_length(table: &mut Table) {
    let Some(model) = table.get_mut("model").and_then(Value::as_table_mut) else {
        return;
    };
    let key = "characteristic_length_m";
    if model.get("characteristic_length").and_then(Value::as_str) != Some("fixed") {
        model.remove(key);
    } else if !model.contains_key(key)
        && let Some(initial) = settings()
            .find(|setting| setting.key == key)
            .and_then(|setting| setting.initial)
    {
        model.extend(initial_value(initial).map(|value| (key.to_owned(), value)));
    }
}

/// A hollow bar needs its wall, and a solid one must not have one.
fn follow_sections(table: &mut Table) {
    const WALLS: [&str; 3] = ["wall_ratio", "wall_m", "catalogue"];
    let Some(sections) = table.get_mut("sections").and_then(Value::as_table_mut) else {
        return;
    };
    for (_, section) in sections.iter_mut() {
        let Some(section) = section.as_table_mut() else {
            continue;
        };
        let is_hollow = section.get("kind").and_then(Value::as_str) != Some("round");
        let has_wall = WALLS.iter().any(|key| section.contains_key(*key));
        if is_hollow && !has_wall {
            section.insert(WALLS[0].to_owned(), Value::Float(0.2));
        } else if !is_hollow {
            section.retain(|key, _| !WALLS.contains(&key));
        }
    }
}

/// A prescribed region needs its sizes, and must not have those of another one.
fn follow_region(table: &mut Table) {
    let region = table
        .get_mut("workspace")
        .and_then(|workspace| workspace.get_mut("region"));
    let Some(region) = region.and_then(Value::as_table_mut) else {
        return;
    };
    let corner = |x: f64, y: f64| Value::Array(vec![Value::Float(x), Value::Float(y)]);
    let triangle = || Value::Array(vec![corner(-0.2, -0.1), corner(0.2, -0.1), corner(0.0, 0.2)]);
    let sizes: Vec<(&str, Value)> = match region.get("kind").and_then(Value::as_str) {
        Some("disc") => vec![("radius_m", Value::Float(0.3))],
        Some("rectangle") => vec![("width_m", Value::Float(0.4)), ("height_m", Value::Float(0.3))],
        Some("polygon") => vec![("corners_m", triangle())],
        _ => Vec::new(),
    };
    region.retain(|key, _| key == "kind" || sizes.iter().any(|(size, _)| *size == key));
    for (key, value) in sizes {
        region.entry(key).or_insert(value);
    }
}

/// Returns the value that an optional setting starts from; `None` for one that is edited as text.
fn initial_value(initial: Initial) -> Option<Value> {
    match initial {
        Initial::Number(number) => Some(Value::Float(number)),
        Initial::Count(count) => Some(Value::Integer(count)),
        Initial::AsText => None,
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
        let tick = ui.checkbox(&mut stated, format!("set {}", setting.key));
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

fn section(ui: &mut Ui, path: &str, table: &mut Table, faults: &[Fault]) {
    optional_settings(ui, path, table);
    for (key, value) in table.iter_mut() {
        // The question has fields of its own.
        if path.is_empty() && ["objectives", "constraints", "quantities"].contains(&&**key) {
            continue;
        }
        let path = if path.is_empty() {
            key.clone()
        } else {
            format!("{path}.{key}")
        };
        let setting = settings().find(|setting| setting.path() == path);
        let label = |ui: &mut Ui| {
            let label = ui.label(key.as_str());
            match setting {
                Some(setting) => label.on_hover_text(setting.description.trim()),
                None => label,
            }
        };
        let check = setting.map(|setting| setting.check);
        match value {
            Value::Table(inner) => {
                CollapsingHeader::new(key.as_str())
                    .id_salt(&path)
                    .default_open(matches!(key.as_str(), "bounds" | "requirements"))
                    .show(ui, |ui| section(ui, &path, inner, faults));
            }
            Value::Array(names) if matches!(check, Some(Check::Selection(_))) => {
                ui.horizontal(|ui| {
                    label(ui);
                    if let Some(Check::Selection(all)) = check {
                        selection(ui, names, &all());
                    }
                });
            }
            // Other arrays, the references, are edited as text.
            Value::Array(items) if items.iter().all(|item| item.is_float() || item.is_integer()) => {
                ui.horizontal(|ui| {
                    let label = label(ui);
                    for item in items {
                        number(ui, item).labelled_by(label.id);
                    }
                });
            }
            Value::Array(_) => {}
            Value::Float(_) | Value::Integer(_) => {
                ui.horizontal(|ui| {
                    let label = label(ui);
                    number(ui, value).labelled_by(label.id);
                });
            }
            Value::String(text) => {
                ui.horizontal(|ui| {
                    let label = label(ui);
                    if let Some(Check::Choice(choices)) = check {
                        for choice in choices {
                            ui.selectable_value(text, (*choice).to_owned(), *choice);
                        }
                    } else {
                        ui.add(TextEdit::singleline(text).desired_width(220.0))
                            .labelled_by(label.id);
                    }
                });
            }
            Value::Boolean(flag) => {
                ui.checkbox(flag, key.as_str());
            }
            Value::Datetime(_) => {}
        }
        for fault in faults.iter().filter(|fault| fault.key == path) {
            ui.colored_label(theme::BAD, &fault.message);
        }
    }
}

fn number(ui: &mut Ui, value: &mut Value) -> egui::Response {
    match value {
        Value::Integer(number) => ui.add(DragValue::new(number).speed(0.2)),
        Value::Float(number) => {
            let speed = (number.abs() * 0.01).max(1e-4);
            ui.add(DragValue::new(number).speed(speed).max_decimals(9))
        }
        _ => ui.label(""),
    }
}
