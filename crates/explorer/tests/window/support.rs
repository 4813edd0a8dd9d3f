//! Helpers: a window without a screen, and a run to show in it.

use std::path::Path;
use std::time::{Duration, Instant};

use egui::accesskit::{Action, ActionData, ActionRequest, Role};
use egui::{Key, Modifiers, Pos2, Rect};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::DVec2;
use kinefront_explorer::{Explorer, InitialContent, Panel, Purpose, Selected};
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

/// What a window opens with: a study, which is run at once if `start` is true.
pub fn content(study: Study, start: bool) -> InitialContent {
    InitialContent::Study {
        study: Box::new(study),
        path: None,
        start,
    }
}

pub fn idle_window() -> Window {
    window(content(small_study(), false))
}

pub fn opened_window() -> Window {
    let mut window = window(InitialContent::Run(run_folder()));
    until_verified(&mut window);
    window
}

/// The study that is edited in a window.
pub fn edited(window: &Window) -> &Study {
    window.state().session().editor().study()
}

pub fn change_study(window: &mut Window, change: impl FnOnce(&mut Study)) {
    window.state_mut().session_mut().editor_mut().change(change);
}

pub fn selected(window: &Window) -> Selected {
    let selected = &window.state().session().document().selected;
    selected.clone().expect("a selected design")
}

/// The id of the selected design, which is one of the run.
pub fn selected_id(window: &Window) -> usize {
    let document = window.state().session().document();
    document.selected_id().expect("a design of the run")
}

pub fn show(window: &mut Window, panel: Panel) {
    window.state_mut().show(panel);
    window.run_steps(3);
}

/// Clicks what has a name.
pub fn click(window: &mut Window, name: &str) {
    window.get_by_label(name).click();
    window.run_steps(3);
}

pub fn press(window: &mut Window, key: Key) {
    window.key_press(key);
    window.run_steps(3);
}

pub fn press_with(window: &mut Window, modifiers: Modifiers, key: Key) {
    window.key_press_modifiers(modifiers, key);
    window.run_steps(3);
}

/// Opens or writes a file, and waits until that is done.
pub fn act(window: &mut Window, purpose: Purpose, path: &Path) {
    let ctx = window.ctx.clone();
    window.state_mut().act(&ctx, purpose, path.to_owned());
    until(window, "the work on the file ends", |explorer| !explorer.is_busy());
}

/// Returns what a label that contains some text says.
pub fn told(window: &Window, text: &str) -> Option<String> {
    let found = window.query_all_by_label_contains(text).next()?;
    found.value().or_else(|| found.accesskit_node().label())
}

/// Fails unless an error is told that contains some words.
pub fn assert_error(window: &Window, words: &str) {
    let notices = window.state().session().notices();
    let is_told = notices
        .iter()
        .any(|notice| notice.is_error && notice.text.contains(words));
    assert!(is_told, "{words}: {notices:?}");
}

/// Draws frames until the selected design is verified.
pub fn until_verified(window: &mut Window) {
    until(window, "the design is verified", |explorer| {
        explorer.session().known().is_some_and(|known| known.verified)
    });
}

/// Draws frames until `done` is true as a result of other threads; fails after two minutes.
pub fn until(window: &mut Window, what: &str, done: impl Fn(&Explorer) -> bool) {
    until_seen(window, what, |window| done(window.state()));
}

/// The same, for what the window shows.
pub fn until_seen(window: &mut Window, what: &str, done: impl Fn(&Window) -> bool) {
    let since = Instant::now();
    while !done(window) {
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
    release_at(window, at);
}

/// Releases the button of the mouse at a position, where the pointer stays.
fn release_at(window: &mut Window, pos: Pos2) {
    window.event(egui::Event::PointerButton {
        pos,
        button: egui::PointerButton::Primary,
        pressed: false,
        modifiers: Modifiers::NONE,
    });
    window.run_steps(3);
}

/// Drags the mouse along a path.
pub fn drag(window: &mut Window, path: &[Pos2]) {
    window.hover_at(path[0]);
    window.run_steps(2);
    window.drag_at(path[0]);
    window.run_steps(2);
    for &at in &path[1..] {
        window.hover_at(at);
        window.run_steps(2);
    }
    release_at(window, path[path.len() - 1]);
}

/// The plan view of the selected design.
pub struct TopView {
    pub rect: Rect,
    /// Screen points per metre.
    pub scale: f64,
}

impl TopView {
    pub fn of(window: &Window) -> Self {
        let design = selected(window).design;
        let half = 0.5 * (design.platform_radius() + design.link_length());
        let reach = 1.25 * design.base_radius().max(half);
        let rect = window.get_by_label("Top view").rect();
        let scale = 0.5 * f64::from(rect.width().min(rect.height())) / reach;
        Self { rect, scale }
    }

    pub fn screen(&self, at: DVec2) -> Pos2 {
        self.rect.center() + egui::vec2((at.x * self.scale) as f32, -(at.y * self.scale) as f32)
    }
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
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.step();
    type_keys(window, text);
}
