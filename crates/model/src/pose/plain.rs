//! The scalars of one pose by the closed form as it is defined. Evaluations use the lanes, which are compared with it.

use glam::DVec2;

use super::PoseChecker;
use super::scalars::PoseScalar;
use super::values::{EXAMINED_ALWAYS, PoseScalars, PoseValues, ScalarSet};
use crate::kinematics::Jacobian;
use crate::lanes::Planar;
use crate::mechanism::{Leg, Posture};
use crate::spatial::LEGS;
use crate::stiffness::{StiffnessDefinition, StiffnessModel};

impl<L: Leg> PoseChecker<L> {
    /// Returns the scalars of a set, and those that every evaluation determines but for the clearance, at a posture with `P` at
    /// `position`. What is computed on demand has no other form than that of the lanes.
    pub fn values_at(&self, position: DVec2, posture: &Posture, jacobian: &Jacobian, set: ScalarSet) -> PoseValues {
        let (k_xy, k_phi_z) = self.in_plane_stiffness(posture, jacobian);
        let mut scalars = PoseScalars::splat(f64::NAN);
        scalars[PoseScalar::Reach] = posture.limit_margin;
        scalars[PoseScalar::Determinant] = jacobian.determinant() / self.length;
        scalars[PoseScalar::Dexterity] = jacobian.inverse_condition(self.length);
        scalars[PoseScalar::StiffnessXy] = k_xy;
        scalars[PoseScalar::StiffnessZ] = self.vertical_stiffness(posture, jacobian);
        scalars[PoseScalar::StiffnessPhiZ] = k_phi_z;
        if set.contains(PoseScalar::Clearance) {
            scalars[PoseScalar::Clearance] = self.nearest(position, posture).distance;
        }
        self.fill_on_demand(set, position.into(), &posture.arms.map(Planar::from), &mut scalars);
        PoseValues::new(|scalar| scalars[scalar], set)
    }

    /// Returns the sign of `det A` with `P` at `position`, if the pose is feasible in every other respect.
    pub fn feasible_sign(&self, position: DVec2, arms: &[DVec2; LEGS]) -> Option<f64> {
        let limit = |scalar: PoseScalar| self.thresholds.bound(scalar);
        let posture = self.manipulator.posture_at(position, arms).ok()?;
        let jacobian = Jacobian::new(&posture);
        let determinant = jacobian.determinant();
        if determinant == 0.0 || jacobian.inverse_condition(self.length) < limit(PoseScalar::Dexterity) {
            return None;
        }
        let (k_xy, k_phi_z) = self.in_plane_stiffness(&posture, &jacobian);
        if !(k_xy >= limit(PoseScalar::StiffnessXy) && k_phi_z >= limit(PoseScalar::StiffnessPhiZ)) {
            return None;
        }
        let is_stiff_along_z = self.vertical_stiffness(&posture, &jacobian) >= limit(PoseScalar::StiffnessZ);
        if !is_stiff_along_z {
            return None;
        }
        // What only some studies limit.
        let is_left = |scalar: PoseScalar| scalar == PoseScalar::Clearance || !EXAMINED_ALWAYS.contains(&scalar);
        let is_met = !self.thresholds.iter().any(|(scalar, _)| is_left(scalar)) || {
            let values = self.values_at(position, &posture, &jacobian, self.computed);
            self.thresholds.are_met_by(&values)
        };
        is_met.then(|| determinant.signum())
    }

    /// Returns `k_xy` and `k_φz`; zero for an infinitely compliant design.
    fn in_plane_stiffness(&self, posture: &Posture, jacobian: &Jacobian) -> (f64, f64) {
        let block = self.stiffness.as_ref().map(|model| model.in_plane(posture, jacobian));
        block.map_or((0.0, 0.0), |block| {
            StiffnessModel::in_plane_stiffness_values(&block, self.definition)
        })
    }

    /// Returns `k_z`, computing no more of the out-of-plane block than its definition needs.
    fn vertical_stiffness(&self, posture: &Posture, jacobian: &Jacobian) -> f64 {
        match (&self.stiffness, self.definition) {
            (None, _) => 0.0,
            (Some(model), StiffnessDefinition::Stiffness) => model.vertical(posture),
            (Some(_), definition) => self.stiffness_at(posture, jacobian).stiffness_values(definition).k_z,
        }
    }
}
