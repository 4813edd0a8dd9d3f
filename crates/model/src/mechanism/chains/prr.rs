//! PRR: slider at `B_i = A_i + ρ_i e_i` on a rail of the base, and link `B_iC_i` of length `L_b` (docs/model.md, section 2.2).

use glam::DVec2;

use super::{
    Within, angle_of, assembly_from_rail, box_about, enclosed_members_on_slider, enclosed_within, link_body,
    members_on_slider, slider_body, wrapped,
};
use crate::enclosure::{AxisEnclosure, MembersEnclosure, PlanarModel, TaylorModel, difference};
use crate::lanes::{Planar, Real};
use crate::mechanism::{
    Assembly, BarPosture, Chain, ChainDescription, ChainEnclosure, ChainLanes, ChainPosture, Design, DesignVariable,
    DistalLanes, JointKind, JointPoint, LegBody, LegFrame, LegFrameEnclosure, LegSettings, LockedKind, LockedLeg,
    MemberAxis, MemberKind, Members, ReachReason, Shortfall, Solved, Travel,
};
use crate::spatial::{Rotation, cross, unit};

/// Chain of a leg with a slider and a link.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrrChain {
    frame: LegFrame,
    link: f64,
}

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

    fn new(frame: LegFrame, design: &Design, _: &LegSettings) -> Self {
        Self {
            frame,
            link: design.link_length(),
        }
    }

    fn frame(&self) -> &LegFrame {
        &self.frame
    }

    fn solve(&self, c: DVec2, _: DVec2) -> Result<Solved, Shortfall> {
        let LegFrame { anchor, rail, .. } = self.frame;
        let from_anchor = c - anchor;
        let height = cross(rail, from_anchor);
        let reach = self.link - height.abs();
        if reach < 0.0 {
            return Err(Shortfall {
                limit_margin: reach,
                reason: ReachReason::OutOfReach,
            });
        }
        // (L − h)(L + h) avoids the cancellation of L² − h² near the end of reach.
        let foot = (reach * (self.link + height.abs())).sqrt();
        let value = from_anchor.dot(rail) + self.frame.sign * foot;
        let within = Within::limits(value, self.frame.rail_travel).and_reach(reach);
        let b = anchor + rail * value;
        let posture = ChainPosture {
            a: anchor,
            b,
            c,
            slider: Some(self.frame.from_rail_ends(b.into())),
            proximal: None,
            distal: BarPosture {
                direction: (c - b) / self.link,
                offset: self.link,
            },
            beam: self.link,
            guides: [Some(rail), None, None],
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
        let (platform, base, kind) = match driven {
            0 => (platform_joint, anchor + rail * value, LockedKind::Circle(self.link)),
            1 => {
                let link = Rotation::new(value).apply(rail) * self.link;
                (platform_joint, anchor + link, LockedKind::BaseLine(rail.perp()))
            }
            _ => (
                platform_joint - unit(-value) * self.link,
                anchor,
                LockedKind::BaseLine(rail.perp()),
            ),
        };
        LockedLeg { platform, base, kind }
    }

    #[inline(always)]
    fn lanes<V: Real>(&self, position: Planar<V>, arm: Planar<V>) -> ChainLanes<V> {
        let like = position.x;
        let axis = Planar::splat(like, self.frame.rail);
        // Components in the slider's axes: along `e_i` and to its left. The terms that depend on the orientation alone
        // are kept separate from those of the position.
        let offset = arm.minus(Planar::splat(like, self.frame.anchor));
        let along = position.dot(axis) + offset.dot(axis);
        let height = axis.cross(position) + axis.cross(offset);
        let arm = Planar::new(arm.dot(axis), axis.cross(arm));

        let (zero, link) = (like.splat(0.0), like.splat(self.link));
        let reach = link - height.abs();
        // Out of reach this is NaN, for which every comparison is false.
        let foot = (reach * (link + height.abs())).sqrt();
        let actuator = along + like.splat(self.frame.sign) * foot;
        let [lower, upper] = self.frame.rail_travel;
        let within = reach.smaller((actuator - like.splat(lower)).smaller(like.splat(upper) - actuator));
        let limit_margin = within.select(reach.at_least(zero), reach);

        let to_unit = 1.0 / self.link;
        let u = Planar::new(
            like.splat(-self.frame.sign * to_unit) * foot,
            like.splat(to_unit) * height,
        );
        ChainLanes {
            tangent: Planar::new(u.x * axis.x - u.y * axis.y, u.x * axis.y + u.y * axis.x),
            along: arm.dot(u),
            across: arm.cross(u),
            offset: link,
            beam: link,
            signed_beam: link,
            proximal: None,
            guides: [Some(Planar::new(u.x, -u.y)), None, None],
            limit_margin,
            reachable: limit_margin.at_least(zero),
        }
    }

    /// In axes along `e_i` and to its left, `C_i` lies at the height `h L_b` above the rail, and `u_i = (−σ f, h)` with
    /// `f = √(1 − h²)`.
    fn enclose(
        frame: &LegFrameEnclosure,
        _: &Design,
        _: &LegSettings,
        position: PlanarModel,
        arm: PlanarModel,
    ) -> ChainEnclosure {
        let one = TaylorModel::exactly(1.0);
        let [along, height] = frame.rail.enter(frame.vector(position, arm));
        let square = one - height.squared();
        let foot = square.sqrt().times(frame.sign);
        let value = (along + foot).scaled(frame.link);
        let [from_start, to_end] = enclosed_within(value, frame.rail_travel);
        ChainEnclosure {
            reach: [square, from_start, to_end, one],
            tangent: frame.rail.leave([-foot, height]),
            offset: one,
            beam: one,
            signed_beam: one,
            slider: Some([from_start, to_end]),
            proximal: None,
            guides: [Some([-foot, -height]), None, None],
            lever_square: Some(square),
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
        let centre = difference(tip, chain.tangent);
        let link = AxisEnclosure::between(centre, tip, chain.tangent);
        enclosed_members_on_slider(frame, chain, centre, link)
    }

    #[inline(always)]
    fn members<V: Real>(&self, c: Planar<V>, distal: &DistalLanes<V>) -> Members<V> {
        let link = MemberAxis::back_from(c, distal.tangent, c.x.splat(self.link));
        members_on_slider(&self.frame, link.from, link)
    }

    fn joint_values(&self, posture: &ChainPosture, arm: DVec2) -> [f64; 3] {
        let link = angle_of(posture.distal.direction);
        [
            (posture.b - posture.a).dot(self.frame.rail),
            wrapped(link - angle_of(self.frame.rail)),
            wrapped(self.frame.orientation(arm) - link),
        ]
    }

    fn joint_limits(&self) -> [Option<[f64; 2]>; 3] {
        [Some(self.frame.rail_travel), None, None]
    }

    fn bodies(&self, posture: &ChainPosture, arm: DVec2, driven: usize) -> Vec<LegBody> {
        let [rail, elbow, _] = self.joint_values(posture, arm);
        vec![
            slider_body(&self.frame, posture.b, rail, driven == 0),
            link_body([posture.b, posture.c], MemberKind::Slider, elbow, driven),
        ]
    }

    fn travels(&self, _: &ChainPosture) -> Vec<Travel> {
        vec![Travel::of_rail(&self.frame)]
    }

    fn reach_box(&self) -> [DVec2; 2] {
        box_about(self.frame.rail_ends(), self.link)
    }

    fn assembly(&self) -> Assembly {
        assembly_from_rail(&self.frame, self.link)
    }
}
