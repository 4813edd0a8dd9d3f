//! The interface of a leg, and the manipulator that consists of three legs.

use glam::DVec2;

use super::chain::{Assembly, ChainLanes, ChainPosture, DistalLanes, JointKind, LockedLeg};
use super::{Design, Geometry, LegEnclosure, LegFrame, LegFrameEnclosure, MemberKind, Members};
use crate::enclosure::{MembersEnclosure, PlanarModel, PoseEnclosure};
use crate::lanes::{Planar, Real};
use crate::spatial::{LEGS, Pose, Rotation};

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
    /// Arrangement of the joints and travel of the guides.
    pub geometry: Geometry,
}

impl Default for LegSettings {
    fn default() -> Self {
        Self {
            telescopic_bar: BarLength::Current,
            telescopic_shortest: 0.5,
            geometry: Geometry::default(),
        }
    }
}

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

/// Posture of one leg at a pose that it reaches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegPosture {
    /// Points and directions of the chain.
    pub chain: ChainPosture,
    /// `C_i − P` in base axes \[m\].
    pub arm: DVec2,
    /// `u_i`, unit vector along the line along which the leg transmits a force.
    pub u: DVec2,
    /// Moment of `u_i` on that line about `P` \[m\].
    pub moment: f64,
    /// Moments of `u_i` on that line about `A_i`, `B_i` and `C_i` \[m\].
    pub about: [f64; 3],
    /// Transmission `B_ii`: speed along the line per unit of speed of the driven joint; 0 at a serial singularity.
    pub transmission: f64,
}

/// Force and moments by which a unit force along the leg's line loads a bar, at several poses at once.
#[derive(Clone, Copy)]
pub struct BarLoads<V> {
    /// Component of the force along the bar; for the platform bar, multiplied by its length \[m\].
    pub force: V,
    /// Moments about the proximal and the distal end of the bar \[m\].
    pub moments: [V; 2],
}

/// Loads of the bars of a leg whose line is not that of its distal bar.
#[derive(Clone, Copy)]
pub struct LineLoads<V> {
    /// Bar from `B_i` to `C_i`.
    pub distal: BarLoads<V>,
    /// Bar from `A_i` to `B_i`; meaningless if there is none.
    pub proximal: BarLoads<V>,
    /// Bar from `C_i` to `P`.
    pub platform: BarLoads<V>,
}

/// Quantities of one leg that the constraints need, at several poses at once; valid in the lanes where the leg reaches
/// the pose.
#[derive(Clone, Copy)]
pub struct LegLanes<V: Real> {
    /// The chain.
    pub chain: ChainLanes<V>,
    /// `u_i`.
    pub u: Planar<V>,
    /// Moment of the leg's line about `P` \[m\].
    pub moment: V,
    /// Transmission `B_ii`.
    pub transmission: V,
    /// Loads of the bars; `None` if the line is that of the distal bar, which then does not bend.
    pub loads: Option<LineLoads<V>>,
}

impl<V: Real> LegLanes<V> {
    /// Returns the distal bar.
    #[inline(always)]
    pub fn distal(&self) -> DistalLanes<V> {
        DistalLanes {
            tangent: self.chain.tangent,
            offset: self.chain.offset,
        }
    }
}

/// Reason why a leg does not reach a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReachReason {
    /// The links are too short, so that the inverse kinematics has no real solution.
    OutOfReach,
    /// A prismatic joint would be below its lower limit.
    BelowLimit,
    /// A prismatic joint would be above its upper limit.
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

impl Travel {
    /// Returns the travel of a slider.
    pub(super) fn of_rail(frame: &LegFrame) -> Self {
        let [from, to] = frame.rail_ends();
        Self {
            kind: TravelKind::Rail,
            from,
            to,
        }
    }
}

/// What a prismatic joint moves along.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TravelKind {
    /// A slider along a rail of the base.
    Rail,
    /// The end of a telescopic leg along the current direction of the leg.
    Stroke,
}

/// Leg of a manipulator; a value holds the constants of one leg of one design.
pub trait Leg: Copy + Send + Sync {
    /// Whether the first joint of the leg can be a slider on a rail of the base.
    const MAY_BE_ON_RAILS: bool;

    /// Creates leg `index` (0, 1, 2) of `design`.
    fn new(design: &Design, settings: &LegSettings, index: usize) -> Self;

    /// Solves the inverse kinematics: returns the posture in which the end of the leg is at `c` in the base frame, with `arm` =
    /// `C_i − P` \[m\].
    ///
    /// # Errors
    /// Returns the [`Shortfall`] if the working mode has no real solution, if a joint limit is violated, or if a
    /// direction of the leg is undefined.
    fn inverse(&self, c: DVec2, arm: DVec2) -> Result<LegPosture, Shortfall>;

    /// Solves the inverse kinematics like [`Leg::inverse`], also beyond the limits of joints; tells which limit is violated, if one
    /// is.
    ///
    /// # Errors
    /// Returns the [`Shortfall`] if the working mode has no real solution, or if a direction of the leg is undefined.
    fn solve(&self, c: DVec2, arm: DVec2) -> Result<(LegPosture, Option<Shortfall>), Shortfall>;

    /// Returns what the leg requires of the platform while its driven joint is locked at a value \[m or rad\].
    fn locked(&self, value: f64) -> LockedLeg;

    /// Solves the inverse kinematics at several poses at once, with `C_i` at `position + arm`.
    fn lanes<V: Real>(&self, position: Planar<V>, arm: Planar<V>) -> LegLanes<V>;

    /// Encloses a leg of a design over a box of poses.
    fn enclose(
        frame: &LegFrameEnclosure,
        design: &Design,
        settings: &LegSettings,
        pose: &PoseEnclosure,
    ) -> LegEnclosure;

    /// Encloses the axes of the members of a leg over a box of poses, relative to `P` and in multiples of `L_b`: `anchor` is
    /// `A_i`, and `tip` is `C_i`.
    fn enclose_members(
        frame: &LegFrameEnclosure,
        design: &Design,
        settings: &LegSettings,
        leg: &LegEnclosure,
        anchor: PlanarModel,
        tip: PlanarModel,
    ) -> MembersEnclosure;

    /// Returns the axes of the leg's members at several poses at once, with the end of the leg at `c`.
    fn members<V: Real>(&self, c: Planar<V>, distal: &DistalLanes<V>) -> Members<V>;

    /// Returns the values of the three joints from base to platform \[m or rad\], angles in (−π, π].
    fn joint_values(&self, posture: &LegPosture) -> [f64; 3];

    /// Returns the smallest and largest values of the joints that have limits \[m\].
    fn joint_limits(&self) -> [Option<[f64; 2]>; 3];

    /// Returns the rigid bodies of the leg, from the base to the platform.
    fn bodies(&self, posture: &LegPosture) -> Vec<LegBody>;

    /// Returns the travels of the prismatic joints that the scene shows.
    fn travels(&self, posture: &LegPosture) -> Vec<Travel>;

    /// Returns the place of the leg in the manipulator.
    fn frame(&self) -> &LegFrame;

    /// Returns the lower and upper corner of an axis-aligned box that contains every point that the end of the leg can
    /// reach \[m\].
    fn reach_box(&self) -> [DVec2; 2];

    /// Returns what g1 compares.
    fn assembly(&self) -> Assembly;
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
            platform_joints: [0, 1, 2].map(|i| settings.geometry.platform_joint(i, design.platform_radius)),
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
        let solved: [_; LEGS] = [0, 1, 2].map(|i| self.legs[i].inverse(position + arms[i], arms[i]));
        match solved {
            [Ok(first), Ok(second), Ok(third)] => Ok(Posture {
                arms: *arms,
                legs: [first, second, third],
                limit_margin: [second, third]
                    .iter()
                    .fold(first.chain.limit_margin, |least, leg| least.min(leg.chain.limit_margin)),
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
