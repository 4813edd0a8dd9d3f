//! Mass that the bars, drives and payload oppose to a vibration (docs/model.md, section 15.4).
//!
//! A leg follows the platform as its stiffness makes it: the displacements of the ends of its bars are those of the legs under the loads
//! that displace the platform, and each bar bends between its ends as a cubic.

use super::DynamicsModel;
use super::bar_shape::{BarEnds, BarShape};
use super::displacement::{
    Coordinates, Displacement, Row, add, add_square, add_twist, combined, in_direction, lift, rotation, slope, times,
};
use super::legs::{DynamicsInputs, MovingLeg};
use crate::lanes::{LaneJob, Planar, Real, dot, scaled, sum};
use crate::spatial::LEGS;
use crate::stiffness::add_bar;
use crate::strength::bars::BarLanes;
use crate::strength::path::{BARS, DISTAL, End, PLATFORM, PathJoint};

/// What a leg contributes to the mass in the plane, as a function of its own.
struct LegInPlane<'a, V, C> {
    model: &'a DynamicsModel,
    leg: &'a MovingLeg<V>,
    compliance: V,
    coordinates: C,
}

impl<V: Real, C: Coordinates<V>> LaneJob for LegInPlane<'_, V, C> {
    type Output = [V; 6];

    #[inline(always)]
    fn run(self) -> [V; 6] {
        let mut mass = [self.compliance.splat(0.0); 6];
        self.model
            .add_leg_in_plane(&mut mass, self.leg, self.compliance, self.coordinates, |_, _| {});
        mass
    }
}

/// What a leg contributes to the mass out of the plane, as a function of its own.
struct LegOutOfPlane<'a, V, C> {
    model: &'a DynamicsModel,
    leg: &'a MovingLeg<V>,
    forces: Displacement<V>,
    coordinates: C,
}

impl<V: Real, C: Coordinates<V>> LaneJob for LegOutOfPlane<'_, V, C> {
    type Output = [V; 6];

    #[inline(always)]
    fn run(self) -> [V; 6] {
        let mut mass = [self.leg.transmission.splat(0.0); 6];
        self.model
            .add_leg_out_of_plane(&mut mass, self.leg, &self.forces, self.coordinates, |_, _| {});
        mass
    }
}

impl DynamicsModel {
    /// Returns the mass in the plane at `P`, for `x`, `y` and `φz` or other coordinates, as an upper triangle.
    #[inline(always)]
    pub(super) fn mass_in_plane<V: Real, C: Coordinates<V>>(
        &self,
        inputs: &DynamicsInputs<V>,
        legs: &[MovingLeg<V>; LEGS],
        coordinates: C,
    ) -> [V; 6] {
        let like = legs[0].transmission;
        let mut mass = [like.splat(0.0); 6];
        for (index, leg) in legs.iter().enumerate() {
            let of_leg = like.call_apart(LegInPlane {
                model: self,
                leg,
                compliance: inputs.legs.along[index],
                coordinates,
            });
            add(&mut mass, &of_leg);
        }
        let payload = &self.settings.payload;
        let centre = self.payload_centre(inputs);
        let platform = coordinates.platform(like);
        let (zero, one) = (like.splat(0.0), like.splat(1.0));
        for direction in [Planar::new(one, zero), Planar::new(zero, one)] {
            let row = in_direction(&platform, direction, centre);
            add_square(&mut mass, &row, like.splat(payload.mass));
        }
        add_square(&mut mass, &platform[2], like.splat(payload.inertia));
        mass
    }

    /// Returns the displacement of a bar's tip, at `P`, for a unit force along the line of the leg.
    #[inline(always)]
    fn give<V: Real>(&self, leg: &MovingLeg<V>, bar: usize) -> [V; 3] {
        let lanes = &leg.path.bars[bar];
        let compliance = self.compliance(bar);
        let (axis, length) = (lanes.axis, lanes.length);
        let line = Planar::new(leg.wrench[0], leg.wrench[1]);
        let tip = lanes.place(length);
        let first = self.paths[0].lever(bar, End::Base, leg.lever(lanes.base));
        let second = self.paths[0].lever(bar, End::Platform, leg.lever(tip));
        let bending = length.splat(compliance.bending);
        let stretch = length * length.splat(compliance.axial) * line.dot(axis);
        let turn = length * bending * (first + second) * length.splat(0.5);
        let across = length * length * bending * (first + first + second) * length.splat(1.0 / 6.0);
        let moved = axis.scaled(stretch).plus(axis.perp().scaled(across));
        let moved = moved.minus(tip.perp().scaled(turn));
        [moved.x, moved.y, turn]
    }

    /// Returns what the joints of a leg under a force along its line have to add to what the bars give for a unit force.
    #[inline(always)]
    fn rates<V: Real, C: Coordinates<V>>(
        &self,
        leg: &MovingLeg<V>,
        coordinates: C,
        gives: &[[V; 3]; BARS],
        force: &Row<V>,
    ) -> [Row<V>; 3] {
        let (zero, one) = (force[0].splat(0.0), force[0].splat(1.0));
        let mut given = [zero; 3];
        for bar in self.paths[0].first..BARS {
            given = sum(&given, &gives[bar]);
        }
        let mut rates = [[zero; 3]; 3];
        for joint in 0..3 {
            let taken = dot(&leg.rates[joint], &given);
            rates[joint] = combined(&coordinates.of(&leg.rates[joint]), one, force, -taken);
        }
        rates
    }

    /// Adds what a leg contributes to the mass in the plane, and shows how each of its bars moves.
    #[inline(always)]
    pub(super) fn add_leg_in_plane<V: Real, C: Coordinates<V>>(
        &self,
        mass: &mut [V; 6],
        leg: &MovingLeg<V>,
        compliance: V,
        coordinates: C,
        mut show: impl FnMut(usize, &BarEnds<V>),
    ) {
        let like = leg.transmission;
        let zero = like.splat(0.0);
        let force = scaled(&coordinates.of(&leg.wrench), like.splat(1.0) / compliance);
        let of = &self.paths[0];
        let first = of.first;
        let mut gives = [[zero; 3]; BARS];
        for bar in first..BARS {
            gives[bar] = self.give(leg, bar);
        }
        let platform = coordinates.platform(like);
        let rates = self.rates(leg, coordinates, &gives, &force);
        add_square(
            mass,
            &rates[self.driven],
            like.splat(self.settings.drives.of(self.actuator)),
        );
        let mut moved = [[zero; 3]; 3];
        let mut joint = 0;
        for bar in first..BARS {
            let mut slide = None;
            while joint < 3 && of.joints[joint].before <= bar {
                if of.joints[joint].is_bush {
                    slide = Some(joint);
                } else {
                    let before = moved;
                    add_twist(&mut moved, &leg.twists[joint], &rates[joint]);
                    self.add_points_in_plane(mass, leg, joint, [&before, &moved]);
                }
                joint += 1;
            }
            let lanes = &leg.path.bars[bar];
            let tip_place = lanes.place(lanes.length);
            let base = moved;
            if let Some(joint) = slide {
                add_twist(&mut moved, &leg.twists[joint], &rates[joint]);
                self.add_points_in_plane(mass, leg, joint, [&base, &moved]);
            }
            add_twist(&mut moved, &gives[bar], &force);
            let tip = if bar == PLATFORM { platform } else { moved };
            let (axis, normal) = (lanes.axis, lanes.axis.perp());
            let ends = BarEnds {
                base: [in_direction(&base, normal, lanes.base), base[2]],
                tip: [in_direction(&tip, normal, tip_place), tip[2]],
                along: [
                    in_direction(&base, axis, lanes.base),
                    in_direction(&tip, axis, tip_place),
                ],
            };
            self.add_bar::<V, C>(mass, lanes, bar, &ends, false);
            show(bar, &ends);
        }
    }

    /// Adds what a bar contributes to the mass, out of the plane if `is_torsion`.
    #[inline(always)]
    fn add_bar<V: Real, C: Coordinates<V>>(
        &self,
        mass: &mut [V; 6],
        lanes: &BarLanes<V>,
        bar: usize,
        ends: &BarEnds<V>,
        is_torsion: bool,
    ) {
        let gyration = self.gyration(bar);
        if C::AT_SHARES && lanes.is_uniform {
            ends.add_uniform(mass, lanes, gyration, is_torsion);
        } else {
            let shape = BarShape::new(lanes.length, ends);
            let is_telescopic = self.is_telescopic(bar);
            shape.add_pieces(mass, lanes, gyration, is_torsion, is_telescopic, C::AT_SHARES);
        }
    }

    /// Returns whether a bar consists of a tube and a rod.
    #[inline(always)]
    pub(super) fn is_telescopic(&self, bar: usize) -> bool {
        bar == DISTAL && self.paths[0].joints.iter().any(|joint| joint.is_bush)
    }

    /// Adds the point masses at a joint, before and behind which the leg moves as given.
    #[inline(always)]
    fn add_points_in_plane<V: Real>(
        &self,
        mass: &mut [V; 6],
        leg: &MovingLeg<V>,
        joint: usize,
        sides: [&Displacement<V>; 2],
    ) {
        let like = leg.transmission;
        let (zero, one) = (like.splat(0.0), like.splat(1.0));
        for point in self.points.iter().flatten().filter(|point| point.joint == joint) {
            let moved = sides[point.body - joint];
            for direction in [Planar::new(one, zero), Planar::new(zero, one)] {
                let row = in_direction(moved, direction, leg.path.joints[joint]);
                add_square(mass, &row, like.splat(point.mass));
            }
        }
    }

    /// Returns the mass out of the plane at `P`, for `z`, `φx` and `φy` or other coordinates, as an upper triangle.
    #[inline(always)]
    pub(super) fn mass_out_of_plane<V: Real, C: Coordinates<V>>(
        &self,
        inputs: &DynamicsInputs<V>,
        legs: &[MovingLeg<V>; LEGS],
        coordinates: C,
    ) -> [V; 6] {
        let like = legs[0].transmission;
        let mut mass = [like.splat(0.0); 6];
        for (index, leg) in legs.iter().enumerate() {
            let of_leg = like.call_apart(LegOutOfPlane {
                model: self,
                leg,
                forces: coordinates.forces(&inputs.legs.stiffness[index]),
                coordinates,
            });
            add(&mut mass, &of_leg);
        }
        let payload = &self.settings.payload;
        let platform = coordinates.platform(like);
        let row = lift(&platform, self.payload_centre(inputs));
        add_square(&mut mass, &row, like.splat(payload.mass));
        for row in &platform[1..] {
            add_square(&mut mass, row, like.splat(0.5 * payload.inertia));
        }
        mass
    }

    /// Adds what a leg with the given forces at `P` contributes to the mass out of the plane, and shows how each of its bars moves.
    #[inline(always)]
    pub(super) fn add_leg_out_of_plane<V: Real, C: Coordinates<V>>(
        &self,
        mass: &mut [V; 6],
        leg: &MovingLeg<V>,
        forces: &Displacement<V>,
        coordinates: C,
        mut show: impl FnMut(usize, &BarEnds<V>),
    ) {
        let like = leg.transmission;
        let zero = like.splat(0.0);
        let platform = coordinates.platform(like);
        let mut ends = [[[zero; 3]; 3], platform, platform];
        if self.paths[0].first == 0 {
            ends[0] = times(&self.compliance_of(leg, 0), forces);
        }
        // Of the whole, what is not the platform bar's: a telescopic leg may bend as one that is longer.
        let of_platform = times(&self.compliance_of(leg, PLATFORM), forces);
        for (end, taken) in ends[DISTAL].iter_mut().zip(&of_platform) {
            *end = combined(end, like.splat(1.0), taken, like.splat(-1.0));
        }
        let mut base = [[zero; 3]; 3];
        for bar in self.paths[0].first..BARS {
            let lanes = &leg.path.bars[bar];
            let tip = ends[bar];
            let tip_place = lanes.place(lanes.length);
            let moved = BarEnds {
                base: [lift(&base, lanes.base), slope(&base, lanes.axis)],
                tip: [lift(&tip, tip_place), slope(&tip, lanes.axis)],
                along: [rotation(&base, lanes.axis), rotation(&tip, lanes.axis)],
            };
            self.add_bar::<V, C>(mass, lanes, bar, &moved, true);
            show(bar, &moved);
            for point in self.points.iter().flatten() {
                let joint = &self.paths[0].joints[point.joint];
                if joint.before != bar {
                    continue;
                }
                // A bush is along the bar, all others are at its base.
                let row = match joint.is_bush {
                    true => {
                        let distance = distance_of_joint(leg, joint, point.joint, lanes);
                        BarShape::new(lanes.length, &moved).at_distance(distance)
                    }
                    false => moved.base[0],
                };
                add_square(mass, &row, like.splat(point.mass));
            }
            base = tip;
        }
    }

    /// Returns the compliance of a bar out of the plane, at `P`.
    #[inline(always)]
    fn compliance_of<V: Real>(&self, leg: &MovingLeg<V>, bar: usize) -> [V; 6] {
        let lanes = &leg.path.bars[bar];
        let mut compliance = [lanes.length.splat(0.0); 6];
        let to_p = lanes.place(lanes.length).scaled(lanes.length.splat(-1.0));
        add_bar(
            &mut compliance,
            self.compliance(bar),
            lanes.axis,
            [lanes.length; 2],
            to_p,
        );
        compliance
    }
}

/// Returns the distance of a joint from the base of the bar that it is before: a bush is along the bar, all others are at its base.
#[inline(always)]
pub(super) fn distance_of_joint<V: Real>(leg: &MovingLeg<V>, joint: &PathJoint, place: usize, bar: &BarLanes<V>) -> V {
    match joint.is_bush {
        true => leg.path.joints[place].minus(bar.base).dot(bar.axis),
        false => bar.length.splat(0.0),
    }
}
