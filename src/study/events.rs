//! What a run tells: its events, and the summary at its end.

use std::sync::Arc;
use std::sync::mpsc::SyncSender;

use super::{DesignProblem, Study};
use kinefront_model::evaluation::Evaluation;
use kinefront_optimize::{knee, spread};

/// Where a listener receives events.
pub type Subscriber = SyncSender<Arc<Event>>;

/// What the worker tells.
#[derive(Debug, Clone)]
pub enum Event {
    /// The run begins.
    Started(Started),
    /// Designs were evaluated, a generation's worth.
    Evaluated(Batch),
    /// A generation is done.
    Generation(GenerationSummary),
    /// The archive of non-dominated designs changed; sorted by mass, radii from the reference grid.
    Front(Vec<FrontMember>),
    /// The front is being verified on the fine grid.
    Verifying {
        /// Designs done.
        done: usize,
        /// Designs in all.
        total: usize,
    },
    /// The run ended.
    Finished(RunSummary),
    /// The run broke off.
    Failed(String),
}

/// What is known at the start.
#[derive(Debug, Clone)]
pub struct Started {
    /// The study as run.
    pub study: Arc<Study>,
    /// Worker threads used.
    pub threads: usize,
}

/// Designs of one generation, in order.
#[derive(Debug, Clone)]
pub struct Batch {
    /// Generation, from 1.
    pub generation: usize,
    /// Id of the first design; the others follow.
    pub first_id: usize,
    /// The designs.
    pub evaluations: Vec<Evaluation>,
}

/// State after a generation.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct GenerationSummary {
    /// Generation, from 1.
    pub generation: usize,
    /// Evaluations so far.
    pub evaluations: usize,
    /// Feasible designs so far.
    pub feasible: usize,
    /// Non-dominated designs.
    pub front_size: usize,
    /// Hypervolume of the front on the reference grid \[kg·m\].
    pub hypervolume: f64,
}

/// A non-dominated design.
#[derive(Debug, Clone, PartialEq)]
pub struct FrontMember {
    /// Id of its evaluation.
    pub id: usize,
    /// Generation of its evaluation.
    pub generation: usize,
    /// Its evaluation; in a finished run the one on the fine grid.
    pub evaluation: Evaluation,
    /// `R_w` on the reference grid \[m\].
    pub reference_radius: f64,
}

impl FrontMember {
    /// Both objectives, minimised.
    pub fn objectives(&self) -> [f64; 2] {
        DesignProblem::outcome(&self.evaluation).objectives
    }
}

/// Why a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// The budget is spent.
    Completed,
    /// The time is up.
    TimeUp,
    /// The hypervolume grew too little.
    Stagnated,
    /// It was asked to stop.
    Stopped,
}

/// Where the time went \[s\].
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct RunTimes {
    /// The search, verification left out.
    pub search_s: f64,
    /// Evaluating designs.
    pub evaluation_s: f64,
    /// Asking and telling the algorithm and keeping the archive.
    pub optimizer_s: f64,
    /// Handing events to listeners, waiting for slow ones included.
    pub publish_s: f64,
    /// Verifying the front on the fine grid.
    pub verification_s: f64,
}

/// A run at its end.
#[derive(Debug, Clone)]
pub struct RunSummary {
    /// Why it ended.
    pub outcome: Outcome,
    /// Worker threads used.
    pub threads: usize,
    /// State after each generation.
    pub history: Vec<GenerationSummary>,
    /// The front, verified on the fine grid and thinned to evenly spread designs, sorted by `R_w`.
    pub front: Vec<FrontMember>,
    /// Designs of the verified front before it was thinned.
    pub verified: usize,
    /// Non-dominated designs of the reference grid that verification dropped: infeasible or dominated on the fine one.
    pub dropped: usize,
    /// Hypervolume of the verified front before it was thinned \[kg·m\].
    pub verified_hypervolume: f64,
    /// Where the time went.
    pub times: RunTimes,
}

impl RunSummary {
    /// At most `most` designs of the front with their places, evenly spread with its ends and its knee: what fits
    /// a table.
    pub fn spread(&self, most: usize) -> impl Iterator<Item = (usize, &FrontMember)> {
        spread(&self.objectives(), most)
            .into_iter()
            .map(|place| (place, &self.front[place]))
    }

    fn objectives(&self) -> Vec<[f64; 2]> {
        self.front.iter().map(FrontMember::objectives).collect()
    }

    /// Place of the knee in `front`.
    pub fn knee(&self) -> Option<usize> {
        knee(&self.objectives())
    }

    /// What each member of the front stands out by; empty for most.
    pub fn marks(&self) -> Vec<&'static str> {
        let mut marks = vec![""; self.front.len()];
        if let Some(last) = marks.last_mut() {
            *last = "largest";
        }
        if let Some(first) = marks.first_mut() {
            *first = "lightest";
        }
        if let Some(knee) = self.knee() {
            marks[knee] = "knee";
        }
        marks
    }
}
