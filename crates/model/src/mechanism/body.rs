//! Rigid bodies of a leg, the parts and joints that they consist of, and the travels of its prismatic joints.

use glam::DVec2;

use super::MemberKind;
use super::joint::JointKind;

/// Geometric part or joint of a leg, in the base frame \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LegPart {
    /// Slider on a rail of the base.
    Slider {
        /// Centre.
        at: DVec2,
        /// Unit vector along the rail.
        axis: DVec2,
        /// Whether it is driven.
        actuated: bool,
    },
    /// Part of a telescopic leg that is attached to the base.
    Tube {
        /// End at the base.
        from: DVec2,
        /// End from which the rod protrudes.
        to: DVec2,
    },
    /// Part of a telescopic leg that moves along the tube; if the leg is short, a part of the rod is inside the tube.
    Rod {
        /// End inside or behind the tube.
        from: DVec2,
        /// End at the platform.
        to: DVec2,
    },
    /// Carriage on a guide that moves.
    Carriage {
        /// Centre.
        at: DVec2,
        /// Unit vector along the guide.
        axis: DVec2,
        /// Kind of the member that the guide is.
        on: MemberKind,
        /// Whether it is driven.
        actuated: bool,
    },
    /// Bar on which a carriage moves.
    GuideBar {
        /// One end.
        from: DVec2,
        /// The other end.
        to: DVec2,
        /// Kind of the member.
        kind: MemberKind,
    },
    /// Bar between the base joint and the next one.
    Crank {
        /// End at the base.
        from: DVec2,
        /// End at the link.
        to: DVec2,
    },
    /// Bar between the proximal member and the platform.
    Link {
        /// Proximal end.
        from: DVec2,
        /// End at the platform.
        to: DVec2,
    },
    /// Joint.
    Joint {
        /// Position.
        at: DVec2,
        /// Whether the joint is actuated.
        actuated: bool,
        /// Kinds of the two members that it connects; the same kind twice if the second one is the base.
        joins: [MemberKind; 2],
        /// Kind of the joint.
        kind: JointKind,
    },
}

/// Joint between a body and the preceding body of the leg, or the base.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegJoint {
    /// Kind: a prismatic joint moves along the body's x axis, a revolute joint turns about z at the body's origin.
    pub kind: JointKind,
    /// Whether the joint is driven.
    pub is_driven: bool,
    /// Joint value \[m or rad\].
    pub value: f64,
    /// Smallest and largest value, if the joint has limits.
    pub limits: Option<[f64; 2]>,
}

/// Rigid body of a leg at a posture, in the base frame.
#[derive(Debug, Clone, PartialEq)]
pub struct LegBody {
    /// Name, for example `crank`.
    pub name: &'static str,
    /// Kind of the member that the body belongs to.
    pub kind: MemberKind,
    /// Origin of the body's frame \[m\].
    pub origin: DVec2,
    /// Unit vector along the x axis of the body's frame.
    pub axis: DVec2,
    /// Joint to the preceding body, or to the base.
    pub joint: LegJoint,
    /// Parts and joints that the body consists of.
    pub parts: Vec<LegPart>,
}

/// Travel of a prismatic joint in the base frame \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Travel {
    /// What moves, or on what.
    pub kind: TravelKind,
    /// Position at the lower limit.
    pub from: DVec2,
    /// Position at the upper limit.
    pub to: DVec2,
}

/// What a prismatic joint moves along.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TravelKind {
    /// A slider along a rail of the base.
    Rail,
    /// The end of a telescopic leg along the current direction of the leg.
    Stroke,
}
