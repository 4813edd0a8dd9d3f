//! The status bar and the title of the window: the study, its run, its designs, the selected one, time and memory.

use egui::{Context, Ui, ViewportCommand};

use super::super::viewer;
use super::Explorer;
use super::menu::phase_name;
use crate::data::DesignOrigin;
use kinefront_scene::text;

impl Explorer {
    /// Draws the status bar.
    pub(super) fn status(&self, ui: &mut Ui) {
        let session = &self.session;
        ui.horizontal(|ui| {
            ui.label(format!("{}: {}", session.study().name, phase_name(session.phase())));
            ui.separator();
            ui.label(format!(
                "{} designs, {} on the front",
                session.store().len(),
                session.front().len()
            ));
            ui.separator();
            ui.label(match &session.document().selected {
                Some(selected) => {
                    let name = match selected.origin {
                        DesignOrigin::Evaluated(id) => format!("#{id}"),
                        DesignOrigin::Kept(_) => "kept design".to_owned(),
                        DesignOrigin::Wished(_) => "result of a wish".to_owned(),
                        DesignOrigin::Modified { .. } => "modified design".to_owned(),
                        DesignOrigin::Reference(_) => "reference design".to_owned(),
                    };
                    format!(
                        "selected: {name}, {}",
                        text::architecture(selected.design.architecture())
                    )
                }
                None => "no design selected".to_owned(),
            });
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if let Some(bytes) = viewer::resident_memory() {
                    ui.weak(format!("{} MB", bytes / 1_000_000));
                }
                let seconds = session.elapsed().as_secs_f64();
                if seconds > 0.0 {
                    ui.weak(format!("{seconds:.1} s"));
                }
            });
        });
    }

    /// Gives the window its title, if that has changed.
    pub(super) fn retitle(&mut self, ctx: &Context) {
        let session = &self.session;
        let title = format!("{} ({}) – Kinefront", session.study().name, phase_name(session.phase()));
        if self.title != title {
            ctx.send_viewport_cmd(ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }
}
