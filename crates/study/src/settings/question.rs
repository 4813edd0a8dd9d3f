//! What a study asks: its objectives, its limits, and the quantities that it reports (docs/interfaces.md).

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::Study;
use kinefront_model::evaluation::{Better, Bound, Objective, Quantity, QuantityLimit, QuantitySet, Scope};
use kinefront_model::workspace::{FurtherLimits, Thresholds};

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
    /// The objectives of the paper: little mass, and a large workspace.
    pub fn of_paper() -> Vec<Self> {
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

    fn objective(&self) -> Option<Objective> {
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

/// Limits by the key of their quantity.
pub type Limits = BTreeMap<String, LimitChoice>;

impl Study {
    /// Returns the objectives of the study; a study without faults has one to three.
    pub fn objectives(&self) -> Vec<Objective> {
        self.objectives.iter().filter_map(ObjectiveChoice::objective).collect()
    }

    /// Whether the workspaces of the front are proved: proofs cover the largest disc and the constraints of the paper.
    pub fn certifies(&self) -> bool {
        let covered = self.thresholds().further.is_none();
        // A radius that is exactly at its limit would fall below it by the tolerance of the proof.
        let bounds_radius = self.limits().any(|limit| limit.quantity == Quantity::WorkspaceRadius);
        self.workspace.certify && !self.workspace.region.is_prescribed() && covered && !bounds_radius
    }

    /// Whether the study asks the paper's question: mass against the radius of the largest disc.
    pub fn asks_as_the_paper(&self) -> bool {
        self.objectives == ObjectiveChoice::of_paper()
    }

    /// Iterates over the limits of the study.
    pub fn limits(&self) -> impl Iterator<Item = QuantityLimit> {
        self.constraints.iter().flat_map(|(key, limits)| {
            let quantity = Quantity::find(key);
            let bounds = [limits.at_least.map(Bound::AtLeast), limits.at_most.map(Bound::AtMost)];
            bounds.into_iter().flatten().filter_map(move |bound| {
                Some(QuantityLimit {
                    quantity: quantity?,
                    bound,
                })
            })
        })
    }

    /// Returns the quantities that an evaluation has to determine besides those that it always does.
    pub fn asked_quantities(&self) -> QuantitySet {
        let named = self.named_quantities();
        named.iter().filter(|quantity| !quantity.is_always_known()).collect()
    }

    /// Returns the quantities that the study names: in its objectives, its limits, and those to be reported.
    pub fn named_quantities(&self) -> QuantitySet {
        let of_objectives = self.objectives().into_iter().map(|objective| objective.quantity);
        let of_limits = self.limits().map(|limit| limit.quantity);
        let reported = self.quantities.iter().filter_map(|key| Quantity::find(key));
        of_objectives.chain(of_limits).chain(reported).collect()
    }

    /// Returns the limits that hold for the region as a whole, not for each of its poses.
    pub fn limits_of_designs(&self) -> Vec<QuantityLimit> {
        self.limits().filter(|limit| !bounds_poses(limit)).collect()
    }

    /// Applies the limits that hold for each pose to thresholds.
    pub(crate) fn bound_poses(&self, thresholds: &mut Thresholds) {
        for limit in self.limits().filter(bounds_poses) {
            let threshold = limit.threshold();
            match limit.quantity {
                Quantity::Dexterity => thresholds.inverse_condition = threshold,
                Quantity::StiffnessXy => thresholds.k_xy = threshold,
                Quantity::StiffnessZ => thresholds.k_z = threshold,
                Quantity::StiffnessPhiZ => thresholds.k_phi_z = threshold,
                Quantity::Clearance => thresholds.clearance = Some(threshold),
                Quantity::Reach => further(thresholds).limit_margin = Some(threshold),
                Quantity::TransmissionMin => further(thresholds).transmission = Some(threshold),
                Quantity::DisplacementMax => further(thresholds).displacement = Some(threshold),
                _ => {}
            }
        }
    }
}

fn further(thresholds: &mut Thresholds) -> &mut FurtherLimits {
    thresholds.further.get_or_insert_default()
}

/// Whether a limit is one of each pose of the region: that of the least value of a quantity over poses from below, or that of the
/// largest value from above.
fn bounds_poses(limit: &QuantityLimit) -> bool {
    let entry = limit.quantity.entry();
    let from = match limit.bound {
        Bound::AtLeast(_) => Better::Higher,
        Bound::AtMost(_) => Better::Lower,
    };
    // No study bounds the determinant from below: the sign rule does.
    entry.scope == Scope::Poses && entry.better == from && limit.quantity != Quantity::Determinant
}

/// Explains that a key names no quantity, and names the nearest one.
pub(super) fn unknown_quantity(key: &str) -> String {
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
        return format!("is no quantity; the {} {unit}: `{}`", entry.label, entry.key);
    }
    let nearest = keys().max_by(|a, b| strsim::jaro_winkler(a, key).total_cmp(&strsim::jaro_winkler(b, key)));
    let known: Vec<&str> = keys().collect();
    format!(
        "is no quantity; did you mean `{}`? The quantities are {}",
        nearest.unwrap_or_default(),
        known.join(", ")
    )
}
