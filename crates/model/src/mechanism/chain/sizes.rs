//! The constants of one leg of one design, and what follows from them and the kinds of its members for every chain.

use glam::DVec2;

use super::{Assembly, ChainDescription, ChainPosture};
use crate::lanes::{Planar, Real};
use crate::mechanism::{BarLength, Design, JointKind, LegFrame, LegSettings, MemberKind, Travel, TravelKind};
use crate::spatial::{Rotation, cross};

/// The constants of one leg of one design, whatever its chain; lengths in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegSizes {
    /// What is known of the chain without any lengths.
    pub chain: &'static ChainDescription,
    /// The place of the leg in the manipulator.
    pub frame: LegFrame,
    /// `L_a`.
    pub proximal: f64,
    /// `L_b`.
    pub link: f64,
    /// Smallest and largest values of the second and the third joint, where these are prismatic.
    pub travels: [[f64; 2]; 2],
    /// `e'_i`: direction of a guide on a slider.
    pub slider_guide: DVec2,
    /// Length of the tube of a telescopic leg.
    pub tube: f64,
    /// Length of the distal bar in the beam model, if it is not the distance from `B_i` to `C_i`.
    pub beam: Option<f64>,
}

/// Returns an angle in (−π, π] \[rad\].
fn wrapped(angle: f64) -> f64 {
    let wrapped = libm::remainder(angle, 2.0 * std::f64::consts::PI);
    if wrapped == -std::f64::consts::PI {
        -wrapped
    } else {
        wrapped
    }
}

/// Returns the angle of a vector to `Ox` \[rad\].
fn angle_of(vector: DVec2) -> f64 {
    libm::atan2(vector.y, vector.x)
}

/// Returns the largest distance that a travel allows from its origin \[m\].
fn farthest(travel: [f64; 2]) -> f64 {
    travel[0].abs().max(travel[1].abs())
}

impl LegSizes {
    /// Returns the constants of leg `index` (0, 1, 2) of `design`.
    pub fn new(design: &Design, settings: &LegSettings, index: usize) -> Self {
        let chain = design.architecture().chain();
        let frame = LegFrame::new(design, &settings.geometry, index);
        let (proximal, link) = (design.proximal_length(), design.link_length());
        let second = match chain.proximal {
            Some(MemberKind::TurningGuide) => settings.geometry.travel(proximal),
            Some(_) => settings.geometry.travel(link),
            None => [settings.telescopic_shortest * link, link],
        };
        let is_always_longest =
            chain.distal == MemberKind::TelescopicLeg && settings.telescopic_bar == BarLength::Longest;
        Self {
            chain,
            frame,
            proximal,
            link,
            travels: [second, settings.geometry.travel(link)],
            slider_guide: Rotation::by(frame.between_guides).apply(frame.rail),
            tube: settings.tube_length(link),
            beam: is_always_longest.then_some(link),
        }
    }

    /// Returns the vector from `A_i` to `C_i` at several poses at once, with `C_i` at `position + arm`.
    #[inline(always)]
    pub(in crate::mechanism) fn chord<V: Real>(&self, position: Planar<V>, arm: Planar<V>) -> Planar<V> {
        position.plus(arm.minus(Planar::splat(position.x, self.frame.anchor)))
    }

    /// Returns the values of the three joints \[m or rad\], angles in (−π, π].
    pub(in crate::mechanism) fn joint_values(&self, posture: &ChainPosture, arm: DVec2) -> [f64; 3] {
        use JointKind::{Prismatic, Revolute};
        let orientation = self.frame.orientation(arm);
        let distal = posture.distal;
        let from_base = posture.b - posture.a;
        // Angle of the member that the first joint moves, and the value of this joint.
        let angle = angle_of(match self.chain.proximal {
            Some(MemberKind::Slider) => self.frame.rail,
            Some(MemberKind::Crank) => from_base,
            _ => distal.direction,
        });
        let first = if self.chain.is_on_rails() {
            from_base.dot(self.frame.rail)
        } else {
            wrapped(angle)
        };
        match self.chain.joints {
            [_, Revolute, Revolute] => {
                let link = angle_of(distal.direction);
                [first, wrapped(link - angle), wrapped(orientation - link)]
            }
            [_, Revolute, Prismatic] => [first, wrapped(orientation - angle), distal.offset],
            [_, Prismatic, Revolute] => [first, distal.offset, wrapped(orientation - angle)],
            // Both guides turn with the platform.
            [_, Prismatic, Prismatic] => {
                let along = posture.proximal.map_or(0.0, |bar| bar.offset);
                [wrapped(orientation), along, distal.offset]
            }
        }
    }

    /// Returns the smallest and largest values of the three joints \[m\]; `None` for a joint without limits.
    pub(in crate::mechanism) fn joint_limits(&self) -> [Option<[f64; 2]>; 3] {
        let [second, third] = self.travels;
        let travels = [self.frame.rail_travel, second, third];
        [0, 1, 2].map(|joint| (self.chain.joints[joint] == JointKind::Prismatic).then_some(travels[joint]))
    }

    /// Returns the travels of the prismatic joints that the scene shows.
    pub(in crate::mechanism) fn shown_travels(&self, posture: &ChainPosture) -> Vec<Travel> {
        let (kind, [from, to]) = match self.chain.proximal {
            Some(MemberKind::Slider) => (TravelKind::Rail, self.frame.rail_ends()),
            Some(_) => return Vec::new(),
            None => {
                let along = |length: f64| posture.a + posture.distal.direction * length;
                (TravelKind::Stroke, self.travels[0].map(along))
            }
        };
        vec![Travel { kind, from, to }]
    }

    /// Returns the lower and upper corner of an axis-aligned box that contains every point that the end of the leg can reach \[m\].
    pub(in crate::mechanism) fn reach_box(&self) -> [DVec2; 2] {
        let of_proximal = match self.chain.proximal {
            Some(MemberKind::Crank) => self.proximal,
            Some(MemberKind::TurningGuide) => farthest(self.travels[0]),
            _ => 0.0,
        };
        let of_distal = match self.chain.distal {
            MemberKind::Guide => farthest(self.travels[1]),
            _ => self.link,
        };
        let reach = DVec2::splat(of_proximal + of_distal);
        let [first, second] = if self.chain.is_on_rails() {
            self.frame.rail_ends()
        } else {
            [self.frame.anchor; 2]
        };
        [first.min(second) - reach, first.max(second) + reach]
    }

    /// Returns the length of the guide at the base (0) or on the platform (1), or its farthest place from its origin if that is larger.
    pub(in crate::mechanism) fn longest_guide(&self, place: usize) -> f64 {
        [self.proximal, self.link][place].max(farthest(self.travels[place]))
    }

    /// Returns what g1 compares: `reach + r_i` against what they have to bridge.
    pub(in crate::mechanism) fn assembly(&self, reach: f64, threshold: f64) -> Assembly {
        Assembly {
            value: reach + self.frame.arm_length,
            threshold,
        }
    }

    /// Returns the same for a leg on a rail, which has to bridge the distance of `O` from the line of the rail.
    pub(in crate::mechanism) fn assembly_from_rail(&self, reach: f64) -> Assembly {
        self.assembly(reach, cross(self.frame.rail, self.frame.anchor).abs())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::BarPosture;

    /// A leg that points against the axis `Ox` has the angle π, whatever the sign of the zero beside it.
    #[test]
    fn angles_of_base_joints_are_above_minus_pi() {
        let design: Design = "3-RPR R=1 r=0.2 Lb=1.2 rj=0.02 rp=0.03".parse().expect("a design");
        let leg = LegSizes::new(&design, &LegSettings::default(), 0);
        let (a, along) = (leg.frame.anchor, 0.9);
        for zero in [0.0, -0.0] {
            let direction = DVec2::new(-1.0, zero);
            let posture = ChainPosture {
                a,
                b: a,
                c: a + direction * along,
                slider: None,
                proximal: None,
                distal: BarPosture::new(direction, along),
                beam: along,
                guides: [None, Some(direction), None],
                limit_margin: 0.1,
            };
            let [first, second, _] = leg.joint_values(&posture, DVec2::X);
            assert_eq!([first, second], [std::f64::consts::PI, along], "{direction}");
        }
    }
}
