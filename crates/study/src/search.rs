//! The search of a study: an algorithm that is asked for generations and told their outcomes, and what was found.

use std::fmt;
use std::sync::Arc;
use std::time::Instant;

use rayon::prelude::*;

use super::stopping::reason_to_end;
use super::{
    AlgorithmName, Batch, DesignProblem, EndReason, Event, GenerationSummary, Row, RunControl, RunTimes, Study,
    TableRow,
};
use kinefront_model::mechanism::DesignError;
use kinefront_model::workspace::GridError;
use kinefront_optimize::{
    Algorithm, Archive, Candidate, CmaEs, Evaluated, FrontDe, Moga2, Nsga2, Objectives, hypervolume,
};

/// Why a search fails; a study that was read without faults gives no cause but the threads.
#[derive(Debug, thiserror::Error)]
pub enum SearchError {
    /// A grid of the study is invalid.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// The worker threads cannot be started.
    #[error("cannot start the worker threads: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// The bounds allow values that are no design.
    #[error(transparent)]
    Design(#[from] DesignError),
}

/// A search in progress.
pub struct StudySearch {
    study: Arc<Study>,
    pub(super) problem: DesignProblem,
    pub(super) algorithm: Box<dyn Algorithm>,
    pub(super) pool: rayon::ThreadPool,
    /// Number of evaluations allowed.
    pub(super) budget: usize,
    pub(super) found: Found,
    pub(super) times: RunTimes,
    /// Candidates that the algorithm was asked for during a replay, but whose outcomes were not all known.
    pub(super) asked: Option<Vec<Candidate>>,
    /// The reason with which a search ends that evaluates nothing more.
    ends_with: Option<EndReason>,
    /// Rows that were replayed and are still to be sent to the listeners.
    pub(super) replayed: Vec<TableRow>,
}

impl fmt::Debug for StudySearch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("StudySearch")
            .field("study", &self.study.name)
            .field("found", &self.found)
            .finish_non_exhaustive()
    }
}

impl StudySearch {
    /// Prepares the search of a study.
    ///
    /// # Errors
    /// [`SearchError`].
    pub fn new(study: Study, threads: Option<usize>) -> Result<Self, SearchError> {
        let problem = DesignProblem::new(&study)?;
        let mut pool = rayon::ThreadPoolBuilder::new().thread_name(|index| format!("kinefront-evaluate-{index}"));
        if let Some(threads) = threads.or(study.optimizer.threads) {
            pool = pool.num_threads(threads);
        }
        Ok(Self {
            algorithm: algorithm(&study, &problem),
            problem,
            pool: pool.build()?,
            budget: study.optimizer.evaluations,
            found: Found::new(&study),
            times: RunTimes::default(),
            asked: None,
            ends_with: None,
            replayed: Vec::new(),
            study: Arc::new(study),
        })
    }

    /// Ends the search once the replayed designs are sent, with the reason for which the run had ended.
    pub fn end_after_replay(&mut self, outcome: EndReason) {
        self.ends_with = Some(outcome);
    }

    /// The study of the search.
    pub fn study(&self) -> &Arc<Study> {
        &self.study
    }

    /// Number of worker threads.
    pub fn threads(&self) -> usize {
        self.pool.current_num_threads()
    }

    /// Number of designs that were replayed and not yet sent to the listeners.
    pub fn replayed(&self) -> usize {
        self.replayed.len()
    }

    /// Sends the replayed designs to the listeners, as if they had been evaluated now. Returns whether all were sent: a run
    /// that is abandoned stops here.
    pub(super) fn send_replayed(&mut self, control: &RunControl, mut send: impl FnMut(Event)) -> bool {
        let rows = std::mem::take(&mut self.replayed);
        for generation in rows.chunk_by(|a, b| a.row.generation == b.row.generation) {
            if control.is_abandoned() {
                return false;
            }
            self.found
                .add(generation.iter().map(|entry| entry.row).collect(), &mut send);
        }
        true
    }

    /// Searches until the budget is used, or until the search is ended; returns the reason.
    pub(super) fn run(
        &mut self,
        start: Instant,
        control: &RunControl,
        mut send: impl FnMut(Event),
    ) -> Result<EndReason, SearchError> {
        if let Some(outcome) = self.ends_with {
            return Ok(outcome);
        }
        while self.found.evaluated < self.budget {
            if !control.go_on() {
                return Ok(control.end_reason());
            }
            let Some(generation) = self.evaluate_generation(control)? else {
                return Ok(control.end_reason());
            };
            self.tell(generation, &mut send);
            let is_spent = self.found.evaluated >= self.budget;
            let reason = reason_to_end(&self.study.optimizer, start.elapsed(), &self.found.history);
            if let Some(reason) = reason.filter(|_| !is_spent) {
                return Ok(reason);
            }
        }
        Ok(EndReason::Completed)
    }

    /// Asks the algorithm for a generation and evaluates it; the budget may cut the last one short. `None` if the run is
    /// interrupted meanwhile.
    fn evaluate_generation(&mut self, control: &RunControl) -> Result<Option<Generation>, SearchError> {
        let asking = Instant::now();
        let mut candidates = self.asked.take().unwrap_or_else(|| self.algorithm.ask());
        candidates.truncate(self.budget - self.found.evaluated);
        self.times.optimizer_s += asking.elapsed().as_secs_f64();

        let evaluating = Instant::now();
        let problem = &self.problem;
        let number = self.found.history.len() + 1;
        let evaluate = |candidate| {
            if control.is_abandoned() {
                return Ok(None);
            }
            let x = kinefront_optimize::Problem::completed(problem, candidate);
            let evaluation = problem.evaluation(&x)?;
            Ok(Some((x, Row::new(number, &evaluation))))
        };
        let evaluated: Result<Vec<_>, DesignError> =
            self.pool.install(|| candidates.into_par_iter().map(evaluate).collect());
        self.times.evaluation_s += evaluating.elapsed().as_secs_f64();
        let evaluated: Option<Vec<_>> = evaluated?.into_iter().collect();
        Ok(evaluated.map(|evaluated| {
            let (values, rows) = evaluated.into_iter().unzip();
            Generation { values, rows }
        }))
    }

    /// Tells the algorithm the outcomes in the order of the candidates, and sends the events.
    fn tell(&mut self, Generation { values, rows }: Generation, send: impl FnMut(Event)) {
        let telling = Instant::now();
        let evaluated = values.into_iter().zip(&rows).map(|(x, row)| Evaluated {
            x,
            outcome: row.outcome(),
        });
        self.algorithm.tell(evaluated.collect());
        self.times.optimizer_s += telling.elapsed().as_secs_f64();
        self.found.add(rows, send);
    }
}

/// A generation that was evaluated: the candidates as completed, and their rows.
struct Generation {
    values: Vec<Vec<f64>>,
    rows: Vec<Row>,
}

/// Largest number of designs that are verified when there is one objective.
const RUNNERS_UP: usize = 24;

/// Number of first designs of an architecture on the front that are followed for each one of another architecture.
const FAVOURED: usize = 2;

/// Number of first designs that are kept of each architecture.
pub(super) const FIRST_DESIGNS: usize = 24;

/// Relative excess of the first runner-up over the best objective; that of each further one is at least twice as large. A search
/// that has converged ends with many copies of the best design, all of which may miss a constraint on the fine grid.
const LEAST_EXCESS: f64 = 1e-7;

/// What a search has found so far; it follows from the rows alone.
#[derive(Debug)]
pub(super) struct Found {
    pub archive: Archive,
    /// The members of the archive, in its order.
    front: Vec<Arc<TableRow>>,
    /// With one objective, the best design and others ever farther from it; otherwise empty.
    runners_up: Vec<Arc<TableRow>>,
    /// The design of each architecture that is best in the first objective, in the order in which they were found first.
    best_of_architectures: Vec<Arc<TableRow>>,
    /// The first feasible designs of each architecture, in the order in which they were found.
    first_designs: Vec<Arc<TableRow>>,
    pub history: Vec<GenerationSummary>,
    pub evaluated: usize,
    feasible: usize,
    /// Reference point of the hypervolume.
    pub reference: Objectives,
}

impl Found {
    pub fn new(study: &Study) -> Self {
        Self {
            archive: Archive::default(),
            front: Vec::new(),
            runners_up: Vec::new(),
            best_of_architectures: Vec::new(),
            first_designs: Vec::new(),
            history: Vec::new(),
            evaluated: 0,
            feasible: 0,
            reference: study.hypervolume_reference(),
        }
    }

    /// Adds the rows of a generation and sends its events.
    pub fn add(&mut self, rows: Vec<Row>, mut send: impl FnMut(Event)) {
        let (generation, first_id) = (self.history.len() + 1, self.evaluated);
        let mut front_changed = false;
        for (id, row) in (first_id..).zip(&rows) {
            self.feasible += usize::from(row.is_feasible());
            front_changed |= self.archive.insert(id, &[], &row.outcome());
        }
        if front_changed {
            self.update_front(first_id, &rows);
        }
        self.keep_runners_up(first_id, &rows);
        self.keep_first_designs(first_id, &rows);
        self.evaluated += rows.len();
        send(Event::Evaluated(Batch {
            generation,
            first_id,
            rows,
        }));
        if front_changed {
            send(Event::Front(self.front.clone()));
        }
        let summary = GenerationSummary {
            generation,
            evaluations: self.evaluated,
            feasible: self.feasible,
            front_size: self.archive.len(),
            hypervolume: hypervolume(self.archive.iter().map(|member| member.objectives), self.reference),
        };
        self.history.push(summary);
        send(Event::Generation(summary));
    }

    /// Follows the archive after the rows from `first_id` on were inserted. Members that stay keep their order.
    fn update_front(&mut self, first_id: usize, rows: &[Row]) {
        let mut before = std::mem::take(&mut self.front).into_iter();
        let entry = |id: usize| match id.checked_sub(first_id) {
            Some(place) => Some(Arc::new(TableRow::new(id, rows[place]))),
            None => before.find(|entry| entry.id == id),
        };
        self.front = self.archive.iter().map(|member| member.id).filter_map(entry).collect();
    }

    /// The designs from which the reported front is selected: those of the front, and with one objective the runners-up, because the best
    /// one may not hold on the fine grid.
    pub fn candidates(&self) -> Vec<Arc<TableRow>> {
        let runners_up = self
            .runners_up
            .iter()
            .filter(|entry| !self.front.iter().any(|best| best.id == entry.id));
        self.front.iter().chain(runners_up).cloned().collect()
    }

    /// The designs that are best in the first objective, of the architectures that are not on the front.
    pub fn best_of_other_architectures(&self) -> Vec<Arc<TableRow>> {
        let is_other = |entry: &&Arc<TableRow>| {
            let architecture = entry.row.design.architecture();
            self.front
                .iter()
                .all(|best| best.row.design.architecture() != architecture)
        };
        self.best_of_architectures.iter().filter(is_other).cloned().collect()
    }

    /// Returns the designs with which the search began, at most as many as stated: of each architecture in turn, and of those on the front
    /// [`FAVOURED`] times as many.
    pub fn first_designs(&self, most: usize) -> Vec<Arc<TableRow>> {
        let architecture = |entry: &Arc<TableRow>| entry.row.design.architecture();
        let turn = |place: usize| {
            let own = architecture(&self.first_designs[place]);
            let before = self.first_designs[..place]
                .iter()
                .filter(|other| architecture(other) == own);
            let is_leading = self.front.iter().any(|best| architecture(best) == own);
            before.count() / if is_leading { FAVOURED } else { 1 }
        };
        let mut places: Vec<usize> = (0..self.first_designs.len()).collect();
        places.sort_by_key(|place| turn(*place));
        let chosen = places.into_iter().take(most);
        chosen.map(|place| Arc::clone(&self.first_designs[place])).collect()
    }

    fn keep_first_designs(&mut self, first_id: usize, rows: &[Row]) {
        for (id, row) in (first_id..).zip(rows).filter(|(_, row)| row.is_feasible()) {
            let architecture = row.design.architecture();
            let is_own = |other: &&Arc<TableRow>| other.row.design.architecture() == architecture;
            if self.first_designs.iter().filter(is_own).count() < FIRST_DESIGNS {
                self.first_designs.push(Arc::new(TableRow::new(id, *row)));
            }
        }
    }

    /// Keeps the best design of each architecture, and with one objective the best design of all and runners-up.
    fn keep_runners_up(&mut self, first_id: usize, rows: &[Row]) {
        for (id, row) in (first_id..).zip(rows).filter(|(_, row)| row.is_feasible()) {
            let entry = || Arc::new(TableRow::new(id, *row));
            let architecture = row.design.architecture();
            let is_own = |other: &&mut Arc<TableRow>| other.row.design.architecture() == architecture;
            match self.best_of_architectures.iter_mut().find(is_own) {
                Some(best) if best.row.objectives[0] <= row.objectives[0] => {}
                Some(best) => *best = entry(),
                None => self.best_of_architectures.push(entry()),
            }
            if self.reference.len() == 1 {
                self.runners_up.push(entry());
            }
        }
        keep_runners_up(&mut self.runners_up, |entry| entry.row.objectives[0]);
    }
}

/// Keeps the best of some designs by a single objective, and others ever farther from it, best first.
pub fn keep_runners_up<T>(designs: &mut Vec<T>, objective: impl Fn(&T) -> f64) {
    // The sort is stable: among equals the older design is kept.
    designs.sort_by(|a, b| objective(a).total_cmp(&objective(b)));
    let best = designs.first().map_or(0.0, &objective);
    let mut wanted = 0.0;
    designs.retain(|design| {
        let excess = (objective(design) - best) / best.abs().max(f64::MIN_POSITIVE);
        let is_kept = excess >= wanted;
        if is_kept {
            wanted = (2.0 * excess).max(LEAST_EXCESS);
        }
        is_kept
    });
    designs.truncate(RUNNERS_UP);
}

fn algorithm(study: &Study, problem: &DesignProblem) -> Box<dyn Algorithm> {
    let (settings, seed) = (&study.optimizer, study.optimizer.seed);
    match settings.algorithm {
        // A front of one objective is a single design.
        AlgorithmName::FrontDe if study.objectives.len() != 1 => {
            Box::new(FrontDe::for_problem(problem, settings.front_de, seed))
        }
        AlgorithmName::FrontDe | AlgorithmName::CmaEs => Box::new(CmaEs::for_problem(problem, settings.cma_es, seed)),
        AlgorithmName::Moga2 => Box::new(Moga2::new(problem.variables(), settings.moga2, seed)),
        AlgorithmName::Nsga2 => Box::new(Nsga2::new(problem.variables(), settings.nsga2, seed)),
    }
}
