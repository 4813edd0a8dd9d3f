//! The seven chains, one file each, and what several of them share.

mod ppr;
mod prp;
mod prr;
mod rpp;
mod rpr;
mod rrp;
mod rrr;

pub use ppr::PprChain;
pub use prp::PrpChain;
pub use prr::PrrChain;
pub use rpp::RppChain;
pub use rpr::RprChain;
pub use rrp::RrpChain;
pub use rrr::RrrChain;

use glam::DVec2;

use super::{
    Chain, ChainEnclosure, ChainPosture, DistalLanes, JointKind, LegBody, LegJoint, LegPart, LegSizes, LegToEnclose,
    MemberAxis, MemberKind, Members, Shortfall,
};
use crate::enclosure::{AxisEnclosure, Interval, MembersEnclosure, PlanarModel, TaylorModel, difference};
use crate::lanes::{Planar, Real};
use crate::spatial::NUMBER_LIMIT;

/// Returns the distance of a value from the nearer of two limits at several poses at once, negative beyond them \[m\].
#[inline(always)]
fn margin_within<V: Real>(value: V, [lower, upper]: [f64; 2]) -> V {
    (value - value.splat(lower)).smaller(value.splat(upper) - value)
}

/// Returns the smaller of the distances of the values of two guides from their limits, a large shortfall where the guides are parallel.
#[inline(always)]
fn margin_within_both<V: Real>([first, second]: [V; 2], travels: [[f64; 2]; 2]) -> V {
    or_far_off(margin_within(first, travels[0]).smaller(margin_within(second, travels[1])))
}

/// Returns by how much a bar reaches beyond a height, which is negative out of reach, and the distance along the ground, which then is NaN,
/// for which every comparison is false.
#[inline(always)]
fn reach_and_foot<V: Real>(bar: V, height: V) -> [V; 2] {
    let height = height.abs();
    let reach = bar - height;
    // (L − h)(L + h) avoids the cancellation of L² − h² near the end of reach.
    [reach, (reach * (bar + height)).sqrt()]
}

/// Returns the same at one pose.
///
/// # Errors
/// Returns the [`Shortfall`] out of reach.
fn try_reach_and_foot(bar: f64, height: f64) -> Result<[f64; 2], Shortfall> {
    let [reach, foot] = reach_and_foot(bar, height);
    if reach < 0.0 {
        return Err(Shortfall::out_of_reach(reach));
    }
    Ok([reach, foot])
}

/// Returns `margin`, or a large shortfall where it is not a number.
#[inline(always)]
fn or_far_off<V: Real>(margin: V) -> V {
    let far = margin.splat(-NUMBER_LIMIT);
    margin.select(margin.at_least(far), far)
}

/// Returns `turn` applied to a vector, where `turn` holds a cosine and a sine.
#[inline(always)]
fn turned<V: Real>(vector: Planar<V>, turn: DVec2) -> Planar<V> {
    let (cosine, sine) = (vector.x.splat(turn.x), vector.x.splat(turn.y));
    Planar::new(cosine * vector.x - sine * vector.y, sine * vector.x + cosine * vector.y)
}

/// Returns the axis of a guide from a joint: it reaches from the joint to both ends of the travel.
#[inline(always)]
fn guide_axis<V: Real>(joint: Planar<V>, direction: Planar<V>, [lower, upper]: [f64; 2]) -> MemberAxis<V> {
    let like = joint.x;
    let [from, to] = [lower.min(0.0), upper.max(0.0)];
    MemberAxis {
        from: joint.plus(direction.scaled(like.splat(from))),
        direction,
        length: like.splat(to - from),
    }
}

/// Encloses the axis of a guide from a joint, with its travel in the unit of lengths.
fn enclosed_guide(joint: PlanarModel, direction: PlanarModel, travel: [Interval; 2]) -> AxisEnclosure {
    let zero = Interval::exactly(0.0);
    let from = if travel[0].lower() < 0.0 { travel[0] } else { zero };
    let to = if travel[1].upper() > 0.0 { travel[1] } else { zero };
    let at = |way: Interval| [0, 1].map(|k| joint[k] + direction[k].scaled(way));
    AxisEnclosure::between(at(from), at(to), direction)
}

/// Encloses the distances of a value from two limits.
fn enclosed_within(value: TaylorModel, [lower, upper]: [Interval; 2]) -> [TaylorModel; 2] {
    [value.plus(-lower), TaylorModel::constant(upper) - value]
}

/// Returns `g_i`, the unit vector along the guide on the platform, for `arm` = `C_i − P` at several poses at once.
#[inline(always)]
fn platform_guide<V: Real>(leg: &LegSizes, arm: Planar<V>) -> Planar<V> {
    turned(arm, leg.frame.platform_guide).scaled(arm.x.splat(1.0 / leg.frame.arm_length))
}

/// Returns the members of a leg with a slider or a crank, and with a link or a guide. The axis of a slider is a point with the direction of
/// the rail.
#[inline(always)]
pub(super) fn members_of<C: Chain, V: Real>(leg: &LegSizes, c: Planar<V>, distal: &DistalLanes<V>) -> Members<V> {
    let like = c.x;
    let (b, axis) = if const { matches!(C::DESCRIPTION.distal, MemberKind::Link) } {
        let link = MemberAxis::back_from(c, distal.tangent, like.splat(leg.link));
        (link.from, link)
    } else if const { C::DESCRIPTION.has_platform_guide() } {
        let guide = Planar::new(-distal.tangent.x, -distal.tangent.y);
        let b = c.plus(guide.scaled(distal.offset));
        (b, guide_axis(c, guide, leg.travels[1]))
    } else {
        let b = c.minus(distal.tangent.scaled(distal.offset));
        (b, guide_axis(b, distal.tangent, leg.travels[0]))
    };
    if const { C::DESCRIPTION.is_on_rails() } {
        return Members {
            proximal: Some(MemberAxis {
                from: b,
                direction: Planar::splat(like, leg.frame.rail),
                length: like.splat(0.0),
            }),
            distal: axis,
            rail: Some(leg.frame.from_rail_ends(b)),
        };
    }
    let anchor = Planar::splat(like, leg.frame.anchor);
    Members {
        proximal: Some(MemberAxis {
            from: anchor,
            direction: b.minus(anchor).scaled(like.splat(1.0 / leg.proximal)),
            length: like.splat(leg.proximal),
        }),
        distal: axis,
        rail: None,
    }
}

/// Encloses the same.
pub(super) fn enclosed_members(
    leg: &LegToEnclose<'_>,
    chain: &ChainEnclosure,
    anchor: PlanarModel,
    tip: PlanarModel,
) -> MembersEnclosure {
    let frame = leg.frame;
    let description = leg.design.architecture().chain();
    let tangent = chain.tangent;
    let (b, distal) = if description.distal == MemberKind::Link {
        let b = difference(tip, tangent);
        (b, AxisEnclosure::between(b, tip, tangent))
    } else {
        let b = difference(tip, tangent.map(|part| part * chain.offset));
        let (from, guide) = if description.has_platform_guide() {
            (tip, tangent.map(|part| -part))
        } else {
            (b, tangent)
        };
        (b, enclosed_guide(from, guide, frame.guide_travel))
    };
    let proximal = if description.is_on_rails() {
        AxisEnclosure::between(b, b, frame.rail.axis().map(TaylorModel::constant))
    } else {
        AxisEnclosure::between(anchor, b, frame.along_crank(difference(b, anchor)))
    };
    MembersEnclosure {
        proximal: Some(proximal),
        distal,
        rail: chain.slider,
    }
}

/// Encloses the absolute value.
fn absolute(value: TaylorModel) -> TaylorModel {
    if value.is_positive() {
        return value;
    }
    if value.is_negative() {
        return -value;
    }
    let [lower, upper] = value.range();
    let largest = if lower.is_nan() || upper.is_nan() {
        f64::NAN
    } else {
        upper.max(-lower)
    };
    TaylorModel::constant(Interval::new(0.0, largest))
}

/// Returns a revolute joint.
fn revolute(value: f64, is_driven: bool) -> LegJoint {
    LegJoint {
        kind: JointKind::Revolute,
        is_driven,
        value,
        limits: None,
    }
}

/// Returns a prismatic joint.
fn prismatic(value: f64, limits: [f64; 2], is_driven: bool) -> LegJoint {
    LegJoint {
        kind: JointKind::Prismatic,
        is_driven,
        value,
        limits: Some(limits),
    }
}

/// Returns the pin of a revolute joint between two members.
fn pin(at: DVec2, actuated: bool, joins: [MemberKind; 2]) -> LegPart {
    LegPart::Joint {
        at,
        actuated,
        joins,
        kind: JointKind::Revolute,
    }
}

/// Returns a bar on which a carriage moves, along `guide` from `origin`.
fn guide_bar(origin: DVec2, guide: DVec2, [lower, upper]: [f64; 2], kind: MemberKind) -> LegPart {
    let (from, to) = (origin + guide * lower.min(0.0), origin + guide * upper.max(0.0));
    LegPart::GuideBar { from, to, kind }
}

/// Returns the slider at `B_i`, with a mark if it is driven.
fn slider_body(leg: &LegSizes, posture: &ChainPosture, value: f64, is_driven: bool) -> LegBody {
    let (at, axis) = (posture.b, leg.frame.rail);
    LegBody {
        name: "slider",
        kind: MemberKind::Slider,
        origin: at,
        axis,
        joint: prismatic(value, leg.frame.rail_travel, is_driven),
        parts: vec![LegPart::Slider {
            at,
            axis,
            actuated: is_driven,
        }],
    }
}

/// Returns the crank from `A_i` to `B_i` with the pin of the base joint.
fn crank_body(posture: &ChainPosture, value: f64, is_driven: bool) -> LegBody {
    let (a, b) = (posture.a, posture.b);
    LegBody {
        name: "crank",
        kind: MemberKind::Crank,
        origin: a,
        axis: (b - a).normalize_or(DVec2::X),
        joint: revolute(value, is_driven),
        parts: vec![
            LegPart::Crank { from: a, to: b },
            pin(a, is_driven, [MemberKind::Crank; 2]),
        ],
    }
}

/// Returns the bodies of a leg with a slider or a crank, and with a link or a guide on the platform.
pub(super) fn leg_bodies(leg: &LegSizes, posture: &ChainPosture, values: [f64; 3], driven: usize) -> Vec<LegBody> {
    let (b, c) = (posture.b, posture.c);
    let (first, proximal) = if leg.chain.is_on_rails() {
        (slider_body(leg, posture, values[0], driven == 0), MemberKind::Slider)
    } else {
        (crank_body(posture, values[0], driven == 0), MemberKind::Crank)
    };
    let kind = leg.chain.distal;
    let at_b = pin(b, driven == 1, [kind, proximal]);
    if kind == MemberKind::Link {
        let link = LegBody {
            name: "link",
            kind,
            origin: b,
            axis: (c - b).normalize_or(DVec2::X),
            joint: revolute(values[1], driven == 1),
            parts: vec![
                LegPart::Link { from: b, to: c },
                at_b,
                pin(c, driven == 2, [kind, MemberKind::PlatformBar]),
            ],
        };
        return vec![first, link];
    }
    let guide = -posture.distal.direction;
    // The carriage on the guide of the platform.
    let carriage = LegBody {
        name: "carriage",
        kind,
        origin: b,
        axis: -guide,
        joint: revolute(values[1], driven == 1),
        parts: vec![
            LegPart::Carriage {
                at: b,
                axis: guide,
                on: kind,
                actuated: driven == 2,
            },
            at_b,
        ],
    };
    vec![
        first,
        carriage,
        platform_guide_body(leg, posture, values[2], driven == 2),
    ]
}

/// Returns the guide on the platform, from `C_i`; it moves against its direction as its joint value grows.
fn platform_guide_body(leg: &LegSizes, posture: &ChainPosture, value: f64, is_driven: bool) -> LegBody {
    let (guide, travel) = (-posture.distal.direction, leg.travels[1]);
    LegBody {
        name: "guide",
        kind: MemberKind::Guide,
        origin: posture.c,
        axis: -guide,
        joint: prismatic(value, travel, is_driven),
        parts: vec![guide_bar(posture.c, guide, travel, MemberKind::Guide)],
    }
}
