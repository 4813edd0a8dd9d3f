//! What a study asks: its objectives, its limits, and the quantities that it reports (docs/interfaces.md).

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use kinefront_model::evaluation::{Better, Bound, Objective, Quantity};

/// An objective of a study: the key of the quantity that is minimised or maximised.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ObjectiveChoice {
    /// The quantity is to be small.
    Minimize(String),
    /// The quantity is to be large.
    Maximize(String),
}

impl ObjectiveChoice {
    /// The objectives of a study that states none: little mass, and a large workspace.
    pub fn defaults() -> Vec<Self> {
        vec![
            Self::Minimize(Quantity::Mass.entry().key.to_owned()),
            Self::Maximize(Quantity::WorkspaceRadius.entry().key.to_owned()),
        ]
    }

    /// Key of the quantity.
    pub fn key(&self) -> &str {
        match self {
            Self::Minimize(key) | Self::Maximize(key) => key,
        }
    }

    /// Returns the objective; `None` if no quantity has the key.
    pub fn objective(&self) -> Option<Objective> {
        Some(Objective {
            quantity: Quantity::find(self.key())?,
            goal: match self {
                Self::Minimize(_) => Better::Lower,
                Self::Maximize(_) => Better::Higher,
            },
        })
    }
}

/// Limits of a quantity.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LimitChoice {
    /// Smallest value allowed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_least: Option<f64>,
    /// Largest value allowed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_most: Option<f64>,
}

impl LimitChoice {
    /// Iterates over the bounds that are stated.
    pub fn bounds(&self) -> impl Iterator<Item = Bound> + use<> {
        let bounds = [self.at_least.map(Bound::AtLeast), self.at_most.map(Bound::AtMost)];
        bounds.into_iter().flatten()
    }
}

/// Limits by the key of their quantity.
pub type Limits = BTreeMap<String, LimitChoice>;

/// Explains that a key names no quantity, and names the nearest one.
pub(crate) fn unknown_quantity(key: &str) -> String {
    let keys = || Quantity::all().map(|quantity| quantity.entry().key);
    let stem = |key: &str| {
        let units = [
            "_kg",
            "_g",
            "_t",
            "_mm",
            "_cm",
            "_m",
            "_n_per_m",
            "_n_per_mm",
            "_nm_per_rad",
            "_nm_per_deg",
        ];
        let unit = units
            .iter()
            .filter(|unit| key.ends_with(**unit))
            .max_by_key(|unit| unit.len());
        key[..key.len() - unit.map_or(0, |unit| unit.len())].to_owned()
    };
    if let Some(found) = Quantity::all().find(|quantity| stem(quantity.entry().key) == stem(key)) {
        let entry = found.entry();
        let unit = if entry.unit.is_empty() {
            "has no unit".to_owned()
        } else {
            format!("is stated in {}", entry.unit)
        };
        return format!("is not a quantity; the {} {unit}: `{}`", entry.label, entry.key);
    }
    let nearest = keys().max_by(|a, b| strsim::jaro_winkler(a, key).total_cmp(&strsim::jaro_winkler(b, key)));
    let known: Vec<&str> = keys().collect();
    format!(
        "is not a quantity; did you mean `{}`? The quantities are {}",
        nearest.unwrap_or_default(),
        known.join(", ")
    )
}
