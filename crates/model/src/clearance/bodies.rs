//! The members of one design, prepared for clearance computations at many poses.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::capsule::{Capsule, Clearance, MemberId, Neighbour};
use super::distance::{may_be_nearer, nearest_points, squared};
use super::layers::BodySettings;
use super::surroundings::Barrier;
use crate::lanes::{Planar, Real};
use crate::mechanism::{
    Architecture, CrossSections, Design, DistalLanes, Geometry, Leg, Manipulator, MemberAxis, MemberKind, Members,
    Posture,
};
use crate::spatial::{LEGS, NUMBER_LIMIT};

/// Number of rows of members: the proximal members of the legs, the distal members of the legs, and the platform bars.
pub(crate) const ROWS: usize = 3;
pub(crate) const PROXIMAL: usize = 0;
pub(crate) const DISTAL: usize = 1;
pub(crate) const PLATFORM: usize = 2;

/// Returns the kinds of the members of each row; `None` for a row that legs of this architecture do not have.
pub(crate) fn kinds(architecture: Architecture) -> [Option<MemberKind>; ROWS] {
    let chain = architecture.chain();
    [chain.proximal, Some(chain.distal), Some(MemberKind::PlatformBar)]
}

/// Returns the pairs of members that are not joined, as indices `LEGS · row + leg`.
pub(crate) fn pairs_not_joined(kinds: [Option<MemberKind>; ROWS]) -> impl Iterator<Item = [usize; 2]> {
    let all = (0..ROWS * LEGS).flat_map(|first| (first + 1..ROWS * LEGS).map(move |second| [first, second]));
    all.filter(move |places| {
        let rows = places.map(|place| place / LEGS);
        let of_one_leg = places[0] % LEGS == places[1] % LEGS;
        let joined = match rows {
            [PLATFORM, PLATFORM] => true,
            [PROXIMAL, DISTAL] | [DISTAL, PLATFORM] => of_one_leg,
            _ => false,
        };
        rows.iter().all(|&row| kinds[row].is_some()) && !joined
    })
}

/// Largest number of pairs of members that are not joined: 3 + 3 + 6 between legs, 9 + 6 with the platform bars.
const MAX_PAIRS: usize = 27;

/// Pair of members that are not joined.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Pair {
    /// Indices of both members: `LEGS · row + leg`.
    places: [usize; 2],
    /// Sum of their radii \[m\].
    radii: f64,
    /// Squared distance between their layers \[m²\].
    layers_squared: f64,
    /// Whether one of them is a square tube, so that both are treated as prisms.
    is_prism: bool,
    /// Lower bound of their clearance, set by the distance between their layers alone \[m\].
    least: f64,
}

/// The members of a design, with the pairs of them that are not joined.
#[derive(Debug, Clone, PartialEq)]
pub struct Bodies {
    kinds: [Option<MemberKind>; ROWS],
    radii: [f64; ROWS],
    heights: [f64; ROWS],
    /// Lengths of the platform bars \[m\].
    platform_radii: [f64; LEGS],
    /// Half the length of a slider, and half the length of its axis \[m\].
    slider: [f64; 2],
    /// Rows that consist of square tubes.
    are_square: [bool; ROWS],
    /// Outlines that no member may cross.
    barriers: Arc<[Barrier]>,
    /// Pairs that are not joined, in increasing order of the lower bound of their clearance.
    pairs: [Pair; MAX_PAIRS],
    count: usize,
}

/// Axes of all members at a pose, indexed by `LEGS · row + leg`.
type Axes<V> = [MemberAxis<V>; ROWS * LEGS];

impl Bodies {
    /// Prepares the members of `design`.
    pub(crate) fn new(
        design: &Design,
        geometry: &Geometry,
        settings: &BodySettings,
        sections: &CrossSections,
        barriers: &Arc<[Barrier]>,
    ) -> Self {
        let kinds = kinds(design.architecture());
        let (legs, platform) = (sections.legs.is_square(), sections.platform.is_square());
        // The limit keeps squares and sums finite, whatever radii a design has.
        let radii = kinds.map(|kind| kind.map_or(0.0, |kind| settings.radius(kind, design).min(NUMBER_LIMIT)));
        let height = |kind| settings.height(kind, design).clamp(-NUMBER_LIMIT, NUMBER_LIMIT);
        let heights = kinds.map(|kind| kind.map_or(0.0, height));
        let half_length = settings.slider_half_length(design).min(NUMBER_LIMIT);
        let none = Pair {
            places: [0; 2],
            radii: 0.0,
            layers_squared: 0.0,
            is_prism: false,
            least: f64::INFINITY,
        };
        let mut bodies = Self {
            kinds,
            radii,
            heights,
            platform_radii: [0, 1, 2].map(|leg| geometry.platform_length(leg, design.platform_radius())),
            slider: [half_length, (half_length - radii[PROXIMAL]).max(0.0)],
            are_square: [legs, legs, platform],
            barriers: Arc::clone(barriers),
            pairs: [none; MAX_PAIRS],
            count: 0,
        };
        bodies.pair_up();
        bodies
    }

    /// Fills in the pairs of members that are not joined.
    fn pair_up(&mut self) {
        for places in pairs_not_joined(self.kinds) {
            let rows = places.map(|place| place / LEGS);
            let gap = (self.heights[rows[0]] - self.heights[rows[1]]).abs();
            let radii = self.radii[rows[0]] + self.radii[rows[1]];
            self.pairs[self.count] = Pair {
                places,
                radii,
                layers_squared: gap * gap,
                is_prism: rows.iter().any(|&row| self.are_square[row]),
                least: gap - radii,
            };
            self.count += 1;
        }
        self.pairs[..self.count].sort_by(|a, b| a.least.total_cmp(&b.least));
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

    #[inline(always)]
    fn gap<V: Real>(pair: &Pair, axes: &Axes<V>) -> V {
        let distance = squared(&axes[pair.places[0]], &axes[pair.places[1]]);
        if pair.is_prism {
            // Prisms with upright sides, as wide as they are high and rounded about their joints: where they overlap in plan or
            // in height, the distance is that in the other direction.
            let zero = distance.splat(0.0);
            let across = distance.sqrt() - distance.splat(pair.radii);
            let along_z = distance.splat(pair.least);
            let (outside_x, outside_z) = (across.larger(zero), along_z.larger(zero));
            let outside = (outside_x * outside_x + outside_z * outside_z).sqrt();
            return outside + across.larger(along_z).smaller(zero);
        }
        (distance + distance.splat(pair.layers_squared)).sqrt() - distance.splat(pair.radii)
    }

    /// Returns the smallest clearance at several poses at once where it is below `limit`, otherwise `limit` \[m\].
    ///
    /// `distals` are the distal bars of the legs; `arms` is as in [`Manipulator::arms`]. Pairs are skipped if
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
        for pair in &self.pairs[..self.count] {
            if !V::any(least.exceeds(limit.splat(pair.least))) {
                break;
            }
            let (a, b) = (&axes[pair.places[0]], &axes[pair.places[1]]);
            // The selection is made lane by lane, because the result of one lane must not depend on its neighbours.
            let near = may_be_nearer(a, b, least + limit.splat(pair.radii));
            if V::any(near) {
                let found = Self::gap(pair, &axes).smaller(least);
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
            for (place, axis) in axes.iter().enumerate() {
                let row = place / LEGS;
                let (height, radius) = (self.heights[row], self.radii[row]);
                if self.kinds[row].is_none()
                    || !V::any(least.exceeds(limit.splat(barrier.gap_to_height(height) - radius)))
                {
                    continue;
                }
                let near = barrier.may_be_nearer(axis, least + limit.splat(radius));
                if V::any(near) {
                    let found = barrier
                        .clearance(axis, height, radius, self.are_square[row])
                        .smaller(least);
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
        farthest
    }

    /// Returns the height of the stack of members: from the lowest to the highest point of any of them \[m\].
    pub fn height(&self) -> f64 {
        let rows = (0..ROWS).filter(|&row| self.kinds[row].is_some());
        let [low, high] = rows.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], row| {
            let (middle, radius) = (self.heights[row], self.radii[row]);
            [low.min(middle - radius), high.max(middle + radius)]
        });
        high - low
    }

    /// Returns the nearest pair at a posture with `P` at `position`.
    pub fn nearest<L: Leg>(&self, manipulator: &Manipulator<L>, position: DVec2, posture: &Posture) -> Clearance {
        enum Found<'a> {
            RailEnd { leg: usize, end: usize, distance: f64 },
            Pair(&'a Pair),
            Barrier { place: usize, barrier: &'a Barrier },
        }
        let (members, axes) = self.laid_out(manipulator, position, posture);
        let ends = members.iter().enumerate().flat_map(|(leg, members)| {
            let of_rail = members.rail.iter().flatten().enumerate();
            of_rail.map(move |(end, &distance)| (distance - self.slider[0], Found::RailEnd { leg, end, distance }))
        });
        let pairs = self.pairs[..self.count].iter();
        let members_beside = (0..ROWS * LEGS).filter(|place| self.kinds[place / LEGS].is_some());
        let beside = members_beside.flat_map(|place| self.barriers.iter().map(move |barrier| (place, barrier)));
        let (distance, found) = ends
            .chain(pairs.map(|pair| (Self::gap(pair, &axes), Found::Pair(pair))))
            .chain(beside.map(|(place, barrier)| {
                let row = place / LEGS;
                let (height, radius) = (self.heights[row], self.radii[row]);
                let distance = barrier.clearance(&axes[place], height, radius, self.are_square[row]);
                (distance, Found::Barrier { place, barrier })
            }))
            .map(|(distance, found)| (distance.clamp(-NUMBER_LIMIT, NUMBER_LIMIT), found))
            .reduce(|least, next| if next.0 < least.0 { next } else { least })
            .expect("a manipulator has pairs of members");
        match found {
            Found::RailEnd {
                leg,
                end,
                distance: way,
            } => {
                let slider = &axes[leg];
                let outwards = if end == 0 { -1.0 } else { 1.0 };
                let middle = slider.from.plus(slider.direction.scaled(0.5 * slider.length));
                let at = |along: f64| self.lift(middle.plus(slider.direction.scaled(outwards * along)), PROXIMAL);
                Clearance {
                    distance,
                    member: self.member(leg),
                    neighbour: Neighbour::RailEnd {
                        leg,
                        anchor: (leg + end) % LEGS,
                    },
                    between: [at(self.slider[0]), at(way)],
                }
            }
            Found::Barrier { place, barrier } => {
                let row = place / LEGS;
                let [on_axis, on_outline] = barrier.nearest_points(&axes[place]);
                let [low, high] = barrier.heights;
                Clearance {
                    distance,
                    member: self.member(place),
                    neighbour: barrier.neighbour.clone(),
                    between: [
                        on_axis.extend(self.heights[row]),
                        on_outline.extend(self.heights[row].max(low).min(high)),
                    ],
                }
            }
            Found::Pair(pair) => {
                let [a, b] = pair.places.map(|place| self.capsule(&axes, place));
                Clearance {
                    distance,
                    member: a.member,
                    neighbour: Neighbour::Member(b.member),
                    between: {
                        let [on_a, on_b] = nearest_points(a.ends().map(DVec3::truncate), b.ends().map(DVec3::truncate));
                        [on_a.extend(a.from.z), on_b.extend(b.from.z)]
                    },
                }
            }
        }
    }

    /// Returns the capsules of the members at a posture with `P` at `position`.
    pub fn capsules<L: Leg>(&self, manipulator: &Manipulator<L>, position: DVec2, posture: &Posture) -> Vec<Capsule> {
        let (_, axes) = self.laid_out(manipulator, position, posture);
        (0..ROWS * LEGS)
            .filter(|place| self.kinds[place / LEGS].is_some())
            .map(|place| self.capsule(&axes, place))
            .collect()
    }

    fn laid_out<L: Leg>(
        &self,
        manipulator: &Manipulator<L>,
        position: DVec2,
        posture: &Posture,
    ) -> ([Members<f64>; LEGS], Axes<f64>) {
        let arms = posture.arms.map(Planar::from);
        let distals = posture.legs.map(|leg| DistalLanes {
            tangent: leg.chain.distal.direction.into(),
            offset: leg.chain.distal.offset,
        });
        let members = members(&manipulator.legs, position.into(), &arms, &distals);
        let axes = self.axes(&members, position.into(), &arms);
        (members, axes)
    }

    fn capsule(&self, axes: &Axes<f64>, place: usize) -> Capsule {
        let row = place / LEGS;
        Capsule {
            member: self.member(place),
            from: self.lift(axes[place].from, row),
            to: self.lift(axes[place].to(), row),
            radius: self.radii[row],
        }
    }

    fn member(&self, place: usize) -> MemberId {
        MemberId {
            leg: place % LEGS,
            kind: self.kinds[place / LEGS].expect("legs of this type have this member"),
        }
    }

    fn lift(&self, at: Planar<f64>, row: usize) -> DVec3 {
        DVec3::new(at.x, at.y, self.heights[row])
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
