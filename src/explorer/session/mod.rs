//! Everything the window knows, without a window: the run, its designs, what is chosen, and what was asked of the scene.

mod choosing;
mod posing;
mod running;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::document::{Chosen, Document, History, Named, Origin};
use super::running::{Running, Writing};
use super::scene_thread::{Answer, Known, SceneThread};
use super::{Filter, FrontEntry, Row, Store, StudyEditor};
use kinefront_model::evaluation::{Evaluation, GridChoice, Model};
use crate::recording::{FrontPoint, Layers, LiveScene};
use kinefront_model::spatial::Pose;
use crate::study::{GenerationSummary, Outcome, Study};

/// Designs that can be compared at once.
pub const MOST_PINS: usize = 4;

/// Where a run stands.
#[derive(Debug, Clone, PartialEq)]
pub enum Phase {
    /// Nothing was run yet.
    Ready,
    /// Searching.
    Searching,
    /// Held between two generations.
    Paused,
    /// Verifying the front on the fine grid.
    Verifying {
        /// Designs done.
        done: usize,
        /// Designs in all.
        total: usize,
    },
    /// At its end.
    Finished(Outcome),
    /// Broken off.
    Failed,
    /// Read back from a file or folder.
    Opened(PathBuf),
}

/// Something to tell, until it is put away.
#[derive(Debug, Clone, PartialEq)]
pub struct Notice {
    /// The words.
    pub text: String,
    /// Whether something went wrong.
    pub is_error: bool,
    /// When it was told.
    pub since: Instant,
}

/// Time that a message stays which tells of nothing wrong.
const GLANCE: Duration = Duration::from_secs(8);

/// A design that comes with the study.
#[derive(Debug, Clone)]
pub struct Reference {
    /// What it is called.
    pub name: String,
    /// What the model makes of it.
    pub evaluation: Evaluation,
    /// Mass and `R_w` as its source states them.
    pub stated: Option<[f64; 2]>,
}

/// What is shown, and how; not undone.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Staging {
    /// Pose of the manipulator; home where it is left out.
    pub pose: Option<Pose>,
    /// Orientation of the heatmap \[rad\]; home where it is left out.
    pub heatmap_phi: Option<f64>,
    /// What is drawn.
    pub layers: Layers,
    /// Whether the pinned designs are in front.
    pub comparing: bool,
    /// Whether the window's colours are light.
    pub light: bool,
}

/// Wakes the window when there is something new.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// Everything the window knows.
pub struct Session {
    /// The study being edited, which the next run takes.
    pub editor: StudyEditor,
    /// What is shown.
    pub staging: Staging,
    /// What is to be told.
    pub notices: Vec<Notice>,
    /// Chosen, pinned, noted, filtered.
    pub history: History,
    as_run: Arc<Study>,
    model: Model,
    run: Option<Running>,
    phase: Phase,
    threads: Option<usize>,
    store: Store,
    front: Vec<FrontEntry>,
    place_on_front: BTreeMap<usize, usize>,
    front_points: Arc<Vec<FrontPoint>>,
    front_number: u64,
    /// The front and filter that `front_points` shows.
    front_drawn: Option<(u64, Filter)>,
    generations: Vec<GenerationSummary>,
    references: Vec<Reference>,
    scene: SceneThread,
    answer: Answer,
    asked: u64,
    wake: Wake,
    /// Counts the stores: ids of one mean nothing in another.
    era: u64,
    /// Whether the knee of the front stays in the light while the run goes on: until a person chooses.
    following: bool,
    followed: Option<Instant>,
}

impl Session {
    /// A session that has run nothing yet; without a viewer there is no `scene`.
    ///
    /// # Errors
    /// Its threads could not be started.
    pub fn new(editor: StudyEditor, scene: Option<LiveScene>, wake: Wake) -> std::io::Result<Self> {
        let waking = Arc::clone(&wake);
        let study = Arc::new(editor.study().clone());
        Ok(Self {
            model: study.model(),
            references: references(&study),
            as_run: study,
            editor,
            staging: Staging::default(),
            notices: Vec::new(),
            history: History::default(),
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
            scene: SceneThread::start(scene, move || waking())?,
            answer: Answer::default(),
            asked: 0,
            wake,
            era: 0,
            following: true,
            followed: None,
        })
    }

    /// The study of the designs at hand.
    pub fn study(&self) -> &Study {
        &self.as_run
    }

    /// Its physics.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Every evaluated design.
    pub fn store(&self) -> &Store {
        &self.store
    }

    /// Counts the stores: ids of one mean nothing in another.
    pub fn era(&self) -> u64 {
        self.era
    }

    /// The front, by mass.
    pub fn front(&self) -> &[FrontEntry] {
        &self.front
    }

    /// Counts the fronts: what was made of one holds until the next.
    pub fn front_number(&self) -> u64 {
        self.front_number
    }

    /// Place of a design on the front.
    pub fn place_on_front(&self, id: usize) -> Option<usize> {
        self.place_on_front.get(&id).copied()
    }

    /// The member of the front, or the stored design, of an id.
    pub fn row(&self, id: usize) -> Option<Row> {
        match self.place_on_front(id) {
            Some(place) => Some(self.front[place].row),
            None => self.store.row(id),
        }
    }

    /// State after each generation.
    pub fn generations(&self) -> &[GenerationSummary] {
        &self.generations
    }

    /// Where the run stands.
    pub fn phase(&self) -> &Phase {
        &self.phase
    }

    /// Whether a run is under way.
    pub fn is_running(&self) -> bool {
        matches!(self.phase, Phase::Searching | Phase::Paused | Phase::Verifying { .. })
    }

    /// Worker threads of the run.
    pub fn threads(&self) -> Option<usize> {
        self.threads
    }

    /// Time the run has worked.
    pub fn elapsed(&self) -> Duration {
        self.run.as_ref().map_or(Duration::ZERO, Running::elapsed)
    }

    /// Folder of the run's files.
    pub fn run_folder(&self) -> Option<PathBuf> {
        self.run.as_ref().map(Running::folder)
    }

    /// The run's files that will be whole after a wait: of a run that has ended.
    pub(super) fn writing(&self) -> Option<Writing> {
        let ended = matches!(self.phase, Phase::Finished(_) | Phase::Failed);
        self.run.as_ref().filter(|_| ended).map(|run| run.writing().clone())
    }

    /// Designs that come with the study.
    pub fn references(&self) -> &[Reference] {
        &self.references
    }

    /// Chosen, pinned, noted, filtered.
    pub fn document(&self) -> &Document {
        self.history.present()
    }

    /// What is known of the design in the light.
    pub fn known(&self) -> Option<&Known> {
        let chosen = self.document().chosen.as_ref()?;
        self.answer
            .known
            .as_ref()
            .filter(|known| known.evaluation.design == chosen.design)
    }

    /// Evaluations of the pinned designs, as far as they are known.
    pub fn pin_evaluations(&self) -> Vec<Option<&Evaluation>> {
        let known = |named: &Named| self.answer.pins.iter().find(|pin| pin.design == named.design);
        self.document().pins.iter().map(known).collect()
    }

    /// Whether everything asked of the scene is drawn.
    pub fn is_drawn(&self) -> bool {
        self.answer.drawn >= self.asked
    }

    /// What the design in the light is called.
    pub fn chosen_name(&self) -> Option<String> {
        let document = self.document();
        Some(match &document.chosen.as_ref()?.origin {
            Origin::Evaluated(id) => format!("#{id}"),
            Origin::WhatIf { from: Some(id) } => format!("what if, from #{id}"),
            Origin::WhatIf { from: None } => "what if".to_owned(),
            Origin::Kept(index) => document.kept.get(*index).map_or("kept", |kept| &kept.name).to_owned(),
            Origin::Reference(index) => self
                .references
                .get(*index)
                .map_or("reference", |reference| &reference.name)
                .to_owned(),
        })
    }

    /// Whether the design in the light is one that was changed by hand and not kept.
    pub fn is_what_if(&self) -> bool {
        matches!(
            self.document().chosen,
            Some(Chosen {
                origin: Origin::WhatIf { .. },
                ..
            })
        )
    }

    /// Tells something.
    pub fn tell(&mut self, text: String) {
        self.put_notice(text, false);
    }

    /// Tells that something went wrong.
    pub fn tell_error(&mut self, text: String) {
        self.put_notice(text, true);
    }

    fn put_notice(&mut self, text: String, is_error: bool) {
        // Said twice is said once.
        self.notices.retain(|notice| notice.text != text);
        self.notices.push(Notice {
            text,
            is_error,
            since: Instant::now(),
        });
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.close();
    }
}

fn references(study: &Study) -> Vec<Reference> {
    let model = study.model();
    let evaluated = study.references.iter().filter_map(|reference| {
        let design = reference.parse(study.working_mode).ok()?;
        Some(Reference {
            name: reference.name.clone(),
            evaluation: model.evaluate(&design, GridChoice::Reference).ok()?,
            stated: reference
                .mass_kg
                .zip(reference.workspace_radius_m)
                .map(|(mass, radius)| [mass, radius]),
        })
    });
    evaluated.collect()
}
