//! What the active requirements and bounds of an optimum cost: multipliers by non-negative least squares, and the range that each price
//! may have where they are not unique.

use nalgebra::{DMatrix, DVector};

use super::convex::ConvexProgram;
use super::problem::LocalProblem;
use super::requirement::{ACTIVE, Critical, End};

/// The same for one-sided prices, of which near requirements are part.
const NEARLY_ACTIVE: f64 = 2e-5;

/// Amount by which the multipliers of one-sided prices may miss the stationarity.
const STATIONARY: f64 = 3e-4;

/// Residual above which multipliers explain nothing.
const UNEXPLAINED: f64 = 1e-4;

/// Multipliers below this share of the largest one are 0.
const NONE: f64 = 1e-8;

/// Singular values of the normalised gradients below this share of the largest one leave the multipliers undetermined.
const DEPENDENT: f64 = 1e-3;

/// Gradients that differ by less than this, relative to their length, are one.
const ALIKE: f64 = 1e-5;

/// The multipliers of an optimum.
#[derive(Debug, Clone)]
pub struct Multipliers {
    /// The requirements that are nearly active, at their critical poses.
    critical: Vec<Critical>,
    /// The bounds at which the design stands, or nearly so: the place of the variable among those that are free, and the end.
    bounds: Vec<(usize, End)>,
    /// Multipliers of the requirements and then of the bounds, at least 0; 0 for what is not quite active.
    values: Vec<f64>,
    /// Gradients of the requirements and then of the bounds, a column each.
    columns: DMatrix<f64>,
    /// Gradient of what is minimised.
    gradient: DVector<f64>,
    /// Largest element of what the multipliers leave of the gradient; 0 at an exact optimum.
    pub residual: f64,
    /// Whether other multipliers explain the optimum, too.
    pub are_ambiguous: bool,
}

impl Multipliers {
    /// Determines the multipliers of a design from its critical poses.
    pub(crate) fn new(problem: &LocalProblem, unknowns: &[f64], survey: &[Critical]) -> Self {
        let near: Vec<Critical> = survey
            .iter()
            .filter(|critical| critical.slack <= NEARLY_ACTIVE)
            .copied()
            .collect();
        let (gradient, rows) = problem.derivatives(unknowns, &near);
        let kept = distinct(&near, &rows);
        let count = unknowns.len();
        let bounds = near_bounds(problem, unknowns);
        let mut columns = DMatrix::zeros(count, kept.len() + bounds.len());
        for (column, place) in kept.iter().enumerate() {
            columns.set_column(column, &rows.row(*place).transpose());
        }
        for (column, (variable, end, _)) in bounds.iter().enumerate() {
            columns[(*variable, kept.len() + column)] = end.sign();
        }
        let slacks = kept
            .iter()
            .map(|place| near[*place].slack)
            .chain(bounds.iter().map(|(.., distance)| *distance));
        let exact: Vec<usize> = slacks
            .enumerate()
            .filter(|(_, slack)| *slack <= ACTIVE)
            .map(|(place, _)| place)
            .collect();
        let (found, residual) = non_negative(&columns.select_columns(&exact), &gradient);
        let mut values = vec![0.0; columns.ncols()];
        for (place, multiplier) in exact.iter().zip(found) {
            values[*place] = multiplier;
        }
        Self {
            critical: kept.iter().map(|place| near[*place]).collect(),
            bounds: bounds.iter().map(|&(variable, end, _)| (variable, end)).collect(),
            values,
            are_ambiguous: is_dependent(&columns),
            columns,
            gradient,
            residual,
        }
    }

    /// Returns whether the multipliers explain why a design cannot be better; otherwise there are no prices.
    pub fn explain(&self) -> bool {
        self.residual <= UNEXPLAINED
    }

    /// Returns the active requirements at their critical poses, each with its multiplier.
    pub fn active(&self) -> impl Iterator<Item = (&Critical, f64)> {
        self.critical_with_values().filter(|(critical, _)| critical.is_active())
    }

    /// Returns the requirements that are nearly active, each with its multiplier.
    pub(crate) fn critical_with_values(&self) -> impl Iterator<Item = (&Critical, f64)> {
        self.critical.iter().zip(self.values.iter().copied())
    }

    /// Returns the requirements and bounds that are nearly active, in the order in which [`Multipliers::range`] takes their effects.
    pub(crate) fn nearly_active(&self) -> (&[Critical], &[(usize, End)]) {
        (&self.critical, &self.bounds)
    }

    /// Returns the sum of the multipliers times the effects of a parameter on the requirements and bounds that are nearly active.
    pub(crate) fn sum(&self, effects: &[f64]) -> f64 {
        dot(self.values.iter(), effects)
    }

    /// Returns the least and the largest sum of multipliers times effects, over all multipliers that explain the optimum.
    pub(crate) fn range(&self, effects: &[f64]) -> Option<[f64; 2]> {
        let Self { columns, gradient, .. } = self;
        let end = |sign: f64| {
            let mut program = ConvexProgram::new(effects.len());
            program.linear = DVector::from_iterator(effects.len(), effects.iter().map(|effect| sign * effect));
            for unknown in 0..gradient.len() {
                let row = columns.row(unknown).transpose();
                program.at_least.push((row.clone(), gradient[unknown] - STATIONARY));
                program.at_least.push((-row, -gradient[unknown] - STATIONARY));
            }
            (0..effects.len()).for_each(|multiplier| program.bound_below(multiplier, 0.0));
            Some(dot(program.solve()?.iter(), effects))
        };
        Some([end(1.0)?, end(-1.0)?])
    }
}

/// Returns the places of critical poses, leaving out those whose gradient is that of one before.
fn distinct(near: &[Critical], rows: &DMatrix<f64>) -> Vec<usize> {
    let mut kept: Vec<usize> = Vec::new();
    for place in 0..near.len() {
        let is_known = |other: &usize| {
            let (a, b) = (rows.row(*other), rows.row(place));
            near[*other].requirement.is_alike(near[place].requirement)
                && near[*other].is_active() == near[place].is_active()
                && (a - b).amax() <= ALIKE * a.amax().max(b.amax())
        };
        if !kept.iter().any(is_known) {
            kept.push(place);
        }
    }
    kept
}

/// Returns the bounds that are nearly reached: the place of the unknown, the end, and its distance.
fn near_bounds(problem: &LocalProblem, unknowns: &[f64]) -> Vec<(usize, End, f64)> {
    let ends = problem.bounds().into_iter().zip(unknowns).enumerate();
    let ends = ends.flat_map(|(place, ([lower, upper], value))| {
        [(place, End::Lower, value - lower), (place, End::Upper, upper - value)]
    });
    ends.filter(|(.., distance)| *distance <= NEARLY_ACTIVE).collect()
}

fn dot<'a>(multipliers: impl Iterator<Item = &'a f64>, effects: &[f64]) -> f64 {
    multipliers
        .zip(effects)
        .map(|(multiplier, effect)| multiplier * effect)
        .sum()
}

/// Returns the least squares solution of `columns · λ = gradient` with `λ ≥ 0`, and the largest element of the residual.
fn non_negative(columns: &DMatrix<f64>, gradient: &DVector<f64>) -> (Vec<f64>, f64) {
    let (rows, count) = columns.shape();
    if !columns.iter().chain(gradient).all(|number| number.is_finite()) {
        return (vec![0.0; count], f64::MAX);
    }
    if rows == 0 {
        // Where every dimension is listed, nothing is left to change.
        return (vec![0.0; count], 0.0);
    }
    if count == 0 {
        return (Vec::new(), gradient.amax());
    }
    let lengths: Vec<f64> = columns
        .column_iter()
        .map(|column| column.norm().max(f64::MIN_POSITIVE))
        .collect();
    // The residual is a variable of its own: squaring the gradients would lose half the digits.
    let mut program = ConvexProgram::new(count + rows);
    for row in 0..rows {
        program.quadratic[(count + row, count + row)] = 1.0;
        let mut equation = DVector::zeros(count + rows);
        for column in 0..count {
            equation[column] = columns[(row, column)] / lengths[column];
        }
        equation[count + row] = -1.0;
        program.equal.push((equation, gradient[row]));
    }
    (0..count).for_each(|multiplier| program.bound_below(multiplier, 0.0));
    let Some(solution) = program.solve() else {
        return (vec![0.0; count], gradient.amax());
    };
    let mut found: Vec<f64> = solution
        .iter()
        .take(count)
        .map(|multiplier| multiplier.max(0.0))
        .collect();
    let largest = found.iter().copied().fold(0.0, f64::max);
    let support: Vec<usize> = (0..count).filter(|&place| found[place] > NONE * largest).collect();
    // Those that are not 0 follow exactly from the equations, unless that makes one negative.
    let scaled = DMatrix::from_fn(rows, support.len(), |row, column| {
        columns[(row, support[column])] / lengths[support[column]]
    });
    if !support.is_empty()
        && let Ok(exact) = scaled.clone().svd(true, true).solve(gradient, 1e-10)
        && exact.iter().all(|multiplier| *multiplier >= 0.0)
    {
        found.fill(0.0);
        for (place, multiplier) in support.iter().zip(exact.iter()) {
            found[*place] = *multiplier;
        }
    }
    for (multiplier, length) in found.iter_mut().zip(&lengths) {
        *multiplier /= length;
    }
    let left = columns * DVector::from_column_slice(&found) - gradient;
    (found, left.amax())
}

/// Returns whether columns, made equally long, are nearly dependent.
fn is_dependent(columns: &DMatrix<f64>) -> bool {
    if columns.is_empty() || !columns.iter().all(|number| number.is_finite()) {
        return false;
    }
    let mut scaled = columns.clone();
    for mut column in scaled.column_iter_mut() {
        let length = column.norm();
        if length > 0.0 {
            column /= length;
        }
    }
    if scaled.ncols() > scaled.nrows() {
        return true;
    }
    let values = scaled.singular_values();
    let largest = values.iter().copied().fold(0.0, f64::max);
    values.iter().any(|value| *value < DEPENDENT * largest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_design_without_active_requirements_has_no_multipliers() {
        let none = DMatrix::zeros(2, 0);
        assert!(!is_dependent(&none));
        let gradient = DVector::from_vec(vec![3.0, -4.0]);
        assert_eq!(non_negative(&none, &gradient), (Vec::new(), 4.0));
        let away = DMatrix::from_row_slice(2, 1, &[-1.0, 0.0]);
        let (found, residual) = non_negative(&away, &gradient);
        assert!(found[0] < 1e-6 && (residual - 4.0).abs() < 1e-6);
        let nothing_to_change = non_negative(&DMatrix::zeros(0, 1), &DVector::zeros(0));
        assert_eq!(nothing_to_change, (vec![0.0], 0.0));
        let broken = DMatrix::from_row_slice(2, 1, &[f64::NAN, 0.0]);
        assert_eq!(non_negative(&broken, &gradient).0, vec![0.0]);
    }

    #[test]
    fn a_gradient_within_a_cone_has_no_residual() {
        let columns = DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, 2.0]);
        let (found, residual) = non_negative(&columns, &DVector::from_vec(vec![3.0, 4.0]));
        assert!(
            residual < 1e-9 && (found[0] - 3.0).abs() < 1e-9 && (found[1] - 2.0).abs() < 1e-9,
            "{found:?}"
        );
        let (_, residual) = non_negative(&columns, &DVector::from_vec(vec![-1.0, 2.0]));
        assert!(
            (residual - 1.0).abs() < 1e-9,
            "outside the cone, its nearest edge is missed"
        );
    }
}
