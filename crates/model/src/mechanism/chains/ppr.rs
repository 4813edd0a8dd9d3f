//! PPR: slider at `B_i = A_i + ρ_i e_i` on a rail of the base, which carries a guide: `C_i = B_i + σ_i e'_i` (docs/model.md,
//! section 2.8).

use glam::DVec2;

use super::{
    Within, absolute, angle_of, assembly_from_rail, box_about, enclosed_guide, enclosed_members_on_slider,
    enclosed_within, farthest, guide_axis, guide_ends, margin_within, members_on_slider, or_far_off, pin, prismatic,
    slider_body, wrapped,
};
use crate::enclosure::{Interval, MembersEnclosure, PlanarModel, TaylorModel, difference};
use crate::lanes::{Planar, Real};
use crate::mechanism::{
    Assembly, BarPosture, Chain, ChainDescription, ChainEnclosure, ChainLanes, ChainPosture, Design, DesignVariable,
    DistalLanes, JointKind, JointPoint, LegBody, LegFrame, LegFrameEnclosure, LegPart, LegSettings, LockedKind,
    LockedLeg, MemberKind, Members, Shortfall, Solved, Travel,
};
use crate::spatial::{Rotation, cross};

/// Chain of a leg with a slider that carries a guide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PprChain {
    frame: LegFrame,
    /// `e'_i`, the direction of the guide on the slider.
    guide: DVec2,
    length: f64,
    travel: [f64; 2],
}

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

    fn new(frame: LegFrame, design: &Design, settings: &LegSettings) -> Self {
        Self {
            guide: Rotation::by(frame.between_guides).apply(frame.rail),
            frame,
            length: design.link_length(),
            travel: settings.geometry.travel(design.link_length()),
        }
    }

    fn frame(&self) -> &LegFrame {
        &self.frame
    }

    fn solve(&self, c: DVec2, _: DVec2) -> Result<Solved, Shortfall> {
        let LegFrame { anchor, rail, .. } = self.frame;
        let sine = self.frame.between_guides.y;
        let chord = c - anchor;
        let (first, second) = (cross(chord, self.guide) / sine, cross(rail, chord) / sine);
        let within = Within::limits(first, self.frame.rail_travel).and(Within::limits(second, self.travel));
        let b = anchor + rail * first;
        let posture = ChainPosture {
            a: anchor,
            b,
            c,
            slider: Some(self.frame.from_rail_ends(b.into())),
            proximal: None,
            distal: BarPosture {
                direction: self.guide,
                offset: second,
            },
            beam: second.abs(),
            guides: [Some(rail), Some(self.guide), None],
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
        let (base, normal) = match driven {
            0 => (anchor + rail * value, self.guide.perp()),
            _ => (anchor + self.guide * value, rail.perp()),
        };
        LockedLeg {
            platform: platform_joint,
            base,
            kind: LockedKind::BaseLine(normal),
        }
    }

    #[inline(always)]
    fn lanes<V: Real>(&self, position: Planar<V>, arm: Planar<V>) -> ChainLanes<V> {
        let like = position.x;
        let (zero, one) = (like.splat(0.0), like.splat(1.0));
        let rail = Planar::splat(like, self.frame.rail);
        let tangent = Planar::splat(like, self.guide);
        let chord = position.plus(arm.minus(Planar::splat(like, self.frame.anchor)));
        let per_sine = like.splat(1.0 / self.frame.between_guides.y);
        let (first, second) = (chord.cross(tangent) * per_sine, rail.cross(chord) * per_sine);
        let within = margin_within(first, self.frame.rail_travel).smaller(margin_within(second, self.travel));
        let limit_margin = or_far_off(within);
        let DVec2 { x, y } = self.frame.between_guides;
        ChainLanes {
            tangent,
            along: arm.dot(tangent),
            across: arm.cross(tangent),
            offset: second,
            beam: second.abs(),
            signed_beam: second,
            proximal: None,
            guides: [
                Some(Planar::splat(like, DVec2::new(x, -y))),
                Some(Planar::new(one, zero)),
                None,
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
        let [along, height] = frame.rail.enter(frame.vector(position, arm));
        let [cosine, sine] = frame.between_guides.axis();
        let second = height.scaled(Interval::exactly(1.0) / sine);
        let first = along - second.scaled(cosine);
        let [from_start, to_end] = enclosed_within(first.scaled(frame.link), frame.rail_travel);
        let [from_lower, to_upper] = enclosed_within(second, frame.guide_travel);
        ChainEnclosure {
            reach: [from_start, to_end, from_lower, to_upper],
            tangent: frame.between_guides.leave(frame.rail.axis().map(TaylorModel::constant)),
            offset: second,
            beam: absolute(second),
            signed_beam: second,
            slider: Some([from_start, to_end]),
            proximal: None,
            guides: [
                Some([TaylorModel::constant(cosine), TaylorModel::constant(-sine)]),
                Some([one, zero]),
                None,
            ],
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
        let centre = difference(tip, chain.tangent.map(|part| part * chain.offset));
        let guide = enclosed_guide(centre, chain.tangent, frame.guide_travel);
        enclosed_members_on_slider(frame, chain, centre, guide)
    }

    #[inline(always)]
    fn members<V: Real>(&self, c: Planar<V>, distal: &DistalLanes<V>) -> Members<V> {
        let centre = c.minus(distal.tangent.scaled(distal.offset));
        members_on_slider(&self.frame, centre, guide_axis(centre, distal.tangent, self.travel))
    }

    fn joint_values(&self, posture: &ChainPosture, arm: DVec2) -> [f64; 3] {
        [
            (posture.b - posture.a).dot(self.frame.rail),
            posture.distal.offset,
            wrapped(self.frame.orientation(arm) - angle_of(self.frame.rail)),
        ]
    }

    fn joint_limits(&self) -> [Option<[f64; 2]>; 3] {
        [Some(self.frame.rail_travel), Some(self.travel), None]
    }

    fn bodies(&self, posture: &ChainPosture, arm: DVec2, driven: usize) -> Vec<LegBody> {
        let [first, second, _] = self.joint_values(posture, arm);
        let [from, to] = guide_ends(posture.b, self.guide, self.travel);
        let mut slider = slider_body(&self.frame, posture.b, first, driven == 0);
        slider.parts.push(LegPart::GuideBar {
            from,
            to,
            kind: MemberKind::Guide,
        });
        vec![
            slider,
            LegBody {
                name: "carriage",
                kind: MemberKind::Guide,
                origin: posture.c,
                axis: self.guide,
                joint: prismatic(second, self.travel, driven == 1),
                parts: vec![
                    LegPart::Carriage {
                        at: posture.c,
                        axis: self.guide,
                        on: MemberKind::Guide,
                        actuated: driven == 1,
                    },
                    pin(posture.c, driven == 2, [MemberKind::Guide, MemberKind::PlatformBar]),
                ],
            },
        ]
    }

    fn travels(&self, _: &ChainPosture) -> Vec<Travel> {
        vec![Travel::of_rail(&self.frame)]
    }

    fn reach_box(&self) -> [DVec2; 2] {
        box_about(self.frame.rail_ends(), farthest(self.travel))
    }

    fn assembly(&self) -> Assembly {
        let reach = self.length.max(farthest(self.travel)) * self.frame.between_guides.y;
        assembly_from_rail(&self.frame, reach)
    }
}
