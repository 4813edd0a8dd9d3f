//! The user's selection, pins, kept designs, stars, notes and filter: everything that undo restores.

use std::collections::{BTreeMap, BTreeSet};

use super::Filter;
use kinefront_model::mechanism::Design;

/// Origin of a design.
#[derive(Debug, Clone, PartialEq)]
pub enum Origin {
    /// Evaluated by the run under this id.
    Evaluated(usize),
    /// Modified by hand from another design, or pasted as text.
    Modified {
        /// Id of the design of the run that it was modified from, if there is one.
        from: Option<usize>,
    },
    /// Kept earlier; the value is its index in [`Document::kept`].
    Kept(usize),
    /// A reference design of the study; the value is its index among the references.
    Reference(usize),
}

/// The selected design and its origin.
#[derive(Debug, Clone, PartialEq)]
pub struct Selected {
    /// The design.
    pub design: Design,
    /// Its origin.
    pub origin: Origin,
}

/// A design with a name.
#[derive(Debug, Clone, PartialEq)]
pub struct Named {
    /// Name of the design.
    pub name: String,
    /// The design.
    pub design: Design,
}

/// The user's selection, pins, kept designs, stars, notes and filter.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Document {
    /// The selected design.
    pub selected: Option<Selected>,
    /// Pinned designs, which are compared.
    pub pins: Vec<Named>,
    /// Modified designs that the user has kept.
    pub kept: Vec<Named>,
    /// Starred designs of the run, by id.
    pub stars: BTreeSet<usize>,
    /// Notes on designs of the run, by id.
    pub notes: BTreeMap<usize, String>,
    /// The filter.
    pub filter: Filter,
}

/// A document with its earlier states, for undo, and its undone states, for redo.
#[derive(Debug, Default)]
pub struct History {
    present: Document,
    past: Vec<Document>,
    undone: Vec<Document>,
    /// Name of the gesture in progress; all its changes are one step.
    gesture: Option<&'static str>,
}

/// Largest number of steps that can be undone.
const DEPTH: usize = 200;

impl History {
    /// Returns the current document.
    pub fn present(&self) -> &Document {
        &self.present
    }

    /// Changes the document as one step.
    pub fn edit(&mut self, change: impl FnOnce(&mut Document)) {
        self.gesture = None;
        self.change(change);
    }

    /// Changes the document as part of a gesture, such as dragging a slider: all changes with the same `name` up to
    /// [`History::end_gesture`] are undone together.
    pub fn drag(&mut self, name: &'static str, change: impl FnOnce(&mut Document)) {
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

    /// Changes the document without recording a step: the user cannot undo what a run does by itself.
    pub fn follow(&mut self, change: impl FnOnce(&mut Document)) {
        change(&mut self.present);
    }

    fn change(&mut self, change: impl FnOnce(&mut Document)) {
        let before = self.present.clone();
        change(&mut self.present);
        if before != self.present {
            self.past.push(before);
            if self.past.len() > DEPTH {
                self.past.remove(0);
            }
            self.undone.clear();
        }
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
        if let Some(before) = self.past.pop() {
            self.undone.push(std::mem::replace(&mut self.present, before));
        }
    }

    /// Redoes the step undone last.
    pub fn redo(&mut self) {
        self.gesture = None;
        if let Some(after) = self.undone.pop() {
            self.past.push(std::mem::replace(&mut self.present, after));
        }
    }

    /// Starts a new history with `document`; no earlier step can be undone.
    pub fn restart(&mut self, document: Document) {
        *self = Self {
            present: document,
            ..Self::default()
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gesture_is_one_step_and_undo_restores() {
        let mut history = History::default();
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
