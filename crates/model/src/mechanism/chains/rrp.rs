//! RRP: crank `A_iB_i` of length `L_a`, and a carriage at `B_i = C_i + σ_i g_i` on a guide of the platform (docs/model.md,
//! section 2.8).

use glam::DVec2;

use super::{absolute, enclosed_within, margin_within, or_far_off, platform_guide, reach_and_foot, try_reach_and_foot};
use crate::enclosure::{PlanarModel, TaylorModel, cross as cross_models, dot};
use crate::lanes::{Planar, Real};
use crate::mechanism::{
    Assembly, BarPosture, Chain, ChainDescription, ChainEnclosure, ChainLanes, DesignVariable, JointKind, JointPoint,
    LegSizes, LegToEnclose, LockedKind, LockedLeg, MemberKind, ProximalLanes, Shortfall, Solved, Within,
};
use crate::spatial::{cross, unit};

/// Chain of a leg with a crank and a guide on the platform.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RrpChain;

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

    fn solve(leg: &LegSizes, c: DVec2, arm: DVec2) -> Result<Solved, Shortfall> {
        let guide = leg.frame.platform_guide(arm);
        let chord = c - leg.frame.anchor;
        let height = cross(guide, chord);
        let [reach, foot] = try_reach_and_foot(leg.proximal, height)?;
        let foot = leg.frame.sign * foot;
        let value = foot - chord.dot(guide);
        let crank = (guide * foot + guide.perp() * height) / leg.proximal;
        Ok(Solved {
            b: c + guide * value,
            proximal: Some(BarPosture::new(crank, leg.proximal)),
            distal: BarPosture::new(-guide, value),
            guides: [None, None, Some(-guide)],
            within: Within::limits(value, leg.travels[1]).and_reach(reach),
        })
    }

    fn locked(leg: &LegSizes, driven: usize, value: f64) -> LockedLeg {
        let (a, c) = (leg.frame.anchor, leg.frame.platform_joint);
        let guide = leg.frame.platform_guide(c);
        let (crank, along_guide) = (leg.proximal, LockedKind::PlatformLine(guide.perp()));
        match driven {
            0 => LockedLeg::new(c, a + unit(value) * crank, along_guide),
            1 => LockedLeg::new(c - unit(-value) * crank, a, along_guide),
            _ => LockedLeg::new(c + guide * value, a, LockedKind::Circle(crank)),
        }
    }

    #[inline(always)]
    fn lanes<V: Real>(leg: &LegSizes, position: Planar<V>, arm: Planar<V>) -> ChainLanes<V> {
        let like = position.x;
        let (zero, one, crank) = (like.splat(0.0), like.splat(1.0), like.splat(leg.proximal));
        let guide = platform_guide(leg, arm);
        let chord = leg.chord(position, arm);
        let height = guide.cross(chord);
        let [reach, foot] = reach_and_foot(crank, height);
        let foot = like.splat(leg.frame.sign) * foot;
        let value = foot - chord.dot(guide);
        let within = reach.smaller(margin_within(value, leg.travels[1]));
        let limit_margin = or_far_off(within.select(reach.at_least(zero), reach));
        let tangent = Planar::new(-guide.x, -guide.y);
        let to_share = like.splat(1.0 / leg.proximal);
        // In axes along −g, the crank has the components −foot and −height.
        let vector = Planar::new(-foot, -height);
        ChainLanes {
            proximal: Some(ProximalLanes {
                vector,
                direction: vector.scaled(to_share),
                length: crank,
                share: one,
                distal_share: value * to_share,
            }),
            ..ChainLanes::new(
                tangent,
                [arm.dot(tangent), arm.cross(tangent)],
                [value, value.abs()],
                [None, None, Some(Planar::new(one, zero))],
                limit_margin,
            )
        }
    }

    /// With lengths in units of `L_b`, `h = g × v` and `w = √(λ² − h²)`: `σ = −v · g + s w`.
    fn enclose(leg: &LegToEnclose<'_>, position: PlanarModel, arm: PlanarModel) -> ChainEnclosure {
        let frame = leg.frame;
        let (one, zero) = (TaylorModel::exactly(1.0), TaylorModel::exactly(0.0));
        let guide = frame.platform_guide.leave(arm);
        let chord = frame.vector(position, arm);
        let height = cross_models(guide, chord);
        let square = TaylorModel::constant(frame.proximal.square()) - height.squared();
        let foot = square.sqrt().times(frame.sign);
        let value = foot - dot(chord, guide);
        let [from_lower, to_upper] = enclosed_within(value, frame.guide_travel);
        ChainEnclosure {
            proximal: Some(frame.crank([-foot, -height])),
            ..ChainEnclosure::new(
                [square, from_lower, to_upper, one],
                guide.map(|part| -part),
                [value, absolute(value)],
                [None, None, Some([one, zero])],
            )
        }
    }

    fn assembly(leg: &LegSizes) -> Assembly {
        leg.assembly(leg.proximal + leg.longest_guide(1), leg.frame.anchor_distance)
    }
}
