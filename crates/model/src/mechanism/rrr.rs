//! 3-RRR: crank `A_iB_i` and link `B_iC_i`, both of length `L_b` (docs/model.md, section 2.4).

use glam::DVec2;

use super::leg::leg_vector;
use super::{
    Actuator, Design, Guide, Leg, LegBody, LegJoint, LegLanes, LegPart, LegPosture, LegSettings, MemberAxis,
    MemberKind, Members, ReachReason, Segment, Shortfall,
};
use crate::enclosure::{
    AxisEnclosure, LegEnclosure, MembersEnclosure, PlanarModel, PoseEnclosure, TaylorModel, TurnedFrame,
    cross as cross_models, difference, dot,
};
use crate::lanes::{Planar, Real};
use crate::spatial::{ANCHOR_DIRECTIONS, cross};

/// Leg of a 3-RRR.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RrrLeg {
    anchor: DVec2,
    link: f64,
    sign: f64,
}

impl Leg for RrrLeg {
    const NAME: &'static str = "3-RRR";
    const ACTUATOR: Actuator = Actuator::Revolute;
    const HAS_WORKING_MODES: bool = true;
    const BARS: usize = 2;
    const PROXIMAL: Option<MemberKind> = Some(MemberKind::Crank);
    const DISTAL: MemberKind = MemberKind::Link;

    fn new(design: &Design, _: &LegSettings, index: usize) -> Self {
        Self {
            anchor: ANCHOR_DIRECTIONS[index] * design.base_radius,
            link: design.link_length,
            sign: design.working_mode.sign(index),
        }
    }

    #[inline]
    fn inverse(&self, c: DVec2) -> Result<LegPosture, Shortfall> {
        let chord = c - self.anchor;
        let distance = chord.length();
        let half = 0.5 * distance;
        let limit_margin = 2.0 * self.link - distance;
        if limit_margin < 0.0 {
            return Err(Shortfall {
                limit_margin,
                reason: ReachReason::OutOfReach,
            });
        }
        if distance == 0.0 {
            return Err(Shortfall {
                limit_margin: 0.0,
                reason: ReachReason::Degenerate,
            });
        }
        let elbow = self.sign * ((self.link - half) * (self.link + half)).sqrt();
        let normal = chord.perp() / distance;
        let crank = chord * 0.5 + normal * elbow;
        let b = self.anchor + crank;
        let u = (c - b) / self.link;
        Ok(LegPosture {
            b,
            u,
            length: self.link,
            transmission: cross(crank, u),
            limit_margin,
        })
    }

    #[inline(always)]
    fn lanes<V: Real>(&self, position: Planar<V>, arm: Planar<V>) -> LegLanes<V> {
        let like = position.x;
        let chord = position.plus(arm.minus(Planar::splat(like, self.anchor)));
        let square = chord.dot(chord);
        let (zero, quarter, half) = (like.splat(0.0), like.splat(0.25), like.splat(0.5));
        // Square of the ratio of the elbow's distance from the chord to the chord's length. Out of reach it is negative
        // and its root is NaN, for which every comparison is false.
        let ratio = (like.splat(self.link * self.link) - quarter * square) / square;
        let elbow = like.splat(self.sign) * ratio.sqrt();
        let to_unit = like.splat(1.0 / self.link);
        let u = chord.scaled(half).minus(chord.perp().scaled(elbow)).scaled(to_unit);
        // (B − A) × u = (B − A) × (C − A)/L, to which only the component of B − A normal to the chord contributes.
        let transmission = -(elbow * square * to_unit);

        let reachable = like.splat(4.0 * self.link * self.link).at_least(square) & square.exceeds(zero);
        let limit_margin = like.splat(2.0 * self.link) - square.sqrt();
        LegLanes {
            u,
            moment: arm.cross(u),
            along: arm.dot(u),
            transmission,
            distal: like.splat(self.link),
            proximal: Some(Planar::new((quarter - ratio) * square * to_unit, -transmission)),
            limit_margin: limit_margin.larger(zero).select(reachable, limit_margin.smaller(zero)),
            reachable,
        }
    }

    /// In axes in which `A_i` stands at `(R, 0)`, with lengths in units of `L_b`, `v` leads from `A_i` to `C_i`, and
    /// `u = v/2 − τ v⊥` with `τ = σ √(1/S − 1/4)`, `S = |v|²`.
    fn enclose(design: &Design, _: &LegSettings, index: usize, pose: &PoseEnclosure) -> LegEnclosure {
        let frame = TurnedFrame::of_leg(index);
        let [x, y] = leg_vector(design, &frame, pose);
        let one = TaylorModel::exactly(1.0);
        let square = dot([x, y], [x, y]);
        let quarter = square.times(0.25);
        let elbow = one - quarter;
        let turn = (square.reciprocal() - one.times(0.25))
            .sqrt()
            .times(design.working_mode.sign(index));
        let u = [x.times(0.5) + turn * y, y.times(0.5) - turn * x];
        let arm = [pose.cosine, pose.sine];
        LegEnclosure {
            reach: [square, elbow, one],
            u: frame.leave(u),
            moment: cross_models(arm, u),
            along: dot(arm, u),
            transmission_square: square * elbow,
            distal: one,
            proximal: Some([square.times(0.5) - one, turn * square]),
        }
    }

    fn enclose_members(
        _: &LegSettings,
        _: usize,
        leg: &LegEnclosure,
        anchor: PlanarModel,
        tip: PlanarModel,
    ) -> MembersEnclosure {
        let elbow = difference(tip, leg.u);
        MembersEnclosure {
            proximal: Some(AxisEnclosure::between(anchor, elbow, difference(elbow, anchor))),
            distal: AxisEnclosure::between(elbow, tip, leg.u),
            rail: None,
        }
    }

    #[inline(always)]
    fn members<V: Real>(&self, c: Planar<V>, u: Planar<V>) -> Members<V> {
        let like = c.x;
        let length = like.splat(self.link);
        let link = MemberAxis::back_from(c, u, length);
        let anchor = Planar::splat(like, self.anchor);
        Members {
            proximal: Some(MemberAxis {
                from: anchor,
                direction: link.from.minus(anchor).scaled(like.splat(1.0 / self.link)),
                length,
            }),
            distal: link,
            rail: None,
        }
    }

    fn actuator(&self, posture: &LegPosture) -> f64 {
        let crank = posture.b - self.anchor;
        libm::atan2(crank.y, crank.x)
    }

    fn actuator_axis(&self, _: &LegPosture) -> Option<DVec2> {
        None
    }

    fn anchor(&self) -> DVec2 {
        self.anchor
    }

    fn bodies(&self, posture: &LegPosture) -> Vec<LegBody> {
        vec![
            LegBody {
                name: "crank",
                kind: MemberKind::Crank,
                origin: self.anchor,
                axis: (posture.b - self.anchor) / self.link,
                joint: LegJoint::Actuated {
                    value: self.actuator(posture),
                    limits: None,
                },
                parts: vec![
                    LegPart::Crank {
                        from: self.anchor,
                        to: posture.b,
                    },
                    LegPart::Joint {
                        at: self.anchor,
                        actuated: true,
                        joins: [MemberKind::Crank; 2],
                    },
                ],
            },
            LegBody::link(posture, MemberKind::Crank),
        ]
    }

    fn guide(&self, _: &LegPosture) -> Option<Guide> {
        None
    }

    fn reach_box(&self) -> [DVec2; 2] {
        let reach = DVec2::splat(2.0 * self.link);
        [self.anchor - reach, self.anchor + reach]
    }

    #[inline]
    fn distal_length(&self, _: &LegPosture) -> f64 {
        self.link
    }

    fn farthest_reach(base: f64, platform: f64, link: f64) -> f64 {
        super::leg::beyond_farthest_anchor(base, 2.0 * link + platform)
    }

    #[inline]
    fn proximal_bar(&self, posture: &LegPosture) -> Option<Segment> {
        Some(Segment {
            from: self.anchor,
            to: posture.b,
        })
    }
}
