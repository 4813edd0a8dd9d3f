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
    DesignProblem, EndReason, Event, FrontMember, FrontProofs, FrontProver, RunControl, RunSummary, Started, Study,
    StudySearch, Subscriber, TableRow,
};
use kinefront_model::evaluation::Evaluation;
use kinefront_optimize::{Archive, ArchiveMember, Objectives, hypervolume, spread};

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
    let front = search.found.candidates();
    let verified = match outcome {
        EndReason::Interrupted => None,
        _ => verify(&front, &search, control, publisher),
    };
    search.times.verification_s = verifying.elapsed().as_secs_f64();
    let certifying = Instant::now();
    let reported = verified.and_then(|verified| report(verified, &search, control, publisher));
    search.times.certification_s = certifying.elapsed().as_secs_f64();
    search.times.publish_s = publisher.spent.as_secs_f64();
    match reported {
        Some(reported) => {
            let found = search.found.front().len();
            Some(summary(search, outcome, found, reported))
        }
        None if control.is_interrupted() || outcome == EndReason::Interrupted => {
            Some(summary(search, EndReason::Interrupted, 0, Reported::default()))
        }
        None => None,
    }
}

/// What a run reports of its verified front.
#[derive(Default)]
struct Reported {
    /// Number of designs of the verified front.
    verified: usize,
    /// Its hypervolume.
    hypervolume: f64,
    /// The designs that are reported.
    front: Vec<FrontMember>,
    proofs: Option<FrontProofs>,
}

/// Thins the verified front to evenly spread designs and proves their workspaces, if the study asks for it. Returns `None` if
/// the run was interrupted or abandoned.
fn report(
    verified: Vec<FrontMember>,
    search: &StudySearch,
    control: &RunControl,
    publisher: &mut Publisher,
) -> Option<Reported> {
    let (study, reference) = (search.study(), search.found.reference);
    let objectives: Vec<Objectives> = verified.iter().map(FrontMember::objectives).collect();
    let shown = spread(&objectives, study.optimizer.front_designs);
    let front: Vec<FrontMember> = shown.into_iter().map(|place| verified[place].clone()).collect();
    let reported = Reported {
        verified: verified.len(),
        hypervolume: hypervolume(objectives, reference),
        front,
        proofs: None,
    };
    if !study.certifies() {
        return Some(reported);
    }
    let goes_on = || !control.is_abandoned();
    let mut prover = FrontProver::new(search.problem.model(), study.thickest_bars(), &goes_on);
    let (found, total) = (search.found.front().len(), reported.front.len());
    let mut done = 0;
    for part in reported.front.chunks(4 * search.threads()) {
        publisher.send(Event::Verifying {
            done: found + done,
            total: found + total,
        });
        search.pool.install(|| prover.prove(part));
        if control.is_abandoned() {
            return None;
        }
        done += part.len();
    }
    let (front, proofs) = prover.conclude(search.found.evaluated, reference);
    Some(Reported {
        front,
        proofs: Some(proofs),
        ..reported
    })
}

fn summary(search: StudySearch, outcome: EndReason, found: usize, reported: Reported) -> RunSummary {
    let threads = search.threads();
    let StudySearch {
        found: Found { history, .. },
        times,
        ..
    } = search;
    RunSummary {
        outcome,
        threads,
        history,
        dropped: found.saturating_sub(reported.verified),
        verified_hypervolume: reported.hypervolume,
        verified: reported.verified,
        front: reported.front,
        proofs: reported.proofs,
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
    let study = search.study();
    let proofs = if study.certifies() {
        front.len().min(study.optimizer.front_designs)
    } else {
        0
    };
    let (total, problem) = (front.len() + proofs, &search.problem);
    let mut next_id = search.found.evaluated;
    let mut archive = Archive::default();
    let mut verified: BTreeMap<usize, FrontMember> = BTreeMap::new();
    let mut done = 0;
    let is_single = study.objectives.len() == 1;
    'parts: for part in front.chunks(if is_single { 1 } else { 4 } * search.threads()) {
        publisher.send(Event::Verifying { done, total });
        let evaluate = |entry: &Arc<TableRow>| {
            if control.is_abandoned() {
                return None;
            }
            Some(problem.verify(&entry.row.design))
        };
        let evaluations: Option<Vec<Evaluation>> = search.pool.install(|| part.par_iter().map(evaluate).collect());
        for (entry, evaluation) in part.iter().zip(evaluations?) {
            // Of runners-up, only those are of interest that are better than what holds on the fine grid.
            let settles = |member: &ArchiveMember| member.objectives[0] <= entry.row.objectives[0];
            if is_single && archive.iter().any(settles) {
                break 'parts;
            }
            let mut id = entry.id;
            if evaluation.design != entry.row.design {
                // A design whose bars were sized again is not one of the search.
                id = next_id;
                next_id += 1;
            }
            archive.insert(id, &[], &DesignProblem::outcome(&evaluation));
            verified.insert(
                id,
                FrontMember {
                    id,
                    generation: entry.row.generation as usize,
                    evaluation,
                    reference_radius: entry.row.workspace_radius(),
                    certified: None,
                },
            );
        }
        done += part.len();
    }
    // On a front of two objectives, the order by one is also the order by the other.
    let front = archive.iter().filter_map(|member| verified.remove(&member.id));
    Some(front.collect())
}
