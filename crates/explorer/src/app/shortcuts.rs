//! Keyboard shortcuts.

use egui::{Context, Event, Key, KeyboardShortcut, Modifiers, ViewportCommand};

use super::super::Phase;
use super::super::files::Purpose;
use super::Explorer;
use kinefront_recording::Viewpoint;

const UNDO: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::Z);
const REDO: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);
const REDO_TOO: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::Y);
const OPEN: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::O);
const SAVE: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::S);
const QUIT: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::Q);

const START: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::R);

/// Keys and descriptions of the shortcuts, as listed in the window.
pub(super) const SHORTCUTS: [(&str, &str); 18] = [
    ("←  →", "select the previous or next design of the front"),
    ("K", "select the knee of the front"),
    ("P", "pin or unpin the selected design"),
    ("S", "star or unstar the selected design"),
    (
        "Alt+arrows, Alt+PageUp/Down",
        "move the platform by a hundredth of R, turn it by 1°",
    ),
    (
        "1  2  3  4",
        "look at the manipulator obliquely, from the top, the front, the side",
    ),
    ("Ctrl+R", "start the study of the panel Run"),
    ("Space", "pause or resume the run"),
    ("G", "run one generation, then pause"),
    ("Ctrl+C, Ctrl+V", "copy the selected design as text, paste a design"),
    ("Ctrl+Z, Ctrl+Shift+Z", "undo, redo"),
    ("Ctrl+O", "open a study, a run or a recording"),
    ("Ctrl+S", "save the session's recording"),
    ("Ctrl+Q", "quit"),
    ("F", "turn the filter for feasible designs on or off"),
    ("Esc", "close messages and dialogs"),
    ("F1", "what you see"),
    ("?", "show or hide this list"),
];

impl Explorer {
    /// Handles the keys that no text field has taken.
    pub(super) fn shortcuts(&mut self, ctx: &Context) {
        // A dialog has the keyboard as long as it asks.
        if ctx.text_edit_focused() || self.requested.is_some() {
            return;
        }
        self.menu_shortcuts(ctx);
        self.platform_keys(ctx);
        self.session_keys(ctx);
        let typed = |text: &str| {
            let is_typed = |event: &Event| matches!(event, Event::Text(typed) if typed == text);
            ctx.input(|input| input.events.iter().any(is_typed))
        };
        if typed("?") {
            self.help = !self.help;
        }
        self.clipboard(ctx);
    }

    fn menu_shortcuts(&mut self, ctx: &Context) {
        let pressed = |shortcut: &KeyboardShortcut| ctx.input_mut(|input| input.consume_shortcut(shortcut));
        // Shortcuts with more modifiers come first: a shortcut also matches while additional modifiers are held.
        if pressed(&REDO) || pressed(&REDO_TOO) {
            self.session.redo();
        } else if pressed(&UNDO) {
            self.session.undo();
        }
        if pressed(&OPEN) {
            self.ask(ctx, Purpose::Open);
        }
        if pressed(&SAVE) {
            self.ask(ctx, Purpose::SaveRecording);
        }
        if pressed(&QUIT) {
            ctx.send_viewport_cmd(ViewportCommand::Close);
        }
        if pressed(&START) && !self.session.is_running() {
            self.session.start();
        }
        if ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::F1)) {
            self.introduction = true;
        }
    }

    /// Moves the platform, and looks at the manipulator from another side.
    fn platform_keys(&mut self, ctx: &Context) {
        const MOVES: [(Key, [f64; 3]); 6] = [
            (Key::ArrowRight, [1.0, 0.0, 0.0]),
            (Key::ArrowLeft, [-1.0, 0.0, 0.0]),
            (Key::ArrowUp, [0.0, 1.0, 0.0]),
            (Key::ArrowDown, [0.0, -1.0, 0.0]),
            (Key::PageUp, [0.0, 0.0, 1.0]),
            (Key::PageDown, [0.0, 0.0, -1.0]),
        ];
        for (key, steps) in MOVES {
            if ctx.input_mut(|input| input.consume_key(Modifiers::ALT, key)) {
                self.session.nudge(steps);
            }
        }
        for (key, viewpoint) in [Key::Num1, Key::Num2, Key::Num3, Key::Num4]
            .into_iter()
            .zip(Viewpoint::ALL)
        {
            if ctx.input_mut(|input| input.consume_key(Modifiers::NONE, key)) {
                self.session.look_from(viewpoint);
            }
        }
    }

    fn session_keys(&mut self, ctx: &Context) {
        let session = &mut self.session;
        let key = |key: Key| ctx.input_mut(|input| input.consume_key(Modifiers::NONE, key));
        if key(Key::ArrowRight) {
            session.walk(1);
        }
        if key(Key::ArrowLeft) {
            session.walk(-1);
        }
        if key(Key::K) {
            session.select_knee();
        }
        if key(Key::P) {
            session.toggle_pin();
        }
        if key(Key::S) {
            session.toggle_star();
        }
        if key(Key::G) {
            session.step();
        }
        if key(Key::F) {
            session.edit(|document| document.filter.feasible_only ^= true);
        }
        if key(Key::Space) {
            match session.phase() {
                Phase::Searching => session.pause(),
                Phase::Paused => session.resume(),
                _ => {}
            }
        }
        // A field that Escape restores has lost the focus already, and must see the key, too.
        if ctx.input(|input| input.key_pressed(Key::Escape)) {
            session.dismiss_all();
            self.help = false;
        }
    }

    /// Copies the selected design as text, or selects the design in the clipboard.
    fn clipboard(&mut self, ctx: &Context) {
        let (copied, pasted) = ctx.input(|input| {
            let copied = input.events.iter().any(|event| matches!(event, Event::Copy));
            let pasted = input.events.iter().find_map(|event| match event {
                Event::Paste(text) => Some(text.clone()),
                _ => None,
            });
            (copied, pasted)
        });
        if copied && let Some(selected) = &self.session.document().selected {
            ctx.copy_text(selected.design.to_string());
        }
        if let Some(text) = pasted {
            self.session.paste(&text);
        }
    }
}
