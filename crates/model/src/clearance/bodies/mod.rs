//! The members and joints of one design, prepared for clearance computations at many poses.

mod at_pose;
mod lanes;

use std::sync::Arc;

use glam::DVec2;

use super::layers::BodySettings;
use super::places::{MEMBERS, PROXIMAL, ROWS, kinds, pairs_not_joined};
use super::stack::{Stack, Upright, pairs_of_joints, thickness};
use super::surroundings::{Barrier, BodySize};
use crate::mechanism::{AnyLeg, CrossSections, Design, JointSizes, Leg, LegSettings, MemberKind};
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
