//! A search with its progress, which Ctrl-C interrupts.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::time::Duration;

use pyo3::prelude::*;

use kinefront_study::{
    ConclusionPart, Event, RunControl, RunSummary, RunWriter, Study, StudySearch, TableRow, spawn_search,
};

use crate::errors::{FileError, of_search};
use crate::run::PyRun;

/// Longest time between two looks at the signals.
const TICK: Duration = Duration::from_millis(50);

/// Number of events that the channel can hold.
const CHANNEL: usize = 64;

/// State of a search.
#[pyclass(name = "Progress", module = "kinefront", frozen, get_all)]
pub struct PyProgress {
    /// `search`, `verification` or `proofs`.
    phase: &'static str,
    /// Number of the generation.
    generation: usize,
    /// Designs evaluated so far, or verified, or proved.
    evaluations: usize,
    /// Designs to be evaluated, or to be verified, or to be proved.
    budget: usize,
    /// Feasible designs so far.
    feasible: usize,
    /// Designs on the front.
    front_size: usize,
    /// Hypervolume of the front on the reference grid.
    hypervolume: f64,
}

#[pymethods]
impl PyProgress {
    fn __repr__(&self) -> String {
        format!(
            "<kinefront.Progress {}: {} of {}, {} on the front>",
            self.phase, self.evaluations, self.budget, self.front_size
        )
    }
}

/// What a search has given so far.
struct Collected {
    rows: Vec<TableRow>,
    summary: Option<RunSummary>,
    failure: Option<String>,
    writer: Option<RunWriter>,
    last: Option<kinefront_study::GenerationSummary>,
}

impl Collected {
    /// Takes an event; returns the progress that it tells.
    fn take(&mut self, event: &Arc<Event>, budget: usize) -> Result<Option<PyProgress>, String> {
        if let Some(writer) = &mut self.writer {
            writer.write(Some(event)).map_err(|cause| cause.to_string())?;
        }
        match &**event {
            Event::Evaluated(batch) => self.rows.extend(batch.entries()),
            Event::Generation(summary) => {
                self.last = Some(*summary);
                return Ok(Some(self.progress("search", summary.evaluations, budget)));
            }
            Event::Concluding { part, done, total } => {
                let phase = match part {
                    ConclusionPart::Verification => "verification",
                    ConclusionPart::Proofs => "proofs",
                };
                return Ok(Some(self.progress(phase, *done, *total)));
            }
            Event::Finished(summary) => {
                if let Some(writer) = &mut self.writer {
                    writer.finish(summary).map_err(|cause| cause.to_string())?;
                    writer.conclude().map_err(|cause| cause.to_string())?;
                }
                self.summary = Some(summary.clone());
            }
            Event::Failed(message) => self.failure = Some(message.clone()),
            _ => {}
        }
        Ok(None)
    }

    fn progress(&self, phase: &'static str, evaluations: usize, budget: usize) -> PyProgress {
        let last = self.last.as_ref();
        PyProgress {
            phase,
            generation: last.map_or(0, |last| last.generation),
            evaluations,
            budget,
            feasible: last.map_or(0, |last| last.feasible),
            front_size: last.map_or(0, |last| last.front_size),
            hypervolume: last.map_or(0.0, |last| last.hypervolume),
        }
    }
}

/// Runs a study; a callback that returns `False` ends the search, whose front is verified all the same.
pub(crate) fn run(py: Python<'_>, study: Study, callback: Option<Py<PyAny>>, out: Option<PathBuf>) -> PyResult<PyRun> {
    let writer = match &out {
        Some(folder) => {
            Some(RunWriter::create(folder, &study, None).map_err(|cause| FileError::new_err(cause.to_string()))?)
        }
        None => None,
    };
    let budget = study.optimizer.evaluations;
    let search = StudySearch::new(study.clone(), None).map_err(of_search)?;
    let control = Arc::new(RunControl::default());
    let (sender, events) = sync_channel(CHANNEL);
    let worker = spawn_search(search, Arc::clone(&control), vec![sender])?;
    let mut collected = Collected {
        rows: Vec::new(),
        summary: None,
        failure: None,
        writer,
        last: None,
    };
    let (events, followed) = follow(py, events, &control, &callback, budget, &mut collected);
    if followed.is_err() {
        control.interrupt();
    }
    // The worker waits while the channel is full, so the rest is taken before its end is waited for; what was evaluated is written
    // even if the caller wants no more of it.
    let drained = py.detach(|| {
        let rest: Result<Vec<_>, String> = events.into_iter().map(|event| collected.take(&event, budget)).collect();
        let _ = worker.join();
        rest.map(drop)
    });
    followed?;
    drained.map_err(FileError::new_err)?;
    if let Some(message) = collected.failure {
        return Err(of_search(message));
    }
    let Some(summary) = collected.summary else {
        return Err(of_search("the search ended without a result"));
    };
    Ok(PyRun::of_search(study, collected.rows, &summary, out))
}

/// Follows a search until it ends, or until the callback or a signal raises an exception.
fn follow(
    py: Python<'_>,
    mut events: Receiver<Arc<Event>>,
    control: &RunControl,
    callback: &Option<Py<PyAny>>,
    budget: usize,
    collected: &mut Collected,
) -> (Receiver<Arc<Event>>, PyResult<()>) {
    loop {
        let (back, event) = py.detach(move || {
            let event = events.recv_timeout(TICK);
            (events, event)
        });
        events = back;
        let told = match event {
            Ok(event) => collected.take(&event, budget).map_err(FileError::new_err),
            Err(RecvTimeoutError::Timeout) => Ok(None),
            Err(RecvTimeoutError::Disconnected) => return (events, Ok(())),
        };
        let seen = told.and_then(|progress| match (progress, callback) {
            (Some(progress), Some(callback)) => {
                let answer = callback.call1(py, (progress,))?;
                if answer.bind(py).is(&*pyo3::types::PyBool::new(py, false)) {
                    control.stop();
                }
                Ok(())
            }
            _ => Ok(()),
        });
        if let Err(error) = seen.and_then(|()| py.check_signals()) {
            return (events, Err(error));
        }
    }
}
