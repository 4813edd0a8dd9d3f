//! Selection of designs by hand, by key and in the scene; modified designs, pins and stars.

use super::super::document::{Chosen, Named, Origin};
use super::{MOST_PINS, Session};
use crate::recording::Picked;
use kinefront_model::mechanism::{Design, VARIABLES};

impl Session {
    /// Selects a design of the run.
    pub fn choose(&mut self, id: usize) {
        if let Some(row) = self.row(id) {
            self.choose_design(Chosen {
                design: row.design,
                origin: Origin::Evaluated(id),
            });
        }
    }

    /// Selects a design.
    pub fn choose_design(&mut self, chosen: Chosen) {
        self.following = false;
        self.staging.pose = None;
        self.staging.heatmap_phi = None;
        self.history.edit(|document| document.chosen = Some(chosen));
    }

    /// Selects the knee of the front.
    pub fn choose_knee(&mut self) {
        if let Some(place) = self.knee() {
            self.choose(self.front[place].id);
        }
    }

    /// Moves the selection by `steps` along the designs of the front that pass the filter.
    pub fn walk(&mut self, steps: isize) {
        let sieve = self.document().filter.sieve(&self.store);
        let lit: Vec<usize> = self
            .front
            .iter()
            .map(|entry| entry.id)
            .filter(|&id| sieve.passes(id))
            .collect();
        let here = match self.document().chosen {
            Some(Chosen {
                origin: Origin::Evaluated(id),
                ..
            }) => lit.iter().position(|&other| other == id),
            _ => None,
        };
        let next = match here {
            Some(here) => here.saturating_add_signed(steps).min(lit.len().saturating_sub(1)),
            None if steps < 0 => lit.len().saturating_sub(1),
            None => 0,
        };
        if let Some(&id) = lit.get(next) {
            self.choose(id);
        }
    }

    /// Selects the design that was clicked in the scene.
    pub fn choose_picked(&mut self, picked: Picked) {
        match picked {
            Picked::Front(place) => {
                if let Some(id) = self.front_points.get(place).map(|point| point.id) {
                    self.choose(id);
                }
            }
            Picked::Pin(place) => {
                if let Some(pin) = self.document().pins.get(place).cloned() {
                    self.choose_named(&pin);
                }
            }
        }
    }

    /// Selects a named design, with its origin if that is known.
    pub fn choose_named(&mut self, named: &Named) {
        let id = named.name.strip_prefix('#').and_then(|id| id.parse().ok());
        let origin = match id {
            Some(id) => Origin::Evaluated(id),
            None => match self.document().kept.iter().position(|kept| kept.design == named.design) {
                Some(index) => Origin::Kept(index),
                None => Origin::WhatIf { from: None },
            },
        };
        self.choose_design(Chosen {
            design: named.design,
            origin,
        });
    }

    /// Changes one variable of the selected design, as part of a gesture.
    pub fn what_if(&mut self, variable: usize, value: f64) {
        let Some(chosen) = self.document().chosen.clone() else {
            return;
        };
        let mut values = chosen.design.values();
        values[variable] = value;
        match Design::new(chosen.design.architecture, chosen.design.working_mode, values) {
            Ok(design) => {
                let from = match chosen.origin {
                    Origin::Evaluated(id) => Some(id),
                    Origin::WhatIf { from } => from,
                    Origin::Kept(_) | Origin::Reference(_) => None,
                };
                self.following = false;
                self.staging.pose = None;
                let gesture = VARIABLES[variable].key();
                self.history.drag(gesture, |document| {
                    document.chosen = Some(Chosen {
                        design,
                        origin: Origin::WhatIf { from },
                    });
                });
            }
            Err(error) => self.tell_error(error.to_string()),
        }
    }

    /// Reads a design from text and selects it.
    pub fn paste(&mut self, text: &str) {
        match Design::parse(text.trim(), self.as_run.working_mode) {
            Ok(design) => self.choose_design(Chosen {
                design,
                origin: Origin::WhatIf { from: None },
            }),
            Err(error) => self.tell_error(format!("the pasted text is not a design: {error}")),
        }
    }

    /// Keeps the selected design under a new name.
    pub fn keep(&mut self) {
        let Some(chosen) = self.document().chosen.clone() else {
            return;
        };
        let name = format!("kept {}", self.document().kept.len() + 1);
        self.history.edit(|document| {
            document.kept.push(Named {
                name,
                design: chosen.design,
            });
            document.chosen = Some(Chosen {
                origin: Origin::Kept(document.kept.len() - 1),
                ..chosen
            });
        });
    }

    /// Adds or removes the star of the selected design, if it is a design of the run.
    pub fn toggle_star(&mut self) {
        if let Some(Chosen {
            origin: Origin::Evaluated(id),
            ..
        }) = self.document().chosen
        {
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
        let Some((design, name)) = self
            .document()
            .chosen
            .as_ref()
            .map(|chosen| chosen.design)
            .zip(self.chosen_name())
        else {
            return;
        };
        if let Some(place) = self.document().pins.iter().position(|pin| pin.design == design) {
            self.history.edit(|document| {
                document.pins.remove(place);
            });
        } else if self.document().pins.len() < MOST_PINS {
            self.history.edit(|document| document.pins.push(Named { name, design }));
        } else {
            self.tell_error(format!("{MOST_PINS} designs are already pinned; unpin one first"));
        }
    }
}
