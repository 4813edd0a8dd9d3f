//! Control of a run in progress.

use super::EndReason;
// The test of all interleavings has these of its own.
use super::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Pauses, resumes, steps and stops a run from any thread.
#[derive(Debug, Default)]
pub struct RunControl {
    state: Mutex<ControlState>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct ControlState {
    paused: bool,
    /// Number of generations still to be run while paused.
    steps: usize,
    stop: bool,
    abandon: bool,
    interrupt: bool,
    /// Whether the run waits in [`RunControl::go_on`].
    waiting: bool,
}

impl ControlState {
    fn is_held(&self) -> bool {
        self.paused && self.steps == 0 && !self.stop
    }
}

impl RunControl {
    fn state(&self) -> MutexGuard<'_, ControlState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn change(&self, change: impl FnOnce(&mut ControlState)) {
        change(&mut self.state());
        self.changed.notify_all();
    }

    /// Pauses the run after the current generation.
    pub fn pause(&self) {
        self.change(|state| {
            state.paused = true;
            state.steps = 0;
        });
    }

    /// Resumes a paused run.
    pub fn resume(&self) {
        self.change(|state| {
            state.paused = false;
            state.steps = 0;
        });
    }

    /// Runs one generation, then pauses again.
    pub fn step(&self) {
        self.change(|state| {
            state.paused = true;
            state.steps += 1;
        });
    }

    /// Ends the run after the current generation; the front found so far is verified and kept.
    pub fn stop(&self) {
        self.change(|state| state.stop = true);
    }

    /// Ends the run at once; nothing more is verified or reported.
    pub fn abandon(&self) {
        self.change(|state| {
            state.stop = true;
            state.abandon = true;
        });
    }

    /// Ends the run at once, as at a signal: designs in evaluation are dropped, and no front is verified; the run can be
    /// resumed.
    pub fn interrupt(&self) {
        self.change(|state| {
            state.stop = true;
            state.abandon = true;
            state.interrupt = true;
        });
    }

    /// Whether the run was interrupted.
    pub fn is_interrupted(&self) -> bool {
        self.state().interrupt
    }

    /// Whether the run is paused and waits: the generation that was in progress is done.
    pub fn is_waiting(&self) -> bool {
        let state = self.state();
        state.waiting && state.is_held()
    }

    pub(super) fn is_abandoned(&self) -> bool {
        self.state().abandon
    }

    /// The reason why a run ends that is not to continue.
    pub(super) fn end_reason(&self) -> EndReason {
        if self.is_interrupted() {
            EndReason::Interrupted
        } else {
            EndReason::Stopped
        }
    }

    /// Waits while the run is paused; returns whether the run is to continue.
    pub(super) fn go_on(&self) -> bool {
        let mut state = self.state();
        while state.is_held() {
            state.waiting = true;
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        state.waiting = false;
        state.steps = state.steps.saturating_sub(1);
        !state.stop
    }
}
