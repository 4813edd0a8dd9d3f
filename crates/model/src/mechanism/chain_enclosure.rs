//! Enclosures of what a chain is over a box of poses.

use super::{Design, DesignVariable, Geometry, LegSettings};
use crate::enclosure::{Interval, PlanarModel, PoseEnclosure, TaylorModel, TurnedFrame};
use crate::spatial::LEGS;

/// The place of a leg in the manipulator as intervals: angles in degrees, lengths and multiples are the doubles given, and all that
/// follows from them is exact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegFrameEnclosure {
    /// `A_i` \[m\].
    pub anchor: [Interval; 2],
    /// Frame whose x axis is `e_i`.
    pub rail: TurnedFrame,
    /// Smallest and largest distance of a slider from `A_i` \[m\].
    pub rail_travel: [Interval; 2],
    /// Direction of `c_i` in the platform frame.
    pub arm_frame: TurnedFrame,
    /// `r_i/r`.
    pub arm_multiple: Interval,
    /// `r_i` \[m\].
    pub arm_length: Interval,
    /// `r/L_b`.
    pub platform_radius: Interval,
    /// `L_b/r`.
    pub per_platform_radius: Interval,
    /// Frame that is turned by `γ`.
    pub platform_guide: TurnedFrame,
    /// Frame that is turned by `β`.
    pub between_guides: TurnedFrame,
    /// Smallest and largest distance along a guide of length `L_b`, as multiples of it.
    pub guide_travel: [Interval; 2],
    /// `L_b` \[m\].
    pub link: Interval,
    /// `1/L_b` \[1/m\].
    pub to_unit: Interval,
    /// `L_a/L_b`.
    pub proximal: Interval,
    /// Sign of the working mode.
    pub sign: f64,
}

impl LegFrameEnclosure {
    /// Encloses the frame of leg `index` (0, 1, 2) of `design`.
    pub fn new(design: &Design, geometry: &Geometry, index: usize) -> Self {
        let exactly = Interval::exactly;
        let joint = |index: usize| {
            let radius = exactly(geometry.arrangement().base_radii[index]);
            let direction = TurnedFrame::by_degrees(geometry.arrangement().base_angles_deg[index]).axis();
            direction.map(|part| part * radius)
        };
        let (base, platform, link) = (
            exactly(design.base_radius()),
            exactly(design.platform_radius()),
            exactly(design.link_length()),
        );
        let (own, next) = (joint(index), joint((index + 1) % LEGS));
        let side = [next[0] - own[0], next[1] - own[1]];
        let length = (side[0].square() + side[1].square()).sqrt();
        let turn = design.value(DesignVariable::RailAngle) + geometry.arrangement().rail_turn_deg[index];
        let [cosine, sine] = TurnedFrame::by_degrees(turn).axis();
        let one = exactly(1.0);
        let arm_multiple = exactly(geometry.arrangement().platform_radii[index]);
        Self {
            anchor: own.map(|part| part * base),
            rail: TurnedFrame::along([
                (cosine * side[0] - sine * side[1]) / length,
                (sine * side[0] + cosine * side[1]) / length,
            ]),
            rail_travel: geometry.arrangement().rail.map(|share| exactly(share) * length * base),
            arm_frame: TurnedFrame::by_degrees(geometry.arrangement().platform_angles_deg[index]),
            arm_multiple,
            arm_length: arm_multiple * platform,
            platform_radius: platform / link,
            per_platform_radius: link / platform,
            platform_guide: TurnedFrame::by_degrees(design.value(DesignVariable::PlatformGuideAngle)),
            between_guides: TurnedFrame::by_degrees(design.value(DesignVariable::GuideAngle)),
            guide_travel: geometry.arrangement().guide.map(exactly),
            link,
            to_unit: one / link,
            proximal: exactly(design.proximal_length()) / link,
            sign: design.working_mode().sign(index),
        }
    }

    /// Encloses the unit vector from `P` to `C_i`.
    pub fn arm(&self, pose: &PoseEnclosure) -> PlanarModel {
        self.arm_frame.direction(pose)
    }

    /// Encloses the vector from `A_i` to `C_i`, in units of `L_b`, for a position of `P` \[m\] and the direction of its arm.
    pub fn vector(&self, position: PlanarModel, arm: PlanarModel) -> PlanarModel {
        [0, 1].map(|k| {
            (position[k] + arm[k].scaled(self.arm_length))
                .plus(-self.anchor[k])
                .scaled(self.to_unit)
        })
    }

    /// Encloses the bar from `A_i` to `B_i` of length `L_a`, for the vector along it.
    pub fn crank(&self, vector: PlanarModel) -> ProximalEnclosure {
        ProximalEnclosure {
            vector,
            direction: self.along_crank(vector),
            length: TaylorModel::constant(self.proximal),
            offset: TaylorModel::constant(self.proximal),
        }
    }

    /// Returns a vector of the length `L_a` as a unit vector.
    pub fn along_crank(&self, vector: PlanarModel) -> PlanarModel {
        let to_unit = Interval::exactly(1.0) / self.proximal;
        vector.map(|part| part.scaled(to_unit))
    }
}

/// A leg that is enclosed over boxes of poses.
#[derive(Debug, Clone, Copy)]
pub struct LegToEnclose<'a> {
    /// The place of the leg in the manipulator.
    pub frame: &'a LegFrameEnclosure,
    /// The design.
    pub design: &'a Design,
    /// The settings of the legs.
    pub settings: &'a LegSettings,
}

/// Largest number of functions that tell whether a chain reaches a pose.
pub const REACH_FORMS: usize = 4;

/// A bar from `A_i` to `B_i` over a box of poses, in the distal axes and in multiples of `L_b`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProximalEnclosure {
    /// Vector from `A_i` to `B_i`.
    pub vector: PlanarModel,
    /// Unit vector along the bar.
    pub direction: PlanarModel,
    /// Length, ≥ 0.
    pub length: TaylorModel,
    /// Distance from `A_i` to `B_i` along `direction`.
    pub offset: TaylorModel,
}

/// A chain over a box of poses; lengths are multiples of `L_b` unless stated otherwise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChainEnclosure {
    /// Each of these is positive exactly where the chain reaches the pose within its limits; those that do not exist are 1.
    pub reach: [TaylorModel; REACH_FORMS],
    /// Unit vector along the distal bar, in base axes.
    pub tangent: PlanarModel,
    /// Distance from `B_i` to `C_i` along `tangent`.
    pub offset: TaylorModel,
    /// Length of the distal bar in the beam model, ≥ 0.
    pub beam: TaylorModel,
    /// The same length with the sign of `offset`.
    pub signed_beam: TaylorModel,
    /// Distances of the slider from the two ends of its rail, for chains on rails \[m\].
    pub slider: Option<[TaylorModel; 2]>,
    /// Bar from `A_i` to `B_i`, for chains that have one.
    pub proximal: Option<ProximalEnclosure>,
    /// Unit vectors along which the prismatic joints move the platform, in the distal axes.
    pub guides: [Option<PlanarModel>; 3],
    /// Square of the lever of the first joint about the line of the distal bar, where it has a narrower form than the general one.
    pub lever_square: Option<TaylorModel>,
}

impl ChainEnclosure {
    /// Creates a chain without slider and without a bar from `A_i` to `B_i`; `beam` is the length of the distal bar in the beam model.
    pub(super) fn new(
        reach: [TaylorModel; REACH_FORMS],
        tangent: PlanarModel,
        [offset, beam]: [TaylorModel; 2],
        guides: [Option<PlanarModel>; 3],
    ) -> Self {
        Self {
            reach,
            tangent,
            offset,
            beam,
            signed_beam: offset,
            slider: None,
            proximal: None,
            guides,
            lever_square: None,
        }
    }
}
