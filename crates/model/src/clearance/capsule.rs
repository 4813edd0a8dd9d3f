//! Named members at one pose, as capsules, and the clearance of a pair of them.

use std::fmt;
use std::sync::Arc;

use glam::{DVec2, DVec3};

use crate::mechanism::MemberKind;

/// A member of a manipulator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct MemberId {
    /// Index of the leg; for a platform bar, index of the leg to which the bar runs.
    pub leg: usize,
    /// Kind of the member.
    pub kind: MemberKind,
}

impl fmt::Display for MemberId {
    /// Writes the name, for example `leg1_link` or `platform_bar3`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (number, kind) = (self.leg + 1, self.kind.name());
        match self.kind {
            MemberKind::PlatformBar => write!(f, "{kind}{number}"),
            _ => write!(f, "leg{number}_{kind}"),
        }
    }
}

/// Object to which the clearance of a member is measured.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Neighbour {
    /// Another member.
    Member(MemberId),
    /// End of a slider's rail, located at a base joint `A_i`.
    RailEnd {
        /// Index of the leg to which the rail belongs.
        leg: usize,
        /// Index of the base joint at this end of the rail.
        anchor: usize,
    },
    /// An obstacle, by its name.
    Obstacle(Arc<str>),
    /// The outline of the room.
    Room,
}

impl fmt::Display for Neighbour {
    /// Writes the name, for example `leg2_link` or `rail1_end_A2`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Neighbour::Member(member) => member.fmt(f),
            Neighbour::Obstacle(name) => f.write_str(name),
            Neighbour::Room => f.write_str("room"),
            Neighbour::RailEnd { leg, anchor } => write!(f, "rail{}_end_A{}", leg + 1, anchor + 1),
        }
    }
}

/// Capsule of a member: its axis with a radius around it, in the base frame \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capsule {
    /// The member that the capsule represents.
    pub member: MemberId,
    /// Centre of the sphere at the proximal end.
    pub from: DVec3,
    /// Centre of the sphere at the distal end.
    pub to: DVec3,
    /// Radius.
    pub radius: f64,
}

/// A joint or a motor as an upright cylinder in the base frame \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UprightBody {
    /// The joint or motor.
    pub member: MemberId,
    /// Its axis in the plane.
    pub at: DVec2,
    /// Radius.
    pub radius: f64,
    /// Lowest and highest point.
    pub heights: [f64; 2],
}

/// Clearance of the nearest pair that is not joined: two members, a slider and an end of its rail, or a member and what stands beside
/// the manipulator.
#[derive(Debug, Clone, PartialEq)]
pub struct Clearance {
    /// Distance between the two surfaces \[m\]; where they overlap, the negative depth of penetration.
    pub distance: f64,
    /// First member of the pair.
    pub member: MemberId,
    /// What it is nearest to.
    pub neighbour: Neighbour,
    /// Points of the two axes that are nearest to each other, the end of a slider and the end of its rail, or points of an axis and of
    /// an outline.
    pub between: [DVec3; 2],
}

impl Clearance {
    /// Returns both names, for example `["leg1_link", "leg2_link"]`.
    pub fn pair(&self) -> [String; 2] {
        [self.member.to_string(), self.neighbour.to_string()]
    }
}
