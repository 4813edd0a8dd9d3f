//! The menu bar, the notices, and the path and shortcut windows above the panels.

use std::path::PathBuf;

use egui::{Key, Ui, ViewportCommand};

use super::super::files::{Dialog, Purpose};
use super::super::panels::{add_named, named};
use super::super::{Panel, Phase, theme};
use super::shortcuts::SHORTCUTS;
use super::{Explorer, layout};
use kinefront_export::Format;
use kinefront_study::ConclusionPart;

/// Entries of the menu "File" that select a file first.
const FILE_ENTRIES: [(&str, Purpose); 10] = [
    ("Open… (Ctrl+O)", Purpose::Open),
    ("Open run folder…", Purpose::OpenFolder),
    ("Compare with run…", Purpose::OpenBeside),
    ("Save recording… (Ctrl+S)", Purpose::SaveRecording),
    ("Save run folder…", Purpose::SaveRun),
    ("Save study…", Purpose::SaveStudy),
    ("Create report…", Purpose::Report),
    ("Export front…", Purpose::ExportFront),
    ("Record design…", Purpose::RecordDesign),
    ("Save picture…", Purpose::SavePicture),
];

impl Explorer {
    /// Draws the menu bar.
    pub(super) fn menu(&mut self, ui: &mut Ui) {
        egui::MenuBar::new().ui(ui, |ui| {
            let requested = ui.menu_button("File", |ui| self.file_menu(ui)).inner.flatten();
            ui.menu_button("Edit", |ui| self.edit_menu(ui));
            ui.menu_button("View", |ui| self.view_menu(ui));
            ui.menu_button("Help", |ui| {
                if ui.button("Keyboard shortcuts (?)").clicked() {
                    self.help = true;
                }
                if ui.button("What you see").clicked() {
                    self.introduction = true;
                }
            });
            if self.jobs > 0 {
                ui.weak("writing a file…");
            }
            if let Some(purpose) = requested {
                self.ask(&ui.ctx().clone(), purpose);
            }
        });
    }

    /// Draws the menu "File"; returns the purpose of the file that the user wants to select.
    fn file_menu(&mut self, ui: &mut Ui) -> Option<Purpose> {
        let mut requested = None;
        for (text, purpose) in FILE_ENTRIES {
            if ui.button(text).clicked() {
                requested = Some(purpose);
            }
        }
        if ui.button("New study from an example").clicked() {
            self.show(Panel::Examples);
        }
        ui.menu_button("Export design", |ui| {
            for &format in Format::ALL {
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
        requested
    }

    fn edit_menu(&mut self, ui: &mut Ui) {
        let session = &mut self.session;
        let undo = egui::Button::new("Undo (Ctrl+Z)");
        if ui.add_enabled(session.can_undo(), undo).clicked() {
            session.undo();
        }
        let redo = egui::Button::new("Redo (Ctrl+Shift+Z)");
        if ui.add_enabled(session.can_redo(), redo).clicked() {
            session.redo();
        }
    }

    fn view_menu(&mut self, ui: &mut Ui) {
        for &panel in Panel::ALL {
            if ui.button(panel.title()).clicked() {
                self.show(panel);
            }
        }
        ui.separator();
        if ui.button("Reset layout").clicked() {
            self.tree = layout();
        }
        let other = if self.dark { "Light theme" } else { "Dark theme" };
        if ui.button(other).clicked() {
            self.dark = !self.dark;
            ui.ctx().set_theme(egui::Theme::from_dark_mode(self.dark));
        }
    }

    pub(super) fn notices(&mut self, ui: &mut Ui) {
        let mut away = None;
        for (index, notice) in self.session.notices().iter().enumerate() {
            ui.horizontal_wrapped(|ui| {
                if named(ui.small_button("×"), "Close this message").clicked() {
                    away = Some(index);
                }
                let color = if notice.is_error {
                    theme::bad(ui)
                } else {
                    theme::good(ui)
                };
                ui.colored_label(color, &notice.text);
            });
        }
        if let Some(index) = away {
            self.session.dismiss(index);
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
                let field = egui::TextEdit::singleline(&mut path)
                    .hint_text("path of the file or folder")
                    .desired_width(460.0);
                let field = add_named(ui, field, "Path");
                if std::mem::take(&mut self.asks_anew) {
                    field.request_focus();
                }
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

    /// Says at the first start what the window shows, until it is closed.
    pub(super) fn introduction(&mut self, ui: &mut Ui) {
        const LINES: [(&str, &str); 6] = [
            (
                "Run",
                "starts the search of the study, which Examples, Study and Mechanisms change",
            ),
            (
                "Scatter",
                "shows every design as it is evaluated; a click selects one, and the line is the front",
            ),
            (
                "3-D",
                "shows the selected design; hover for details, drag the platform to move it, or click the heatmap",
            ),
            (
                "Inspector",
                "shows its dimensions, which the sliders change, its workspace and its constraints",
            ),
            ("Pose", "moves the platform; Layers chooses what is drawn"),
            (
                "Front",
                "lists the designs of the front; the File menu saves, exports and creates reports",
            ),
        ];
        let mut is_open = self.introduction;
        let mut done = false;
        egui::Window::new("What you see")
            .open(&mut is_open)
            .resizable(false)
            .collapsible(false)
            // Below the 3-D view, which it explains.
            .anchor(egui::Align2::CENTER_BOTTOM, egui::vec2(0.0, -40.0))
            .show(ui.ctx(), |ui| {
                explanations(ui, "introduction", [18.0, 6.0], &LINES);
                ui.separator();
                done = ui.button("Close").clicked();
            });
        self.introduction = is_open && !done;
    }

    pub(super) fn help(&mut self, ui: &mut Ui) {
        egui::Window::new("Keyboard shortcuts")
            .open(&mut self.help)
            .resizable(false)
            .collapsible(false)
            .show(ui.ctx(), |ui| {
                explanations(ui, "shortcuts", [24.0, 4.0], &SHORTCUTS);
                ui.separator();
                ui.weak("scatter: drag to pan, scroll to zoom, right-drag to zoom into a box, double-click to fit");
            });
    }
}

/// Shows lines of what is explained and what it is or does.
fn explanations(ui: &mut Ui, id: &str, spacing: [f32; 2], lines: &[(&str, &str)]) {
    let grid = egui::Grid::new(id).num_columns(2).spacing(spacing);
    grid.show(ui, |ui| {
        for (explained, words) in lines {
            ui.strong(*explained);
            ui.label(*words);
            ui.end_row();
        }
    });
}

pub(super) fn phase_name(phase: &Phase) -> &'static str {
    match phase {
        Phase::Ready => "ready",
        Phase::Searching => "searching",
        Phase::Paused => "paused",
        Phase::Concluding { part, .. } => match part {
            ConclusionPart::Verification => "verifying",
            ConclusionPart::Proofs => "proving",
        },
        Phase::Finished(_) => "finished",
        Phase::Failed => "failed",
        Phase::Opened(_) => "opened",
    }
}
