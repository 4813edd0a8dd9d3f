//! Bounds of the values of a polynomial with a remainder, its sign, and where it is least.

use super::{PAIRS, ROUNDOFF, TaylorModel, VARIABLES, remainder};

impl TaylorModel {
    /// Returns a bound of the absolute value.
    pub(in super::super) fn largest(&self) -> f64 {
        let [lower, upper] = self.range();
        if lower.is_nan() || upper.is_nan() {
            return f64::NAN;
        }
        upper.abs().max(lower.abs())
    }

    /// Returns an interval that contains all values: for each variable the exact range of its linear and square terms, for the
    /// mixed terms their absolute values.
    pub fn range(&self) -> [f64; 2] {
        let (mut lower, mut upper) = (self.constant, self.constant);
        for (&a, &b) in self.linear.iter().zip(&self.square) {
            let [low, high] = quadratic_range(a, b);
            lower += low;
            upper += high;
        }
        let mixed: f64 = self.mixed[0].abs() + self.mixed[1].abs() + self.mixed[2].abs();
        let slack = remainder(self.remainder + mixed, 2.0 * self.size());
        [lower - slack, upper + slack]
    }

    /// Returns the sign that all values have, where few operations tell it; with NaN, none.
    #[inline]
    pub fn sure_sign(&self) -> Option<f64> {
        // The factor covers the rounding of the coefficients and of the sum.
        let others = self.linear_size() + self.quadratic_size() + self.remainder;
        let is_sure = self.constant.abs() > others * (1.0 + 64.0 * ROUNDOFF) + 64.0 * ROUNDOFF * self.constant.abs();
        is_sure.then(|| self.constant.signum())
    }

    /// Whether every value is above 0. A comparison with NaN is false, so that nothing is proved from it.
    pub fn is_positive(&self) -> bool {
        // Where it is not so in the middle, squares do not help.
        self.range()[0] > 0.0 || (self.constant > self.remainder && self.least_by_squares() > 0.0)
    }

    /// Whether every value is below 0; not so with NaN.
    pub fn is_negative(&self) -> bool {
        self.range()[1] < 0.0
    }

    /// Returns a lower bound that is better than that of the range where the polynomial is nearly constant along a direction in which several
    /// variables change; NaN where no number is known.
    ///
    /// With `b_k > 0`, `b_k ε_k² + (a_k + Σ b_kj ε_j) ε_k ≥ −(a_k + Σ b_kj ε_j)²/(4 b_k)`, whatever `ε_k` is: a square is left out, and what
    /// remains is a polynomial of the other variables. Variables are left out in turn, and the best of all bounds counts. `slack` covers the
    /// rounding of the coefficients, as [`TaylorModel`] explains.
    fn least_by_squares(&self) -> f64 {
        /// A vertex farther outside the box, as a multiple of its half width, makes a square too large to be left out.
        const FAR: f64 = 4.0;
        let mut rest = *self;
        let mut best = f64::NEG_INFINITY;
        let mut slack = 0.0;
        for _ in 0..VARIABLES {
            let is_curved = |k: &usize| rest.square[*k] > 0.0 && rest.linear[*k].abs() <= 2.0 * FAR * rest.square[*k];
            let coupled = |k: usize| -> f64 {
                let with = PAIRS.iter().zip(&rest.mixed).filter(|(pair, _)| pair.contains(&k));
                with.map(|(_, b)| b.abs()).sum()
            };
            let Some(k) = (0..VARIABLES)
                .filter(is_curved)
                .max_by(|i, j| coupled(*i).total_cmp(&coupled(*j)))
            else {
                break;
            };
            slack += rest.leave_out(k);
            let lower = rest.range()[0] - slack;
            if lower.is_nan() {
                return f64::NAN;
            }
            best = best.max(lower);
        }
        best
    }

    /// Leaves out the square of a variable with a positive coefficient; returns a bound of the rounding errors of all coefficients together.
    fn leave_out(&mut self, k: usize) -> f64 {
        let (per, a) = (0.25 / self.square[k], self.linear[k]);
        let with = |j: usize| {
            PAIRS
                .iter()
                .position(|pair| pair.contains(&k) && pair.contains(&j) && j != k)
        };
        let coupling = [0, 1, 2].map(|j| with(j).map_or(0.0, |pair| self.mixed[pair]));
        let mut magnitude = self.size();
        let mut less = |value: &mut f64, by: f64| {
            *value -= by;
            magnitude += 2.0 * by.abs();
        };
        less(&mut self.constant, per * a * a);
        for j in 0..VARIABLES {
            less(&mut self.linear[j], 2.0 * per * a * coupling[j]);
            less(&mut self.square[j], per * coupling[j] * coupling[j]);
        }
        for (value, [i, j]) in self.mixed.iter_mut().zip(PAIRS) {
            less(value, 2.0 * per * coupling[i] * coupling[j]);
        }
        (self.linear[k], self.square[k]) = (0.0, 0.0);
        for (value, pair) in self.mixed.iter_mut().zip(PAIRS) {
            if pair.contains(&k) {
                *value = 0.0;
            }
        }
        16.0 * ROUNDOFF * magnitude
    }

    /// Returns a lower bound of the polynomial and the remainder without the terms of the variable `index` alone.
    pub fn least_without(&self, index: usize) -> f64 {
        let mut rest = *self;
        rest.linear[index] = 0.0;
        rest.square[index] = 0.0;
        // The terms left out were part of the magnitude that covers rounding.
        rest.range()[0] - 32.0 * ROUNDOFF * self.size()
    }

    /// Returns a point near the least value of the polynomial, in plain doubles: each variable in turn takes its best place.
    pub fn least_point(&self) -> [f64; VARIABLES] {
        let mut epsilon = [0.0; VARIABLES];
        for _ in 0..2 {
            for k in 0..VARIABLES {
                let mut slope = self.linear[k];
                for (&b, [i, j]) in self.mixed.iter().zip(PAIRS) {
                    if i == k {
                        slope += b * epsilon[j];
                    } else if j == k {
                        slope += b * epsilon[i];
                    }
                }
                epsilon[k] = least_of_quadratic(slope, self.square[k]);
            }
        }
        epsilon
    }
}

/// Returns the range of `a ε + b ε²` over `[−1, 1]`, as computed in doubles.
#[inline(always)]
fn quadratic_range(a: f64, b: f64) -> [f64; 2] {
    let (mut low, mut high) = (b - a.abs(), b + a.abs());
    // The vertex lies inside.
    if a.abs() < 2.0 * b.abs() {
        // |a/b| < 2, so that nothing underflows that is not negligible.
        let vertex = -0.25 * a * (a / b);
        low = low.min(vertex);
        high = high.max(vertex);
    }
    [low, high]
}

fn least_of_quadratic(a: f64, b: f64) -> f64 {
    if b > 0.0 {
        (-a / (2.0 * b)).clamp(-1.0, 1.0)
    } else if a > 0.0 {
        -1.0
    } else {
        1.0
    }
}
