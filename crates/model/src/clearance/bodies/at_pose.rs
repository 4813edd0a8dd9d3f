//! The bodies at one posture: the nearest pair, capsules and joints.

use glam::{DVec2, DVec3};

use super::super::capsule::{Capsule, Clearance, MemberId, Neighbour, UprightBody};
use super::super::distance::nearest_points;
use super::super::places::MEMBERS;
use super::super::surroundings::Barrier;
use super::lanes::{Axes, members};
use super::{Bodies, Pair};
use crate::lanes::Planar;
use crate::mechanism::{DistalLanes, Leg, Manipulator, MemberAxis, Members, Posture};
use crate::spatial::{LEGS, NUMBER_LIMIT};

/// A pair of bodies that may be the nearest.
enum Nearest<'a> {
    /// The slider of a leg and an end of its rail (0 or 1), with their distance.
    RailEnd(usize, usize, f64),
    /// Two bodies.
    Pair(&'a Pair),
    /// The body of a place and what stands beside it.
    Barrier(usize, &'a Barrier),
}

/// A member, what it is nearest to, and points of both as [`Clearance`] has them.
type Between = (MemberId, Neighbour, [DVec3; 2]);

impl Bodies {
    /// Returns the joints and motors that are bodies, at a posture with `P` at `position`.
    pub fn joints<L: Leg>(&self, manipulator: &Manipulator<L>, position: DVec2, posture: &Posture) -> Vec<UprightBody> {
        let (_, axes) = self.laid_out(manipulator, position, posture);
        let joints = self.uprights.iter().enumerate().map(|(index, (upright, heights))| {
            let place = MEMBERS + index;
            let at = self.point(&axes, place).from;
            UprightBody {
                member: self.member(place),
                at: DVec2::new(at.x, at.y),
                radius: upright.radius,
                heights: *heights,
            }
        });
        joints.collect()
    }

    /// Returns the radius of a member or joint \[m\]; 0 if there is no such body.
    pub fn radius_of(&self, member: &MemberId) -> f64 {
        let place = self.places().find(|&place| self.member(place) == *member);
        place.map_or(0.0, |place| self.size(place).radius)
    }

    /// Returns the nearest pair at a posture with `P` at `position`.
    pub fn nearest<L: Leg>(&self, manipulator: &Manipulator<L>, position: DVec2, posture: &Posture) -> Clearance {
        let (members, axes) = self.laid_out(manipulator, position, posture);
        let (distance, found) = self.find_nearest(&members, &axes);
        let (member, neighbour, between) = match found {
            Nearest::RailEnd(leg, end, way) => self.at_rail_end(&axes[leg], [leg, end], way),
            Nearest::Barrier(place, barrier) => self.beside(&self.axis(&axes, place), place, barrier),
            Nearest::Pair(pair) => self.between(pair.places.map(|place| self.axis(&axes, place)), pair),
        };
        Clearance {
            distance,
            member,
            neighbour,
            between,
        }
    }

    /// Returns the distance of the nearest pair, and which it is.
    fn find_nearest(&self, members: &[Members<f64>; LEGS], axes: &Axes<f64>) -> (f64, Nearest<'_>) {
        let ends = members.iter().enumerate().flat_map(|(leg, members)| {
            let of_rail = members.rail.iter().flatten().enumerate();
            of_rail.map(move |(end, &way)| (way - self.slider[0], Nearest::RailEnd(leg, end, way)))
        });
        let pairs = self.pairs.iter().map(|pair| {
            let [first, second] = pair.places.map(|place| self.axis(axes, place));
            (Self::gap(pair, &first, &second), Nearest::Pair(pair))
        });
        let places = self.places();
        let beside = places.flat_map(|place| self.barriers.iter().map(move |barrier| (place, barrier)));
        let beside = beside.map(|(place, barrier)| {
            let distance = barrier.clearance(&self.axis(axes, place), &self.size(place));
            (distance, Nearest::Barrier(place, barrier))
        });
        ends.chain(pairs)
            .chain(beside)
            .map(|(distance, found)| (distance.clamp(-NUMBER_LIMIT, NUMBER_LIMIT), found))
            .reduce(|least, next| if next.0 < least.0 { next } else { least })
            .expect("a manipulator has pairs of members")
    }

    /// Returns the axis of a member or joint.
    fn axis(&self, axes: &Axes<f64>, place: usize) -> MemberAxis<f64> {
        match place < MEMBERS {
            true => axes[place],
            false => self.point(axes, place),
        }
    }

    /// Returns what is between a slider and an end of its rail, which is `way` from the centre of the slider.
    fn at_rail_end(&self, slider: &MemberAxis<f64>, [leg, end]: [usize; 2], way: f64) -> Between {
        let outwards = if end == 0 { -1.0 } else { 1.0 };
        let middle = slider.from.plus(slider.direction.scaled(0.5 * slider.length));
        let at = |along: f64| self.lift(middle.plus(slider.direction.scaled(outwards * along)), leg);
        let anchor = (leg + end) % LEGS;
        let neighbour = Neighbour::RailEnd { leg, anchor };
        (self.member(leg), neighbour, [at(self.slider[0]), at(way)])
    }

    /// Returns what is between a body and what stands beside the manipulator.
    fn beside(&self, axis: &MemberAxis<f64>, place: usize, barrier: &Barrier) -> Between {
        let [on_axis, on_outline] = barrier.nearest_points(axis);
        let of_barrier = barrier.heights;
        let of_body = self.size(place).heights;
        let height = 0.5 * (of_body[0] + of_body[1]);
        let on_barrier = height.max(of_barrier[0]).min(of_barrier[1]);
        let between = [
            on_axis.extend(on_barrier.max(of_body[0]).min(of_body[1])),
            on_outline.extend(on_barrier),
        ];
        (self.member(place), barrier.neighbour.clone(), between)
    }

    /// Returns what is between two bodies.
    fn between(&self, axes: [MemberAxis<f64>; 2], pair: &Pair) -> Between {
        let [first, second] = axes.map(|axis| [axis.from, axis.to()].map(|end| DVec2::new(end.x, end.y)));
        let [member, neighbour] = pair.places.map(|place| self.member(place));
        let [heights, other_heights] = pair.places.map(|place| self.size(place).heights);
        // Points at the same height, if the bodies have one in common.
        let height = (0.5 * (other_heights[0] + other_heights[1]))
            .max(heights[0])
            .min(heights[1]);
        let other_height = height.max(other_heights[0]).min(other_heights[1]);
        let [on_a, on_b] = nearest_points(first, second);
        let between = [on_a.extend(height), on_b.extend(other_height)];
        (member, Neighbour::Member(neighbour), between)
    }

    /// Returns the capsules of the members at a posture with `P` at `position`.
    pub fn capsules<L: Leg>(&self, manipulator: &Manipulator<L>, position: DVec2, posture: &Posture) -> Vec<Capsule> {
        let (_, axes) = self.laid_out(manipulator, position, posture);
        let members = self.places().filter(|place| *place < MEMBERS);
        members.map(|place| self.capsule(&axes, place)).collect()
    }

    /// Returns the smallest clearance at a posture with `P` at `position` where it is below `limit`, otherwise `limit` \[m\].
    pub(crate) fn clearance_up_to<L: Leg>(
        &self,
        manipulator: &Manipulator<L>,
        position: DVec2,
        posture: &Posture,
        limit: f64,
    ) -> f64 {
        let arms = posture.arms.map(Planar::from);
        self.compute_clearance_up_to(&manipulator.legs, position.into(), &arms, &distals(posture), limit)
    }

    fn laid_out<L: Leg>(
        &self,
        manipulator: &Manipulator<L>,
        position: DVec2,
        posture: &Posture,
    ) -> ([Members<f64>; LEGS], Axes<f64>) {
        let arms = posture.arms.map(Planar::from);
        let members = members(&manipulator.legs, position.into(), &arms, &distals(posture));
        let axes = self.axes(&members, position.into(), &arms);
        (members, axes)
    }

    fn capsule(&self, axes: &Axes<f64>, place: usize) -> Capsule {
        Capsule {
            member: self.member(place),
            from: self.lift(axes[place].from, place),
            to: self.lift(axes[place].to(), place),
            radius: self.radii[place / LEGS],
        }
    }

    fn member(&self, place: usize) -> MemberId {
        match place.checked_sub(MEMBERS) {
            Some(joint) => {
                let (upright, _) = self.uprights[joint];
                MemberId {
                    leg: upright.leg,
                    kind: upright.kind,
                }
            }
            None => MemberId {
                leg: place % LEGS,
                kind: self.kinds[place / LEGS].expect("legs of this type have this member"),
            },
        }
    }

    fn lift(&self, at: Planar<f64>, place: usize) -> DVec3 {
        DVec3::new(at.x, at.y, self.heights[place])
    }
}

/// Returns the distal bars of the legs at a posture.
fn distals(posture: &Posture) -> [DistalLanes<f64>; LEGS] {
    posture.legs.map(|leg| DistalLanes {
        tangent: leg.chain.distal.direction.into(),
        offset: leg.chain.distal.offset,
    })
}
