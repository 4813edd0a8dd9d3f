//! The members and joints of one design, prepared for clearance computations at many poses.

mod at_pose;

use std::sync::Arc;

use glam::DVec2;

use super::distance::{may_be_nearer, squared};
use super::layers::BodySettings;
use super::places::{MEMBERS, PLATFORM, PROXIMAL, ROWS, kinds, pairs_not_joined};
use super::stack::{Stack, Upright, pairs_of_joints, thickness};
use super::surroundings::{Barrier, BodySize};
use crate::lanes::{Planar, Real};
use crate::mechanism::{
    AnyLeg, CrossSections, Design, DistalLanes, JointPoint, JointSizes, Leg, LegSettings, MemberAxis, MemberKind,
    Members,
};
use crate::spatial::{LEGS, NUMBER_LIMIT};

/// Pair of bodies that are not joined.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Pair {
    /// Indices of both bodies: `LEGS · row + leg` for a member, from [`MEMBERS`] for a joint.
    places: [usize; 2],
    /// Sum of their radii \[m\].
    radii: f64,
    /// Squared distance between their layers \[m²\]; meaningless for prisms.
    layers_squared: f64,
    /// Whether one of them is a square tube or an upright cylinder, so that both are treated as prisms.
    is_prism: bool,
    /// Radius of a round bar beside an upright cylinder, which is kept in every direction; otherwise 0 \[m\].
    round: f64,
    /// Lower bound of their clearance, set by the distance between their heights alone \[m\].
    least: f64,
}

/// The members of a design, with the pairs of them that are not joined.
#[derive(Debug, Clone, PartialEq)]
pub struct Bodies {
    stack: Stack,
    kinds: [Option<MemberKind>; ROWS],
    radii: [f64; ROWS],
    /// Heights of the members, indexed by `LEGS · row + leg` \[m\].
    heights: [f64; MEMBERS],
    /// Joints that are bodies, with their lowest and highest points \[m\].
    uprights: Vec<(Upright, [f64; 2])>,
    /// Base joints, if there are joints with a size \[m\].
    anchors: [DVec2; LEGS],
    /// Lengths of the platform bars \[m\].
    platform_radii: [f64; LEGS],
    /// Half the length of a slider, and half the length of its axis \[m\].
    slider: [f64; 2],
    /// Rows that consist of square tubes.
    are_square: [bool; ROWS],
    /// Outlines that no member may cross.
    barriers: Arc<[Barrier]>,
    /// Pairs that are not joined, in increasing order of the lower bound of their clearance.
    pairs: Vec<Pair>,
}

/// Axes of all members at a pose, indexed by `LEGS · row + leg`.
type Axes<V> = [MemberAxis<V>; MEMBERS];

/// What the bodies of a design follow from, besides the design.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BodyBasis<'a> {
    /// Settings of the legs.
    pub legs: &'a LegSettings,
    /// Sizes of sliders and layers.
    pub settings: &'a BodySettings,
    /// Sizes of joints.
    pub joints: &'a JointSizes,
    /// Cross-sections of the bars.
    pub sections: &'a CrossSections,
    /// Outlines that no body may cross.
    pub barriers: &'a Arc<[Barrier]>,
}

impl Bodies {
    /// Prepares the members and joints of `design`, stacked as given.
    pub(crate) fn new(design: &Design, stack: &Stack, basis: &BodyBasis<'_>) -> Self {
        let mut bodies = Self::unpaired(design, stack, basis);
        bodies.pair_up();
        bodies
    }

    /// Prepares them without their pairs, so that no clearance can be computed.
    pub(crate) fn unpaired(design: &Design, stack: &Stack, basis: &BodyBasis<'_>) -> Self {
        let BodyBasis { settings, sections, .. } = *basis;
        let kinds = kinds(design.architecture());
        let (legs, platform) = (sections.legs.is_square(), sections.platform.is_square());
        // The limit keeps squares and sums finite, whatever radii a design has.
        let radii = kinds.map(|kind| kind.map_or(0.0, |kind| settings.radius(kind, design).min(NUMBER_LIMIT)));
        let thickness = thickness(design);
        let limited = |height: f64| height.clamp(-NUMBER_LIMIT, NUMBER_LIMIT);
        let mut heights = [0.0; MEMBERS];
        for (place, height) in heights.iter_mut().enumerate() {
            if kinds[place / LEGS].is_some() {
                *height = limited(stack.layer(place / LEGS, place % LEGS) * thickness);
            }
        }
        let uprights = stack.uprights(basis.joints, design);
        let anchors = match uprights.is_empty() {
            true => [DVec2::ZERO; LEGS],
            false => [0, 1, 2].map(|leg| AnyLeg::new(design, basis.legs, leg).frame().anchor),
        };
        let half_length = settings.slider_half_length(design).min(NUMBER_LIMIT);
        let geometry = &basis.legs.geometry;
        Self {
            stack: *stack,
            kinds,
            radii,
            heights,
            uprights: uprights
                .into_iter()
                .map(|upright| (upright, upright.heights(thickness).map(limited)))
                .collect(),
            anchors,
            platform_radii: [0, 1, 2].map(|leg| geometry.platform_length(leg, design.platform_radius())),
            slider: [half_length, (half_length - radii[PROXIMAL]).max(0.0)],
            are_square: [legs, legs, platform],
            barriers: Arc::clone(basis.barriers),
            pairs: Vec::new(),
        }
    }

    /// Returns the layers in which the members are.
    pub fn stack(&self) -> &Stack {
        &self.stack
    }

    /// Fills in the pairs of bodies that are not joined.
    fn pair_up(&mut self) {
        let uprights: Vec<Upright> = self.uprights.iter().map(|(upright, _)| *upright).collect();
        let places = pairs_not_joined(self.kinds).chain(pairs_of_joints(self.kinds, &uprights));
        self.pairs = places.map(|places| self.pair(places)).collect();
        self.pairs.sort_by(|a, b| a.least.total_cmp(&b.least));
    }

    fn pair(&self, places: [usize; 2]) -> Pair {
        let [first, second] = places.map(|place| self.size(place));
        let gap = (second.heights[0] - first.heights[1]).max(first.heights[0] - second.heights[1]);
        Pair {
            places,
            radii: first.radius + second.radius,
            layers_squared: gap * gap,
            is_prism: first.is_prism || second.is_prism,
            round: match (
                places.iter().any(|&place| place >= MEMBERS),
                first.is_prism,
                second.is_prism,
            ) {
                (true, false, _) => first.radius,
                (true, _, false) => second.radius,
                _ => 0.0,
            },
            least: gap - (first.beyond + second.beyond),
        }
    }

    /// Returns the size of a body about its axis.
    #[inline(always)]
    fn size(&self, place: usize) -> BodySize {
        match place.checked_sub(MEMBERS) {
            Some(joint) => {
                let (upright, heights) = self.uprights[joint];
                BodySize {
                    heights,
                    radius: upright.radius.min(NUMBER_LIMIT),
                    beyond: 0.0,
                    is_prism: true,
                }
            }
            None => BodySize {
                heights: [self.heights[place]; 2],
                radius: self.radii[place / LEGS],
                beyond: self.radii[place / LEGS],
                is_prism: self.are_square[place / LEGS],
            },
        }
    }

    /// Returns the places of all bodies.
    fn places(&self) -> impl Iterator<Item = usize> {
        let has = self.kinds.map(|kind| kind.is_some());
        let members = (0..MEMBERS).filter(move |place| has[place / LEGS]);
        members.chain(MEMBERS..MEMBERS + self.uprights.len())
    }

    /// Returns the axes of all members, given those of the legs.
    #[inline(always)]
    fn axes<V: Real>(&self, members: &[Members<V>; LEGS], position: Planar<V>, arms: &[Planar<V>; LEGS]) -> Axes<V> {
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
    fn point<V: Real>(&self, axes: &Axes<V>, place: usize) -> MemberAxis<V> {
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
    fn gap<V: Real>(pair: &Pair, a: &MemberAxis<V>, b: &MemberAxis<V>) -> V {
        let distance = squared(a, b);
        if pair.is_prism {
            // Prisms with upright sides, as wide as they are high and rounded about their joints: where they overlap in plan or
            // in height, the distance is that in the other direction.
            let zero = distance.splat(0.0);
            let across = distance.sqrt() - distance.splat(pair.radii - pair.round);
            let along_z = distance.splat(pair.least + pair.round);
            let (outside_x, outside_z) = (across.larger(zero), along_z.larger(zero));
            let outside = (outside_x * outside_x + outside_z * outside_z).sqrt();
            return outside + across.larger(along_z).smaller(zero) - distance.splat(pair.round);
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

    /// Returns the height of the stack of members and joints: from the lowest to the highest point of any of them \[m\].
    pub fn height(&self) -> f64 {
        let sizes = self.places().map(|place| self.size(place));
        let [low, high] = sizes.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], size| {
            [
                low.min(size.heights[0] - size.beyond),
                high.max(size.heights[1] + size.beyond),
            ]
        });
        high - low
    }
}

/// Returns the axes of the members of all legs.
#[inline(always)]
fn members<V: Real, L: Leg>(
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
