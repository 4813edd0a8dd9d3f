//! Further values of a pose, which only some studies bound or report: transmission, displacement, and how far the members
//! extend (docs/model.md, section 6.5).

use pulp::{Simd, WithSimd};

use super::PoseChecker;
use super::batch::OrientationLanes;
use super::columns::Positions;
use crate::kinematics::Jacobian;
use crate::lanes::{LaneJob, Lanes, Planar, Real};
use crate::mechanism::{JointKind, Leg, LegLanes};
use crate::spatial::LEGS;
use crate::stiffness::NoSliders;

/// Limits of values that the paper does not bound; `None` where a study states none.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct FurtherLimits {
    /// Smallest distance to a joint limit or to the end of reach allowed \[m\].
    pub limit_margin: Option<f64>,
    /// Smallest transmission allowed.
    pub transmission: Option<f64>,
    /// Largest displacement under the in-plane force allowed \[m\].
    pub displacement: Option<f64>,
}

/// Further values of a reachable pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FurtherValues {
    /// Smallest transmission of a leg: `|B_ii|`, divided by the lever of a revolute actuator; in \[0, 1\].
    pub transmission: f64,
    /// Displacement under the in-plane force in the most compliant direction \[m\].
    pub displacement: f64,
}

/// Further values at several poses at once.
#[derive(Clone, Copy)]
pub struct FurtherLanes<V> {
    /// Smallest transmission of a leg.
    pub transmission: V,
    /// Displacement under the in-plane force in the most compliant direction \[m\]; infinite for a platform that yields.
    pub displacement: V,
}

impl FurtherLimits {
    /// Returns whether the values satisfy all limits.
    pub fn are_met_by(&self, limit_margin: f64, values: &FurtherValues) -> bool {
        self.limit_margin.is_none_or(|least| limit_margin >= least)
            && self.transmission.is_none_or(|least| values.transmission >= least)
            && self.displacement.is_none_or(|most| values.displacement <= most)
    }
}

/// Further values at many positions in one orientation, one column each.
#[derive(Debug, Default)]
pub(crate) struct FurtherColumns {
    pub transmission: Vec<f64>,
    pub displacement: Vec<f64>,
    /// Distance from `O` of the farthest point of a member \[m\].
    pub outermost: Vec<f64>,
}

struct WriteFurther<'a, L> {
    checker: &'a PoseChecker<L>,
    oriented: OrientationLanes<'a>,
    positions: &'a Positions,
    columns: &'a mut FurtherColumns,
}

impl<L: Leg> WithSimd for WriteFurther<'_, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let (arms, _) = self.oriented.lanes(simd);
        let xs = Lanes::<S>::column(&self.positions.xs);
        let ys = Lanes::<S>::column(&self.positions.ys);
        let transmission = Lanes::<S>::column_mut(&mut self.columns.transmission);
        let displacement = Lanes::<S>::column_mut(&mut self.columns.displacement);
        let outermost = Lanes::<S>::column_mut(&mut self.columns.outermost);
        for group in 0..xs.len() {
            let position = Planar::new(Lanes::load(simd, &xs[group]), Lanes::load(simd, &ys[group]));
            let found = self.checker.further_lanes(position, &arms);
            found.transmission.store(&mut transmission[group]);
            found.displacement.store(&mut displacement[group]);
            let checker = self.checker;
            let legs = checker.leg_lanes(position, &arms);
            let distals = [legs[0].distal(), legs[1].distal(), legs[2].distal()];
            checker
                .bodies
                .outermost(&checker.manipulator.legs, position, &arms, &distals)
                .store(&mut outermost[group]);
        }
    }
}

/// The further values at several poses, as a job of its own: few studies need them.
struct FurtherJob<'a, L, V> {
    checker: &'a PoseChecker<L>,
    position: Planar<V>,
    arms: &'a [Planar<V>; LEGS],
}

impl<L: Leg, V: Real> LaneJob for FurtherJob<'_, L, V> {
    type Output = FurtherLanes<V>;

    #[inline(always)]
    fn run(self) -> FurtherLanes<V> {
        self.checker.compute_further(self.position, self.arms)
    }
}

impl<L: Leg> PoseChecker<L> {
    #[inline(always)]
    pub(super) fn leg_lanes<V: Real>(&self, position: Planar<V>, arms: &[Planar<V>; LEGS]) -> [LegLanes<V>; LEGS] {
        let legs = &self.manipulator.legs;
        [
            legs[0].lanes(position, arms[0]),
            legs[1].lanes(position, arms[1]),
            legs[2].lanes(position, arms[2]),
        ]
    }

    /// Returns the further values at several poses at once; meaningless where a leg does not reach the pose.
    #[inline(always)]
    pub(super) fn further_lanes<V: Real>(&self, position: Planar<V>, arms: &[Planar<V>; LEGS]) -> FurtherLanes<V> {
        let checker = self;
        position.x.call_apart(FurtherJob {
            checker,
            position,
            arms,
        })
    }

    #[inline(always)]
    fn compute_further<V: Real>(&self, position: Planar<V>, arms: &[Planar<V>; LEGS]) -> FurtherLanes<V> {
        let like = position.x;
        let legs = self.leg_lanes(position, arms);
        let jacobian = Jacobian::of_lanes(&legs);
        let lever = match self.actuator {
            JointKind::Prismatic => 1.0,
            JointKind::Revolute => 1.0 / self.longest_lever,
        };
        let least = legs[0]
            .transmission
            .abs()
            .smaller(legs[1].transmission.abs().smaller(legs[2].transmission.abs()));
        let k_xy = match &self.stiffness {
            Some(model) if L::MAY_BE_ON_RAILS && model.is_on_bending_rails() => {
                model.compliant_k_xy_lanes(&legs, &self.slider_lanes(position, arms, &legs), &jacobian)
            }
            Some(model) => model.compliant_k_xy_lanes(&legs, &NoSliders, &jacobian),
            None => like.splat(0.0),
        };
        let force = like.splat(self.in_plane_force);
        let yields = like.splat(0.0).at_least(k_xy);
        FurtherLanes {
            transmission: least * like.splat(lever),
            displacement: like.splat(f64::INFINITY).select(yields, force / k_xy),
        }
    }

    /// Computes the further values at many positions in one orientation; the positions are padded.
    pub(crate) fn further(&self, oriented: OrientationLanes<'_>, positions: &Positions, columns: &mut FurtherColumns) {
        for column in [
            &mut columns.transmission,
            &mut columns.displacement,
            &mut columns.outermost,
        ] {
            column.resize(positions.xs.len(), 0.0);
        }
        self.instructions.run(WriteFurther {
            checker: self,
            oriented,
            positions,
            columns,
        });
    }

    /// Returns the further values at one pose, with `P` at `position`; meaningless if a leg does not reach the pose.
    pub fn further_at(&self, position: glam::DVec2, arms: &[glam::DVec2; LEGS]) -> FurtherValues {
        let found = self.further_lanes::<f64>(position.into(), &arms.map(Planar::from));
        FurtherValues {
            transmission: found.transmission,
            displacement: found.displacement,
        }
    }
}
