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
    let problem = DesignProblem::new(&study).map_err(|error| error.to_string())?;
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
    let front_designs = study.optimizer.front_designs;
    let stopping = Stopping::new(&study.optimizer);
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
    let mut outcome = EndReason::Completed;
    while evaluated_count < budget {
        if !control.go_on() {
            outcome = EndReason::Stopped;
            break;
        }
        generation += 1;
        let required = Instant::now();
        let mut candidates = algorithm.ask();
        candidates.truncate(budget - evaluated_count);
        times.optimizer_s += required.elapsed().as_secs_f64();

        let began = Instant::now();
        let (values, evaluations): (Vec<Vec<f64>>, Vec<Evaluation>) = pool
            .install(|| {
                candidates
                    .into_par_iter()
                    .map(|candidate| {
                        let x = problem.completed(candidate);
                        problem.evaluation(&x).map(|evaluation| (x, evaluation))
                    })
                    .collect::<Result<_, _>>()
            })
            .map_err(|error| error.to_string())?;
        times.evaluation_s += began.elapsed().as_secs_f64();

        let telling = Instant::now();
        let mut front_changed = false;
        let mut evaluated = Vec::with_capacity(values.len());
        for (offset, (x, evaluation)) in values.into_iter().zip(&evaluations).enumerate() {
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
        if evaluated_count < budget
            && let Some(reason) = stopping.reason(start.elapsed(), &history)
        {
            outcome = reason;
            break;
        }
    }
    times.search_s = start.elapsed().as_secs_f64();

    let found = members.len();
    let verifying = Instant::now();
    let Some(verified) = verify(members.into_values().collect(), &problem, &pool, control, publisher) else {
        return Ok(());
    };
    times.verification_s = verifying.elapsed().as_secs_f64();
    times.publish_s = publisher.spent.as_secs_f64();
    let objectives: Vec<[f64; 2]> = verified.iter().map(FrontMember::objectives).collect();
    let shown = spread(&objectives, front_designs);
    publisher.send(Event::Finished(RunSummary {
        outcome,
        threads,
        history,
        dropped: found - verified.len(),
        verified_hypervolume: hypervolume(objectives, reference),
        verified: verified.len(),
        front: shown.into_iter().map(|place| verified[place].clone()).collect(),
        times,
    }));
    Ok(())
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
