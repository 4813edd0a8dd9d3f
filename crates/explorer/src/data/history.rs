//! A state with its earlier states, for undo, and its undone states, for redo.

use std::time::Instant;

/// A state with its earlier states, for undo, and its undone states, for redo.
#[derive(Debug, Clone, Default)]
pub struct History<T> {
    present: T,
    /// Earlier states, and when each of them was left.
    past: Vec<(Instant, T)>,
    /// Undone states, and when each of them was undone.
    undone: Vec<(Instant, T)>,
    /// Name of the gesture in progress; all its changes are one step.
    gesture: Option<&'static str>,
}

/// Largest number of steps that can be undone.
const DEPTH: usize = 200;

impl<T: Clone + PartialEq> History<T> {
    /// Returns the current state.
    pub fn present(&self) -> &T {
        &self.present
    }

    /// Changes the state as one step.
    pub fn edit(&mut self, change: impl FnOnce(&mut T)) {
        self.gesture = None;
        self.change(change);
    }

    /// Changes the state as part of a gesture, such as dragging a slider: all changes with the same `name` up to
    /// [`History::end_gesture`] are undone together.
    pub fn drag(&mut self, name: &'static str, change: impl FnOnce(&mut T)) {
        if self.gesture == Some(name) {
            change(&mut self.present);
            return;
        }
        self.change(change);
        self.gesture = Some(name);
    }

    /// Ends a gesture.
    pub fn end_gesture(&mut self) {
        self.gesture = None;
    }

    /// Changes the state without recording a step: the user cannot undo what a run does by itself.
    pub fn follow(&mut self, change: impl FnOnce(&mut T)) {
        change(&mut self.present);
    }

    fn change(&mut self, change: impl FnOnce(&mut T)) {
        let before = self.present.clone();
        change(&mut self.present);
        if before != self.present {
            self.past.push((Instant::now(), before));
            if self.past.len() > DEPTH {
                self.past.remove(0);
            }
            self.undone.clear();
        }
    }

    /// Returns when the last step was taken that can be undone.
    pub fn last_step(&self) -> Option<Instant> {
        self.past.last().map(|(at, _)| *at)
    }

    /// Returns when the last step was undone that can be redone.
    pub fn last_undone(&self) -> Option<Instant> {
        self.undone.last().map(|(at, _)| *at)
    }

    /// Returns whether there is a step to undo.
    pub fn can_undo(&self) -> bool {
        !self.past.is_empty()
    }

    /// Returns whether there is a step to redo.
    pub fn can_redo(&self) -> bool {
        !self.undone.is_empty()
    }

    /// Undoes the last step.
    pub fn undo(&mut self) {
        self.gesture = None;
        if let Some((_, before)) = self.past.pop() {
            let after = std::mem::replace(&mut self.present, before);
            self.undone.push((Instant::now(), after));
        }
    }

    /// Redoes the step undone last.
    pub fn redo(&mut self) {
        self.gesture = None;
        if let Some((_, after)) = self.undone.pop() {
            let before = std::mem::replace(&mut self.present, after);
            self.past.push((Instant::now(), before));
        }
    }
}

impl<T: Clone + PartialEq + Default> History<T> {
    /// Starts a new history with `state`; no earlier step can be undone.
    pub fn restart(&mut self, state: T) {
        *self = Self {
            present: state,
            ..Self::default()
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Document;

    #[test]
    fn a_gesture_is_one_step_and_undo_restores() {
        let mut history = History::<Document>::default();
        history.edit(|document| {
            document.stars.insert(3);
        });
        for k in 0..5 {
            history.drag("note", |document| {
                document.notes.insert(3, format!("{k}"));
            });
        }
        history.end_gesture();
        history.drag("note", |document| {
            document.notes.insert(3, "end".to_owned());
        });
        history.undo();
        assert_eq!(history.present().notes[&3], "4");
        history.undo();
        assert!(history.present().notes.is_empty() && history.present().stars.contains(&3));
        history.redo();
        assert_eq!(history.present().notes[&3], "4");
        history.undo();
        history.undo();
        assert_eq!(*history.present(), Document::default());
        assert!(!history.can_undo());
        // An edit that changes nothing is not recorded as a step.
        history.edit(|_| {});
        assert!(!history.can_undo() && history.can_redo());
    }
}
