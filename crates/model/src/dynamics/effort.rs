//! What the motion of a design asks of its actuators at several poses at once, whatever its direction (docs/model.md, section 15.7).

use super::displacement::Own;
use super::frequency::lowest_frequency;
use super::legs::{DynamicsInputs, MovingLeg};
use super::{Anywhere, DynamicsModel, DynamicsSettings, Tolerances};
use crate::enclosure::{EnclosedNumber, TaylorModel};
use crate::lanes::{LaneJob, Real, dot, scaled};
use crate::mechanism::JointKind;
use crate::spatial::LEGS;

/// A value of the motion at a pose that a study may limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum MotionValue {
    NaturalFrequency,
    PositionError,
    OrientationError,
    ActuatorSpeed,
    ActuatorRate,
    MotionForce,
    MotionTorque,
}

impl MotionValue {
    /// All values, those that take the fewest operations first.
    pub const ALL: [MotionValue; 7] = [
        MotionValue::ActuatorSpeed,
        MotionValue::ActuatorRate,
        MotionValue::MotionForce,
        MotionValue::MotionTorque,
        MotionValue::OrientationError,
        MotionValue::PositionError,
        MotionValue::NaturalFrequency,
    ];

    /// Returns the kind of actuators that have the value; `None` if all designs have it.
    #[inline(always)]
    pub fn of_actuators(self) -> Option<JointKind> {
        match self {
            MotionValue::ActuatorSpeed | MotionValue::MotionForce => Some(JointKind::Prismatic),
            MotionValue::ActuatorRate | MotionValue::MotionTorque => Some(JointKind::Revolute),
            _ => None,
        }
    }

    /// Returns whether designs with actuators of a kind have the value.
    #[inline(always)]
    pub fn exists(self, actuator: JointKind) -> bool {
        self.of_actuators().is_none_or(|kind| kind == actuator)
    }

    /// Returns whether the settings ask for something of which the value tells: it is 0 everywhere otherwise.
    pub fn is_asked(self, settings: &DynamicsSettings) -> bool {
        match self {
            MotionValue::NaturalFrequency => true,
            MotionValue::PositionError | MotionValue::OrientationError => settings.tolerances != Tolerances::default(),
            MotionValue::ActuatorSpeed
            | MotionValue::ActuatorRate
            | MotionValue::MotionForce
            | MotionValue::MotionTorque => settings.anywhere != Anywhere::default(),
        }
    }

    /// Returns the worst number, which stands for no value.
    pub fn worst(self) -> f64 {
        match self {
            MotionValue::NaturalFrequency => f64::NEG_INFINITY,
            _ => f64::INFINITY,
        }
    }
}

/// Computation of a value at several poses at once, as a function of its own.
pub(crate) struct MotionJob<'a, V: Real> {
    pub model: &'a DynamicsModel,
    pub inputs: &'a DynamicsInputs<V>,
    pub value: MotionValue,
}

impl<V: Real> LaneJob for MotionJob<'_, V> {
    type Output = V;

    #[inline(always)]
    fn run(self) -> V {
        let Self { model, inputs, value } = self;
        let legs = model.legs(inputs);
        let found = match value {
            MotionValue::NaturalFrequency => model.lowest_frequency(inputs, &legs),
            _ => model.demand(inputs, &legs, value),
        };
        // A value that is not a number is the worst one.
        let is_known = found.splat(f64::INFINITY).exceeds(found.abs());
        found.select(is_known, found.splat(value.worst()))
    }
}

impl DynamicsModel {
    /// Encloses what a limit bounds from above over a box of poses: all of several values, of which the largest is the demand. The error of
    /// the position has one for each direction, because the largest of many enclosures that are nearly equal is wide.
    pub fn enclose(
        &self,
        inputs: &DynamicsInputs<EnclosedNumber>,
        legs: &[MovingLeg<EnclosedNumber>; LEGS],
        value: MotionValue,
    ) -> Vec<TaylorModel> {
        match value {
            MotionValue::PositionError => {
                let errors = self.leg_errors(inputs, legs);
                self.position_errors(&errors).map(|error| error.0).collect()
            }
            _ => vec![self.demand(inputs, legs, value).0],
        }
    }

    /// Returns a value that a limit bounds from above, at several poses at once; not a number where there is none.
    #[inline(always)]
    pub(super) fn demand<V: Real>(
        &self,
        inputs: &DynamicsInputs<V>,
        legs: &[MovingLeg<V>; LEGS],
        value: MotionValue,
    ) -> V {
        match value {
            MotionValue::NaturalFrequency => legs[0].transmission.splat(f64::NAN),
            MotionValue::PositionError => self.worst_position(&self.leg_errors(inputs, legs)).0,
            MotionValue::OrientationError => {
                let error = self.worst_orientation(&self.leg_errors(inputs, legs));
                error * error.splat(180.0 / std::f64::consts::PI)
            }
            MotionValue::ActuatorSpeed | MotionValue::ActuatorRate => {
                let driven = self.driven;
                self.largest_speed(&[legs[0].rates[driven], legs[1].rates[driven], legs[2].rates[driven]])
            }
            MotionValue::MotionForce | MotionValue::MotionTorque => {
                let rigid = self.rigid_mass(inputs, legs);
                self.largest_force(inputs, legs, &self.effort_rows(legs, &rigid))
            }
        }
    }
}

/// Rows of the matrices that give the effort of each actuator for a motion or a load at several poses at once.
pub(super) struct EffortRows<V> {
    /// `B⁻¹A`: speeds for a twist.
    pub speed: [[V; 3]; LEGS],
    /// `B A⁻ᵀ`: forces for a wrench.
    pub force: [[V; 3]; LEGS],
    /// Forces for an acceleration from rest.
    pub inertia: [[V; 3]; LEGS],
}

/// Returns the length of the linear part of a row.
#[inline(always)]
pub(super) fn norm<V: Real>(row: &[V; 3]) -> V {
    (row[0] * row[0] + row[1] * row[1]).sqrt()
}

impl DynamicsModel {
    /// Returns the effort of the actuators for a motion or a load, given the columns of the mass of the rigid bodies.
    #[inline(always)]
    pub(super) fn effort_rows<V: Real>(&self, legs: &[MovingLeg<V>; LEGS], rigid: &[[V; 3]; 3]) -> EffortRows<V> {
        let zero = legs[0].transmission.splat(0.0);
        let mut rows = EffortRows {
            speed: [[zero; 3]; LEGS],
            force: [[zero; 3]; LEGS],
            inertia: [[zero; 3]; LEGS],
        };
        for (index, leg) in legs.iter().enumerate() {
            let force = scaled(&leg.column, leg.transmission);
            rows.speed[index] = leg.rates[self.driven];
            rows.force[index] = force;
            for component in 0..3 {
                rows.inertia[index][component] = dot(&force, &rigid[component]);
            }
        }
        rows
    }

    /// Returns the largest speed of an actuator for the motion in any direction.
    #[inline(always)]
    pub(super) fn largest_speed<V: Real>(&self, rows: &[[V; 3]; LEGS]) -> V {
        let Anywhere { velocity, omega, .. } = self.settings.anywhere;
        let mut most = rows[0][0].splat(0.0);
        for row in rows {
            most = most.larger(norm(row) * most.splat(velocity) + row[2].abs() * most.splat(omega));
        }
        most
    }

    /// Returns the largest force of an actuator for the motion and load in any direction, from rest.
    #[inline(always)]
    pub(super) fn largest_force<V: Real>(
        &self,
        inputs: &DynamicsInputs<V>,
        legs: &[MovingLeg<V>; LEGS],
        rows: &EffortRows<V>,
    ) -> V {
        let anywhere = &self.settings.anywhere;
        let zero = legs[0].transmission.splat(0.0);
        let held = self.drives(inputs, legs, [zero; 3], [zero; 3], (self.gravity(zero), [zero; 3]));
        let mut most = zero;
        for leg in 0..LEGS {
            let (inertia, force) = (&rows.inertia[leg], &rows.force[leg]);
            let effort = norm(inertia) * zero.splat(anywhere.acceleration)
                + inertia[2].abs() * zero.splat(anywhere.alpha)
                + norm(force) * zero.splat(anywhere.force)
                + force[2].abs() * zero.splat(anywhere.moment)
                + held[leg].force.abs();
            most = most.larger(effort);
        }
        most
    }

    /// Returns the lowest natural frequency \[Hz\]; no number on rails that bend.
    #[inline(always)]
    pub(super) fn lowest_frequency<V: Real>(&self, inputs: &DynamicsInputs<V>, legs: &[MovingLeg<V>; LEGS]) -> V {
        if self.is_on_bending_rails {
            return legs[0].transmission.splat(f64::NAN);
        }
        let in_plane = lowest_frequency(&inputs.legs.in_plane(), &self.mass_in_plane(inputs, legs, Own));
        let out_of_plane = lowest_frequency(&inputs.legs.out_of_plane(), &self.mass_out_of_plane(inputs, legs, Own));
        // A sum keeps what is not a number, which a comparison loses.
        in_plane.smaller(out_of_plane) + (in_plane + out_of_plane) * in_plane.splat(0.0)
    }
}
