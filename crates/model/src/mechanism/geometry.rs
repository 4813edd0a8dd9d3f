//! Arrangement of the base and platform joints and travel of the guides, which a study fixes (docs/model.md, section 2.7).

use glam::DVec2;

use super::Design;
use crate::lanes::{Planar, Real};
use crate::spatial::{LEGS, Rotation, direction_deg};

/// Arrangement of the joints and travel of the guides. The default is the paper's: both triangles equilateral, rails along the
/// sides of the base.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arrangement {
    /// Directions of the base joints `A_i` from `O` \[deg\].
    pub base_angles_deg: [f64; LEGS],
    /// Distances `|OA_i|` as multiples of `R`.
    pub base_radii: [f64; LEGS],
    /// Directions of the platform joints `c_i` in the platform frame \[deg\].
    pub platform_angles_deg: [f64; LEGS],
    /// Distances `|PC_i|` as multiples of `r`.
    pub platform_radii: [f64; LEGS],
    /// `δ_i`: turn of each rail in addition to `α` \[deg\].
    pub rail_turn_deg: [f64; LEGS],
    /// Travel of a slider on its rail, as multiples of `|A_iA_{i+1}|`.
    pub rail: [f64; 2],
    /// Travel along every other guide, as multiples of `L_b`, or of `L_a` for the guide at the base of an RPP leg. A telescopic
    /// leg has its own limits.
    pub guide: [f64; 2],
}

impl Arrangement {
    /// Arrangement of the paper.
    pub const PAPER: Arrangement = Arrangement {
        base_angles_deg: [210.0, 330.0, 90.0],
        base_radii: [1.0; LEGS],
        platform_angles_deg: [210.0, 330.0, 90.0],
        platform_radii: [1.0; LEGS],
        rail_turn_deg: [0.0; LEGS],
        rail: [0.0, 1.0],
        guide: [0.0, 1.0],
    };
}

impl Default for Arrangement {
    fn default() -> Self {
        Self::PAPER
    }
}

/// An [`Arrangement`], prepared for many designs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Geometry {
    arrangement: Arrangement,
    /// Base joints for `R` = 1 m.
    base: [DVec2; LEGS],
    /// Unit vectors along the rails for `α` = 0.
    rails: [DVec2; LEGS],
    /// Smallest and largest distances of the sliders from `A_i` for `R` = 1 m.
    rail_travels: [[f64; 2]; LEGS],
    /// Platform joints for `r` = 1 m.
    platform: [DVec2; LEGS],
    is_three_fold: bool,
}

impl Default for Geometry {
    fn default() -> Self {
        Arrangement::PAPER.into()
    }
}

impl From<Arrangement> for Geometry {
    fn from(arrangement: Arrangement) -> Self {
        let joint = |angles: &[f64; LEGS], radii: &[f64; LEGS], i: usize| direction_deg(angles[i]) * radii[i];
        let base = [0, 1, 2].map(|i| joint(&arrangement.base_angles_deg, &arrangement.base_radii, i));
        let side = |i: usize| base[(i + 1) % LEGS] - base[i];
        Self {
            base,
            rails: [0, 1, 2].map(|i| {
                let (side, length) = (side(i), side(i).length());
                // Two base joints that coincide leave no direction; a study that needs one refuses them.
                let along = if length > 0.0 { side / length } else { DVec2::X };
                Rotation::by(direction_deg(arrangement.rail_turn_deg[i])).apply(along)
            }),
            rail_travels: [0, 1, 2].map(|i| arrangement.rail.map(|share| share * side(i).length())),
            platform: [0, 1, 2].map(|i| joint(&arrangement.platform_angles_deg, &arrangement.platform_radii, i)),
            is_three_fold: arrangement.is_three_fold(),
            arrangement,
        }
    }
}

impl Arrangement {
    /// Returns whether a rotation by 120° maps base and platform onto themselves.
    fn is_three_fold(&self) -> bool {
        let steps = |angles: &[f64; LEGS]| {
            let step = |from: f64, to: f64| (to - from - 120.0).rem_euclid(360.0) == 0.0;
            step(angles[0], angles[1]) && step(angles[1], angles[2])
        };
        let equal = |values: &[f64; LEGS]| values[0] == values[1] && values[1] == values[2];
        steps(&self.base_angles_deg)
            && steps(&self.platform_angles_deg)
            && equal(&self.base_radii)
            && equal(&self.platform_radii)
            && equal(&self.rail_turn_deg)
    }
}

impl Geometry {
    /// The arrangement as a study states it.
    pub fn arrangement(&self) -> &Arrangement {
        &self.arrangement
    }

    /// Returns the base joint `A_i` of leg `index` for the base radius `R` \[m\].
    pub fn base_joint(&self, index: usize, base_radius: f64) -> DVec2 {
        self.base[index] * base_radius
    }

    /// Returns the platform joint `c_i` of leg `index` in the platform frame for the platform radius `r` \[m\].
    pub fn platform_joint(&self, index: usize, platform_radius: f64) -> DVec2 {
        self.platform[index] * platform_radius
    }

    /// Returns `|PC_i|` \[m\].
    pub fn platform_length(&self, index: usize, platform_radius: f64) -> f64 {
        self.arrangement.platform_radii[index] * platform_radius
    }

    /// Returns whether a rotation by 120° maps base and platform onto themselves.
    pub fn is_three_fold(&self) -> bool {
        self.is_three_fold
    }

    /// Returns the mean length of the platform bars as a multiple of `r`, by which the mass of a platform is larger than that of a
    /// regular one.
    pub fn mean_platform_radius(&self) -> f64 {
        (self.arrangement.platform_radii[0]
            + self.arrangement().platform_radii[1]
            + self.arrangement().platform_radii[2])
            / LEGS as f64
    }

    /// Returns the smallest and the largest distance of the slider of leg `index` from `A_i` for the base radius `R` \[m\].
    pub fn rail_travel(&self, index: usize, base_radius: f64) -> [f64; 2] {
        self.rail_travels[index].map(|value| value * base_radius)
    }

    /// Returns the smallest and the largest distance along a guide of length `length` \[m\].
    pub(crate) fn travel(&self, length: f64) -> [f64; 2] {
        self.arrangement.guide.map(|share| share * length)
    }
}

/// What a chain needs to know of its place in the manipulator; lengths in metres, in the base frame unless stated otherwise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegFrame {
    /// `A_i`.
    pub anchor: DVec2,
    /// `|OA_i|`.
    pub anchor_distance: f64,
    /// `e_i`: unit vector along the rail.
    pub rail: DVec2,
    /// Smallest and largest distance `ρ_i` of a slider from `A_i`.
    pub rail_travel: [f64; 2],
    /// `|PC_i|`.
    pub arm_length: f64,
    /// Angle of `c_i` in the platform frame \[rad\].
    pub arm_angle: f64,
    /// `c_i`, in the platform frame.
    pub platform_joint: DVec2,
    /// Cosine and sine of `γ`, the angle from `c_i` to the guide on the platform.
    pub platform_guide: DVec2,
    /// Cosine and sine of `β`, the angle between the two guides of a leg.
    pub between_guides: DVec2,
    /// Sign of the working mode.
    pub sign: f64,
}

impl LegFrame {
    /// Returns the frame of leg `index` (0, 1, 2) of `design`.
    pub fn new(design: &Design, geometry: &Geometry, index: usize) -> Self {
        let turned = |angle: f64, vector: DVec2| {
            if angle == 0.0 {
                vector
            } else {
                Rotation::by(direction_deg(angle)).apply(vector)
            }
        };
        Self {
            anchor: geometry.base_joint(index, design.base_radius()),
            anchor_distance: geometry.arrangement.base_radii[index] * design.base_radius(),
            rail: turned(design.rail_angle_deg(), geometry.rails[index]),
            rail_travel: geometry.rail_travel(index, design.base_radius()),
            arm_length: geometry.arrangement.platform_radii[index] * design.platform_radius(),
            arm_angle: geometry.arrangement.platform_angles_deg[index].to_radians(),
            platform_joint: geometry.platform_joint(index, design.platform_radius()),
            platform_guide: turned(design.platform_guide_angle_deg(), DVec2::X),
            between_guides: if design.guide_angle_deg() == 90.0 {
                DVec2::Y
            } else {
                direction_deg(design.guide_angle_deg())
            },
            sign: design.working_mode().sign(index),
        }
    }

    /// Returns the unit vector `g_i` along the guide on the platform, for `arm` = `C_i − P`.
    pub fn platform_guide(&self, arm: DVec2) -> DVec2 {
        Rotation::by(self.platform_guide).apply(arm) / self.arm_length
    }

    /// Returns the distances of a slider at `b` from both ends of its rail, negative beyond them \[m\].
    #[inline(always)]
    pub fn from_rail_ends<V: Real>(&self, b: Planar<V>) -> [V; 2] {
        let like = b.x;
        let along = b
            .minus(Planar::splat(like, self.anchor))
            .dot(Planar::splat(like, self.rail));
        let [lower, upper] = self.rail_travel;
        [along - like.splat(lower), like.splat(upper) - along]
    }

    /// Returns the ends of the rail.
    pub fn rail_ends(&self) -> [DVec2; 2] {
        self.rail_travel.map(|value| self.anchor + self.rail * value)
    }

    /// Returns `φ` \[rad\] for `arm` = `C_i − P`.
    pub fn orientation(&self, arm: DVec2) -> f64 {
        libm::atan2(arm.y, arm.x) - self.arm_angle
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spatial::{ANCHOR_DIRECTIONS, HALF_SQRT_3};

    /// The default must give the paper's triangles to the bit, because recorded designs are compared to the bit.
    #[test]
    fn the_default_is_the_paper_s() {
        let geometry = Geometry::default();
        let design: Design = "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056"
            .parse()
            .expect("a design");
        assert!(geometry.is_three_fold());
        for index in 0..LEGS {
            let frame = LegFrame::new(&design, &geometry, index);
            let side = ANCHOR_DIRECTIONS[(index + 1) % LEGS] - ANCHOR_DIRECTIONS[index];
            assert_eq!(frame.anchor, ANCHOR_DIRECTIONS[index] * design.base_radius());
            assert_eq!(frame.rail, side / (2.0 * HALF_SQRT_3));
            assert_eq!(frame.rail_travel, [0.0, 2.0 * HALF_SQRT_3 * design.base_radius()]);
            assert_eq!(
                geometry.platform_joint(index, design.platform_radius()),
                ANCHOR_DIRECTIONS[index] * design.platform_radius()
            );
        }
    }

    #[test]
    fn a_change_of_one_leg_breaks_the_symmetry() {
        let symmetric = |change: fn(&mut Arrangement)| {
            let mut arrangement = Arrangement::PAPER;
            change(&mut arrangement);
            Geometry::from(arrangement).is_three_fold()
        };
        assert!(!symmetric(|found| found.platform_angles_deg = [330.0, 210.0, 90.0]));
        assert!(!symmetric(|found| found.rail_turn_deg[1] = 90.0));
        assert!(!symmetric(|found| found.base_radii[2] = 1.1));
        assert!(symmetric(|found| found.base_angles_deg = [-150.0, -30.0, 450.0]));
        assert!(symmetric(|found| found.rail_turn_deg = [30.0; LEGS]));
    }
}
