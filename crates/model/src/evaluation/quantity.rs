//! The quantities of a design: what it is worth (docs/model.md, section 6.5).
//!
//! Objectives, limits, columns of tables, axes, filters and fields follow from [`Quantity::entry`]. A further quantity is an
//! entry of the table and a value in [`quantities`](super::quantities).

use super::Constraint;

/// A number that a design is worth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Quantity {
    /// Mass in motion.
    Mass,
    /// Radius of the regular workspace.
    WorkspaceRadius,
    /// Least inverse condition number.
    Dexterity,
    /// Least translational stiffness in the plane.
    StiffnessXy,
    /// Least translational stiffness out of the plane.
    StiffnessZ,
    /// Least rotational stiffness about z.
    StiffnessPhiZ,
    /// Smallest clearance.
    Clearance,
    /// Smallest distance to a joint limit or to the end of reach.
    Reach,
    /// Least determinant.
    Determinant,
    /// Mass of the bars and rails of all legs.
    LegsMass,
    /// Mass of the platform bars.
    PlatformMass,
    /// Height of the stack of layers.
    Height,
    /// Mean inverse condition number.
    DexterityMean,
    /// Largest displacement under the in-plane force.
    DisplacementMax,
    /// Least transmission.
    TransmissionMin,
    /// Radius of the area that the machine needs.
    Footprint,
}

/// Over what a quantity is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scope {
    /// The design alone, whatever its pose.
    Design,
    /// All poses of the region, of which the quantity is the least or the largest value. Its limit bounds the poses of the
    /// largest disc.
    Poses,
    /// The region as a whole.
    Region,
}

/// Direction in which the values of a quantity are better.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Better {
    /// Smaller values are better.
    Lower,
    /// Larger values are better.
    Higher,
}

/// What there is to know about a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct QuantityEntry {
    /// The quantity.
    pub quantity: Quantity,
    /// Name with the unit, as in study files and tables.
    pub key: &'static str,
    /// Unit; empty for a number without one.
    pub unit: &'static str,
    /// Name to display, without the unit.
    pub label: &'static str,
    /// What it is, in one sentence.
    pub meaning: &'static str,
    /// Over what it is taken.
    pub scope: Scope,
    /// Which values are better.
    pub better: Better,
    /// The constraint of which it is the value.
    pub constraint: Option<Constraint>,
}

macro_rules! quantities {
    ($($quantity:ident $key:literal [$unit:literal] $label:literal $scope:ident $better:ident $constraint:expr, $meaning:literal;)*) => {
        const TABLE: &[QuantityEntry] = &[$(QuantityEntry {
            quantity: Quantity::$quantity,
            key: $key,
            unit: $unit,
            label: $label,
            meaning: $meaning,
            scope: Scope::$scope,
            better: Better::$better,
            constraint: $constraint,
        }),*];
    };
}

quantities! {
    Mass "mass_kg" ["kg"] "mass in motion" Design Lower None,
        "Mass of the bars of the legs and of the platform.";
    WorkspaceRadius "workspace_radius_m" ["m"] "R_w" Region Higher None,
        "Radius of the regular workspace; for a prescribed region, of the largest disc about the centre within it.";
    Dexterity "dexterity" [""] "dexterity" Poses Higher Some(Constraint::Dexterity),
        "Least inverse condition number of the normalised Jacobian (g3).";
    StiffnessXy "k_xy_n_per_m" ["N/m"] "k_xy" Poses Higher Some(Constraint::StiffnessXy),
        "Least translational stiffness in the plane (g4).";
    StiffnessZ "k_z_n_per_m" ["N/m"] "k_z" Poses Higher Some(Constraint::StiffnessZ),
        "Least translational stiffness out of the plane (g5).";
    StiffnessPhiZ "k_phi_z_nm_per_rad" ["N·m/rad"] "k_φz" Poses Higher Some(Constraint::StiffnessPhiZ),
        "Least rotational stiffness about z (g6).";
    Clearance "clearance_m" ["m"] "clearance" Poses Higher Some(Constraint::Clearance),
        "Smallest clearance of members that are not joined (g7).";
    Reach "reach_m" ["m"] "reach" Poses Higher Some(Constraint::Reach),
        "Smallest distance to a joint limit or to the end of reach (g2).";
    Determinant "determinant" [""] "det A" Poses Higher Some(Constraint::DeterminantSign),
        "Least determinant of the direct Jacobian, divided by the characteristic length.";
    LegsMass "legs_mass_kg" ["kg"] "mass of the legs" Design Lower None,
        "Mass of the bars and rails of all legs.";
    PlatformMass "platform_mass_kg" ["kg"] "mass of the platform" Design Lower None,
        "Mass of the platform bars.";
    Height "height_m" ["m"] "height" Design Lower None,
        "Height of the stack of layers, from the lowest to the highest point of any member.";
    DexterityMean "dexterity_mean" [""] "mean dexterity" Region Higher None,
        "Mean of the inverse condition number over the region, the global conditioning index of Gosselin and Angeles.";
    DisplacementMax "displacement_max_m" ["m"] "largest displacement" Poses Lower None,
        "Largest displacement of P under the in-plane force of the requirements, in its most compliant direction.";
    TransmissionMin "transmission_min" [""] "least transmission" Poses Higher None,
        "Least transmission of a leg: the speed along its last link for a unit speed of the joint that the actuator moves.";
    Footprint "footprint_m" ["m"] "footprint" Region Lower None,
        "Radius of the smallest circle about O that holds the base and all members at every pose of the region.";
}

impl Quantity {
    /// All quantities, in the order of the table.
    pub fn all() -> impl Iterator<Item = Quantity> {
        TABLE.iter().map(|entry| entry.quantity)
    }

    /// Number of quantities.
    pub const COUNT: usize = TABLE.len();

    /// The entry of the quantity in the table.
    pub fn entry(self) -> &'static QuantityEntry {
        &TABLE[self as usize]
    }

    /// Returns the quantity of a key.
    pub fn find(key: &str) -> Option<Quantity> {
        Self::all().find(|quantity| quantity.entry().key == key)
    }

    /// Returns the quantity that is the value of a constraint.
    pub fn of_constraint(constraint: Constraint) -> Option<Quantity> {
        Self::all().find(|quantity| quantity.entry().constraint == Some(constraint))
    }

    /// Returns whether every evaluation determines the quantity; all others are computed only if they are asked for.
    pub fn is_always_known(self) -> bool {
        self.entry().constraint.is_some() || matches!(self, Quantity::Mass | Quantity::WorkspaceRadius)
    }
}

/// A set of quantities.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct QuantitySet(u32);

impl QuantitySet {
    /// Returns whether the set contains a quantity.
    pub fn contains(self, quantity: Quantity) -> bool {
        self.0 & (1 << quantity as u32) != 0
    }

    /// Iterates over the quantities in the order of the table.
    pub fn iter(self) -> impl Iterator<Item = Quantity> {
        Quantity::all().filter(move |&quantity| self.contains(quantity))
    }

    /// All quantities.
    pub fn all() -> Self {
        Quantity::all().collect()
    }
}

impl FromIterator<Quantity> for QuantitySet {
    fn from_iter<I: IntoIterator<Item = Quantity>>(quantities: I) -> Self {
        let bits = quantities
            .into_iter()
            .fold(0, |bits, quantity| bits | 1 << quantity as u32);
        Self(bits)
    }
}

/// The quantities of a design; `None` where it has none or it was not asked for.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct QuantityValues([Option<f64>; Quantity::COUNT]);

impl QuantityValues {
    /// Returns a quantity.
    pub fn get(&self, quantity: Quantity) -> Option<f64> {
        self.0[quantity as usize]
    }

    /// Returns those quantities that are computed only if they are asked for.
    pub fn asked_for(&self) -> Self {
        let rest = Quantity::all().filter(|quantity| !quantity.is_always_known());
        rest.map(|quantity| (quantity, self.get(quantity))).collect()
    }

    /// Sets a quantity; a number that is not finite is no value.
    pub(super) fn set(&mut self, quantity: Quantity, value: Option<f64>) {
        self.0[quantity as usize] = value.filter(|value| value.is_finite());
    }
}

impl FromIterator<(Quantity, Option<f64>)> for QuantityValues {
    fn from_iter<I: IntoIterator<Item = (Quantity, Option<f64>)>>(quantities: I) -> Self {
        let mut values = Self::default();
        for (quantity, value) in quantities {
            values.set(quantity, value);
        }
        values
    }
}

/// An objective of a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Objective {
    /// The quantity.
    pub quantity: Quantity,
    /// Whether it is to be small or large, whatever is usually better.
    pub goal: Better,
}

impl Objective {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_in_the_order_of_the_quantities_and_its_keys_name_the_unit() {
        for (place, entry) in TABLE.iter().enumerate() {
            assert_eq!(entry.quantity as usize, place);
            assert_eq!(Quantity::find(entry.key), Some(entry.quantity));
            let suffix = match entry.unit {
                "" => "",
                "kg" => "_kg",
                "m" => "_m",
                "N/m" => "_n_per_m",
                "N·m/rad" => "_nm_per_rad",
                unit => panic!("{unit} has no suffix"),
            };
            assert!(entry.key.ends_with(suffix), "{}", entry.key);
        }
        assert_eq!(QuantitySet::all().iter().count(), Quantity::COUNT);
    }
}
