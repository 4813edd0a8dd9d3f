//! RPP: guide that turns about `A_i`, with a carriage at `B_i = A_i + ρ_i f_i`, which also runs on a guide of the platform:
//! `B_i = C_i + σ_i g_i` (docs/model.md, section 2.8).

use glam::DVec2;

use super::{absolute, enclosed_within, margin_within_both, platform_guide, turned};
use crate::enclosure::{Interval, MembersEnclosure, PlanarModel, TaylorModel, cross as cross_models};
use crate::lanes::{Planar, Real};
use crate::mechanism::chain::bodies::{carriage_on, guide_bar, pin, platform_guide_body, prismatic, revolute};
use crate::mechanism::chain::members::{enclosed_guide, guide_axis};
use crate::mechanism::{
    Assembly, BarPosture, Chain, ChainDescription, ChainEnclosure, ChainLanes, ChainPosture, DesignVariable,
    DistalLanes, JointKind, JointPoint, LegBody, LegFrameEnclosure, LegSizes, LegToEnclose, LockedKind, LockedLeg,
    MemberKind, Members, ProximalEnclosure, ProximalLanes, Shortfall, Solved, Within,
};
use crate::spatial::{Rotation, cross};

/// Chain of a leg with a guide that turns about the base joint and a guide on the platform.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RppChain;

/// Returns `f_i`, the direction of the guide at the base, for the direction of that on the platform.
fn base_guide_of(leg: &LegSizes, guide: DVec2) -> DVec2 {
    Rotation::by(leg.frame.between_guides).apply(guide)
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

    fn solve(leg: &LegSizes, c: DVec2, arm: DVec2) -> Result<Solved, Shortfall> {
        let guide = leg.frame.platform_guide(arm);
        let base_guide = base_guide_of(leg, guide);
        let sine = leg.frame.between_guides.y;
        let chord = c - leg.frame.anchor;
        let (first, second) = (cross(guide, chord) / sine, cross(base_guide, chord) / sine);
        Ok(Solved {
            b: leg.frame.anchor + base_guide * first,
            proximal: Some(BarPosture::new(base_guide, first)),
            distal: BarPosture::new(-guide, second),
            guides: [None, Some(base_guide), Some(-guide)],
            within: Within::limits(first, leg.travels[0]).and(Within::limits(second, leg.travels[1])),
        })
    }

    fn locked(leg: &LegSizes, driven: usize, value: f64) -> LockedLeg {
        let (a, c) = (leg.frame.anchor, leg.frame.platform_joint);
        let guide = leg.frame.platform_guide(c);
        let base_guide = base_guide_of(leg, guide);
        match driven {
            1 => LockedLeg::new(c - base_guide * value, a, LockedKind::PlatformLine(guide.perp())),
            _ => LockedLeg::new(c + guide * value, a, LockedKind::PlatformLine(base_guide.perp())),
        }
    }

    #[inline(always)]
    fn lanes<V: Real>(leg: &LegSizes, position: Planar<V>, arm: Planar<V>) -> ChainLanes<V> {
        let like = position.x;
        let (zero, one) = (like.splat(0.0), like.splat(1.0));
        let guide = platform_guide(leg, arm);
        let base_guide = turned(guide, leg.frame.between_guides);
        let chord = leg.chord(position, arm);
        let per_sine = like.splat(1.0 / leg.frame.between_guides.y);
        let (first, second) = (guide.cross(chord) * per_sine, base_guide.cross(chord) * per_sine);
        let tangent = Planar::new(-guide.x, -guide.y);
        // In axes along −g, the guide at the base has the components −cos β and −sin β.
        let direction = Planar::splat(like, -leg.frame.between_guides);
        let to_share = like.splat(1.0 / leg.proximal);
        ChainLanes {
            proximal: Some(ProximalLanes {
                vector: direction.scaled(first),
                direction,
                length: first.abs(),
                share: first * to_share,
                distal_share: second * to_share,
            }),
            ..ChainLanes::new(
                tangent,
                [arm.dot(tangent), arm.cross(tangent)],
                [second, second.abs()],
                [None, Some(direction), Some(Planar::new(one, zero))],
                margin_within_both([first, second], leg.travels),
            )
        }
    }

    fn enclose(leg: &LegToEnclose<'_>, position: PlanarModel, arm: PlanarModel) -> ChainEnclosure {
        let frame = leg.frame;
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
            proximal: Some(ProximalEnclosure {
                vector: direction.map(|part| part * first),
                direction,
                length: absolute(first),
                offset: first,
            }),
            ..ChainEnclosure::new(
                [first_lower, first_upper, second_lower, second_upper],
                guide.map(|part| -part),
                [second, absolute(second)],
                [None, Some(direction), Some([one, zero])],
            )
        }
    }

    fn enclose_members(
        leg: &LegToEnclose<'_>,
        chain: &ChainEnclosure,
        anchor: PlanarModel,
        tip: PlanarModel,
    ) -> MembersEnclosure {
        let frame = leg.frame;
        let guide = chain.tangent.map(|part| -part);
        let base_guide = frame.between_guides.leave(guide);
        MembersEnclosure {
            proximal: Some(enclosed_guide(anchor, base_guide, base_travel(frame))),
            distal: enclosed_guide(tip, guide, frame.guide_travel),
            rail: None,
        }
    }

    #[inline(always)]
    fn members<V: Real>(leg: &LegSizes, c: Planar<V>, distal: &DistalLanes<V>) -> Members<V> {
        let guide = Planar::new(-distal.tangent.x, -distal.tangent.y);
        let base_guide = turned(guide, leg.frame.between_guides);
        let anchor = Planar::splat(c.x, leg.frame.anchor);
        Members {
            proximal: Some(guide_axis(anchor, base_guide, leg.travels[0])),
            distal: guide_axis(c, guide, leg.travels[1]),
            rail: None,
        }
    }

    fn bodies(leg: &LegSizes, posture: &ChainPosture, values: [f64; 3], driven: usize) -> Vec<LegBody> {
        let (a, b) = (posture.a, posture.b);
        let guide = -posture.distal.direction;
        let base_guide = base_guide_of(leg, guide);
        let kind = MemberKind::TurningGuide;
        vec![
            LegBody {
                name: "turning_guide",
                kind,
                origin: a,
                axis: base_guide,
                joint: revolute(values[0], driven == 0),
                parts: vec![
                    guide_bar(a, base_guide, leg.travels[0], kind),
                    pin(a, driven == 0, [kind; 2]),
                ],
            },
            LegBody {
                name: "carriage",
                kind,
                origin: b,
                axis: base_guide,
                joint: prismatic(values[1], leg.travels[0], driven == 1),
                parts: vec![
                    carriage_on(kind, b, base_guide, driven == 1),
                    carriage_on(MemberKind::Guide, b, guide, driven == 2),
                ],
            },
            platform_guide_body(leg, posture, values[2], driven == 2),
        ]
    }

    fn assembly(leg: &LegSizes) -> Assembly {
        leg.assembly(leg.longest_guide(0) + leg.longest_guide(1), leg.frame.anchor_distance)
    }
}
