//! Steering a run that is under way.

use std::sync::{Condvar, Mutex, PoisonError};

/// Pauses, steps and stops a run from any thread.
#[derive(Debug, Default)]
pub struct RunControl {
    state: Mutex<ControlState>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct ControlState {
    paused: bool,
    /// Generations still to do while paused.
    steps: usize,
    stop: bool,
    abandon: bool,
}

impl RunControl {
    fn change(&self, change: impl FnOnce(&mut ControlState)) {
        change(&mut self.state.lock().unwrap_or_else(PoisonError::into_inner));
        self.changed.notify_all();
    }

    /// Holds the run after the generation under way.
    pub fn pause(&self) {
        self.change(|state| state.paused = true);
    }

    /// Goes on.
    pub fn resume(&self) {
        self.change(|state| {
            state.paused = false;
            state.steps = 0;
        });
    }

    /// Does one generation and pauses again.
    pub fn step(&self) {
        self.change(|state| {
            state.paused = true;
            state.steps += 1;
        });
    }

    /// Ends the run after the generation under way; what was found is verified and kept.
    pub fn stop(&self) {
        self.change(|state| state.stop = true);
    }

    /// Ends the run after what is under way; nothing more is verified or told.
    pub fn abandon(&self) {
        self.change(|state| {
            state.stop = true;
            state.abandon = true;
        });
    }

    pub(super) fn is_abandoned(&self) -> bool {
        self.state.lock().unwrap_or_else(PoisonError::into_inner).abandon
    }

    /// Waits while paused; tells whether to go on.
    pub(super) fn go_on(&self) -> bool {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        while state.paused && state.steps == 0 && !state.stop {
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        state.steps = state.steps.saturating_sub(1);
        !state.stop
    }
}
