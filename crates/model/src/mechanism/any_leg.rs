//! A leg of any architecture: the leg behind it is known at run time alone.

use glam::DVec2;

use super::chain::{Assembly, DistalLanes, LockedLeg};
use super::{AnyLeg, Design, Leg, LegBody, LegLanes, LegPosture, LegSettings, LegSizes, Members, Shortfall, Travel};
use crate::lanes::{LaneJob, Planar, Real};

/// Inverse kinematics of a leg at several poses at once, as a function of its own.
struct LegJob<'a, L, V> {
    leg: &'a L,
    position: Planar<V>,
    arm: Planar<V>,
}

impl<L: Leg, V: Real> LaneJob for LegJob<'_, L, V> {
    type Output = LegLanes<V>;

    #[inline(always)]
    fn run(self) -> LegLanes<V> {
        self.leg.lanes(self.position, self.arm)
    }
}

/// Members of a leg at several poses at once, as a function of its own.
struct MembersJob<'a, L, V> {
    leg: &'a L,
    c: Planar<V>,
    distal: DistalLanes<V>,
}

impl<L: Leg, V: Real> LaneJob for MembersJob<'_, L, V> {
    type Output = Members<V>;

    #[inline(always)]
    fn run(self) -> Members<V> {
        self.leg.members(self.c, &self.distal)
    }
}

impl Leg for AnyLeg {
    const MAY_BE_ON_RAILS: bool = true;

    fn new(design: &Design, settings: &LegSettings, index: usize) -> Self {
        Self::of(design, settings, index)
    }

    fn inverse(&self, c: DVec2, arm: DVec2) -> Result<LegPosture, Shortfall> {
        visit!(self, leg => leg.inverse(c, arm))
    }

    #[inline(always)]
    fn lanes<V: Real>(&self, position: Planar<V>, arm: Planar<V>) -> LegLanes<V> {
        visit!(self, leg => position.x.call_apart(LegJob { leg, position, arm }))
    }

    #[inline(always)]
    fn members<V: Real>(&self, c: Planar<V>, distal: &DistalLanes<V>) -> Members<V> {
        visit!(self, leg => c.x.call_apart(MembersJob { leg, c, distal: *distal }))
    }

    fn sizes(&self) -> &LegSizes {
        visit!(self, leg => leg.sizes())
    }

    fn assembly(&self) -> Assembly {
        visit!(self, leg => leg.assembly())
    }
}

impl AnyLeg {
    /// Solves the inverse kinematics like [`Leg::inverse`], also beyond the limits of joints; tells which limit is violated, if one
    /// is.
    ///
    /// # Errors
    /// Returns the [`Shortfall`] if the working mode has no real solution, or if a direction of the leg is undefined.
    pub fn solve(&self, c: DVec2, arm: DVec2) -> Result<(LegPosture, Option<Shortfall>), Shortfall> {
        visit!(self, leg => leg.solve(c, arm))
    }

    /// Returns what the leg requires of the platform while its actuated joint is locked at a value \[m or rad\].
    pub fn locked(&self, value: f64) -> LockedLeg {
        visit!(self, leg => leg.locked(value))
    }

    /// Returns the values of the three joints from base to platform \[m or rad\], angles in (−π, π].
    pub fn joint_values(&self, posture: &LegPosture) -> [f64; 3] {
        self.sizes().joint_values(&posture.chain, posture.arm)
    }

    /// Returns the smallest and largest values of the joints that have limits \[m\].
    pub fn joint_limits(&self) -> [Option<[f64; 2]>; 3] {
        self.sizes().joint_limits()
    }

    /// Returns the rigid bodies of the leg, from the base to the platform.
    pub fn bodies(&self, posture: &LegPosture) -> Vec<LegBody> {
        visit!(self, leg => leg.bodies(&posture.chain, self.joint_values(posture)))
    }

    /// Returns the travels of the prismatic joints that the scene shows.
    pub fn travels(&self, posture: &LegPosture) -> Vec<Travel> {
        self.sizes().shown_travels(&posture.chain)
    }
}
