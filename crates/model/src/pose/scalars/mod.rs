//! The scalars of a pose: the one table from which lanes, loops over poses, thresholds, limits, quantities, fields and columns follow
//! (docs/model.md, section 6).
//!
//! A further scalar is an entry here and a file with its formula. If it is a constraint with an id of its own, the entry says so; if a
//! certificate has a form of it (`certify/forms/`), the entry says so, too.

mod displacement;
mod dynamics;
mod entry;
mod footprint;
mod strength;
mod transmission;

pub(super) use dynamics::keep_limits_of_motion;
pub use entry::{MarginUnit, PoseScalarEntry};

use super::PoseChecker;
use super::entry::{Better, QuantityEntry, Reference, Scope};
use super::values::{PoseScalars, ScalarSet};
use crate::dynamics::MotionValue;
use crate::lanes::{LaneJob, Planar, Real};
use crate::mechanism::{JointKind, Leg};
use crate::spatial::LEGS;
use crate::strength::{StrengthSet, StrengthValue};

const _: () = assert!(
    MotionValue::ALL.len() == PoseScalar::OF_MOTION.len(),
    "every limit of a motion is examined"
);

macro_rules! pose_scalars {
    (
        always { $($(#[$doc:meta])* $scalar:ident $([$constraint:ident $id:literal $name:literal])? = $entry:expr;)* }
        on_demand {
            $($(#[$more_doc:meta])* $more:ident $([$bound:ident $bound_id:literal $bound_name:literal])? by $formula:path = $more_entry:expr;)*
        }
        of_loads {
            $($(#[$load_doc:meta])* $load:ident = $load_entry:expr;)*
        }
        of_motion {
            $($(#[$motion_doc:meta])* $motion:ident = $motion_entry:expr;)*
        }
    ) => {
        /// A number that describes the manipulator at one pose.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum PoseScalar {
            $($(#[$doc])* $scalar,)*
            $($(#[$more_doc])* $more,)*
            $($(#[$load_doc])* $load,)*
            $($(#[$motion_doc])* $motion,)*
        }

        const TABLE: &[PoseScalarEntry] = &[$($entry,)* $($more_entry,)* $($load_entry,)* $($motion_entry,)*];

        impl MotionValue {
            /// Returns the scalar that is the value.
            #[inline(always)]
            pub(crate) fn scalar(self) -> PoseScalar {
                match self {
                    $(MotionValue::$motion => PoseScalar::$motion,)*
                }
            }
        }

        impl PoseScalar {
            /// All scalars, in the order of the table.
            pub const ALL: &[PoseScalar; TABLE.len()] = &[
                $(PoseScalar::$scalar,)*
                $(PoseScalar::$more,)*
                $(PoseScalar::$load,)*
                $(PoseScalar::$motion,)*
            ];

            /// Those that depend on the loads of the members.
            pub const OF_LOADS: &[PoseScalar] = &[$(PoseScalar::$load),*];

            /// Those that depend on the payload, the motion or the tolerances.
            pub const OF_MOTION: &[PoseScalar] = &[$(PoseScalar::$motion),*];

            /// Returns what of the motion at a pose the scalar is, if it depends on that.
            #[inline(always)]
            pub(crate) fn of_motion(self) -> Option<MotionValue> {
                match self {
                    $(PoseScalar::$motion => Some(MotionValue::$motion),)*
                    _ => None,
                }
            }

            /// Returns what of the strength at a pose the scalar is, if it depends on the loads of the members.
            #[inline(always)]
            pub(crate) fn of_strength(self) -> Option<StrengthValue> {
                match self {
                    $(PoseScalar::$load => Some(StrengthValue::$load),)*
                    _ => None,
                }
            }

            /// Those that every evaluation determines; the others only where a study asks for them.
            pub const ALWAYS: &[PoseScalar] = &[$(PoseScalar::$scalar),*];
        }

        /// One constraint of the study: g1, or a scalar of a pose that has an id of its own.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum Constraint {
            /// g1: a leg and the platform bridge the distance from the base to `O`, for example `L_b + r ≥ R/2`.
            Assembly,
            $($(
                #[doc = concat!($id, ", `", $name, "`: see [`PoseScalar::", stringify!($scalar), "`].")]
                $constraint,
            )?)*
            $($(
                #[doc = concat!($bound_id, ", `", $bound_name, "`: see [`PoseScalar::", stringify!($more), "`].")]
                $bound,
            )?)*
        }

        /// Constraints with their ids, their names, and the scalars that they bound.
        pub(super) const CONSTRAINTS: &[(Constraint, &str, &str, Option<PoseScalar>)] = &[
            (Constraint::Assembly, "g1", "assembly", None),
            $($((Constraint::$constraint, $id, $name, Some(PoseScalar::$scalar)),)?)*
            $($((Constraint::$bound, $bound_id, $bound_name, Some(PoseScalar::$more)),)?)*
        ];

        /// A scalar at several poses at once, as a function of its own: few studies need it, and the loops stay short.
        struct OnDemand<'a, L, V, const SCALAR: usize> {
            checker: &'a PoseChecker<L>,
            position: Planar<V>,
            arms: &'a [Planar<V>; LEGS],
        }

        impl<L: Leg, V: Real, const SCALAR: usize> LaneJob for OnDemand<'_, L, V, SCALAR> {
            type Output = V;

            #[inline(always)]
            fn run(self) -> V {
                $(if SCALAR == PoseScalar::$more as usize {
                    return $formula(self.checker, self.position, self.arms);
                })*
                self.position.x.splat(f64::NAN)
            }
        }

        impl<L: Leg> PoseChecker<L> {
            /// Computes those scalars of a set that only some studies need, at several poses at once; meaningless where a leg does not
            /// reach the pose.
            #[inline(always)]
            pub fn fill_on_demand<V: Real>(
                &self,
                set: ScalarSet,
                position: Planar<V>,
                arms: &[Planar<V>; LEGS],
                scalars: &mut PoseScalars<V>,
            ) {
                let checker = self;
                $(if set.contains(PoseScalar::$more) {
                    let job = OnDemand::<L, V, { PoseScalar::$more as usize }> {
                        checker,
                        position,
                        arms,
                    };
                    scalars[PoseScalar::$more] = position.x.call_apart(job);
                })*
                let mut of_strength = StrengthSet::default();
                $(if set.contains(PoseScalar::$load) {
                    of_strength = of_strength.with(StrengthValue::$load);
                })*
                if !of_strength.is_empty() {
                    let values = strength::lanes(self, position, arms, of_strength);
                    $(scalars[PoseScalar::$load] = values[StrengthValue::$load as usize];)*
                }
                if PoseScalar::OF_MOTION.iter().any(|scalar| set.contains(*scalar)) {
                    dynamics::fill(self, set, position, arms, scalars);
                }
            }
        }
    };
}

pose_scalars! {
    always {
        /// g2: limit margin, the smallest distance to a joint limit or to the end of reach \[m\].
        Reach [Reach "g2" "reach_and_limits"] = PoseScalarEntry::new(
            QuantityEntry::new("reach_m", "m", "reach", Scope::Poses, Better::Higher,
                "Smallest distance to a joint limit or to the end of reach (g2).").above_zero(),
            "limit_margin").labelled("distance to the limits").per_base_radius().enclosed();
        /// g3: inverse condition number `κ_F⁻¹`.
        Dexterity [Dexterity "g3" "dexterity"] = PoseScalarEntry::new(
            QuantityEntry::new("dexterity", "", "dexterity", Scope::Poses, Better::Higher,
                "Smallest inverse condition number of the normalized Jacobian (g3).").below(1.0),
            "inverse_condition").labelled("inverse condition number").enclosed();
        /// g4: translational stiffness in the plane, `k_xy` \[N/m\].
        StiffnessXy [StiffnessXy "g4" "stiffness_xy"] = PoseScalarEntry::new(
            QuantityEntry::new("k_xy_n_per_m", "N/m", "k_xy", Scope::Poses, Better::Higher,
                "Smallest translational stiffness in the plane (g4).").logarithmic().reference(Reference::Limit(100.0)),
            "k_xy").labelled("stiffness k_xy").of_bars().enclosed();
        /// g5: translational stiffness out of the plane, `k_z` \[N/m\].
        StiffnessZ [StiffnessZ "g5" "stiffness_z"] = PoseScalarEntry::new(
            QuantityEntry::new("k_z_n_per_m", "N/m", "k_z", Scope::Poses, Better::Higher,
                "Smallest translational stiffness out of the plane (g5).").logarithmic().reference(Reference::Limit(100.0)),
            "k_z").labelled("stiffness k_z").of_bars().enclosed();
        /// g6: rotational stiffness about z, `k_φz` \[N·m/rad\].
        StiffnessPhiZ [StiffnessPhiZ "g6" "stiffness_phi_z"] = PoseScalarEntry::new(
            QuantityEntry::new("k_phi_z_nm_per_rad", "N·m/rad", "k_φz", Scope::Poses, Better::Higher,
                "Smallest rotational stiffness about z (g6).").logarithmic().reference(Reference::Limit(100.0)),
            "k_phi_z").labelled("stiffness k_φz").of_bars().enclosed();
        /// Sign rule: `det A / ℓ`, which keeps one sign over the workspace.
        Determinant [DeterminantSign "det_sign" "determinant_sign"] = PoseScalarEntry::new(
            // No study bounds the determinant at each pose: the sign rule does.
            QuantityEntry::new("determinant", "", "det A", Scope::Region, Better::Higher,
                "Smallest determinant of the direct Jacobian, divided by the characteristic length."),
            "determinant").labelled("det A / ℓ");
        /// g7: smallest clearance between members that are not joined \[m\]; negative where they overlap.
        Clearance [Clearance "g7" "clearance"] = PoseScalarEntry::new(
            QuantityEntry::new("clearance_m", "m", "clearance", Scope::Poses, Better::Higher,
                "Smallest clearance between members that are not joined (g7)."),
            "clearance").labelled("clearance between members").in_millimetres().per_base_radius().enclosed();
    }
    on_demand {
        /// Displacement of `P` under the in-plane force, in its most compliant direction \[m\].
        Displacement by displacement::lanes = PoseScalarEntry::new(
            QuantityEntry::new("displacement_max_m", "m", "largest displacement", Scope::Poses, Better::Lower,
                "Largest displacement of P under the in-plane force of the requirements, in its most compliant direction.")
                .above_zero().logarithmic().reference(Reference::Displacement(2.0)),
            "displacement").labelled("displacement under the in-plane force").in_millimetres().of_bars().enclosed();
        /// Transmission: `|B_ii|` of the leg that has the least, divided by the lever of a revolute actuator; in \[0, 1\].
        Transmission by transmission::lanes = PoseScalarEntry::new(
            QuantityEntry::new("transmission_min", "", "smallest transmission", Scope::Poses, Better::Higher,
                "Smallest transmission of a leg: the speed along its last link per unit speed of its actuated joint.")
                .above_zero().below(1.0),
            "transmission").labelled("transmission").enclosed();
        /// Radius of the smallest circle about `O` that holds the base and all members \[m\].
        Footprint by footprint::lanes = PoseScalarEntry::new(
            QuantityEntry::new("footprint_m", "m", "footprint", Scope::Region, Better::Lower,
                "Radius of the smallest circle about O that holds the base and all members at every pose of the region.")
                .reference(Reference::BaseRadius(2.0)),
            "footprint");
    }
    of_loads {
        /// Largest equivalent stress of any bar \[Pa\].
        Stress = PoseScalarEntry::new(
            QuantityEntry::new("stress_max_pa", "Pa", "largest stress", Scope::Poses, Better::Lower,
                "Largest equivalent stress of any bar of the legs or of the platform under the loads and the weight of the members.")
                .above_zero().logarithmic().reference(Reference::Number(1e9)),
            "stress").labelled("largest stress").shown_in("MPa", 1e-6).of_bars().enclosed();
        /// Yield strength divided by the largest stress.
        SafetyFactor = PoseScalarEntry::new(
            QuantityEntry::new("safety_factor_min", "", "safety factor", Scope::Poses, Better::Higher,
                "Yield strength of the material divided by the largest stress.")
                .above_zero().logarithmic().reference(Reference::Number(100.0)),
            "safety_factor").labelled("safety factor against yielding").of_bars().enclosed();
        /// Factor by which the loads may grow until the manipulator buckles; a lower bound.
        BucklingFactor = PoseScalarEntry::new(
            QuantityEntry::new("buckling_factor_min", "", "buckling factor", Scope::Poses, Better::Higher,
                "Factor by which the loads and the weight of the members may grow until the manipulator buckles; a lower bound.")
                .above_zero().logarithmic().reference(Reference::Number(1000.0)),
            "buckling_factor").labelled("factor against buckling").of_bars().enclosed();
        /// Largest force of any joint \[N\].
        JointForce = PoseScalarEntry::new(
            QuantityEntry::new("joint_force_max_n", "N", "largest joint force", Scope::Poses, Better::Lower,
                "Largest force of any joint, without the component along its actuator.")
                .above_zero().logarithmic().reference(Reference::Number(1e5)),
            "joint_force").labelled("largest force of a joint").enclosed();
        /// Largest moment of any joint \[N·m\].
        JointMoment = PoseScalarEntry::new(
            QuantityEntry::new("joint_moment_max_nm", "N·m", "largest joint moment", Scope::Poses, Better::Lower,
                "Largest moment of any joint: the tilting moment of a revolute joint, the whole moment of a prismatic joint.")
                .above_zero().logarithmic().reference(Reference::Number(1e5)),
            "joint_moment").labelled("largest moment of a joint").enclosed();
        /// Largest force of a prismatic drive \[N\].
        ActuatorForce = PoseScalarEntry::new(
            QuantityEntry::new("actuator_force_max_n", "N", "largest actuator force", Scope::Poses, Better::Lower,
                "Largest force of a prismatic actuator; revolute ones have none.")
                .above_zero().logarithmic().reference(Reference::Number(1e5)),
            "actuator_force").labelled("largest force of an actuator").enclosed();
        /// Largest torque of a revolute drive \[N·m\].
        ActuatorTorque = PoseScalarEntry::new(
            QuantityEntry::new("actuator_torque_max_nm", "N·m", "largest actuator torque", Scope::Poses, Better::Lower,
                "Largest torque of a revolute actuator; prismatic ones have none.")
                .above_zero().logarithmic().reference(Reference::Number(1e5)),
            "actuator_torque").labelled("largest torque of an actuator").enclosed();
    }
    of_motion {
        /// Lowest natural frequency \[Hz\].
        NaturalFrequency = PoseScalarEntry::new(
            QuantityEntry::new("natural_frequency_hz", "Hz", "natural frequency", Scope::Poses, Better::Higher,
                "Lowest natural frequency with the payload and with locked actuators.")
                .above_zero().logarithmic().reference(Reference::Number(1e3)),
            "natural_frequency").labelled("lowest natural frequency").of_bars().as_frequency().enclosed();
        /// Largest error of the position \[m\].
        PositionError = PoseScalarEntry::new(
            QuantityEntry::new("position_error_m", "m", "position error", Scope::Poses, Better::Lower,
                "Largest position error that the tolerances cause.")
                .above_zero().logarithmic().reference(Reference::Number(1.0)),
            "position_error").labelled("largest error of the position").in_millimetres().enclosed();
        /// Largest error of the orientation \[deg\].
        OrientationError = PoseScalarEntry::new(
            QuantityEntry::new("orientation_error_deg", "°", "orientation error", Scope::Poses, Better::Lower,
                "Largest orientation error that the tolerances cause.")
                .above_zero().logarithmic().reference(Reference::Number(90.0)),
            "orientation_error").labelled("largest error of the orientation").enclosed();
        /// Largest speed of a prismatic actuator for the motion in any direction \[m/s\].
        ActuatorSpeed = PoseScalarEntry::new(
            QuantityEntry::new("actuator_speed_max_m_per_s", "m/s", "actuator speed", Scope::Poses, Better::Lower,
                "Largest speed of a prismatic actuator for the motion in any direction that [anywhere] states.")
                .above_zero().logarithmic().reference(Reference::Number(1e3)),
            "actuator_speed").labelled("largest speed of an actuator").enclosed();
        /// Largest speed of a revolute actuator for the motion in any direction \[rad/s\].
        ActuatorRate = PoseScalarEntry::new(
            QuantityEntry::new("actuator_speed_max_rad_per_s", "rad/s", "actuator rate", Scope::Poses, Better::Lower,
                "Largest speed of a revolute actuator for the motion in any direction that [anywhere] states.")
                .above_zero().logarithmic().reference(Reference::Number(1e3)),
            "actuator_rate").labelled("largest rate of an actuator").enclosed();
        /// Largest force of a prismatic actuator for the motion and load in any direction \[N\].
        MotionForce = PoseScalarEntry::new(
            QuantityEntry::new("motion_force_max_n", "N", "force in motion", Scope::Poses, Better::Lower,
                "Largest force of a prismatic actuator for the acceleration and load in any direction that [anywhere] states.")
                .above_zero().logarithmic().reference(Reference::Number(1e6)),
            "motion_force").labelled("largest force of an actuator in motion").enclosed();
        /// Largest torque of a revolute actuator for the motion and load in any direction \[N·m\].
        MotionTorque = PoseScalarEntry::new(
            QuantityEntry::new("motion_torque_max_nm", "N·m", "torque in motion", Scope::Poses, Better::Lower,
                "Largest torque of a revolute actuator for the acceleration and load in any direction that [anywhere] states.")
                .above_zero().logarithmic().reference(Reference::Number(1e6)),
            "motion_torque").labelled("largest torque of an actuator in motion").enclosed();
    }
}

impl PoseScalar {
    /// Number of scalars.
    pub const COUNT: usize = TABLE.len();

    /// The entry of the scalar in the table.
    pub const fn entry(self) -> &'static PoseScalarEntry {
        &TABLE[self as usize]
    }

    /// Those that are computed where a study asks for them.
    pub(crate) fn on_demand() -> &'static [PoseScalar] {
        &Self::ALL[Self::ALWAYS.len()..]
    }

    /// The id of the constraint that bounds the scalar; the key of the quantity for one that has no id of its own.
    pub fn limit_id(self) -> &'static str {
        Constraint::of_scalar(self).map_or(self.entry().quantity.key, Constraint::id)
    }

    /// Returns whether the value depends on the loads of the members. Such a value does not exist at a singularity; any other that is
    /// not a number counts as the worst one.
    pub fn is_of_loads(self) -> bool {
        self.of_strength().is_some()
    }

    /// Returns the kind of actuators that have the value; `None` if all designs have it.
    pub(crate) fn of_actuators(self) -> Option<JointKind> {
        let of_strength = self.of_strength().and_then(StrengthValue::of_actuators);
        of_strength.or_else(|| self.of_motion().and_then(MotionValue::of_actuators))
    }

    /// Returns whether some designs or poses have no such value: it depends on the loads of the members, or on a motion.
    pub(crate) fn may_be_missing(self) -> bool {
        self.is_of_loads() || self.of_motion().is_some()
    }

    /// Returns whether it takes much longer than the other scalars: the same ones do that may be missing.
    pub(crate) fn takes_long(self) -> bool {
        self.may_be_missing()
    }

    /// Returns the stricter one of two limits.
    pub fn stricter(self, a: f64, b: f64) -> f64 {
        match self.entry().quantity.better {
            Better::Higher => a.max(b),
            Better::Lower => a.min(b),
        }
    }

    /// Whether a limit of the quantity bounds each pose.
    pub fn bounds_poses(self) -> bool {
        self.entry().quantity.scope == Scope::Poses
    }
}
