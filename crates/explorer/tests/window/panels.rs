//! Snapshots of every panel in the light and the dark theme, all of the same run.
//!
//! `UPDATE_SNAPSHOTS=1` replaces the snapshots that differ. A software renderer draws them if there is one, so that the
//! pictures are the same on all machines.

use egui_kittest::{Harness, SnapshotOptions, SnapshotResults};
use kinefront_explorer::{Panel, Panels, Session, StudyEditor, dress};

use kinefront_model::evaluation::Quantity;
use kinefront_study::{Column, TaskShapeChoice};
use kinefront_testkit::run_folder;

use super::support::small_study;

/// Returns a session that contains everything that a panel can show.
fn session(panel: Panel) -> Session {
    let mut session =
        Session::new(StudyEditor::new(small_study(), None), None, std::sync::Arc::new(|| {})).expect("a session");
    session.open(&run_folder());
    let front: Vec<usize> = session.front().iter().map(|entry| entry.id).collect();
    for place in [0, front.len() / 2, front.len() - 1] {
        session.select(front[place]);
        session.toggle_pin();
    }
    session.select_knee();
    session.toggle_star();
    session.edit(|document| {
        document.notes.insert(front[1], "the one to build".to_owned());
        document
            .filter
            .set_range(Column::Quantity(Quantity::WorkspaceRadius), Some([0.2, 1.5]));
    });
    if panel == Panel::Motion {
        session
            .editor_mut()
            .change(|study| study.task.go(TaskShapeChoice::Star));
    }
    let point = [(Quantity::Mass, 40.0), (Quantity::WorkspaceRadius, 1.2)];
    session.ask_why(&point);
    for _ in 0..4000 {
        session.update();
        let is_answered = match panel {
            Panel::Drivers => session.drivers().is_some() && session.drivers_with_steps().is_some(),
            Panel::Prices => session.drivers_along().is_some(),
            Panel::WhyNot => session.why().is_some(),
            Panel::Motion => session.motion().is_some(),
            _ => true,
        };
        if is_answered && session.known().is_some_and(|known| known.verified) && session.is_drawn() {
            return session;
        }
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    panic!("the design was not verified");
}

fn size(panel: Panel) -> egui::Vec2 {
    match panel {
        Panel::Scatter => egui::vec2(560.0, 480.0),
        Panel::Front | Panel::Parallel | Panel::Compare | Panel::Motion => egui::vec2(820.0, 360.0),
        Panel::Pose => egui::vec2(400.0, 560.0),
        Panel::Examples => egui::vec2(480.0, 760.0),
        _ => egui::vec2(420.0, 520.0),
    }
}

/// Returns what draws a panel of a session that contains everything, in a frame of the window's style.
pub(super) fn drawing(panel: Panel, theme: egui::Theme) -> impl FnMut(&mut egui::Ui) {
    let (mut session, mut panels, mut dressed) = (session(panel), Panels::default(), false);
    if panel == Panel::Beside {
        session.open_beside(&run_folder());
    }
    move |ui| {
        if !dressed {
            dress(ui.ctx());
            ui.ctx().set_theme(theme);
            dressed = true;
            return;
        }
        egui::Frame::central_panel(ui.style()).show(ui, |ui| {
            session.update();
            panels.ui(panel, ui, &mut session);
        });
    }
}

#[test]
fn every_panel_looks_as_it_did() {
    let mut results = SnapshotResults::new();
    for theme in [egui::Theme::Dark, egui::Theme::Light] {
        for &panel in Panel::ALL.iter().filter(|panel| **panel != Panel::Scene) {
            let mut harness = Harness::builder()
                .with_size(size(panel))
                .with_theme(theme)
                .with_step_dt(1.0 / 60.0)
                // The edges of letters and lines differ slightly between graphics drivers.
                .with_options(SnapshotOptions::new().threshold(2.0).max_failed_pixels(300))
                .wgpu()
                .build_ui(drawing(panel, theme));
            // Drawing the cloud of designs takes several frames, and so do a layout that measures itself and the pictures of examples.
            harness.run_steps(16);
            harness.snapshot(format!(
                "{}_{}",
                panel.title().replace(' ', "_").to_lowercase(),
                name(theme)
            ));
            results.extend_harness(&mut harness);
        }
    }
}

fn name(theme: egui::Theme) -> &'static str {
    match theme {
        egui::Theme::Dark => "dark",
        egui::Theme::Light => "light",
    }
}
