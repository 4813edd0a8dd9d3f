//! The window: menu, panels, shortcuts, notices, and what is remembered between two sessions.

mod deliveries;
mod layout;
mod menu;
mod shortcuts;

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

use egui::{Context, Ui, UserData, ViewportCommand};
use egui_tiles::Tree;
use serde::{Deserialize, Serialize};

use self::deliveries::Picture;
use self::layout::{Drawing, layout};
use super::files::{self, Dialog, Job, Purpose};
use super::panels::scatter::{Axis, Scatter};
use super::panels::{Panel, Panels};
use super::viewer::Viewer;
use super::{Phase, Script, Session, StudyEditor, theme};
use crate::study::Study;

/// What the window opens with.
#[derive(Debug, Clone)]
pub enum Subject {
    /// A study, run at once where `start`.
    Study {
        /// The study.
        study: Box<Study>,
        /// Its file.
        path: Option<PathBuf>,
        /// Whether its run starts at once.
        start: bool,
    },
    /// What a run left.
    Run(PathBuf),
}

/// What is remembered between two sessions.
#[derive(Serialize, Deserialize)]
struct Remembered {
    tree: Tree<Panel>,
    axes: [Axis; 2],
    recent: Vec<PathBuf>,
    dark: bool,
}

/// How work on a file ended, in words.
type Ended = Result<String, String>;

/// Fewest and most milliseconds between two frames that news ask for.
const QUICKEST: u64 = 8;
const SLOWEST: u64 = 400;

/// Files that are remembered.
const RECENT: usize = 8;

/// The window.
pub struct Explorer {
    session: Session,
    panels: Panels,
    tree: Tree<Panel>,
    viewer: Option<Viewer>,
    script: Option<Script>,
    recent: Vec<PathBuf>,
    dark: bool,
    help: bool,
    /// A file that is asked for: by a dialog of the system, and by a field for its path.
    asked: Option<(Purpose, String)>,
    dialog: Option<Dialog>,
    /// Ends of work on files.
    ended: (Sender<Ended>, Receiver<Ended>),
    jobs: usize,
    /// Milliseconds between two frames that news ask for.
    pace: Arc<AtomicU64>,
}

impl Explorer {
    /// The window's contents. Without `embedded` there is no viewer, for tests without a graphics card.
    ///
    /// # Errors
    /// The graphics card cannot draw the viewer, or threads cannot be started.
    pub fn new(
        cc: &eframe::CreationContext<'_>,
        subject: Subject,
        script: Option<Script>,
        embedded: bool,
    ) -> Result<Self, Box<dyn std::error::Error + Send + Sync>> {
        let editor = match &subject {
            Subject::Study { study, path, .. } => StudyEditor::new((**study).clone(), path.clone()),
            Subject::Run(_) => StudyEditor::paper(),
        };
        let (viewer, scene) = if embedded {
            let (viewer, scene) = Viewer::new(cc, editor.study())?;
            (Some(viewer), Some(scene))
        } else {
            theme::dress(&cc.egui_ctx);
            (None, None)
        };
        let ctx = cc.egui_ctx.clone();
        // What comes within a frame's time is shown in one. Where frames are drawn by the processor, the search needs it more.
        let pace = Arc::new(AtomicU64::new(QUICKEST));
        let paced = Arc::clone(&pace);
        let wake = Arc::new(move || ctx.request_repaint_after(Duration::from_millis(paced.load(Ordering::Relaxed))));
        let mut session = Session::new(editor, scene, wake)?;
        match &subject {
            Subject::Study { start: true, .. } => session.start(),
            Subject::Study { .. } => {}
            Subject::Run(path) => session.open(path),
        }
        // A script shows the window as it is made, whatever someone made of it before.
        let remembered: Option<Remembered> = cc
            .storage
            .filter(|_| script.is_none())
            .and_then(|storage| eframe::get_value(storage, eframe::APP_KEY));
        let mut panels = Panels::default();
        let (tree, recent, dark) = match remembered {
            Some(remembered) => {
                panels.scatter = Scatter::new(remembered.axes);
                (remembered.tree, remembered.recent, remembered.dark)
            }
            None => (layout(), Vec::new(), true),
        };
        cc.egui_ctx
            .set_theme(if dark { egui::Theme::Dark } else { egui::Theme::Light });
        Ok(Self {
            session,
            panels,
            tree,
            viewer,
            script,
            recent,
            dark,
            help: false,
            asked: None,
            dialog: None,
            ended: channel(),
            jobs: 0,
            pace,
        })
    }

    /// Everything the window knows.
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// Everything the window knows, to change it.
    pub fn session_mut(&mut self) -> &mut Session {
        &mut self.session
    }

    /// Where a design of the run stood in the scatter in the last frame.
    pub fn scatter_position(&self, id: usize) -> Option<egui::Pos2> {
        self.panels.scatter.screen_position(&self.session.row(id)?)
    }

    /// Axes of the scatter.
    pub fn scatter_axes(&self) -> [Axis; 2] {
        self.panels.scatter.axes()
    }

    /// Puts other quantities on the axes of the scatter.
    pub fn set_axes(&mut self, axes: [Axis; 2]) {
        self.panels.scatter = Scatter::new(axes);
    }

    /// Files opened lately, the last first.
    pub fn recent(&self) -> &[PathBuf] {
        &self.recent
    }

    /// Brings a panel to the front.
    pub fn show(&mut self, panel: Panel) {
        self.tree
            .make_active(|_, tile| matches!(tile, egui_tiles::Tile::Pane(other) if *other == panel));
    }

    /// Does with a file what it was chosen for.
    pub fn act(&mut self, ctx: &Context, purpose: Purpose, path: PathBuf) {
        if matches!(purpose, Purpose::Open | Purpose::OpenFolder) {
            self.recent.retain(|other| *other != path);
            self.recent.insert(0, path.clone());
            self.recent.truncate(RECENT);
        }
        if purpose == Purpose::SavePicture {
            ctx.send_viewport_cmd(ViewportCommand::Screenshot(UserData::new(Picture(path))));
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

    /// Whether work on files is under way.
    pub fn is_busy(&self) -> bool {
        self.jobs > 0
    }

    fn ask(&mut self, ctx: &Context, purpose: Purpose) {
        let ctx = ctx.clone();
        self.asked = Some((purpose, purpose.name().to_owned()));
        self.dialog = Some(Dialog::open(purpose, move || ctx.request_repaint()));
    }
}

impl eframe::App for Explorer {
    fn logic(&mut self, ctx: &Context, frame: &mut eframe::Frame) {
        if let Some(viewer) = &mut self.viewer {
            viewer.logic(ctx, frame);
            if let Some(picked) = viewer.picked() {
                self.session.choose_picked(picked);
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
        self.session.staging.light = !ui.visuals().dark_mode;
        self.deliveries(&ctx);
        self.shortcuts(&ctx);
        if !ctx.input(|input| input.pointer.any_down()) {
            self.session.history.end_gesture();
        }
        egui::Panel::top("menu").show(ui, |ui| self.menu(ui));
        if !self.session.notices.is_empty() {
            egui::Panel::bottom("notices").show(ui, |ui| self.notices(ui));
        }
        egui::CentralPanel::no_frame().show(ui, |ui| {
            let mut drawing = Drawing {
                session: &mut self.session,
                panels: &mut self.panels,
                viewer: self.viewer.as_mut(),
                frame,
                asked: None,
            };
            self.tree.ui(&mut drawing, ui);
            if let Some(purpose) = drawing.asked {
                self.ask(&ctx, purpose);
            }
        });
        self.path_field(ui);
        self.help(ui);
        if self.session.is_running() && *self.session.phase() != Phase::Paused {
            // Rate and time left go on where no news come.
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
        let remembered = Remembered {
            tree: self.tree.clone(),
            axes: self.panels.scatter.axes(),
            recent: self.recent.clone(),
            dark: self.dark,
        };
        eframe::set_value(storage, eframe::APP_KEY, &remembered);
    }

    fn raw_input_hook(&mut self, _: &Context, input: &mut egui::RawInput) {
        // A script's pictures show no trace of a mouse that happens to lie somewhere.
        if self.script.is_some() {
            input
                .events
                .retain(|event| !matches!(event, egui::Event::PointerMoved(_)));
        }
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }
}

/// Opens the window and returns when it is closed.
///
/// # Errors
/// Why there can be no window, in words, and what would help.
pub fn run(subject: Subject, script: Option<Script>) -> Result<(), String> {
    let headless =
        "without a window, `kinefront optimize --out run` runs a study and leaves a recording to look at elsewhere";
    let display = ["WAYLAND_DISPLAY", "WAYLAND_SOCKET", "DISPLAY"];
    if cfg!(target_os = "linux")
        && display
            .iter()
            .all(|name| std::env::var_os(name).is_none_or(|value| value.is_empty()))
    {
        return Err(format!(
            "there is no display to open a window on (DISPLAY and WAYLAND_DISPLAY are not set); {headless}"
        ));
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
        // An interrupt at the terminal closes the window in good order; without a handler it would leave the run's files.
        let ctx = cc.egui_ctx.clone();
        let _ = ctrlc::set_handler(move || {
            ctx.send_viewport_cmd(ViewportCommand::Close);
            ctx.request_repaint();
        });
        Ok(Box::new(explorer) as Box<dyn eframe::App>)
    });
    eframe::run_native("kinefront", options, create).map_err(|error| match error {
        // What the window library says names a place in its own source.
        eframe::Error::WinitEventLoop(_) => format!("the display cannot be reached; {headless}"),
        eframe::Error::Wgpu(error) => format!(
            "no graphics card can draw the window ({error}); a driver for Vulkan or OpenGL is needed, in software as \
             Debian's mesa-vulkan-drivers if there is no card; {headless}"
        ),
        error => format!("the window cannot be opened: {error}; {headless}"),
    })
}
