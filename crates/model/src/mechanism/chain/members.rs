//! The axes of the members of a leg, which follow from their kinds for most chains.

use super::{Chain, DistalLanes, LegSizes};
use crate::enclosure::{AxisEnclosure, Interval, MembersEnclosure, PlanarModel, TaylorModel, difference};
use crate::lanes::{Planar, Real};
use crate::mechanism::{ChainEnclosure, LegToEnclose, MemberAxis, MemberKind, Members};

/// Returns the axis of a guide from a joint: it reaches from the joint to both ends of the travel.
#[inline(always)]
pub(in crate::mechanism) fn guide_axis<V: Real>(
    joint: Planar<V>,
    direction: Planar<V>,
    [lower, upper]: [f64; 2],
) -> MemberAxis<V> {
    let like = joint.x;
    let [from, to] = [lower.min(0.0), upper.max(0.0)];
    MemberAxis {
        from: joint.plus(direction.scaled(like.splat(from))),
        direction,
        length: like.splat(to - from),
    }
}

/// Encloses the axis of a guide from a joint, with its travel in the unit of lengths.
pub(in crate::mechanism) fn enclosed_guide(
    joint: PlanarModel,
    direction: PlanarModel,
    travel: [Interval; 2],
) -> AxisEnclosure {
    let zero = Interval::exactly(0.0);
    let from = if travel[0].lower() < 0.0 { travel[0] } else { zero };
    let to = if travel[1].upper() > 0.0 { travel[1] } else { zero };
    let at = |way: Interval| [0, 1].map(|k| joint[k] + direction[k].scaled(way));
    AxisEnclosure::between(at(from), at(to), direction)
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
