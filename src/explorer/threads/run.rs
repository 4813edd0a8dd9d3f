//! A run in progress in the window, with the files that it writes.

use crate::AnyError;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, sync_channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

use tempfile::TempDir;

use super::Intake;
use crate::recording::Recorder;
use crate::study::{Event, RunControl, RunWriter, Study, Subscriber};

/// Number of events that a channel can hold; the run waits while one is full.
const CHANNEL: usize = 64;

/// A run in progress or ended.
///
/// It writes the same files as a run without a window, to a temporary folder from which they can be saved. Dropping it
/// ends the run and removes that folder.
pub struct Running {
    /// The study of the run.
    pub study: Arc<Study>,
    /// Pauses, steps and stops the run.
    pub control: Arc<RunControl>,
    /// Collects the messages of the run.
    pub intake: Arc<Intake>,
    folder: Arc<TempDir>,
    writing: Writing,
    threads: Vec<JoinHandle<()>>,
    clock: Clock,
}

/// Counts the files of the run that are still being written.
#[derive(Debug, Clone, Default)]
pub struct Writing(Arc<(Mutex<usize>, Condvar)>);

impl Writing {
    fn count(&self) -> MutexGuard<'_, usize> {
        self.0.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Counts one more file until the returned guard is dropped.
    fn begin(&self) -> BeingWritten {
        *self.count() += 1;
        BeingWritten(self.clone())
    }

    /// Waits until all files are complete: the recorder still draws the front for some time after the run has ended.
    pub fn wait(&self) {
        let mut count = self.count();
        while *count > 0 {
            count = self.0.1.wait(count).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

struct BeingWritten(Writing);

impl Drop for BeingWritten {
    fn drop(&mut self) {
        *self.0.count() -= 1;
        self.0.0.1.notify_all();
    }
}

/// Measures the working time of a run, without pauses.
#[derive(Debug)]
struct Clock {
    worked: Duration,
    since: Option<Instant>,
}

/// The threads that receive the events of a run, and their channels.
#[derive(Default)]
struct Listeners {
    subscribers: Vec<Subscriber>,
    threads: Vec<JoinHandle<()>>,
}

impl Listeners {
    fn start(&mut self, name: &str, work: impl FnOnce(&Receiver<Arc<Event>>) + Send + 'static) -> Result<(), AnyError> {
        let (sender, receiver) = sync_channel(CHANNEL);
        let thread = Builder::new()
            .name(format!("kinefront-{name}"))
            .spawn(move || work(&receiver))
            .map_err(|error| format!("cannot start the run: {error}"))?;
        self.subscribers.push(sender);
        self.threads.push(thread);
        Ok(())
    }
}

impl Running {
    /// Starts the run of a study, whose events come from `source`; `wake` is called at every new message.
    ///
    /// # Errors
    /// Returns a message if the folder for the files cannot be created or a thread cannot be started.
    pub fn start(
        study: Study,
        source: impl FnOnce(Study, Arc<RunControl>, Vec<Subscriber>) -> std::io::Result<JoinHandle<()>>,
        wake: impl Fn() + Send + Sync + 'static,
    ) -> Result<Self, AnyError> {
        let place = |error: std::io::Error| {
            format!(
                "cannot start the run: cannot create a folder for its files in {}: {error}",
                std::env::temp_dir().display()
            )
        };
        let folder = Arc::new(tempfile::Builder::new().prefix("kinefront-").tempdir().map_err(place)?);
        let path = folder.path().join("run");
        let intake = Arc::new(Intake::new(wake));
        let control = Arc::new(RunControl::default());
        let tables = RunWriter::create(&path, &study).map_err(|error| error.to_string())?;
        let recorder = Recorder::create(&path.join("recording.rrd"), &study).map_err(|error| error.to_string())?;
        let writing = Writing::default();
        let mut listeners = Listeners::default();
        // Each listener that writes keeps the folder until its file is complete.
        let (held, messages, as_run) = (
            (Arc::clone(&folder), writing.begin()),
            Arc::clone(&intake),
            study.clone(),
        );
        listeners.start("tables", move |events| {
            if let Err(error) = tables.follow(events, &as_run) {
                messages.trouble(format!(
                    "the run continues, but its tables are no longer written: {error}"
                ));
            }
            drop(held);
        })?;
        let (held, messages) = ((Arc::clone(&folder), writing.begin()), Arc::clone(&intake));
        listeners.start("recorder", move |events| {
            if let Err(error) = recorder.follow(events) {
                messages.trouble(format!(
                    "the run continues, but its recording is no longer written: {error}"
                ));
            }
            drop(held);
        })?;
        let messages = Arc::clone(&intake);
        listeners.start("collector", move |events| messages.follow(events))?;
        let as_run = Arc::new(study);
        source((*as_run).clone(), Arc::clone(&control), listeners.subscribers)
            .map_err(|error| format!("cannot start the run: {error}"))?;
        Ok(Self {
            study: as_run,
            control,
            intake,
            folder,
            writing,
            threads: listeners.threads,
            clock: Clock {
                worked: Duration::ZERO,
                since: Some(Instant::now()),
            },
        })
    }

    /// Ends the run and waits up to 3 s for its files to be closed, so that none is left behind.
    pub fn close(self) {
        const PATIENCE: Duration = Duration::from_secs(3);
        self.control.abandon();
        let since = Instant::now();
        while since.elapsed() < PATIENCE && !self.threads.iter().all(JoinHandle::is_finished) {
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// Returns the run folder; its files are complete once the run has ended and [`Writing::wait`] has returned.
    pub fn folder(&self) -> PathBuf {
        self.folder.path().join("run")
    }

    /// Returns the counter of the files that are still being written.
    pub fn writing(&self) -> &Writing {
        &self.writing
    }

    /// Returns the working time so far.
    pub fn elapsed(&self) -> Duration {
        self.clock.worked + self.clock.since.map_or(Duration::ZERO, |since| since.elapsed())
    }

    /// Starts the clock if `counting`, otherwise stops it.
    pub fn count_time(&mut self, counting: bool) {
        match (self.clock.since, counting) {
            (Some(since), false) => {
                self.clock.worked += since.elapsed();
                self.clock.since = None;
            }
            (None, true) => self.clock.since = Some(Instant::now()),
            _ => {}
        }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.control.abandon();
    }
}
