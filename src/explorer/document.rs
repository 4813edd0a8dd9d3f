//! What a person has chosen, pinned, noted and filtered: everything that undo restores.

use std::collections::{BTreeMap, BTreeSet};

use super::Filter;
use kinefront_model::mechanism::Design;

/// Where a design comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum Origin {
    /// Evaluated by the run, with this id.
    Evaluated(usize),
    /// Changed by hand from another, or pasted.
    WhatIf {
        /// What it was changed from.
        from: Option<usize>,
    },
    /// Kept earlier; its place in [`Document::kept`].
    Kept(usize),
    /// Comes with the study; its place among the references.
    Reference(usize),
}

/// The design in the light.
#[derive(Debug, Clone, PartialEq)]
pub struct Chosen {
    /// The design.
    pub design: Design,
    /// Where it comes from.
    pub origin: Origin,
}

/// A design by a name.
#[derive(Debug, Clone, PartialEq)]
pub struct Named {
    /// What it is called.
    pub name: String,
    /// The design.
    pub design: Design,
}

/// What a person has chosen, pinned, noted and filtered.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Document {
    /// The design in the light.
    pub chosen: Option<Chosen>,
    /// Designs to compare.
    pub pins: Vec<Named>,
    /// What-if designs that were kept.
    pub kept: Vec<Named>,
    /// Starred designs of the run, by id.
    pub stars: BTreeSet<usize>,
    /// Notes on designs of the run, by id.
    pub notes: BTreeMap<usize, String>,
    /// The filter.
    pub filter: Filter,
}

/// A document with its past and what was undone of it.
#[derive(Debug, Default)]
pub struct History {
    present: Document,
    past: Vec<Document>,
    undone: Vec<Document>,
    /// What the gesture under way changes: its steps are one.
    gesture: Option<&'static str>,
}

/// Steps that can be undone.
const DEPTH: usize = 200;

impl History {
    /// The document.
    pub fn present(&self) -> &Document {
        &self.present
    }

    /// Changes the document as one step.
    pub fn edit(&mut self, change: impl FnOnce(&mut Document)) {
        self.gesture = None;
        self.change(change);
    }

    /// Changes the document as part of a gesture, such as dragging a slider: all changes of one `name` up to
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

    /// Changes the document without a step: what a run does by itself is not for a person to undo.
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

    /// Whether there is something to undo.
    pub fn can_undo(&self) -> bool {
        !self.past.is_empty()
    }

    /// Whether there is something to redo.
    pub fn can_redo(&self) -> bool {
        !self.undone.is_empty()
    }

    /// Goes a step back.
    pub fn undo(&mut self) {
        self.gesture = None;
        if let Some(before) = self.past.pop() {
            self.undone.push(std::mem::replace(&mut self.present, before));
        }
    }

    /// Goes a step forward again.
    pub fn redo(&mut self) {
        self.gesture = None;
        if let Some(after) = self.undone.pop() {
            self.past.push(std::mem::replace(&mut self.present, after));
        }
    }

    /// Begins anew with `document`; nothing before it can be undone.
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
        // What changes nothing is no step.
        history.edit(|_| {});
        assert!(!history.can_undo() && history.can_redo());
    }
}
