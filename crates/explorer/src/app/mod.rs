//! The window: menu, panels, shortcuts, notices, and the state that is saved between two sessions.

mod deliveries;
mod focus;
mod layout;
mod menu;
mod remembered;
mod script;
mod shortcuts;
mod status;

pub use script::{Script, ScriptError};

use crate::AnyError;
use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

use egui::{Context, Ui, UserData, ViewportCommand};
use egui_tiles::Tree;

use self::deliveries::PendingScreenshot;
use self::focus::FocusRing;
use self::layout::{Drawing, layout};
use self::remembered::Remembered;
use super::files::{self, Dialog, Job, Purpose};
use super::panels::scatter::{Scatter, ScatterAxis, objective_columns};
use super::panels::{Panel, Panels};
use super::platform_drag::PlatformDrag;
use super::viewer::Viewer;
use super::{Phase, Session, StudyEditor, Subject, theme};
use kinefront_study::Study;

/// Content that the window opens with.
#[derive(Debug, Clone)]
pub enum InitialContent {
    /// A study, which is run at once if `start` is true.
    Study {
        /// The study.
        study: Box<Study>,
        /// File that the study was read from.
        path: Option<PathBuf>,
        /// Whether its run starts at once.
        start: bool,
    },
    /// Path of a run folder, of one of its tables, or of a recording.
    Run(PathBuf),
}

/// Result of a file job: the message to show on success or on failure.
type Ended = Result<String, AnyError>;

/// Shortest and longest interval between two frames that worker threads request \[ms\].
const QUICKEST: u64 = 8;
const SLOWEST: u64 = 400;

/// Number of recently opened files that are saved.
const RECENT: usize = 8;

/// The explorer's window.
pub struct Explorer {
    session: Session,
    panels: Panels,
    tree: Tree<Panel>,
    viewer: Option<Viewer>,
    platform_drag: PlatformDrag,
    focus_ring: FocusRing,
    script: Option<Script>,
    recent: Vec<PathBuf>,
    dark: bool,
    help: bool,
    /// Whether the introduction is open.
    introduction: bool,
    /// Events of the pointer that a script still has to send, one per frame.
    pub(super) pointer: VecDeque<egui::Event>,
    /// Title that the window has.
    title: String,
    /// Purpose of the requested file, and its path as typed so far. The system's dialog may be open as well.
    requested: Option<(Purpose, String)>,
    /// Whether the field of that path has not had the focus yet.
    asks_anew: bool,
    dialog: Option<Dialog>,
    /// Channel for the results of file jobs.
    ended: (Sender<Ended>, Receiver<Ended>),
    jobs: usize,
    /// Interval between two frames that worker threads request \[ms\].
    pace: Arc<AtomicU64>,
}

impl Explorer {
    /// Creates the window's contents. If `embedded` is false, there is no viewer: tests run without a graphics card.
    ///
    /// # Errors
    /// Returns an error if the graphics card cannot draw the viewer or if a thread cannot be started.
    pub fn new(
        cc: &eframe::CreationContext<'_>,
        subject: InitialContent,
        script: Option<Script>,
        embedded: bool,
    ) -> Result<Self, Box<dyn std::error::Error + Send + Sync>> {
        let editor = match &subject {
            InitialContent::Study { study, path, .. } => StudyEditor::opened(study, path.as_deref()),
            InitialContent::Run(_) => StudyEditor::paper(),
        };
        let (viewer, scene) = if embedded {
            let (viewer, scene) = Viewer::new(cc, editor.study())?;
            theme::refine(&cc.egui_ctx);
            (Some(viewer), Some(scene))
        } else {
            theme::dress(&cc.egui_ctx);
            (None, None)
        };
        let ctx = cc.egui_ctx.clone();
        // Updates that arrive within this interval share a frame. The interval grows with the time that a frame takes:
        // where frames are drawn by the processor, they would take its time from the search.
        let pace = Arc::new(AtomicU64::new(QUICKEST));
        let paced = Arc::clone(&pace);
        let wake = Arc::new(move || ctx.request_repaint_after(Duration::from_millis(paced.load(Ordering::Relaxed))));
        let mut session = Session::new(editor, scene, wake)?;
        match &subject {
            InitialContent::Study { start: true, .. } => session.start(),
            InitialContent::Study { .. } => {}
            InitialContent::Run(path) => session.open(path),
        }
        // A script starts from the default layout, axes and theme, not from those of an earlier session.
        let storage = cc.storage.filter(|_| script.is_none());
        let remembered: Option<Remembered> = storage.and_then(|storage| eframe::get_value(storage, eframe::APP_KEY));
        let is_introduced = remembered.as_ref().is_some_and(|remembered| remembered.introduced);
        let mut panels = Panels::default();
        let (tree, recent, dark) = match remembered {
            Some(remembered) => {
                *panels.scatter_mut() = remembered.scatter();
                (remembered.tree, remembered.recent, remembered.dark)
            }
            None => (layout(), Vec::new(), true),
        };
        cc.egui_ctx.set_theme(egui::Theme::from_dark_mode(dark));
        Ok(Self {
            session,
            panels,
            tree,
            viewer,
            platform_drag: PlatformDrag::default(),
            focus_ring: FocusRing::default(),
            script,
            recent,
            dark,
            help: false,
            introduction: storage.is_some() && !is_introduced,
            pointer: VecDeque::new(),
            title: String::new(),
            requested: None,
            asks_anew: false,
            dialog: None,
            ended: channel(),
            jobs: 0,
            pace,
        })
    }

    /// Returns the session: the run, its designs, and everything selected, pinned and filtered.
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// Returns the session for modification.
    pub fn session_mut(&mut self) -> &mut Session {
        &mut self.session
    }

    /// Returns the position on screen at which the last frame drew a design of the run in the scatter.
    pub fn scatter_position(&self, id: usize) -> Option<egui::Pos2> {
        self.panels.scatter().screen_position(&self.session.row(id)?)
    }

    /// Returns the rectangle of the widget that has the keyboard, if the last frame marked it.
    pub fn focus_ring(&self) -> Option<egui::Rect> {
        self.focus_ring.drawn()
    }

    /// Returns the axes of the scatter.
    pub fn scatter_axes(&self) -> [ScatterAxis; 2] {
        self.panels.scatter().axes()
    }

    /// Returns the scatter for modification.
    pub(super) fn scatter_mut(&mut self) -> &mut Scatter {
        self.panels.scatter_mut()
    }

    /// Replaces the axes of the scatter and fits its view.
    pub fn set_axes(&mut self, axes: [ScatterAxis; 2]) {
        *self.panels.scatter_mut() = Scatter::new(axes, objective_columns(&self.session));
    }

    /// Returns the recently opened files, the most recent first.
    pub fn recent(&self) -> &[PathBuf] {
        &self.recent
    }

    /// Activates the tab of a panel.
    pub fn show(&mut self, panel: Panel) {
        layout::show(&mut self.tree, panel);
    }

    /// Opens or writes the file at `path`, depending on its purpose.
    pub fn act(&mut self, ctx: &Context, purpose: Purpose, path: PathBuf) {
        if matches!(purpose, Purpose::Open | Purpose::OpenFolder) {
            self.recent.retain(|other| *other != path);
            self.recent.insert(0, path.clone());
            self.recent.truncate(RECENT);
        }
        if purpose == Purpose::SavePicture {
            ctx.send_viewport_cmd(ViewportCommand::Screenshot(UserData::new(PendingScreenshot(path))));
        } else if let Some(job) = files::act(&mut self.session, purpose, path) {
            self.begin(ctx, job);
        }
    }

    fn begin(&mut self, ctx: &Context, job: Job) {
        let (sender, ctx) = (self.ended.0.clone(), ctx.clone());
        self.jobs += 1;
        std::thread::spawn(move || {
            let _ = sender.send(job());
            ctx.request_repaint();
        });
    }

    /// Returns whether a file job is running.
    pub fn is_busy(&self) -> bool {
        self.jobs > 0
    }

    fn ask(&mut self, ctx: &Context, purpose: Purpose) {
        let ctx = ctx.clone();
        self.requested = Some((purpose, purpose.name().to_owned()));
        self.asks_anew = true;
        self.dialog = Some(Dialog::open(purpose, move || ctx.request_repaint()));
    }
}

impl eframe::App for Explorer {
    fn logic(&mut self, ctx: &Context, frame: &mut eframe::Frame) {
        if let Some(viewer) = &mut self.viewer {
            viewer.logic(ctx, frame);
            if let Some(picked) = viewer.picked() {
                self.session.select_picked(picked);
            }
        }
        self.session.update();
        if let Some(mut script) = self.script.take() {
            script.advance(self, ctx);
            self.script = Some(script);
        }
    }

    fn ui(&mut self, ui: &mut Ui, frame: &mut eframe::Frame) {
        let ctx = ui.ctx().clone();
        let took = frame.info().cpu_usage.map_or(0, |seconds| (1e3 * seconds) as u64);
        self.pace.store((4 * took).clamp(QUICKEST, SLOWEST), Ordering::Relaxed);
        self.session.view_mut().light = !ui.visuals().dark_mode;
        self.deliveries(&ctx);
        self.shortcuts(&ctx);
        if !ctx.input(|input| input.pointer.any_down()) {
            self.session.end_gestures();
        }
        egui::Panel::top("menu").show(ui, |ui| self.menu(ui));
        if !self.session.notices().is_empty() {
            egui::Panel::bottom("notices").show(ui, |ui| self.notices(ui));
        }
        egui::Panel::bottom("status").show(ui, |ui| self.status(ui));
        self.retitle(&ctx);
        egui::CentralPanel::no_frame().show(ui, |ui| {
            let mut drawing = Drawing {
                session: &mut self.session,
                panels: &mut self.panels,
                viewer: self.viewer.as_mut(),
                platform_drag: &self.platform_drag,
                frame,
            };
            self.tree.ui(&mut drawing, ui);
            match self.session.take_subject() {
                Some(Subject::Study) => self.show(Panel::Study),
                Some(Subject::WhyNot) => self.show(Panel::WhyNot),
                None => {}
            }
            if let Some(purpose) = self.session.take_file_request() {
                self.ask(&ctx, purpose);
            }
        });
        self.path_field(ui);
        self.help(ui);
        self.introduction(ui);
        self.focus_ring.ui(&ctx);
        if self.session.is_running() && *self.session.phase() != Phase::Paused {
            // The rate and the remaining time change even while no message arrives.
            ctx.request_repaint_after(Duration::from_millis(250));
        }
        if ctx.input(|input| input.viewport().close_requested()) {
            self.session.close();
        }
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        if self.script.is_some() {
            return;
        }
        eframe::set_value(storage, eframe::APP_KEY, &Remembered::of(self));
    }

    fn raw_input_hook(&mut self, ctx: &Context, input: &mut egui::RawInput) {
        // The pictures of a script must not show the hover effects of a mouse that happens to be over the window.
        if self.script.is_some() {
            input
                .events
                .retain(|event| !matches!(event, egui::Event::PointerMoved(_)));
            input.events.extend(self.pointer.pop_front());
        }
        let view = self.viewer.as_ref().and_then(|viewer| viewer.view_of_design(ctx));
        self.platform_drag.take_events(input, &mut self.session, view);
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }
}

/// Calls a function at each signal that asks the program to end, or returns why it cannot.
pub type AtEndSignals = fn(Box<dyn Fn() + Send>) -> std::io::Result<()>;

/// Opens the window and returns when it is closed, which signals that ask the program to end bring about.
///
/// # Errors
/// Returns a message that says why the window cannot be opened and what would help.
pub fn run(subject: InitialContent, script: Option<Script>, at_end_signals: AtEndSignals) -> Result<(), AnyError> {
    let headless =
        "`kinefront optimize --out run` runs a study without a window and writes a recording to view elsewhere";
    let display = ["WAYLAND_DISPLAY", "WAYLAND_SOCKET", "DISPLAY"];
    if cfg!(target_os = "linux")
        && display
            .iter()
            .all(|name| std::env::var_os(name).is_none_or(|value| value.is_empty()))
    {
        return Err(format!(
            "there is no display to open a window on (DISPLAY and WAYLAND_DISPLAY are not set); {headless}"
        )
        .into());
    }
    let mut options = re_viewer::native::eframe_options(None);
    options.viewport = egui::ViewportBuilder::default()
        .with_title("Kinefront")
        .with_app_id("kinefront")
        .with_inner_size([1600.0, 1000.0])
        .with_min_inner_size([900.0, 600.0])
        .with_transparent(false)
        .with_decorations(true);
    options.persist_window = script.is_none();
    let create = Box::new(move |cc: &eframe::CreationContext<'_>| {
        let explorer = Explorer::new(cc, subject, script, true)?;
        // An interrupt at the terminal closes the window normally; without a handler, the run's files would remain.
        let ctx = cc.egui_ctx.clone();
        let _ = at_end_signals(Box::new(move || {
            ctx.send_viewport_cmd(ViewportCommand::Close);
            ctx.request_repaint();
        }));
        Ok(Box::new(explorer) as Box<dyn eframe::App>)
    });
    eframe::run_native("kinefront", options, create).map_err(|error| {
        let message = match error {
            // The library's own message names a line of its source code, which does not help.
            eframe::Error::WinitEventLoop(_) => format!("cannot connect to the display; {headless}"),
            // The library's list of the reasons may be empty.
            eframe::Error::Wgpu(error) => format!(
                "no graphics card can draw the window ({}); install a Vulkan driver, or, without a card, a \
             software renderer such as Debian's mesa-vulkan-drivers; {headless}",
                error.to_string().replace(": {}", "")
            ),
            error => format!("cannot open the window: {error}; {headless}"),
        };
        message.into()
    })
}
