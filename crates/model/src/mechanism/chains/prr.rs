//! PRR: slider at `B_i = A_i + ρ_i e_i` on a rail of the base, and link `B_iC_i` of length `L_b` (docs/model.md, section 2.2).

use glam::DVec2;

use super::{enclosed_within, margin_within, reach_and_foot, try_reach_and_foot};
use crate::enclosure::{PlanarModel, TaylorModel};
use crate::lanes::{Planar, Real};
use crate::mechanism::{
    Assembly, BarPosture, Chain, ChainDescription, ChainEnclosure, ChainLanes, DesignVariable, JointKind, JointPoint,
    LegFrame, LegSizes, LegToEnclose, LockedKind, LockedLeg, MemberKind, Shortfall, Solved, Within,
};
use crate::spatial::{Rotation, cross, unit};

/// Chain of a leg with a slider and a link.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrrChain;

impl Chain for PrrChain {
    const DESCRIPTION: ChainDescription = ChainDescription {
        name: "PRR",
        joints: [JointKind::Prismatic, JointKind::Revolute, JointKind::Revolute],
        points: [JointPoint::B, JointPoint::B, JointPoint::C],
        has_working_modes: true,
        has_proximal_bar: false,
        proximal: Some(MemberKind::Slider),
        distal: MemberKind::Link,
        variables: &[DesignVariable::RailAngle],
    };

    fn solve(leg: &LegSizes, c: DVec2, _: DVec2) -> Result<Solved, Shortfall> {
        let LegFrame { anchor, rail, .. } = leg.frame;
        let from_anchor = c - anchor;
        let [reach, foot] = try_reach_and_foot(leg.link, cross(rail, from_anchor))?;
        let value = from_anchor.dot(rail) + leg.frame.sign * foot;
        let b = anchor + rail * value;
        Ok(Solved {
            b,
            proximal: None,
            distal: BarPosture::new((c - b) / leg.link, leg.link),
            guides: [Some(rail), None, None],
            within: Within::limits(value, leg.frame.rail_travel).and_reach(reach),
        })
    }

    fn locked(leg: &LegSizes, driven: usize, value: f64) -> LockedLeg {
        let LegFrame { anchor, rail, .. } = leg.frame;
        let (c, along_rail) = (leg.frame.platform_joint, LockedKind::BaseLine(rail.perp()));
        match driven {
            0 => LockedLeg::new(c, anchor + rail * value, LockedKind::Circle(leg.link)),
            1 => {
                let link = Rotation::new(value).apply(rail) * leg.link;
                LockedLeg::new(c, anchor + link, along_rail)
            }
            _ => LockedLeg::new(c - unit(-value) * leg.link, anchor, along_rail),
        }
    }

    #[inline(always)]
    fn lanes<V: Real>(leg: &LegSizes, position: Planar<V>, arm: Planar<V>) -> ChainLanes<V> {
        let like = position.x;
        let axis = Planar::splat(like, leg.frame.rail);
        // Components in the slider's axes: along `e_i` and to its left. The terms that depend on the orientation alone
        // are kept separate from those of the position.
        let offset = arm.minus(Planar::splat(like, leg.frame.anchor));
        let along = position.dot(axis) + offset.dot(axis);
        let height = axis.cross(position) + axis.cross(offset);
        let arm = Planar::new(arm.dot(axis), axis.cross(arm));

        let link = like.splat(leg.link);
        let [reach, foot] = reach_and_foot(link, height);
        let actuator = along + like.splat(leg.frame.sign) * foot;
        let within = reach.smaller(margin_within(actuator, leg.frame.rail_travel));
        let limit_margin = within.select(reach.at_least(like.splat(0.0)), reach);

        let to_unit = 1.0 / leg.link;
        let u = Planar::new(
            like.splat(-leg.frame.sign * to_unit) * foot,
            like.splat(to_unit) * height,
        );
        ChainLanes::new(
            Planar::new(u.x * axis.x - u.y * axis.y, u.x * axis.y + u.y * axis.x),
            [arm.dot(u), arm.cross(u)],
            [link, link],
            [Some(Planar::new(u.x, -u.y)), None, None],
            limit_margin,
        )
    }

    /// In axes along `e_i` and to its left, `C_i` lies at the height `h L_b` above the rail, and `u_i = (−σ f, h)` with
    /// `f = √(1 − h²)`.
    fn enclose(leg: &LegToEnclose<'_>, position: PlanarModel, arm: PlanarModel) -> ChainEnclosure {
        let frame = leg.frame;
        let one = TaylorModel::exactly(1.0);
        let [along, height] = frame.rail.enter(frame.vector(position, arm));
        let square = one - height.squared();
        let foot = square.sqrt().times(frame.sign);
        let value = (along + foot).scaled(frame.link);
        let slider = enclosed_within(value, frame.rail_travel);
        let tangent = frame.rail.leave([-foot, height]);
        let guides = [Some([-foot, -height]), None, None];
        ChainEnclosure {
            slider: Some(slider),
            lever_square: Some(square),
            ..ChainEnclosure::new([square, slider[0], slider[1], one], tangent, [one, one], guides)
        }
    }

    fn assembly(leg: &LegSizes) -> Assembly {
        leg.assembly_from_rail(leg.link)
    }
}
