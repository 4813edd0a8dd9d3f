//! The vibration panel: the natural frequencies of the selected design at its pose, and each vibration as a slow motion in 3-D.

use egui::{Grid, ScrollArea, Slider, Ui};
use kinefront_scene::{VibrationMode, text::number};

use super::{fields, play_button};
use crate::{Session, ShownVibration, theme};

/// Vibrations shown per second.
const SHOWN_RATE: f64 = 0.7;

/// The vibration panel.
pub struct VibrationPanel {
    /// Whether the vibration is being played.
    is_playing: bool,
    /// Displacement of the point that moves most, as a share of `R`.
    amplitude: f64,
    /// Phase of the vibration \[turns\].
    phase: f64,
}

impl Default for VibrationPanel {
    fn default() -> Self {
        Self {
            is_playing: true,
            amplitude: 0.08,
            phase: 0.0,
        }
    }
}

impl VibrationPanel {
    /// Draws the panel.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        let Some(known) = session.known() else {
            ui.weak("Click a design in the scatter to see its natural frequencies and mode shapes here.");
            return;
        };
        let lever = known.evaluation.design.platform_radius();
        let dynamics = session.pose_dynamics();
        let report = dynamics.and_then(|known| known.report);
        let of_frame = dynamics.and_then(|known| known.frame_frequencies);
        let modes = dynamics.and_then(|known| Some(known.vibrations.as_ref()?.modes.clone()));
        ScrollArea::vertical().show(ui, |ui| {
            match (report, modes) {
                (Some(report), Some(modes)) => {
                    self.modes(ui, session, &modes, lever);
                    let bars = number(report.bar_frequency);
                    let lowest = of_frame.map_or(String::new(), |[in_plane, out_of_plane]| {
                        let [in_plane, out_of_plane] = [in_plane, out_of_plane].map(number);
                        format!(
                            "With three finite elements per bar, the lowest ones are {in_plane} Hz in the plane and \
                             {out_of_plane} Hz out of it. "
                        )
                    });
                    ui.weak(format!(
                        "These frequencies leave out that the bars also vibrate between their ends. {lowest}The leg bars \
                         alone bend at {bars} Hz."
                    ));
                }
                (Some(_), None) => {
                    ui.label("Natural frequencies are not available for rails that bend.");
                }
                (None, _) => {
                    ui.colored_label(theme::bad(ui), "At a singular pose there are no natural frequencies.");
                }
            }
            ui.separator();
            ui.weak("With the payload, joints and drives of the study being edited:");
            fields::of_sections(ui, session, &["payload", "joints", "drives"]);
        });
    }

    /// Shows the frequencies, and the one that is selected as a motion.
    fn modes(&mut self, ui: &mut Ui, session: &mut Session, modes: &[VibrationMode], lever: f64) {
        let mut selected = session.view().vibration.map(|shown| shown.mode);
        let is_wide = ui.available_width() > 310.0;
        Grid::new("natural frequencies")
            .num_columns(3)
            .spacing([14.0, 3.0])
            .show(ui, |ui| {
                for (place, mode) in modes.iter().enumerate() {
                    let is_selected = selected == Some(place);
                    let name = format!("{} Hz", number(mode.frequency));
                    if ui.selectable_label(is_selected, name).clicked() {
                        selected = (!is_selected).then_some(place);
                    }
                    let plane = if mode.is_in_plane {
                        "in the plane"
                    } else {
                        "out of the plane"
                    };
                    let words = ui.label(mode.words(lever));
                    if is_wide {
                        ui.weak(plane);
                    } else {
                        words.on_hover_text(plane);
                    }
                    ui.end_row();
                }
            });
        let Some(mode) = selected else {
            session.view_mut().vibration = None;
            ui.weak("Select a frequency to see its mode shape in 3-D, much enlarged and slowed down.");
            return;
        };
        ui.horizontal(|ui| {
            play_button(ui, &mut self.is_playing);
            let label = ui.label("amplitude").id;
            let slider =
                Slider::new(&mut self.amplitude, 0.01..=0.3).custom_formatter(|share, _| format!("{share:.2} R"));
            ui.add(slider).labelled_by(label);
            if ui.button("Hide").clicked() {
                selected = None;
            }
        });
        if self.is_playing {
            let passed = f64::from(ui.input(|input| input.stable_dt));
            self.phase = (self.phase + SHOWN_RATE * passed).fract();
            ui.ctx().request_repaint();
        }
        // Still, the bars are shown where they bend most.
        let turn = if self.is_playing { self.phase } else { 0.25 };
        let share = self.amplitude * libm::sin(2.0 * std::f64::consts::PI * turn);
        session.view_mut().vibration = selected.map(|_| ShownVibration { mode, share });
    }
}
