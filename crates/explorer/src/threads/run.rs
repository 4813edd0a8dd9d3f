//! A run in progress in the window, with the files that it writes.

use crate::AnyError;
use std::path::PathBuf;
use std::sync::mpsc::sync_channel;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

use tempfile::TempDir;

use super::{Intake, lock};
use kinefront_recording::{Recorder, RunFileError, RunFiles};
use kinefront_study::{Resumption, RunControl, RunWriter, Study, Subscriber, spawn_search};

/// Number of events that a channel can hold; the run waits while one is full.
const CHANNEL: usize = 64;

/// A run in progress or ended.
///
/// It writes the same files as a run without a window: to a temporary folder from which they can be saved, or to the folder
/// of the run that it resumes. Dropping it ends the run; a temporary folder is removed.
pub struct Running {
    /// Pauses, steps and stops the run.
    pub control: Arc<RunControl>,
    /// Collects the messages of the run.
    pub intake: Arc<Intake>,
    place: Place,
    writing: Writing,
    collector: JoinHandle<()>,
    clock: Clock,
}

/// Counts the files of the run that are still being written.
#[derive(Debug, Clone, Default)]
pub struct Writing(Arc<(Mutex<usize>, Condvar)>);

impl Writing {
    fn count(&self) -> MutexGuard<'_, usize> {
        lock(&self.0.0)
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

/// Where the files of a run are.
#[derive(Debug, Clone)]
enum Place {
    /// A temporary folder, which is removed with the last of its users.
    Temporary(Arc<TempDir>),
    /// A run folder that was resumed.
    Kept(PathBuf),
}

impl Place {
    fn path(&self) -> PathBuf {
        match self {
            Self::Temporary(folder) => folder.path().join("run"),
            Self::Kept(path) => path.clone(),
        }
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
        let cannot = |error: std::io::Error| {
            format!(
                "cannot start the run: cannot create a folder for its files in {}: {error}",
                std::env::temp_dir().display()
            )
        };
        let folder = Arc::new(
            tempfile::Builder::new()
                .prefix("kinefront-")
                .tempdir()
                .map_err(cannot)?,
        );
        let place = Place::Temporary(folder);
        let tables = RunWriter::create(&place.path(), &study, Some(1))?;
        Self::over(place, tables, study, source, wake)
    }

    /// Continues a run in its folder.
    ///
    /// # Errors
    /// Returns a message if the folder cannot be written or a thread cannot be started.
    pub fn resume(resumption: Resumption, wake: impl Fn() + Send + Sync + 'static) -> Result<Self, AnyError> {
        let place = Place::Kept(resumption.folder().path().to_owned());
        let every = resumption.record_every();
        let (tables, search) = resumption.start(every)?;
        let study = Study::clone(search.study());
        let source = move |_: Study, control, listeners| spawn_search(search, control, listeners);
        Self::over(place, tables, study, source, wake)
    }

    fn over(
        place: Place,
        tables: RunWriter,
        study: Study,
        source: impl FnOnce(Study, Arc<RunControl>, Vec<Subscriber>) -> std::io::Result<JoinHandle<()>>,
        wake: impl Fn() + Send + Sync + 'static,
    ) -> Result<Self, AnyError> {
        let cannot = |error: std::io::Error| format!("cannot start the run: {error}");
        let intake = Arc::new(Intake::new(wake));
        let control = Arc::new(RunControl::default());
        let recorder = Recorder::of_run(&tables, &study)?;
        let writing = Writing::default();
        let (next, events) = sync_channel(CHANNEL);
        let messages = Arc::clone(&intake);
        let tell = move |error: &RunFileError| messages.trouble(error.to_string());
        let (listeners, files) = RunFiles::start(tables, recorder, next, Arc::clone(&control), tell).map_err(cannot)?;
        // The folder is kept until its files are complete.
        let (held, messages) = ((place.clone(), writing.begin()), Arc::clone(&intake));
        let collector = Builder::new()
            .name("kinefront-collector".to_owned())
            .spawn(move || {
                messages.follow(&events);
                files.join();
                drop(held);
            })
            .map_err(cannot)?;
        source(study, Arc::clone(&control), listeners).map_err(cannot)?;
        Ok(Self {
            control,
            intake,
            place,
            writing,
            collector,
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
        while since.elapsed() < PATIENCE && !self.collector.is_finished() {
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// Returns the run folder; its files are complete once the run has ended and [`Writing::wait`] has returned.
    pub fn folder(&self) -> PathBuf {
        self.place.path()
    }

    /// Returns the counter of the files that are still being written.
    pub fn writing(&self) -> &Writing {
        &self.writing
    }

    /// Returns the working time so far.
    pub fn elapsed(&self) -> Duration {
        self.clock.worked + self.clock.since.map_or(Duration::ZERO, |since| since.elapsed())
    }

    /// Returns the working time until an earlier moment.
    pub fn elapsed_at(&self, moment: Instant) -> Duration {
        let since = self.clock.since.map(|since| moment.saturating_duration_since(since));
        self.clock.worked + since.unwrap_or_default()
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
