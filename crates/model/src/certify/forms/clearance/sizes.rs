//! Sizes and heights of the bodies of a design, and what they must keep from each other and from outlines.

use super::{Distance, SeparatedBarrier, SeparatedPair};
use crate::clearance::{
    Barrier, BodySettings, MEMBERS, ROWS, Stack, Upright, kinds, pairs_not_joined, pairs_of_joints,
};
use crate::enclosure::Interval;
use crate::evaluation::Model;
use crate::mechanism::{Design, MemberKind};
use crate::spatial::LEGS;

/// The outlines, with what each body must keep from them.
pub(super) fn barriers(model: &Model, members: &Members<'_>, clearance: Interval) -> Vec<SeparatedBarrier> {
    let exactly = Interval::exactly;
    let of_body = |barrier: &Barrier, place: usize| {
        let size = members.size(place)?;
        let [low, high] = barrier.heights.map(exactly);
        let [below, above] = [low - size.heights[1], size.heights[0] - high];
        // By how much the body lies above or below, if it does.
        let gap = below.max(above).max(exactly(0.0));
        let distance = size.radius + clearance;
        let (keep, is_certain) = if size.is_prism {
            let apart = gap - size.beyond;
            (
                between_prisms(size.radius, apart, clearance)?,
                apart.upper() < clearance.lower(),
            )
        } else {
            let keep = distance.square() - gap.square();
            (keep, keep.lower() > 0.0)
        };
        if distance.upper() <= 0.0 || keep.upper() <= 0.0 {
            return None;
        }
        let keep = Interval::new(keep.lower().max(0.0), keep.upper());
        let square = (keep.sqrt() + exactly(barrier.rounding)).square() * members.to_unit.square();
        Some(Distance {
            square,
            upper: exactly(square.upper()).sqrt().upper(),
            is_certain,
        })
    };
    let all = model.barriers().iter().map(|barrier| SeparatedBarrier {
        barrier: barrier.clone(),
        distances: (0..members.count()).map(|place| of_body(barrier, place)).collect(),
    });
    all.collect()
}

/// Sizes and heights of the members and joints of a design as intervals \[m\].
pub(super) struct Members<'a> {
    bodies: &'a BodySettings,
    design: &'a Design,
    stack: Stack,
    kinds: [Option<MemberKind>; ROWS],
    /// Joints that are bodies.
    pub uprights: Vec<Upright>,
    /// Rows that consist of square tubes.
    are_square: [bool; ROWS],
    /// `1/L_b`.
    to_unit: Interval,
}

/// Size of a body about its axis \[m\].
struct BodyBounds {
    /// Twice the height of a horizontal axis, or the lowest and the highest point of an upright cylinder.
    heights: [Interval; 2],
    /// Radius, or half the width.
    radius: Interval,
    /// How far the body extends beyond these heights.
    beyond: Interval,
    /// Whether its sides are upright.
    is_prism: bool,
}

impl<'a> Members<'a> {
    pub fn new(model: &'a Model, design: &'a Design) -> Self {
        let sections = &model.settings().sections;
        let (legs, platform) = (sections.legs.is_square(), sections.platform.is_square());
        let stack = model.stack_of(design);
        Self {
            bodies: &model.settings().bodies,
            design,
            stack,
            kinds: kinds(design.architecture()),
            uprights: stack.uprights(&model.settings().joint_sizes, design),
            are_square: [legs, legs, platform],
            to_unit: Interval::exactly(1.0) / Interval::exactly(design.link_length()),
        }
    }

    /// Returns the number of places of members and joints.
    fn count(&self) -> usize {
        MEMBERS + self.uprights.len()
    }

    /// Encloses the height of a layer \[m\].
    fn height(&self, layer: f64) -> Interval {
        let exactly = Interval::exactly;
        let thicker = self.design.leg_bar_radius().max(self.design.platform_bar_radius());
        exactly(layer) * exactly(2.0) * exactly(thicker)
    }

    /// Encloses the size of a body; `None` if the legs have no such member.
    fn size(&self, place: usize) -> Option<BodyBounds> {
        let exactly = Interval::exactly;
        if let Some(upright) = place.checked_sub(MEMBERS).and_then(|joint| self.uprights.get(joint)) {
            return Some(BodyBounds {
                heights: self.heights(upright),
                radius: exactly(upright.radius),
                beyond: exactly(0.0),
                is_prism: true,
            });
        }
        let (row, leg) = (place / LEGS, place % LEGS);
        let radius = match self.kinds[row]? {
            MemberKind::Slider => exactly(self.bodies.slider_half_width) * exactly(self.design.leg_bar_radius()),
            kind => exactly(self.bodies.radius(kind, self.design)),
        };
        Some(BodyBounds {
            heights: [self.height(self.stack.layer(row, leg)); 2],
            radius,
            beyond: radius,
            is_prism: self.are_square[row],
        })
    }

    /// Encloses the lowest and the highest point of a joint.
    fn heights(&self, upright: &Upright) -> [Interval; 2] {
        let exactly = Interval::exactly;
        let [low, high] = upright.layers.map(|layer| self.height(layer));
        let height = exactly(upright.height);
        if upright.stands {
            return [high, high + height];
        }
        let half = exactly(0.5);
        let (middle, half) = (half * (low + high), half * height);
        let (bottom, top) = (middle - half, middle + half);
        [low.min(bottom), high.max(top)]
    }
}

/// The pairs that their heights alone do not keep apart.
pub(super) fn pairs(members: &Members<'_>, clearance: Interval) -> Vec<SeparatedPair> {
    let exactly = Interval::exactly;
    let keep = |places: [usize; 2]| {
        let (first, second) = (members.size(places[0])?, members.size(places[1])?);
        let radii = first.radius + second.radius;
        let distance = radii + clearance;
        let (below, above) = (
            second.heights[0] - first.heights[1],
            first.heights[0] - second.heights[1],
        );
        let gap = below.max(above);
        let round = [&first, &second].into_iter().find(|size| !size.is_prism);
        let has_joint = places.iter().any(|&place| place >= MEMBERS);
        let square = match (first.is_prism || second.is_prism, round) {
            (false, _) => distance.square() - gap.square(),
            (true, Some(bar)) if has_joint => beside_cylinder(bar.radius, radii - bar.radius, gap, clearance)?,
            (true, _) => between_prisms(radii, gap - (first.beyond + second.beyond), clearance)?,
        };
        let square = square * members.to_unit.square();
        (distance.upper() > 0.0 && square.upper() > 0.0).then(|| SeparatedPair {
            places,
            square,
            distance: exactly(square.upper()).sqrt().upper(),
        })
    };
    let all = pairs_not_joined(members.kinds).chain(pairs_of_joints(members.kinds, &members.uprights));
    all.filter_map(keep).collect()
}

/// The square of the distance that the axis of a round bar and that of an upright cylinder must keep in the plane, given the distance
/// between the height of the bar's axis and those of the cylinder; `None` if the latter alone keeps the clearance.
fn beside_cylinder(bar: Interval, cylinder: Interval, gap: Interval, clearance: Interval) -> Option<Interval> {
    let distance = bar + clearance;
    let gap = gap.max(Interval::exactly(0.0));
    let keep = distance.square() - gap.square();
    if distance.upper() <= 0.0 || keep.upper() <= 0.0 {
        return None;
    }
    let keep = Interval::new(keep.lower().max(0.0), keep.upper());
    Some((keep.sqrt() + cylinder).square())
}

/// The square of the distance that the axes of two prisms must keep in the plane, given the sum of their radii and the distance between
/// their heights; `None` if the latter alone keeps the clearance.
fn between_prisms(radii: Interval, apart: Interval, clearance: Interval) -> Option<Interval> {
    if apart.lower() >= clearance.upper() {
        return None;
    }
    // Where the layers overlap, nothing of the clearance is kept by them.
    let zero = Interval::exactly(0.0);
    let left = (clearance.square() - apart.max(zero).square()).max(zero);
    Some((radii + left.sqrt()).square())
}
