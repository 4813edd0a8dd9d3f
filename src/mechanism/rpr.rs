//! 3-RPR: telescopic leg `A_iC_i` of length `ρ_i` between a share of `L_b` and `L_b`.

use glam::DVec2;

use super::{
    Actuator, BarLength, Design, Leg, LegLanes, LegPart, LegPosture, LegSettings, ReachReason, Segment, Shortfall,
};
use crate::lanes::{Planar, Real};
use crate::spatial::ANCHOR_DIRECTIONS;

/// A leg of the 3-RPR.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RprLeg {
    anchor: DVec2,
    shortest: f64,
    longest: f64,
    bar: BarLength,
}

impl Leg for RprLeg {
    const NAME: &'static str = "3-RPR";
    const ACTUATOR: Actuator = Actuator::Prismatic;
    const HAS_WORKING_MODES: bool = false;
    const BARS: usize = 1;

    fn new(design: &Design, settings: &LegSettings, index: usize) -> Self {
        Self {
            anchor: ANCHOR_DIRECTIONS[index] * design.base_radius,
            shortest: settings.telescopic_shortest * design.link_length,
            longest: design.link_length,
            bar: settings.telescopic_bar,
        }
    }

    #[inline]
    fn inverse(&self, c: DVec2) -> Result<LegPosture, Shortfall> {
        let leg = c - self.anchor;
        let length = leg.length();
        if length < self.shortest {
            return Err(Shortfall {
                slack: length - self.shortest,
                reason: ReachReason::BelowLimit,
            });
        }
        if length > self.longest {
            return Err(Shortfall {
                slack: self.longest - length,
                reason: ReachReason::AboveLimit,
            });
        }
        if length == 0.0 {
            return Err(Shortfall {
                slack: 0.0,
                reason: ReachReason::Degenerate,
            });
        }
        Ok(LegPosture {
            b: self.anchor,
            u: leg / length,
            length,
            drive: 1.0,
            slack: (length - self.shortest).min(self.longest - length),
        })
    }

    #[inline(always)]
    fn lanes<V: Real>(&self, position: Planar<V>, arm: Planar<V>) -> LegLanes<V> {
        let like = position.x;
        let leg = position.plus(arm.minus(Planar::splat(like, self.anchor)));
        let length = leg.dot(leg).sqrt();
        let (zero, one) = (like.splat(0.0), like.splat(1.0));
        let slack = (length - like.splat(self.shortest)).smaller(like.splat(self.longest) - length);
        let u = leg.scaled(one / length);
        LegLanes {
            u,
            moment: arm.cross(u),
            along: arm.dot(u),
            drive: one,
            distal: match self.bar {
                BarLength::Current => length,
                BarLength::Longest => like.splat(self.longest),
            },
            proximal: None,
            slack,
            reachable: slack.at_least(zero) & length.exceeds(zero),
        }
    }

    fn actuator(&self, posture: &LegPosture) -> f64 {
        posture.length
    }

    fn actuator_axis(&self, posture: &LegPosture) -> Option<DVec2> {
        Some(posture.u)
    }

    fn anchor(&self) -> DVec2 {
        self.anchor
    }

    fn parts(&self, posture: &LegPosture) -> Vec<LegPart> {
        let along = |length: f64| self.anchor + posture.u * length;
        // The two halves of a leg that doubles its length are as long as it is at its shortest.
        let mouth = along((0.5 * self.longest).min(posture.length));
        let c = along(posture.length);
        vec![
            LegPart::Stroke {
                from: along(self.shortest),
                to: along(self.longest),
            },
            LegPart::Tube {
                from: self.anchor,
                to: mouth,
            },
            LegPart::Rod { from: mouth, to: c },
            LegPart::Joint {
                at: self.anchor,
                actuated: false,
            },
            LegPart::Joint {
                at: mouth,
                actuated: true,
            },
            LegPart::Joint { at: c, actuated: false },
        ]
    }

    fn reach_box(&self) -> [DVec2; 2] {
        let reach = DVec2::splat(self.longest);
        [self.anchor - reach, self.anchor + reach]
    }

    #[inline]
    fn distal_length(&self, posture: &LegPosture) -> f64 {
        match self.bar {
            BarLength::Current => posture.length,
            BarLength::Longest => self.longest,
        }
    }

    #[inline]
    fn proximal_bar(&self, _: &LegPosture) -> Option<Segment> {
        None
    }
}
