//! Enclosures of what a leg is over a box of poses.

use super::chain::{ChainEnclosure, ProximalEnclosure};
use super::{Design, DesignVariable, Geometry};
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
            let radius = exactly(geometry.base_radii[index]);
            let direction = TurnedFrame::by_degrees(geometry.base_angles_deg[index]).axis();
            direction.map(|part| part * radius)
        };
        let (base, platform, link) = (
            exactly(design.base_radius),
            exactly(design.platform_radius),
            exactly(design.link_length),
        );
        let (own, next) = (joint(index), joint((index + 1) % LEGS));
        let side = [next[0] - own[0], next[1] - own[1]];
        let length = (side[0].square() + side[1].square()).sqrt();
        let turn = design.value(DesignVariable::RailAngle) + geometry.rail_turn_deg[index];
        let [cosine, sine] = TurnedFrame::by_degrees(turn).axis();
        let one = exactly(1.0);
        let arm_multiple = exactly(geometry.platform_radii[index]);
        Self {
            anchor: own.map(|part| part * base),
            rail: TurnedFrame::along([
                (cosine * side[0] - sine * side[1]) / length,
                (sine * side[0] + cosine * side[1]) / length,
            ]),
            rail_travel: geometry.rail.map(|share| exactly(share) * length * base),
            arm_frame: TurnedFrame::by_degrees(geometry.platform_angles_deg[index]),
            arm_multiple,
            arm_length: arm_multiple * platform,
            platform_radius: platform / link,
            per_platform_radius: link / platform,
            platform_guide: TurnedFrame::by_degrees(design.value(DesignVariable::PlatformGuideAngle)),
            between_guides: TurnedFrame::by_degrees(design.value(DesignVariable::GuideAngle)),
            guide_travel: geometry.guide.map(exactly),
            link,
            to_unit: one / link,
            proximal: exactly(design.proximal_length) / link,
            sign: design.working_mode.sign(index),
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

/// Loads of the bars of a leg whose line is not that of its distal bar, with moments as multiples of `L_b`. Each holds the
/// component of the force along the bar, then the moments about its proximal and its distal end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnclosedLoads {
    /// Bar from `B_i` to `C_i`.
    pub distal: [TaylorModel; 3],
    /// Bar from `A_i` to `B_i`; meaningless if there is none.
    pub proximal: [TaylorModel; 3],
    /// Bar from `C_i` to `P`; the component of the force is multiplied by `r_i/r`.
    pub platform: [TaylorModel; 3],
}

/// What the constraints need of a leg, over a box of poses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegEnclosure {
    /// The chain.
    pub chain: ChainEnclosure,
    /// Unit vector from `P` to `C_i`.
    pub arm: PlanarModel,
    /// `u_i` in base axes.
    pub u: PlanarModel,
    /// Moment of the leg's line about `P`, as a multiple of `r`.
    pub moment: TaylorModel,
    /// Component of `C_i − P` along the distal bar, as a multiple of `r`.
    pub along: TaylorModel,
    /// Moment about `P` of a unit vector on the line of the distal bar, as a multiple of `r`.
    pub across: TaylorModel,
    /// Square of the transmission `B_ii`, in units of `L_b` for a revolute joint.
    pub transmission_square: TaylorModel,
    /// Loads of the bars; `None` if the line is that of the distal bar.
    pub loads: Option<EnclosedLoads>,
}
