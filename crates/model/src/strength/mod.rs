//! Strength and buckling of the members, and the forces of joints and drives, at a pose (docs/model.md, section 14).
//!
//! The model is the statics of that of `stiffness`. A leg transmits one force along its line in the plane; out of the plane, the legs
//! share the load by their compliances. All values are the worst of a set of wrenches together with the weight of the members. They are
//! written over [`Real`], so that a report of one pose and an evaluation of many use the same formulas.

pub(crate) mod bars;
mod buckling;
mod inputs;
mod joints;
pub(crate) mod path;
mod report;
mod resultants;
mod sag;
mod settings;
mod stress;

pub(crate) use inputs::{LegLoadPath, LegStiffness, StrengthInputs};
pub use report::{JointStrength, MemberStrength, StrengthReport};
pub use settings::{LoadShape, Loads};

use crate::enclosure::{EnclosedNumber, Interval, TaylorModel};
use crate::lanes::{LaneJob, Real};
use crate::mechanism::{CrossSection, CrossSections, Design, JointKind, LegSettings};
use crate::spatial::LEGS;
use crate::stiffness::{BarCompliance, Material, StiffnessModel};
use path::{BarSection, LegPath, PLATFORM};
use resultants::LoadedLegs;

/// Largest factor against buckling, and against yielding, that is reported: it stands for members without load.
pub const LARGEST_FACTOR: f64 = 1e6;

/// What the strength of one design depends on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StrengthModel {
    loads: Loads,
    /// `f_y` \[Pa\], if the study states one.
    yield_strength: Option<f64>,
    sections: [BarSection; 2],
    paths: [LegPath; LEGS],
    /// Kind of the actuated joints.
    actuator: JointKind,
    /// Whether the rails bend, whose share in buckling is unknown.
    is_on_bending_rails: bool,
}

/// A value of the strength at a pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum StrengthValue {
    Stress,
    SafetyFactor,
    BucklingFactor,
    JointForce,
    JointMoment,
    ActuatorForce,
    ActuatorTorque,
}

impl StrengthValue {
    /// All values.
    const ALL: [StrengthValue; 7] = [
        StrengthValue::Stress,
        StrengthValue::SafetyFactor,
        StrengthValue::BucklingFactor,
        StrengthValue::JointForce,
        StrengthValue::JointMoment,
        StrengthValue::ActuatorForce,
        StrengthValue::ActuatorTorque,
    ];

    /// Number of values.
    pub const COUNT: usize = Self::ALL.len();

    /// Returns whether a design has the value: drives have either forces or torques, a safety factor needs a yield strength, and the
    /// share of rails that bend in buckling is not known.
    #[inline(always)]
    pub fn exists(self, yield_strength: Option<f64>, actuator: JointKind, is_on_bending_rails: bool) -> bool {
        match self {
            StrengthValue::SafetyFactor => yield_strength.is_some(),
            StrengthValue::BucklingFactor => !is_on_bending_rails,
            _ => self.of_actuators().is_none_or(|kind| kind == actuator),
        }
    }

    /// Returns the kind of actuators that have the value; `None` if all designs have it.
    #[inline(always)]
    pub fn of_actuators(self) -> Option<JointKind> {
        match self {
            StrengthValue::ActuatorForce => Some(JointKind::Prismatic),
            StrengthValue::ActuatorTorque => Some(JointKind::Revolute),
            _ => None,
        }
    }

    /// Returns no value of any kind.
    #[inline(always)]
    pub fn none<V: Real>(like: V) -> [V; Self::COUNT] {
        let mut none = [like; Self::COUNT];
        for value in Self::ALL {
            none[value as usize] = like.splat(value.worst());
        }
        none
    }

    /// Returns the worst number, which stands for no value.
    pub fn worst(self) -> f64 {
        match self {
            StrengthValue::SafetyFactor | StrengthValue::BucklingFactor => f64::NEG_INFINITY,
            _ => f64::INFINITY,
        }
    }
}

/// Values of the strength, which share most of their computation.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct StrengthSet(u8);

impl StrengthSet {
    /// Returns whether the set contains any of some values.
    #[inline(always)]
    fn contains_any<const N: usize>(self, values: [StrengthValue; N]) -> bool {
        values.into_iter().any(|value| self.0 & (1 << value as u8) != 0)
    }

    /// Returns the set with a value.
    #[inline(always)]
    pub fn with(self, value: StrengthValue) -> Self {
        Self(self.0 | 1 << value as u8)
    }

    /// Returns whether the set is empty.
    #[inline(always)]
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }
}

/// Computation of some values at several poses, as a function of its own.
pub(crate) struct StrengthJob<'a, V: Real> {
    pub model: &'a StrengthModel,
    pub inputs: &'a StrengthInputs<V>,
    pub set: StrengthSet,
}

impl<V: Real> LaneJob for StrengthJob<'_, V> {
    type Output = [V; StrengthValue::COUNT];

    #[inline(always)]
    fn run(self) -> Self::Output {
        let paths = self.model.paths_at(self.inputs);
        let legs = self.model.legs(self.inputs, &paths);
        let loaded = self.model.loaded(&legs);
        self.model.values(&loaded, self.inputs, self.set)
    }
}

impl StrengthModel {
    /// Prepares a design whose stiffness is known.
    pub fn new(
        design: &Design,
        settings: &LegSettings,
        material: &Material,
        sections: &CrossSections,
        stiffness: &StiffnessModel,
        loads: &Loads,
    ) -> Self {
        let of = |section: &CrossSection, radius: f64, compliance: BarCompliance| BarSection {
            compliance,
            per_area: 1.0 / section.area(radius),
            bending: radius / section.inertia(radius),
            torsion: section.torsion_radius(radius) / section.torsion_constant(radius),
            is_square: section.is_square(),
            mass_per_length: section.mass_per_length(material.density, radius),
        };
        let [leg_bar, platform_bar] = stiffness.bars_of_design();
        let legs = of(&sections.legs, design.leg_bar_radius(), leg_bar);
        let platform = of(&sections.platform, design.platform_bar_radius(), platform_bar);
        let masses = [legs.mass_per_length, platform.mass_per_length];
        Self {
            loads: *loads,
            yield_strength: material.yield_strength,
            sections: [legs, platform],
            paths: [0, 1, 2].map(|index| LegPath::new(design, settings, index, masses)),
            actuator: design.architecture().actuator(),
            is_on_bending_rails: stiffness.is_on_bending_rails(),
        }
    }

    /// Returns the model under a single wrench.
    pub fn with_wrench(self, wrench: [f64; 6]) -> Self {
        Self {
            loads: self.loads.with_wrench(wrench),
            ..self
        }
    }

    /// Returns whether the members weigh something.
    #[inline(always)]
    fn weighs(&self) -> bool {
        self.loads.weighs() != [false; 2]
    }

    /// Returns the first bar of a leg.
    #[inline(always)]
    fn first(&self) -> usize {
        self.paths[0].first
    }

    /// Returns the section of a bar.
    #[inline(always)]
    fn section(&self, bar: usize) -> &BarSection {
        &self.sections[usize::from(bar == PLATFORM)]
    }

    /// Returns what the limits of a set bound from above at several poses at once, in the order of [`StrengthValue`]: the stress for the
    /// safety factor, and the reciprocal of the factor against buckling; for all others, the worst number, which is infinite. Bars that
    /// nowhere exceed the stress `kept` are left out.
    #[inline(always)]
    fn demands<V: Real>(
        &self,
        loaded: &LoadedLegs<'_, V>,
        inputs: &StrengthInputs<V>,
        set: StrengthSet,
        kept: Option<f64>,
    ) -> [V; StrengthValue::COUNT] {
        let mut found = StrengthValue::none(inputs.legs[0].moment);
        if set.contains_any([StrengthValue::Stress, StrengthValue::SafetyFactor]) {
            let stress = self.largest_stress(&loaded.legs, kept);
            found[StrengthValue::Stress as usize] = stress;
            found[StrengthValue::SafetyFactor as usize] = stress;
        }
        if set.contains_any([StrengthValue::BucklingFactor]) {
            let columns = self.columns(loaded, inputs);
            found[StrengthValue::BucklingFactor as usize] = self.buckling_demand(&columns);
        }
        if set.contains_any([StrengthValue::JointForce, StrengthValue::JointMoment]) {
            let [force, moment] = self.largest_joint_loads(&loaded.legs);
            found[StrengthValue::JointForce as usize] = force;
            found[StrengthValue::JointMoment as usize] = moment;
        }
        if set.contains_any([StrengthValue::ActuatorForce, StrengthValue::ActuatorTorque]) {
            let effort = self.largest_effort(&loaded.legs);
            found[StrengthValue::ActuatorForce as usize] = effort;
            found[StrengthValue::ActuatorTorque as usize] = effort;
        }
        found
    }

    /// Encloses what the limits of a set bound from above over a box of poses, as [`StrengthModel::demands`]. The stress `kept`
    /// is one that the limits allow: a smaller one may be enclosed too low, because bars that nowhere exceed it are left out.
    pub fn enclose(
        &self,
        inputs: &StrengthInputs<EnclosedNumber>,
        set: StrengthSet,
        kept: Option<f64>,
    ) -> [TaylorModel; StrengthValue::COUNT] {
        let paths = self.paths_at(inputs);
        let legs = self.legs(inputs, &paths);
        self.demands(&self.loaded(&legs), inputs, set, kept)
            .map(|number| number.0)
    }

    /// Returns the largest demand with which a value keeps its limit; `None` if the design has no such value, or none as good.
    pub fn demand_limit(&self, value: StrengthValue, limit: f64) -> Option<Interval> {
        let limit =
            Some(limit).filter(|_| value.exists(self.yield_strength, self.actuator, self.is_on_bending_rails))?;
        let is_factor = matches!(value, StrengthValue::SafetyFactor | StrengthValue::BucklingFactor);
        if is_factor && limit > LARGEST_FACTOR {
            return None;
        }
        let bound = Interval::exactly(limit);
        Some(match value {
            StrengthValue::SafetyFactor => Interval::exactly(self.yield_strength?) / bound,
            StrengthValue::BucklingFactor => Interval::exactly(1.0) / bound,
            _ => bound,
        })
    }

    /// Returns the values of a set at several poses at once, in the order of [`StrengthValue`]; where there is none, and for all
    /// others, the worst number, which is infinite.
    #[inline(always)]
    fn values<V: Real>(
        &self,
        loaded: &LoadedLegs<'_, V>,
        inputs: &StrengthInputs<V>,
        set: StrengthSet,
    ) -> [V; StrengthValue::COUNT] {
        let like = inputs.legs[0].moment;
        let mut found = self.demands(loaded, inputs, set, None);
        if set.contains_any([StrengthValue::Stress, StrengthValue::SafetyFactor]) {
            let stress = &mut found[StrengthValue::SafetyFactor as usize];
            *stress = self.safety_factor(*stress);
        }
        if set.contains_any([StrengthValue::BucklingFactor]) {
            let reciprocal = &mut found[StrengthValue::BucklingFactor as usize];
            *reciprocal = buckling::factor(*reciprocal);
        }
        // A comparison loses what is not a number; a sum keeps it.
        let check = loaded.check();
        let infinite = like.splat(f64::INFINITY);
        for value in StrengthValue::ALL {
            let none = like.splat(value.worst());
            let number = &mut found[value as usize];
            let is_known = infinite.exceeds((*number + check).abs());
            *number = if value.exists(self.yield_strength, self.actuator, self.is_on_bending_rails) {
                number.select(is_known, none)
            } else {
                none
            };
        }
        found
    }

    /// Returns the factor by which the stress may grow.
    #[inline(always)]
    fn safety_factor<V: Real>(&self, stress: V) -> V {
        let yields = stress.splat(self.yield_strength.unwrap_or(f64::NAN));
        (yields / stress).smaller(yields.splat(LARGEST_FACTOR))
    }
}
