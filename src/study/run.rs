//! The run of a study: a worker thread that performs the search and the events that it sends.
//!
//! ```text
//!             RunControl: pause, step, stop
//!                  │
//! study ─► worker thread: ask ─► evaluate (thread pool) ─► tell ─► archive
//!                  │ Arc<Event>, bounded channels
//!                  ├─► tables    (designs.csv, front.csv, run.json)
//!                  ├─► recorder  (recording.rrd)
//!                  └─► terminal or window
//! ```
//!
//! The channels are bounded: the worker thread waits for a slow listener and never drops an event. A listener that has
//! ended (because of a full disk or a closed window) receives no further events, and the run continues. The candidates
//! of a generation are evaluated in parallel and told to the algorithm in their order, so the result depends neither on
//! the number of threads nor on the listeners.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

use rayon::prelude::*;

use super::stopping::Stopping;
use super::{
    AlgorithmName, Batch, DesignProblem, EndReason, Event, FrontMember, GenerationSummary, RunControl, RunSummary,
    RunTimes, Started, Study, Subscriber,
};
use kinefront_model::evaluation::{Evaluation, GridChoice};
use kinefront_model::mechanism::DesignError;
use kinefront_model::workspace::GridError;
use kinefront_optimize::{Algorithm, Archive, Evaluated, FrontDe, Moga2, Nsga2, Problem, hypervolume, spread};

/// Starts the run of a study on its own thread.
///
/// # Errors
/// The I/O error if the thread cannot be started.
pub fn spawn(study: Study, control: Arc<RunControl>, subscribers: Vec<Subscriber>) -> std::io::Result<JoinHandle<()>> {
    Builder::new().name("kinefront-run".to_owned()).spawn(move || {
        let mut publisher = Publisher {
            subscribers,
            spent: Duration::ZERO,
        };
        // A panic is a bug; the listeners must still learn that the run failed, so that they keep what was found.
        let ended = catch_unwind(AssertUnwindSafe(|| run(study, &control, &mut publisher)));
        let message = match ended {
            Ok(Ok(())) => return,
            Ok(Err(error)) => error.to_string(),
            Err(panic) => panic
                .downcast_ref::<String>()
                .cloned()
                .or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()))
                .unwrap_or_else(|| "the run panicked".to_owned()),
        };
        publisher.send(Event::Failed(message));
    })
}

/// Why a run fails; a study that was read without faults gives no cause but the threads.
#[derive(Debug, thiserror::Error)]
enum RunError {
    #[error(transparent)]
    Grid(#[from] GridError),
    #[error("cannot start the worker threads: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    #[error(transparent)]
    Design(#[from] DesignError),
}

struct Publisher {
    subscribers: Vec<Subscriber>,
    spent: Duration,
}

impl Publisher {
    fn send(&mut self, event: Event) {
        let start = Instant::now();
        let event = Arc::new(event);
        self.subscribers
            .retain(|subscriber| subscriber.send(Arc::clone(&event)).is_ok());
        self.spent += start.elapsed();
    }
}

fn run(study: Study, control: &RunControl, publisher: &mut Publisher) -> Result<(), RunError> {
    let start = Instant::now();
    let mut search = StudySearch::new(&study)?;
    publisher.send(Event::Started(Started {
        study: Arc::new(study),
        threads: search.pool.current_num_threads(),
    }));
    let outcome = search.run(start, control, publisher)?;
    search.times.search_s = start.elapsed().as_secs_f64();

    let verifying = Instant::now();
    let found = std::mem::take(&mut search.members);
    let dropped_from = found.len();
    let front = found.into_values().collect();
    let Some(verified) = verify(front, &search.problem, &search.pool, control, publisher) else {
        return Ok(());
    };
    search.times.verification_s = verifying.elapsed().as_secs_f64();
    search.times.publish_s = publisher.spent.as_secs_f64();
    let dropped = dropped_from - verified.len();
    publisher.send(Event::Finished(search.summary(outcome, &verified, dropped)));
    Ok(())
}

/// A search in progress.
struct StudySearch {
    problem: DesignProblem,
    algorithm: Box<dyn Algorithm>,
    pool: rayon::ThreadPool,
    stopping: Stopping,
    /// Number of evaluations allowed.
    budget: usize,
    /// Number of designs of the verified front that are kept.
    front_designs: usize,
    /// Reference point of the hypervolume.
    reference: [f64; 2],
    archive: Archive,
    /// The members of the archive, by id.
    members: BTreeMap<usize, FrontMember>,
    history: Vec<GenerationSummary>,
    evaluated: usize,
    feasible: usize,
    times: RunTimes,
}

/// A generation that was evaluated: the candidates as completed, and their evaluations.
struct Generation {
    values: Vec<Vec<f64>>,
    evaluations: Vec<Evaluation>,
}

impl StudySearch {
    fn new(study: &Study) -> Result<Self, RunError> {
        let problem = DesignProblem::new(study)?;
        let mut pool = rayon::ThreadPoolBuilder::new().thread_name(|index| format!("kinefront-evaluate-{index}"));
        if let Some(threads) = study.optimizer.threads {
            pool = pool.num_threads(threads);
        }
        let pool = pool.build()?;
        Ok(Self {
            algorithm: algorithm(study, &problem),
            problem,
            pool,
            stopping: Stopping::new(&study.optimizer),
            budget: study.optimizer.evaluations,
            front_designs: study.optimizer.front_designs,
            reference: [study.hypervolume.reference_mass_kg, 0.0],
            archive: Archive::default(),
            members: BTreeMap::new(),
            history: Vec::new(),
            evaluated: 0,
            feasible: 0,
            times: RunTimes::default(),
        })
    }

    /// Searches until the budget is used, or until the search is ended; returns the reason.
    fn run(&mut self, start: Instant, control: &RunControl, publisher: &mut Publisher) -> Result<EndReason, RunError> {
        while self.evaluated < self.budget {
            if !control.go_on() {
                return Ok(EndReason::Stopped);
            }
            let generation = self.evaluate_generation()?;
            self.tell(generation, publisher);
            let spent = self.evaluated >= self.budget;
            if let Some(reason) = self.stopping.reason(start.elapsed(), &self.history).filter(|_| !spent) {
                return Ok(reason);
            }
        }
        Ok(EndReason::Completed)
    }

    /// Asks the algorithm for a generation and evaluates it; the budget may cut the last one short.
    fn evaluate_generation(&mut self) -> Result<Generation, RunError> {
        let asking = Instant::now();
        let mut candidates = self.algorithm.ask();
        candidates.truncate(self.budget - self.evaluated);
        self.times.optimizer_s += asking.elapsed().as_secs_f64();

        let evaluating = Instant::now();
        let problem = &self.problem;
        let evaluate = |candidate| {
            let x = problem.completed(candidate);
            problem.evaluation(&x).map(|evaluation| (x, evaluation))
        };
        let (values, evaluations) = self
            .pool
            .install(|| candidates.into_par_iter().map(evaluate).collect::<Result<_, _>>())?;
        self.times.evaluation_s += evaluating.elapsed().as_secs_f64();
        Ok(Generation { values, evaluations })
    }

    /// Tells the algorithm the outcomes in the order of the candidates, keeps the archive, and sends the events.
    fn tell(&mut self, Generation { values, evaluations }: Generation, publisher: &mut Publisher) {
        let telling = Instant::now();
        let (generation, first_id) = (self.history.len() + 1, self.evaluated);
        let mut front_changed = false;
        let mut evaluated = Vec::with_capacity(values.len());
        for ((id, x), evaluation) in (first_id..).zip(values).zip(&evaluations) {
            let candidate = Evaluated {
                x,
                outcome: DesignProblem::outcome(evaluation),
            };
            self.feasible += usize::from(evaluation.is_feasible());
            if self.archive.insert(id, &candidate) {
                front_changed = true;
                let member = FrontMember {
                    id,
                    generation,
                    evaluation: evaluation.clone(),
                    reference_radius: evaluation.workspace_radius,
                };
                self.members.insert(id, member);
            }
            evaluated.push(candidate);
        }
        self.evaluated += evaluated.len();
        self.algorithm.tell(evaluated);
        self.times.optimizer_s += telling.elapsed().as_secs_f64();

        publisher.send(Event::Evaluated(Batch {
            generation,
            first_id,
            evaluations,
        }));
        if front_changed {
            publisher.send(Event::Front(self.keep_members()));
        }
        let summary = self.generation_summary(generation);
        self.history.push(summary);
        publisher.send(Event::Generation(summary));
    }

    /// Drops the members that left the archive; returns the others in its order.
    fn keep_members(&mut self) -> Vec<FrontMember> {
        let members = &mut self.members;
        let kept: Vec<FrontMember> = self
            .archive
            .iter()
            .filter_map(|member| members.remove(&member.id))
            .collect();
        self.members = kept.iter().map(|member| (member.id, member.clone())).collect();
        kept
    }

    fn generation_summary(&self, generation: usize) -> GenerationSummary {
        GenerationSummary {
            generation,
            evaluations: self.evaluated,
            feasible: self.feasible,
            front_size: self.archive.len(),
            hypervolume: hypervolume(self.archive.iter().map(|member| member.objectives), self.reference),
        }
    }

    /// The summary of the run, with the verified front thinned to evenly spread designs.
    fn summary(self, outcome: EndReason, verified: &[FrontMember], dropped: usize) -> RunSummary {
        let objectives: Vec<[f64; 2]> = verified.iter().map(FrontMember::objectives).collect();
        let shown = spread(&objectives, self.front_designs);
        RunSummary {
            outcome,
            threads: self.pool.current_num_threads(),
            history: self.history,
            dropped,
            verified_hypervolume: hypervolume(objectives, self.reference),
            verified: verified.len(),
            front: shown.into_iter().map(|place| verified[place].clone()).collect(),
            times: self.times,
        }
    }
}

fn algorithm(study: &Study, problem: &DesignProblem) -> Box<dyn Algorithm> {
    let (variables, seed) = (problem.variables(), study.optimizer.seed);
    match study.optimizer.algorithm {
        AlgorithmName::FrontDe => Box::new(FrontDe::new(variables, study.optimizer.front_de, seed)),
        AlgorithmName::Moga2 => Box::new(Moga2::new(variables, study.optimizer.moga2, seed)),
        AlgorithmName::Nsga2 => Box::new(Nsga2::new(variables, study.optimizer.nsga2, seed)),
    }
}

/// Evaluates the front again on the fine grid and keeps the designs that are feasible and non-dominated there. Returns
/// `None` if the run was abandoned.
fn verify(
    front: Vec<FrontMember>,
    problem: &DesignProblem,
    pool: &rayon::ThreadPool,
    control: &RunControl,
    publisher: &mut Publisher,
) -> Option<Vec<FrontMember>> {
    let total = front.len();
    let mut archive = Archive::default();
    let mut verified: BTreeMap<usize, FrontMember> = BTreeMap::new();
    let mut done = 0;
    for part in front.chunks(4 * pool.current_num_threads()) {
        if control.is_abandoned() {
            return None;
        }
        publisher.send(Event::Verifying { done, total });
        let evaluations: Vec<Evaluation> = pool.install(|| {
            part.par_iter()
                .map(|member| problem.model().evaluate(&member.evaluation.design, GridChoice::Fine))
                .collect()
        });
        for (member, evaluation) in part.iter().zip(evaluations) {
            let candidate = Evaluated {
                x: Vec::new(),
                outcome: DesignProblem::outcome(&evaluation),
            };
            archive.insert(member.id, &candidate);
            verified.insert(
                member.id,
                FrontMember {
                    evaluation,
                    ..member.clone()
                },
            );
        }
        done += part.len();
    }
    // On a front, the order by mass is also the order by R_w.
    let front = archive.iter().filter_map(|member| verified.remove(&member.id));
    Some(front.collect())
}
