//! An evolution strategy with covariance matrix adaptation (Hansen 2016), in the form with a Cholesky factor (Krause, Arbonès and
//! Igel 2016).

use crate::{Evaluated, Outcome};

/// A strategy has converged when its steps are smaller than this fraction of the ranges.
const SMALLEST_STEP: f64 = 1e-10;

/// A strategy whose steps are smaller than this fraction of the ranges is given up if its best candidate is not the best one.
const HOPELESS_STEP: f64 = 1e-4;

/// Largest violation that costs a penalty.
const SLIGHT: f64 = 0.2;

/// An evolution strategy in the unit cube.
#[derive(Debug, Clone)]
pub struct Strategy {
    pub mean: Vec<f64>,
    pub step: f64,
    /// Lower triangular factor of the covariance matrix.
    factor: Vec<Vec<f64>>,
    step_path: Vec<f64>,
    path: Vec<f64>,
    pub population: usize,
    /// Relative growth of the objective that a violation of 1 costs.
    penalty: f64,
    /// Standard normal vectors of the candidates of the current generation.
    pub normals: Vec<Vec<f64>>,
}

impl Strategy {
    /// Starts a strategy at a point of the unit cube.
    pub fn new(mean: Vec<f64>, step: f64, population: usize) -> Self {
        let count = mean.len();
        let row = |row: usize| (0..count).map(|column| f64::from(u8::from(row == column))).collect();
        Self {
            mean,
            step,
            factor: (0..count).map(row).collect(),
            step_path: vec![0.0; count],
            path: vec![0.0; count],
            population,
            penalty: 10.0,
            normals: Vec::new(),
        }
    }

    /// Returns the points of a generation, of which each follows from a standard normal vector.
    pub fn ask(&mut self, normals: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
        self.normals = normals;
        let point = |normal: &Vec<f64>| {
            let moved = |at: usize| self.mean[at] + self.step * dot(&self.factor[at][..=at], normal);
            (0..self.mean.len()).map(|at| reflected(moved(at))).collect()
        };
        self.normals.iter().map(point).collect()
    }

    /// Adapts mean, step and covariance to the ranking of the current generation.
    pub fn learn(&mut self, evaluated: &[Evaluated]) {
        let count = self.mean.len();
        if count == 0 {
            return;
        }
        let n = count as f64;
        let ranked = self.rank(evaluated);
        let parents = (evaluated.len() / 2).max(1);
        let raw = |place: usize| libm::log(parents as f64 + 0.5) - libm::log(place as f64 + 1.0);
        let total: f64 = (0..parents).map(raw).sum();
        let weights: Vec<f64> = (0..parents).map(|place| raw(place) / total).collect();
        let effective = 1.0 / weights.iter().map(|weight| weight * weight).sum::<f64>();
        // The standard parameters (Hansen 2016, table 1).
        let step_rate = (effective + 2.0) / (n + effective + 5.0);
        let damping = 1.0 + 2.0 * (libm::sqrt((effective - 1.0) / (n + 1.0)) - 1.0).max(0.0) + step_rate;
        let rate = (4.0 + effective / n) / (n + 4.0 + 2.0 * effective / n);
        let rank_one = 2.0 / ((n + 1.3) * (n + 1.3) + effective);
        let rank_many = (2.0 * (effective - 2.0 + 1.0 / effective) / ((n + 2.0) * (n + 2.0) + effective))
            .clamp(0.0, 1.0 - rank_one);
        let expected = libm::sqrt(n) * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));

        let mean_of = |k: usize| {
            let best = ranked.iter().zip(&weights);
            best.map(|(&i, weight)| weight * self.normals[i][k]).sum()
        };
        let mean_normal: Vec<f64> = (0..count).map(mean_of).collect();
        let moved = self.turned(&mean_normal);
        for (mean, by) in self.mean.iter_mut().zip(&moved) {
            *mean = reflected(*mean + self.step * by);
        }
        let gain = libm::sqrt(step_rate * (2.0 - step_rate) * effective);
        for (path, normal) in self.step_path.iter_mut().zip(&mean_normal) {
            *path = (1.0 - step_rate) * *path + gain * normal;
        }
        let length = libm::sqrt(dot(&self.step_path, &self.step_path));
        let is_short = length < (1.4 + 2.0 / (n + 1.0)) * expected;
        let gain = if is_short {
            libm::sqrt(rate * (2.0 - rate) * effective)
        } else {
            0.0
        };
        for (path, by) in self.path.iter_mut().zip(&moved) {
            *path = (1.0 - rate) * *path + gain * by;
        }
        let lost = if is_short { 0.0 } else { rank_one * rate * (2.0 - rate) };
        let kept = 1.0 - rank_one - rank_many + lost;
        let steps: Vec<Vec<f64>> = ranked[..parents]
            .iter()
            .map(|&i| self.turned(&self.normals[i]))
            .collect();
        let covariance = self.covariance([kept, rank_one, rank_many], &steps, &weights);
        if let Some(factor) = cholesky(&covariance) {
            self.factor = factor;
        }
        self.step *= libm::exp((step_rate / damping * (length / expected - 1.0)).min(1.0));
    }

    /// Returns the step of a standard normal vector, in units of the step size.
    fn turned(&self, normal: &[f64]) -> Vec<f64> {
        let at = |k: usize| dot(&self.factor[k][..=k], normal);
        (0..self.mean.len()).map(at).collect()
    }

    /// Returns the lower triangle of the covariance matrix after a generation, from shares of the matrix before, of the path, and of the
    /// steps of the better half with their weights.
    fn covariance(&self, shares: [f64; 3], steps: &[Vec<f64>], weights: &[f64]) -> Vec<Vec<f64>> {
        let [kept, rank_one, rank_many] = shares;
        let count = self.mean.len();
        let mut covariance = vec![vec![0.0; count]; count];
        for row in 0..count {
            for column in 0..=row {
                let before = dot(&self.factor[row][..=column], &self.factor[column][..=column]);
                let of_step = |(step, weight): (&Vec<f64>, &f64)| weight * step[row] * step[column];
                let many: f64 = steps.iter().zip(weights).map(of_step).sum();
                covariance[row][column] =
                    kept * before + rank_one * self.path[row] * self.path[column] + rank_many * many;
            }
        }
        covariance
    }

    /// Ranks candidates by the objective with its penalty, then those with a larger violation, and adapts the penalty so that a
    /// part of the better half is feasible.
    fn rank(&mut self, evaluated: &[Evaluated]) -> Vec<usize> {
        let penalty = self.penalty;
        let key = |outcome: &Outcome| {
            let violation = outcome.violation.max(0.0);
            let objective = outcome.objectives[0];
            if violation <= SLIGHT {
                (0.0, objective + penalty * violation * libm::fabs(objective))
            } else {
                (violation, objective)
            }
        };
        let mut ranked: Vec<usize> = (0..evaluated.len()).collect();
        ranked.sort_by(|&a, &b| {
            let ((tier_a, value_a), (tier_b, value_b)) = (key(&evaluated[a].outcome), key(&evaluated[b].outcome));
            tier_a.total_cmp(&tier_b).then(value_a.total_cmp(&value_b))
        });
        let better = &ranked[..ranked.len().div_ceil(2)];
        let feasible = better
            .iter()
            .filter(|&&place| evaluated[place].outcome.is_feasible())
            .count();
        let share = feasible as f64 / better.len() as f64;
        if share < 0.3 {
            self.penalty = (1.5 * self.penalty).min(1e9);
        } else if share > 0.8 {
            self.penalty = (self.penalty / 1.2).max(1e-3);
        }
        ranked
    }

    /// Returns whether the strategy has ended: its steps are very small, or small while a better candidate is known.
    pub fn is_over(&self, leads: bool) -> bool {
        let widest = self
            .factor
            .iter()
            .map(|row| libm::sqrt(dot(row, row)))
            .fold(0.0, f64::max);
        let smallest = if leads { SMALLEST_STEP } else { HOPELESS_STEP };
        self.step * widest < smallest || !self.step.is_finite() || self.mean.is_empty()
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |sum, (a, b)| sum + a * b)
}

/// Reflects a number at 0 and 1 until it lies between them.
pub fn reflected(value: f64) -> f64 {
    let turned = libm::fmod(libm::fabs(value), 2.0);
    if turned > 1.0 { 2.0 - turned } else { turned }
}

/// Returns the lower triangular factor of a symmetric matrix, of which the lower triangle is given; `None` if it is not positive
/// definite.
fn cholesky(matrix: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let count = matrix.len();
    let mut factor = vec![vec![0.0; count]; count];
    for row in 0..count {
        for column in 0..=row {
            let rest = matrix[row][column] - dot(&factor[row][..column], &factor[column][..column]);
            factor[row][column] = if row == column {
                let square = Some(rest).filter(|rest| *rest > 0.0 && rest.is_finite())?;
                libm::sqrt(square)
            } else {
                rest / factor[column][column]
            };
        }
    }
    Some(factor)
}
