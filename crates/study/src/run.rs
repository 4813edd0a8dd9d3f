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

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

use super::conclusion::conclude;
use super::search::SearchError;
use super::{Event, RunControl, Started, Study, StudySearch, Subscriber};

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
    if let Some(mut summary) = conclude(search, outcome, control, &mut |event| publisher.send(event)) {
        summary.times.publish_s = publisher.spent.as_secs_f64();
        publisher.send(Event::Finished(summary));
    }
    Ok(())
}
