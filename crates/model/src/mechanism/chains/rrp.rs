//! RRP: crank `A_iB_i` of length `L_a`, and a carriage at `B_i = C_i + σ_i g_i` on a guide of the platform (docs/model.md,
//! section 2.8).

use glam::DVec2;

use super::{
    Within, absolute, angle_of, box_about, carriage_body, crank_body, enclosed_guide, enclosed_members_on_crank,
    enclosed_within, farthest, guide_axis, margin_within, members_on_crank, or_far_off, platform_guide_body, turned,
    wrapped,
};
use crate::enclosure::{MembersEnclosure, PlanarModel, TaylorModel, cross as cross_models, difference, dot};
use crate::lanes::{Planar, Real};
use crate::mechanism::{
    Assembly, BarPosture, Chain, ChainDescription, ChainEnclosure, ChainLanes, ChainPosture, Design, DesignVariable,
    DistalLanes, JointKind, JointPoint, LegBody, LegFrame, LegFrameEnclosure, LegSettings, LockedKind, LockedLeg,
    MemberKind, Members, ProximalLanes, ReachReason, Shortfall, Solved, Travel,
};
use crate::spatial::{cross, unit};

/// Chain of a leg with a crank and a guide on the platform.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RrpChain {
    frame: LegFrame,
    crank: f64,
    guide: f64,
    travel: [f64; 2],
}

impl Chain for RrpChain {
    const DESCRIPTION: ChainDescription = ChainDescription {
        name: "RRP",
        joints: [JointKind::Revolute, JointKind::Revolute, JointKind::Prismatic],
        points: [JointPoint::A, JointPoint::B, JointPoint::B],
        has_working_modes: true,
        has_proximal_bar: true,
        proximal: Some(MemberKind::Crank),
        distal: MemberKind::Guide,
        variables: &[DesignVariable::ProximalLength, DesignVariable::PlatformGuideAngle],
    };

    fn new(frame: LegFrame, design: &Design, settings: &LegSettings) -> Self {
        Self {
            frame,
            crank: design.proximal_length(),
            guide: design.link_length(),
            travel: settings.geometry.travel(design.link_length()),
        }
    }

    fn frame(&self) -> &LegFrame {
        &self.frame
    }

    fn solve(&self, c: DVec2, arm: DVec2) -> Result<Solved, Shortfall> {
        let guide = self.frame.platform_guide(arm);
        let chord = c - self.frame.anchor;
        let height = cross(guide, chord);
        let reach = self.crank - height.abs();
        if reach < 0.0 {
            return Err(Shortfall {
                limit_margin: reach,
                reason: ReachReason::OutOfReach,
            });
        }
        let foot = self.frame.sign * (reach * (self.crank + height.abs())).sqrt();
        let value = foot - chord.dot(guide);
        let within = Within::limits(value, self.travel).and_reach(reach);
        let b = c + guide * value;
        let posture = ChainPosture {
            a: self.frame.anchor,
            b,
            c,
            slider: None,
            proximal: Some(BarPosture {
                direction: (guide * foot + guide.perp() * height) / self.crank,
                offset: self.crank,
            }),
            distal: BarPosture {
                direction: -guide,
                offset: value,
            },
            beam: value.abs(),
            guides: [None, None, Some(-guide)],
            limit_margin: within.margin,
        };
        Ok((posture, within.beyond))
    }

    fn locked(&self, driven: usize, value: f64) -> LockedLeg {
        let (a, c) = (self.frame.anchor, self.frame.platform_joint);
        let guide = self.frame.platform_guide(c);
        let (platform, base, kind) = match driven {
            0 => (c, a + unit(value) * self.crank, LockedKind::PlatformLine(guide.perp())),
            1 => (c - unit(-value) * self.crank, a, LockedKind::PlatformLine(guide.perp())),
            _ => (c + guide * value, a, LockedKind::Circle(self.crank)),
        };
        LockedLeg { platform, base, kind }
    }

    #[inline(always)]
    fn lanes<V: Real>(&self, position: Planar<V>, arm: Planar<V>) -> ChainLanes<V> {
        let like = position.x;
        let (zero, one, crank) = (like.splat(0.0), like.splat(1.0), like.splat(self.crank));
        let to_unit = like.splat(1.0 / self.frame.arm_length);
        let guide = turned(arm, self.frame.platform_guide).scaled(to_unit);
        let chord = position.plus(arm.minus(Planar::splat(like, self.frame.anchor)));
        let height = guide.cross(chord);
        let reach = crank - height.abs();
        // Out of reach this is NaN, for which every comparison is false.
        let foot = like.splat(self.frame.sign) * (reach * (crank + height.abs())).sqrt();
        let value = foot - chord.dot(guide);
        let within = reach.smaller(margin_within(value, self.travel));
        let limit_margin = or_far_off(within.select(reach.at_least(zero), reach));
        let tangent = Planar::new(-guide.x, -guide.y);
        let to_share = like.splat(1.0 / self.crank);
        // In axes along −g, the crank has the components −foot and −height.
        let vector = Planar::new(-foot, -height);
        ChainLanes {
            tangent,
            along: arm.dot(tangent),
            across: arm.cross(tangent),
            offset: value,
            beam: value.abs(),
            signed_beam: value,
            proximal: Some(ProximalLanes {
                vector,
                direction: vector.scaled(to_share),
                length: crank,
                share: one,
                distal_share: value * to_share,
            }),
            guides: [None, None, Some(Planar::new(one, zero))],
            limit_margin,
            reachable: limit_margin.at_least(zero),
        }
    }

    /// With lengths in units of `L_b`, `h = g × v` and `w = √(λ² − h²)`: `σ = −v · g + s w`.
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
        let height = cross_models(guide, chord);
        let square = TaylorModel::constant(frame.proximal.square()) - height.squared();
        let foot = square.sqrt().times(frame.sign);
        let value = foot - dot(chord, guide);
        let [from_lower, to_upper] = enclosed_within(value, frame.guide_travel);
        ChainEnclosure {
            reach: [square, from_lower, to_upper, one],
            tangent: guide.map(|part| -part),
            offset: value,
            beam: absolute(value),
            signed_beam: value,
            slider: None,
            proximal: Some(frame.crank([-foot, -height])),
            guides: [None, None, Some([one, zero])],
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
        let elbow = difference(tip, chain.tangent.map(|part| part * chain.offset));
        let guide = chain.tangent.map(|part| -part);
        enclosed_members_on_crank(frame, [anchor, elbow], enclosed_guide(tip, guide, frame.guide_travel))
    }

    #[inline(always)]
    fn members<V: Real>(&self, c: Planar<V>, distal: &DistalLanes<V>) -> Members<V> {
        let guide = Planar::new(-distal.tangent.x, -distal.tangent.y);
        let elbow = c.plus(guide.scaled(distal.offset));
        members_on_crank(&self.frame, self.crank, elbow, guide_axis(c, guide, self.travel))
    }

    fn joint_values(&self, posture: &ChainPosture, arm: DVec2) -> [f64; 3] {
        let crank = angle_of(posture.b - posture.a);
        [
            crank,
            wrapped(self.frame.orientation(arm) - crank),
            posture.distal.offset,
        ]
    }

    fn joint_limits(&self) -> [Option<[f64; 2]>; 3] {
        [None, None, Some(self.travel)]
    }

    fn bodies(&self, posture: &ChainPosture, arm: DVec2, driven: usize) -> Vec<LegBody> {
        let [crank, elbow, value] = self.joint_values(posture, arm);
        let guide = -posture.distal.direction;
        vec![
            crank_body([posture.a, posture.b], crank, driven == 0),
            carriage_body(posture.b, guide, MemberKind::Crank, elbow, driven),
            platform_guide_body(posture.c, guide, value, self.travel, driven == 2),
        ]
    }

    fn travels(&self, _: &ChainPosture) -> Vec<Travel> {
        Vec::new()
    }

    fn reach_box(&self) -> [DVec2; 2] {
        box_about([self.frame.anchor; 2], self.crank + farthest(self.travel))
    }

    fn assembly(&self) -> Assembly {
        Assembly {
            value: self.crank + self.guide.max(farthest(self.travel)) + self.frame.arm_length,
            threshold: self.frame.anchor_distance,
        }
    }
}
