//! Collects messages of the run's thread between two frames of the window, so that neither waits for the other.

use std::sync::mpsc::Receiver;
use std::sync::{Arc, Mutex};
use std::time::Instant;

use super::lock;
use crate::{FrontEntry, Store};
use kinefront_study::{ConclusionPart, Event, GenerationSummary, RunSummary};

/// Messages of a run since the last call of [`Intake::take`].
#[derive(Debug, Default)]
pub struct RunMessages {
    /// Designs that were evaluated.
    pub rows: Store,
    /// The current front, if it has changed.
    pub front: Option<Vec<FrontEntry>>,
    /// Summaries of the completed generations, and when they arrived.
    pub history: Vec<(GenerationSummary, Instant)>,
    /// Number of worker threads, reported once per run.
    pub threads: Option<usize>,
    /// Part of the end of the run, number of designs of which it is done, and number of all of them.
    pub conclusion: Option<(ConclusionPart, usize, usize)>,
    /// Summary of the run, once it has finished.
    pub finished: Option<Box<RunSummary>>,
    /// Reason why the run failed.
    pub failed: Option<String>,
    /// Errors of the files of the run, each of which says what follows from it.
    pub troubles: Vec<String>,
}

/// Collects the messages of a run until the window takes them.
pub struct Intake {
    messages: Mutex<RunMessages>,
    wake: Box<dyn Fn() + Send + Sync>,
}

impl Intake {
    /// Makes an intake that calls `wake` at every new message.
    pub fn new(wake: impl Fn() + Send + Sync + 'static) -> Self {
        Self {
            messages: Mutex::default(),
            wake: Box::new(wake),
        }
    }

    /// Takes all messages since the last call.
    pub fn take(&self) -> RunMessages {
        std::mem::take(&mut *lock(&self.messages))
    }

    fn put(&self, put: impl FnOnce(&mut RunMessages)) {
        put(&mut lock(&self.messages));
        (self.wake)();
    }

    /// Reports an error that does not stop the run.
    pub fn trouble(&self, words: String) {
        self.put(|messages| messages.troubles.push(words));
    }

    /// Collects the events of a run until it ends.
    pub fn follow(&self, events: &Receiver<Arc<Event>>) {
        for event in events {
            match &*event {
                Event::Started(started) => self.put(|messages| messages.threads = Some(started.threads)),
                Event::Evaluated(batch) => {
                    let mut rows = Store::default();
                    for row in &batch.rows {
                        rows.push(row);
                    }
                    self.put(|messages| messages.rows.append(&mut rows));
                }
                Event::Front(front) => {
                    let front = front.iter().map(|entry| FrontEntry::of_row(entry, false)).collect();
                    self.put(|messages| messages.front = Some(front));
                }
                Event::Generation(summary) => self.put(|messages| messages.history.push((*summary, Instant::now()))),
                Event::Concluding { part, done, total } => {
                    self.put(|messages| messages.conclusion = Some((*part, *done, *total)));
                }
                Event::Finished(summary) => {
                    let front = summary.front.iter().map(FrontEntry::of_member).collect();
                    self.put(|messages| {
                        messages.front = Some(front);
                        messages.finished = Some(Box::new(summary.clone()));
                    });
                }
                Event::Failed(message) => self.put(|messages| messages.failed = Some(message.clone())),
            }
        }
    }
}
