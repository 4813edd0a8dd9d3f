//! The quantities of a design: what it is worth (docs/model.md, section 6.5).
//!
//! Objectives, limits, columns of tables, axes, filters and fields follow from [`Quantity::entry`]. A further quantity over poses is an
//! entry of the table of scalars ([`PoseScalar`]); any other is an entry here, with its value in
//! [`quantities`](super::quantities).

use crate::mechanism::{Design, JointKind};
use crate::pose::{Better, Constraint, PoseScalar, QuantityEntry, Reference, Scope};

macro_rules! quantities {
    ($($(#[$doc:meta])* $quantity:ident = $entry:expr;)*) => {
        /// A quantity of a design.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Quantity {
            $($(#[$doc])* $quantity,)*
            /// The worst value of a scalar over the poses of the region.
            Worst(PoseScalar),
        }

        /// Quantities that are not the worst value of a scalar.
        const OTHERS: &[Quantity] = &[$(Quantity::$quantity),*];

        const TABLE: &[QuantityEntry] = &[$($entry),*];

        impl Quantity {
            /// Returns the place of the quantity in an array of [`Quantity::COUNT`] values; the order has no meaning.
            pub fn index(self) -> usize {
                match self {
                    $(Quantity::$quantity => Other::$quantity as usize,)*
                    Quantity::Worst(scalar) => OTHERS.len() + scalar as usize,
                }
            }
        }

        enum Other {
            $($quantity),*
        }
    };
}

quantities! {
    /// Mass in motion.
    Mass = QuantityEntry::new("mass_kg", "kg", "mass in motion", Scope::Design, Better::Lower,
        "Mass of the moving parts: bars, and joints, motors and drives to which the study gives a mass; plus the mass of rails with a cross-section.").logarithmic().reference(Reference::Mass).short("mass").superlative("lightest");
    /// Radius of the regular workspace.
    WorkspaceRadius = QuantityEntry::new("workspace_radius_m", "m", "R_w", Scope::Region, Better::Higher,
        "Radius of the regular workspace; for a prescribed region, of the largest disc about the centre within it.")
        .reference(Reference::LinkLength(1.0)).superlative("largest");
    /// Mass of the bars and rails of all legs.
    LegsMass = QuantityEntry::new("legs_mass_kg", "kg", "mass of the legs", Scope::Design, Better::Lower,
        "Mass of the bars and rails of all legs, and of those of their joints and motors that move.").logarithmic().reference(Reference::Mass);
    /// Mass of the platform bars.
    PlatformMass = QuantityEntry::new("platform_mass_kg", "kg", "mass of the platform", Scope::Design, Better::Lower,
        "Mass of the platform bars.").logarithmic().reference(Reference::Mass);
    /// Height of the stack of layers.
    Height = QuantityEntry::new("height_m", "m", "height", Scope::Design, Better::Lower,
        "Height of the stack of layers, from the lowest to the highest point of any member.")
        .reference(Reference::BarRadius(20.0));
    /// Mean inverse condition number.
    DexterityMean = QuantityEntry::new("dexterity_mean", "", "mean dexterity", Scope::Region, Better::Higher,
        "Mean of the inverse condition number over the region, the global conditioning index of Gosselin and Angeles.")
        .below(1.0);
    /// Time of a cycle of the motion.
    CycleTime = QuantityEntry::new("cycle_time_s", "s", "cycle time", Scope::Region, Better::Lower,
        "Duration of one cycle of the motion that [task] defines, including rests.").above_zero().logarithmic().reference(Reference::Number(1e4));
    /// Least distance to a joint limit or to the end of reach over the motion.
    PathReach = QuantityEntry::new("path_reach_m", "m", "reach of the path", Scope::Region, Better::Higher,
        "Smallest distance to a joint limit or to the end of reach over the motion; negative if the motion ends early.");
    /// Energy of a cycle, with the drives on a common link.
    CycleEnergy = QuantityEntry::new("energy_j", "J", "energy per cycle", Scope::Region, Better::Lower,
        "Mechanical energy per cycle of the motion, with drives that share the energy they recover.")
        .above_zero().logarithmic().reference(Reference::Number(1e6));
    /// Power of one type of motor for all drives.
    CornerPower = QuantityEntry::new("power_w", "W", "power of a drive", Scope::Region, Better::Lower,
        "Largest force times largest speed of any actuator over the motion: the corner power of one motor type for all legs.")
        .above_zero().logarithmic().reference(Reference::Number(1e6));
    /// Largest speed of a prismatic actuator over the motion.
    PathSpeed = QuantityEntry::new("path_speed_max_m_per_s", "m/s", "speed on the path", Scope::Region, Better::Lower,
        "Largest speed of a prismatic actuator over the motion.").above_zero().logarithmic().reference(Reference::Number(1e3));
    /// Largest speed of a revolute actuator over the motion.
    PathRate = QuantityEntry::new("path_speed_max_rad_per_s", "rad/s", "rate on the path", Scope::Region, Better::Lower,
        "Largest speed of a revolute actuator over the motion.").above_zero().logarithmic().reference(Reference::Number(1e3));
    /// Largest force of a prismatic actuator over the motion.
    PathForce = QuantityEntry::new("path_force_max_n", "N", "force on the path", Scope::Region, Better::Lower,
        "Largest force of a prismatic actuator over the motion.").above_zero().logarithmic().reference(Reference::Number(1e6));
    /// Largest torque of a revolute actuator over the motion.
    PathTorque = QuantityEntry::new("path_torque_max_nm", "N·m", "torque on the path", Scope::Region, Better::Lower,
        "Largest torque of a revolute actuator over the motion.").above_zero().logarithmic().reference(Reference::Number(1e6));
    /// Largest root mean square of the force of a prismatic actuator over a cycle.
    PathForceRms = QuantityEntry::new("path_rms_force_n", "N", "RMS force on the path", Scope::Region, Better::Lower,
        "Largest root mean square of the force of a prismatic actuator over a cycle of the motion.")
        .above_zero().logarithmic().reference(Reference::Number(1e6));
    /// Largest root mean square of the torque of a revolute actuator over a cycle.
    PathTorqueRms = QuantityEntry::new("path_rms_torque_nm", "N·m", "RMS torque on the path", Scope::Region, Better::Lower,
        "Largest root mean square of the torque of a revolute actuator over a cycle of the motion.")
        .above_zero().logarithmic().reference(Reference::Number(1e6));
    /// Mass of the selected drive.
    DriveMass = QuantityEntry::new("drive_mass_kg", "kg", "mass of a drive", Scope::Region, Better::Lower,
        "Mass of one of the three equal drives selected: the lightest of the catalogue whose utilization by the motion is within the limit.")
        .above_zero().logarithmic().reference(Reference::Number(1e4));
    /// Largest share of the limits of the selected drive that the motion uses.
    DriveUtilization = QuantityEntry::new("drive_utilization", "", "utilization of the drives", Scope::Region, Better::Lower,
        "Largest fraction of the peak force, rated force and speed of the selected drive that the motion uses; above 1, no drive of the catalogue \
         can perform the motion.").above_zero();
    /// Lowest natural frequency of the frame of finite elements.
    FrameFrequency = QuantityEntry::new("frame_frequency_hz", "Hz", "frame frequency", Scope::Region, Better::Higher,
        "Lowest natural frequency of a frame with three finite elements per bar, at the pose of the region where natural_frequency_hz is lowest: \
         bars also vibrate between their ends, and guides beyond their carriages.")
        .above_zero().logarithmic().reference(Reference::Number(1e3));
    /// Length that a leg and the platform bridge, the value of g1.
    Assembly = QuantityEntry::new("assembly_m", "m", "assembly", Scope::Design, Better::Higher,
        "Distance that a leg and the platform can span together; g1 requires it to reach from the base to O.");
}

/// The quantities of the first version, in the order of their columns, which is a contract; later ones follow in the order of the
/// tables.
const FIRST: [Quantity; 16] = [
    Quantity::Mass,
    Quantity::WorkspaceRadius,
    Quantity::Worst(PoseScalar::Dexterity),
    Quantity::Worst(PoseScalar::StiffnessXy),
    Quantity::Worst(PoseScalar::StiffnessZ),
    Quantity::Worst(PoseScalar::StiffnessPhiZ),
    Quantity::Worst(PoseScalar::Clearance),
    Quantity::Worst(PoseScalar::Reach),
    Quantity::Worst(PoseScalar::Determinant),
    Quantity::LegsMass,
    Quantity::PlatformMass,
    Quantity::Height,
    Quantity::DexterityMean,
    Quantity::Worst(PoseScalar::Displacement),
    Quantity::Worst(PoseScalar::Transmission),
    Quantity::Worst(PoseScalar::Footprint),
];

impl Quantity {
    /// Number of quantities.
    pub const COUNT: usize = TABLE.len() + PoseScalar::COUNT;

    /// All quantities, in the order of their columns.
    pub fn all() -> impl Iterator<Item = Quantity> {
        let worst = PoseScalar::ALL.iter().map(|&scalar| Quantity::Worst(scalar));
        let later = OTHERS
            .iter()
            .copied()
            .chain(worst)
            .filter(|quantity| !FIRST.contains(quantity));
        FIRST.into_iter().chain(later)
    }

    /// The entry of the quantity in its table.
    pub fn entry(self) -> &'static QuantityEntry {
        match self {
            Quantity::Worst(scalar) => &scalar.entry().quantity,
            other => &TABLE[other.index()],
        }
    }

    /// Quantities of the motion that a study states.
    pub const OF_TASK: [Quantity; 12] = [
        Quantity::CycleTime,
        Quantity::PathReach,
        Quantity::CycleEnergy,
        Quantity::CornerPower,
        Quantity::PathSpeed,
        Quantity::PathRate,
        Quantity::PathForce,
        Quantity::PathTorque,
        Quantity::PathForceRms,
        Quantity::PathTorqueRms,
        Quantity::DriveMass,
        Quantity::DriveUtilization,
    ];

    /// Returns the kind of actuators that have the quantity; `None` if it is one of all designs.
    pub fn of_actuators(self) -> Option<JointKind> {
        match self {
            Quantity::PathSpeed | Quantity::PathForce | Quantity::PathForceRms => Some(JointKind::Prismatic),
            Quantity::PathRate | Quantity::PathTorque | Quantity::PathTorqueRms => Some(JointKind::Revolute),
            Quantity::Worst(scalar) => scalar.of_actuators(),
            _ => None,
        }
    }

    /// Returns the quantity that takes the place of this one where the actuators are of the other kind.
    pub fn of_other_actuators(self) -> Option<Quantity> {
        const PAIRS: [[Quantity; 2]; 6] = [
            [Quantity::PathSpeed, Quantity::PathRate],
            [Quantity::PathForce, Quantity::PathTorque],
            [Quantity::PathForceRms, Quantity::PathTorqueRms],
            [
                Quantity::Worst(PoseScalar::ActuatorForce),
                Quantity::Worst(PoseScalar::ActuatorTorque),
            ],
            [
                Quantity::Worst(PoseScalar::ActuatorSpeed),
                Quantity::Worst(PoseScalar::ActuatorRate),
            ],
            [
                Quantity::Worst(PoseScalar::MotionForce),
                Quantity::Worst(PoseScalar::MotionTorque),
            ],
        ];
        let pair = PAIRS.into_iter().find(|pair| pair.contains(&self))?;
        pair.into_iter().find(|other| *other != self)
    }

    /// Returns whether the actuators of a design are of the kind that has the quantity.
    pub fn is_of(self, design: &Design) -> bool {
        let actuator = design.architecture().actuator();
        self.of_actuators().is_none_or(|kind| kind == actuator)
    }

    /// Returns the quantity of a key.
    pub fn find(key: &str) -> Option<Quantity> {
        Self::all().find(|quantity| quantity.entry().key == key)
    }

    /// Returns the quantity that is the value of a constraint.
    pub fn of_constraint(constraint: Constraint) -> Quantity {
        constraint.scalar().map_or(Quantity::Assembly, Quantity::Worst)
    }

    /// Returns the constraint of which the quantity is the value.
    pub fn constraint(self) -> Option<Constraint> {
        match self {
            Quantity::Assembly => Some(Constraint::Assembly),
            Quantity::Worst(scalar) => Constraint::of_scalar(scalar),
            _ => None,
        }
    }

    /// Returns whether every evaluation determines the quantity; all others are computed only if they are asked for.
    pub fn is_always_known(self) -> bool {
        match self {
            Quantity::Mass | Quantity::WorkspaceRadius | Quantity::Assembly => true,
            Quantity::Worst(scalar) => PoseScalar::ALWAYS.contains(&scalar),
            _ => false,
        }
    }
}

/// A set of quantities.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct QuantitySet(u64);

const _: () = assert!(
    Quantity::COUNT <= u64::BITS as usize,
    "a set of quantities has a bit for each"
);

impl QuantitySet {
    /// Returns whether the set contains a quantity.
    pub fn contains(self, quantity: Quantity) -> bool {
        self.0 & (1 << quantity.index()) != 0
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
            .fold(0, |bits, quantity| bits | 1 << quantity.index());
        Self(bits)
    }
}

/// The quantities of a design, without those that it does not have or that were not asked for.
#[derive(Clone, Copy)]
pub struct QuantityValues {
    /// NaN stands for no value.
    values: [f64; Quantity::COUNT],
}

impl Default for QuantityValues {
    fn default() -> Self {
        Self {
            values: [f64::NAN; Quantity::COUNT],
        }
    }
}

impl PartialEq for QuantityValues {
    fn eq(&self, other: &Self) -> bool {
        Quantity::all().all(|quantity| self.get(quantity) == other.get(quantity))
    }
}

impl std::fmt::Debug for QuantityValues {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let known = Quantity::all().filter_map(|quantity| Some((quantity.entry().key, self.get(quantity)?)));
        f.debug_map().entries(known).finish()
    }
}

impl QuantityValues {
    /// Returns a quantity.
    pub fn get(&self, quantity: Quantity) -> Option<f64> {
        Some(self.values[quantity.index()]).filter(|value| !value.is_nan())
    }

    /// Sets a quantity; a number that is not finite is no value.
    pub(super) fn set(&mut self, quantity: Quantity, value: Option<f64>) {
        self.values[quantity.index()] = value.filter(|value| value.is_finite()).unwrap_or(f64::NAN);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_keys_name_the_unit() {
        for quantity in Quantity::all() {
            let entry = quantity.entry();
            assert_eq!(Quantity::find(entry.key), Some(quantity));
            let suffix = match entry.unit {
                "" => "",
                "kg" => "_kg",
                "m" => "_m",
                "N/m" => "_n_per_m",
                "N·m/rad" => "_nm_per_rad",
                "Pa" => "_pa",
                "N" => "_n",
                "N·m" => "_nm",
                "Hz" => "_hz",
                "°" => "_deg",
                "m/s" => "_m_per_s",
                "rad/s" => "_rad_per_s",
                "s" => "_s",
                "J" => "_j",
                "W" => "_w",
                unit => panic!("{unit} has no suffix"),
            };
            assert!(entry.key.ends_with(suffix), "{}", entry.key);
        }
        assert_eq!(Quantity::all().count(), Quantity::COUNT);
        assert_eq!(QuantitySet::all().iter().count(), Quantity::COUNT);
    }
}
