//! By how much a requirement holds, as a number that is not negative where it does.

use kinefront_model::evaluation::{Better, Bound, MarginUnit, PoseScalar, PoseScalars, Quantity};
use kinefront_model::mechanism::MemberKind;

use super::place::{Density, Place};
use super::problem::{LocalProblem, Prepared, excess};
use super::requirement::{End, NOWHERE, Requirement, threshold_name};

/// Value of a requirement that another one of the same leg hides.
const FAR: f64 = 1.0;

impl Requirement {
    /// Returns whether the requirement has a value at each pose.
    pub(crate) fn is_of_poses(self, problem: &LocalProblem) -> bool {
        match self {
            Requirement::Assembly => false,
            Requirement::Quantity(place) => {
                matches!(problem.question().settings.limits[place].quantity, Quantity::Worst(_))
            }
            _ => true,
        }
    }

    /// Returns the name in results, for example `k_z_min` or `reach_and_limits:rail_end:leg1`.
    pub fn name(self, problem: &LocalProblem) -> String {
        match self {
            Requirement::Limit { leg, joint, end } => {
                let chain = problem.architecture().chain();
                let is_telescopic = chain.distal == MemberKind::TelescopicLeg;
                let word = match (joint, is_telescopic, end) {
                    (0, _, End::Lower) => "rail_start",
                    (0, _, End::Upper) => "rail_end",
                    (1, true, End::Lower) => "shortest",
                    (1, true, End::Upper) => "longest",
                    (_, _, End::Lower) => "guide_start",
                    (_, _, End::Upper) => "guide_end",
                };
                format!("reach_and_limits:{word}:leg{}", leg + 1)
            }
            Requirement::EndOfReach { leg } => format!("reach_and_limits:end_of_reach:leg{}", leg + 1),
            Requirement::Scalar(scalar) => threshold_name(scalar).to_owned(),
            Requirement::Determinant => "determinant_sign".to_owned(),
            Requirement::Quantity(place) => problem.question().settings.limits[place]
                .quantity
                .entry()
                .key
                .to_owned(),
            Requirement::Assembly => "assembly".to_owned(),
        }
    }
}

impl LocalProblem {
    /// Returns the value of a requirement at a place: not negative where it holds, [`NOWHERE`] where it has none. A requirement of the
    /// design as a whole has the same value at every place.
    pub(crate) fn value(&self, prepared: &Prepared, requirement: Requirement, place: &Place) -> f64 {
        let scale = prepared.design.base_radius();
        let value = match requirement {
            Requirement::Limit { leg, joint, end } => prepared
                .distance_from_limit(leg, joint, end, place)
                .map_or(NOWHERE, |distance| (distance - self.margin(prepared)) / scale),
            Requirement::EndOfReach { leg } => prepared
                .distance_from_end(leg, place)
                .map_or(FAR, |distance| (distance - self.margin(prepared)) / scale),
            Requirement::Assembly => {
                let assembly = self.model.assembly(&prepared.design);
                (assembly.value - assembly.threshold) / scale
            }
            Requirement::Quantity(index) => {
                let limit = &self.question().settings.limits[index];
                match limit.quantity {
                    Quantity::Worst(scalar) => excess(self.scalars(prepared, place)[scalar], limit),
                    _ => self.excess_of_quantity(prepared, limit).unwrap_or(NOWHERE),
                }
            }
            Requirement::Scalar(_) | Requirement::Determinant => {
                let scalars = self.scalars(prepared, place);
                self.of_scalars(prepared, requirement, |scalar| scalars[scalar])
            }
        };
        if value.is_nan() {
            NOWHERE
        } else {
            (value - self.question().slack).max(NOWHERE)
        }
    }

    fn scalars(&self, prepared: &Prepared, place: &Place) -> PoseScalars<f64> {
        let (position, arms) = prepared.located(place);
        prepared.evaluator().evaluate_beyond_limits(&arms, position)
    }

    /// Returns the distance from joint limits and from the end of reach that is required \[m\].
    pub(crate) fn margin(&self, prepared: &Prepared) -> f64 {
        self.limit(prepared, PoseScalar::Reach)
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
                let limit = &self.question().settings.limits[index];
                match (limit.quantity, limit.bound) {
                    (Quantity::Worst(scalar), Bound::AtMost(_) | Bound::AtLeast(_)) => excess(value(scalar), limit),
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
        let determinant = self.scalars(prepared, &anywhere)[PoseScalar::Determinant];
        if determinant < 0.0 { -1.0 } else { 1.0 }
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
