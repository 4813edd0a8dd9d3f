//! Trends of the design variables with an objective along a front: least-squares fits and rank correlations.

use nalgebra::{DMatrix, DVector};

use super::Front;
use kinefront_model::evaluation::{Evaluation, Quantity};
use kinefront_model::mechanism::{DESIGN_VARIABLES, DesignVariable};
use kinefront_study::Bounds;

/// A polynomial in an objective fitted to a design variable.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// Coefficients, starting with the constant.
    pub coefficients: Vec<f64>,
    /// Coefficient of determination: the fraction of the variable's variance that the fit explains.
    pub r_squared: f64,
}

impl Trend {
    /// Returns whether a parabola that opens upwards fits clearly better than a straight line: its residual variance
    /// is at most half of that of the line. Returns `None` if there is no fit.
    pub fn is_quadratic(&self) -> Option<bool> {
        let (line, parabola) = (self.linear.as_ref()?, self.quadratic.as_ref()?);
        Some(parabola.coefficients[2] > 0.0 && 1.0 - parabola.r_squared <= 0.5 * (1.0 - line.r_squared))
    }
}

impl Fit {
    /// Fits a polynomial of the given degree to the points `(x, y)` by least squares; returns `None` if there are too
    /// few points or the fit is degenerate.
    pub fn new(points: &[[f64; 2]], degree: usize) -> Option<Self> {
        if points.len() <= degree + 1 {
            return None;
        }
        // Scaling x to at most 1 gives all powers a similar magnitude.
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
        // The constant alone explains a variable that does not vary; the quotient would divide by zero.
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

    /// Returns the value of the polynomial at `x`.
    pub fn at(&self, x: f64) -> f64 {
        self.coefficients.iter().rev().fold(0.0, |sum, value| sum * x + value)
    }
}

/// Trend of one design variable with an objective.
#[derive(Debug, Clone)]
pub struct Trend {
    /// The variable.
    pub variable: DesignVariable,
    /// Objective and value of the shown designs of the front.
    pub points: Vec<[f64; 2]>,
    /// The points at which the variable is at neither of its bounds; only these are fitted.
    pub free: Vec<[f64; 2]>,
    /// Straight line fitted to the free points.
    pub linear: Option<Fit>,
    /// Parabola fitted to the free points.
    pub quadratic: Option<Fit>,
    /// Spearman's rank correlation with the objective over the free points: 1 if the variable increases monotonically. `None`
    /// if there are too few free points.
    pub rank_correlation: Option<f64>,
}

/// Distance from a bound, as a fraction of the variable's range, within which the variable counts as being at the
/// bound.
pub const AT_BOUND: f64 = 1e-3;

/// Smallest number of free points from which a trend is determined.
const FEWEST: usize = 4;

/// Determines the trends of all five design variables with a quantity along a front found within `bounds`.
pub fn trends(front: &Front, bounds: &Bounds, quantity: Quantity) -> Vec<Trend> {
    DESIGN_VARIABLES
        .into_iter()
        .map(|variable| {
            let place = |member: &Evaluation| {
                let along = member.quantities.get(quantity)?;
                Some([along, member.design.values()[variable as usize]])
            };
            let points: Vec<[f64; 2]> = front.shown().filter_map(place).collect();
            // At a bound the value is fixed by the bound and does not show the trend.
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

/// Returns the ranks of the values in ascending order; equal values get the mean of their ranks.
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
