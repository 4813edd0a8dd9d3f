//! Constraints g1 … g6, the sign rule, and g7, which a study may require: their thresholds and margins (docs/model.md, section 6).

use super::entry::Better;
use super::scalars::{CONSTRAINTS, Constraint, MarginUnit, PoseScalar};
use super::values::{PoseValues, Thresholds, is_within};
use crate::mechanism::{Assembly, Design};

impl PoseScalar {
    /// Returns the relative margin of a value, which is negative where the limit is violated: the excess over the threshold, divided by
    /// `R` for distances between parts, otherwise by the threshold, unless that is 0. Without a value it is −1.
    pub fn margin(self, value: f64, threshold: f64, design: &Design) -> f64 {
        let entry = self.entry();
        if !value.is_finite() {
            return -1.0;
        }
        let excess = match entry.quantity.better {
            Better::Higher => value - threshold,
            Better::Lower => threshold - value,
        };
        match entry.margin {
            MarginUnit::BaseRadius => excess / design.base_radius(),
            MarginUnit::Threshold if threshold > 0.0 => excess / threshold,
            MarginUnit::Threshold => excess,
        }
    }
}

impl Constraint {
    /// Number of constraints.
    pub const COUNT: usize = CONSTRAINTS.len();

    /// All constraints, beginning with g1.
    pub const ALL: [Constraint; Self::COUNT] = {
        let mut all = [Constraint::Assembly; Self::COUNT];
        let mut place = 0;
        while place < Self::COUNT {
            all[place] = CONSTRAINTS[place].0;
            place += 1;
        }
        all
    };

    /// Returns the short id, as in JSON and CSV.
    pub fn id(self) -> &'static str {
        CONSTRAINTS[self as usize].1
    }

    /// Returns the name, as in JSON.
    pub fn name(self) -> &'static str {
        CONSTRAINTS[self as usize].2
    }

    /// Returns the scalar of a pose that it bounds; `None` for g1, which applies to the design as a whole.
    pub fn scalar(self) -> Option<PoseScalar> {
        CONSTRAINTS[self as usize].3
    }

    /// Returns the constraint that bounds a scalar of a pose, if it has an id of its own.
    pub fn of_scalar(scalar: PoseScalar) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|constraint| constraint.scalar() == Some(scalar))
    }

    /// Returns which values are better.
    pub fn better(self) -> Better {
        self.scalar()
            .map_or(Better::Higher, |scalar| scalar.entry().quantity.better)
    }

    /// Returns the unit of the value and the threshold; empty for a dimensionless number.
    pub fn unit(self) -> &'static str {
        self.scalar().map_or("m", |scalar| scalar.entry().quantity.unit)
    }

    /// Returns whether the constraint is required: g7, and a scalar that only some studies need, are required if the study states a
    /// threshold, all others always are.
    pub fn is_required(self, thresholds: &Thresholds) -> bool {
        let is_optional =
            |scalar: &PoseScalar| *scalar == PoseScalar::Clearance || !PoseScalar::ALWAYS.contains(scalar);
        self.scalar()
            .filter(is_optional)
            .is_none_or(|scalar| thresholds.get(scalar).is_some())
    }

    /// Returns the constraints that are required.
    pub fn required(thresholds: &Thresholds) -> impl Iterator<Item = Constraint> {
        Self::ALL
            .into_iter()
            .filter(|constraint| constraint.is_required(thresholds))
    }

    /// Returns the smallest value allowed; 0 for g7 if it is not required, at which members touch.
    pub fn threshold(self, assembly: &Assembly, thresholds: &Thresholds) -> f64 {
        match self.scalar() {
            None => assembly.threshold,
            Some(scalar) => thresholds.get(scalar).unwrap_or(0.0),
        }
    }

    /// Returns the relative margin of a value ([`PoseScalar::margin`]).
    pub fn margin(self, value: f64, threshold: f64, design: &Design) -> f64 {
        match self.scalar() {
            Some(scalar) => scalar.margin(value, threshold, design),
            None if threshold > 0.0 => (value - threshold) / threshold,
            None => value - threshold,
        }
    }

    /// Returns the value at a reachable pose, with `det A / ℓ` multiplied by `sign`, that of the home pose; `None` for g1, which
    /// applies to a design as a whole, and for a value that was not computed because it is not required.
    pub fn value(self, values: &PoseValues, sign: f64) -> Option<f64> {
        let value = values.get(self.scalar()?)?;
        Some(if self == Constraint::DeterminantSign {
            sign * value
        } else {
            value
        })
    }

    /// Returns whether a value satisfies the constraint: `det A` must not vanish, every other value may equal its
    /// threshold.
    pub fn holds(self, value: f64, threshold: f64) -> bool {
        match (self, self.scalar()) {
            (Constraint::DeterminantSign, _) => value > threshold,
            (_, Some(scalar)) => is_within(scalar, value, threshold),
            (_, None) => value >= threshold,
        }
    }
}

/// A set of constraints.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ConstraintSet(u32);

const _: () = assert!(Constraint::COUNT <= 32, "a set of constraints has a bit for each");

impl ConstraintSet {
    /// Returns whether the set contains a constraint.
    pub fn contains(self, constraint: Constraint) -> bool {
        self.0 & (1 << constraint as u32) != 0
    }

    /// Returns the set with a constraint.
    pub fn with(self, constraint: Constraint) -> Self {
        Self(self.0 | 1 << constraint as u32)
    }

    /// Iterates over the constraints in their order.
    pub fn iter(self) -> impl Iterator<Item = Constraint> {
        Constraint::ALL
            .into_iter()
            .filter(move |&constraint| self.contains(constraint))
    }
}

impl FromIterator<Constraint> for ConstraintSet {
    fn from_iter<I: IntoIterator<Item = Constraint>>(constraints: I) -> Self {
        constraints.into_iter().fold(Self::default(), Self::with)
    }
}
