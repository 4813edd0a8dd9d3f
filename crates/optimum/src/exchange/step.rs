//! A step of the search: the quadratic programme, and the merit that tells whether the step is good.

use nalgebra::{DMatrix, DVector};

use super::{Exchange, HEAVIEST};
use crate::convex::ConvexProgram;
use crate::requirement::Critical;

/// Curvature that the cost of a violation has, so that a step is unique.
const BENT: f64 = 1e-3;

/// A step of the quadratic programme.
pub struct Step {
    pub change: DVector<f64>,
    pub multipliers: Vec<f64>,
    /// Decrease of the merit that the programme promises.
    pub promised: f64,
}

impl Exchange<'_> {
    /// Returns the largest violation of each kind of requirement.
    fn violations(&self, values: &[f64]) -> Vec<f64> {
        let mut violations = vec![0.0f64; self.kinds.len()];
        for (critical, value) in self.critical.iter().zip(values) {
            let violation: &mut f64 = &mut violations[self.kind(critical)];
            *violation = violation.max(-value);
        }
        violations
    }

    fn kind(&self, critical: &Critical) -> usize {
        let kind = critical.requirement.kind();
        self.kinds.iter().position(|other| *other == kind).unwrap_or(0)
    }

    /// Returns the minimised value, raised by the largest violation of each kind of requirement: if the largest of all counted alone,
    /// one requirement that is far from holding would let the others go.
    pub fn merit(&self, unknowns: &[f64], values: &[f64]) -> f64 {
        let violation: f64 = self.violations(values).iter().sum();
        self.problem.minimised(unknowns) + self.weight * violation
    }

    /// Solves the quadratic programme about the unknowns. Where its constraints contradict each other, they are missed as little as
    /// possible.
    pub fn step(&mut self, gradient: &DVector<f64>, rows: &DMatrix<f64>, values: &[f64], trust: f64) -> Option<Step> {
        let count = self.unknowns.len();
        if !gradient.iter().chain(rows.iter()).all(|number| number.is_finite()) {
            return None;
        }
        // The last variables are the largest violation of each kind.
        let kinds = self.kinds.len();
        let mut program = ConvexProgram::new(count + kinds);
        program
            .quadratic
            .view_mut((0, 0), (count, count))
            .copy_from(self.hessian.matrix());
        (count..count + kinds).for_each(|violation| program.quadratic[(violation, violation)] = BENT);
        program.linear.rows_mut(0, count).copy_from(gradient);
        program.linear.rows_mut(count, kinds).fill(self.weight);
        for (row, value) in values.iter().enumerate() {
            let mut row_of = DVector::zeros(count + kinds);
            row_of.rows_mut(0, count).copy_from(&rows.row(row).transpose());
            row_of[count + self.kind(&self.critical[row])] = 1.0;
            program.at_least.push((row_of, -value));
        }
        for unknown in 0..count {
            let [lower, upper] = self.reach[unknown].map(|bound| bound - self.unknowns[unknown]);
            program.bound_below(unknown, lower.max(-trust));
            program.bound_above(unknown, upper.min(trust));
        }
        (count..count + kinds).for_each(|violation| program.bound_below(violation, 0.0));
        let solution = program.solve_strictly()?;
        let change: DVector<f64> = solution.x.rows(0, count).into_owned();
        let multipliers = solution.multipliers[..values.len()].to_vec();
        let left: f64 = solution
            .x
            .rows(count, kinds)
            .iter()
            .map(|violation| violation.max(0.0))
            .sum();
        let violation: f64 = self.violations(values).iter().sum();
        let promised = self.weight * (violation - left) - gradient.dot(&change) - self.hessian.half_square(&change);
        if left > 1e-9 && self.weight < HEAVIEST {
            self.weight *= 2.0;
        }
        Some(Step {
            change,
            multipliers,
            promised,
        })
    }
}
