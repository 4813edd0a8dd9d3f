//! Enclosures of what a leg is over a box of poses.

use super::chain::ChainEnclosure;
use super::{Design, DesignVariable, Geometry};
use crate::enclosure::{Interval, PlanarModel, PoseEnclosure, TaylorModel, TurnedFrame, cross, dot};
use crate::spatial::LEGS;

/// The place of a leg in the manipulator as intervals: angles in degrees, lengths and multiples are the doubles given, and all that
/// follows from them is exact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegFrameEnclosure {
    /// `A_i` \[m\].
    pub anchor: [Interval; 2],
    /// `e_i`.
    pub rail: [Interval; 2],
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
    /// Cosine and sine of `γ`.
    pub platform_guide: TurnedFrame,
    /// Cosine and sine of `β`.
    pub between_guides: [Interval; 2],
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
        let direction = |angle: f64| TurnedFrame::by_degrees(angle).axis();
        let joint = |index: usize| {
            let radius = exactly(geometry.base_radii[index]);
            direction(geometry.base_angles_deg[index]).map(|part| part * radius)
        };
        let (base, platform, link) = (
            exactly(design.base_radius),
            exactly(design.platform_radius),
            exactly(design.link_length),
        );
        let (own, next) = (joint(index), joint((index + 1) % LEGS));
        let side = [next[0] - own[0], next[1] - own[1]];
        let length = (side[0].square() + side[1].square()).sqrt();
        let turn = direction(design.value(DesignVariable::RailAngle) + geometry.rail_turn_deg[index]);
        let one = exactly(1.0);
        let arm_multiple = exactly(geometry.platform_radii[index]);
        Self {
            anchor: own.map(|part| part * base),
            rail: [
                (turn[0] * side[0] - turn[1] * side[1]) / length,
                (turn[1] * side[0] + turn[0] * side[1]) / length,
            ],
            rail_travel: geometry.rail.map(|share| exactly(share) * length * base),
            arm_frame: TurnedFrame::by_degrees(geometry.platform_angles_deg[index]),
            arm_multiple,
            arm_length: arm_multiple * platform,
            platform_radius: platform / link,
            per_platform_radius: link / platform,
            platform_guide: TurnedFrame::by_degrees(design.value(DesignVariable::PlatformGuideAngle)),
            between_guides: direction(design.value(DesignVariable::GuideAngle)),
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

    /// Encloses the vector from `A_i` to `C_i`, in units of `L_b`.
    pub fn vector(&self, pose: &PoseEnclosure) -> PlanarModel {
        let arm = self.arm(pose);
        [0, 1].map(|k| {
            (pose.position[k] + arm[k].scaled(self.arm_length))
                .plus(-self.anchor[k])
                .scaled(self.to_unit)
        })
    }

    /// Encloses `g_i`, the direction of the guide on the platform.
    pub fn guide(&self, pose: &PoseEnclosure) -> PlanarModel {
        self.platform_guide.leave(self.arm(pose))
    }

    /// Turns a vector by `β`.
    pub fn turned_between_guides(&self, [x, y]: PlanarModel) -> PlanarModel {
        let [cosine, sine] = self.between_guides;
        [x.scaled(cosine) - y.scaled(sine), x.scaled(sine) + y.scaled(cosine)]
    }

    /// Returns the components of a vector along the rail and to its left.
    pub fn enter_rail(&self, vector: PlanarModel) -> PlanarModel {
        let rail = self.rail.map(TaylorModel::constant);
        [dot(rail, vector), cross(rail, vector)]
    }

    /// Returns a vector that is given along the rail and to its left.
    pub fn leave_rail(&self, [along, across]: PlanarModel) -> PlanarModel {
        let [x, y] = self.rail;
        [along.scaled(x) - across.scaled(y), along.scaled(y) + across.scaled(x)]
    }

    /// Returns a vector of the length `L_a` as a unit vector.
    pub fn along_proximal(&self, vector: PlanarModel) -> PlanarModel {
        let to_unit = Interval::exactly(1.0) / self.proximal;
        vector.map(|part| part.scaled(to_unit))
    }

    /// Encloses the distances of a slider from both ends of its travel \[m\].
    pub fn within_rail(&self, value: TaylorModel) -> [TaylorModel; 2] {
        let [lower, upper] = self.rail_travel;
        [value.plus(-lower), TaylorModel::constant(upper) - value]
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
