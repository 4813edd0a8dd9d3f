//! A place for the latest request to a thread.

use std::sync::{Condvar, Mutex, PoisonError};
use std::time::Duration;

use super::lock;

/// Holds at most one item; a later item replaces an earlier one.
pub(super) struct Mailbox<T> {
    state: Mutex<(Option<T>, bool)>,
    changed: Condvar,
}

impl<T> Mailbox<T> {
    pub fn new() -> Self {
        Self {
            state: Mutex::new((None, false)),
            changed: Condvar::new(),
        }
    }

    pub fn put(&self, thing: T) {
        lock(&self.state).0 = Some(thing);
        self.changed.notify_all();
    }

    pub fn close(&self) {
        lock(&self.state).1 = true;
        self.changed.notify_all();
    }

    /// Whether it is open and holds no item.
    pub fn is_idle(&self) -> bool {
        let state = lock(&self.state);
        state.0.is_none() && !state.1
    }

    /// Waits for an item for at most `time`.
    pub fn wait(&self, time: Duration) -> Option<T> {
        let state = lock(&self.state);
        let empty = |state: &mut (Option<T>, bool)| state.0.is_none() && !state.1;
        let (mut state, _) = self
            .changed
            .wait_timeout_while(state, time, empty)
            .unwrap_or_else(PoisonError::into_inner);
        state.0.take()
    }

    /// Waits for an item; returns `None` once the mailbox is closed.
    pub fn take(&self) -> Option<T> {
        let mut state = lock(&self.state);
        loop {
            if state.1 {
                return None;
            }
            if let Some(thing) = state.0.take() {
                return Some(thing);
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }
}
