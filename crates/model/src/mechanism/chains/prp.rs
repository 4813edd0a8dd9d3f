//! PRP: slider at `B_i = A_i + ρ_i e_i` on a rail of the base, with a carriage that runs on a guide of the platform:
//! `B_i = C_i + σ_i g_i` (docs/model.md, section 2.8).

use glam::DVec2;

use super::{
    Within, absolute, angle_of, assembly_from_rail, box_about, carriage_body, enclosed_guide,
    enclosed_members_on_slider, enclosed_within, farthest, guide_axis, margin_within, members_on_slider, or_far_off,
    platform_guide_body, slider_body, turned, wrapped,
};
use crate::enclosure::{MembersEnclosure, PlanarModel, TaylorModel, cross as cross_models, difference};
use crate::lanes::{Planar, Real};
use crate::mechanism::{
    Assembly, BarPosture, Chain, ChainDescription, ChainEnclosure, ChainLanes, ChainPosture, Design, DesignVariable,
    DistalLanes, JointKind, JointPoint, LegBody, LegFrame, LegFrameEnclosure, LegSettings, LockedKind, LockedLeg,
    MemberKind, Members, ReachReason, Shortfall, Solved, Travel,
};
use crate::spatial::cross;

/// Chain of a leg with a slider and a guide on the platform.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrpChain {
    frame: LegFrame,
    guide: f64,
    travel: [f64; 2],
}

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

    fn new(frame: LegFrame, design: &Design, settings: &LegSettings) -> Self {
        Self {
            frame,
            guide: design.link_length(),
            travel: settings.geometry.travel(design.link_length()),
        }
    }

    fn frame(&self) -> &LegFrame {
        &self.frame
    }

    fn solve(&self, c: DVec2, arm: DVec2) -> Result<Solved, Shortfall> {
        let LegFrame { anchor, rail, .. } = self.frame;
        let guide = self.frame.platform_guide(arm);
        let turn = cross(guide, rail);
        if turn == 0.0 {
            return Err(Shortfall {
                limit_margin: 0.0,
                reason: ReachReason::Degenerate,
            });
        }
        let chord = c - anchor;
        let (first, second) = (cross(guide, chord) / turn, cross(rail, chord) / turn);
        let within = Within::limits(first, self.frame.rail_travel).and(Within::limits(second, self.travel));
        let b = anchor + rail * first;
        let posture = ChainPosture {
            a: anchor,
            b,
            c,
            slider: Some(self.frame.from_rail_ends(b.into())),
            proximal: None,
            distal: BarPosture {
                direction: -guide,
                offset: second,
            },
            beam: second.abs(),
            guides: [Some(rail), None, Some(-guide)],
            limit_margin: within.margin,
        };
        Ok((posture, within.beyond))
    }

    fn locked(&self, driven: usize, value: f64) -> LockedLeg {
        let LegFrame {
            anchor,
            rail,
            platform_joint,
            ..
        } = self.frame;
        let guide = self.frame.platform_guide(platform_joint);
        let (platform, base, kind) = match driven {
            0 => (
                platform_joint,
                anchor + rail * value,
                LockedKind::PlatformLine(guide.perp()),
            ),
            _ => (
                platform_joint + guide * value,
                anchor,
                LockedKind::BaseLine(rail.perp()),
            ),
        };
        LockedLeg { platform, base, kind }
    }

    #[inline(always)]
    fn lanes<V: Real>(&self, position: Planar<V>, arm: Planar<V>) -> ChainLanes<V> {
        let like = position.x;
        let (zero, one) = (like.splat(0.0), like.splat(1.0));
        let to_unit = like.splat(1.0 / self.frame.arm_length);
        let guide = turned(arm, self.frame.platform_guide).scaled(to_unit);
        let rail = Planar::splat(like, self.frame.rail);
        let chord = position.plus(arm.minus(Planar::splat(like, self.frame.anchor)));
        let turn = guide.cross(rail);
        let per_turn = one / turn;
        let (first, second) = (guide.cross(chord) * per_turn, rail.cross(chord) * per_turn);
        let within = margin_within(first, self.frame.rail_travel).smaller(margin_within(second, self.travel));
        let limit_margin = or_far_off(within);
        let tangent = Planar::new(-guide.x, -guide.y);
        ChainLanes {
            tangent,
            along: arm.dot(tangent),
            across: arm.cross(tangent),
            offset: second,
            beam: second.abs(),
            signed_beam: second,
            proximal: None,
            guides: [
                Some(Planar::new(tangent.dot(rail), -turn)),
                None,
                Some(Planar::new(one, zero)),
            ],
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
        let [from_start, to_end] = enclosed_within(first.scaled(frame.link), frame.rail_travel);
        let [from_lower, to_upper] = enclosed_within(second, frame.guide_travel);
        ChainEnclosure {
            reach: [from_start, to_end, from_lower, to_upper],
            tangent: guide.map(|part| -part),
            offset: second,
            beam: absolute(second),
            signed_beam: second,
            slider: Some([from_start, to_end]),
            proximal: None,
            guides: [Some([-along_rail, to_guide]), None, Some([one, zero])],
            lever_square: None,
        }
    }

    fn enclose_members(
        frame: &LegFrameEnclosure,
        _: &Design,
        _: &LegSettings,
        chain: &ChainEnclosure,
        _: PlanarModel,
        tip: PlanarModel,
    ) -> MembersEnclosure {
        let guide = chain.tangent.map(|part| -part);
        let centre = difference(tip, chain.tangent.map(|part| part * chain.offset));
        let guide = enclosed_guide(tip, guide, frame.guide_travel);
        enclosed_members_on_slider(frame, chain, centre, guide)
    }

    #[inline(always)]
    fn members<V: Real>(&self, c: Planar<V>, distal: &DistalLanes<V>) -> Members<V> {
        let guide = Planar::new(-distal.tangent.x, -distal.tangent.y);
        let centre = c.plus(guide.scaled(distal.offset));
        members_on_slider(&self.frame, centre, guide_axis(c, guide, self.travel))
    }

    fn joint_values(&self, posture: &ChainPosture, arm: DVec2) -> [f64; 3] {
        [
            (posture.b - posture.a).dot(self.frame.rail),
            wrapped(self.frame.orientation(arm) - angle_of(self.frame.rail)),
            posture.distal.offset,
        ]
    }

    fn joint_limits(&self) -> [Option<[f64; 2]>; 3] {
        [Some(self.frame.rail_travel), None, Some(self.travel)]
    }

    fn bodies(&self, posture: &ChainPosture, arm: DVec2, driven: usize) -> Vec<LegBody> {
        let [first, turn, second] = self.joint_values(posture, arm);
        let guide = -posture.distal.direction;
        vec![
            slider_body(&self.frame, posture.b, first, driven == 0),
            carriage_body(posture.b, guide, MemberKind::Slider, turn, driven),
            platform_guide_body(posture.c, guide, second, self.travel, driven == 2),
        ]
    }

    fn travels(&self, _: &ChainPosture) -> Vec<Travel> {
        vec![Travel::of_rail(&self.frame)]
    }

    fn reach_box(&self) -> [DVec2; 2] {
        box_about(self.frame.rail_ends(), farthest(self.travel))
    }

    fn assembly(&self) -> Assembly {
        assembly_from_rail(&self.frame, self.guide.max(farthest(self.travel)))
    }
}
