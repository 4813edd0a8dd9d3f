//! Collects messages of the run's thread between two frames of the window, so that neither waits for the other.

use std::sync::mpsc::Receiver;
use std::sync::{Arc, Mutex, PoisonError};

use crate::explorer::{FrontEntry, Row, Store};
use crate::study::{Event, GenerationSummary, RunSummary};

/// Messages of a run since the last call of [`Intake::take`].
#[derive(Debug, Default)]
pub struct RunMessages {
    /// Designs that were evaluated.
    pub rows: Store,
    /// The current front, if it has changed.
    pub front: Option<Vec<FrontEntry>>,
    /// Summaries of the completed generations.
    pub history: Vec<GenerationSummary>,
    /// Number of worker threads, reported once per run.
    pub threads: Option<usize>,
    /// Number of designs verified so far, and number of designs to verify.
    pub verifying: Option<(usize, usize)>,
    /// Summary of the run, once it has finished.
    pub finished: Option<Box<RunSummary>>,
    /// Reason why the run failed.
    pub failed: Option<String>,
    /// Errors that do not stop the run, such as a table that cannot be written.
    pub troubles: Vec<String>,
}

/// Collects the messages of a run until the window takes them.
pub struct Intake {
    news: Mutex<RunMessages>,
    wake: Box<dyn Fn() + Send + Sync>,
}

impl Intake {
    /// Makes an intake that calls `wake` at every new message.
    pub fn new(wake: impl Fn() + Send + Sync + 'static) -> Self {
        Self {
            news: Mutex::default(),
            wake: Box::new(wake),
        }
    }

    /// Takes all messages since the last call.
    pub fn take(&self) -> RunMessages {
        std::mem::take(&mut *self.news.lock().unwrap_or_else(PoisonError::into_inner))
    }

    fn put(&self, put: impl FnOnce(&mut RunMessages)) {
        put(&mut self.news.lock().unwrap_or_else(PoisonError::into_inner));
        (self.wake)();
    }

    /// Reports an error that does not stop the run.
    pub fn trouble(&self, words: String) {
        self.put(|news| news.troubles.push(words));
    }

    /// Collects the events of a run until it ends.
    pub fn follow(&self, events: &Receiver<Arc<Event>>) {
        for event in events {
            match &*event {
                Event::Started(started) => self.put(|news| news.threads = Some(started.threads)),
                Event::Evaluated(batch) => {
                    let mut rows = Store::default();
                    for evaluation in &batch.evaluations {
                        rows.push(&Row::new(batch.generation, evaluation));
                    }
                    self.put(|news| news.rows.append(&mut rows));
                }
                Event::Front(members) => {
                    let front = members.iter().map(|member| FrontEntry::new(member, false)).collect();
                    self.put(|news| news.front = Some(front));
                }
                Event::Generation(summary) => self.put(|news| news.history.push(*summary)),
                Event::Verifying { done, total } => self.put(|news| news.verifying = Some((*done, *total))),
                Event::Finished(summary) => {
                    let front = summary
                        .front
                        .iter()
                        .map(|member| FrontEntry::new(member, true))
                        .collect();
                    self.put(|news| {
                        news.front = Some(front);
                        news.finished = Some(Box::new(summary.clone()));
                    });
                }
                Event::Failed(message) => self.put(|news| news.failed = Some(message.clone())),
            }
        }
    }
}
