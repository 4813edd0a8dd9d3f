//! Is this pose good? Reach, joint limits, sign of `det A`, dexterity and stiffness (g2 … g6).

use glam::DVec2;

use crate::kinematics::Jacobian;
use crate::mechanism::{Leg, Manipulator, Posture, Shortfall};
use crate::spatial::LEGS;
use crate::stiffness::{PlanarStiffness, Rigidity, StiffnessDefinition, StiffnessModel};

/// Least values that a good pose must have (g3 … g6).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thresholds {
    /// `κ_F⁻¹` ≥ this (g3).
    pub inverse_condition: f64,
    /// `k_xy` ≥ this \[N/m\] (g4).
    pub k_xy: f64,
    /// `k_z` ≥ this \[N/m\] (g5).
    pub k_z: f64,
    /// `k_φz` ≥ this \[N·m/rad\] (g6).
    pub k_phi_z: f64,
}

/// Everything the constraints look at, at one reachable pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseValues {
    /// Least distance to a joint limit or to the end of reach \[m\].
    pub slack: f64,
    /// `det A / ℓ`: signed, without unit.
    pub determinant: f64,
    /// `κ_F⁻¹`.
    pub inverse_condition: f64,
    /// `k_xy`, `k_z`, `k_φz`.
    pub rigidity: Rigidity,
}

/// One design, made ready for many poses.
#[derive(Debug, Clone, Copy)]
pub struct PoseChecker<L> {
    /// Legs and platform.
    pub manipulator: Manipulator<L>,
    /// Bars and actuators; `None` when the design is infinitely compliant.
    pub stiffness: Option<StiffnessModel>,
    /// Definition of the three stiffness values.
    pub definition: StiffnessDefinition,
    /// Characteristic length `ℓ` \[m\].
    pub length: f64,
    /// What a good pose must have.
    pub thresholds: Thresholds,
}

impl<L: Leg> PoseChecker<L> {
    /// Sign of `det A` with `P` at `position`, if the pose is good in every other respect.
    #[inline]
    pub fn good_sign(&self, position: DVec2, arms: &[DVec2; LEGS]) -> Option<f64> {
        let posture = self.manipulator.posture_at(position, arms).ok()?;
        let jacobian = Jacobian::new(&posture);
        let determinant = jacobian.determinant();
        if determinant == 0.0 || jacobian.inverse_condition(self.length) < self.thresholds.inverse_condition {
            return None;
        }
        let (k_xy, k_phi_z) = self.in_plane_rigidity(&self.in_plane(&posture, &jacobian));
        if !(k_xy >= self.thresholds.k_xy && k_phi_z >= self.thresholds.k_phi_z) {
            return None;
        }
        let k_z = self.vertical_rigidity(&posture, &jacobian);
        (k_z >= self.thresholds.k_z).then(|| determinant.signum())
    }

    /// Whether the pose is good, with `det A` of the given sign.
    #[inline]
    pub fn is_good(&self, position: DVec2, arms: &[DVec2; LEGS], sign: f64) -> bool {
        self.good_sign(position, arms) == Some(sign)
    }

    /// All values at a pose.
    ///
    /// # Errors
    /// The leg that cannot reach it, and by how much.
    pub fn values(&self, position: DVec2, arms: &[DVec2; LEGS]) -> Result<PoseValues, (usize, Shortfall)> {
        let posture = self.manipulator.posture_at(position, arms)?;
        Ok(self.values_at(&posture, &Jacobian::new(&posture)))
    }

    /// All values at a posture.
    pub fn values_at(&self, posture: &Posture, jacobian: &Jacobian) -> PoseValues {
        let (k_xy, k_phi_z) = self.in_plane_rigidity(&self.in_plane(posture, jacobian));
        PoseValues {
            slack: posture.slack,
            determinant: jacobian.determinant() / self.length,
            inverse_condition: jacobian.inverse_condition(self.length),
            rigidity: Rigidity {
                k_xy,
                k_z: self.vertical_rigidity(posture, jacobian),
                k_phi_z,
            },
        }
    }

    /// In-plane block of `K`, as [`PlanarStiffness::in_plane`]; zero for an infinitely compliant design.
    #[inline]
    pub fn in_plane(&self, posture: &Posture, jacobian: &Jacobian) -> [f64; 6] {
        match &self.stiffness {
            Some(model) => model.in_plane(&self.manipulator, posture, jacobian),
            None => [0.0; 6],
        }
    }

    /// `k_xy` and `k_φz` of an in-plane block.
    #[inline]
    pub fn in_plane_rigidity(&self, in_plane: &[f64; 6]) -> (f64, f64) {
        StiffnessModel::in_plane_rigidity(in_plane, self.definition)
    }

    /// `k_z`, with no more of the out-of-plane block than its definition needs.
    #[inline]
    pub fn vertical_rigidity(&self, posture: &Posture, jacobian: &Jacobian) -> f64 {
        match (&self.stiffness, self.definition) {
            (None, _) => 0.0,
            (Some(model), StiffnessDefinition::Stiffness) => model.vertical(&self.manipulator, posture),
            (Some(model), definition) => {
                let stiffness = model.stiffness(&self.manipulator, posture, jacobian);
                stiffness.rigidity(definition).k_z
            }
        }
    }

    /// Both stiffness blocks at a posture, zero for an infinitely compliant design.
    pub fn stiffness_at(&self, posture: &Posture, jacobian: &Jacobian) -> PlanarStiffness {
        self.stiffness.as_ref().map_or(PlanarStiffness::ZERO, |model| {
            model.stiffness(&self.manipulator, posture, jacobian)
        })
    }
}
