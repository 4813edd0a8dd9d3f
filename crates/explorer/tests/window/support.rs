//! Helpers: a window without a screen, and a run to show in it.

use std::time::{Duration, Instant};

use egui::accesskit::{Action, ActionData, ActionRequest, Role};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use kinefront_explorer::{Explorer, InitialContent};
use kinefront_study::Study;
use kinefront_testkit::{DESIGN, run_folder};

/// Returns a small study, which runs quickly and has all three architectures.
pub fn small_study() -> Study {
    let text = format!(
        "{}threads = 2
[[references]]
name = \"ID-II\"
design = \"{DESIGN}\"
mass_kg = 484.8
workspace_radius_m = 1.207
",
        kinefront_testkit::small_study(300)
    );
    Study::parse(&text, "small").expect("a valid study")
}

pub type Window = Harness<'static, Explorer>;

/// Opens a window on `subject`, without the embedded viewer.
pub fn window(subject: InitialContent) -> Window {
    Harness::builder()
        .with_size(egui::vec2(1600.0, 1000.0))
        .with_step_dt(1.0 / 60.0)
        .with_max_steps(64)
        .build_eframe(move |cc| Explorer::new(cc, subject, None, false).expect("a window"))
}

pub fn idle_window() -> Window {
    window(InitialContent::Study {
        study: Box::new(small_study()),
        path: None,
        start: false,
    })
}

pub fn opened_window() -> Window {
    let mut window = window(InitialContent::Run(run_folder()));
    until(&mut window, "the design is verified", |explorer| {
        explorer.session().known().is_some_and(|known| known.verified)
    });
    window
}

/// Draws frames until `done` is true as a result of other threads; fails after two minutes.
pub fn until(window: &mut Window, what: &str, done: impl Fn(&Explorer) -> bool) {
    let since = Instant::now();
    while !done(window.state()) {
        assert!(since.elapsed() < Duration::from_secs(120), "timed out: {what}");
        std::thread::sleep(Duration::from_millis(5));
        window.step();
    }
    window.run_steps(3);
}

/// Draws frames until the number of generations stays the same: the messages on their way have arrived. Fails after
/// two minutes.
pub fn until_settled(window: &mut Window) {
    let since = Instant::now();
    let (mut before, mut same) = (0, 0);
    while same < 20 {
        assert!(since.elapsed() < Duration::from_secs(120), "timed out: the run goes on");
        std::thread::sleep(Duration::from_millis(5));
        window.step();
        let now = window.state().session().generations().len();
        same = if now == before { same + 1 } else { 0 };
        before = now;
    }
}

/// Sets a slider to a value, as assistive technology would.
pub fn set_slider(window: &mut Window, label: &str, value: f64) {
    let (target_node, target_tree) = window
        .get_by_role_and_label(Role::Slider, label)
        .accesskit_node()
        .locate();
    window.event(egui::Event::AccessKitActionRequest(ActionRequest {
        action: Action::SetValue,
        target_node,
        target_tree,
        data: Some(ActionData::NumericValue(value)),
    }));
    window.run_steps(2);
}

/// Clicks the mouse at a position.
pub fn click_at(window: &mut Window, at: egui::Pos2) {
    window.hover_at(at);
    window.run_steps(2);
    window.drag_at(at);
    window.run_steps(1);
    window.event(egui::Event::PointerButton {
        pos: at,
        button: egui::PointerButton::Primary,
        pressed: false,
        modifiers: egui::Modifiers::NONE,
    });
    window.run_steps(3);
}

/// The text that the last frame put on the clipboard.
pub fn copied_text(window: &Window) -> Option<String> {
    let commands = &window.output().platform_output.commands;
    commands.iter().find_map(|command| match command {
        egui::OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    })
}

/// Types a text key by key, with a frame after each.
pub fn type_keys(window: &mut Window, text: &str) {
    for key in text.chars() {
        window.event(egui::Event::Text(key.to_string()));
        window.step();
    }
}

/// Replaces the text of the field of a number by what is typed, and leaves the field as it is.
pub fn type_into(window: &mut Window, name: &str, text: &str) {
    window.get_by_role_and_label(Role::SpinButton, name).focus();
    window.run_steps(2);
    window.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
    window.step();
    type_keys(window, text);
}
