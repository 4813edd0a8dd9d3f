//! Rates of the joints, and the forces that the actuators need for a motion (docs/model.md, sections 15.2 and 15.3).
//!
//! Velocities and accelerations are those of the points of the bodies that pass `P`, so that they add up along a chain.

use super::DynamicsModel;
use super::legs::{DynamicsInputs, MovingLeg};
use crate::enclosure::{EnclosedNumber, TaylorModel};
use crate::lanes::{LaneJob, Planar, Real, dot, less, scaled, sum};
use crate::spatial::LEGS;
use crate::strength::path::{BARS, PLATFORM};

/// Motion of a body: its twist, and the acceleration of the point that passes `P` with the angular acceleration.
#[derive(Clone, Copy)]
struct BodyMotion<V> {
    twist: [V; 3],
    acceleration: [V; 3],
}

/// Values of the actuated joint of a leg during a motion, at several poses at once.
#[derive(Clone, Copy)]
pub(super) struct DriveMotion<V> {
    /// Rate of the joint \[m/s or rad/s\].
    pub speed: V,
    /// Its rate \[m/s² or rad/s²\].
    pub acceleration: V,
    /// Force or torque of the actuator along the joint value \[N or N·m\].
    pub force: V,
}

/// Returns the velocity that a rotation about `P` at a rate gives to a place.
#[inline(always)]
fn turned<V: Real>(rate: V, place: Planar<V>) -> Planar<V> {
    place.perp().scaled(rate)
}

#[inline(always)]
fn linear<V: Real>(twist: &[V; 3]) -> Planar<V> {
    Planar::new(twist[0], twist[1])
}

impl<V: Real> BodyMotion<V> {
    /// Returns the acceleration of a place of the body.
    #[inline(always)]
    fn acceleration_of(&self, place: Planar<V>) -> Planar<V> {
        let rate = self.twist[2];
        let velocity = linear(&self.twist).plus(turned(rate, place));
        linear(&self.acceleration)
            .plus(turned(self.acceleration[2], place))
            .plus(turned(rate, velocity))
    }

    /// Returns the wrench about `P` that moves a mass at a place, against gravity.
    #[inline(always)]
    fn wrench(&self, mass: V, inertia: V, place: Planar<V>, gravity: Planar<V>) -> [V; 3] {
        let force = self.acceleration_of(place).minus(gravity).scaled(mass);
        [force.x, force.y, place.cross(force) + inertia * self.acceleration[2]]
    }
}

/// The motion of the actuated joints with the forces of the actuators, as a function of its own.
struct Drives<'a, V: Real> {
    model: &'a DynamicsModel,
    inputs: &'a DynamicsInputs<V>,
    legs: &'a [MovingLeg<V>; LEGS],
    twist: [V; 3],
    acceleration: [V; 3],
    loads: (Planar<V>, [V; 3]),
}

impl<V: Real> LaneJob for Drives<'_, V> {
    type Output = [DriveMotion<V>; LEGS];

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Self {
            model, inputs, legs, ..
        } = self;
        let (twist, acceleration, (gravity, tool)) = (self.twist, self.acceleration, self.loads);
        let like = twist[0];
        let platform = platform_motion(twist, acceleration);
        let mut needed = less(&model.platform_wrench(inputs, legs, &platform, gravity), &tool);
        let mut drives = [DriveMotion {
            speed: like,
            acceleration: like,
            force: like,
        }; LEGS];
        for (index, leg) in legs.iter().enumerate() {
            let (motions, rates) = chain_motion(leg, &platform);
            let forces = model.joint_forces(leg, &motions, gravity);
            for joint in 0..LEGS {
                needed = sum(&needed, &scaled(&leg.rates[joint], forces[joint]));
            }
            let rotor = rates[model.driven] * like.splat(model.settings.drives.of(model.actuator));
            needed = sum(&needed, &scaled(&leg.rates[model.driven], rotor));
            drives[index].speed = dot(&leg.rates[model.driven], &twist);
            drives[index].acceleration = rates[model.driven];
        }
        for (drive, leg) in drives.iter_mut().zip(legs) {
            drive.force = leg.transmission * dot(&leg.column, &needed);
        }
        drives
    }
}

impl DynamicsModel {
    /// Returns the motion of the actuated joints, and the forces of the actuators, for a twist and an acceleration of the platform at `P`.
    #[inline(always)]
    pub(super) fn drives<V: Real>(
        &self,
        inputs: &DynamicsInputs<V>,
        legs: &[MovingLeg<V>; LEGS],
        twist: [V; 3],
        acceleration: [V; 3],
        loads: (Planar<V>, [V; 3]),
    ) -> [DriveMotion<V>; LEGS] {
        twist[0].call_apart(Drives {
            model: self,
            inputs,
            legs,
            twist,
            acceleration,
            loads,
        })
    }

    /// Encloses the rate of each actuated joint, and the force of its actuator, over an interval of a motion under the loads of the
    /// settings.
    pub fn enclose_drives(
        &self,
        inputs: &DynamicsInputs<EnclosedNumber>,
        twist: [EnclosedNumber; 3],
        acceleration: [EnclosedNumber; 3],
    ) -> [[TaylorModel; 2]; LEGS] {
        let legs = self.legs(inputs);
        let zero = twist[0].splat(0.0);
        let loads = (self.gravity(zero), self.settings.tool.map(|part| zero.splat(part)));
        let drives = self.drives(inputs, &legs, twist, acceleration, loads);
        drives.map(|drive| [drive.speed.0, drive.force.0])
    }

    /// Returns the wrench about `P` that moves the platform with its payload.
    #[inline(always)]
    fn platform_wrench<V: Real>(
        &self,
        inputs: &DynamicsInputs<V>,
        legs: &[MovingLeg<V>; LEGS],
        platform: &BodyMotion<V>,
        gravity: Planar<V>,
    ) -> [V; 3] {
        let like = platform.twist[0];
        let payload = &self.settings.payload;
        let centre = self.payload_centre(inputs);
        let mut wrench = platform.wrench(like.splat(payload.mass), like.splat(payload.inertia), centre, gravity);
        for leg in legs {
            wrench = sum(&wrench, &self.bar_wrench(leg, PLATFORM, 0, platform, gravity));
        }
        wrench
    }

    /// Returns the centre of mass of the payload, relative to `P`.
    #[inline(always)]
    pub(super) fn payload_centre<V: Real>(&self, inputs: &DynamicsInputs<V>) -> Planar<V> {
        let turn = self.turn(inputs);
        let [x, y] = self.settings.payload.centre;
        let (x, y) = (turn.x.splat(x), turn.x.splat(y));
        turn.scaled(x).plus(turn.perp().scaled(y))
    }

    /// Returns the wrench about `P` that moves a piece of a bar.
    #[inline(always)]
    fn bar_wrench<V: Real>(
        &self,
        leg: &MovingLeg<V>,
        bar: usize,
        piece: usize,
        motion: &BodyMotion<V>,
        gravity: Planar<V>,
    ) -> [V; 3] {
        let lanes = &leg.path.bars[bar];
        let span = &lanes.pieces[piece];
        let length = span.to - span.from;
        let mass = length * length.splat(span.density);
        let middle = (span.from + span.to) * length.splat(0.5);
        let gyration = length * length * length.splat(1.0 / 12.0) + length.splat(self.gyration(bar));
        motion.wrench(mass, mass * gyration, lanes.place(middle), gravity)
    }

    /// Returns the force that each joint of a leg would need to move the bodies beyond it, without the platform.
    #[inline(always)]
    fn joint_forces<V: Real>(&self, leg: &MovingLeg<V>, motions: &[BodyMotion<V>; 3], gravity: Planar<V>) -> [V; 3] {
        let zero = leg.transmission.splat(0.0);
        let mut forces = [zero; 3];
        for bar in self.paths[0].first..BARS - 1 {
            for piece in 0..2 {
                let body = self.bodies[bar][piece];
                if leg.path.bars[bar].pieces[piece].density == 0.0 || body == 0 {
                    continue;
                }
                let wrench = self.bar_wrench(leg, bar, piece, &motions[body - 1], gravity);
                add_power(&mut forces, leg, body, &wrench);
            }
        }
        for point in self.points.iter().flatten() {
            let place = leg.path.joints[point.joint];
            let wrench = motions[point.body - 1].wrench(zero.splat(point.mass), zero, place, gravity);
            add_power(&mut forces, leg, point.body, &wrench);
        }
        forces
    }

    /// Returns the mass matrix at `P`, as columns.
    #[inline(always)]
    pub(super) fn rigid_mass<V: Real>(&self, inputs: &DynamicsInputs<V>, legs: &[MovingLeg<V>; LEGS]) -> [[V; 3]; 3] {
        let (zero, one) = (legs[0].transmission.splat(0.0), legs[0].transmission.splat(1.0));
        let mut mass = [[zero; 3]; 3];
        for (component, column) in mass.iter_mut().enumerate() {
            let mut acceleration = [zero; 3];
            acceleration[component] = one;
            let nothing = (Planar::new(zero, zero), [zero; 3]);
            let drives = self.drives(inputs, legs, [zero; 3], acceleration, nothing);
            for (drive, leg) in drives.iter().zip(legs) {
                *column = sum(column, &scaled(&leg.wrench, drive.force / leg.transmission));
            }
        }
        mass
    }
}

/// Adds the power of a wrench on a body for a unit rate of each joint before it.
#[inline(always)]
fn add_power<V: Real>(forces: &mut [V; 3], leg: &MovingLeg<V>, body: usize, wrench: &[V; 3]) {
    for (force, twist) in forces.iter_mut().zip(&leg.twists).take(body) {
        *force = *force + dot(twist, wrench);
    }
}

/// Returns the motion of the platform for a twist and an acceleration of `P`, which moves with it.
#[inline(always)]
fn platform_motion<V: Real>(twist: [V; 3], acceleration: [V; 3]) -> BodyMotion<V> {
    let towards = turned(twist[2], linear(&twist));
    BodyMotion {
        twist,
        acceleration: [
            acceleration[0] - towards.x,
            acceleration[1] - towards.y,
            acceleration[2],
        ],
    }
}

/// Returns the motions of the bodies of a leg behind each of its joints, and the accelerations of the joints.
#[inline(always)]
fn chain_motion<V: Real>(leg: &MovingLeg<V>, platform: &BodyMotion<V>) -> ([BodyMotion<V>; 3], [V; 3]) {
    let zero = leg.transmission.splat(0.0);
    let mut twist = [zero; 3];
    let mut drift = [zero; 3];
    let mut motions = [BodyMotion {
        twist,
        acceleration: drift,
    }; 3];
    // What accelerates the bodies while no rate of a joint changes: the axes of the joints move with the bodies before them.
    for joint in 0..3 {
        let axis = &leg.twists[joint];
        let rate = dot(&leg.rates[joint], &platform.twist);
        let carried = turned(twist[2], linear(axis)).minus(turned(axis[2], linear(&twist)));
        drift = [drift[0] + rate * carried.x, drift[1] + rate * carried.y, drift[2]];
        twist = sum(&twist, &scaled(axis, rate));
        motions[joint] = BodyMotion {
            twist,
            acceleration: drift,
        };
    }
    let left = less(&platform.acceleration, &drift);
    let mut added = [zero; 3];
    let mut rates = [zero; 3];
    for joint in 0..3 {
        rates[joint] = dot(&leg.rates[joint], &left);
        added = sum(&added, &scaled(&leg.twists[joint], rates[joint]));
        motions[joint].acceleration = sum(&motions[joint].acceleration, &added);
    }
    (motions, rates)
}
