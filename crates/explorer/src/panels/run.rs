//! The run panel: the study and the optimizer's settings, the run's controls, and its progress.

use egui::{Button, ComboBox, DragValue, Grid, ProgressBar, Ui};

use super::progress::ProgressPlot;
use super::{button, button_if, typed};
use crate::{Phase, Session, theme};
use kinefront_study::{AlgorithmName, BUILTIN, ConclusionPart, EndReason};

/// The run panel.
#[derive(Default)]
pub struct RunPanel {
    plot: ProgressPlot,
}

impl RunPanel {
    /// Draws the panel.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        study(ui, session);
        settings(ui, session);
        ui.add_space(4.0);
        buttons(ui, session);
        ui.add_space(4.0);
        progress(ui, session);
        self.plot.ui(ui, session);
    }
}

fn study(ui: &mut Ui, session: &mut Session) {
    ui.horizontal(|ui| {
        ui.label("study");
        let mut picked = None;
        ComboBox::from_id_salt("study")
            .selected_text(session.editor().study().name.clone())
            .show_ui(ui, |ui| {
                for builtin in BUILTIN {
                    let here = session.editor().study().name == builtin.name;
                    if ui.selectable_label(here, builtin.name).clicked() {
                        picked = Some(builtin);
                    }
                }
            });
        if let Some(builtin) = picked {
            session.edit_builtin(&builtin);
        }
        if session.editor().is_changed() {
            ui.weak("changed");
        }
    });
    let description = session.editor().study().description.clone();
    ui.add(egui::Label::new(egui::RichText::new(description).weak()).truncate());
}

fn settings(ui: &mut Ui, session: &mut Session) {
    let mut study = session.editor().study().clone();
    // All four settings in two rows need this width [points].
    let is_narrow = ui.available_width() < 400.0;
    Grid::new("run settings").num_columns(4).show(ui, |ui| {
        algorithm(ui, &mut study.optimizer.algorithm);
        if is_narrow {
            ui.end_row();
        }
        let label = ui.label("evaluations");
        ui.add(
            typed(ui, DragValue::new(&mut study.optimizer.evaluations))
                .range(1..=100_000_000)
                .speed(50),
        )
        .labelled_by(label.id);
        ui.end_row();
        seed(ui, &mut study.optimizer.seed);
        if is_narrow {
            ui.end_row();
        }
        threads(ui, &mut study.optimizer.threads);
        ui.end_row();
    });
    session.editor_mut().change(|edited| *edited = study);
    for fault in session.editor().faults() {
        ui.colored_label(theme::bad(ui), format!("`{}` {}", fault.key, fault.message));
    }
}

fn algorithm(ui: &mut Ui, chosen: &mut AlgorithmName) {
    let label = ui.label("algorithm");
    ComboBox::from_id_salt("algorithm")
        .selected_text(chosen.to_string())
        .width(80.0)
        .show_ui(ui, |ui| {
            for name in AlgorithmName::ALL {
                ui.selectable_value(chosen, name, name.to_string());
            }
        })
        .response
        .labelled_by(label.id);
}

fn seed(ui: &mut Ui, seed: &mut u64) {
    let label = ui.label("seed");
    ui.horizontal(|ui| {
        ui.add(typed(ui, DragValue::new(seed)).range(0..=i64::MAX as u64).speed(0.1))
            .labelled_by(label.id);
        if button(ui, "random", "draws a random seed") {
            *seed = random_seed();
        }
    });
}

fn threads(ui: &mut Ui, stated: &mut Option<usize>) {
    let label = ui.label("threads");
    ui.horizontal(|ui| {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let mut threads = stated.unwrap_or(cores);
        let field = ui
            .add(typed(ui, DragValue::new(&mut threads)).range(1..=1024).speed(0.05))
            .labelled_by(label.id);
        if field.changed() {
            *stated = Some(threads);
        }
        ui.weak(if stated.is_none() { "all cores" } else { "fixed" });
    });
}

/// Returns a random seed of up to four digits, which is short enough to pass on to others.
fn random_seed() -> u64 {
    let mut bytes = [0; 2];
    // Without a source of randomness the seed is 0, which is as valid as any other.
    let _ = getrandom::fill(&mut bytes);
    u64::from(u16::from_le_bytes(bytes)) % 10_000
}

/// The button for what a person would do next: start, pause or resume. `valid` says whether the study as edited can be searched.
fn main_button(ui: &mut Ui, session: &mut Session, valid: bool) {
    match session.phase() {
        Phase::Searching => {
            if button(ui, "⏸ Pause", "pauses after the current generation (Space)") {
                session.pause();
            }
        }
        Phase::Paused => {
            if button(ui, "▶ Resume", "resumes the search (Space)") {
                session.resume();
            }
        }
        Phase::Concluding { .. } => {
            ui.add_enabled(false, Button::new("⏸ Pause"));
        }
        _ => {
            let start = theme::primary("▶ Start");
            let why = "the study has errors; see the panel Study";
            if ui.add_enabled(valid, start).on_disabled_hover_text(why).clicked() {
                session.start();
            }
            let hint = "continues the search in the folder of this run; a larger budget extends it";
            if session.continuable().is_some() && button(ui, "▶ Continue", hint) {
                session.continue_run();
            }
        }
    }
}

fn buttons(ui: &mut Ui, session: &mut Session) {
    ui.horizontal_wrapped(|ui| {
        let valid = session.editor().text_fault().is_none();
        main_button(ui, session, valid);
        let can_step = matches!(session.phase(), Phase::Searching | Phase::Paused);
        let why_not = "only while a search runs or is paused";
        let hints = ["runs one generation, then pauses (G)", why_not];
        if button_if(ui, can_step, Button::new("⏭ Step"), hints) {
            session.step();
        }
        let hint = "ends the search; its front is verified and all designs are kept";
        if button_if(ui, can_step, Button::new("⏹ Stop"), [hint, why_not]) {
            session.stop();
        }
        let hints = [
            "discards the current run and starts again with the study as edited here",
            "only during a run, and only if the study has no errors",
        ];
        if button_if(ui, valid && session.is_running(), Button::new("⟲ Restart"), hints) {
            session.start();
        }
    });
}

fn progress(ui: &mut Ui, session: &Session) {
    let budget = session.study().optimizer.evaluations;
    let done = session.store().len();
    let seconds = session.elapsed().as_secs_f64();
    let (fraction, text) = match session.phase() {
        Phase::Concluding { part, done, total } => {
            let fraction = *done as f32 / (*total).max(1) as f32;
            let what = match part {
                ConclusionPart::Verification => "verifying on the fine grid",
                ConclusionPart::Proofs => "proving the workspaces",
            };
            (fraction, format!("{what}: {done} of {total}"))
        }
        _ => (
            done as f32 / budget.max(1) as f32,
            format!("{done} of {budget} evaluations"),
        ),
    };
    // Beside the bar, because text in it would lie on two grounds.
    let bar = ui.add(ProgressBar::new(fraction).desired_height(8.0));
    bar.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::ProgressIndicator, true, "Progress"));
    let words = match session.phase() {
        Phase::Ready => "ready".to_owned(),
        Phase::Searching => {
            let rate = done as f64 / seconds.max(1e-3);
            let left = (budget.saturating_sub(done)) as f64 / rate.max(1e-3);
            format!("{rate:.0} designs/s, {left:.0} s left")
        }
        Phase::Paused => "paused".to_owned(),
        Phase::Concluding { .. } => "search finished".to_owned(),
        Phase::Finished(EndReason::Completed) => format!("finished in {seconds:.1} s"),
        Phase::Finished(EndReason::TimeUp) => format!("time limit reached after {seconds:.1} s"),
        Phase::Finished(EndReason::Stagnated) => format!("stagnated after {seconds:.1} s"),
        Phase::Finished(EndReason::Stopped) => format!("stopped after {seconds:.1} s"),
        Phase::Finished(EndReason::Interrupted) => format!("interrupted after {seconds:.1} s"),
        Phase::Failed => "failed".to_owned(),
        Phase::Opened(path) => format!(
            "opened {}",
            path.file_name().unwrap_or(path.as_os_str()).to_string_lossy()
        ),
    };
    ui.label(format!("{text}, {words}"));
    if let Some(last) = session.generations().last() {
        ui.weak(format!(
            "generation {}, {} feasible, {} on the front{}",
            last.generation,
            last.feasible,
            session.front().len(),
            session
                .threads()
                .map_or(String::new(), |threads| format!(", {threads} threads")),
        ));
    }
}
