//! What a study asks of the quantities of a design: objectives and limits.

use super::Quantity;
use crate::pose::Better;

/// An objective of a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Objective {
    /// The quantity.
    pub quantity: Quantity,
    /// Whether it is to be small or large, whatever is usually better.
    pub goal: Better,
}

impl Objective {
    /// Returns what the best design of a front is called, if there is a word for it.
    pub fn superlative(&self) -> Option<&'static str> {
        let entry = self.quantity.entry();
        entry.superlative.filter(|_| entry.better == self.goal)
    }

    /// Returns what the best design of a front is called, for a person.
    pub fn best_name(&self) -> String {
        let short = self.quantity.entry().short;
        match (self.superlative(), self.goal) {
            (Some(word), _) => word.to_owned(),
            (None, Better::Lower) => format!("smallest {short}"),
            (None, Better::Higher) => format!("largest {short}"),
        }
    }

    /// Returns the value that is minimised: the negative of a quantity that is to be large, and 0 without a value.
    pub fn minimised(&self, value: Option<f64>) -> f64 {
        match (self.goal, value) {
            (_, None) => 0.0,
            (Better::Lower, Some(value)) => value,
            (Better::Higher, Some(value)) => -value,
        }
    }

    /// Returns the value of the quantity for a value that is minimised.
    pub fn value(&self, minimised: f64) -> f64 {
        match self.goal {
            Better::Lower => minimised,
            Better::Higher => -minimised,
        }
    }
}

/// Which values of a quantity a study allows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bound {
    /// Values of at least this number.
    AtLeast(f64),
    /// Values of at most this number.
    AtMost(f64),
}

impl Bound {
    /// Returns the bound that allows a value and all that are better.
    pub const fn no_worse_than(value: f64, better: Better) -> Self {
        match better {
            Better::Higher => Bound::AtLeast(value),
            Better::Lower => Bound::AtMost(value),
        }
    }

    /// Returns the least value allowed, if the bound is one from below.
    pub(crate) fn least(self) -> Option<f64> {
        match self {
            Bound::AtLeast(least) => Some(least),
            Bound::AtMost(_) => None,
        }
    }

    /// Returns the largest value allowed, if the bound is one from above.
    pub(crate) fn most(self) -> Option<f64> {
        match self {
            Bound::AtLeast(_) => None,
            Bound::AtMost(most) => Some(most),
        }
    }
}

/// Limit of a quantity of a design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QuantityLimit {
    /// The quantity.
    pub quantity: Quantity,
    /// Which values are allowed.
    pub bound: Bound,
}

/// A limit of one design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LimitResult {
    /// The limit.
    pub limit: QuantityLimit,
    /// The value; `None` if the design has none.
    pub value: Option<f64>,
    /// Relative margin, negative where the limit is not kept; −1 if there is no value.
    pub margin: f64,
}

impl QuantityLimit {
    /// The number that the limit states.
    pub fn threshold(&self) -> f64 {
        match self.bound {
            Bound::AtLeast(threshold) | Bound::AtMost(threshold) => threshold,
        }
    }

    /// Returns the margin of a value relative to the threshold, or the difference if the threshold is 0.
    pub fn margin(&self, value: f64) -> f64 {
        let (threshold, excess) = match self.bound {
            Bound::AtLeast(threshold) => (threshold, value - threshold),
            Bound::AtMost(threshold) => (threshold, threshold - value),
        };
        if threshold == 0.0 {
            excess
        } else {
            excess / threshold.abs()
        }
    }

    pub(super) fn result(&self, value: Option<f64>) -> LimitResult {
        LimitResult {
            limit: *self,
            value,
            margin: value.map_or(-1.0, |value| self.margin(value)),
        }
    }
}
