//! Members at one pose, by name.

use std::fmt;

use glam::DVec3;

use crate::mechanism::MemberKind;

/// A member of a manipulator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Member {
    /// Index of the leg, or of the leg that its bar of the platform runs to.
    pub leg: usize,
    /// What it is.
    pub kind: MemberKind,
}

impl fmt::Display for Member {
    /// As in `leg1_link` or `platform_bar3`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (number, kind) = (self.leg + 1, self.kind.name());
        match self.kind {
            MemberKind::PlatformBar => write!(f, "{kind}{number}"),
            _ => write!(f, "leg{number}_{kind}"),
        }
    }
}

/// What a member is near to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Neighbour {
    /// Another member.
    Member(Member),
    /// The end of a slider's rail, at the anchor `A` of this index.
    RailEnd {
        /// The leg whose rail it is.
        leg: usize,
        /// Index of the anchor.
        anchor: usize,
    },
}

impl fmt::Display for Neighbour {
    /// As in `leg2_link` or `rail1_end_A2`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Neighbour::Member(member) => member.fmt(f),
            Neighbour::RailEnd { leg, anchor } => write!(f, "rail{}_end_A{}", leg + 1, anchor + 1),
        }
    }
}

/// A member's axis with the radius about it, in the base frame \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capsule {
    /// Which member.
    pub member: Member,
    /// Centre of the sphere at the proximal end.
    pub from: DVec3,
    /// Centre of the sphere at the distal end.
    pub to: DVec3,
    /// Radius.
    pub radius: f64,
}

/// The nearest pair of bodies that are not joined.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clearance {
    /// Distance of their surfaces \[m\]; where they overlap, the depth of penetration, negative.
    pub distance: f64,
    /// One of the two.
    pub member: Member,
    /// The other.
    pub neighbour: Neighbour,
    /// The points of the members' axes that are nearest to each other, or a slider's end and that of its rail.
    pub between: [DVec3; 2],
}

impl Clearance {
    /// Both names, as in `["leg1_link", "leg2_link"]`.
    pub fn pair(&self) -> [String; 2] {
        [self.member.to_string(), self.neighbour.to_string()]
    }
}
