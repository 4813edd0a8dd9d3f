//! The study panel: the settings as fields or as the text of the study file; both are checked as they are typed.

use egui::{Button, CollapsingHeader, ScrollArea, TextEdit, Ui};

use super::sketch::Sketch;
use super::{add_named, button_if, fields, question};
use crate::{Purpose, Session, theme};
use kinefront_study::Fault;

/// The study panel.
#[derive(Default)]
pub struct StudyPanel {
    as_text: bool,
    /// The text as typed, while it is invalid.
    typed: Option<String>,
    /// Shows what the lengths of the first architecture are.
    sketch: Option<Sketch>,
}

impl StudyPanel {
    /// Draws the panel.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        ui.horizontal_wrapped(|ui| {
            theme::choice(ui, &mut self.as_text, false, "Fields");
            theme::choice(ui, &mut self.as_text, true, "Text");
            ui.separator();
            if ui.button("Save study…").clicked() {
                session.request_file(Purpose::SaveStudy);
            }
            let history = session.editor().history();
            let (can_undo, can_redo) = (history.can_undo(), history.can_redo());
            let hints = ["undoes the last change of the study (Ctrl+Z)", "nothing to undo"];
            if button_if(ui, can_undo, Button::new("Undo"), hints) {
                session.editor_mut().undo();
            }
            let hint = "redoes the change that was undone last (Ctrl+Shift+Z)";
            if button_if(ui, can_redo, Button::new("Redo"), [hint, "nothing to redo"]) {
                session.editor_mut().redo();
            }
            if let Some(path) = session.editor().path() {
                ui.weak(path.display().to_string());
            }
        });
        let faults: Vec<Fault> = session.editor().faults().cloned().collect();
        fields::verdict(ui, &faults);
        if faults.is_empty() {
            self.typed = None;
        }
        ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
            if self.as_text {
                let mut text = self.typed.clone().unwrap_or_else(|| session.editor().text().to_owned());
                let field = TextEdit::multiline(&mut text).code_editor();
                if add_named(ui, field.desired_width(f32::INFINITY), "Study text").changed() {
                    session.editor_mut().set_text(text.clone());
                    self.typed = Some(text);
                }
            } else {
                CollapsingHeader::new("Question").default_open(true).show(ui, |ui| {
                    let mut study = session.editor().study().clone();
                    question::ui(ui, &mut study);
                    session.editor_mut().change(|edited| *edited = study);
                });
                self.follow_architecture(session);
                fields::all(ui, session, &faults, self.sketch.as_ref());
            }
        });
    }

    /// Sketches the first architecture of the study.
    fn follow_architecture(&mut self, session: &Session) {
        let first = session.editor().study().architectures.first().copied();
        if self.sketch.as_ref().map(|sketch| sketch.architecture) != first {
            self.sketch = first.and_then(Sketch::new);
        }
    }
}
