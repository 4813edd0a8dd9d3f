//! RPP: guide that turns about `A_i`, with a carriage at `B_i = A_i + ρ_i f_i`, which also runs on a guide of the platform:
//! `B_i = C_i + σ_i g_i` (docs/model.md, section 2.8).

use glam::DVec2;

use super::{
    Within, absolute, box_about, enclosed_guide, enclosed_within, farthest, guide_axis, guide_ends, margin_within,
    or_far_off, pin, platform_guide_body, prismatic, revolute, turned, wrapped,
};
use crate::enclosure::{Interval, MembersEnclosure, PlanarModel, TaylorModel, cross as cross_models};
use crate::lanes::{Planar, Real};
use crate::mechanism::{
    Assembly, BarPosture, Chain, ChainDescription, ChainEnclosure, ChainLanes, ChainPosture, Design, DesignVariable,
    DistalLanes, JointKind, JointPoint, LegBody, LegFrame, LegFrameEnclosure, LegPart, LegSettings, LockedKind,
    LockedLeg, MemberKind, Members, ProximalEnclosure, ProximalLanes, Shortfall, Solved, Travel,
};
use crate::spatial::{Rotation, cross};

/// Chain of a leg with a guide that turns about the base joint and a guide on the platform.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RppChain {
    frame: LegFrame,
    lengths: [f64; 2],
    travels: [[f64; 2]; 2],
}

impl RppChain {
    /// Returns `f_i`, the direction of the guide at the base, for the direction of that on the platform.
    fn base_guide(&self, guide: DVec2) -> DVec2 {
        Rotation::by(self.frame.between_guides).apply(guide)
    }
}

/// Encloses the travel of the guide at the base, in units of `L_b`.
fn base_travel(frame: &LegFrameEnclosure) -> [Interval; 2] {
    frame.guide_travel.map(|share| share * frame.proximal)
}

impl Chain for RppChain {
    const DESCRIPTION: ChainDescription = ChainDescription {
        name: "RPP",
        joints: [JointKind::Revolute, JointKind::Prismatic, JointKind::Prismatic],
        points: [JointPoint::A, JointPoint::B, JointPoint::B],
        has_working_modes: false,
        has_proximal_bar: true,
        proximal: Some(MemberKind::TurningGuide),
        distal: MemberKind::Guide,
        variables: &[
            DesignVariable::ProximalLength,
            DesignVariable::GuideAngle,
            DesignVariable::PlatformGuideAngle,
        ],
    };

    fn new(frame: LegFrame, design: &Design, settings: &LegSettings) -> Self {
        let lengths = [design.proximal_length(), design.link_length()];
        Self {
            frame,
            lengths,
            travels: lengths.map(|length| settings.geometry.travel(length)),
        }
    }

    fn frame(&self) -> &LegFrame {
        &self.frame
    }

    fn solve(&self, c: DVec2, arm: DVec2) -> Result<Solved, Shortfall> {
        let guide = self.frame.platform_guide(arm);
        let base_guide = self.base_guide(guide);
        let sine = self.frame.between_guides.y;
        let chord = c - self.frame.anchor;
        let (first, second) = (cross(guide, chord) / sine, cross(base_guide, chord) / sine);
        let within = Within::limits(first, self.travels[0]).and(Within::limits(second, self.travels[1]));
        let posture = ChainPosture {
            a: self.frame.anchor,
            b: self.frame.anchor + base_guide * first,
            c,
            slider: None,
            proximal: Some(BarPosture {
                direction: base_guide,
                offset: first,
            }),
            distal: BarPosture {
                direction: -guide,
                offset: second,
            },
            beam: second.abs(),
            guides: [None, Some(base_guide), Some(-guide)],
            limit_margin: within.margin,
        };
        Ok((posture, within.beyond))
    }

    fn locked(&self, driven: usize, value: f64) -> LockedLeg {
        let c = self.frame.platform_joint;
        let guide = self.frame.platform_guide(c);
        let base_guide = self.base_guide(guide);
        let (platform, normal) = match driven {
            1 => (c - base_guide * value, guide.perp()),
            _ => (c + guide * value, base_guide.perp()),
        };
        LockedLeg {
            platform,
            base: self.frame.anchor,
            kind: LockedKind::PlatformLine(normal),
        }
    }

    #[inline(always)]
    fn lanes<V: Real>(&self, position: Planar<V>, arm: Planar<V>) -> ChainLanes<V> {
        let like = position.x;
        let (zero, one) = (like.splat(0.0), like.splat(1.0));
        let to_unit = like.splat(1.0 / self.frame.arm_length);
        let guide = turned(arm, self.frame.platform_guide).scaled(to_unit);
        let base_guide = turned(guide, self.frame.between_guides);
        let chord = position.plus(arm.minus(Planar::splat(like, self.frame.anchor)));
        let per_sine = like.splat(1.0 / self.frame.between_guides.y);
        let (first, second) = (guide.cross(chord) * per_sine, base_guide.cross(chord) * per_sine);
        let within = margin_within(first, self.travels[0]).smaller(margin_within(second, self.travels[1]));
        let limit_margin = or_far_off(within);
        let tangent = Planar::new(-guide.x, -guide.y);
        // In axes along −g, the guide at the base has the components −cos β and −sin β.
        let direction = Planar::splat(like, -self.frame.between_guides);
        let to_share = like.splat(1.0 / self.lengths[0]);
        ChainLanes {
            tangent,
            along: arm.dot(tangent),
            across: arm.cross(tangent),
            offset: second,
            beam: second.abs(),
            signed_beam: second,
            proximal: Some(ProximalLanes {
                vector: direction.scaled(first),
                direction,
                length: first.abs(),
                share: first * to_share,
                distal_share: second * to_share,
            }),
            guides: [None, Some(direction), Some(Planar::new(one, zero))],
            limit_margin,
            reachable: limit_margin.at_least(zero),
        }
    }

    fn enclose(
        frame: &LegFrameEnclosure,
        _: &Design,
        _: &LegSettings,
        position: PlanarModel,
        arm: PlanarModel,
    ) -> ChainEnclosure {
        let (one, zero) = (TaylorModel::exactly(1.0), TaylorModel::exactly(0.0));
        let guide = frame.platform_guide.leave(arm);
        let chord = frame.vector(position, arm);
        let [cosine, sine] = frame.between_guides.axis();
        let per_sine = Interval::exactly(1.0) / sine;
        let first = cross_models(guide, chord).scaled(per_sine);
        let second = cross_models(frame.between_guides.leave(guide), chord).scaled(per_sine);
        let [first_lower, first_upper] = enclosed_within(first, base_travel(frame));
        let [second_lower, second_upper] = enclosed_within(second, frame.guide_travel);
        let direction = [cosine, sine].map(|part| TaylorModel::constant(-part));
        ChainEnclosure {
            reach: [first_lower, first_upper, second_lower, second_upper],
            tangent: guide.map(|part| -part),
            offset: second,
            beam: absolute(second),
            signed_beam: second,
            slider: None,
            proximal: Some(ProximalEnclosure {
                vector: direction.map(|part| part * first),
                direction,
                length: absolute(first),
                offset: first,
            }),
            guides: [None, Some(direction), Some([one, zero])],
            lever_square: None,
        }
    }

    fn enclose_members(
        frame: &LegFrameEnclosure,
        _: &Design,
        _: &LegSettings,
        chain: &ChainEnclosure,
        anchor: PlanarModel,
        tip: PlanarModel,
    ) -> MembersEnclosure {
        let guide = chain.tangent.map(|part| -part);
        MembersEnclosure {
            proximal: Some(enclosed_guide(
                anchor,
                frame.between_guides.leave(guide),
                base_travel(frame),
            )),
            distal: enclosed_guide(tip, guide, frame.guide_travel),
            rail: None,
        }
    }

    #[inline(always)]
    fn members<V: Real>(&self, c: Planar<V>, distal: &DistalLanes<V>) -> Members<V> {
        let like = c.x;
        let guide = Planar::new(-distal.tangent.x, -distal.tangent.y);
        let base_guide = turned(guide, self.frame.between_guides);
        Members {
            proximal: Some(guide_axis(
                Planar::splat(like, self.frame.anchor),
                base_guide,
                self.travels[0],
            )),
            distal: guide_axis(c, guide, self.travels[1]),
            rail: None,
        }
    }

    fn joint_values(&self, posture: &ChainPosture, arm: DVec2) -> [f64; 3] {
        let first = posture.proximal.map_or(0.0, |bar| bar.offset);
        [wrapped(self.frame.orientation(arm)), first, posture.distal.offset]
    }

    fn joint_limits(&self) -> [Option<[f64; 2]>; 3] {
        [None, Some(self.travels[0]), Some(self.travels[1])]
    }

    fn bodies(&self, posture: &ChainPosture, arm: DVec2, driven: usize) -> Vec<LegBody> {
        let [turn, first, second] = self.joint_values(posture, arm);
        let guide = -posture.distal.direction;
        let base_guide = self.base_guide(guide);
        let [from, to] = guide_ends(posture.a, base_guide, self.travels[0]);
        let carriage = |axis: DVec2, on: MemberKind, actuated: bool| LegPart::Carriage {
            at: posture.b,
            axis,
            on,
            actuated,
        };
        vec![
            LegBody {
                name: "turning_guide",
                kind: MemberKind::TurningGuide,
                origin: posture.a,
                axis: base_guide,
                joint: revolute(turn, driven == 0),
                parts: vec![
                    LegPart::GuideBar {
                        from,
                        to,
                        kind: MemberKind::TurningGuide,
                    },
                    pin(posture.a, driven == 0, [MemberKind::TurningGuide; 2]),
                ],
            },
            LegBody {
                name: "carriage",
                kind: MemberKind::TurningGuide,
                origin: posture.b,
                axis: base_guide,
                joint: prismatic(first, self.travels[0], driven == 1),
                parts: vec![
                    carriage(base_guide, MemberKind::TurningGuide, driven == 1),
                    carriage(guide, MemberKind::Guide, driven == 2),
                ],
            },
            platform_guide_body(posture.c, guide, second, self.travels[1], driven == 2),
        ]
    }

    fn travels(&self, _: &ChainPosture) -> Vec<Travel> {
        Vec::new()
    }

    fn reach_box(&self) -> [DVec2; 2] {
        let [first, second] = self.travels.map(farthest);
        box_about([self.frame.anchor; 2], first + second)
    }

    fn assembly(&self) -> Assembly {
        let [first, second] = [0, 1].map(|k| self.lengths[k].max(farthest(self.travels[k])));
        Assembly {
            value: first + second + self.frame.arm_length,
            threshold: self.frame.anchor_distance,
        }
    }
}
