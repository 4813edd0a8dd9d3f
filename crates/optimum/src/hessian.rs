//! The approximation of the Hessian of the Lagrangian with which a sequential quadratic programme steps.

use nalgebra::{DMatrix, DVector};

use super::multipliers::Multipliers;
use super::problem::LocalProblem;
use super::requirement::Critical;

/// Least and largest curvature.
const FLATTEST: f64 = 1e-3;
const STEEPEST: f64 = 1e6;

/// A positive definite approximation of the Hessian.
#[derive(Debug, Clone)]
pub(crate) struct Hessian(DMatrix<f64>);

impl Hessian {
    /// The first approximation for some number of unknowns.
    pub fn identity(count: usize) -> Self {
        Self(DMatrix::identity(count, count))
    }

    pub fn matrix(&self) -> &DMatrix<f64> {
        &self.0
    }

    /// Returns the term of second order of a change.
    pub fn half_square(&self, change: &DVector<f64>) -> f64 {
        0.5 * change.dot(&(&self.0 * change))
    }

    /// Determines the Hessian by differences, made positive definite.
    pub fn renew(&mut self, problem: &LocalProblem, unknowns: &[f64], multipliers: &Multipliers) {
        let (critical, weights): (Vec<Critical>, Vec<f64>) = multipliers
            .critical_with_values()
            .map(|(critical, multiplier)| (*critical, multiplier))
            .unzip();
        let of_places = |_: &[f64]| Some(critical.clone());
        let hessian = problem.hessian_of_lagrangian(unknowns, &DVector::from_vec(weights), of_places);
        let Some(hessian) = hessian else { return };
        let mut found = hessian.symmetric_eigen();
        for value in found.eigenvalues.iter_mut() {
            *value = value.abs().clamp(FLATTEST, STEEPEST);
        }
        self.0 = found.recompose();
    }

    /// Updates the approximation by the change of the gradient of the Lagrangian along a way, damped so that it stays positive definite
    /// (Powell 1978).
    pub fn bend(&mut self, way: &DVector<f64>, turned: DVector<f64>) {
        let image = &self.0 * way;
        let curvature = way.dot(&image);
        if curvature < 1e-30 || way.amax() < 1e-9 {
            return;
        }
        let along = way.dot(&turned);
        let share = if along >= 0.2 * curvature {
            1.0
        } else {
            0.8 * curvature / (curvature - along)
        };
        let turned = turned * share + &image * (1.0 - share);
        let along = way.dot(&turned);
        self.0 += &turned * turned.transpose() / along - &image * image.transpose() / curvature;
        self.0 = 0.5 * (&self.0 + self.0.transpose());
    }
}
