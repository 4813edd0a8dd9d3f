//! What became of a wish, as other programs read it.

use kinefront_model::evaluation::{Evaluation, Quantity};
use serde::Serialize;

use super::{Wish, WishOutcome};
use crate::Study;

/// What became of a wish, as other programs read it.
#[derive(Debug, Clone, Serialize)]
pub struct WishJson {
    /// The nearest design that satisfies the wish, as text.
    pub design: String,
    /// Its home orientation \[deg\].
    pub home_phi_deg: Option<f64>,
    /// `had`, `granted` or `not granted`.
    pub outcome: &'static str,
    /// Conditions that are not met, each with the value that can be had instead.
    pub unmet: Vec<UnmetJson>,
    /// Quantities of the given design, by their keys.
    pub before: serde_json::Map<String, serde_json::Value>,
    /// Quantities of the design that was found.
    pub after: serde_json::Map<String, serde_json::Value>,
    /// What is proved about the workspace: `proved`, `open`, or absent.
    pub proof: Option<&'static str>,
    /// What was compared at the end alone.
    pub warnings: Vec<String>,
    /// Dimensions of lists and catalogues that have another entry, in words.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub changed_entries: Vec<String>,
}

/// A condition that is not met.
#[derive(Debug, Clone, Serialize)]
pub struct UnmetJson {
    /// The condition, as it was stated.
    pub condition: String,
    /// The value that can be had instead.
    pub value: f64,
}

impl Wish {
    /// Returns the quantities that tell what became of the wish: those that describe a design of the study, and those that it names.
    pub fn shown(&self, study: &Study) -> Vec<Quantity> {
        let mut shown = study.shown_quantities();
        let named = self.conditions.iter().map(|condition| condition.0.quantity);
        for quantity in named.chain(self.keep.iter().copied()) {
            if !shown.contains(&quantity) {
                shown.push(quantity);
            }
        }
        shown
    }
}

impl WishOutcome {
    /// Returns what became of the wish, in a word: `had`, `granted` or `not granted`.
    pub fn word(&self) -> &'static str {
        match (self.was_true, self.unmet.is_empty()) {
            (true, _) => "had",
            (false, true) => "granted",
            (false, false) => "not granted",
        }
    }

    /// Returns the outcome with the values of some quantities.
    pub fn to_json(&self, shown: &[Quantity]) -> WishJson {
        let found = &self.found.evaluation;
        let values = |evaluation: &Evaluation| {
            let value = |quantity: &Quantity| {
                let value = evaluation.quantities.get(*quantity)?;
                Some((quantity.entry().key.to_owned(), value.into()))
            };
            shown.iter().filter_map(value).collect()
        };
        let unmet = self.unmet.iter().map(|(condition, value)| UnmetJson {
            condition: condition.to_string(),
            value: *value,
        });
        let left_out = self
            .left_out
            .iter()
            .map(|quantity| format!("the limit of {} was checked only at the end", quantity.entry().key));
        WishJson {
            design: found.design.to_string(),
            home_phi_deg: found.home_phi_deg,
            outcome: self.word(),
            unmet: unmet.collect(),
            before: values(&self.before),
            after: values(found),
            proof: self.found.certified.as_ref().map(|certified| certified.state()),
            warnings: left_out.collect(),
            changed_entries: self.changed_entries.clone(),
        }
    }
}
