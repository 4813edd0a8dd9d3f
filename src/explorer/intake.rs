//! From the run's thread to the window: news are put together between two frames, so that neither waits for the other.

use std::sync::mpsc::Receiver;
use std::sync::{Arc, Mutex, PoisonError};

use super::{FrontEntry, Row, Store};
use crate::study::{Event, GenerationSummary, RunSummary};

/// What a run told since it was last asked.
#[derive(Debug, Default)]
pub struct News {
    /// Designs.
    pub rows: Store,
    /// The front as it stands, if it changed.
    pub front: Option<Vec<FrontEntry>>,
    /// Generations done.
    pub history: Vec<GenerationSummary>,
    /// Worker threads, told once.
    pub threads: Option<usize>,
    /// Designs verified, and how many there are.
    pub verifying: Option<(usize, usize)>,
    /// The end.
    pub finished: Option<Box<RunSummary>>,
    /// Why the run broke off.
    pub failed: Option<String>,
    /// What went wrong beside the run.
    pub troubles: Vec<String>,
}

/// Where news are put and fetched.
pub struct Intake {
    news: Mutex<News>,
    wake: Box<dyn Fn() + Send + Sync>,
}

impl Intake {
    /// An intake that calls `wake` when there are news.
    pub fn new(wake: impl Fn() + Send + Sync + 'static) -> Self {
        Self {
            news: Mutex::default(),
            wake: Box::new(wake),
        }
    }

    /// Everything since the last call.
    pub fn take(&self) -> News {
        std::mem::take(&mut *self.news.lock().unwrap_or_else(PoisonError::into_inner))
    }

    fn put(&self, put: impl FnOnce(&mut News)) {
        put(&mut self.news.lock().unwrap_or_else(PoisonError::into_inner));
        (self.wake)();
    }

    /// Tells of something that went wrong beside the run.
    pub fn trouble(&self, words: String) {
        self.put(|news| news.troubles.push(words));
    }

    /// Takes in what a run tells until it ends.
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
