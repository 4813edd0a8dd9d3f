//! What there is to know about a scalar of a pose.

use crate::pose::entry::QuantityEntry;

/// What there is to know about a scalar of a pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseScalarEntry {
    /// The quantity of a design: the worst value over the poses of the region.
    pub quantity: QuantityEntry,
    /// Key of the value at one pose.
    pub at_pose: &'static str,
    /// Name to display of the value at one pose, without the unit.
    pub label: &'static str,
    /// Unit to display, and the factor from the SI unit to it.
    pub shown_in: (&'static str, f64),
    /// How margins of the value are made dimensionless.
    pub margin: MarginUnit,
    /// Whether thicker bars improve the value and nothing else of the design has to change for that.
    pub is_of_bars: bool,
    /// Whether a certificate encloses the value over boxes of poses: a limit of any other value is not proved.
    pub is_enclosed: bool,
    /// Whether the value is the root of a stiffness by a mass: bars are sized by its square, and from some radius on the mass of thicker
    /// bars makes it worse.
    pub is_frequency: bool,
}

/// What a margin is divided by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MarginUnit {
    /// The threshold, unless that is 0.
    Threshold,
    /// `R`: a distance between parts of the manipulator, whose threshold may well be 0.
    BaseRadius,
}

impl PoseScalarEntry {
    pub(super) const fn new(quantity: QuantityEntry, at_pose: &'static str) -> Self {
        Self {
            label: quantity.label,
            shown_in: (quantity.unit, 1.0),
            quantity,
            at_pose,
            margin: MarginUnit::Threshold,
            is_of_bars: false,
            is_enclosed: false,
            is_frequency: false,
        }
    }

    pub(super) const fn labelled(mut self, label: &'static str) -> Self {
        self.label = label;
        self
    }

    pub(super) const fn in_millimetres(mut self) -> Self {
        self.shown_in = ("mm", 1e3);
        self
    }

    pub(super) const fn per_base_radius(mut self) -> Self {
        self.margin = MarginUnit::BaseRadius;
        self
    }

    pub(super) const fn shown_in(mut self, unit: &'static str, factor: f64) -> Self {
        self.shown_in = (unit, factor);
        self
    }

    pub(super) const fn as_frequency(mut self) -> Self {
        self.is_frequency = true;
        self
    }

    pub(super) const fn enclosed(mut self) -> Self {
        self.is_enclosed = true;
        self
    }

    pub(super) const fn of_bars(mut self) -> Self {
        self.is_of_bars = true;
        self
    }
}
