//! A design, prepared for many poses: with its stiffness, its members, and what else its study computes.

use super::{Model, ModelSettings, PoseScalar};
use crate::clearance::{Bodies, BodyBasis, Stack};
use crate::dynamics::{DynamicsBasis, DynamicsModel, DynamicsSettings};
use crate::lanes::{InstructionSet, Planar, Real};
use crate::mechanism::{AnyLeg, Assembly, Design, Geometry, JointMasses, Leg, Manipulator};
use crate::pose::{PoseChecker, ScalarSet, computed};
use crate::spatial::LEGS;
use crate::stiffness::StiffnessModel;
use crate::strength::StrengthModel;
use crate::workspace::PoseEvaluator;

impl Model {
    /// Prepares the design for evaluation at many poses.
    pub(crate) fn checker<L: Leg>(&self, design: &Design) -> PoseChecker<L> {
        self.checker_in(design, &self.stack_of(design))
    }

    /// Prepares the design with its members in a stack.
    pub(super) fn checker_in<L: Leg>(&self, design: &Design, stack: &Stack) -> PoseChecker<L> {
        self.checker_with(design, self.bodies_in(design, stack))
    }

    fn checker_with<L: Leg>(&self, design: &Design, bodies: Bodies) -> PoseChecker<L> {
        let manipulator = Manipulator::new(design, &self.settings().legs);
        let stiffness = self.stiffness(design);
        let thresholds = self.thresholds_of(design);
        PoseChecker {
            manipulator,
            strength: self.strength_if_asked(design, stiffness.as_ref()),
            dynamics: self.dynamics_if_asked(design, stiffness.as_ref()),
            stiffness,
            definition: self.settings().stiffness_definition,
            length: self.length(design, &manipulator),
            bodies,
            base_radius: design.base_radius(),
            longest_lever: design.architecture().longest_lever(design),
            actuator: design.architecture().actuator(),
            assembly: worst_assembly(&manipulator.legs, &self.settings().legs.geometry),
            leaves_out_base: false,
            in_plane_force: self.settings().in_plane_force,
            thresholds,
            asked: ScalarSet::default(),
            computed: computed(&thresholds, ScalarSet::default()),
            examines_all: thresholds.need_all_scalars(),
            instructions: InstructionSet::best(),
        }
    }

    /// Prepares the design for evaluation at many poses, whatever its legs are.
    pub fn pose_evaluator(&self, design: &Design) -> Box<dyn PoseEvaluator> {
        self.pose_evaluator_of(design, ScalarSet::all())
    }

    /// Prepares the design for some scalars besides those that an evaluation computes, which takes less time than for all of them: for
    /// methods that prepare many designs. No other scalar has a meaning.
    pub fn pose_evaluator_of(&self, design: &Design, set: ScalarSet) -> Box<dyn PoseEvaluator> {
        with_leg!(design.architecture(), L => Box::new(self.checker_of::<L>(design, set)))
    }

    /// Prepares the design for some scalars besides those that are limited.
    pub(super) fn checker_of<L: Leg>(&self, design: &Design, set: ScalarSet) -> PoseChecker<L> {
        let asks = |scalars: &[PoseScalar]| scalars.iter().any(|&scalar| set.contains(scalar));
        let is_limited = self.settings().thresholds.get(PoseScalar::Clearance).is_some();
        let bodies = match is_limited || set.contains(PoseScalar::Clearance) {
            true => self.bodies_of(design),
            false => Bodies::unpaired(design, &self.stack_of(design), &self.body_basis()),
        };
        let mut checker = self.checker_with(design, bodies);
        let stiffness = checker.stiffness.as_ref();
        if checker.strength.is_none() && asks(PoseScalar::OF_LOADS) {
            checker.strength = stiffness.map(|stiffness| self.strength(design, stiffness));
        }
        if checker.dynamics.is_none() && asks(PoseScalar::OF_MOTION) {
            checker.dynamics = stiffness.map(|stiffness| self.dynamics(design, stiffness));
        }
        checker
    }

    /// Returns `k_xy` at a position in the orientation of `arms`, by the formulas of every scalar but the clearance, on any type of
    /// number: on one that counts operations, they are the operations of a pose.
    #[doc(hidden)]
    pub fn run_formulas<V: Real>(&self, design: &Design, position: Planar<V>, arms: [Planar<V>; LEGS]) -> V {
        with_leg!(design.architecture(), L => {
            let (found, _) = self.checker::<L>(design).core_lanes(position, &arms);
            found.scalars[PoseScalar::StiffnessXy]
        })
    }

    /// Returns the stiffness model of a design; `None` if a bar is infinitely compliant.
    pub fn stiffness(&self, design: &Design) -> Option<StiffnessModel> {
        StiffnessModel::new(
            design,
            &self.settings().legs.geometry,
            &self.settings().material,
            &self.settings().sections,
            &self.settings().actuators,
            self.rails_of(design),
        )
    }

    /// Returns the strength of a design whose stiffness is known, if an evaluation computes anything of it.
    pub(super) fn strength_if_asked(
        &self,
        design: &Design,
        stiffness: Option<&StiffnessModel>,
    ) -> Option<StrengthModel> {
        stiffness
            .filter(|_| self.computes_any(PoseScalar::OF_LOADS))
            .map(|stiffness| self.strength(design, stiffness))
    }

    /// Returns the strength of a design, if an evaluation computes anything of it; `None` also if a bar is infinitely compliant.
    pub(crate) fn strength_of(&self, design: &Design) -> Option<StrengthModel> {
        self.strength_if_asked(design, self.stiffness(design).as_ref())
    }

    /// Returns the motion of a design whose stiffness is known, if an evaluation computes anything of it.
    pub(super) fn dynamics_if_asked(
        &self,
        design: &Design,
        stiffness: Option<&StiffnessModel>,
    ) -> Option<DynamicsModel> {
        stiffness
            .filter(|_| self.computes_any(PoseScalar::OF_MOTION))
            .map(|stiffness| self.dynamics(design, stiffness))
    }

    /// Returns the motion of a design, if the study limits anything of it; `None` also if a bar is infinitely compliant.
    pub(crate) fn dynamics_of(&self, design: &Design) -> Option<DynamicsModel> {
        self.dynamics_if_asked(design, self.stiffness(design).as_ref())
    }

    /// Returns the motion of a design; `None` if a bar is infinitely compliant.
    pub(crate) fn dynamics_in_motion(&self, design: &Design) -> Option<DynamicsModel> {
        let stiffness = self.stiffness(design)?;
        Some(self.dynamics(design, &stiffness))
    }

    fn dynamics(&self, design: &Design, stiffness: &StiffnessModel) -> DynamicsModel {
        self.dynamics_with(design, stiffness, &self.settings().dynamics, self.settings().joints)
    }

    /// Returns the motion of a design whose drives and motors are other ones than the study states.
    pub(super) fn dynamics_with(
        &self,
        design: &Design,
        stiffness: &StiffnessModel,
        settings: &DynamicsSettings,
        joints: JointMasses,
    ) -> DynamicsModel {
        let basis = DynamicsBasis {
            settings,
            legs: &self.settings().legs,
            material: &self.settings().material,
            sections: &self.settings().sections,
            joints,
            platform_bars: self.settings().platform_bars,
        };
        DynamicsModel::new(design, &basis, stiffness)
    }

    fn strength(&self, design: &Design, stiffness: &StiffnessModel) -> StrengthModel {
        let ModelSettings {
            legs,
            material,
            sections,
            loads,
            ..
        } = self.settings();
        StrengthModel::new(design, legs, material, sections, stiffness, loads)
    }

    /// Returns the members of a design, prepared for clearance computations.
    pub fn bodies_of(&self, design: &Design) -> Bodies {
        self.bodies_in(design, &self.stack_of(design))
    }

    /// Returns the members of a design in a stack.
    pub(super) fn bodies_in(&self, design: &Design, stack: &Stack) -> Bodies {
        Bodies::new(design, stack, &self.body_basis())
    }

    fn body_basis(&self) -> BodyBasis<'_> {
        BodyBasis {
            legs: &self.settings().legs,
            settings: &self.settings().bodies,
            joints: &self.settings().joint_sizes,
            sections: &self.settings().sections,
            barriers: self.barriers(),
        }
    }

    /// Returns what g1 compares, for the leg that is worst off.
    pub fn assembly(&self, design: &Design) -> Assembly {
        let legs = [0, 1, 2].map(|index| AnyLeg::new(design, &self.settings().legs, index));
        worst_assembly(&legs, &self.settings().legs.geometry)
    }
}

/// Returns what g1 compares, for the leg that is worst off.
fn worst_assembly<L: Leg>(legs: &[L; LEGS], geometry: &Geometry) -> Assembly {
    let first = legs[0].assembly();
    // A symmetric design has the same values for all legs, which rounding must not tell apart.
    if geometry.is_three_fold() {
        return first;
    }
    let excess = |assembly: &Assembly| assembly.value - assembly.threshold;
    legs[1..].iter().fold(first, |worst, leg| {
        let next = leg.assembly();
        if excess(&next) < excess(&worst) { next } else { worst }
    })
}
