//! 3-RRR: crank `A_iB_i` and link `B_iC_i`, both of length `L_b`.

use glam::DVec2;

use super::{Actuator, Design, Leg, LegPart, LegPosture, LegSettings, ReachReason, Segment, Shortfall};
use crate::spatial::{ANCHOR_DIRECTIONS, cross};

/// A leg of the 3-RRR.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RrrLeg {
    anchor: DVec2,
    link: f64,
    sign: f64,
}

impl Leg for RrrLeg {
    const NAME: &'static str = "3-RRR";
    const ACTUATOR: Actuator = Actuator::Revolute;
    const HAS_WORKING_MODES: bool = true;
    const BARS: usize = 2;

    fn new(design: &Design, _: &LegSettings, index: usize) -> Self {
        Self {
            anchor: ANCHOR_DIRECTIONS[index] * design.base_radius,
            link: design.link_length,
            sign: design.working_mode.sign(index),
        }
    }

    #[inline]
    fn inverse(&self, c: DVec2) -> Result<LegPosture, Shortfall> {
        let chord = c - self.anchor;
        let distance = chord.length();
        let half = 0.5 * distance;
        let slack = 2.0 * self.link - distance;
        if slack < 0.0 {
            return Err(Shortfall {
                slack,
                reason: ReachReason::OutOfReach,
            });
        }
        if distance == 0.0 {
            return Err(Shortfall {
                slack: 0.0,
                reason: ReachReason::Degenerate,
            });
        }
        let elbow = self.sign * ((self.link - half) * (self.link + half)).sqrt();
        let normal = chord.perp() / distance;
        let crank = chord * 0.5 + normal * elbow;
        let b = self.anchor + crank;
        let u = (c - b) / self.link;
        Ok(LegPosture {
            b,
            u,
            length: self.link,
            drive: cross(crank, u),
            slack,
        })
    }

    fn actuator(&self, posture: &LegPosture) -> f64 {
        let crank = posture.b - self.anchor;
        libm::atan2(crank.y, crank.x)
    }

    fn actuator_axis(&self, _: &LegPosture) -> Option<DVec2> {
        None
    }

    fn anchor(&self) -> DVec2 {
        self.anchor
    }

    fn parts(&self, posture: &LegPosture) -> Vec<LegPart> {
        let c = posture.b + posture.u * posture.length;
        vec![
            LegPart::Crank {
                from: self.anchor,
                to: posture.b,
            },
            LegPart::Link { from: posture.b, to: c },
            LegPart::Joint {
                at: self.anchor,
                actuated: true,
            },
            LegPart::Joint {
                at: posture.b,
                actuated: false,
            },
            LegPart::Joint { at: c, actuated: false },
        ]
    }

    fn reach_box(&self) -> [DVec2; 2] {
        let reach = DVec2::splat(2.0 * self.link);
        [self.anchor - reach, self.anchor + reach]
    }

    #[inline]
    fn distal_length(&self, _: &LegPosture) -> f64 {
        self.link
    }

    #[inline]
    fn proximal_bar(&self, posture: &LegPosture) -> Option<Segment> {
        Some(Segment {
            from: self.anchor,
            to: posture.b,
        })
    }
}
