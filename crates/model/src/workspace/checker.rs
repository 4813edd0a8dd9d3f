//! Is this pose good? Reach, joint limits, sign of `det A`, dexterity, stiffness and clearance (g2 … g7).

use glam::DVec2;

use crate::clearance::{Bodies, Clearance, FARTHEST};
use crate::kinematics::Jacobian;
use crate::lanes::{InstructionSet, Planar, Real};
use crate::mechanism::{Leg, Manipulator, Posture};
use crate::spatial::LEGS;
use crate::stiffness::{PlanarStiffness, Rigidity, StiffnessDefinition, StiffnessModel};

/// Least values that a good pose must have (g3 … g7).
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
    /// Clearance ≥ this \[m\] (g7); `None` where bodies may collide.
    pub clearance: Option<f64>,
}

impl Thresholds {
    /// Whether a reachable pose has them all.
    pub fn hold(&self, values: &PoseValues) -> bool {
        values.inverse_condition >= self.inverse_condition
            && values.rigidity.k_xy >= self.k_xy
            && values.rigidity.k_phi_z >= self.k_phi_z
            && values.rigidity.k_z >= self.k_z
            && self
                .clearance
                .is_none_or(|least| values.clearance.is_some_and(|clearance| clearance >= least))
    }
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
    /// Least clearance of bodies that are not joined \[m\]; `None` where nobody asks for it.
    pub clearance: Option<f64>,
}

impl PoseValues {
    /// The same, with 0 for what has left the number range: nothing that is no number leaves the model.
    pub(super) fn finite(mut self) -> Self {
        for value in [
            &mut self.slack,
            &mut self.determinant,
            &mut self.inverse_condition,
            &mut self.rigidity.k_xy,
            &mut self.rigidity.k_z,
            &mut self.rigidity.k_phi_z,
        ] {
            if !value.is_finite() {
                *value = 0.0;
            }
        }
        self.clearance = self.clearance.map(|clearance| clearance.clamp(-FARTHEST, FARTHEST));
        self
    }
}

/// [`PoseValues`] at several poses at once.
#[derive(Clone, Copy)]
pub struct PoseLanes<V: Real> {
    /// Where every leg reaches; elsewhere nothing but `slack` has a meaning.
    pub reachable: V::Mask,
    /// Least distance to a joint limit or to the end of reach \[m\]; not above 0 where a leg does not reach.
    pub slack: V,
    /// `det A / ℓ`.
    pub determinant: V,
    /// `κ_F⁻¹`.
    pub inverse_condition: V,
    /// `k_xy` \[N/m\].
    pub k_xy: V,
    /// `k_z` \[N/m\].
    pub k_z: V,
    /// `k_φz` \[N·m/rad\].
    pub k_phi_z: V,
    /// Least clearance of bodies that are not joined \[m\]; `None` where nobody asks for it.
    pub clearance: Option<V>,
}

impl PoseLanes<f64> {
    /// The values of a single pose, where it is reached.
    pub fn reached(&self) -> Option<PoseValues> {
        let values = PoseValues {
            slack: self.slack,
            determinant: self.determinant,
            inverse_condition: self.inverse_condition,
            rigidity: Rigidity {
                k_xy: self.k_xy,
                k_z: self.k_z,
                k_phi_z: self.k_phi_z,
            },
            clearance: self.clearance,
        };
        self.reachable.then(|| values.finite())
    }
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
    /// What may collide.
    pub bodies: Bodies,
    /// What a good pose must have.
    pub thresholds: Thresholds,
    /// What poses are taken several at a time with. Changes no bit of a result.
    pub instructions: InstructionSet,
}

impl<L: Leg> PoseChecker<L> {
    /// Sign of `det A` with `P` at `position`, if the pose is good in every other respect: a pose at a time in the plain
    /// closed form, which [`PoseChecker::lanes`], what decides in evaluations, is compared with.
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
        let clear = |least: f64| self.nearest(position, &posture).distance >= least;
        (k_z >= self.thresholds.k_z && self.thresholds.clearance.is_none_or(clear)).then(|| determinant.signum())
    }

    /// All values at several poses at once, `arms` as in [`Manipulator::arms`]; the clearance only where g7 asks for it.
    #[inline(always)]
    pub fn lanes<V: Real>(&self, position: Planar<V>, arms: &[Planar<V>; LEGS]) -> PoseLanes<V> {
        let (mut values, directions) = self.lanes_without_clearance(position, arms);
        if self.thresholds.clearance.is_some() {
            let limit = position.x.splat(f64::INFINITY);
            values.clearance = Some(self.clearance_below(position, arms, &directions, limit));
        }
        values
    }

    /// The least clearance at several poses at once where it is below `limit`, else `limit`, with the legs' directions as
    /// [`PoseChecker::lanes_without_clearance`] gives them. Of no meaning where a leg does not reach.
    #[inline(always)]
    pub(super) fn clearance_below<V: Real>(
        &self,
        position: Planar<V>,
        arms: &[Planar<V>; LEGS],
        directions: &[Planar<V>; LEGS],
        limit: V,
    ) -> V {
        self.bodies
            .below(&self.manipulator.legs, position, arms, directions, limit)
    }

    /// All values but the clearance at several poses at once, and the legs' `u_i`.
    #[inline(always)]
    pub(super) fn lanes_without_clearance<V: Real>(
        &self,
        position: Planar<V>,
        arms: &[Planar<V>; LEGS],
    ) -> (PoseLanes<V>, [Planar<V>; LEGS]) {
        let like = position.x;
        let legs = &self.manipulator.legs;
        let legs = [
            legs[0].lanes(position, arms[0]),
            legs[1].lanes(position, arms[1]),
            legs[2].lanes(position, arms[2]),
        ];
        let jacobian = Jacobian {
            ux: [legs[0].u.x, legs[1].u.x, legs[2].u.x],
            uy: [legs[0].u.y, legs[1].u.y, legs[2].u.y],
            moment: [legs[0].moment, legs[1].moment, legs[2].moment],
            drive: [legs[0].drive, legs[1].drive, legs[2].drive],
        };
        let [k_xy, k_z, k_phi_z] = match &self.stiffness {
            Some(model) => model.rigidity_lanes(self.definition, &legs, arms, &jacobian),
            None => [like.splat(0.0); 3],
        };
        let values = PoseLanes {
            reachable: legs[0].reachable & legs[1].reachable & legs[2].reachable,
            slack: legs[0].slack.smaller(legs[1].slack.smaller(legs[2].slack)),
            determinant: jacobian.determinant() * like.splat(1.0 / self.length),
            inverse_condition: jacobian.inverse_condition(self.length),
            k_xy,
            k_z,
            k_phi_z,
            clearance: None,
        };
        (values, [legs[0].u, legs[1].u, legs[2].u])
    }

    /// Where the pose is good, with `det A` of the given sign (±1).
    #[inline(always)]
    pub(super) fn good_lanes<V: Real>(&self, position: Planar<V>, arms: &[Planar<V>; LEGS], sign: V) -> V::Mask {
        let (values, directions) = self.lanes_without_clearance(position, arms);
        let least = &self.thresholds;
        let good = values.reachable
            & (values.determinant * sign).exceeds(sign.splat(0.0))
            & values.inverse_condition.at_least(sign.splat(least.inverse_condition))
            & values.k_xy.at_least(sign.splat(least.k_xy))
            & values.k_phi_z.at_least(sign.splat(least.k_phi_z))
            & values.k_z.at_least(sign.splat(least.k_z));
        match least.clearance {
            // Where the pose has failed already, nothing is below the limit, and no pair is looked at for its sake.
            Some(least) if V::any(good) => {
                let least = sign.splat(least);
                let limit = least.where_set(good, sign.splat(f64::NEG_INFINITY));
                good & self.clearance_below(position, arms, &directions, limit).at_least(least)
            }
            _ => good,
        }
    }

    /// The nearest pair of bodies that are not joined, at a posture with `P` at `position`.
    pub fn nearest(&self, position: DVec2, posture: &Posture) -> Clearance {
        self.bodies.nearest(&self.manipulator, position, posture)
    }

    /// All values at a posture, the clearance left out.
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
            clearance: None,
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
