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

use super::{Assembly, ChainEnclosure, JointKind};
use super::{
    LegBody, LegFrame, LegFrameEnclosure, LegJoint, LegPart, MemberAxis, MemberKind, Members, ReachReason, Shortfall,
};
use crate::enclosure::{AxisEnclosure, Interval, MembersEnclosure, PlanarModel, TaylorModel, difference};
use crate::lanes::{Planar, Real};
use crate::spatial::{NUMBER_LIMIT, cross};

/// Returns an angle in (−π, π] \[rad\].
fn wrapped(angle: f64) -> f64 {
    let wrapped = libm::remainder(angle, 2.0 * std::f64::consts::PI);
    if wrapped == -std::f64::consts::PI {
        -wrapped
    } else {
        wrapped
    }
}

/// Returns the angle of a vector to `Ox` \[rad\].
fn angle_of(vector: DVec2) -> f64 {
    libm::atan2(vector.y, vector.x)
}

/// Where a joint stands between its limits: the distance from the nearer one \[m\], negative beyond it, and what is wrong there.
#[derive(Debug, Clone, Copy)]
struct Within {
    margin: f64,
    beyond: Option<Shortfall>,
}

impl Within {
    /// Compares a value with two limits.
    fn limits(value: f64, [lower, upper]: [f64; 2]) -> Self {
        let (from_lower, to_upper) = (value - lower, upper - value);
        let beyond = if from_lower < 0.0 {
            Some((from_lower, ReachReason::BelowLimit))
        } else if to_upper < 0.0 {
            Some((to_upper, ReachReason::AboveLimit))
        } else if value.is_nan() {
            Some((0.0, ReachReason::Degenerate))
        } else {
            None
        };
        Self {
            margin: beyond.map_or(from_lower.min(to_upper), |(margin, _)| margin),
            beyond: beyond.map(|(limit_margin, reason)| Shortfall { limit_margin, reason }),
        }
    }

    /// Combines two joints: the smaller margin counts.
    fn and(self, other: Self) -> Self {
        if other.margin < self.margin { other } else { self }
    }

    /// Takes account of a distance to the end of reach, which is not negative.
    fn and_reach(self, reach: f64) -> Self {
        Self {
            margin: self.margin.min(reach),
            ..self
        }
    }
}

/// Returns the distance of a value from the nearer of two limits at several poses at once, negative beyond them \[m\].
#[inline(always)]
fn margin_within<V: Real>(value: V, [lower, upper]: [f64; 2]) -> V {
    (value - value.splat(lower)).smaller(value.splat(upper) - value)
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

/// Returns the two ends of a guide from a joint.
fn guide_ends(joint: DVec2, direction: DVec2, [lower, upper]: [f64; 2]) -> [DVec2; 2] {
    [joint + direction * lower.min(0.0), joint + direction * upper.max(0.0)]
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

/// Returns the members of a leg on a rail: a slider, whose axis is a point with the direction of the rail, and a distal member.
#[inline(always)]
fn members_on_slider<V: Real>(frame: &LegFrame, centre: Planar<V>, distal: MemberAxis<V>) -> Members<V> {
    let like = centre.x;
    let rail = Planar::splat(like, frame.rail);
    Members {
        proximal: Some(MemberAxis {
            from: centre,
            direction: rail,
            length: like.splat(0.0),
        }),
        distal,
        rail: Some(frame.from_rail_ends(centre)),
    }
}

/// Encloses the same, for a chain on rails.
fn enclosed_members_on_slider(
    frame: &LegFrameEnclosure,
    chain: &ChainEnclosure,
    centre: PlanarModel,
    distal: AxisEnclosure,
) -> MembersEnclosure {
    let rail = frame.rail.axis().map(TaylorModel::constant);
    MembersEnclosure {
        proximal: Some(AxisEnclosure::between(centre, centre, rail)),
        distal,
        rail: chain.slider,
    }
}

/// Returns the members of a leg with a crank of length `crank` from `A_i` to `elbow`, and a distal member.
#[inline(always)]
fn members_on_crank<V: Real>(frame: &LegFrame, crank: f64, elbow: Planar<V>, distal: MemberAxis<V>) -> Members<V> {
    let like = elbow.x;
    let anchor = Planar::splat(like, frame.anchor);
    Members {
        proximal: Some(MemberAxis {
            from: anchor,
            direction: elbow.minus(anchor).scaled(like.splat(1.0 / crank)),
            length: like.splat(crank),
        }),
        distal,
        rail: None,
    }
}

/// Encloses the same, for a crank between two points.
fn enclosed_members_on_crank(
    frame: &LegFrameEnclosure,
    [anchor, elbow]: [PlanarModel; 2],
    distal: AxisEnclosure,
) -> MembersEnclosure {
    let direction = frame.along_crank(difference(elbow, anchor));
    MembersEnclosure {
        proximal: Some(AxisEnclosure::between(anchor, elbow, direction)),
        distal,
        rail: None,
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

/// Returns the slider at `b`, with a mark if it is driven.
fn slider_body(frame: &LegFrame, b: DVec2, value: f64, is_driven: bool) -> LegBody {
    LegBody {
        name: "slider",
        kind: MemberKind::Slider,
        origin: b,
        axis: frame.rail,
        joint: prismatic(value, frame.rail_travel, is_driven),
        parts: vec![LegPart::Slider {
            at: b,
            axis: frame.rail,
            actuated: is_driven,
        }],
    }
}

/// Returns the link from `b` to `c` and the pins at its ends, the first of which connects it to a `proximal` member.
fn link_body([b, c]: [DVec2; 2], proximal: MemberKind, value: f64, driven: usize) -> LegBody {
    LegBody {
        name: "link",
        kind: MemberKind::Link,
        origin: b,
        axis: (c - b).normalize_or(DVec2::X),
        joint: revolute(value, driven == 1),
        parts: vec![
            LegPart::Link { from: b, to: c },
            pin(b, driven == 1, [MemberKind::Link, proximal]),
            pin(c, driven == 2, [MemberKind::Link, MemberKind::PlatformBar]),
        ],
    }
}

/// Returns the crank from `a` to `b` with the pin of the base joint.
fn crank_body([a, b]: [DVec2; 2], value: f64, is_driven: bool) -> LegBody {
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

/// Returns the guide on the platform, along `guide` from `c`; it moves against `guide` as its joint value grows.
fn platform_guide_body(c: DVec2, guide: DVec2, value: f64, travel: [f64; 2], is_driven: bool) -> LegBody {
    let [from, to] = guide_ends(c, guide, travel);
    LegBody {
        name: "guide",
        kind: MemberKind::Guide,
        origin: c,
        axis: -guide,
        joint: prismatic(value, travel, is_driven),
        parts: vec![LegPart::GuideBar {
            from,
            to,
            kind: MemberKind::Guide,
        }],
    }
}

/// Returns the carriage at `b` on the guide on the platform, with the pin that connects it to a `proximal` member.
fn carriage_body(b: DVec2, guide: DVec2, proximal: MemberKind, value: f64, driven: usize) -> LegBody {
    LegBody {
        name: "carriage",
        kind: MemberKind::Guide,
        origin: b,
        axis: -guide,
        joint: revolute(value, driven == 1),
        parts: vec![
            LegPart::Carriage {
                at: b,
                axis: guide,
                on: MemberKind::Guide,
                actuated: driven == 2,
            },
            pin(b, driven == 1, [MemberKind::Guide, proximal]),
        ],
    }
}

/// Returns the corners of a box about two points that reaches `reach` farther in every direction.
fn box_about(points: [DVec2; 2], reach: f64) -> [DVec2; 2] {
    let reach = DVec2::splat(reach);
    [points[0].min(points[1]) - reach, points[0].max(points[1]) + reach]
}

/// Returns the largest distance that a travel allows from its origin \[m\].
fn farthest(travel: [f64; 2]) -> f64 {
    travel[0].abs().max(travel[1].abs())
}

/// Returns what g1 compares for a leg on a rail: `reach + r_i` against the distance of `O` from the line of the rail.
fn assembly_from_rail(frame: &LegFrame, reach: f64) -> Assembly {
    Assembly {
        value: reach + frame.arm_length,
        threshold: cross(frame.rail, frame.anchor).abs(),
    }
}
