//! Small convex programs, with linear constraints, and their solution by an interior-point method, for those that are not strictly convex.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, SupportedConeT, ZeroConeT,
};
use nalgebra::{DMatrix, DVector};

/// Tolerance of the interior-point method.
const TOLERANCE: f64 = 1e-12;

/// A program `min ½ xᵀPx + qᵀx` with `A x = b` and `C x ≥ d`.
#[derive(Debug, Clone)]
pub(crate) struct ConvexProgram {
    /// `P`, symmetric.
    pub quadratic: DMatrix<f64>,
    /// `q`.
    pub linear: DVector<f64>,
    /// Rows of `A` with the elements of `b`.
    pub equal: Vec<(DVector<f64>, f64)>,
    /// Rows of `C` with the elements of `d`.
    pub at_least: Vec<(DVector<f64>, f64)>,
}

impl ConvexProgram {
    /// Creates a program without constraints in `count` variables, with the value 0.
    pub fn new(count: usize) -> Self {
        Self {
            quadratic: DMatrix::zeros(count, count),
            linear: DVector::zeros(count),
            equal: Vec::new(),
            at_least: Vec::new(),
        }
    }

    /// Requires that a variable is at least a number.
    pub fn bound_below(&mut self, variable: usize, least: f64) {
        self.bound(variable, 1.0, least);
    }

    /// Requires that a variable is at most a number.
    pub fn bound_above(&mut self, variable: usize, most: f64) {
        self.bound(variable, -1.0, -most);
    }

    fn bound(&mut self, variable: usize, sign: f64, least: f64) {
        let mut row = DVector::zeros(self.linear.len());
        row[variable] = sign;
        self.at_least.push((row, least));
    }

    /// Returns where a program that need not be strictly convex has its least value; `None` if it has no solution, or if none was found.
    pub fn solve(&self) -> Option<DVector<f64>> {
        let count = self.linear.len();
        let quadratic = sparse(count, count, |row, column| {
            if row <= column {
                self.quadratic[(row, column)]
            } else {
                0.0
            }
        });
        let rows: Vec<(&DVector<f64>, f64)> = self
            .equal
            .iter()
            .chain(&self.at_least)
            .map(|(row, side)| (row, *side))
            .collect();
        // The library has `A x + s = b` with `s` in a cone.
        let constraints = sparse(rows.len(), count, |row, column| -rows[row].0[column]);
        let sides: Vec<f64> = rows.iter().map(|(_, side)| -side).collect();
        let cones: [SupportedConeT<f64>; 2] = [ZeroConeT(self.equal.len()), NonnegativeConeT(self.at_least.len())];
        let settings = DefaultSettings {
            verbose: false,
            tol_gap_abs: TOLERANCE,
            tol_gap_rel: TOLERANCE,
            tol_feas: TOLERANCE,
            ..DefaultSettings::default()
        };
        let linear: Vec<f64> = self.linear.iter().copied().collect();
        let mut solver = DefaultSolver::new(&quadratic, &linear, &constraints, &sides, &cones, settings).ok()?;
        solver.solve();
        let found = matches!(
            solver.solution.status,
            SolverStatus::Solved | SolverStatus::AlmostSolved | SolverStatus::InsufficientProgress
        );
        let x = DVector::from_vec(solver.solution.x.clone());
        (found && x.iter().all(|number| number.is_finite())).then_some(x)
    }
}

/// Returns a matrix with its elements other than 0.
fn sparse(rows: usize, columns: usize, element: impl Fn(usize, usize) -> f64) -> CscMatrix<f64> {
    let (mut starts, mut places, mut values) = (vec![0], Vec::new(), Vec::new());
    for column in 0..columns {
        for row in 0..rows {
            let value = element(row, column);
            if value != 0.0 {
                places.push(row);
                values.push(value);
            }
        }
        starts.push(values.len());
    }
    CscMatrix::new(rows, columns, starts, places, values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_point_of_a_half_plane_is_found() {
        // The point of x + y ≥ 2 that is nearest to the origin.
        let mut program = ConvexProgram::new(2);
        program.quadratic.fill_with_identity();
        program.at_least.push((DVector::from_vec(vec![1.0, 1.0]), 2.0));
        program.bound_below(0, -5.0);
        let found = program.solve().expect("the half plane is not empty");
        assert!((found[0] - 1.0).abs() < 1e-10 && (found[1] - 1.0).abs() < 1e-10);
        program.bound_above(0, 0.5);
        program.bound_above(1, 0.5);
        assert!(program.solve().is_none());
    }

    #[test]
    fn a_linear_program_ends_in_a_corner() {
        let mut program = ConvexProgram::new(2);
        program.linear = DVector::from_vec(vec![-1.0, -2.0]);
        program.equal.push((DVector::from_vec(vec![1.0, 1.0]), 3.0));
        program.bound_below(0, 1.0);
        program.bound_below(1, 0.0);
        let found = program.solve().expect("the segment is not empty");
        assert!((found[0] - 1.0).abs() < 1e-9 && (found[1] - 2.0).abs() < 1e-9);
    }
}
