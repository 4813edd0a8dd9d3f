//! The interface of a leg, and the manipulator that consists of three legs.

use glam::DVec2;

use super::chain::{Assembly, ChainLanes, ChainPosture, DistalLanes};
use super::{Design, LegFrame, LegSettings, LegSizes, Members, Shortfall};
use crate::lanes::{Planar, Real};
use crate::spatial::{LEGS, Pose, Rotation};

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
    /// Transmission `B_ii`: speed along the line per unit of speed of the actuated joint; 0 at a serial singularity.
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

impl<V: Real> BarLoads<V> {
    /// Creates the loads from the component of the force and the two moments.
    #[inline(always)]
    pub(super) fn new([force, proximal, distal]: [V; 3]) -> Self {
        let moments = [proximal, distal];
        Self { force, moments }
    }
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

/// What the loops over poses need of a leg; a value holds the constants of one leg of one design. The rest is asked of [`AnyLeg`](super::AnyLeg).
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

    /// Solves the inverse kinematics at several poses at once, with `C_i` at `position + arm`.
    fn lanes<V: Real>(&self, position: Planar<V>, arm: Planar<V>) -> LegLanes<V>;

    /// Returns the axes of the leg's members at several poses at once, with the end of the leg at `c`.
    fn members<V: Real>(&self, c: Planar<V>, distal: &DistalLanes<V>) -> Members<V>;

    /// Returns the constants of the leg.
    fn sizes(&self) -> &LegSizes;

    /// Returns the place of the leg in the manipulator.
    #[inline(always)]
    fn frame(&self) -> &LegFrame {
        &self.sizes().frame
    }

    /// Returns the lower and upper corner of an axis-aligned box that contains every point that the end of the leg can
    /// reach \[m\].
    fn reach_box(&self) -> [DVec2; 2] {
        self.sizes().reach_box()
    }

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
            platform_joints: [0, 1, 2].map(|i| settings.geometry.platform_joint(i, design.platform_radius())),
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
