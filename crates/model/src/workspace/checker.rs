//! Feasibility of a pose: reach, joint limits, sign of `det A`, dexterity, stiffness and clearance (g2 … g7).

use glam::DVec2;

use super::further::{FurtherLanes, FurtherLimits, FurtherValues};
use crate::clearance::{Bodies, Clearance, NUMBER_LIMIT};
use crate::kinematics::Jacobian;
use crate::lanes::{InstructionSet, LaneJob, Planar, Real};
use crate::mechanism::{Assembly, DistalLanes, JointKind, Leg, LegLanes, Manipulator, Posture};
use crate::spatial::LEGS;
use crate::stiffness::{NoSliders, PlanarStiffness, StiffnessDefinition, StiffnessModel, StiffnessValues};

/// Smallest values allowed at a feasible pose (g3 … g7).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thresholds {
    /// Smallest `κ_F⁻¹` allowed (g3).
    pub inverse_condition: f64,
    /// Smallest `k_xy` allowed \[N/m\] (g4).
    pub k_xy: f64,
    /// Smallest `k_z` allowed \[N/m\] (g5).
    pub k_z: f64,
    /// Smallest `k_φz` allowed \[N·m/rad\] (g6).
    pub k_phi_z: f64,
    /// Smallest clearance allowed \[m\] (g7); `None` if members may collide.
    pub clearance: Option<f64>,
    /// Limits of further values, if the study states any.
    pub further: Option<FurtherLimits>,
}

impl Thresholds {
    /// Returns whether the values of a reachable pose satisfy all thresholds.
    pub fn are_met_by(&self, values: &PoseValues) -> bool {
        values.inverse_condition >= self.inverse_condition
            && values.stiffness_values.k_xy >= self.k_xy
            && values.stiffness_values.k_phi_z >= self.k_phi_z
            && values.stiffness_values.k_z >= self.k_z
            && self
                .clearance
                .is_none_or(|least| values.clearance.is_some_and(|clearance| clearance >= least))
            && self.further.as_ref().is_none_or(|limits| {
                let of_values = |further| limits.are_met_by(values.limit_margin, further);
                values.further.as_ref().is_some_and(of_values)
            })
    }
}

/// Values that the constraints use, at one reachable pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseValues {
    /// Limit margin: smallest distance to a joint limit or to the end of reach \[m\].
    pub limit_margin: f64,
    /// `det A / ℓ`: signed, dimensionless.
    pub determinant: f64,
    /// `κ_F⁻¹`.
    pub inverse_condition: f64,
    /// `k_xy`, `k_z`, `k_φz`.
    pub stiffness_values: StiffnessValues,
    /// Smallest clearance between members that are not joined \[m\]; `None` if it is not required.
    pub clearance: Option<f64>,
    /// Further values; `None` if no limit of them is required.
    pub further: Option<FurtherValues>,
}

impl PoseValues {
    /// Returns the values with 0 in place of infinities and NaN, and with a bounded clearance, so that the model
    /// returns only finite numbers.
    pub(super) fn finite(mut self) -> Self {
        for value in [
            &mut self.limit_margin,
            &mut self.determinant,
            &mut self.inverse_condition,
            &mut self.stiffness_values.k_xy,
            &mut self.stiffness_values.k_z,
            &mut self.stiffness_values.k_phi_z,
        ] {
            if !value.is_finite() {
                *value = 0.0;
            }
        }
        self.clearance = self
            .clearance
            .map(|clearance| clearance.clamp(-NUMBER_LIMIT, NUMBER_LIMIT));
        self.further = self.further.map(|further| {
            let finite = |value: f64, instead: f64| if value.is_finite() { value } else { instead };
            FurtherValues {
                transmission: finite(further.transmission, 0.0),
                displacement: finite(further.displacement, NUMBER_LIMIT).min(NUMBER_LIMIT),
            }
        });
        self
    }
}

/// [`PoseValues`] at several poses at once.
#[derive(Clone, Copy)]
pub struct PoseLanes<V: Real> {
    /// Mask of the poses that every leg reaches; elsewhere only `limit_margin` is meaningful.
    pub reachable: V::Mask,
    /// Limit margin: smallest distance to a joint limit or to the end of reach \[m\]; at most 0 where a leg does not
    /// reach the pose.
    pub limit_margin: V,
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
    /// Smallest clearance between members that are not joined \[m\]; `None` if it is not required.
    pub clearance: Option<V>,
    /// Further values; `None` if no limit of them is required.
    pub further: Option<FurtherLanes<V>>,
}

impl PoseLanes<f64> {
    /// Returns the values of a single pose, if it is reachable.
    pub fn reached(&self) -> Option<PoseValues> {
        let values = PoseValues {
            limit_margin: self.limit_margin,
            determinant: self.determinant,
            inverse_condition: self.inverse_condition,
            stiffness_values: StiffnessValues {
                k_xy: self.k_xy,
                k_z: self.k_z,
                k_phi_z: self.k_phi_z,
            },
            clearance: self.clearance,
            further: self.further.map(|further| FurtherValues {
                transmission: further.transmission,
                displacement: further.displacement,
            }),
        };
        self.reachable.then(|| values.finite())
    }
}

/// One design, prepared for evaluation at many poses.
#[derive(Debug, Clone, Copy)]
pub struct PoseChecker<L> {
    /// Legs and platform.
    pub manipulator: Manipulator<L>,
    /// Stiffness model of the bars and actuators; `None` if the design is infinitely compliant.
    pub stiffness: Option<StiffnessModel>,
    /// Definition of the three stiffness values.
    pub definition: StiffnessDefinition,
    /// Characteristic length `ℓ` \[m\].
    pub length: f64,
    /// Members that may collide.
    pub bodies: Bodies,
    /// `R` \[m\].
    pub base_radius: f64,
    /// Longest lever that the driven joints may have if they are revolute \[m\].
    pub longest_lever: f64,
    /// Kind of the driven joints.
    pub actuator: JointKind,
    /// What g1 compares.
    pub assembly: Assembly,
    /// In-plane force under which the displacement is computed \[N\].
    pub in_plane_force: f64,
    /// Smallest values allowed at a feasible pose.
    pub thresholds: Thresholds,
    /// Instruction set by which several poses are evaluated at a time. It changes no bit of a result.
    pub instructions: InstructionSet,
}

/// The stiffness on rails that bend, as a job of its own: few studies have them, and the loop over the poses stays short.
struct StiffnessOnRails<'a, L, V> {
    checker: &'a PoseChecker<L>,
    position: Planar<V>,
    arms: [Planar<V>; LEGS],
}

impl<L: Leg, V: Real> LaneJob for StiffnessOnRails<'_, L, V> {
    type Output = [V; 3];

    #[inline(always)]
    fn run(self) -> [V; 3] {
        let legs = self.checker.leg_lanes(self.position, &self.arms);
        let jacobian = Jacobian::of_lanes(&legs);
        let sliders = self.checker.slider_lanes(self.position, &self.arms, &legs);
        match &self.checker.stiffness {
            Some(model) => model.stiffness_value_lanes(self.checker.definition, &legs, &self.arms, &sliders, &jacobian),
            None => [self.position.x.splat(0.0); 3],
        }
    }
}

/// The values except the clearance, as a job of its own, for loops in which its speed matters less than their size.
struct WithoutClearance<'a, L, V> {
    checker: &'a PoseChecker<L>,
    position: Planar<V>,
    arms: &'a [Planar<V>; LEGS],
}

impl<L: Leg, V: Real> LaneJob for WithoutClearance<'_, L, V> {
    type Output = (PoseLanes<V>, [DistalLanes<V>; LEGS]);

    #[inline(always)]
    fn run(self) -> Self::Output {
        self.checker.lanes_without_clearance(self.position, self.arms)
    }
}

/// The clearance at several poses, as a job of its own.
struct ClearanceUpTo<'a, L, V: Real> {
    checker: &'a PoseChecker<L>,
    position: Planar<V>,
    arms: &'a [Planar<V>; LEGS],
    distals: &'a [DistalLanes<V>; LEGS],
    limit: V,
}

impl<L: Leg, V: Real> LaneJob for ClearanceUpTo<'_, L, V> {
    type Output = V;

    #[inline(always)]
    fn run(self) -> V {
        self.checker
            .compute_clearance_up_to(self.position, self.arms, self.distals, self.limit)
    }
}

impl<L: Leg> PoseChecker<L> {
    /// Returns the sign of `det A` with `P` at `position`, if the pose is feasible in every other respect.
    ///
    /// It evaluates one pose at a time by the plain closed form. Evaluations use [`PoseChecker::lanes`] instead, which
    /// is compared with this function.
    #[inline]
    pub fn feasible_sign(&self, position: DVec2, arms: &[DVec2; LEGS]) -> Option<f64> {
        let posture = self.manipulator.posture_at(position, arms).ok()?;
        let jacobian = Jacobian::new(&posture);
        let determinant = jacobian.determinant();
        if determinant == 0.0 || jacobian.inverse_condition(self.length) < self.thresholds.inverse_condition {
            return None;
        }
        let (k_xy, k_phi_z) = self.in_plane_stiffness_values(&self.in_plane(&posture, &jacobian));
        if !(k_xy >= self.thresholds.k_xy && k_phi_z >= self.thresholds.k_phi_z) {
            return None;
        }
        let k_z = self.vertical_stiffness(&posture, &jacobian);
        let clear = |least: f64| self.nearest(position, &posture).distance >= least;
        let further = self.thresholds.further.as_ref();
        let within = |limits: &FurtherLimits| limits.are_met_by(posture.limit_margin, &self.further_at(position, arms));
        (k_z >= self.thresholds.k_z && self.thresholds.clearance.is_none_or(clear) && further.is_none_or(within))
            .then(|| determinant.signum())
    }

    /// Returns all values at several poses at once, with `arms` as in [`Manipulator::arms`]. The clearance is computed
    /// only if g7 is required.
    #[inline(always)]
    pub fn lanes<V: Real>(&self, position: Planar<V>, arms: &[Planar<V>; LEGS]) -> PoseLanes<V> {
        let (mut values, distals) = self.lanes_without_clearance(position, arms);
        if self.thresholds.clearance.is_some() {
            let limit = position.x.splat(f64::INFINITY);
            values.clearance = Some(self.compute_clearance_apart(position, arms, &distals, limit));
        }
        if self.thresholds.further.is_some() {
            values.further = Some(self.further_lanes(position, arms));
        }
        values
    }

    /// Returns the smallest clearance at several poses at once where it is below `limit`, otherwise `limit` \[m\].
    /// `distals` are the distal bars of the legs as [`PoseChecker::lanes_without_clearance`] returns them. The result
    /// is meaningless where a leg does not reach the pose.
    #[inline(always)]
    pub(super) fn compute_clearance_up_to<V: Real>(
        &self,
        position: Planar<V>,
        arms: &[Planar<V>; LEGS],
        distals: &[DistalLanes<V>; LEGS],
        limit: V,
    ) -> V {
        self.bodies
            .compute_clearance_up_to(&self.manipulator.legs, position, arms, distals, limit)
    }

    /// Does the same as [`PoseChecker::compute_clearance_up_to`] in a function of its own.
    #[inline(always)]
    pub(super) fn compute_clearance_apart<V: Real>(
        &self,
        position: Planar<V>,
        arms: &[Planar<V>; LEGS],
        distals: &[DistalLanes<V>; LEGS],
        limit: V,
    ) -> V {
        let checker = self;
        limit.call_apart(ClearanceUpTo {
            checker,
            position,
            arms,
            distals,
            limit,
        })
    }

    /// Returns the distances of the sliders from both ends of their rails \[m\], for chains on rails.
    #[inline(always)]
    pub(super) fn slider_lanes<V: Real>(
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

    /// Returns all values except the clearance at several poses at once, and the distal bars of the legs.
    #[inline(always)]
    pub(super) fn lanes_without_clearance<V: Real>(
        &self,
        position: Planar<V>,
        arms: &[Planar<V>; LEGS],
    ) -> (PoseLanes<V>, [DistalLanes<V>; LEGS]) {
        let like = position.x;
        let legs = self.leg_lanes(position, arms);
        let jacobian = Jacobian::of_lanes(&legs);
        let [k_xy, k_z, k_phi_z] = match &self.stiffness {
            Some(model) if L::MAY_BE_ON_RAILS && model.is_on_bending_rails() => {
                let arms = *arms;
                let checker = self;
                like.call_apart(StiffnessOnRails {
                    checker,
                    position,
                    arms,
                })
            }
            Some(model) => model.stiffness_value_lanes(self.definition, &legs, arms, &NoSliders, &jacobian),
            None => [like.splat(0.0); 3],
        };
        let [first, second, third] = [&legs[0].chain, &legs[1].chain, &legs[2].chain];
        let values = PoseLanes {
            reachable: first.reachable & second.reachable & third.reachable,
            limit_margin: first
                .limit_margin
                .smaller(second.limit_margin.smaller(third.limit_margin)),
            determinant: jacobian.determinant() * like.splat(1.0 / self.length),
            inverse_condition: jacobian.inverse_condition(self.length),
            k_xy,
            k_z,
            k_phi_z,
            clearance: None,
            further: None,
        };
        (values, [legs[0].distal(), legs[1].distal(), legs[2].distal()])
    }

    /// Does the same as [`PoseChecker::lanes_without_clearance`] in a function of its own.
    #[inline(always)]
    pub(super) fn lanes_without_clearance_apart<V: Real>(
        &self,
        position: Planar<V>,
        arms: &[Planar<V>; LEGS],
    ) -> (PoseLanes<V>, [DistalLanes<V>; LEGS]) {
        let checker = self;
        position.x.call_apart(WithoutClearance {
            checker,
            position,
            arms,
        })
    }

    /// Returns the mask of the feasible poses, at which `det A` has the given sign (±1). The limits of further values are examined
    /// only if `FURTHER` says so, because a loop that could examine them is slower; with them, the parts are functions of their own.
    #[inline(always)]
    pub(super) fn feasible_lanes<V: Real, const FURTHER: bool>(
        &self,
        position: Planar<V>,
        arms: &[Planar<V>; LEGS],
        sign: V,
    ) -> V::Mask {
        let (values, distals) = if FURTHER {
            self.lanes_without_clearance_apart(position, arms)
        } else {
            self.lanes_without_clearance(position, arms)
        };
        let least = &self.thresholds;
        let good = values.reachable
            & (values.determinant * sign).exceeds(sign.splat(0.0))
            & values.inverse_condition.at_least(sign.splat(least.inverse_condition))
            & values.k_xy.at_least(sign.splat(least.k_xy))
            & values.k_phi_z.at_least(sign.splat(least.k_phi_z))
            & values.k_z.at_least(sign.splat(least.k_z));
        let good = match &least.further {
            Some(limits) if FURTHER && V::any(good) => {
                good & self.within_further_lanes(limits, &values, position, arms)
            }
            _ => good,
        };
        match least.clearance {
            // Where the pose is already infeasible the limit is −∞, so that no clearance is below it and no pair is
            // examined.
            Some(least) if V::any(good) => {
                let least = sign.splat(least);
                let limit = least.select(good, sign.splat(f64::NEG_INFINITY));
                let clearance = if FURTHER {
                    self.compute_clearance_apart(position, arms, &distals, limit)
                } else {
                    self.compute_clearance_up_to(position, arms, &distals, limit)
                };
                good & clearance.at_least(least)
            }
            _ => good,
        }
    }

    /// Returns the nearest pair of members that are not joined, at a posture with `P` at `position`.
    pub fn nearest(&self, position: DVec2, posture: &Posture) -> Clearance {
        self.bodies.nearest(&self.manipulator, position, posture)
    }

    /// Returns all values at a posture except the clearance.
    pub fn values_at(&self, posture: &Posture, jacobian: &Jacobian) -> PoseValues {
        let (k_xy, k_phi_z) = self.in_plane_stiffness_values(&self.in_plane(posture, jacobian));
        PoseValues {
            limit_margin: posture.limit_margin,
            determinant: jacobian.determinant() / self.length,
            inverse_condition: jacobian.inverse_condition(self.length),
            stiffness_values: StiffnessValues {
                k_xy,
                k_z: self.vertical_stiffness(posture, jacobian),
                k_phi_z,
            },
            clearance: None,
            further: None,
        }
    }

    /// Returns the mask of the poses that satisfy the limits of further values.
    #[inline(always)]
    fn within_further_lanes<V: Real>(
        &self,
        limits: &FurtherLimits,
        values: &PoseLanes<V>,
        position: Planar<V>,
        arms: &[Planar<V>; LEGS],
    ) -> V::Mask {
        let like = position.x;
        let found = self.further_lanes(position, arms);
        let least = |limit: Option<f64>| like.splat(limit.unwrap_or(f64::NEG_INFINITY));
        values.limit_margin.at_least(least(limits.limit_margin))
            & found.transmission.at_least(least(limits.transmission))
            & like
                .splat(limits.displacement.unwrap_or(f64::INFINITY))
                .at_least(found.displacement)
    }

    /// Returns the in-plane block of `K`, as [`PlanarStiffness::in_plane`] stores it; zero for an infinitely compliant
    /// design.
    #[inline]
    pub fn in_plane(&self, posture: &Posture, jacobian: &Jacobian) -> [f64; 6] {
        match &self.stiffness {
            Some(model) => model.in_plane(posture, jacobian),
            None => [0.0; 6],
        }
    }

    /// Returns `k_xy` and `k_φz` of an in-plane block.
    #[inline]
    pub fn in_plane_stiffness_values(&self, in_plane: &[f64; 6]) -> (f64, f64) {
        StiffnessModel::in_plane_stiffness_values(in_plane, self.definition)
    }

    /// Returns `k_z`, computing no more of the out-of-plane block than its definition needs.
    #[inline]
    pub fn vertical_stiffness(&self, posture: &Posture, jacobian: &Jacobian) -> f64 {
        match (&self.stiffness, self.definition) {
            (None, _) => 0.0,
            (Some(model), StiffnessDefinition::Stiffness) => model.vertical(posture),
            (Some(model), definition) => {
                let stiffness = model.stiffness(posture, jacobian);
                stiffness.stiffness_values(definition).k_z
            }
        }
    }

    /// Returns both stiffness blocks at a posture; they are zero for an infinitely compliant design.
    pub fn stiffness_at(&self, posture: &Posture, jacobian: &Jacobian) -> PlanarStiffness {
        self.stiffness
            .as_ref()
            .map_or(PlanarStiffness::ZERO, |model| model.stiffness(posture, jacobian))
    }
}
