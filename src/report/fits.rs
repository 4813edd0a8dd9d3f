//! How design variables go with `R_w` along a front: least-squares fits, and whether they only ever grow.

use nalgebra::{DMatrix, DVector};

use super::Front;
use kinefront_model::mechanism::{VARIABLES, Variable};
use crate::study::Bounds;

/// A polynomial in `R_w` fitted to a variable.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// Coefficients, the constant first \[m, 1, 1/m\].
    pub coefficients: Vec<f64>,
    /// Coefficient of determination: the share of the variable's variance that the fit explains.
    pub r_squared: f64,
}

impl Trend {
    /// Whether a parabola that opens upwards says clearly more than a line: it leaves at most half of what the line does.
    pub fn is_quadratic(&self) -> Option<bool> {
        let (line, parabola) = (self.linear.as_ref()?, self.quadratic.as_ref()?);
        Some(parabola.coefficients[2] > 0.0 && 1.0 - parabola.r_squared <= 0.5 * (1.0 - line.r_squared))
    }
}

impl Fit {
    /// The polynomial of a degree nearest to the points `(x, y)`; `None` where there are too few or too alike.
    pub fn new(points: &[[f64; 2]], degree: usize) -> Option<Self> {
        if points.len() <= degree + 1 {
            return None;
        }
        // Powers of x scaled to 1, so that they are of one size.
        let scale = points.iter().fold(0.0f64, |scale, point| scale.max(point[0].abs()));
        if scale <= 0.0 {
            return None;
        }
        let powers = DMatrix::from_fn(points.len(), degree + 1, |row, power| {
            libm::pow(points[row][0] / scale, power as f64)
        });
        let values = DVector::from_iterator(points.len(), points.iter().map(|point| point[1]));
        let solved = powers.clone().svd(true, true).solve(&values, 1e-12).ok()?;
        let mean = values.mean();
        let total: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
        let rest = (powers * &solved - &values).norm_squared();
        // A variable that does not vary is explained by its constant.
        let spread = 1e-9 * mean.abs().max(f64::MIN_POSITIVE);
        let constant = total <= spread * spread * points.len() as f64;
        let coefficients = solved.iter().enumerate();
        let fit = Self {
            coefficients: coefficients
                .map(|(power, value)| value / libm::pow(scale, power as f64))
                .collect(),
            r_squared: if constant { 1.0 } else { 1.0 - rest / total },
        };
        fit.coefficients.iter().all(|value| value.is_finite()).then_some(fit)
    }

    /// Its value at `x`.
    pub fn at(&self, x: f64) -> f64 {
        self.coefficients.iter().rev().fold(0.0, |sum, value| sum * x + value)
    }
}

/// How one variable goes with `R_w`.
#[derive(Debug, Clone)]
pub struct Trend {
    /// The variable.
    pub variable: Variable,
    /// `(R_w, value)` of the designs shown.
    pub points: Vec<[f64; 2]>,
    /// Those of them that stand at neither of the variable's bounds: what the fits are made of.
    pub free: Vec<[f64; 2]>,
    /// A straight line.
    pub linear: Option<Fit>,
    /// A parabola.
    pub quadratic: Option<Fit>,
    /// Spearman's rank correlation with `R_w`: 1 where the variable, off its bounds, only grows. `None` where it is
    /// hardly ever off its bounds.
    pub rank_correlation: Option<f64>,
}

/// Distance from a bound, as a share of a variable's range, within which the variable stands at it.
pub const AT_BOUND: f64 = 1e-3;

/// Fewest designs that say how a variable goes.
const FEWEST: usize = 4;

/// Trends of all five variables along a front found within `bounds`.
pub fn trends(front: &Front, bounds: &Bounds) -> Vec<Trend> {
    VARIABLES
        .into_iter()
        .map(|variable| {
            let points: Vec<[f64; 2]> = front
                .shown()
                .map(|member| [member.workspace_radius, member.design.values()[variable as usize]])
                .collect();
            // A variable that may not go on growing says nothing of how it would.
            let [lower, upper] = bounds.range(variable);
            let near = AT_BOUND * (upper - lower);
            let is_free = |point: &[f64; 2]| point[1] > lower + near && point[1] < upper - near;
            let free: Vec<[f64; 2]> = points.iter().copied().filter(is_free).collect();
            let fit = |degree: usize| Fit::new(&free, degree).filter(|_| free.len() >= FEWEST);
            Trend {
                variable,
                linear: fit(1),
                quadratic: fit(2),
                rank_correlation: (free.len() >= FEWEST).then(|| rank_correlation(&free)),
                points,
                free,
            }
        })
        .collect()
}

fn rank_correlation(points: &[[f64; 2]]) -> f64 {
    let [x, y] = [0, 1].map(|axis| ranks(points.iter().map(|point| point[axis]).collect()));
    let mean = (points.len() as f64 - 1.0) / 2.0;
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - mean) * (b - mean)).sum::<f64>();
    let size = libm::sqrt(product(&x, &x) * product(&y, &y));
    if size > 0.0 { product(&x, &y) / size } else { 0.0 }
}

/// Places in order of size; equals share the mean of theirs.
fn ranks(values: Vec<f64>) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut ranks = vec![0.0; values.len()];
    let mut first = 0;
    while first < order.len() {
        let equal = order[first..]
            .iter()
            .take_while(|&&place| values[place] == values[order[first]])
            .count();
        let mean = first as f64 + (equal as f64 - 1.0) / 2.0;
        for &place in &order[first..first + equal] {
            ranks[place] = mean;
        }
        first += equal;
    }
    ranks
}
