//! The events of a run and the summary at its end.

use std::sync::Arc;
use std::sync::mpsc::SyncSender;

use super::{FrontMember, FrontProofs, Row, Study, TableRow, front_marks};
use kinefront_optimize::{Objectives, knee, spread};

/// Channel to a listener that receives events.
pub type Subscriber = SyncSender<Arc<Event>>;

/// Event sent by the worker thread of a run.
#[derive(Debug, Clone)]
pub enum Event {
    /// The run has started.
    Started(Started),
    /// The designs of a generation were evaluated.
    Evaluated(Batch),
    /// A generation is complete.
    Generation(GenerationSummary),
    /// The archive of non-dominated designs changed. Its members are in the order of the first objective; their workspace radii are those of
    /// the reference grid.
    Front(Vec<Arc<TableRow>>),
    /// The designs that are reported are being verified on the fine grid, or proved.
    Concluding {
        /// What is being done.
        part: ConclusionPart,
        /// Number of designs of which it is done.
        done: usize,
        /// Number of all of them, as far as it is known.
        total: usize,
    },
    /// The run ended normally.
    Finished(RunSummary),
    /// The run failed; the text is the error message.
    Failed(String),
}

/// A part of the end of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ConclusionPart {
    /// Designs are evaluated, and optimised, on the fine grid.
    Verification,
    /// Every pose of their workspaces is proved feasible.
    Proofs,
}

/// Information on a run at its start.
#[derive(Debug, Clone)]
pub struct Started {
    /// The study as run.
    pub study: Arc<Study>,
    /// Number of worker threads.
    pub threads: usize,
}

/// Designs of one generation, in order of evaluation.
#[derive(Debug, Clone)]
pub struct Batch {
    /// Number of the generation, counted from 1.
    pub generation: usize,
    /// Id of the first design; the ids of the others follow consecutively.
    pub first_id: usize,
    /// The designs with the values of their evaluations.
    pub rows: Vec<Row>,
}

impl Batch {
    /// Returns the rows with their ids.
    pub fn entries(&self) -> impl Iterator<Item = TableRow> {
        (self.first_id..)
            .zip(&self.rows)
            .map(|(id, row)| TableRow::new(id, *row))
    }
}

/// State of a run after a generation.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct GenerationSummary {
    /// Number of the generation, counted from 1.
    pub generation: usize,
    /// Number of evaluations so far.
    pub evaluations: usize,
    /// Number of feasible designs so far.
    pub feasible: usize,
    /// Number of non-dominated designs.
    pub front_size: usize,
    /// Hypervolume of the front on the reference grid, in the product of the units of the objectives.
    pub hypervolume: f64,
}

/// Reason why a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EndReason {
    /// The budget of evaluations was used up.
    Completed,
    /// The time limit was reached.
    TimeUp,
    /// The search stagnated: the hypervolume grew too little.
    Stagnated,
    /// The run was stopped on request.
    Stopped,
    /// The run was interrupted by a signal; it verified no front.
    Interrupted,
}

/// Times of the parts of a run \[s\]; of a resumed run, those since it was resumed.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct RunTimes {
    /// Time of the search, without the verification.
    pub search_s: f64,
    /// Time for evaluating designs.
    pub evaluation_s: f64,
    /// Time for the ask and tell calls of the algorithm.
    pub optimizer_s: f64,
    /// Time for sending events to listeners, including the wait for slow listeners.
    pub publish_s: f64,
    /// Time for verifying the front on the fine grid.
    pub verification_s: f64,
    /// Time for proving the workspaces of the front.
    #[serde(default)]
    pub certification_s: f64,
}

/// Summary of a run at its end.
#[derive(Debug, Clone)]
pub struct RunSummary {
    /// Reason why the run ended.
    pub outcome: EndReason,
    /// Number of worker threads.
    pub threads: usize,
    /// State of the run after each generation.
    pub history: Vec<GenerationSummary>,
    /// The front, verified on the fine grid, thinned to evenly spread designs and proved, in the order of the first objective.
    pub front: Vec<FrontMember>,
    /// Number of designs of the verified front before it was thinned.
    pub verified: usize,
    /// Number of designs that are non-dominated on the reference grid but were dropped by the verification, because
    /// they are infeasible or dominated on the fine grid.
    pub dropped: usize,
    /// Hypervolume of the verified front before it was thinned.
    pub verified_hypervolume: f64,
    /// What the proofs of the workspaces of the front found; `None` if the study asks for none.
    pub proofs: Option<FrontProofs>,
    /// Times of the parts of the run.
    pub times: RunTimes,
}

impl RunSummary {
    /// Whether the run verified its front; a front that is empty may have been verified.
    pub fn verified_front(&self) -> bool {
        self.outcome != EndReason::Interrupted
    }

    /// Returns at most `most` evenly spread designs of the front with their places, including both ends and the knee,
    /// for example for a short table.
    pub fn spread(&self, most: usize) -> impl Iterator<Item = (usize, &FrontMember)> {
        spread(&self.objectives(), most)
            .into_iter()
            .map(|place| (place, &self.front[place]))
    }

    fn objectives(&self) -> Vec<Objectives> {
        self.front.iter().map(FrontMember::objectives).collect()
    }

    /// Returns the place of the knee in `front`.
    pub fn knee(&self) -> Option<usize> {
        knee(&self.objectives())
    }

    /// Returns the mark of each member of the front ([`front_marks`]).
    pub fn marks(&self, study: &Study) -> Vec<String> {
        front_marks(study, &self.objectives())
    }
}
