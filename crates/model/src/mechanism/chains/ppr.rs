//! PPR: slider at `B_i = A_i + ρ_i e_i` on a rail of the base, which carries a guide: `C_i = B_i + σ_i e'_i` (docs/model.md,
//! section 2.8).

use glam::DVec2;

use super::{absolute, enclosed_within, margin_within_both};
use crate::enclosure::{Interval, PlanarModel, TaylorModel};
use crate::lanes::{Planar, Real};
use crate::mechanism::chain::bodies::{carriage_on, guide_bar, pin, prismatic, slider_body};
use crate::mechanism::{
    Assembly, BarPosture, Chain, ChainDescription, ChainEnclosure, ChainLanes, ChainPosture, DesignVariable, JointKind,
    JointPoint, LegBody, LegFrame, LegSizes, LegToEnclose, LockedKind, LockedLeg, MemberKind, Shortfall, Solved,
    Within,
};
use crate::spatial::cross;

/// Chain of a leg with a slider that carries a guide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PprChain;

impl Chain for PprChain {
    const DESCRIPTION: ChainDescription = ChainDescription {
        name: "PPR",
        joints: [JointKind::Prismatic, JointKind::Prismatic, JointKind::Revolute],
        points: [JointPoint::B, JointPoint::C, JointPoint::C],
        has_working_modes: false,
        has_proximal_bar: false,
        proximal: Some(MemberKind::Slider),
        distal: MemberKind::Guide,
        variables: &[DesignVariable::RailAngle, DesignVariable::GuideAngle],
    };

    fn solve(leg: &LegSizes, c: DVec2, _: DVec2) -> Result<Solved, Shortfall> {
        let LegFrame { anchor, rail, .. } = leg.frame;
        let guide = leg.slider_guide;
        let sine = leg.frame.between_guides.y;
        let chord = c - anchor;
        let (first, second) = (cross(chord, guide) / sine, cross(rail, chord) / sine);
        Ok(Solved {
            b: anchor + rail * first,
            proximal: None,
            distal: BarPosture::new(guide, second),
            guides: [Some(rail), Some(guide), None],
            within: Within::limits(first, leg.frame.rail_travel).and(Within::limits(second, leg.travels[0])),
        })
    }

    fn locked(leg: &LegSizes, driven: usize, value: f64) -> LockedLeg {
        let LegFrame { anchor, rail, .. } = leg.frame;
        let (base, normal) = match driven {
            0 => (anchor + rail * value, leg.slider_guide.perp()),
            _ => (anchor + leg.slider_guide * value, rail.perp()),
        };
        LockedLeg::new(leg.frame.platform_joint, base, LockedKind::BaseLine(normal))
    }

    #[inline(always)]
    fn lanes<V: Real>(leg: &LegSizes, position: Planar<V>, arm: Planar<V>) -> ChainLanes<V> {
        let like = position.x;
        let (zero, one) = (like.splat(0.0), like.splat(1.0));
        let rail = Planar::splat(like, leg.frame.rail);
        let tangent = Planar::splat(like, leg.slider_guide);
        let chord = leg.chord(position, arm);
        let DVec2 { x, y } = leg.frame.between_guides;
        let per_sine = like.splat(1.0 / y);
        let (first, second) = (chord.cross(tangent) * per_sine, rail.cross(chord) * per_sine);
        ChainLanes::new(
            tangent,
            [arm.dot(tangent), arm.cross(tangent)],
            [second, second.abs()],
            [
                Some(Planar::splat(like, DVec2::new(x, -y))),
                Some(Planar::new(one, zero)),
                None,
            ],
            margin_within_both([first, second], [leg.frame.rail_travel, leg.travels[0]]),
        )
    }

    fn enclose(leg: &LegToEnclose<'_>, position: PlanarModel, arm: PlanarModel) -> ChainEnclosure {
        let frame = leg.frame;
        let (one, zero) = (TaylorModel::exactly(1.0), TaylorModel::exactly(0.0));
        let [along, height] = frame.rail.enter(frame.vector(position, arm));
        let [cosine, sine] = frame.between_guides.axis();
        let second = height.scaled(Interval::exactly(1.0) / sine);
        let first = along - second.scaled(cosine);
        let slider = enclosed_within(first.scaled(frame.link), frame.rail_travel);
        let [from_lower, to_upper] = enclosed_within(second, frame.guide_travel);
        let rail = [cosine, -sine].map(TaylorModel::constant);
        ChainEnclosure {
            slider: Some(slider),
            ..ChainEnclosure::new(
                [slider[0], slider[1], from_lower, to_upper],
                frame.between_guides.leave(frame.rail.axis().map(TaylorModel::constant)),
                [second, absolute(second)],
                [Some(rail), Some([one, zero]), None],
            )
        }
    }

    fn bodies(leg: &LegSizes, posture: &ChainPosture, values: [f64; 3], driven: usize) -> Vec<LegBody> {
        let (c, guide, travel) = (posture.c, leg.slider_guide, leg.travels[0]);
        let mut slider = slider_body(leg, posture, values[0], driven == 0);
        slider
            .parts
            .push(guide_bar(posture.b, guide, travel, MemberKind::Guide));
        let carriage = LegBody {
            name: "carriage",
            kind: MemberKind::Guide,
            origin: c,
            axis: guide,
            joint: prismatic(values[1], travel, driven == 1),
            parts: vec![
                carriage_on(MemberKind::Guide, c, guide, driven == 1),
                pin(c, driven == 2, [MemberKind::Guide, MemberKind::PlatformBar]),
            ],
        };
        vec![slider, carriage]
    }

    fn assembly(leg: &LegSizes) -> Assembly {
        leg.assembly_from_rail(leg.longest_guide(1) * leg.frame.between_guides.y)
    }
}
