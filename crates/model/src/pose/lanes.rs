//! The scalars of several poses at once, and which of the poses are feasible.

use super::PoseChecker;
use super::entry::Better;
use super::scalars::PoseScalar;
use super::scalars::keep_limits_of_motion;
use super::values::{CoreLanes, CoreScalars, EXAMINED_ALWAYS, PoseLanes, PoseScalars, ScalarSet};
use crate::kinematics::Jacobian;
use crate::lanes::{LaneJob, Planar, Real};
use crate::mechanism::{DistalLanes, Leg};
use crate::spatial::LEGS;
use crate::stiffness::NoSliders;

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

/// The scalars that every evaluation determines, but for the clearance, as a job of its own, for loops in which its speed matters
/// less than their size.
struct Core<'a, L, V> {
    checker: &'a PoseChecker<L>,
    position: Planar<V>,
    arms: &'a [Planar<V>; LEGS],
}

impl<L: Leg, V: Real> LaneJob for Core<'_, L, V> {
    type Output = (CoreLanes<V>, [DistalLanes<V>; LEGS]);

    #[inline(always)]
    fn run(self) -> Self::Output {
        self.checker.core_lanes(self.position, self.arms)
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
    /// Returns the scalars of a set, and those that every evaluation determines but for the clearance, at several poses at once, with
    /// `arms` as in [`Manipulator::arms`](crate::mechanism::Manipulator::arms).
    #[inline(always)]
    pub fn lanes<V: Real>(&self, position: Planar<V>, arms: &[Planar<V>; LEGS], set: ScalarSet) -> PoseLanes<V> {
        let CoreLanes { reachable, scalars } = self.core_lanes_with_clearance(position, arms, set);
        let mut scalars = PoseScalars::of_core(&scalars);
        self.fill_on_demand(set, position, arms, &mut scalars);
        PoseLanes { reachable, scalars }
    }

    /// Returns the scalars that every evaluation determines, at several poses at once, with the clearance if a set contains it.
    #[inline(always)]
    pub fn core_lanes_with_clearance<V: Real>(
        &self,
        position: Planar<V>,
        arms: &[Planar<V>; LEGS],
        set: ScalarSet,
    ) -> CoreLanes<V> {
        let (mut values, distals) = self.core_lanes(position, arms);
        if set.contains(PoseScalar::Clearance) {
            let limit = position.x.splat(f64::INFINITY);
            values.scalars[PoseScalar::Clearance] = self.compute_clearance_apart(position, arms, &distals, limit);
        }
        values
    }

    /// Returns the smallest clearance at several poses at once where it is below `limit`, otherwise `limit` \[m\].
    /// `distals` are the distal bars of the legs as [`PoseChecker::core_lanes`] returns them. The result
    /// is meaningless where a leg does not reach the pose.
    #[inline(always)]
    pub fn compute_clearance_up_to<V: Real>(
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
    pub fn compute_clearance_apart<V: Real>(
        &self,
        position: Planar<V>,
        arms: &[Planar<V>; LEGS],
        distals: &[DistalLanes<V>; LEGS],
        limit: V,
    ) -> V {
        limit.call_apart(ClearanceUpTo {
            checker: self,
            position,
            arms,
            distals,
            limit,
        })
    }

    /// Returns the scalars that every evaluation determines, but for the clearance, at several poses at once, and the distal bars of
    /// the legs.
    #[inline(always)]
    pub fn core_lanes<V: Real>(
        &self,
        position: Planar<V>,
        arms: &[Planar<V>; LEGS],
    ) -> (CoreLanes<V>, [DistalLanes<V>; LEGS]) {
        let like = position.x;
        let legs = self.leg_lanes(position, arms);
        let jacobian = Jacobian::of_lanes(&legs);
        let [k_xy, k_z, k_phi_z] = match &self.stiffness {
            Some(model) if L::MAY_BE_ON_RAILS && model.is_on_bending_rails() => like.call_apart(StiffnessOnRails {
                checker: self,
                position,
                arms: *arms,
            }),
            Some(model) => model.stiffness_value_lanes(self.definition, &legs, arms, &NoSliders, &jacobian),
            None => [like.splat(0.0); 3],
        };
        let [first, second, third] = [&legs[0].chain, &legs[1].chain, &legs[2].chain];
        let mut scalars = CoreScalars::splat(like);
        scalars[PoseScalar::Reach] = first
            .limit_margin
            .smaller(second.limit_margin.smaller(third.limit_margin));
        scalars[PoseScalar::Determinant] = jacobian.determinant() * like.splat(1.0 / self.length);
        scalars[PoseScalar::Dexterity] = jacobian.inverse_condition(self.length);
        scalars[PoseScalar::StiffnessXy] = k_xy;
        scalars[PoseScalar::StiffnessZ] = k_z;
        scalars[PoseScalar::StiffnessPhiZ] = k_phi_z;
        let values = CoreLanes {
            reachable: first.reachable & second.reachable & third.reachable,
            scalars,
        };
        (values, [legs[0].distal(), legs[1].distal(), legs[2].distal()])
    }

    /// Returns the limit of a scalar in as many lanes as `like` has.
    #[inline(always)]
    fn bound_lanes<V: Real>(&self, like: V, scalar: PoseScalar) -> V {
        like.splat(self.thresholds.bound(scalar))
    }

    /// Returns the mask of the feasible poses, at which `det A` has the given sign (±1). The limits of other scalars than
    /// [`EXAMINED_ALWAYS`] are examined only if `ALL` says so, because a loop that could examine them is slower; with them, the parts
    /// are functions of their own. `set` are the scalars that are limited.
    #[inline(always)]
    pub fn feasible_lanes<V: Real, const ALL: bool>(
        &self,
        position: Planar<V>,
        arms: &[Planar<V>; LEGS],
        sign: V,
        set: ScalarSet,
    ) -> V::Mask {
        let (values, distals) = if ALL {
            position.x.call_apart(Core {
                checker: self,
                position,
                arms,
            })
        } else {
            self.core_lanes(position, arms)
        };
        let scalars = &values.scalars;
        let mut good = values.reachable
            & (scalars[PoseScalar::Determinant] * sign).exceeds(sign.splat(0.0))
            & scalars[PoseScalar::Dexterity].at_least(self.bound_lanes(sign, PoseScalar::Dexterity))
            & scalars[PoseScalar::StiffnessXy].at_least(self.bound_lanes(sign, PoseScalar::StiffnessXy))
            & scalars[PoseScalar::StiffnessPhiZ].at_least(self.bound_lanes(sign, PoseScalar::StiffnessPhiZ))
            & scalars[PoseScalar::StiffnessZ].at_least(self.bound_lanes(sign, PoseScalar::StiffnessZ));
        if ALL && V::any(good) {
            let mut scalars = PoseScalars::of_core(scalars);
            self.fill_on_demand(set.without_motion(), position, arms, &mut scalars);
            for &scalar in PoseScalar::ALL {
                let is_examined = !EXAMINED_ALWAYS.contains(&scalar) && scalar.of_motion().is_none();
                if is_examined && self.thresholds.get(scalar).is_some() {
                    let (value, limit) = (scalars[scalar], self.bound_lanes(sign, scalar));
                    good = good
                        & match scalar.entry().quantity.better {
                            Better::Higher => value.at_least(limit),
                            Better::Lower => limit.at_least(value),
                        };
                }
            }
            if self.thresholds.limit_motion() && V::any(good) {
                good = keep_limits_of_motion(self, position, arms, good);
            }
        }
        // Where the pose is already infeasible the limit is −∞, so that no clearance is below it and no pair is
        // examined.
        if set.contains(PoseScalar::Clearance) && V::any(good) {
            let least = self.bound_lanes(sign, PoseScalar::Clearance);
            let limit = least.select(good, sign.splat(f64::NEG_INFINITY));
            let clearance = if ALL {
                self.compute_clearance_apart(position, arms, &distals, limit)
            } else {
                self.compute_clearance_up_to(position, arms, &distals, limit)
            };
            good = good & clearance.at_least(least);
        }
        good
    }
}
