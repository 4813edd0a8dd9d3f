//! The thread that evaluates and draws the selected design, so that no frame waits for it.
//!
//! ```text
//! window ──Request──► [latest] ─► scene thread ─► LiveScene ─► viewer
//!    ▲                               │ design to verify
//!    │                               ▼
//!    └──────── Answer ◄──── [latest] verify thread (fine grid)
//! ```
//!
//! Only the latest request is processed: while a slider is dragged, intermediate requests are skipped.

use crate::AnyError;
use std::sync::{Arc, Mutex};
use std::thread::Builder;
use std::time::Duration;

use super::mailbox::Mailbox;
use super::questions::MotionAnswer;
use super::{Wake, lock};
use kinefront_model::evaluation::{Evaluation, GridChoice, Model};
use kinefront_model::mechanism::Design;
use kinefront_model::spatial::Pose;
use kinefront_recording::{
    FrontPoint, LiveScene, Pinned, RecordingError, SceneLegends, Shown, Viewpoint, VisibleLayers,
};
use kinefront_scene::{BentBar, MotionPath, WorkspaceProof, workspace_proof};
use kinefront_study::{PoolWorkers, PreparedStudy};

/// Time without a newer design after which a design is verified.
const RESTING: Duration = Duration::from_millis(150);

/// The motion that is shown. Two answers are different, so that their contents need not be compared.
#[derive(Debug, Clone)]
pub struct MotionShown(pub Arc<MotionAnswer>);

impl PartialEq for MotionShown {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl MotionShown {
    fn path(&self) -> Option<&MotionPath> {
        self.0.as_ref().as_ref().ok()?.as_ref()?.path.as_ref()
    }
}

/// Request to show a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// The study whose model applies.
    pub study: Arc<PreparedStudy>,
    /// The selected design.
    pub design: Option<Design>,
    /// Pose of the manipulator; the home pose if `None`.
    pub pose: Option<Pose>,
    /// Orientation of the heatmap \[rad\]; the home orientation if `None`.
    pub heatmap_phi: Option<f64>,
    /// Layers that are drawn.
    pub layers: VisibleLayers,
    /// Pinned designs with their names.
    pub pins: Vec<(String, Design)>,
    /// Whether the view of the pinned designs is in front of that of the selected design.
    pub comparing: bool,
    /// Whether the viewer uses light colours.
    pub light: bool,
    /// Direction from which the manipulator is seen, and how often one was chosen: choosing it again fits the view.
    pub viewpoint: (Viewpoint, u64),
    /// Evaluation of the design on the fine grid, if it is known; the scene shows its values.
    pub verified: Option<Arc<Evaluation>>,
    /// Proof of its workspace, if it is known.
    pub proof: Option<Arc<WorkspaceProof>>,
    /// The motion that it follows, if it is known.
    pub motion: Option<MotionShown>,
    /// The bars as they bend in the vibration that is shown.
    pub bent: Arc<Vec<BentBar>>,
    /// The current front.
    pub front: Arc<Vec<FrontPoint>>,
}

impl Request {
    /// Whether another request asks for the same but for the vibration.
    fn differs_by_its_vibration(&self, other: &Self) -> bool {
        let bent = Arc::clone(&other.bent);
        self.bent != bent && Self { bent, ..self.clone() } == *other
    }
}

/// Evaluation of the selected design.
#[derive(Debug, Clone, PartialEq)]
pub struct Known {
    /// Its evaluation.
    pub evaluation: Arc<Evaluation>,
    /// Whether the evaluation is from the fine grid.
    pub verified: bool,
}

impl Known {
    /// An evaluation on the fine grid.
    fn verified(evaluation: Arc<Evaluation>) -> Self {
        Self {
            evaluation,
            verified: true,
        }
    }
}

/// Results of the latest requests.
#[derive(Debug, Clone, Default)]
pub struct Answer {
    /// The study of the request that was answered last.
    pub study: Option<Arc<PreparedStudy>>,
    /// Evaluation of the selected design, once it is known.
    pub known: Option<Known>,
    /// Proof of the workspace of the design that was proved last.
    pub proof: Option<Arc<WorkspaceProof>>,
    /// Legends of what is drawn.
    pub legends: SceneLegends,
    /// Distance between the lines of the ground grid \[m\], if there is a viewer.
    pub grid_spacing: Option<f64>,
    /// Evaluations of the pinned designs.
    pub pins: Vec<Evaluation>,
    /// Number of the last request that was drawn.
    pub drawn: u64,
    /// Number of the last request that failed, and the message about it.
    pub trouble: Option<(u64, String)>,
}

struct Shared {
    requests: Mailbox<(u64, Request)>,
    to_verify: Mailbox<(Arc<PreparedStudy>, Known)>,
    /// The design verified last, which the scene shows with its values from the fine grid.
    verified: Mutex<Option<(Arc<PreparedStudy>, Arc<Evaluation>)>>,
    answer: Mutex<Answer>,
    wake: Wake,
}

impl Shared {
    /// Returns the verified evaluation of `design`, if it is the design verified last.
    fn verified(&self, study: &Arc<PreparedStudy>, design: &Design) -> Option<Known> {
        let verified = lock(&self.verified);
        let (_, evaluation) = verified
            .as_ref()
            .filter(|(of, evaluation)| of == study && evaluation.design == *design)?;
        Some(Known::verified(Arc::clone(evaluation)))
    }

    fn answer(&self, change: impl FnOnce(&mut Answer)) {
        change(&mut lock(&self.answer));
        (self.wake)();
    }
}

/// Evaluates and draws designs on its own threads.
pub struct SceneThread {
    shared: Arc<Shared>,
    sent: u64,
    last: Option<Request>,
}

impl SceneThread {
    /// Starts the threads; `scene` is `None` if there is no viewer.
    ///
    /// # Errors
    /// Returns an error if a thread cannot be started.
    pub fn start(scene: Option<LiveScene>, wake: impl Fn() + Send + Sync + 'static) -> std::io::Result<Self> {
        let shared = Arc::new(Shared {
            requests: Mailbox::new(),
            to_verify: Mailbox::new(),
            verified: Mutex::new(None),
            answer: Mutex::default(),
            wake: Arc::new(wake),
        });
        let hand = Arc::clone(&shared);
        Builder::new()
            .name("kinefront-scene".to_owned())
            .spawn(move || draw_requests(&hand, scene))?;
        let hand = Arc::clone(&shared);
        Builder::new()
            .name("kinefront-verify".to_owned())
            .spawn(move || verify_requests(&hand))?;
        Ok(Self {
            shared,
            sent: 0,
            last: None,
        })
    }

    /// Sends a request, unless it equals the last one. Returns the number of the request.
    pub fn ask(&mut self, request: Request) -> u64 {
        if self.last.as_ref() != Some(&request) {
            self.last = Some(request.clone());
            self.sent += 1;
            self.shared.requests.put((self.sent, request));
        }
        self.sent
    }

    /// Returns the results so far.
    pub fn answer(&self) -> Answer {
        lock(&self.shared.answer).clone()
    }
}

impl Drop for SceneThread {
    fn drop(&mut self) {
        self.shared.requests.close();
        self.shared.to_verify.close();
    }
}

fn verify_requests(shared: &Shared) {
    while let Some(mut wanted) = shared.to_verify.take() {
        // Dragging a slider passes through many designs; only the one at which it rests is verified.
        while let Some(newer) = shared.to_verify.wait(RESTING) {
            wanted = newer;
        }
        let (study, known) = wanted;
        let design = known.evaluation.design;
        let evaluation = if known.verified {
            known.evaluation
        } else {
            Arc::new(study.model().evaluate_by(&PoolWorkers, &design, GridChoice::Fine))
        };
        *lock(&shared.verified) = Some((Arc::clone(&study), Arc::clone(&evaluation)));
        shared.answer(|answer| {
            if let Some(known) = &mut answer.known
                && known.evaluation.design == design
                && answer.study.as_ref() == Some(&study)
            {
                *known = Known::verified(Arc::clone(&evaluation));
            }
        });
        if !study.study().workspace.certify {
            continue;
        }
        // A newer design ends a proof that takes long.
        let proof = workspace_proof(study.model(), &evaluation, &|| shared.to_verify.is_idle());
        shared.answer(|answer| {
            if answer.study.as_ref() == Some(&study) {
                answer.proof = proof.map(Arc::new);
            }
        });
    }
}

/// Current state of the scene.
#[derive(Default)]
struct SceneState {
    scene: Option<LiveScene>,
    request: Option<Request>,
    known: Option<Known>,
    /// The evaluation whose values the scene shows.
    drawn: Option<Arc<Evaluation>>,
    legends: SceneLegends,
    pins: Vec<Evaluation>,
    /// The design sent last to the verify thread.
    verifying: Option<Design>,
}

impl SceneState {
    /// Returns the evaluation of a pinned design on the fine grid, as the tables show it. A design that was pinned before, or verified as
    /// the selected one, is not evaluated again.
    fn pin(&self, model: &Model, design: &Design) -> Evaluation {
        let pinned = self.pins.iter().find(|pin| pin.design == *design);
        let verified = || {
            let known = self.known.as_ref().filter(|known| known.verified)?;
            Some(&*known.evaluation).filter(|evaluation| evaluation.design == *design)
        };
        let found = pinned.or_else(verified).cloned();
        found.unwrap_or_else(|| model.evaluate_by(&PoolWorkers, design, GridChoice::Fine))
    }
}

fn draw_requests(shared: &Shared, scene: Option<LiveScene>) {
    let mut state = SceneState {
        scene,
        ..SceneState::default()
    };
    while let Some((number, request)) = shared.requests.take() {
        let trouble = step(&mut state, shared, &request).err();
        // Verification starts after drawing, because both compete for the processor.
        if let Some(known) = &state.known {
            let design = known.evaluation.design;
            // A design is sent only once: a change of the pose, as in a tour, needs no new verification.
            if state.verifying.replace(design) != Some(design) {
                shared.to_verify.put((Arc::clone(&request.study), known.clone()));
            }
        }
        let (known, pins, legends) = (state.known.clone(), state.pins.clone(), state.legends);
        shared.answer(|answer| {
            // The verify thread may have finished earlier, while the answer still held another design.
            let finer = known
                .as_ref()
                .and_then(|known| shared.verified(&request.study, &known.evaluation.design));
            answer.known = finer.or(known);
            answer.pins = pins;
            answer.legends = legends;
            answer.grid_spacing = state.scene.as_ref().map(LiveScene::grid_spacing);
            answer.study = Some(Arc::clone(&request.study));
            answer.drawn = number;
            if let Some(trouble) = trouble {
                answer.trouble = Some((number, trouble.to_string()));
            }
        });
        state.request = Some(request);
    }
}

fn step(state: &mut SceneState, shared: &Shared, request: &Request) -> Result<(), AnyError> {
    let before = state.request.take();
    let new_study = before.as_ref().is_none_or(|before| before.study != request.study);
    if new_study {
        if let Some(scene) = &mut state.scene {
            scene
                .turn_to(request.study.study())
                .map_err(|error| error.to_string())?;
        }
        state.known = None;
        state.verifying = None;
        state.pins.clear();
        *lock(&shared.verified) = None;
    }
    let before = before.filter(|_| !new_study);
    let model = request.study.model();
    let evaluate = |design: &Design| model.evaluate(design, GridChoice::Reference);

    let given = request.verified.clone().map(Known::verified);
    let verified = request.design.and_then(|design| {
        given
            .filter(|known| known.evaluation.design == design)
            .or_else(|| shared.verified(&request.study, &design))
    });
    state.known = match (&request.design, verified, state.known.take()) {
        (None, ..) => None,
        (Some(_), Some(known), _) => Some(known),
        (Some(design), None, Some(known)) if known.evaluation.design == *design => Some(known),
        (Some(design), None, _) => Some(Known {
            evaluation: Arc::new(evaluate(design)),
            verified: false,
        }),
    };
    let new_pins = before.as_ref().is_none_or(|before| before.pins != request.pins);
    if new_pins {
        let pins = request.pins.iter().map(|(_, design)| state.pin(model, design));
        state.pins = pins.collect();
    }

    let Some(mut scene) = state.scene.take() else {
        return Ok(());
    };
    let drawn = draw(&mut scene, state, before.as_ref(), request, new_pins);
    state.scene = Some(scene);
    state.drawn = state.known.as_ref().map(|known| Arc::clone(&known.evaluation));
    let drawn = drawn.map(|legends| state.legends = legends);
    drawn.map_err(|error| format!("the scene cannot be drawn: {error}").into())
}

/// Draws what differs from the request before, and returns the legends.
fn draw(
    scene: &mut LiveScene,
    state: &SceneState,
    before: Option<&Request>,
    request: &Request,
    new_pins: bool,
) -> Result<SceneLegends, RecordingError> {
    if before.is_some_and(|before| before.comparing != request.comparing) {
        scene.compare(request.comparing)?;
    }
    if before.is_some_and(|before| before.viewpoint != request.viewpoint) {
        scene.look_from(request.viewpoint.0)?;
    }
    if before.is_none_or(|before| before.bent != request.bent) {
        scene.bend(&request.bent)?;
    }
    let as_drawn = match (&state.known, &state.drawn) {
        (Some(known), Some(drawn)) => Arc::ptr_eq(&known.evaluation, drawn),
        _ => false,
    };
    if as_drawn && before.is_some_and(|before| before.differs_by_its_vibration(request)) {
        return Ok(state.legends);
    }
    let model = request.study.model();
    let shown = state.known.as_ref().map(|known| Shown {
        model,
        evaluation: &known.evaluation,
        proof: request
            .proof
            .as_deref()
            .filter(|proof| proof.design == known.evaluation.design),
        path: request.motion.as_ref().and_then(MotionShown::path),
        pose: request.pose,
        heatmap_phi: request.heatmap_phi,
        layers: &request.layers,
        light: request.light,
    });
    let legends = scene.design(shown.as_ref())?;
    if new_pins {
        let named = request.pins.iter().zip(&state.pins);
        let pins: Vec<Pinned<'_>> = named
            .map(|((name, _), evaluation)| Pinned { evaluation, name })
            .collect();
        scene.pins(model, &pins)?;
    }
    let moved =
        before.is_none_or(|before| before.design != request.design || !Arc::ptr_eq(&before.front, &request.front));
    if moved {
        let marked = state.known.as_ref().map(|known| &*known.evaluation);
        scene.front(request.study.study(), &request.front, marked)?;
    }
    Ok(legends)
}
