//! The interface of a leg type, and the manipulator that consists of three legs.

use glam::DVec2;

use super::{Design, MemberKind, Members};
use crate::enclosure::{Interval, LegEnclosure, MembersEnclosure, PlanarModel, PoseEnclosure, TurnedFrame};
use crate::lanes::{Planar, Real};
use crate::spatial::{ANCHOR_DIRECTIONS, LEGS, Pose, Rotation};

/// Kind of the actuated joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Actuator {
    /// Prismatic joint, with the actuator value in metres and the stiffness in N/m.
    Prismatic,
    /// Revolute joint, with the actuator value in radians and the stiffness in N·m/rad.
    Revolute,
}

impl Actuator {
    /// Returns the unit of the actuator value.
    pub fn unit(self) -> &'static str {
        match self {
            Actuator::Prismatic => "m",
            Actuator::Revolute => "rad",
        }
    }
}

/// Length of a telescopic bar in the beam model (docs/model.md, section 11).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BarLength {
    /// Current length `ρ_i` of the leg.
    Current,
    /// Largest length `L_b`, independent of the pose.
    Longest,
}

/// Settings of the legs that the study fixes in addition to the design vector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegSettings {
    /// Beam length of a telescopic leg.
    pub telescopic_bar: BarLength,
    /// Smallest length of a telescopic leg as a fraction of `L_b`, in \[0, 1).
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

/// Axis of a bar in the plane, from the proximal to the distal end, in the base frame \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// Proximal end.
    pub from: DVec2,
    /// Distal end (the tip).
    pub to: DVec2,
}

/// Travel of a prismatic joint in the base frame \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Guide {
    /// Travel of a slider along its rail.
    Rail {
        /// Position at the lower limit.
        from: DVec2,
        /// Position at the upper limit.
        to: DVec2,
    },
    /// Travel of the end of a telescopic leg along its current direction.
    Stroke {
        /// Position at the smallest leg length.
        from: DVec2,
        /// Position at the largest leg length.
        to: DVec2,
    },
}

/// Geometric part or joint of a leg, in the base frame \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LegPart {
    /// Actuated slider.
    Slider {
        /// Centre.
        at: DVec2,
        /// Unit vector along the rail.
        axis: DVec2,
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
    /// Bar clamped to a revolute actuator.
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
    },
}

/// Joint between a body and the preceding body of the leg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LegJoint {
    /// Passive revolute joint about z at the origin of the body.
    Passive,
    /// Actuated joint: prismatic along the body's axis or revolute about z, according to [`Leg::ACTUATOR`].
    Actuated {
        /// Actuator value \[m or rad\].
        value: f64,
        /// Smallest and largest actuator value, if the leg type has limits.
        limits: Option<[f64; 2]>,
    },
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
    /// Unit vector along the x axis of the body's frame. A prismatic actuator acts along this axis.
    pub axis: DVec2,
    /// Joint to the preceding body, or to the base.
    pub joint: LegJoint,
    /// Parts and joints that the body consists of.
    pub parts: Vec<LegPart>,
}

impl LegBody {
    /// Creates the link `B_iC_i` between two passive joints, the first of which connects it to a `proximal` member.
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

/// Posture of one leg at a pose that it reaches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegPosture {
    /// `B_i`, the proximal passive joint (`A_i` for a telescopic leg), in the base frame \[m\].
    pub b: DVec2,
    /// `u_i`, unit vector along the distal link, towards `C_i`.
    pub u: DVec2,
    /// `|B_iC_i|`: `L_b`, or `ρ_i` of a telescopic leg \[m\].
    pub length: f64,
    /// Transmission `B_ii`: speed of `C_i` along `u_i` per unit of actuator speed; 0 at a serial singularity.
    pub transmission: f64,
    /// Limit margin: smallest distance to a joint limit or to the end of reach \[m\], ≥ 0.
    pub limit_margin: f64,
}

/// Quantities of one leg that the constraints need, at several poses at once; valid in the lanes where the leg reaches
/// the pose.
#[derive(Clone, Copy)]
pub struct LegLanes<V: Real> {
    /// `u_i`.
    pub u: Planar<V>,
    /// `(C_i − P) × u_i` \[m\].
    pub moment: V,
    /// `(C_i − P) · u_i` \[m\].
    pub along: V,
    /// Transmission `B_ii`.
    pub transmission: V,
    /// Length of the distal bar in the beam model \[m\].
    pub distal: V,
    /// `u_i · (B_i − A_i)` and `u_i × (B_i − A_i)` of the proximal bar, for leg types that have one \[m\].
    pub proximal: Option<Planar<V>>,
    /// Limit margin: smallest distance to a joint limit or to the end of reach \[m\]; not above 0 where the leg does
    /// not reach the pose.
    pub limit_margin: V,
    /// Lanes where the leg reaches the pose.
    pub reachable: V::Mask,
}

/// Reason why a leg does not reach a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReachReason {
    /// The links are too short, so that the inverse kinematics has no real solution.
    OutOfReach,
    /// The actuator would be below its lower limit.
    BelowLimit,
    /// The actuator would be above its upper limit.
    AboveLimit,
    /// Two joints of the leg coincide, so that the direction of the leg is undefined.
    Degenerate,
}

/// Distance by which a leg fails to reach a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shortfall {
    /// Limit margin: signed distance to the violated limit \[m\], ≤ 0.
    pub limit_margin: f64,
    /// Violated limit.
    pub reason: ReachReason,
}

/// Leg type; a value holds the constants of one leg of one design.
pub trait Leg: Copy + Send + Sync {
    /// Name of the architecture in the paper.
    const NAME: &'static str;
    /// Kind of the actuated joint.
    const ACTUATOR: Actuator;
    /// Whether the inverse kinematics has two solutions.
    const HAS_WORKING_MODES: bool;
    /// Number of moving bars of the leg.
    const BARS: usize;
    /// Kind of the proximal member (the one before the distal member), for leg types that have one.
    const PROXIMAL: Option<MemberKind>;
    /// Kind of the distal member, which is connected to the platform.
    const DISTAL: MemberKind;

    /// Creates leg `index` (0, 1, 2) of `design`.
    fn new(design: &Design, settings: &LegSettings, index: usize) -> Self;

    /// Solves the inverse kinematics: returns the posture in which the end of the leg is at `c` (base frame, m)
    /// (docs/model.md, section 2.5).
    ///
    /// # Errors
    /// Returns the [`Shortfall`] if the working mode has no real solution, if a joint limit is violated, or if the
    /// direction of the leg is undefined.
    fn inverse(&self, c: DVec2) -> Result<LegPosture, Shortfall>;

    /// Solves the inverse kinematics at several poses at once, with `C_i` at `position + arm`.
    ///
    /// It is optimized for speed and may work in the leg's own axes. It rounds differently from [`Leg::inverse`] and
    /// does not give the reason why a pose is not reached.
    fn lanes<V: Real>(&self, position: Planar<V>, arm: Planar<V>) -> LegLanes<V>;

    /// Encloses leg `index` of a design over a box of poses.
    ///
    /// The formulas are written apart from those of [`Leg::lanes`], so that each checks the other.
    fn enclose(design: &Design, settings: &LegSettings, index: usize, pose: &PoseEnclosure) -> LegEnclosure;

    /// Encloses the axes of the members of leg `index` over a box of poses, relative to `P` and in multiples of `L_b`: `anchor` is
    /// `A_i`, and `tip` is `C_i`.
    fn enclose_members(
        settings: &LegSettings,
        index: usize,
        leg: &LegEnclosure,
        anchor: PlanarModel,
        tip: PlanarModel,
    ) -> MembersEnclosure;

    /// Returns the axes of the leg's members at several poses at once, with the end of the leg at `c` and its distal
    /// member along `u`.
    fn members<V: Real>(&self, c: Planar<V>, u: Planar<V>) -> Members<V>;

    /// Returns the actuator value: `ρ_i` \[m\], or the crank's angle to `Ox` in (−π, π] \[rad\].
    fn actuator(&self, posture: &LegPosture) -> f64;

    /// Returns the unit vector of a prismatic actuator's axis in the base frame; `None` for a revolute actuator.
    fn actuator_axis(&self, posture: &LegPosture) -> Option<DVec2>;

    /// Returns the position of the base joint `A_i`, the origin of the actuator value \[m\].
    fn anchor(&self) -> DVec2;

    /// Returns the length in the beam model of the distal bar, which runs along `u_i` to `C_i` \[m\].
    fn distal_length(&self, posture: &LegPosture) -> f64;

    /// Returns the rigid bodies of the leg, from the base to the platform.
    fn bodies(&self, posture: &LegPosture) -> Vec<LegBody>;

    /// Returns the travel of the prismatic joint; `None` for a leg without one.
    fn guide(&self, posture: &LegPosture) -> Option<Guide>;

    /// Returns the lower and upper corner of an axis-aligned box that contains every point that the end of the leg can
    /// reach \[m\].
    fn reach_box(&self) -> [DVec2; 2];

    /// Returns a distance from `O` beyond which no point `P` can be reached by all legs of any design with a base radius of at least
    /// `base`, and with platform radii and link lengths of at most those given \[m\].
    fn farthest_reach(base: f64, platform: f64, link: f64) -> f64;

    /// Returns the proximal bar, which is clamped to the actuator, for leg types that have one.
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

/// Postures of all legs at a pose that they reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Posture {
    /// `C_i − P` in base axes \[m\].
    pub arms: [DVec2; LEGS],
    /// Postures of legs 1, 2, 3.
    pub legs: [LegPosture; LEGS],
    /// Limit margin: smallest distance of any leg to a joint limit or to the end of reach \[m\]; the value of g2.
    pub limit_margin: f64,
}

impl<L: Leg> Manipulator<L> {
    /// Creates the manipulator of `design`.
    pub fn new(design: &Design, settings: &LegSettings) -> Self {
        Self {
            legs: [0, 1, 2].map(|i| L::new(design, settings, i)),
            platform_joints: ANCHOR_DIRECTIONS.map(|direction| direction * design.platform_radius),
        }
    }

    /// Returns `C_i − P` in base axes \[m\] at the platform orientation `rotation`.
    #[inline]
    pub fn arms(&self, rotation: &Rotation) -> [DVec2; LEGS] {
        self.platform_joints.map(|c| rotation.apply(c))
    }

    /// Solves the inverse kinematics at `pose`.
    ///
    /// # Errors
    /// Returns the index of the leg with the largest shortfall, and this [`Shortfall`].
    pub fn posture(&self, pose: &Pose) -> Result<Posture, (usize, Shortfall)> {
        self.posture_at(pose.position, &self.arms(&Rotation::new(pose.phi)))
    }

    /// Solves the inverse kinematics with `P` at `position` and with `arms` that were computed for an orientation.
    ///
    /// # Errors
    /// Fails as [`Manipulator::posture`] does.
    #[inline]
    pub fn posture_at(&self, position: DVec2, arms: &[DVec2; LEGS]) -> Result<Posture, (usize, Shortfall)> {
        let solved: [_; LEGS] = [0, 1, 2].map(|i| self.legs[i].inverse(position + arms[i]));
        match solved {
            [Ok(first), Ok(second), Ok(third)] => Ok(Posture {
                arms: *arms,
                legs: [first, second, third],
                limit_margin: first.limit_margin.min(second.limit_margin).min(third.limit_margin),
            }),
            _ => Err(worst(&solved)),
        }
    }
}

/// Returns the index and the shortfall of the leg with the largest shortfall, the first one among equals.
#[cold]
fn worst(solved: &[Result<LegPosture, Shortfall>; LEGS]) -> (usize, Shortfall) {
    let mut found: Option<(usize, Shortfall)> = None;
    for (index, leg) in solved.iter().enumerate() {
        if let Err(shortfall) = leg
            && found.is_none_or(|(_, other)| shortfall.limit_margin < other.limit_margin)
        {
            found = Some((index, *shortfall));
        }
    }
    found.expect("this function is called only if a leg has a shortfall")
}

/// Encloses the vector from `A_i` to `C_i`, in units of `L_b` and in the axes of `frame`, in which `A_i` stands at `(R, 0)`.
pub(super) fn leg_vector(design: &Design, frame: &TurnedFrame, pose: &PoseEnclosure) -> PlanarModel {
    let [x, y] = frame.enter(pose.position);
    let radius = Interval::exactly(design.platform_radius);
    let to_unit = Interval::exactly(1.0) / Interval::exactly(design.link_length);
    let leg = [
        (x + pose.cosine.scaled(radius)).plus(-Interval::exactly(design.base_radius)),
        y + pose.sine.scaled(radius),
    ];
    leg.map(|part| part.scaled(to_unit))
}

/// Returns the largest distance `|OP|` at which the farthest of the three base joints, which is at least
/// `√(|OP|² + R² + |OP|·R)` away, is no farther than `reach` \[m\].
pub(super) fn beyond_farthest_anchor(base: f64, reach: f64) -> f64 {
    (libm::sqrt((4.0 * reach * reach - 3.0 * base * base).max(0.0)) - base).max(0.0) * 0.5
}
