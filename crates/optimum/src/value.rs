//! By how much a requirement holds, as a number that is not negative where it does.

use std::cell::OnceCell;

use kinefront_model::evaluation::{
    Better, MarginUnit, ModelSettings, PoseScalar, PoseScalars, Quantity, QuantityLimit,
};
use kinefront_model::mechanism::MemberKind;
use nalgebra::{DMatrix, DVector};

use super::place::{Density, Place};
use super::prepared::Prepared;
use super::problem::{LocalProblem, excess};
use super::requirement::{Critical, End, NOWHERE, Requirement, threshold_name};

/// Half the difference by which derivatives are taken.
const DIFFERENCE: f64 = 1e-6;

/// Half the difference of the unknowns by which a Hessian is determined.
const BEND: f64 = 1e-4;

/// Value of a requirement that another one of the same leg hides.
const FAR: f64 = 1.0;

impl Requirement {
    /// Returns whether the requirement has a value at each pose.
    pub(crate) fn is_of_poses(self, problem: &LocalProblem) -> bool {
        match self {
            Requirement::Assembly | Requirement::Base => false,
            Requirement::Quantity(_) => self.scalar_in(&problem.question().settings).is_some(),
            _ => true,
        }
    }

    /// Returns the scalar of a pose that the requirement compares with a limit of `settings`, if it is one.
    pub(crate) fn scalar_in(self, settings: &ModelSettings) -> Option<PoseScalar> {
        match self {
            Requirement::Scalar(scalar) => Some(scalar),
            Requirement::Quantity(place) => match settings.limits[place].quantity {
                Quantity::Worst(scalar) => Some(scalar),
                _ => None,
            },
            _ => None,
        }
    }

    /// Returns the name of an end of the travel of a joint, and that for a person.
    fn end_of_travel(problem: &LocalProblem, joint: usize, end: End) -> [&'static str; 2] {
        let is_telescopic = problem.architecture().chain().distal == MemberKind::TelescopicLeg;
        match (joint, is_telescopic, end) {
            (0, _, End::Lower) => ["rail_start", "start of a rail"],
            (0, _, End::Upper) => ["rail_end", "end of a rail"],
            (1, true, End::Lower) => ["shortest", "shortest length of a leg"],
            (1, true, End::Upper) => ["longest", "longest length of a leg"],
            (_, _, End::Lower) => ["guide_start", "start of a guide"],
            (_, _, End::Upper) => ["guide_end", "end of a guide"],
        }
    }

    /// Returns the word in results and the name for a person, both the same for all legs.
    fn words(self, problem: &LocalProblem) -> [&'static str; 2] {
        match self {
            Requirement::Limit { joint, end, .. } => Self::end_of_travel(problem, joint, end),
            Requirement::EndOfReach { .. } => ["end_of_reach", "end of the reach of a leg"],
            Requirement::Scalar(scalar) => [threshold_name(scalar), scalar.entry().quantity.label],
            Requirement::Determinant => ["determinant_sign", "distance to singularities"],
            Requirement::Quantity(place) => {
                let entry = limit(problem, place).quantity.entry();
                [entry.key, entry.label]
            }
            Requirement::Base => ["footprint_m:base", "footprint of the base"],
            Requirement::Assembly => ["assembly", "assembly"],
        }
    }

    /// Returns the name for a person, the same for all legs.
    pub fn label(self, problem: &LocalProblem) -> String {
        let [_, label] = self.words(problem);
        label.to_owned()
    }

    /// Returns the name in results, for example `k_z_min` or `reach_and_limits:rail_end:leg1`.
    pub fn name(self, problem: &LocalProblem) -> String {
        let [word, _] = self.words(problem);
        match self.leg() {
            Some(leg) => format!("reach_and_limits:{word}:leg{}", leg + 1),
            None => word.to_owned(),
        }
    }
}

/// Returns a limit of the problem that is none of poses.
fn limit(problem: &LocalProblem, place: usize) -> &QuantityLimit {
    &problem.question().settings.limits[place]
}

impl LocalProblem {
    /// Returns the value of a requirement at a place: not negative where it holds, [`NOWHERE`] where it has none. A requirement of the
    /// design as a whole has the same value at every place.
    pub(crate) fn value(&self, prepared: &Prepared, requirement: Requirement, place: &Place) -> f64 {
        let value = match requirement {
            Requirement::Limit { leg, joint, end } => prepared
                .distance_from_limit(leg, joint, end, place)
                .map_or(NOWHERE, |distance| self.reach(prepared, distance)),
            Requirement::EndOfReach { leg } => prepared
                .distance_from_end(leg, place)
                .map_or(FAR, |distance| self.reach(prepared, distance)),
            Requirement::Assembly => {
                let assembly = self.model.assembly(&prepared.design);
                (assembly.value - assembly.threshold) / prepared.design.base_radius()
            }
            Requirement::Base => self.footprint_beyond_base(prepared),
            Requirement::Quantity(index) if !requirement.is_of_poses(self) => {
                let limit = limit(self, index);
                self.excess_of_quantity(prepared, limit).unwrap_or(NOWHERE)
            }
            Requirement::Scalar(_) | Requirement::Determinant | Requirement::Quantity(_) => {
                let scalars = self.scalars(prepared, place, requirement.scalar_in(&self.question().settings));
                self.of_scalars(prepared, requirement, |scalar| scalars[scalar])
            }
        };
        if value.is_nan() {
            NOWHERE
        } else {
            (value - self.question().slack).max(NOWHERE)
        }
    }

    /// Returns by how much the limits of the footprint exceed the distance of the farthest anchor of the base, as a logarithm.
    fn footprint_beyond_base(&self, prepared: &Prepared) -> f64 {
        let farthest = prepared.base_radius();
        let of_scalar = |requirement: &Requirement| match *requirement {
            Requirement::Scalar(PoseScalar::Footprint) => {
                Some(libm::log(self.limit(prepared, PoseScalar::Footprint) / farthest))
            }
            Requirement::Quantity(index) => {
                let limit = limit(self, index);
                (limit.quantity == Quantity::Worst(PoseScalar::Footprint)).then(|| excess(farthest, limit))
            }
            _ => None,
        };
        let excesses = self.requirements().iter().filter_map(of_scalar);
        excesses.fold(f64::INFINITY, f64::min)
    }

    fn scalars(&self, prepared: &Prepared, place: &Place, scalar: Option<PoseScalar>) -> PoseScalars<f64> {
        let (position, arms) = prepared.located(place);
        let set = scalar.into_iter().collect();
        prepared.evaluator().evaluate_beyond_limits(&arms, position, set)
    }

    /// Returns the value of g2 for a distance from a joint limit or from the end of reach \[m\].
    pub(crate) fn reach(&self, prepared: &Prepared, distance: f64) -> f64 {
        (distance - self.limit(prepared, PoseScalar::Reach)) / prepared.design.base_radius()
    }

    /// Returns the value of a requirement on a scalar from the scalars of the pose.
    pub(crate) fn of_scalars(
        &self,
        prepared: &Prepared,
        requirement: Requirement,
        value: impl Fn(PoseScalar) -> f64,
    ) -> f64 {
        // The inverse kinematics has no solution.
        if value(PoseScalar::Determinant).is_nan() {
            return f64::NAN;
        }
        match requirement {
            Requirement::Scalar(scalar) => {
                let limit = self.limit(prepared, scalar);
                of_scalar(scalar, value(scalar), limit, prepared.design.base_radius())
            }
            Requirement::Determinant => value(PoseScalar::Determinant) * self.sign(prepared),
            Requirement::Quantity(index) => {
                let limit = limit(self, index);
                match limit.quantity {
                    Quantity::Worst(scalar) => excess(value(scalar), limit),
                    _ => NOWHERE,
                }
            }
            _ => NOWHERE,
        }
    }

    /// Returns the sign of `det A` at a spot of the region in the home orientation.
    fn sign(&self, prepared: &Prepared) -> f64 {
        let anywhere = Place {
            spot: self.spots(Density::Coarse).all[0],
            turn: 0.0,
        };
        let determinant = self.scalars(prepared, &anywhere, None)[PoseScalar::Determinant];
        if determinant < 0.0 { -1.0 } else { 1.0 }
    }

    /// Returns the values of critical requirements at their places for some unknowns.
    pub(crate) fn values_of(&self, unknowns: &[f64], critical: &[Critical]) -> Vec<f64> {
        match self.prepare(unknowns) {
            Some(prepared) => {
                let value = |critical: &Critical| self.value(&prepared, critical.requirement, &critical.place);
                critical.iter().map(value).collect()
            }
            None => vec![NOWHERE; critical.len()],
        }
    }

    /// Returns the derivatives of the minimised value and of critical requirements with respect to the unknowns: a vector, and a row for
    /// each requirement.
    pub(crate) fn derivatives(&self, unknowns: &[f64], critical: &[Critical]) -> (DVector<f64>, DMatrix<f64>) {
        let count = unknowns.len();
        let mut gradient = DVector::zeros(count);
        let mut rows = DMatrix::zeros(critical.len(), count);
        let here = OnceCell::new();
        let here = |row: usize| here.get_or_init(|| self.values_of(unknowns, critical))[row];
        for unknown in 0..count {
            let moved = |step: f64| {
                let mut moved = unknowns.to_vec();
                moved[unknown] += step;
                moved
            };
            let (below, above) = (moved(-DIFFERENCE), moved(DIFFERENCE));
            let width = above[unknown] - below[unknown];
            gradient[unknown] = (self.minimised(&above) - self.minimised(&below)) / width;
            let (lower, upper) = (self.values_of(&below, critical), self.values_of(&above, critical));
            for (row, (lower, upper)) in lower.iter().zip(&upper).enumerate() {
                // At the end of reach, a requirement has a value on one side alone.
                rows[(row, unknown)] = match (*lower > NOWHERE, *upper > NOWHERE) {
                    (true, true) => (upper - lower) / width,
                    (true, false) => (here(row) - lower) / DIFFERENCE,
                    (false, true) => (upper - here(row)) / DIFFERENCE,
                    (false, false) => 0.0,
                };
            }
        }
        (gradient, rows)
    }

    /// Returns the Hessian of the Lagrangian by differences; `None` if it is not finite. `weights` are the multipliers of the critical
    /// requirements, and `critical_at` returns these at other unknowns, in the same order.
    pub(crate) fn hessian_of_lagrangian(
        &self,
        unknowns: &[f64],
        weights: &DVector<f64>,
        critical_at: impl Fn(&[f64]) -> Option<Vec<Critical>>,
    ) -> Option<DMatrix<f64>> {
        let count = unknowns.len();
        let mut hessian = DMatrix::zeros(count, count);
        for unknown in 0..count {
            let at = |step: f64| -> Option<DVector<f64>> {
                let mut moved = unknowns.to_vec();
                moved[unknown] += step;
                let (gradient, rows) = self.derivatives(&moved, &critical_at(&moved)?);
                Some(gradient - rows.transpose() * weights)
            };
            hessian.set_column(unknown, &((at(BEND)? - at(-BEND)?) / (2.0 * BEND)));
        }
        let is_finite = hessian.iter().all(|number: &f64| number.is_finite());
        is_finite.then(|| 0.5 * (&hessian + hessian.transpose()))
    }
}

/// Returns the excess of a scalar over its limit: a logarithm of their ratio, half the excess of the squares for the dexterity, which is
/// smooth at singularities, and a share of `base_radius` for a distance.
fn of_scalar(scalar: PoseScalar, value: f64, limit: f64, base_radius: f64) -> f64 {
    let entry = scalar.entry();
    if scalar == PoseScalar::Dexterity && limit > 0.0 {
        return 0.5 * (value * value / (limit * limit) - 1.0);
    }
    let (is_ratio, higher) = (
        entry.margin == MarginUnit::Threshold && limit > 0.0,
        entry.quantity.better == Better::Higher,
    );
    match (is_ratio, higher) {
        (true, true) => libm::log(value / limit),
        (true, false) => libm::log(limit / value),
        (false, true) => (value - limit) / base_radius,
        (false, false) => (limit - value) / base_radius,
    }
}
