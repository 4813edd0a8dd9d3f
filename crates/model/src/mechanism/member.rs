//! Axes of the members of a manipulator, used for collision checks and for picking with the pointer.

use super::JointPoint;
use crate::lanes::{Planar, Real};

/// Kind of a member.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum MemberKind {
    /// Slider on a rail.
    Slider,
    /// Tube and rod of a telescopic leg, treated as one bar.
    TelescopicLeg,
    /// Bar from a revolute base joint to the next joint.
    Crank,
    /// Guide that turns about a base joint.
    TurningGuide,
    /// Guide on the platform, or on a slider.
    Guide,
    /// Bar between the proximal member and the platform.
    Link,
    /// Bar of the platform, from `C_i` to `P`.
    PlatformBar,
    /// Revolute joint with a size, or its pin.
    Joint(JointPoint),
    /// Motor of a revolute joint.
    Motor,
}

impl MemberKind {
    /// Returns the name that JSON uses.
    pub fn name(self) -> &'static str {
        match self {
            MemberKind::Slider => "slider",
            MemberKind::TelescopicLeg => "telescopic_leg",
            MemberKind::Crank => "crank",
            MemberKind::TurningGuide => "turning_guide",
            MemberKind::Guide => "guide",
            MemberKind::Link => "link",
            MemberKind::PlatformBar => "platform_bar",
            MemberKind::Joint(JointPoint::A) => "joint_A",
            MemberKind::Joint(JointPoint::B) => "joint_B",
            MemberKind::Joint(JointPoint::C) => "joint_C",
            MemberKind::Motor => "motor",
        }
    }
}

/// Axis of a member in the plane, at several poses at once.
#[derive(Clone, Copy)]
pub struct MemberAxis<V> {
    /// Proximal end \[m\].
    pub from: Planar<V>,
    /// Unit vector towards the distal end.
    pub direction: Planar<V>,
    /// Length \[m\].
    pub length: V,
}

impl<V: Real> MemberAxis<V> {
    /// Creates the axis of the given direction and length whose distal end is `tip`.
    #[inline(always)]
    pub fn back_from(tip: Planar<V>, direction: Planar<V>, length: V) -> Self {
        Self {
            from: tip.minus(direction.scaled(length)),
            direction,
            length,
        }
    }

    /// Returns the distal end \[m\].
    #[inline(always)]
    pub fn to(&self) -> Planar<V> {
        self.from.plus(self.direction.scaled(self.length))
    }

    /// Returns the axis extended by `by` at both ends.
    #[inline(always)]
    pub fn extended(&self, by: V) -> Self {
        Self {
            from: self.from.minus(self.direction.scaled(by)),
            direction: self.direction,
            length: self.length + by + by,
        }
    }
}

/// The axes of a leg's members at several poses at once.
#[derive(Clone, Copy)]
pub struct Members<V> {
    /// Axis of the proximal member (that before the distal one). For a slider, it starts at the
    /// centre of the slider, has the direction of the rail and length 0.
    pub proximal: Option<MemberAxis<V>>,
    /// Axis of the distal member (that which leads to the platform).
    pub distal: MemberAxis<V>,
    /// Distance of a slider's centre from the lower and the upper end of its rail \[m\].
    pub rail: Option<[V; 2]>,
}
