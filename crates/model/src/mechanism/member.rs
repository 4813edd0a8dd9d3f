//! Members of a manipulator as axes: what may collide, and what a pointer may touch.

use crate::lanes::{Planar, Real};

/// Kind of a member.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum MemberKind {
    /// Actuated block on a rail.
    Slider,
    /// Tube and rod as one bar.
    TelescopicLeg,
    /// Bar clamped to a revolute actuator.
    Crank,
    /// Bar up to the platform.
    Link,
    /// Bar of the platform, from `C_i` to `P`.
    PlatformBar,
}

impl MemberKind {
    /// Its name, as in JSON.
    pub fn name(self) -> &'static str {
        match self {
            MemberKind::Slider => "slider",
            MemberKind::TelescopicLeg => "telescopic_leg",
            MemberKind::Crank => "crank",
            MemberKind::Link => "link",
            MemberKind::PlatformBar => "platform_bar",
        }
    }
}

/// Axis of a member in the plane, at several poses at once.
#[derive(Clone, Copy)]
pub struct Axis<V> {
    /// Its proximal end \[m\].
    pub from: Planar<V>,
    /// Unit vector towards the distal end.
    pub direction: Planar<V>,
    /// Length \[m\].
    pub length: V,
}

impl<V: Real> Axis<V> {
    /// The axis of a length that ends at `tip`.
    #[inline(always)]
    pub fn back_from(tip: Planar<V>, direction: Planar<V>, length: V) -> Self {
        Self {
            from: tip.minus(direction.scaled(length)),
            direction,
            length,
        }
    }

    /// Its distal end \[m\].
    #[inline(always)]
    pub fn to(&self) -> Planar<V> {
        self.from.plus(self.direction.scaled(self.length))
    }

    /// The same, longer by `by` at either end.
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
    /// The member before the last ([`super::Leg::PROXIMAL`]); of a slider its centre, with the rail's direction.
    pub proximal: Option<Axis<V>>,
    /// The member up to the platform.
    pub distal: Axis<V>,
    /// Distance of a slider's centre from the lower and the upper end of its rail \[m\].
    pub rail: Option<[V; 2]>,
}
