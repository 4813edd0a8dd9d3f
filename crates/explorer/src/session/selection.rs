//! Selection of designs by hand, by key and in the scene; modified designs, pins and stars.

use std::sync::Arc;

use super::{MOST_PINS, Session};
use crate::data::{DesignOrigin, Document, Named, Selected};
use kinefront_model::mechanism::{Architecture, Design, DesignError, DesignVariable};
use kinefront_model::spatial::Pose;
use kinefront_optimize::{Objectives, knee};
use kinefront_recording::Picked;

/// Numbers of marked designs.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct MarkedCounts {
    /// All of them.
    pub all: usize,
    /// Those that are feasible.
    pub feasible: usize,
    /// Those on the front.
    pub on_front: usize,
    /// Those of each architecture.
    pub of: Vec<(Architecture, usize)>,
}

impl Session {
    /// Changes the document by a step of its own that can be undone.
    pub fn edit(&mut self, change: impl FnOnce(&mut Document)) {
        self.history.edit(change);
    }

    /// Changes the document by a gesture; all changes of one gesture are one step.
    pub fn drag(&mut self, name: &'static str, change: impl FnOnce(&mut Document)) {
        self.history.drag(name, change);
    }

    /// Selects a design of the run.
    pub fn select(&mut self, id: usize) {
        if let Some(row) = self.row(id) {
            self.select_design(Selected {
                design: row.design,
                origin: DesignOrigin::Evaluated(id),
            });
        }
    }

    /// Selects a design.
    pub fn select_design(&mut self, selected: Selected) {
        self.following = false;
        self.view.pose = None;
        self.view.heatmap_phi = None;
        self.history.edit(|document| document.selected = Some(selected));
    }

    /// Returns the places on the front of the designs that pass the filter, in order.
    pub fn passing(&self) -> Vec<usize> {
        let prepared = self.document().filter.prepare(&self.store);
        let places = self.front.iter().enumerate();
        places
            .filter(|(_, entry)| prepared.passes_entry(entry))
            .map(|(place, _)| place)
            .collect()
    }

    /// Selects the knee of the designs of the front that pass the filter.
    pub fn select_knee(&mut self) {
        let passing = self.passing();
        let objectives: Vec<Objectives> = passing.iter().map(|&place| self.front[place].objectives()).collect();
        if let Some(place) = knee(&objectives) {
            self.select(self.front[passing[place]].id);
        }
    }

    /// Moves the selection by `steps` along the designs of the front that pass the filter.
    pub fn walk(&mut self, steps: isize) {
        let passing: Vec<usize> = self.passing().into_iter().map(|place| self.front[place].id).collect();
        let id = self.document().selected_id();
        let here = id.and_then(|id| passing.iter().position(|&other| other == id));
        let next = match here {
            Some(here) => here.saturating_add_signed(steps).min(passing.len().saturating_sub(1)),
            None if steps < 0 => passing.len().saturating_sub(1),
            None => 0,
        };
        if let Some(&id) = passing.get(next) {
            self.select(id);
        }
    }

    /// Selects the design that was clicked in the scene.
    pub fn select_picked(&mut self, picked: Picked) {
        match picked {
            Picked::Front(place) => {
                if let Some(id) = self.front_points.get(place).map(|point| point.id) {
                    self.select(id);
                }
            }
            Picked::Position(position) => {
                let phi = self.view.heatmap_phi.or(self.home().map(|home| home.phi));
                if let Some(phi) = phi {
                    let stopped = self.move_platform(Pose { position, phi });
                    if let Some(stopped) = stopped {
                        self.notify(stopped);
                    }
                }
            }
            Picked::Pin(place) => {
                if let Some(pin) = self.document().pins.get(place).cloned() {
                    self.select_named(&pin);
                }
            }
        }
    }

    /// Selects a named design, with its origin if that is known.
    pub fn select_named(&mut self, named: &Named) {
        let id = named.name.strip_prefix('#').and_then(|id| id.parse().ok());
        let origin = match id {
            // After a new run, the number may belong to another design.
            Some(id) if self.store().design(id) == Some(named.design) => DesignOrigin::Evaluated(id),
            _ => self.origin_of_own(&named.design),
        };
        self.select_design(Selected {
            design: named.design,
            origin,
        });
    }

    /// Returns the origin of a design that is none of the run.
    fn origin_of_own(&self, design: &Design) -> DesignOrigin {
        let document = self.document();
        let kept = document.kept.iter().position(|kept| kept.design == *design);
        let mut wished = document.wished.iter();
        let wished = wished.position(|wished| wished.evaluation.design == *design);
        match (kept, wished) {
            (Some(index), _) => DesignOrigin::Kept(index),
            (None, Some(index)) => DesignOrigin::Wished(index),
            (None, None) => DesignOrigin::Modified { from: None },
        }
    }

    /// Selects a design that answers a wish, by its index in the document.
    pub fn select_wished(&mut self, index: usize) {
        if let Some(wished) = self.document().wished.get(index) {
            let design = wished.evaluation.design;
            let origin = DesignOrigin::Wished(index);
            self.select_design(Selected { design, origin });
        }
    }

    /// Changes one variable of the selected design, as part of a gesture.
    pub fn modify(&mut self, variable: DesignVariable, value: f64) {
        self.modify_with(variable.key(), |design| design.with(variable, value));
    }

    /// Changes the selected design, as part of a gesture of the given name.
    pub(super) fn modify_with(
        &mut self,
        gesture: &'static str,
        change: impl FnOnce(&Design) -> Result<Design, DesignError>,
    ) {
        let Some(selected) = self.document().selected.clone() else {
            return;
        };
        match change(&selected.design) {
            Ok(design) => {
                let from = match selected.origin {
                    DesignOrigin::Evaluated(id) => Some(id),
                    DesignOrigin::Modified { from } => from,
                    DesignOrigin::Kept(_) | DesignOrigin::Wished(_) | DesignOrigin::Reference(_) => None,
                };
                self.following = false;
                self.view.pose = None;
                self.history.drag(gesture, |document| {
                    document.selected = Some(Selected {
                        design,
                        origin: DesignOrigin::Modified { from },
                    });
                });
            }
            Err(error) => self.notify_error(error),
        }
    }

    /// Reads a design from text and selects it.
    pub fn paste(&mut self, text: &str) {
        match Design::parse(text.trim(), self.study().working_mode) {
            Ok(design) => self.select_design(Selected {
                design,
                origin: DesignOrigin::Modified { from: None },
            }),
            Err(error) => self.notify_error(format!("the pasted text is not a design: {error}")),
        }
    }

    /// Keeps the selected design under a new name.
    pub fn keep(&mut self) {
        let Some(selected) = self.document().selected.clone() else {
            return;
        };
        let name = format!("kept {}", self.document().kept.len() + 1);
        self.history.edit(|document| {
            document.kept.push(Named {
                name,
                design: selected.design,
            });
            document.selected = Some(Selected {
                origin: DesignOrigin::Kept(document.kept.len() - 1),
                ..selected
            });
        });
    }

    /// Returns whether there is a step to undo, of the study or of what was selected, marked and noted.
    pub fn can_undo(&self) -> bool {
        self.history.can_undo() || self.editor.history().can_undo()
    }

    /// Returns whether there is a step to redo.
    pub fn can_redo(&self) -> bool {
        self.history.can_redo() || self.editor.history().can_redo()
    }

    /// Undoes the last step, of the study or of what was selected, marked and noted.
    pub fn undo(&mut self) {
        if self.editor.history().last_step() > self.history.last_step() {
            self.editor.undo();
            self.notify("a change of the study was undone".to_owned());
        } else {
            self.history.undo();
        }
    }

    /// Redoes the step that was undone last.
    pub fn redo(&mut self) {
        if self.editor.history().last_undone() > self.history.last_undone() {
            self.editor.redo();
            self.notify("a change of the study was redone".to_owned());
        } else {
            self.history.redo();
        }
    }

    /// Ends the gestures to which changes by hand belong.
    pub fn end_gestures(&mut self) {
        self.history.end_gesture();
        self.editor.end_gesture();
    }

    /// Marks designs of the run; `ids` are in order.
    pub fn mark(&mut self, ids: Arc<Vec<usize>>) {
        self.history.edit(|document| document.marked = ids);
    }

    /// Counts the marked designs: all of them, those that are feasible, those on the front, and those of each architecture of the
    /// study.
    pub fn count_marked(&self) -> MarkedCounts {
        let mut counts = MarkedCounts {
            of: self.study().architectures.iter().map(|&found| (found, 0)).collect(),
            ..MarkedCounts::default()
        };
        for &id in self.document().marked.iter() {
            let place = self.place_on_front(id);
            let (architecture, feasible) = match place {
                Some(place) => {
                    let row = &self.front[place].row;
                    (row.design.architecture(), row.is_feasible())
                }
                None if id < self.store.len() => (self.store.architecture(id), self.store.is_feasible(id)),
                None => continue,
            };
            counts.all += 1;
            counts.feasible += usize::from(feasible);
            counts.on_front += usize::from(place.is_some());
            if let Some((_, count)) = counts.of.iter_mut().find(|(found, _)| *found == architecture) {
                *count += 1;
            }
        }
        counts
    }

    /// Adds or removes the star of the selected design, if it is a design of the run.
    pub fn toggle_star(&mut self) {
        if let Some(id) = self.document().selected_id() {
            self.toggle_star_of(id);
        }
    }

    /// Adds or removes the star of a design of the run.
    pub fn toggle_star_of(&mut self, id: usize) {
        self.history.edit(|document| {
            if !document.stars.remove(&id) {
                document.stars.insert(id);
            }
        });
    }

    /// Pins or unpins the selected design.
    pub fn toggle_pin(&mut self) {
        let Some((design, name)) = self.document().selected_design().zip(self.selected_name()) else {
            return;
        };
        if let Some(place) = self.document().pins.iter().position(|pin| pin.design == design) {
            self.history.edit(|document| {
                document.pins.remove(place);
            });
        } else if self.document().pins.len() < MOST_PINS {
            self.history.edit(|document| document.pins.push(Named { name, design }));
        } else {
            self.notify_error(format!("{MOST_PINS} designs are already pinned; unpin one first"));
        }
    }
}
