//! The menu bar, the notices, and the path and shortcut windows above the panels.

use std::path::PathBuf;

use egui::{Key, Ui, ViewportCommand};

use super::super::files::{Dialog, Purpose};
use super::super::{Panel, Phase, theme};
use super::shortcuts::SHORTCUTS;
use super::{Explorer, layout};
use crate::export::Format;

impl Explorer {
    pub(super) fn menu(&mut self, ui: &mut Ui) {
        egui::MenuBar::new().ui(ui, |ui| {
            let mut requested = None;
            ui.menu_button("File", |ui| {
                for (text, purpose) in [
                    ("Open… (Ctrl+O)", Purpose::Open),
                    ("Open run folder…", Purpose::OpenFolder),
                    ("Save recording… (Ctrl+S)", Purpose::SaveRecording),
                    ("Save run folder…", Purpose::SaveRun),
                    ("Save study…", Purpose::SaveStudy),
                    ("Create report…", Purpose::Report),
                    ("Export front…", Purpose::ExportFront),
                    ("Record design…", Purpose::RecordDesign),
                    ("Save picture…", Purpose::SavePicture),
                ] {
                    if ui.button(text).clicked() {
                        requested = Some(purpose);
                    }
                }
                ui.menu_button("Export design", |ui| {
                    for format in Format::ALL {
                        if ui.button(format!("{}…", format.title())).clicked() {
                            requested = Some(Purpose::ExportDesign(format));
                        }
                    }
                });
                let recent = self.recent.clone();
                ui.menu_button("Open recent", |ui| {
                    for path in recent {
                        if ui.button(path.display().to_string()).clicked() {
                            self.act(&ui.ctx().clone(), Purpose::Open, path);
                        }
                    }
                });
                if ui.button("Quit (Ctrl+Q)").clicked() {
                    ui.ctx().send_viewport_cmd(ViewportCommand::Close);
                }
            });
            ui.menu_button("Edit", |ui| {
                let (can_undo, can_redo) = (self.session.history.can_undo(), self.session.history.can_redo());
                if ui.add_enabled(can_undo, egui::Button::new("Undo (Ctrl+Z)")).clicked() {
                    self.session.history.undo();
                }
                if ui
                    .add_enabled(can_redo, egui::Button::new("Redo (Ctrl+Shift+Z)"))
                    .clicked()
                {
                    self.session.history.redo();
                }
            });
            ui.menu_button("View", |ui| {
                for panel in Panel::ALL {
                    if ui.button(panel.title()).clicked() {
                        self.show(panel);
                    }
                }
                ui.separator();
                if ui.button("Reset layout").clicked() {
                    self.tree = layout();
                }
                if ui
                    .button(if self.dark { "Light theme" } else { "Dark theme" })
                    .clicked()
                {
                    self.dark = !self.dark;
                    ui.ctx().set_theme(if self.dark {
                        egui::Theme::Dark
                    } else {
                        egui::Theme::Light
                    });
                }
            });
            if ui.button("?").on_hover_text("keyboard shortcuts").clicked() {
                self.help = !self.help;
            }
            ui.separator();
            ui.strong(&self.session.study().name);
            let phase = match self.session.phase() {
                Phase::Ready => "ready",
                Phase::Searching => "searching",
                Phase::Paused => "paused",
                Phase::Verifying { .. } => "verifying",
                Phase::Finished(_) => "finished",
                Phase::Failed => "failed",
                Phase::Opened(_) => "opened",
            };
            ui.weak(phase);
            if self.jobs > 0 {
                ui.weak("writing a file…");
            }
            if let Some(purpose) = requested {
                self.ask(&ui.ctx().clone(), purpose);
            }
        });
    }

    pub(super) fn notices(&mut self, ui: &mut Ui) {
        let mut away = None;
        for (index, notice) in self.session.notices.iter().enumerate() {
            ui.horizontal_wrapped(|ui| {
                if ui.small_button("×").clicked() {
                    away = Some(index);
                }
                let color = if notice.is_error {
                    theme::VIOLATED
                } else {
                    theme::SATISFIED
                };
                ui.colored_label(color, &notice.text);
            });
        }
        if let Some(index) = away {
            self.session.notices.remove(index);
        }
    }

    /// Shows a field for the path of the requested file, for systems without a file dialog. A choice made in a
    /// dialog is acted on as well.
    pub(super) fn path_field(&mut self, ui: &mut Ui) {
        let selected = self.dialog.as_ref().and_then(Dialog::choice);
        if let Some((purpose, path)) = selected {
            self.dialog = None;
            if let Some(path) = path {
                self.requested = None;
                self.act(&ui.ctx().clone(), purpose, path);
            }
        }
        let Some((purpose, mut path)) = self.requested.take() else {
            return;
        };
        let (mut open, mut done) = (true, false);
        egui::Window::new(purpose.title())
            .id(egui::Id::new("path"))
            .open(&mut open)
            .collapsible(false)
            .resizable(false)
            .anchor(egui::Align2::CENTER_TOP, [0.0, 60.0])
            .show(ui.ctx(), |ui| {
                let field = ui.add(
                    egui::TextEdit::singleline(&mut path)
                        .hint_text("path of the file or folder")
                        .desired_width(460.0),
                );
                ui.ctx().accesskit_node_builder(field.id, |node| node.set_label("Path"));
                let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
                ui.horizontal(|ui| {
                    done = (ui.button("OK").clicked() || entered) && !path.trim().is_empty();
                    if ui.button("Cancel").clicked() {
                        ui.close();
                    }
                });
            });
        if done {
            self.dialog = None;
            self.act(&ui.ctx().clone(), purpose, PathBuf::from(path.trim()));
        } else if open && !ui.input(|input| input.key_pressed(Key::Escape)) {
            self.requested = Some((purpose, path));
        } else {
            self.dialog = None;
        }
    }

    pub(super) fn help(&mut self, ui: &mut Ui) {
        egui::Window::new("Keyboard shortcuts")
            .open(&mut self.help)
            .resizable(false)
            .collapsible(false)
            .show(ui.ctx(), |ui| {
                egui::Grid::new("shortcuts")
                    .num_columns(2)
                    .spacing([24.0, 4.0])
                    .show(ui, |ui| {
                        for (keys, words) in SHORTCUTS {
                            ui.strong(keys);
                            ui.label(words);
                            ui.end_row();
                        }
                    });
                ui.separator();
                ui.weak("scatter: drag to pan, scroll to zoom, right-drag to zoom into a box, double-click to fit");
            });
    }
}
