//! The complete state of the window, independent of any window: the run, its designs, the selection, and the requests
//! to the scene.

mod asking;
mod beside;
mod control;
mod motion;
mod notices;
mod pose;
mod selected;
mod selection;
mod vibration;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use self::asking::Asking;
pub use self::asking::WhyPoint;
pub use self::beside::Beside;
pub use self::notices::Notice;
pub use self::selection::MarkedCounts;
pub use self::vibration::{PoseDynamics, ShownVibration};
use super::data::{Document, History, Named};
use super::files::Purpose;
use super::threads::{Answer, Running, SceneThread, Wake, Writing};
use super::{Filter, FrontEntry, Row, Store, StudyEditor};
use kinefront_model::evaluation::{Evaluation, GridChoice, Model, Quantity};
use kinefront_model::spatial::Pose;
use kinefront_recording::{FrontPoint, LiveScene, Viewpoint, VisibleLayers};
use kinefront_scene::{FieldLegend, StressLegend};
use kinefront_study::{Column, ConclusionPart, EndReason, GenerationSummary, PreparedStudy, Study};

/// Largest number of designs that can be pinned for comparison.
pub const MOST_PINS: usize = 4;

/// Phase of a run.
#[derive(Debug, Clone, PartialEq)]
pub enum Phase {
    /// No run was started yet.
    Ready,
    /// The optimizer is searching.
    Searching,
    /// The run is paused between two generations.
    Paused,
    /// The designs that are reported are being verified on the fine grid, or proved.
    Concluding {
        /// What is being done.
        part: ConclusionPart,
        /// Number of designs of which it is done.
        done: usize,
        /// Number of all of them, as far as it is known.
        total: usize,
    },
    /// The run has finished.
    Finished(EndReason),
    /// The run has failed.
    Failed,
    /// The run was read from this file or folder.
    Opened(PathBuf),
}

/// A reference design of the study.
#[derive(Debug, Clone)]
pub struct ReferenceMark {
    /// Name of the design.
    pub name: String,
    /// Evaluation of the design by the model.
    pub evaluation: Evaluation,
    /// Quantities that its source states.
    pub stated: Vec<(Quantity, f64)>,
}

/// What is shown and how; undo does not restore it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ViewState {
    /// Pose of the manipulator; the home pose if `None`.
    pub pose: Option<Pose>,
    /// Orientation of the heatmap \[rad\]; the home orientation if `None`.
    pub heatmap_phi: Option<f64>,
    /// Layers that are drawn.
    pub layers: VisibleLayers,
    /// Whether the view of the pinned designs is in front of that of the selected design.
    pub comparing: bool,
    /// Whether the window uses light colours.
    pub light: bool,
    /// Direction from which the manipulator is seen, and how often one was chosen.
    pub viewpoint: (Viewpoint, u64),
    /// The vibration that is shown.
    pub vibration: Option<ShownVibration>,
    /// Whether a click in the plan view adds a waypoint to the motion.
    pub drawing_path: bool,
}

/// What the user turns to, which the window shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Subject {
    /// The study that is edited.
    Study,
    /// Why a point beyond the front cannot be had.
    WhyNot,
}

/// The complete state of the window.
pub struct Session {
    /// The study being edited, which the next run uses.
    editor: StudyEditor,
    /// What is shown and how.
    view: ViewState,
    /// Messages to the user.
    notices: Vec<Notice>,
    /// The user's selection, pins, kept designs, stars, notes and filter, with their earlier states.
    history: History<Document>,
    /// Purpose of the file that a panel requests.
    requested_file: Option<Purpose>,
    /// What a panel or a key has turned to since the window looked last.
    subject: Option<Subject>,
    as_run: Arc<PreparedStudy>,
    run: Option<Running>,
    phase: Phase,
    threads: Option<usize>,
    store: Store,
    front: Vec<FrontEntry>,
    place_on_front: BTreeMap<usize, usize>,
    front_points: Arc<Vec<FrontPoint>>,
    front_number: u64,
    /// Number of the front and the filter that `front_points` shows.
    front_drawn: Option<(u64, Filter)>,
    generations: Vec<GenerationSummary>,
    /// Working time of the run at the end of each generation; none for a run that was opened.
    generation_times: Vec<Duration>,
    references: Vec<ReferenceMark>,
    scene: SceneThread,
    asking: Asking,
    pose_dynamics: Option<PoseDynamics>,
    beside: Option<Beside>,
    answer: Answer,
    requested: u64,
    /// Number of the last failed request whose message was shown.
    failure_shown: Option<u64>,
    wake: Wake,
    /// Number of the current store; the ids of one store mean nothing in another.
    era: u64,
    /// Whether the selection follows the knee of the front during the run; it does until the user selects a design.
    following: bool,
    followed: Option<Instant>,
    stopped: Option<pose::Stopped>,
}

impl Session {
    /// Makes a session without a run; `scene` is `None` if there is no viewer.
    ///
    /// # Errors
    /// Returns an error if the threads of the session cannot be started.
    pub fn new(editor: StudyEditor, scene: Option<LiveScene>, wake: Wake) -> std::io::Result<Self> {
        let waking = Arc::clone(&wake);
        let study = PreparedStudy::new(editor.study().clone()).map_err(std::io::Error::other)?;
        Ok(Self {
            references: references(&study),
            as_run: Arc::new(study),
            editor,
            view: ViewState::default(),
            notices: Vec::new(),
            history: History::default(),
            requested_file: None,
            subject: None,
            run: None,
            phase: Phase::Ready,
            threads: None,
            store: Store::default(),
            front: Vec::new(),
            place_on_front: BTreeMap::new(),
            front_points: Arc::default(),
            front_number: 0,
            front_drawn: None,
            generations: Vec::new(),
            generation_times: Vec::new(),
            scene: SceneThread::start(scene, move || waking())?,
            asking: Asking::new(&wake),
            pose_dynamics: None,
            beside: None,
            answer: Answer::default(),
            requested: 0,
            failure_shown: None,
            wake,
            era: 0,
            following: true,
            followed: None,
            stopped: None,
        })
    }

    /// Returns the study being edited, which the next run uses.
    pub fn editor(&self) -> &StudyEditor {
        &self.editor
    }

    /// Returns the study being edited for modification.
    pub fn editor_mut(&mut self) -> &mut StudyEditor {
        &mut self.editor
    }

    /// Returns what is shown and how.
    pub fn view(&self) -> &ViewState {
        &self.view
    }

    /// Returns what is shown and how for modification.
    pub fn view_mut(&mut self) -> &mut ViewState {
        &mut self.view
    }

    /// Requests a file from the user.
    pub fn request_file(&mut self, purpose: Purpose) {
        self.requested_file = Some(purpose);
    }

    /// Takes the request for a file, if there is one.
    pub fn take_file_request(&mut self) -> Option<Purpose> {
        self.requested_file.take()
    }

    /// Makes the window show a subject.
    pub fn turn_to(&mut self, subject: Subject) {
        self.subject = Some(subject);
    }

    /// Takes the subject to which the user has turned since the last call, if there is one.
    pub fn take_subject(&mut self) -> Option<Subject> {
        self.subject.take()
    }

    /// Returns the study to which the stored designs belong.
    pub fn study(&self) -> &Study {
        self.as_run.study()
    }

    /// Returns the model of that study.
    pub fn model(&self) -> &Model {
        self.as_run.model()
    }

    /// Returns the study with its model, to be shared with other threads.
    pub fn prepared(&self) -> Arc<PreparedStudy> {
        Arc::clone(&self.as_run)
    }

    /// Returns all evaluated designs.
    pub fn store(&self) -> &Store {
        &self.store
    }

    /// Returns the number of the current store; the ids of one store mean nothing in another.
    pub fn era(&self) -> u64 {
        self.era
    }

    /// Returns the front, sorted by the first objective.
    pub fn front(&self) -> &[FrontEntry] {
        &self.front
    }

    /// Returns the number of the current front; data derived from a front are valid until the number changes.
    pub fn front_number(&self) -> u64 {
        self.front_number
    }

    /// Returns the index of a design on the front, if it is on it.
    pub fn place_on_front(&self, id: usize) -> Option<usize> {
        self.place_on_front.get(&id).copied()
    }

    /// Returns the values of design `id`: from the front if it is on it, otherwise from the store.
    pub fn row(&self, id: usize) -> Option<Row> {
        match self.place_on_front(id) {
            Some(place) => Some(self.front[place].row),
            None => self.store.row(id),
        }
    }

    /// Returns a value of design `id`: from the front if it is on it, otherwise from the store.
    pub fn number(&self, id: usize, quantity: Column) -> Option<f64> {
        match self.place_on_front(id) {
            Some(place) => self.front[place].row.number(quantity),
            None => self
                .store
                .column(quantity)
                .get(id)
                .copied()
                .filter(|value| value.is_finite()),
        }
    }

    /// Returns the summary of each generation.
    pub fn generations(&self) -> &[GenerationSummary] {
        &self.generations
    }

    /// Returns the working time of the run at the end of each generation; none for a run that was opened.
    pub fn generation_times(&self) -> &[Duration] {
        &self.generation_times
    }

    /// Returns the phase of the run.
    pub fn phase(&self) -> &Phase {
        &self.phase
    }

    /// Returns whether a run is in progress.
    pub fn is_running(&self) -> bool {
        matches!(self.phase, Phase::Searching | Phase::Paused | Phase::Concluding { .. })
    }

    /// Returns the number of worker threads of the run.
    pub fn threads(&self) -> Option<usize> {
        self.threads
    }

    /// Returns the working time of the run.
    pub fn elapsed(&self) -> Duration {
        self.run.as_ref().map_or(Duration::ZERO, Running::elapsed)
    }

    /// Returns the run folder of a run that was started in the window.
    pub fn run_folder(&self) -> Option<PathBuf> {
        self.run.as_ref().map(Running::folder)
    }

    /// Returns the counter of files still being written if the run has ended, so that a job can wait for them.
    pub(super) fn writing(&self) -> Option<Writing> {
        let ended = matches!(self.phase, Phase::Finished(_) | Phase::Failed);
        self.run.as_ref().filter(|_| ended).map(|run| run.writing().clone())
    }

    /// Returns the reference designs of the study.
    pub fn references(&self) -> &[ReferenceMark] {
        &self.references
    }

    /// Returns the user's selection, pins, kept designs, stars, notes and filter.
    pub fn document(&self) -> &Document {
        self.history.present()
    }

    /// Returns the legend of the heatmap that was drawn last, if there is one.
    pub fn legend(&self) -> Option<&FieldLegend> {
        self.answer.legends.field.as_ref()
    }

    /// Returns the legend of the stresses of the bars, if their colours tell them.
    pub fn stress_legend(&self) -> Option<StressLegend> {
        self.answer.legends.stress
    }

    /// Returns the distance between the lines of the ground grid in 3-D \[m\], if there is a viewer.
    pub fn grid_spacing(&self) -> Option<f64> {
        self.answer.grid_spacing
    }

    /// Looks at the manipulator from another side, with the whole of it in view.
    pub fn look_from(&mut self, viewpoint: Viewpoint) {
        self.view.viewpoint = (viewpoint, self.view.viewpoint.1 + 1);
    }

    /// Returns the evaluations of the pinned designs; `None` for each that is not known yet.
    pub fn pin_evaluations(&self) -> Vec<Option<&Evaluation>> {
        let known = |named: &Named| self.answer.pins.iter().find(|pin| pin.design == named.design);
        self.document().pins.iter().map(known).collect()
    }

    /// Returns whether everything requested of the scene is drawn.
    pub fn is_drawn(&self) -> bool {
        self.answer.drawn >= self.requested
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.close();
    }
}

fn references(prepared: &PreparedStudy) -> Vec<ReferenceMark> {
    let (study, model) = (prepared.study(), prepared.model());
    let evaluated = study.references.iter().filter_map(|reference| {
        let design = reference.parse(study.working_mode).ok()?;
        Some(ReferenceMark {
            name: reference.name.clone(),
            evaluation: model.evaluate(&design, GridChoice::Reference),
            stated: reference.stated().collect(),
        })
    });
    evaluated.collect()
}
