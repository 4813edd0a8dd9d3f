//! What a leg type must tell, and the three legs of a manipulator together.

use glam::DVec2;

use super::{Design, MemberKind, Members};
use crate::lanes::{Planar, Real};
use crate::spatial::{ANCHOR_DIRECTIONS, LEGS, Pose, Rotation};

/// Kind of the actuated joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Actuator {
    /// Actuator value in metres, stiffness in N/m.
    Prismatic,
    /// Actuator value in radians, stiffness in N·m/rad.
    Revolute,
}

impl Actuator {
    /// Unit of the actuator value.
    pub fn unit(self) -> &'static str {
        match self {
            Actuator::Prismatic => "m",
            Actuator::Revolute => "rad",
        }
    }
}

/// What the beam model takes as the length of a telescopic bar (SPEC section 8, no. 9).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BarLength {
    /// The leg's current length `ρ_i`.
    Current,
    /// The longest length `L_b`, whatever the pose.
    Longest,
}

/// What a study decides about legs beyond the design vector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegSettings {
    /// Beam length of a telescopic leg.
    pub telescopic_bar: BarLength,
    /// Shortest length of a telescopic leg as a share of `L_b`, in \[0, 1).
    pub telescopic_shortest: f64,
}

impl Default for LegSettings {
    fn default() -> Self {
        Self {
            telescopic_bar: BarLength::Current,
            telescopic_shortest: 0.5,
        }
    }
}

/// A bar's axis in the plane, from its proximal to its distal end, in the base frame \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// Proximal end.
    pub from: DVec2,
    /// Distal end, the tip.
    pub to: DVec2,
}

/// Where a prismatic joint can be, in the base frame \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Guide {
    /// Path of a slider over its whole travel.
    Rail {
        /// Lower limit.
        from: DVec2,
        /// Upper limit.
        to: DVec2,
    },
    /// Where the end of a telescopic leg can be along its present direction.
    Stroke {
        /// Shortest leg.
        from: DVec2,
        /// Longest leg.
        to: DVec2,
    },
}

/// A member or joint of a leg in the base frame \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LegPart {
    /// Actuated slider.
    Slider {
        /// Its centre.
        at: DVec2,
        /// Its axis, a unit vector.
        axis: DVec2,
    },
    /// Fixed half of a telescopic leg.
    Tube {
        /// At the base.
        from: DVec2,
        /// Where the rod comes out.
        to: DVec2,
    },
    /// Moving half of a telescopic leg; where the leg is short, part of it is inside the tube.
    Rod {
        /// Its inner end.
        from: DVec2,
        /// At the platform.
        to: DVec2,
    },
    /// Bar clamped to a revolute actuator.
    Crank {
        /// At the base.
        from: DVec2,
        /// At the link.
        to: DVec2,
    },
    /// Bar up to the platform.
    Link {
        /// Proximal end.
        from: DVec2,
        /// At the platform.
        to: DVec2,
    },
    /// Joint.
    Joint {
        /// Where.
        at: DVec2,
        /// Whether it is driven.
        actuated: bool,
        /// What it joins; one of them alone where the other is the base.
        joins: [MemberKind; 2],
    },
}

/// How a body moves against the one before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LegJoint {
    /// About z at the body's origin.
    Passive,
    /// The actuated joint: along or about what its kind says, at the value \[m or rad\].
    Actuated {
        /// Actuator value.
        value: f64,
        /// Least and largest value, where the leg type has limits.
        limits: Option<[f64; 2]>,
    },
}

/// A rigid body of a leg at a posture, in the base frame.
#[derive(Debug, Clone, PartialEq)]
pub struct LegBody {
    /// What it is, as in `crank`.
    pub name: &'static str,
    /// Kind of its member.
    pub kind: MemberKind,
    /// Origin of its frame \[m\].
    pub origin: DVec2,
    /// x axis of its frame, a unit vector. The actuator of a prismatic joint works along it.
    pub axis: DVec2,
    /// The joint to the body before it, or to the base.
    pub joint: LegJoint,
    /// What it consists of.
    pub parts: Vec<LegPart>,
}

impl LegBody {
    /// The link `B_iC_i` between two passive joints, the first to a `proximal` member.
    pub(super) fn link(posture: &LegPosture, proximal: MemberKind) -> Self {
        let (b, c) = (posture.b, posture.b + posture.u * posture.length);
        let joint = |at: DVec2, other: MemberKind| LegPart::Joint {
            at,
            actuated: false,
            joins: [MemberKind::Link, other],
        };
        Self {
            name: "link",
            kind: MemberKind::Link,
            origin: b,
            axis: posture.u,
            joint: LegJoint::Passive,
            parts: vec![
                LegPart::Link { from: b, to: c },
                joint(b, proximal),
                joint(c, MemberKind::PlatformBar),
            ],
        }
    }
}

/// One leg at a pose it reaches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegPosture {
    /// `B_i` in the base frame \[m\]; the proximal passive joint (`A_i` for a telescopic leg).
    pub b: DVec2,
    /// `u_i`, unit vector along the last link, towards `C_i`.
    pub u: DVec2,
    /// `|B_iC_i|`: `L_b`, or `ρ_i` of a telescopic leg \[m\].
    pub length: f64,
    /// `B_ii`: speed of `C_i` along `u_i` per unit of actuator speed; 0 at a serial singularity.
    pub drive: f64,
    /// Least distance to a joint limit or to the end of reach \[m\], ≥ 0.
    pub slack: f64,
}

/// One leg at several poses at once: what the constraints need of it, in the lanes where it reaches.
#[derive(Clone, Copy)]
pub struct LegLanes<V: Real> {
    /// `u_i`.
    pub u: Planar<V>,
    /// `(C_i − P) × u_i` \[m\].
    pub moment: V,
    /// `(C_i − P) · u_i` \[m\].
    pub along: V,
    /// `B_ii`.
    pub drive: V,
    /// Length of the last bar for the beam model \[m\].
    pub distal: V,
    /// `u_i · (B_i − A_i)` and `u_i × (B_i − A_i)` of the bar before the last, for legs that have one \[m\].
    pub proximal: Option<Planar<V>>,
    /// Least distance to a joint limit or to the end of reach \[m\]; not above 0 where the leg does not reach.
    pub slack: V,
    /// Where the leg reaches.
    pub reachable: V::Mask,
}

/// Why a leg does not reach a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReachReason {
    /// The links are too short: the inverse kinematics has no real solution.
    OutOfReach,
    /// The actuator would be below its lower limit.
    BelowLimit,
    /// The actuator would be above its upper limit.
    AboveLimit,
    /// Two joints of the leg coincide, and with them the leg's direction is lost.
    Degenerate,
}

/// How far a leg is from reaching a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shortfall {
    /// Signed distance to the limit \[m\], ≤ 0.
    pub slack: f64,
    /// Which limit.
    pub reason: ReachReason,
}

/// A leg type with the constants of one leg of one design.
pub trait Leg: Copy + Send + Sync {
    /// The architecture's name in the paper.
    const NAME: &'static str;
    /// Kind of the actuated joint.
    const ACTUATOR: Actuator;
    /// Whether the inverse kinematics has two solutions.
    const HAS_WORKING_MODES: bool;
    /// Number of moving bars.
    const BARS: usize;
    /// The member before the last, for legs that have one.
    const PROXIMAL: Option<MemberKind>;
    /// The member up to the platform.
    const DISTAL: MemberKind;

    /// Leg `index` (0, 1, 2) of `design`.
    fn new(design: &Design, settings: &LegSettings, index: usize) -> Self;

    /// Inverse kinematics: the posture in which the leg's end is at `c` (base frame, m).
    ///
    /// # Errors
    /// [`Shortfall`] when the working mode has no real solution or a joint limit is passed.
    fn inverse(&self, c: DVec2) -> Result<LegPosture, Shortfall>;

    /// [`Leg::inverse`] at several poses at once, with `C_i` at `position + arm`.
    ///
    /// Written for speed, in the leg's own axes; it rounds differently from [`Leg::inverse`] and says no reasons.
    fn lanes<V: Real>(&self, position: Planar<V>, arm: Planar<V>) -> LegLanes<V>;

    /// The axes of its members where the leg's end is at `c` and its last link points along `u`, at several poses at once.
    fn members<V: Real>(&self, c: Planar<V>, u: Planar<V>) -> Members<V>;

    /// Actuator value: `ρ_i` \[m\], or the crank's angle to `Ox` in (−π, π] \[rad\].
    fn actuator(&self, posture: &LegPosture) -> f64;

    /// Unit vector of a prismatic actuator's axis in the base frame; `None` for a revolute one.
    fn actuator_axis(&self, posture: &LegPosture) -> Option<DVec2>;

    /// Position of the actuated joint's origin, `A_i` \[m\].
    fn anchor(&self) -> DVec2;

    /// Length of the last bar, along `u_i` up to `C_i`, for the beam model \[m\].
    fn distal_length(&self, posture: &LegPosture) -> f64;

    /// Its rigid bodies, from the base to the platform.
    fn bodies(&self, posture: &LegPosture) -> Vec<LegBody>;

    /// Where its prismatic joint can be.
    fn guide(&self, posture: &LegPosture) -> Option<Guide>;

    /// Corners of an axis-parallel box that holds every point the leg's end can reach \[m\].
    fn reach_box(&self) -> [DVec2; 2];

    /// The bar before the last, clamped to the actuator, for legs that have one.
    fn proximal_bar(&self, posture: &LegPosture) -> Option<Segment>;
}

/// The three legs and the platform joints of one design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Manipulator<L> {
    /// Legs 1, 2, 3.
    pub legs: [L; LEGS],
    /// Platform joints in the platform frame, `c_i` \[m\].
    pub platform_joints: [DVec2; LEGS],
}

/// All legs at a pose they reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Posture {
    /// `C_i − P` in base axes \[m\].
    pub arms: [DVec2; LEGS],
    /// The legs.
    pub legs: [LegPosture; LEGS],
    /// Least distance of any leg to a joint limit or to the end of reach \[m\]: the value of g2.
    pub slack: f64,
}

impl<L: Leg> Manipulator<L> {
    /// The manipulator of `design`.
    pub fn new(design: &Design, settings: &LegSettings) -> Self {
        Self {
            legs: [0, 1, 2].map(|i| L::new(design, settings, i)),
            platform_joints: ANCHOR_DIRECTIONS.map(|direction| direction * design.platform_radius),
        }
    }

    /// `C_i − P` in base axes \[m\] at platform orientation `rotation`.
    #[inline]
    pub fn arms(&self, rotation: &Rotation) -> [DVec2; LEGS] {
        self.platform_joints.map(|c| rotation.apply(c))
    }

    /// Inverse kinematics at `pose`.
    ///
    /// # Errors
    /// The index of the leg that falls shortest, and by how much.
    pub fn posture(&self, pose: &Pose) -> Result<Posture, (usize, Shortfall)> {
        self.posture_at(pose.position, &self.arms(&Rotation::new(pose.phi)))
    }

    /// Inverse kinematics with `P` at `position` and the arms of an orientation already at hand.
    ///
    /// # Errors
    /// As [`Manipulator::posture`].
    #[inline]
    pub fn posture_at(&self, position: DVec2, arms: &[DVec2; LEGS]) -> Result<Posture, (usize, Shortfall)> {
        let solved: [_; LEGS] = [0, 1, 2].map(|i| self.legs[i].inverse(position + arms[i]));
        match solved {
            [Ok(first), Ok(second), Ok(third)] => Ok(Posture {
                arms: *arms,
                legs: [first, second, third],
                slack: first.slack.min(second.slack).min(third.slack),
            }),
            _ => Err(worst(&solved)),
        }
    }
}

/// The leg that misses its target by most, the first among equals.
#[cold]
fn worst(solved: &[Result<LegPosture, Shortfall>; LEGS]) -> (usize, Shortfall) {
    let mut found: Option<(usize, Shortfall)> = None;
    for (index, leg) in solved.iter().enumerate() {
        if let Err(shortfall) = leg
            && found.is_none_or(|(_, other)| shortfall.slack < other.slack)
        {
            found = Some((index, *shortfall));
        }
    }
    found.expect("called only when a leg falls short")
}
