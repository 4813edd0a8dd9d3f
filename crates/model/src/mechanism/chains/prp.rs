//! PRP: slider at `B_i = A_i + ρ_i e_i` on a rail of the base, with a carriage that runs on a guide of the platform:
//! `B_i = C_i + σ_i g_i` (docs/model.md, section 2.8).

use glam::DVec2;

use super::{absolute, enclosed_within, margin_within_both, platform_guide};
use crate::enclosure::{PlanarModel, TaylorModel, cross as cross_models};
use crate::lanes::{Planar, Real};
use crate::mechanism::{
    Assembly, BarPosture, Chain, ChainDescription, ChainEnclosure, ChainLanes, DesignVariable, JointKind, JointPoint,
    LegFrame, LegSizes, LegToEnclose, LockedKind, LockedLeg, MemberKind, Shortfall, Solved, Within,
};
use crate::spatial::cross;

/// Chain of a leg with a slider and a guide on the platform.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrpChain;

impl Chain for PrpChain {
    const DESCRIPTION: ChainDescription = ChainDescription {
        name: "PRP",
        joints: [JointKind::Prismatic, JointKind::Revolute, JointKind::Prismatic],
        points: [JointPoint::B, JointPoint::B, JointPoint::B],
        has_working_modes: false,
        has_proximal_bar: false,
        proximal: Some(MemberKind::Slider),
        distal: MemberKind::Guide,
        variables: &[DesignVariable::RailAngle, DesignVariable::PlatformGuideAngle],
    };

    fn solve(leg: &LegSizes, c: DVec2, arm: DVec2) -> Result<Solved, Shortfall> {
        let LegFrame { anchor, rail, .. } = leg.frame;
        let guide = leg.frame.platform_guide(arm);
        let turn = cross(guide, rail);
        if turn == 0.0 {
            return Err(Shortfall::degenerate());
        }
        let chord = c - anchor;
        let (first, second) = (cross(guide, chord) / turn, cross(rail, chord) / turn);
        Ok(Solved {
            b: anchor + rail * first,
            proximal: None,
            distal: BarPosture::new(-guide, second),
            guides: [Some(rail), None, Some(-guide)],
            within: Within::limits(first, leg.frame.rail_travel).and(Within::limits(second, leg.travels[1])),
        })
    }

    fn locked(leg: &LegSizes, driven: usize, value: f64) -> LockedLeg {
        let LegFrame { anchor, rail, .. } = leg.frame;
        let c = leg.frame.platform_joint;
        let guide = leg.frame.platform_guide(c);
        match driven {
            0 => LockedLeg::new(c, anchor + rail * value, LockedKind::PlatformLine(guide.perp())),
            _ => LockedLeg::new(c + guide * value, anchor, LockedKind::BaseLine(rail.perp())),
        }
    }

    #[inline(always)]
    fn lanes<V: Real>(leg: &LegSizes, position: Planar<V>, arm: Planar<V>) -> ChainLanes<V> {
        let like = position.x;
        let (zero, one) = (like.splat(0.0), like.splat(1.0));
        let guide = platform_guide(leg, arm);
        let rail = Planar::splat(like, leg.frame.rail);
        let chord = leg.chord(position, arm);
        let turn = guide.cross(rail);
        let per_turn = one / turn;
        let (first, second) = (guide.cross(chord) * per_turn, rail.cross(chord) * per_turn);
        let tangent = Planar::new(-guide.x, -guide.y);
        ChainLanes::new(
            tangent,
            [arm.dot(tangent), arm.cross(tangent)],
            [second, second.abs()],
            [
                Some(Planar::new(tangent.dot(rail), -turn)),
                None,
                Some(Planar::new(one, zero)),
            ],
            margin_within_both([first, second], [leg.frame.rail_travel, leg.travels[1]]),
        )
    }

    fn enclose(leg: &LegToEnclose<'_>, position: PlanarModel, arm: PlanarModel) -> ChainEnclosure {
        let frame = leg.frame;
        let (one, zero) = (TaylorModel::exactly(1.0), TaylorModel::exactly(0.0));
        let guide = frame.platform_guide.leave(arm);
        let chord = frame.vector(position, arm);
        let [along_rail, to_guide] = frame.rail.enter(guide);
        let turn = -to_guide;
        // A reciprocal is enclosed for positive values only.
        let per_turn = if turn.constant < 0.0 {
            -(-turn).reciprocal()
        } else {
            turn.reciprocal()
        };
        let (first, second) = (
            cross_models(guide, chord) * per_turn,
            frame.rail.enter(chord)[1] * per_turn,
        );
        let slider = enclosed_within(first.scaled(frame.link), frame.rail_travel);
        let [from_lower, to_upper] = enclosed_within(second, frame.guide_travel);
        ChainEnclosure {
            slider: Some(slider),
            ..ChainEnclosure::new(
                [slider[0], slider[1], from_lower, to_upper],
                guide.map(|part| -part),
                [second, absolute(second)],
                [Some([-along_rail, to_guide]), None, Some([one, zero])],
            )
        }
    }

    fn assembly(leg: &LegSizes) -> Assembly {
        leg.assembly_from_rail(leg.longest_guide(1))
    }
}
