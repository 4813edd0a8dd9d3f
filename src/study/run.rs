//! The run of a study: a worker thread that evaluates, and the events it tells.
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
//! Channels are bounded, and the worker waits for a slow listener rather than lose an event. A listener that has gone
//! (a full disk, a closed window) is left out from then on; the run goes on. Candidates of a generation are evaluated in
//! parallel and told in their order, so the result does not depend on the number of threads or on who listens.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::mpsc::SyncSender;
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

use rayon::prelude::*;

use super::{AlgorithmName, DesignProblem, RunControl, Study};
use crate::evaluation::{Evaluation, GridChoice};
use crate::optimize::{Algorithm, Archive, Evaluated, Moga2, Nsga2, hypervolume};

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

/// Why a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// The budget is spent.
    Completed,
    /// It was asked to stop.
    Stopped,
}

/// Where the time went \[s\].
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize)]
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
    /// The front, verified on the fine grid, sorted by `R_w`.
    pub front: Vec<FrontMember>,
    /// Non-dominated designs of the reference grid that verification dropped: infeasible or dominated on the fine one.
    pub dropped: usize,
    /// Hypervolume of the verified front \[kg·m\].
    pub verified_hypervolume: f64,
    /// Where the time went.
    pub times: RunTimes,
}

impl RunSummary {
    /// At most `most` designs of the front, evenly spread over it with both its ends: what fits a table.
    pub fn spread(&self, most: usize) -> impl Iterator<Item = &FrontMember> {
        let count = self.front.len();
        let rows = count.min(most);
        (0..rows).map(move |k| &self.front[if rows > 1 { k * (count - 1) / (rows - 1) } else { 0 }])
    }
}

/// Starts the run of a study on a thread of its own.
///
/// # Errors
/// The thread could not be started.
pub fn spawn(study: Study, control: Arc<RunControl>, subscribers: Vec<Subscriber>) -> std::io::Result<JoinHandle<()>> {
    Builder::new().name("kinefront-run".to_owned()).spawn(move || {
        let mut publisher = Publisher {
            subscribers,
            spent: Duration::ZERO,
        };
        // A panic is a bug, but what was found until then must reach its readers.
        let ended = catch_unwind(AssertUnwindSafe(|| run(study, &control, &mut publisher)));
        let message = match ended {
            Ok(Ok(())) => return,
            Ok(Err(message)) => message,
            Err(panic) => panic
                .downcast_ref::<String>()
                .cloned()
                .or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()))
                .unwrap_or_else(|| "the run panicked".to_owned()),
        };
        publisher.send(Event::Failed(message));
    })
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

fn run(study: Study, control: &RunControl, publisher: &mut Publisher) -> Result<(), String> {
    let start = Instant::now();
    let problem = DesignProblem::new(&study);
    let mut pool = rayon::ThreadPoolBuilder::new().thread_name(|index| format!("kinefront-evaluate-{index}"));
    if let Some(threads) = study.optimizer.threads {
        pool = pool.num_threads(threads);
    }
    let pool = pool
        .build()
        .map_err(|error| format!("cannot start the worker threads: {error}"))?;
    let threads = pool.current_num_threads();
    let reference = [study.hypervolume.reference_mass_kg, 0.0];
    let budget = study.optimizer.evaluations;
    let mut algorithm = algorithm(&study, &problem);
    publisher.send(Event::Started(Started {
        study: Arc::new(study),
        threads,
    }));

    let mut times = RunTimes::default();
    let mut archive = Archive::default();
    let mut members: BTreeMap<usize, FrontMember> = BTreeMap::new();
    let mut history: Vec<GenerationSummary> = Vec::new();
    let (mut evaluated_count, mut feasible, mut generation) = (0, 0, 0);
    let mut outcome = Outcome::Completed;
    while evaluated_count < budget {
        if !control.go_on() {
            outcome = Outcome::Stopped;
            break;
        }
        generation += 1;
        let asked = Instant::now();
        let mut candidates = algorithm.ask();
        candidates.truncate(budget - evaluated_count);
        times.optimizer_s += asked.elapsed().as_secs_f64();

        let began = Instant::now();
        let evaluations: Vec<Evaluation> = pool
            .install(|| {
                candidates
                    .par_iter()
                    .map(|x| problem.evaluation(x))
                    .collect::<Result<_, _>>()
            })
            .map_err(|error| error.to_string())?;
        times.evaluation_s += began.elapsed().as_secs_f64();

        let telling = Instant::now();
        let mut front_changed = false;
        let mut evaluated = Vec::with_capacity(candidates.len());
        for (offset, (x, evaluation)) in candidates.into_iter().zip(&evaluations).enumerate() {
            let candidate = Evaluated {
                x,
                outcome: DesignProblem::outcome(evaluation),
            };
            feasible += usize::from(evaluation.is_feasible());
            let id = evaluated_count + offset;
            if archive.insert(id, &candidate) {
                front_changed = true;
                members.insert(
                    id,
                    FrontMember {
                        id,
                        generation,
                        evaluation: evaluation.clone(),
                        reference_radius: evaluation.workspace_radius,
                    },
                );
            }
            evaluated.push(candidate);
        }
        let first_id = evaluated_count;
        evaluated_count += evaluated.len();
        algorithm.tell(evaluated);
        times.optimizer_s += telling.elapsed().as_secs_f64();

        publisher.send(Event::Evaluated(Batch {
            generation,
            first_id,
            evaluations,
        }));
        if front_changed {
            let kept = archive
                .iter()
                .filter_map(|member| members.remove(&member.id))
                .collect::<Vec<_>>();
            members = kept.iter().map(|member| (member.id, member.clone())).collect();
            publisher.send(Event::Front(kept));
        }
        let summary = GenerationSummary {
            generation,
            evaluations: evaluated_count,
            feasible,
            front_size: archive.len(),
            hypervolume: hypervolume(archive.iter().map(|member| member.objectives), reference),
        };
        history.push(summary);
        publisher.send(Event::Generation(summary));
    }
    times.search_s = start.elapsed().as_secs_f64();

    let found = members.len();
    let verifying = Instant::now();
    let Some(front) = verify(members.into_values().collect(), &problem, &pool, control, publisher)? else {
        return Ok(());
    };
    times.verification_s = verifying.elapsed().as_secs_f64();
    times.publish_s = publisher.spent.as_secs_f64();
    let objectives = front
        .iter()
        .map(|member| DesignProblem::outcome(&member.evaluation).objectives);
    publisher.send(Event::Finished(RunSummary {
        outcome,
        threads,
        history,
        dropped: found - front.len(),
        verified_hypervolume: hypervolume(objectives, reference),
        front,
        times,
    }));
    Ok(())
}

fn algorithm(study: &Study, problem: &DesignProblem) -> Box<dyn Algorithm> {
    let (variables, seed) = (problem.variables(), study.optimizer.seed);
    match study.optimizer.algorithm {
        AlgorithmName::Moga2 => Box::new(Moga2::new(variables, study.optimizer.moga2, seed)),
        AlgorithmName::Nsga2 => Box::new(Nsga2::new(variables, study.optimizer.nsga2, seed)),
    }
}

/// Evaluates the front again on the fine grid and keeps what is feasible and non-dominated there; `None` for a run that
/// was abandoned.
fn verify(
    front: Vec<FrontMember>,
    problem: &DesignProblem,
    pool: &rayon::ThreadPool,
    control: &RunControl,
    publisher: &mut Publisher,
) -> Result<Option<Vec<FrontMember>>, String> {
    let total = front.len();
    let mut archive = Archive::default();
    let mut verified: BTreeMap<usize, FrontMember> = BTreeMap::new();
    let mut done = 0;
    for part in front.chunks(4 * pool.current_num_threads()) {
        if control.is_abandoned() {
            return Ok(None);
        }
        publisher.send(Event::Verifying { done, total });
        let evaluations: Vec<Evaluation> = pool
            .install(|| {
                part.par_iter()
                    .map(|member| problem.model().evaluate(&member.evaluation.design, GridChoice::Fine))
                    .collect::<Result<_, _>>()
            })
            .map_err(|error| error.to_string())?;
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
    // On a front, sorted by mass is sorted by R_w.
    let front = archive.iter().filter_map(|member| verified.remove(&member.id));
    Ok(Some(front.collect()))
}
