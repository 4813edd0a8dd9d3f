//! The threads that write the files of a run: tables and recording.

use std::io;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::thread::{Builder, JoinHandle, sleep};
use std::time::{Duration, Instant};

use super::{Recorder, RecordingError};
use kinefront_study::{Event, RunControl, RunWriter, Subscriber, WriteError};

/// Number of events that a channel can hold; the run waits while one is full.
const CHANNEL: usize = 64;

/// Longest time between two looks at a file that is being written.
const TICK: Duration = Duration::from_millis(500);

/// Why a file of a run is no longer written.
#[derive(Debug, thiserror::Error)]
pub enum RunFileError {
    /// The tables. The search ends, because its designs would be lost; it can be resumed.
    #[error("{}; the search ends{}", .0, hint(.0))]
    Tables(WriteError),
    /// The recording. The search continues; a resumed run writes the recording anew.
    #[error("{cause}; the search continues without its recording")]
    Recording {
        /// Cause of the error.
        cause: RecordingError,
    },
    /// The recording was removed so that the tables have space.
    #[error("{cause}; the recording was removed so that the tables have space, and the run continues")]
    Removed {
        /// The file of the tables that had no space.
        cause: String,
    },
}

/// What can be done after an error of the tables; a folder that was taken away cannot be resumed.
fn hint(error: &WriteError) -> &'static str {
    match error {
        WriteError::Changed { .. } => "",
        _ => ", and the run can be resumed",
    }
}

/// Files of a run that are being written.
#[derive(Debug)]
pub struct RunFiles {
    thread: JoinHandle<Vec<RunFileError>>,
}

impl RunFiles {
    /// Starts the threads that write the tables in `folder` and the recording. Each event is passed on to `next` once its
    /// rows are written. An error is given to `tell` as soon as it occurs, and those of the tables stop the run.
    ///
    /// Returns the listeners of the run and the files.
    ///
    /// # Errors
    /// The I/O error if a thread cannot be started.
    pub fn start(
        folder: RunWriter,
        recorder: Option<Recorder>,
        next: Subscriber,
        control: Arc<RunControl>,
        tell: impl Fn(&RunFileError) + Clone + Send + 'static,
    ) -> io::Result<(Vec<Subscriber>, Self)> {
        let (to_tables, events) = sync_channel(CHANNEL);
        let mut listeners = vec![to_tables];
        let record = |recorder| {
            let (to_recorder, events) = sync_channel(CHANNEL);
            listeners.push(to_recorder);
            RecordingThread::start(recorder, events, folder.recording_path(), tell.clone())
        };
        let recording = recorder.map(record).transpose()?;
        let thread = Builder::new().name("kinefront-tables".to_owned()).spawn(move || {
            // Whatever happens to this thread, a search whose designs are lost does not go on.
            let guard = StopOnPanic(Arc::clone(&control));
            let mut writer = TableThread {
                folder,
                recording,
                control,
                failures: Vec::new(),
                tell,
            };
            writer.follow(&events, next);
            drop(guard);
            writer.failures
        })?;
        Ok((listeners, Self { thread }))
    }

    /// Waits until all files are complete; returns the errors, which `tell` was given already.
    pub fn join(self) -> Vec<RunFileError> {
        self.thread.join().unwrap_or_else(|_| {
            let cause = io::Error::other("the thread that writes the files of the run panicked");
            vec![RunFileError::Tables(WriteError::Write {
                path: Path::new("designs.csv").to_owned(),
                cause,
            })]
        })
    }
}

struct StopOnPanic(Arc<RunControl>);

impl Drop for StopOnPanic {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.stop();
        }
    }
}

struct TableThread<T> {
    folder: RunWriter,
    recording: Option<RecordingThread>,
    control: Arc<RunControl>,
    failures: Vec<RunFileError>,
    tell: T,
}

impl<T: Fn(&RunFileError)> TableThread<T> {
    fn follow(&mut self, events: &Receiver<Arc<Event>>, next: Subscriber) {
        let mut is_finished = false;
        loop {
            match events.recv_timeout(TICK) {
                Ok(event) => {
                    self.write(Some(&event));
                    if let Event::Finished(summary) = &*event {
                        // The front is on the disk before its scenes are drawn.
                        is_finished = true;
                        self.attempt(|folder| folder.finish(summary));
                    }
                    // What was not written is not reported as evaluated. A display that has ended does not stop the run.
                    let is_report = matches!(&*event, Event::Evaluated(_) | Event::Generation(_));
                    if self.tables_are_written() || !is_report {
                        let _ = next.send(event);
                    }
                }
                Err(RecvTimeoutError::Timeout) => self.write(None),
                Err(RecvTimeoutError::Disconnected) => break,
            }
        }
        drop(next);
        let is_recorded = match self.recording.take().map(|recording| recording.join(&self.control)) {
            Some(Err(error)) => {
                self.failures.push(error);
                false
            }
            Some(Ok(())) | None => !self
                .failures
                .iter()
                .any(|failure| matches!(failure, RunFileError::Removed { .. })),
        };
        // A run that failed, or was abandoned, has no summary: its folder states that it has not ended.
        if is_finished && is_recorded && self.tables_are_written() {
            self.attempt(RunWriter::conclude);
        }
    }

    /// Writes something; if the disk is full, once more without the recording.
    fn attempt(&mut self, mut write: impl FnMut(&mut RunWriter) -> Result<(), WriteError>) {
        if !self.tables_are_written() {
            return;
        }
        let Err(error) = write(&mut self.folder) else { return };
        let is_full = matches!(&error, WriteError::Write { cause, .. } if is_out_of_space(cause));
        if is_full && let Some(recording) = self.recording.take() {
            // The recording can be regenerated from the tables, but not the other way round.
            self.failures.push(recording.give_up(&error, &self.tell));
            if let Err(error) = write(&mut self.folder) {
                self.fail(error);
            }
        } else {
            self.fail(error);
        }
    }

    fn write(&mut self, event: Option<&Event>) {
        self.attempt(|folder| folder.write(event));
    }

    fn tables_are_written(&self) -> bool {
        !self
            .failures
            .iter()
            .any(|failure| matches!(failure, RunFileError::Tables(_)))
    }

    fn fail(&mut self, error: WriteError) {
        let error = RunFileError::Tables(error);
        (self.tell)(&error);
        self.failures.push(error);
        self.control.stop();
    }
}

struct RecordingThread {
    thread: JoinHandle<Result<(), RunFileError>>,
    path: std::path::PathBuf,
    give_up: Arc<AtomicBool>,
}

impl RecordingThread {
    fn start(
        recorder: Recorder,
        events: Receiver<Arc<Event>>,
        path: std::path::PathBuf,
        tell: impl Fn(&RunFileError) + Send + 'static,
    ) -> io::Result<Self> {
        let give_up = Arc::new(AtomicBool::new(false));
        let (given_up, file) = (Arc::clone(&give_up), path.clone());
        let thread = Builder::new().name("kinefront-recorder".to_owned()).spawn(move || {
            match recorder.follow(&events, &given_up, TICK) {
                Ok(()) => Ok(()),
                Err(cause) if given_up.load(Ordering::Relaxed) => Err(RunFileError::Recording { cause }),
                Err(cause) => {
                    if matches!(&cause, RecordingError::Write { cause, .. } if is_out_of_space(cause)) {
                        // What is left of it would keep space from the tables.
                        let _ = std::fs::remove_file(&file);
                    }
                    let error = RunFileError::Recording { cause };
                    tell(&error);
                    Err(error)
                }
            }
        })?;
        Ok(Self { thread, path, give_up })
    }

    /// Waits until the recording is complete. An interrupted run waits long enough to close the file, but not to draw all
    /// scenes of its front.
    fn join(self, control: &RunControl) -> Result<(), RunFileError> {
        const PATIENCE: Duration = Duration::from_millis(500);
        let since = Instant::now();
        while !self.thread.is_finished() {
            if control.is_interrupted() && since.elapsed() > PATIENCE {
                self.give_up.store(true, Ordering::Relaxed);
            }
            sleep(Duration::from_millis(5));
        }
        let cause = match self.thread.join() {
            Ok(Ok(())) if self.path.exists() => return Ok(()),
            Ok(Ok(())) => RecordingError::Write {
                path: self.path,
                cause: io::ErrorKind::NotFound.into(),
            },
            Ok(Err(error)) => return Err(error),
            Err(_) => RecordingError::encode("the thread that writes it panicked"),
        };
        Err(RunFileError::Recording { cause })
    }

    /// Ends the recording and removes its file.
    fn give_up(self, cause: &WriteError, tell: &impl Fn(&RunFileError)) -> RunFileError {
        const PATIENCE: Duration = Duration::from_secs(10);
        self.give_up.store(true, Ordering::Relaxed);
        let since = Instant::now();
        while !self.thread.is_finished() && since.elapsed() < PATIENCE {
            sleep(Duration::from_millis(10));
        }
        let _ = std::fs::remove_file(&self.path);
        let removed = RunFileError::Removed {
            cause: cause.to_string(),
        };
        tell(&removed);
        removed
    }
}

/// Whether a file cannot grow because its disk, its quota or its own limit is used up.
fn is_out_of_space(error: &io::Error) -> bool {
    use io::ErrorKind::{FileTooLarge, QuotaExceeded, StorageFull};
    matches!(error.kind(), StorageFull | QuotaExceeded | FileTooLarge)
}
