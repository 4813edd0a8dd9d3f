//! One design, prepared for evaluation at many poses.

use glam::DVec2;

use super::scalars::PoseScalar;
use super::values::{ScalarSet, Thresholds};
use crate::clearance::{Bodies, Clearance};
use crate::dynamics::DynamicsModel;
use crate::kinematics::Jacobian;
use crate::lanes::{InstructionSet, Planar, Real};
use crate::mechanism::{Assembly, JointKind, Leg, LegLanes, Manipulator, Posture};
use crate::spatial::LEGS;
use crate::stiffness::{PlanarStiffness, StiffnessDefinition, StiffnessModel};
use crate::strength::StrengthModel;

/// One design, prepared for evaluation at many poses.
#[derive(Debug, Clone)]
pub(crate) struct PoseChecker<L> {
    /// Legs and platform.
    pub manipulator: Manipulator<L>,
    /// Stiffness model of the bars and actuators; `None` if the design is infinitely compliant.
    pub stiffness: Option<StiffnessModel>,
    /// Strength of the members; `None` if the design is infinitely compliant, or if nothing that depends on loads is computed.
    pub strength: Option<StrengthModel>,
    /// Motion of the design; `None` if the design is infinitely compliant, or if nothing of it is computed.
    pub dynamics: Option<DynamicsModel>,
    /// Definition of the three stiffness values.
    pub definition: StiffnessDefinition,
    /// Characteristic length `ℓ` \[m\].
    pub length: f64,
    /// Members that may collide.
    pub bodies: Bodies,
    /// `R` \[m\].
    pub base_radius: f64,
    /// Longest lever that the actuated joints may have if they are revolute \[m\].
    pub longest_lever: f64,
    /// Kind of the actuated joints.
    pub actuator: JointKind,
    /// What g1 compares.
    pub assembly: Assembly,
    /// Whether the footprint is that of the members alone.
    pub leaves_out_base: bool,
    /// In-plane force under which the displacement is computed \[N\].
    pub in_plane_force: f64,
    /// What a feasible pose must keep; see [`PoseChecker::set_threshold`].
    pub thresholds: Thresholds,
    /// Scalars that are computed besides those that the thresholds need.
    pub asked: ScalarSet,
    /// Scalars that are computed where all values of a pose are.
    pub computed: ScalarSet,
    /// [`Thresholds::need_all_scalars`].
    pub examines_all: bool,
    /// Instruction set by which several poses are evaluated at a time. It changes no bit of a result.
    pub instructions: InstructionSet,
}

/// Returns the scalars that are computed where all values of a pose are.
pub(crate) fn computed(thresholds: &Thresholds, asked: ScalarSet) -> ScalarSet {
    let core = PoseScalar::ALWAYS
        .iter()
        .copied()
        .filter(|&scalar| scalar != PoseScalar::Clearance);
    let limited = thresholds.iter().map(|(scalar, _)| scalar);
    core.chain(limited).fold(asked, ScalarSet::with)
}

impl<L: Leg> PoseChecker<L> {
    /// Sets the limit of a scalar, or removes it.
    pub fn set_threshold(&mut self, scalar: PoseScalar, limit: Option<f64>) {
        self.thresholds.set(scalar, limit);
        self.follow_thresholds();
    }

    /// Determines what the limits require to be computed.
    fn follow_thresholds(&mut self) {
        self.computed = computed(&self.thresholds, self.asked);
        self.examines_all = self.thresholds.need_all_scalars();
    }

    /// Removes the limits of some scalars.
    pub fn drop_limits(&mut self, is_dropped: impl Fn(PoseScalar) -> bool) {
        for &scalar in PoseScalar::ALL {
            if is_dropped(scalar) {
                self.thresholds.set(scalar, None);
            }
        }
        self.follow_thresholds();
    }

    /// Computes a scalar besides those that every evaluation determines and those that are limited.
    pub fn ask_for(&mut self, scalar: PoseScalar) {
        self.asked = self.asked.with(scalar);
        self.computed = self.computed.with(scalar);
    }

    /// Returns the design without the limits that take long; `None` if there are none.
    pub fn without_slow_limits(&self) -> Option<Self> {
        if self.slow_limits().is_empty() {
            return None;
        }
        let mut checker = self.clone();
        checker.drop_limits(PoseScalar::takes_long);
        Some(checker)
    }

    /// Returns the limited scalars that take long.
    pub fn slow_limits(&self) -> ScalarSet {
        self.thresholds.that_take_long()
    }

    /// Solves the inverse kinematics of all legs at several poses at once.
    #[inline(always)]
    pub fn leg_lanes<V: Real>(&self, position: Planar<V>, arms: &[Planar<V>; LEGS]) -> [LegLanes<V>; LEGS] {
        let legs = &self.manipulator.legs;
        [
            legs[0].lanes(position, arms[0]),
            legs[1].lanes(position, arms[1]),
            legs[2].lanes(position, arms[2]),
        ]
    }

    /// Returns the distances of the sliders from both ends of their rails \[m\], for chains on rails.
    #[inline(always)]
    pub fn slider_lanes<V: Real>(
        &self,
        position: Planar<V>,
        arms: &[Planar<V>; LEGS],
        legs: &[LegLanes<V>; LEGS],
    ) -> [[V; 2]; LEGS] {
        [
            self.slider_lanes_of(position, arms, legs, 0),
            self.slider_lanes_of(position, arms, legs, 1),
            self.slider_lanes_of(position, arms, legs, 2),
        ]
    }

    #[inline(always)]
    fn slider_lanes_of<V: Real>(
        &self,
        position: Planar<V>,
        arms: &[Planar<V>; LEGS],
        legs: &[LegLanes<V>; LEGS],
        leg: usize,
    ) -> [V; 2] {
        let chain = &legs[leg].chain;
        let b = position.plus(arms[leg]).minus(chain.tangent.scaled(chain.offset));
        self.manipulator.legs[leg].frame().from_rail_ends(b)
    }

    /// Returns the nearest pair of members that are not joined, at a posture with `P` at `position`.
    pub fn nearest(&self, position: DVec2, posture: &Posture) -> Clearance {
        self.bodies.nearest(&self.manipulator, position, posture)
    }

    /// Returns both stiffness blocks at a posture; they are zero for an infinitely compliant design.
    pub fn stiffness_at(&self, posture: &Posture, jacobian: &Jacobian) -> PlanarStiffness {
        self.stiffness
            .as_ref()
            .map_or(PlanarStiffness::ZERO, |model| model.stiffness(posture, jacobian))
    }
}
