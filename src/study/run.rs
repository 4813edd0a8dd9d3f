//! The run of a study: a worker thread that performs the search and the events that it sends.
//!
//! ```text
//!             RunControl: pause, step, stop
//!                  │
//! study ─► worker thread: ask ─► evaluate (thread pool) ─► tell ─► what was found
//!                  │ Arc<Event>, bounded channels
//!                  ├─► tables    (designs.csv, front.csv, run.json) ─► terminal or window
//!                  └─► recorder  (recording.rrd)
//! ```
//!
//! The channels are bounded: the worker thread waits for a slow listener and never drops an event. A listener that has
//! ended (such as a recorder whose disk is full) receives no further events, and the run continues. The candidates
//! of a generation are evaluated in parallel and told to the algorithm in their order, so the result depends neither on
//! the number of threads nor on the listeners.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

use rayon::prelude::*;

use super::search::{Found, SearchError};
use super::{
    DesignProblem, EndReason, Event, FrontMember, RunControl, RunSummary, Started, Study, StudySearch, Subscriber,
    TableRow,
};
use kinefront_model::evaluation::{Evaluation, GridChoice};
use kinefront_optimize::{Archive, Evaluated, hypervolume, spread};

/// Starts the run of a study on its own thread.
///
/// # Errors
/// The I/O error if the thread cannot be started.
pub fn spawn(study: Study, control: Arc<RunControl>, subscribers: Vec<Subscriber>) -> std::io::Result<JoinHandle<()>> {
    start(move || StudySearch::new(study, None), control, subscribers)
}

/// Starts the run of a search that was prepared, for example resumed, on its own thread.
///
/// # Errors
/// The I/O error if the thread cannot be started.
pub fn spawn_search(
    search: StudySearch,
    control: Arc<RunControl>,
    subscribers: Vec<Subscriber>,
) -> std::io::Result<JoinHandle<()>> {
    start(move || Ok(search), control, subscribers)
}

fn start(
    prepare: impl FnOnce() -> Result<StudySearch, SearchError> + Send + 'static,
    control: Arc<RunControl>,
    subscribers: Vec<Subscriber>,
) -> std::io::Result<JoinHandle<()>> {
    Builder::new().name("kinefront-run".to_owned()).spawn(move || {
        let mut publisher = Publisher {
            subscribers,
            spent: Duration::ZERO,
        };
        // A panic is a bug; the listeners must still learn that the run failed, so that they keep what was found.
        let ended = catch_unwind(AssertUnwindSafe(|| run(prepare()?, &control, &mut publisher)));
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

fn run(mut search: StudySearch, control: &RunControl, publisher: &mut Publisher) -> Result<(), SearchError> {
    let start = Instant::now();
    publisher.send(Event::Started(Started {
        study: Arc::clone(search.study()),
        threads: search.threads(),
    }));
    if !search.send_replayed(control, |event| publisher.send(event)) {
        return Ok(());
    }
    let outcome = search.run(start, control, |event| publisher.send(event))?;
    search.times.search_s = start.elapsed().as_secs_f64();
    if let Some(summary) = conclude(search, outcome, control, publisher) {
        publisher.send(Event::Finished(summary));
    }
    Ok(())
}

/// Verifies the front of a search that was resumed, as at the end of its run; returns the summary of a run that ended for
/// the reason `outcome`.
pub(super) fn verify_replayed(mut search: StudySearch, outcome: EndReason) -> Option<RunSummary> {
    let control = RunControl::default();
    search.send_replayed(&control, |_| {});
    let mut nobody = Publisher {
        subscribers: Vec::new(),
        spent: Duration::ZERO,
    };
    conclude(search, outcome, &control, &mut nobody)
}

/// Verifies the front of a search that has ended and sums it up; `None` if the run was abandoned.
fn conclude(
    mut search: StudySearch,
    outcome: EndReason,
    control: &RunControl,
    publisher: &mut Publisher,
) -> Option<RunSummary> {
    let verifying = Instant::now();
    let front = search.found.front().to_vec();
    let verified = match outcome {
        EndReason::Interrupted => None,
        _ => verify(&front, &search, control, publisher),
    };
    search.times.verification_s = verifying.elapsed().as_secs_f64();
    search.times.publish_s = publisher.spent.as_secs_f64();
    match verified {
        Some(verified) => Some(summary(search, outcome, front.len(), &verified)),
        None if control.is_interrupted() || outcome == EndReason::Interrupted => {
            Some(summary(search, EndReason::Interrupted, 0, &[]))
        }
        None => None,
    }
}

/// The summary of a run, with the verified front thinned to evenly spread designs.
fn summary(search: StudySearch, outcome: EndReason, found: usize, verified: &[FrontMember]) -> RunSummary {
    let objectives: Vec<[f64; 2]> = verified.iter().map(FrontMember::objectives).collect();
    let shown = spread(&objectives, search.study().optimizer.front_designs);
    let threads = search.threads();
    let StudySearch {
        found: Found { history, reference, .. },
        times,
        ..
    } = search;
    RunSummary {
        outcome,
        threads,
        history,
        dropped: found - verified.len(),
        verified_hypervolume: hypervolume(objectives, reference),
        verified: verified.len(),
        front: shown.into_iter().map(|place| verified[place].clone()).collect(),
        times,
    }
}

/// Evaluates the front again on the fine grid and keeps the designs that are feasible and non-dominated there. Returns
/// `None` if the run was interrupted or abandoned.
fn verify(
    front: &[Arc<TableRow>],
    search: &StudySearch,
    control: &RunControl,
    publisher: &mut Publisher,
) -> Option<Vec<FrontMember>> {
    let (total, model) = (front.len(), search.problem.model());
    let mut archive = Archive::default();
    let mut verified: BTreeMap<usize, FrontMember> = BTreeMap::new();
    let mut done = 0;
    for part in front.chunks(4 * search.threads()) {
        publisher.send(Event::Verifying { done, total });
        let evaluate = |entry: &Arc<TableRow>| {
            if control.is_abandoned() {
                return None;
            }
            Some(model.evaluate(&entry.row.design, GridChoice::Fine))
        };
        let evaluations: Option<Vec<Evaluation>> = search.pool.install(|| part.par_iter().map(evaluate).collect());
        for (entry, evaluation) in part.iter().zip(evaluations?) {
            let candidate = Evaluated {
                x: Vec::new(),
                outcome: DesignProblem::outcome(&evaluation),
            };
            archive.insert(entry.id, &candidate);
            verified.insert(
                entry.id,
                FrontMember {
                    id: entry.id,
                    generation: entry.row.generation as usize,
                    evaluation,
                    reference_radius: entry.row.radius,
                },
            );
        }
        done += part.len();
    }
    // On a front, the order by mass is also the order by R_w.
    let front = archive.iter().filter_map(|member| verified.remove(&member.id));
    Some(front.collect())
}
