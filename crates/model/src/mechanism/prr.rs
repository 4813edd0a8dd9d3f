//! 3-PRR: slider at `B_i = A_i + ρ_i e_i` on the side `A_iA_{i+1}` of the base triangle, and link `B_iC_i` of length
//! `L_b` (docs/model.md, section 2.2).

use glam::DVec2;

use super::{
    Actuator, Design, Guide, Leg, LegBody, LegJoint, LegLanes, LegPart, LegPosture, LegSettings, MemberAxis,
    MemberKind, Members, ReachReason, Segment, Shortfall,
};
use crate::enclosure::{
    AxisEnclosure, Interval, LegEnclosure, MembersEnclosure, PlanarModel, PoseEnclosure, TaylorModel, TurnedFrame,
    cross as cross_models, difference, dot,
};
use crate::lanes::{Planar, Real};
use crate::spatial::{ANCHOR_DIRECTIONS, HALF_SQRT_3, LEGS, cross};

/// Leg of a 3-PRR.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrrLeg {
    anchor: DVec2,
    /// `e_i`, the unit vector from `A_i` to `A_{i+1}`.
    axis: DVec2,
    link: f64,
    /// Travel `√3 R` of the slider \[m\].
    travel: f64,
    sign: f64,
}

impl Leg for PrrLeg {
    const NAME: &'static str = "3-PRR";
    const ACTUATOR: Actuator = Actuator::Prismatic;
    const HAS_WORKING_MODES: bool = true;
    const BARS: usize = 1;
    const PROXIMAL: Option<MemberKind> = Some(MemberKind::Slider);
    const DISTAL: MemberKind = MemberKind::Link;

    fn new(design: &Design, _: &LegSettings, index: usize) -> Self {
        let side = ANCHOR_DIRECTIONS[(index + 1) % LEGS] - ANCHOR_DIRECTIONS[index];
        Self {
            anchor: ANCHOR_DIRECTIONS[index] * design.base_radius,
            axis: side / (2.0 * HALF_SQRT_3),
            link: design.link_length,
            travel: 2.0 * HALF_SQRT_3 * design.base_radius,
            sign: design.working_mode.sign(index),
        }
    }

    #[inline]
    fn inverse(&self, c: DVec2) -> Result<LegPosture, Shortfall> {
        let from_anchor = c - self.anchor;
        let along = from_anchor.dot(self.axis);
        let height = cross(self.axis, from_anchor);
        let reach = self.link - height.abs();
        if reach < 0.0 {
            return Err(Shortfall {
                limit_margin: reach,
                reason: ReachReason::OutOfReach,
            });
        }
        // (L − h)(L + h) avoids the cancellation of L² − h² near the end of reach.
        let foot = (reach * (self.link + height.abs())).sqrt();
        let actuator = along + self.sign * foot;
        if actuator < 0.0 {
            return Err(Shortfall {
                limit_margin: actuator,
                reason: ReachReason::BelowLimit,
            });
        }
        if actuator > self.travel {
            return Err(Shortfall {
                limit_margin: self.travel - actuator,
                reason: ReachReason::AboveLimit,
            });
        }
        let b = self.anchor + self.axis * actuator;
        let u = (c - b) / self.link;
        Ok(LegPosture {
            b,
            u,
            length: self.link,
            transmission: u.dot(self.axis),
            limit_margin: reach.min(actuator).min(self.travel - actuator),
        })
    }

    #[inline(always)]
    fn lanes<V: Real>(&self, position: Planar<V>, arm: Planar<V>) -> LegLanes<V> {
        let like = position.x;
        let axis = Planar::splat(like, self.axis);
        // Components in the slider's axes: along `e_i` and to its left. The terms that depend on the orientation alone
        // are kept separate from those of the position.
        let offset = arm.minus(Planar::splat(like, self.anchor));
        let along = position.dot(axis) + offset.dot(axis);
        let height = axis.cross(position) + axis.cross(offset);
        let arm = Planar::new(arm.dot(axis), axis.cross(arm));

        let (zero, link, travel) = (like.splat(0.0), like.splat(self.link), like.splat(self.travel));
        let reach = link - height.abs();
        // Out of reach this is NaN, for which every comparison is false.
        let foot = (reach * (link + height.abs())).sqrt();
        let actuator = along + like.splat(self.sign) * foot;
        let within = reach.smaller(actuator.smaller(travel - actuator));
        let limit_margin = within.select(reach.at_least(zero), reach);

        let to_unit = 1.0 / self.link;
        let transmission = like.splat(-self.sign * to_unit) * foot;
        let u = Planar::new(transmission, like.splat(to_unit) * height);
        LegLanes {
            u: Planar::new(u.x * axis.x - u.y * axis.y, u.x * axis.y + u.y * axis.x),
            moment: arm.cross(u),
            along: arm.dot(u),
            transmission,
            distal: link,
            proximal: None,
            limit_margin,
            reachable: limit_margin.at_least(zero),
        }
    }

    /// In axes along `e_i` and to its left, `C_i` lies at the height `h L_b` above the rail, and `u_i = (−σ f, h)` with
    /// `f = √(1 − h²)`.
    fn enclose(design: &Design, _: &LegSettings, index: usize, pose: &PoseEnclosure) -> LegEnclosure {
        let frame = TurnedFrame::by_thirties(4 * index as u8);
        let [x, y] = frame.enter(pose.position);
        // In these axes the arm of every leg stands at φ + 210°, and A_i at (−√3/2, −1/2) R.
        let arm = TurnedFrame::by_thirties(7).direction(pose);
        let (radius, link) = (
            Interval::exactly(design.platform_radius),
            Interval::exactly(design.link_length),
        );
        let base = Interval::exactly(design.base_radius);
        let half = Interval::exactly(0.5);
        let one = TaylorModel::exactly(1.0);
        let height = (y + arm[1].scaled(radius))
            .plus(base * half)
            .scaled(Interval::exactly(1.0) / link);
        let transmission_square = one - height.squared();
        let foot = transmission_square.sqrt();
        let side = Interval::sqrt_3() * base;
        let sign = design.working_mode.sign(index);
        let along_rail = (x + arm[0].scaled(radius)).plus(side * half);
        let actuator = along_rail + foot.scaled(link).times(sign);
        let u = [foot.times(-sign), height];
        LegEnclosure {
            reach: [transmission_square, actuator, TaylorModel::constant(side) - actuator],
            u: frame.leave(u),
            moment: cross_models(arm, u),
            along: dot(arm, u),
            transmission_square,
            distal: one,
            proximal: None,
        }
    }

    fn enclose_members(
        _: &LegSettings,
        index: usize,
        leg: &LegEnclosure,
        _: PlanarModel,
        tip: PlanarModel,
    ) -> MembersEnclosure {
        let slider = difference(tip, leg.u);
        let (one, zero) = (TaylorModel::exactly(1.0), TaylorModel::exactly(0.0));
        let axis = TurnedFrame::by_thirties(4 * index as u8).leave([one, zero]);
        let [_, from_start, to_end] = leg.reach;
        MembersEnclosure {
            proximal: Some(AxisEnclosure::between(slider, slider, axis)),
            distal: AxisEnclosure::between(slider, tip, leg.u),
            rail: Some([from_start, to_end]),
        }
    }

    #[inline(always)]
    fn members<V: Real>(&self, c: Planar<V>, u: Planar<V>) -> Members<V> {
        let like = c.x;
        let link = MemberAxis::back_from(c, u, like.splat(self.link));
        let axis = Planar::splat(like, self.axis);
        let along = link.from.minus(Planar::splat(like, self.anchor)).dot(axis);
        Members {
            proximal: Some(MemberAxis {
                from: link.from,
                direction: axis,
                length: like.splat(0.0),
            }),
            distal: link,
            rail: Some([along, like.splat(self.travel) - along]),
        }
    }

    fn actuator(&self, posture: &LegPosture) -> f64 {
        (posture.b - self.anchor).dot(self.axis)
    }

    fn actuator_axis(&self, _: &LegPosture) -> Option<DVec2> {
        Some(self.axis)
    }

    fn anchor(&self) -> DVec2 {
        self.anchor
    }

    fn bodies(&self, posture: &LegPosture) -> Vec<LegBody> {
        vec![
            LegBody {
                name: "slider",
                kind: MemberKind::Slider,
                origin: posture.b,
                axis: self.axis,
                joint: LegJoint::Actuated {
                    value: self.actuator(posture),
                    limits: Some([0.0, self.travel]),
                },
                parts: vec![LegPart::Slider {
                    at: posture.b,
                    axis: self.axis,
                }],
            },
            LegBody::link(posture, MemberKind::Slider),
        ]
    }

    fn guide(&self, _: &LegPosture) -> Option<Guide> {
        Some(Guide::Rail {
            from: self.anchor,
            to: self.anchor + self.axis * self.travel,
        })
    }

    fn reach_box(&self) -> [DVec2; 2] {
        let end = self.anchor + self.axis * self.travel;
        let reach = DVec2::splat(self.link);
        [self.anchor.min(end) - reach, self.anchor.max(end) + reach]
    }

    #[inline]
    fn distal_length(&self, _: &LegPosture) -> f64 {
        self.link
    }

    fn farthest_reach(base: f64, platform: f64, link: f64) -> f64 {
        // The rails are the sides of the base triangle; that farthest from `P` is at least (base + |OP|)/2 away.
        (2.0 * (link + platform) - base).max(0.0)
    }

    #[inline]
    fn proximal_bar(&self, _: &LegPosture) -> Option<Segment> {
        None
    }
}
