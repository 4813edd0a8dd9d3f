//! 3-RPR: telescopic leg `A_iC_i` whose length `ρ_i` lies between a fraction of `L_b` and `L_b` (docs/model.md,
//! section 2.3).

use glam::DVec2;

use super::leg::leg_vector;
use super::{
    Actuator, BarLength, Design, Guide, Leg, LegBody, LegJoint, LegLanes, LegPart, LegPosture, LegSettings, MemberAxis,
    MemberKind, Members, ReachReason, Segment, Shortfall,
};
use crate::enclosure::{
    AxisEnclosure, Interval, LegEnclosure, MembersEnclosure, PlanarModel, PoseEnclosure, TaylorModel, TurnedFrame,
    cross as cross_models, difference, dot,
};
use crate::lanes::{Planar, Real};
use crate::spatial::ANCHOR_DIRECTIONS;

/// Leg of a 3-RPR.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RprLeg {
    anchor: DVec2,
    shortest: f64,
    longest: f64,
    bar: BarLength,
}

impl RprLeg {
    /// Returns the length of the tube \[m\]: half of the largest leg length, so that the leg can retract to half of it.
    /// If the smallest leg length is shorter than that, the tube has this length and the rod can protrude behind it.
    fn tube(&self) -> f64 {
        (0.5 * self.longest).min(self.shortest)
    }
}

impl Leg for RprLeg {
    const NAME: &'static str = "3-RPR";
    const ACTUATOR: Actuator = Actuator::Prismatic;
    const HAS_WORKING_MODES: bool = false;
    const BARS: usize = 1;
    const PROXIMAL: Option<MemberKind> = None;
    const DISTAL: MemberKind = MemberKind::TelescopicLeg;

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
                limit_margin: length - self.shortest,
                reason: ReachReason::BelowLimit,
            });
        }
        if length > self.longest {
            return Err(Shortfall {
                limit_margin: self.longest - length,
                reason: ReachReason::AboveLimit,
            });
        }
        if length == 0.0 {
            return Err(Shortfall {
                limit_margin: 0.0,
                reason: ReachReason::Degenerate,
            });
        }
        Ok(LegPosture {
            b: self.anchor,
            u: leg / length,
            length,
            transmission: 1.0,
            limit_margin: (length - self.shortest).min(self.longest - length),
        })
    }

    #[inline(always)]
    fn lanes<V: Real>(&self, position: Planar<V>, arm: Planar<V>) -> LegLanes<V> {
        let like = position.x;
        let leg = position.plus(arm.minus(Planar::splat(like, self.anchor)));
        let length = leg.dot(leg).sqrt();
        let (zero, one) = (like.splat(0.0), like.splat(1.0));
        let limit_margin = (length - like.splat(self.shortest)).smaller(like.splat(self.longest) - length);
        let u = leg.scaled(one / length);
        LegLanes {
            u,
            moment: arm.cross(u),
            along: arm.dot(u),
            transmission: one,
            distal: match self.bar {
                BarLength::Current => length,
                BarLength::Longest => like.splat(self.longest),
            },
            proximal: None,
            limit_margin,
            reachable: limit_margin.at_least(zero) & length.exceeds(zero),
        }
    }

    /// In axes in which `A_i` stands at `(R, 0)`, the leg is the vector `v = p + r (cos φ, sin φ) − (R, 0)`.
    fn enclose(design: &Design, settings: &LegSettings, index: usize, pose: &PoseEnclosure) -> LegEnclosure {
        let frame = TurnedFrame::of_leg(index);
        let leg = leg_vector(design, &frame, pose);
        let one = TaylorModel::exactly(1.0);
        let square = dot(leg, leg);
        let shortest = Interval::exactly(settings.telescopic_shortest);
        let length = square.sqrt();
        let to_unit = length.reciprocal();
        let u = leg.map(|part| part * to_unit);
        let arm = [pose.cosine, pose.sine];
        LegEnclosure {
            reach: [square - TaylorModel::constant(shortest.square()), one - square, one],
            u: frame.leave(u),
            moment: cross_models(arm, u),
            along: dot(arm, u),
            transmission_square: one,
            distal: match settings.telescopic_bar {
                BarLength::Current => length,
                BarLength::Longest => one,
            },
            proximal: None,
        }
    }

    /// The rod, of constant length, ends at `C_i`. Where it protrudes behind `A_i`, the axis begins at its inner end.
    fn enclose_members(
        settings: &LegSettings,
        _: usize,
        leg: &LegEnclosure,
        anchor: PlanarModel,
        tip: PlanarModel,
    ) -> MembersEnclosure {
        let one = Interval::exactly(1.0);
        let shortest = Interval::exactly(settings.telescopic_shortest);
        // A rod that never protrudes counts as one that ends at `A_i`.
        let inner = if settings.telescopic_shortest < 0.5 {
            difference(tip, leg.u.map(|part| part.scaled(one - shortest)))
        } else {
            anchor
        };
        MembersEnclosure {
            proximal: None,
            distal: AxisEnclosure {
                points: [anchor, inner, tip],
                direction: leg.u,
            },
            rail: None,
        }
    }

    #[inline(always)]
    fn members<V: Real>(&self, c: Planar<V>, u: Planar<V>) -> Members<V> {
        let like = c.x;
        let anchor = Planar::splat(like, self.anchor);
        let length = c.minus(anchor).dot(u);
        let rod = self.longest - self.tube();
        let distal = if rod > self.shortest {
            // Length by which the rod protrudes behind the joint at the base.
            let behind = (like.splat(rod) - length).larger(like.splat(0.0));
            MemberAxis {
                from: anchor.minus(u.scaled(behind)),
                direction: u,
                length: length + behind,
            }
        } else {
            MemberAxis {
                from: anchor,
                direction: u,
                length,
            }
        };
        Members {
            proximal: None,
            distal,
            rail: None,
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

    fn bodies(&self, posture: &LegPosture) -> Vec<LegBody> {
        let along = |length: f64| self.anchor + posture.u * length;
        let tube = self.tube();
        let (mouth, c) = (along(tube), along(posture.length));
        vec![
            LegBody {
                name: "tube",
                kind: MemberKind::TelescopicLeg,
                origin: self.anchor,
                axis: posture.u,
                joint: LegJoint::Passive,
                parts: vec![
                    LegPart::Tube {
                        from: self.anchor,
                        to: mouth,
                    },
                    LegPart::Joint {
                        at: self.anchor,
                        actuated: false,
                        joins: [MemberKind::TelescopicLeg; 2],
                    },
                    LegPart::Joint {
                        at: mouth,
                        actuated: true,
                        joins: [MemberKind::TelescopicLeg; 2],
                    },
                ],
            },
            LegBody {
                name: "rod",
                kind: MemberKind::TelescopicLeg,
                origin: c,
                axis: posture.u,
                joint: LegJoint::Actuated {
                    value: posture.length,
                    limits: Some([self.shortest, self.longest]),
                },
                parts: vec![
                    LegPart::Rod {
                        from: along(posture.length - (self.longest - tube)),
                        to: c,
                    },
                    LegPart::Joint {
                        at: c,
                        actuated: false,
                        joins: [MemberKind::TelescopicLeg, MemberKind::PlatformBar],
                    },
                ],
            },
        ]
    }

    fn guide(&self, posture: &LegPosture) -> Option<Guide> {
        let along = |length: f64| self.anchor + posture.u * length;
        Some(Guide::Stroke {
            from: along(self.shortest),
            to: along(self.longest),
        })
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

    fn farthest_reach(base: f64, platform: f64, link: f64) -> f64 {
        super::leg::beyond_farthest_anchor(base, link + platform)
    }

    #[inline]
    fn proximal_bar(&self, _: &LegPosture) -> Option<Segment> {
        None
    }
}
