//! The study panel: the settings as fields or as the text of the study file; both are checked as they are typed.

use egui::{CollapsingHeader, DragValue, ScrollArea, TextEdit, Ui};
use toml::{Table, Value};

use crate::explorer::{Session, theme};
use crate::study::{AlgorithmName, Fault, Study};

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
        let faults = session.editor.faults().to_vec();
        for fault in &faults {
            ui.colored_label(theme::VIOLATED, format!("`{}` {}", fault.key, fault.message));
        }
        if faults.is_empty() {
            ui.colored_label(theme::SATISFIED, "valid");
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
    if table != before {
        match table.try_into::<Study>() {
            Ok(study) => session.editor.change(|edited| *edited = study),
            // Only a text that must be a known name but is none, such as a working mode, leads here: the field keeps
            // its last valid value.
            Err(error) => session.notify_error(format!("invalid study: {}", error.message())),
        }
    }
}

/// Optional settings of a study: section, key, and initial value.
const OPTIONAL: [(&str, &str, f64); 5] = [
    ("requirements", "clearance_min_m", 0.005),
    ("requirements", "k_xy_min_n_per_m", 1e6),
    ("requirements", "k_z_min_n_per_m", 1e5),
    ("requirements", "k_phi_z_min_nm_per_rad", 573.0),
    ("workspace", "home_phi_deg", 0.0),
];

fn section(ui: &mut Ui, path: &str, table: &mut Table, faults: &[Fault]) {
    for (section, key, value) in OPTIONAL {
        if section == path {
            let mut stated = table.contains_key(key);
            if ui.checkbox(&mut stated, format!("set {key}")).changed() {
                if stated {
                    table.insert(key.to_owned(), Value::Float(value));
                } else {
                    table.remove(key);
                }
            }
        }
    }
    for (key, value) in table.iter_mut() {
        let path = if path.is_empty() {
            key.clone()
        } else {
            format!("{path}.{key}")
        };
        match value {
            Value::Table(inner) => {
                CollapsingHeader::new(key.as_str())
                    .id_salt(&path)
                    .default_open(matches!(key.as_str(), "bounds" | "requirements"))
                    .show(ui, |ui| section(ui, &path, inner, faults));
            }
            // Other arrays, the architectures and the references, are edited as text.
            Value::Array(items) if items.iter().all(|item| item.is_float() || item.is_integer()) => {
                ui.horizontal(|ui| {
                    let label = ui.label(key.as_str());
                    for item in items {
                        number(ui, item).labelled_by(label.id);
                    }
                });
            }
            Value::Array(_) => {}
            Value::Float(_) | Value::Integer(_) => {
                ui.horizontal(|ui| {
                    let label = ui.label(key.as_str());
                    number(ui, value).labelled_by(label.id);
                });
            }
            Value::String(text) => {
                ui.horizontal(|ui| {
                    let label = ui.label(key.as_str());
                    let algorithms = AlgorithmName::ALL.map(AlgorithmName::name);
                    let choices: &[&str] = match key.as_str() {
                        "stiffness_definition" => &["stiffness", "compliance"],
                        "characteristic_length" => &["platform_radius", "isotropic"],
                        "telescopic_bar" => &["current", "longest"],
                        "algorithm" => &algorithms,
                        _ => &[],
                    };
                    if choices.is_empty() {
                        ui.add(TextEdit::singleline(text).desired_width(220.0))
                            .labelled_by(label.id);
                    } else {
                        for choice in choices {
                            ui.selectable_value(text, (*choice).to_owned(), *choice);
                        }
                    }
                });
            }
            Value::Boolean(flag) => {
                ui.checkbox(flag, key.as_str());
            }
            Value::Datetime(_) => {}
        }
        for fault in faults.iter().filter(|fault| fault.key == path) {
            ui.colored_label(theme::VIOLATED, &fault.message);
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
