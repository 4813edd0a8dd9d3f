//! The rigid bodies of a leg, which follow from the kinds of its members for most chains, and the joints and parts of all.

use glam::DVec2;

use super::{ChainPosture, LegSizes};
use crate::mechanism::{JointKind, LegBody, LegJoint, LegPart, MemberKind};

/// Returns a revolute joint.
pub(in crate::mechanism) fn revolute(value: f64, is_driven: bool) -> LegJoint {
    LegJoint {
        kind: JointKind::Revolute,
        is_driven,
        value,
        limits: None,
    }
}

/// Returns a prismatic joint.
pub(in crate::mechanism) fn prismatic(value: f64, limits: [f64; 2], is_driven: bool) -> LegJoint {
    LegJoint {
        kind: JointKind::Prismatic,
        is_driven,
        value,
        limits: Some(limits),
    }
}

/// Returns the pin of a revolute joint between two members.
pub(in crate::mechanism) fn pin(at: DVec2, actuated: bool, joins: [MemberKind; 2]) -> LegPart {
    LegPart::Joint {
        at,
        actuated,
        joins,
        kind: JointKind::Revolute,
    }
}

/// Returns a bar on which a carriage moves, along `guide` from `origin`.
pub(in crate::mechanism) fn guide_bar(
    origin: DVec2,
    guide: DVec2,
    [lower, upper]: [f64; 2],
    kind: MemberKind,
) -> LegPart {
    let (from, to) = (origin + guide * lower.min(0.0), origin + guide * upper.max(0.0));
    LegPart::GuideBar { from, to, kind }
}

/// Returns a carriage on a guide of a kind.
pub(in crate::mechanism) fn carriage_on(on: MemberKind, at: DVec2, axis: DVec2, actuated: bool) -> LegPart {
    LegPart::Carriage { at, axis, on, actuated }
}

/// Returns the slider at `B_i`, with a mark if it is driven.
pub(in crate::mechanism) fn slider_body(
    leg: &LegSizes,
    posture: &ChainPosture,
    value: f64,
    is_driven: bool,
) -> LegBody {
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
        parts: vec![carriage_on(kind, b, guide, driven == 2), at_b],
    };
    vec![
        first,
        carriage,
        platform_guide_body(leg, posture, values[2], driven == 2),
    ]
}

/// Returns the guide on the platform, from `C_i`; it moves against its direction as its joint value grows.
pub(in crate::mechanism) fn platform_guide_body(
    leg: &LegSizes,
    posture: &ChainPosture,
    value: f64,
    is_driven: bool,
) -> LegBody {
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
