//! RPR: telescopic leg `A_iC_i` whose length `ρ_i` lies between a fraction of `L_b` and `L_b` (docs/model.md, section 2.3).

use glam::DVec2;

use super::{Within, angle_of, box_about, pin, prismatic, revolute, wrapped};
use crate::enclosure::{AxisEnclosure, Interval, MembersEnclosure, PlanarModel, TaylorModel, difference, dot};
use crate::lanes::{Planar, Real};
use crate::mechanism::{
    Assembly, BarLength, BarPosture, Chain, ChainDescription, ChainEnclosure, ChainLanes, ChainPosture, Design,
    DistalLanes, JointKind, JointPoint, LegBody, LegFrame, LegFrameEnclosure, LegPart, LegSettings, LockedKind,
    LockedLeg, MemberAxis, MemberKind, Members, ReachReason, Shortfall, Solved, Travel, TravelKind,
};
use crate::spatial::unit;

/// Chain of a telescopic leg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RprChain {
    frame: LegFrame,
    shortest: f64,
    longest: f64,
    /// Length of the tube \[m\].
    tube: f64,
    bar: BarLength,
}

impl Chain for RprChain {
    const DESCRIPTION: ChainDescription = ChainDescription {
        name: "RPR",
        joints: [JointKind::Revolute, JointKind::Prismatic, JointKind::Revolute],
        points: [JointPoint::B, JointPoint::B, JointPoint::C],
        has_working_modes: false,
        has_proximal_bar: false,
        proximal: None,
        distal: MemberKind::TelescopicLeg,
        variables: &[],
    };

    fn new(frame: LegFrame, design: &Design, settings: &LegSettings) -> Self {
        Self {
            frame,
            shortest: settings.telescopic_shortest * design.link_length(),
            longest: design.link_length(),
            tube: settings.tube_length(design.link_length()),
            bar: settings.telescopic_bar,
        }
    }

    fn frame(&self) -> &LegFrame {
        &self.frame
    }

    fn solve(&self, c: DVec2, _: DVec2) -> Result<Solved, Shortfall> {
        let leg = c - self.frame.anchor;
        let length = leg.length();
        let within = Within::limits(length, [self.shortest, self.longest]);
        if length == 0.0 {
            return Err(Shortfall {
                limit_margin: 0.0,
                reason: ReachReason::Degenerate,
            });
        }
        let direction = leg / length;
        let posture = ChainPosture {
            a: self.frame.anchor,
            b: self.frame.anchor,
            c,
            slider: None,
            proximal: None,
            distal: BarPosture {
                direction,
                offset: length,
            },
            beam: match self.bar {
                BarLength::Current => length,
                BarLength::Longest => self.longest,
            },
            guides: [None, Some(direction), None],
            limit_margin: within.margin,
        };
        Ok((posture, within.beyond))
    }

    fn locked(&self, driven: usize, value: f64) -> LockedLeg {
        LockedLeg {
            platform: self.frame.platform_joint,
            base: self.frame.anchor,
            kind: match driven {
                0 => LockedKind::BaseLine(unit(value).perp()),
                1 => LockedKind::Circle(value),
                _ => LockedKind::PlatformLine(unit(-value).perp()),
            },
        }
    }

    #[inline(always)]
    fn lanes<V: Real>(&self, position: Planar<V>, arm: Planar<V>) -> ChainLanes<V> {
        let like = position.x;
        let leg = position.plus(arm.minus(Planar::splat(like, self.frame.anchor)));
        let length = leg.dot(leg).sqrt();
        let (zero, one) = (like.splat(0.0), like.splat(1.0));
        let limit_margin = (length - like.splat(self.shortest)).smaller(like.splat(self.longest) - length);
        let u = leg.scaled(one / length);
        let beam = match self.bar {
            BarLength::Current => length,
            BarLength::Longest => like.splat(self.longest),
        };
        ChainLanes {
            tangent: u,
            along: arm.dot(u),
            across: arm.cross(u),
            offset: length,
            beam,
            signed_beam: beam,
            proximal: None,
            guides: [None, Some(Planar::new(one, zero)), None],
            limit_margin,
            reachable: limit_margin.at_least(zero) & length.exceeds(zero),
        }
    }

    /// The leg is the vector `v` from `A_i` to `C_i`.
    fn enclose(
        frame: &LegFrameEnclosure,
        _: &Design,
        settings: &LegSettings,
        position: PlanarModel,
        arm: PlanarModel,
    ) -> ChainEnclosure {
        let leg = frame.vector(position, arm);
        let (one, zero) = (TaylorModel::exactly(1.0), TaylorModel::exactly(0.0));
        let square = dot(leg, leg);
        let shortest = Interval::exactly(settings.telescopic_shortest);
        let length = square.sqrt();
        let to_unit = length.reciprocal();
        let beam = match settings.telescopic_bar {
            BarLength::Current => length,
            BarLength::Longest => one,
        };
        ChainEnclosure {
            reach: [
                square - TaylorModel::constant(shortest.square()),
                one - square,
                one,
                one,
            ],
            tangent: leg.map(|part| part * to_unit),
            offset: length,
            beam,
            signed_beam: beam,
            slider: None,
            proximal: None,
            guides: [None, Some([one, zero]), None],
            lever_square: Some(one),
        }
    }

    /// The rod, of constant length, ends at `C_i`. Where it protrudes behind `A_i`, the axis begins at its inner end.
    fn enclose_members(
        _: &LegFrameEnclosure,
        _: &Design,
        settings: &LegSettings,
        chain: &ChainEnclosure,
        anchor: PlanarModel,
        tip: PlanarModel,
    ) -> MembersEnclosure {
        let one = Interval::exactly(1.0);
        let shortest = Interval::exactly(settings.telescopic_shortest);
        // A rod that never protrudes counts as one that ends at `A_i`.
        let inner = if settings.telescopic_shortest < 0.5 {
            difference(tip, chain.tangent.map(|part| part.scaled(one - shortest)))
        } else {
            anchor
        };
        MembersEnclosure {
            proximal: None,
            distal: AxisEnclosure {
                points: [anchor, inner, tip],
                direction: chain.tangent,
            },
            rail: None,
        }
    }

    #[inline(always)]
    fn members<V: Real>(&self, c: Planar<V>, distal: &DistalLanes<V>) -> Members<V> {
        let like = c.x;
        let u = distal.tangent;
        let anchor = Planar::splat(like, self.frame.anchor);
        let length = c.minus(anchor).dot(u);
        let rod = self.longest - self.tube;
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

    fn joint_values(&self, posture: &ChainPosture, arm: DVec2) -> [f64; 3] {
        let leg = angle_of(posture.distal.direction);
        [leg, posture.distal.offset, wrapped(self.frame.orientation(arm) - leg)]
    }

    fn joint_limits(&self) -> [Option<[f64; 2]>; 3] {
        [None, Some([self.shortest, self.longest]), None]
    }

    fn bodies(&self, posture: &ChainPosture, arm: DVec2, driven: usize) -> Vec<LegBody> {
        let [swing, length, _] = self.joint_values(posture, arm);
        let (a, u) = (posture.a, posture.distal.direction);
        let along = |length: f64| a + u * length;
        let tube = self.tube;
        let (mouth, c) = (along(tube), posture.c);
        let of_leg = [MemberKind::TelescopicLeg; 2];
        vec![
            LegBody {
                name: "tube",
                kind: MemberKind::TelescopicLeg,
                origin: a,
                axis: u,
                joint: revolute(swing, driven == 0),
                parts: vec![
                    LegPart::Tube { from: a, to: mouth },
                    pin(a, driven == 0, of_leg),
                    LegPart::Joint {
                        at: mouth,
                        actuated: driven == 1,
                        joins: of_leg,
                        kind: JointKind::Prismatic,
                    },
                ],
            },
            LegBody {
                name: "rod",
                kind: MemberKind::TelescopicLeg,
                origin: c,
                axis: u,
                joint: prismatic(length, [self.shortest, self.longest], driven == 1),
                parts: vec![
                    LegPart::Rod {
                        from: along(length - (self.longest - tube)),
                        to: c,
                    },
                    pin(c, driven == 2, [MemberKind::TelescopicLeg, MemberKind::PlatformBar]),
                ],
            },
        ]
    }

    fn travels(&self, posture: &ChainPosture) -> Vec<Travel> {
        let along = |length: f64| posture.a + posture.distal.direction * length;
        vec![Travel {
            kind: TravelKind::Stroke,
            from: along(self.shortest),
            to: along(self.longest),
        }]
    }

    fn reach_box(&self) -> [DVec2; 2] {
        box_about([self.frame.anchor; 2], self.longest)
    }

    fn assembly(&self) -> Assembly {
        Assembly {
            value: self.longest + self.frame.arm_length,
            threshold: 0.5 * self.frame.anchor_distance,
        }
    }
}
