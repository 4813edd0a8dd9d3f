//! The axes of the bodies and their smallest clearance, at several poses at once.

use super::super::distance::{between_prisms, may_be_nearer, squared};
use super::super::places::{MEMBERS, PLATFORM, PROXIMAL};
use super::{Bodies, Pair};
use crate::lanes::{Planar, Real};
use crate::mechanism::{DistalLanes, JointPoint, Leg, MemberAxis, MemberKind, Members};
use crate::spatial::LEGS;

/// Axes of all members at a pose, indexed by `LEGS · row + leg`.
pub(super) type Axes<V> = [MemberAxis<V>; MEMBERS];

impl Bodies {
    /// Returns the axes of all members, given those of the legs.
    #[inline(always)]
    pub(super) fn axes<V: Real>(
        &self,
        members: &[Members<V>; LEGS],
        position: Planar<V>,
        arms: &[Planar<V>; LEGS],
    ) -> Axes<V> {
        [
            self.proximal(&members[0]),
            self.proximal(&members[1]),
            self.proximal(&members[2]),
            members[0].distal,
            members[1].distal,
            members[2].distal,
            self.platform_bar(position, arms[0], 0),
            self.platform_bar(position, arms[1], 1),
            self.platform_bar(position, arms[2], 2),
        ]
    }

    /// Returns the axis of the proximal member. For a leg without one it returns that of the distal member, which no
    /// pair uses.
    #[inline(always)]
    fn proximal<V: Real>(&self, members: &Members<V>) -> MemberAxis<V> {
        match (&members.proximal, self.kinds[PROXIMAL]) {
            (Some(axis), Some(MemberKind::Slider)) => axis.extended(axis.length.splat(self.slider[1])),
            (Some(axis), _) => *axis,
            (None, _) => members.distal,
        }
    }

    #[inline(always)]
    fn platform_bar<V: Real>(&self, position: Planar<V>, arm: Planar<V>, leg: usize) -> MemberAxis<V> {
        let like = arm.x;
        let length = self.platform_radii[leg];
        MemberAxis {
            from: position.plus(arm),
            direction: arm.scaled(like.splat(-1.0 / length)),
            length: like.splat(length),
        }
    }

    /// Returns where a joint is, as an axis without length.
    #[inline(always)]
    pub(super) fn point<V: Real>(&self, axes: &Axes<V>, place: usize) -> MemberAxis<V> {
        let like = axes[0].length;
        let (upright, _) = &self.uprights[place - MEMBERS];
        let leg = upright.leg;
        let from = match upright.point {
            JointPoint::A => Planar::splat(like, self.anchors[leg]),
            JointPoint::B => {
                let axis = &axes[LEGS * PROXIMAL + leg];
                match self.kinds[PROXIMAL] {
                    Some(MemberKind::Slider) => axis.from.plus(axis.direction.scaled(like.splat(0.5) * axis.length)),
                    _ => axis.to(),
                }
            }
            JointPoint::C => axes[LEGS * PLATFORM + leg].from,
        };
        MemberAxis {
            from,
            direction: Planar::new(like.splat(1.0), like.splat(0.0)),
            length: like.splat(0.0),
        }
    }

    #[inline(always)]
    pub(super) fn gap<V: Real>(pair: &Pair, a: &MemberAxis<V>, b: &MemberAxis<V>) -> V {
        let distance = squared(a, b);
        if pair.is_prism {
            // Prisms with upright sides, as wide as they are high and rounded about their joints: where they overlap in plan or
            // in height, the distance is that in the other direction.
            let across = distance.sqrt() - distance.splat(pair.radii - pair.round);
            let along_z = distance.splat(pair.least + pair.round);
            return between_prisms(across, along_z) - distance.splat(pair.round);
        }
        (distance + distance.splat(pair.layers_squared)).sqrt() - distance.splat(pair.radii)
    }

    /// Returns the smallest clearance at several poses at once where it is below `limit`, otherwise `limit` \[m\].
    ///
    /// `distals` are the distal bars of the legs; `arms` is as in [`Manipulator::arms`](crate::mechanism::Manipulator::arms). Pairs are skipped if
    /// their layers or the circles around their axes show that they cannot be nearer than the smallest clearance found
    /// so far.
    #[inline(always)]
    pub fn compute_clearance_up_to<V: Real, L: Leg>(
        &self,
        legs: &[L; LEGS],
        position: Planar<V>,
        arms: &[Planar<V>; LEGS],
        distals: &[DistalLanes<V>; LEGS],
        limit: V,
    ) -> V {
        let members = members(legs, position, arms, distals);
        let mut least = limit;
        // Loops over lanes avoid closures and iterator adapters: code that is not inlined is compiled for the baseline
        // processor.
        if let [Some(first), Some(second), Some(third)] = [members[0].rail, members[1].rail, members[2].rail] {
            let lower = first[0].smaller(second[0].smaller(third[0]));
            let upper = first[1].smaller(second[1].smaller(third[1]));
            least = (lower.smaller(upper) - limit.splat(self.slider[0])).smaller(least);
        }
        if self.barriers.is_empty() && !V::any(least.exceeds(limit.splat(self.pairs[0].least))) {
            return least;
        }
        let axes = self.axes(&members, position, arms);
        least = self.clearance_beside(&axes, least);
        for pair in &self.pairs {
            if !V::any(least.exceeds(limit.splat(pair.least))) {
                break;
            }
            let [first, second] = pair.places;
            let (point, other_point);
            let a = if first < MEMBERS {
                &axes[first]
            } else {
                point = self.point(&axes, first);
                &point
            };
            let b = if second < MEMBERS {
                &axes[second]
            } else {
                other_point = self.point(&axes, second);
                &other_point
            };
            // The selection is made lane by lane, because the result of one lane must not depend on its neighbours.
            let near = may_be_nearer(a, b, least + limit.splat(pair.radii));
            if V::any(near) {
                let found = Self::gap(pair, a, b).smaller(least);
                least = found.select(near, least);
            }
        }
        least
    }

    /// Returns the smallest clearance from what stands beside the manipulator, where it is below `limit` \[m\].
    #[inline(always)]
    fn clearance_beside<V: Real>(&self, axes: &Axes<V>, limit: V) -> V {
        let mut least = limit;
        for barrier in self.barriers.iter() {
            for place in 0..MEMBERS + self.uprights.len() {
                if place < MEMBERS && self.kinds[place / LEGS].is_none() {
                    continue;
                }
                let size = self.size(place);
                if !V::any(least.exceeds(limit.splat(barrier.gap_to_heights(size.heights) - size.beyond))) {
                    continue;
                }
                let point;
                let axis = if place < MEMBERS {
                    &axes[place]
                } else {
                    point = self.point(axes, place);
                    &point
                };
                let near = barrier.may_be_nearer(axis, least + limit.splat(size.radius));
                if V::any(near) {
                    let found = barrier.clearance(axis, &size).smaller(least);
                    least = found.select(near, least);
                }
            }
        }
        least
    }

    /// Returns the distance from `O` of the farthest point of any member at several poses at once \[m\]; meaningless where a leg
    /// does not reach the pose.
    #[inline(always)]
    pub(crate) fn outermost<V: Real, L: Leg>(
        &self,
        legs: &[L; LEGS],
        position: Planar<V>,
        arms: &[Planar<V>; LEGS],
        distals: &[DistalLanes<V>; LEGS],
    ) -> V {
        let members = members(legs, position, arms, distals);
        let axes = self.axes(&members, position, arms);
        let mut farthest = position.x.splat(0.0);
        for (place, axis) in axes.iter().enumerate() {
            let row = place / LEGS;
            if self.kinds[row].is_none() {
                continue;
            }
            let (from, to) = (axis.from, axis.to());
            let squared = from.dot(from).larger(to.dot(to));
            farthest = (squared.sqrt() + squared.splat(self.radii[row])).larger(farthest);
        }
        for place in MEMBERS..MEMBERS + self.uprights.len() {
            let at = self.point(&axes, place).from;
            let distance = at.dot(at).sqrt();
            farthest = (distance + distance.splat(self.size(place).radius)).larger(farthest);
        }
        farthest
    }
}

/// Returns the axes of the members of all legs.
#[inline(always)]
pub(super) fn members<V: Real, L: Leg>(
    legs: &[L; LEGS],
    position: Planar<V>,
    arms: &[Planar<V>; LEGS],
    distals: &[DistalLanes<V>; LEGS],
) -> [Members<V>; LEGS] {
    [
        legs[0].members(position.plus(arms[0]), &distals[0]),
        legs[1].members(position.plus(arms[1]), &distals[1]),
        legs[2].members(position.plus(arms[2]), &distals[2]),
    ]
}
