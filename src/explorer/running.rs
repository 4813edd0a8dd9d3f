//! A run under way in the window, with the files it leaves.

use std::path::PathBuf;
use std::sync::mpsc::sync_channel;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

use tempfile::TempDir;

use super::Intake;
use crate::recording::Recorder;
use crate::study::{RunControl, RunFolder, Study, Subscriber};

/// Events that may wait in a channel before the run waits too.
const CHANNEL: usize = 64;

/// A run under way, or at its end.
///
/// It writes the same folder as a run without a window, to a place of its own, from where it can be saved. Dropping it
/// ends the run and removes that place.
pub struct Running {
    /// The study as run.
    pub study: Arc<Study>,
    /// Pauses, steps and stops it.
    pub control: Arc<RunControl>,
    /// Its news.
    pub intake: Arc<Intake>,
    folder: Arc<TempDir>,
    writing: Writing,
    threads: Vec<JoinHandle<()>>,
    clock: Clock,
}

/// The run's files that are still being written.
#[derive(Debug, Clone, Default)]
pub struct Writing(Arc<(Mutex<usize>, Condvar)>);

impl Writing {
    fn count(&self) -> MutexGuard<'_, usize> {
        self.0.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// One more, until what is returned is dropped.
    fn begin(&self) -> BeingWritten {
        *self.count() += 1;
        BeingWritten(self.clone())
    }

    /// Waits until all are whole: a recording draws its front for a while after the run has ended.
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

/// Time that a run has worked, pauses left out.
#[derive(Debug)]
struct Clock {
    worked: Duration,
    since: Option<Instant>,
}

impl Running {
    /// Starts the run of a study, whose events come from `source`; `wake` is called when it has news.
    ///
    /// # Errors
    /// No folder for its files could be made, or no thread started.
    pub fn start(
        study: Study,
        source: impl FnOnce(Study, Arc<RunControl>, Vec<Subscriber>) -> std::io::Result<JoinHandle<()>>,
        wake: impl Fn() + Send + Sync + 'static,
    ) -> Result<Self, String> {
        let place = |error: std::io::Error| {
            format!(
                "cannot start the run: no folder for its files below {}: {error}",
                std::env::temp_dir().display()
            )
        };
        let folder = Arc::new(tempfile::Builder::new().prefix("kinefront-").tempdir().map_err(place)?);
        let path = folder.path().join("run");
        let intake = Arc::new(Intake::new(wake));
        let control = Arc::new(RunControl::default());
        let mut subscribers = Vec::new();
        let mut threads = Vec::new();

        let tables = RunFolder::create(&path, &study).map_err(|error| error.to_string())?;
        let recorder = Recorder::create(&path.join("recording.rrd"), &study).map_err(|error| error.to_string())?;
        let mut listen = |name: &str, work: Box<dyn FnOnce(&_) + Send>| -> Result<(), String> {
            let (sender, receiver) = sync_channel(CHANNEL);
            subscribers.push(sender);
            Builder::new()
                .name(format!("kinefront-{name}"))
                .spawn(move || work(&receiver))
                .map(|thread| threads.push(thread))
                .map_err(|error| format!("cannot start the run: {error}"))
        };
        // Each keeps the folder until it is done with its file.
        let writing = Writing::default();
        let (held, told, as_run) = (
            (Arc::clone(&folder), writing.begin()),
            Arc::clone(&intake),
            study.clone(),
        );
        listen(
            "tables",
            Box::new(move |events| {
                if let Err(error) = tables.follow(events, &as_run) {
                    told.trouble(format!("the tables stop here, the run goes on: {error}"));
                }
                drop(held);
            }),
        )?;
        let (held, told) = ((Arc::clone(&folder), writing.begin()), Arc::clone(&intake));
        listen(
            "recorder",
            Box::new(move |events| {
                if let Err(error) = recorder.follow(events) {
                    told.trouble(format!("the recording stops here, the run goes on: {error}"));
                }
                drop(held);
            }),
        )?;
        let told = Arc::clone(&intake);
        listen("collector", Box::new(move |events| told.follow(events)))?;
        let as_run = Arc::new(study);
        source((*as_run).clone(), Arc::clone(&control), subscribers)
            .map_err(|error| format!("cannot start the run: {error}"))?;
        Ok(Self {
            study: as_run,
            control,
            intake,
            folder,
            writing,
            threads,
            clock: Clock {
                worked: Duration::ZERO,
                since: Some(Instant::now()),
            },
        })
    }

    /// Ends the run and waits a moment for its files to be closed, so that none is left behind.
    pub fn close(self) {
        const PATIENCE: Duration = Duration::from_secs(3);
        self.control.abandon();
        let since = Instant::now();
        while since.elapsed() < PATIENCE && !self.threads.iter().all(JoinHandle::is_finished) {
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// Folder with the run's files; whole once the run has ended.
    pub fn folder(&self) -> PathBuf {
        self.folder.path().join("run")
    }

    /// Its files that are still being written.
    pub fn writing(&self) -> &Writing {
        &self.writing
    }

    /// Time worked so far.
    pub fn elapsed(&self) -> Duration {
        self.clock.worked + self.clock.since.map_or(Duration::ZERO, |since| since.elapsed())
    }

    /// Stops or starts the clock.
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
