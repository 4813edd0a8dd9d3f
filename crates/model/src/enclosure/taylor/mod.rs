//! Polynomials of degree 2 with a remainder, which enclose a function on a box.

mod bounds;

use std::ops::{Add, Mul, Neg, Sub};

use super::Interval;

/// Number of variables of a box.
pub const VARIABLES: usize = 3;

/// Pairs of different variables, in the order of the mixed coefficients.
const PAIRS: [[usize; 2]; 3] = [[0, 1], [0, 2], [1, 2]];

/// Unit roundoff `u` of a double.
const ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// A function on the box `ε ∈ [−1, 1]³`, enclosed by a polynomial of degree 2 and a remainder:
///
/// ```text
/// f(ε) ∈ c + Σ a_i ε_i + Σ b_ii ε_i² + Σ_{i<j} b_ij ε_i ε_j ± e
/// ```
///
/// Let `u = 2⁻⁵³`, `A = Σ|a|`, `B = Σ|b|`, and `M = |c| + A + B` the largest absolute value of the polynomial.
///
/// **Rounding.** A coefficient of a result is a sum of at most 6 products of coefficients. Computed in doubles, it differs from
/// its exact value by at most `6u/(1 − 6u)` times the sum of the absolute values of these products. The sum over all
/// coefficients of a result of these absolute values is at most the magnitude that each operation states: `M₁ + M₂` for
/// a sum, `M₁ M₂` for a product. The remainder therefore grows by `16u` times this magnitude, which covers that the magnitude
/// itself is rounded. The remainder is a sum of at most 12 terms that are not negative, so that the factor `1 + 32u` covers its own
/// rounding. Underflow is covered by the smallest normal number that every operation adds.
///
/// **No number.** Where a value overflows or does not exist, coefficients become infinite or NaN. Every comparison with NaN is
/// false, so that nothing is proved from it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TaylorModel {
    /// Value in the middle of the box.
    pub constant: f64,
    /// Linear coefficients.
    pub linear: [f64; VARIABLES],
    /// Coefficients of the squares.
    pub square: [f64; VARIABLES],
    /// Coefficients of the products of different variables.
    pub mixed: [f64; 3],
    /// Bound of the remainder.
    pub remainder: f64,
}

/// Returns a bound of the remainder: the sum of its terms, increased for its own rounding and for that of coefficients whose
/// absolute values sum to at most `magnitude`.
#[inline(always)]
fn remainder(sum: f64, magnitude: f64) -> f64 {
    (sum + 16.0 * ROUNDOFF * magnitude) * (1.0 + 32.0 * ROUNDOFF) + f64::MIN_POSITIVE
}

impl TaylorModel {
    /// A constant.
    pub fn constant(value: Interval) -> Self {
        let (constant, remainder) = value.middle_and_radius();
        Self {
            constant,
            linear: [0.0; VARIABLES],
            square: [0.0; VARIABLES],
            mixed: [0.0; 3],
            remainder,
        }
    }

    /// The number that a double is.
    pub fn exactly(value: f64) -> Self {
        Self::constant(Interval::exactly(value))
    }

    /// The variable `index` over the interval `middle ± radius`.
    pub fn variable(index: usize, middle: f64, radius: f64) -> Self {
        let mut model = Self::exactly(middle);
        model.linear[index] = radius;
        model
    }

    /// Sine and cosine of the variable `index` over the interval `middle ± radius`.
    ///
    /// By Taylor's theorem, `sin(m + hε) = sin m + h cos m ε − ½h² sin m ε² ± h³/6`, and likewise for the cosine. The sine and the
    /// cosine of the middle are intervals, whose radii enter the remainder.
    pub fn sine_and_cosine(index: usize, middle: f64, radius: f64) -> (Self, Self) {
        let (sine, cosine) = Interval::exactly(middle).sine_and_cosine();
        let (sine, sine_radius) = sine.middle_and_radius();
        let (cosine, cosine_radius) = cosine.middle_and_radius();
        let half_square = 0.5 * radius * radius;
        let series = |value: f64, value_radius: f64, slope: f64, slope_radius: f64| {
            let mut model = Self::exactly(value);
            model.linear[index] = radius * slope;
            model.square[index] = -half_square * value;
            let rest = value_radius * (1.0 + half_square) + radius * slope_radius + radius * radius * radius / 6.0;
            model.remainder = remainder(rest, 1.0 + radius + half_square);
            model
        };
        (
            series(sine, sine_radius, cosine, cosine_radius),
            series(cosine, cosine_radius, -sine, sine_radius),
        )
    }

    /// Sine and cosine of an angle that is enclosed itself.
    ///
    /// With `x = c + d`, Taylor's theorem gives `sin x = sin c + d cos c − ½d² sin c ± |d|³/6`, and likewise for the cosine.
    pub fn sine_and_cosine_of(&self) -> (Self, Self) {
        let (sine, cosine) = Interval::exactly(self.constant).sine_and_cosine();
        let rest = Self { constant: 0.0, ..*self };
        let half_square = rest.squared().times(0.5);
        let [lower, upper] = rest.range();
        let far = Interval::exactly(upper.max(-lower));
        let most = (far * far * far / Interval::exactly(6.0)).upper();
        let off = Interval::new(-most, most);
        (
            (rest.scaled(cosine) - half_square.scaled(sine)).plus(sine + off),
            (-rest.scaled(sine) - half_square.scaled(cosine)).plus(cosine + off),
        )
    }

    /// `A = Σ|a|`.
    #[inline(always)]
    fn linear_size(&self) -> f64 {
        self.linear[0].abs() + self.linear[1].abs() + self.linear[2].abs()
    }

    /// `B = Σ|b|`.
    #[inline(always)]
    fn quadratic_size(&self) -> f64 {
        let sum = |terms: &[f64; 3]| terms[0].abs() + terms[1].abs() + terms[2].abs();
        sum(&self.square) + sum(&self.mixed)
    }

    /// `M = |c| + A + B`.
    #[inline(always)]
    fn size(&self) -> f64 {
        self.constant.abs() + self.linear_size() + self.quadratic_size()
    }

    /// Returns the polynomial of which each coefficient is a function of one of this, with a remainder.
    #[inline(always)]
    fn mapped(&self, of: impl Fn(f64) -> f64, remainder: f64) -> Self {
        Self {
            constant: of(self.constant),
            linear: self.linear.map(&of),
            square: self.square.map(&of),
            mixed: self.mixed.map(&of),
            remainder,
        }
    }

    /// Returns the square; its products are those of a multiplication.
    #[inline]
    pub fn squared(&self) -> Self {
        *self * *self
    }

    /// Multiplies by a double, which is a power of 2 or rounds like any factor.
    #[inline]
    pub fn times(&self, factor: f64) -> Self {
        let size = self.size() * factor.abs();
        self.mapped(|part| part * factor, remainder(self.remainder * factor.abs(), size))
    }

    /// Multiplies by `factor ± radius`, where `size` is that of `self`.
    #[inline]
    fn multiple(&self, factor: f64, radius: f64, size: f64) -> Self {
        let carried = self.remainder * (factor.abs() + radius) + radius * size;
        self.mapped(|part| part * factor, remainder(carried, size * factor.abs()))
    }

    /// Multiplies by a constant.
    #[inline]
    pub fn scaled(&self, factor: Interval) -> Self {
        // Multiples of lengths are often exactly 1, and nothing is rounded then.
        if factor == Interval::exactly(1.0) {
            return *self;
        }
        let (middle, radius) = factor.middle_and_radius();
        let mut product = self.times(middle);
        product.remainder = remainder(product.remainder + radius * (self.size() + self.remainder), 0.0);
        product
    }

    /// Adds a constant.
    #[inline]
    pub fn plus(&self, constant: Interval) -> Self {
        *self + Self::constant(constant)
    }

    /// Returns the reciprocal; NaN unless the range lies in `(0, 2c)`.
    ///
    /// With `q ≈ 1/c` and `t = 1 − q x`, whatever the rounding of `q`, `1/x = q/(1 − t) = q (1 + t + t² + t³/(1 − t))`, where
    /// `|t³/(1 − t)| ≤ s³/(1 − s)` for `|t| ≤ s < 1`.
    pub fn reciprocal(&self) -> Self {
        let q = 1.0 / self.constant;
        let t = Self::exactly(1.0) - self.times(q);
        let s = t.largest();
        if !(s < 1.0 && q > 0.0) {
            return Self::exactly(f64::NAN);
        }
        let mut sum = Self::exactly(1.0) + t + t.squared();
        sum.remainder = remainder(sum.remainder + s * s * s / (1.0 - s), 0.0);
        sum.times(q)
    }

    /// Returns the square root; NaN unless the range lies in `(0, 2c)`.
    ///
    /// With `q ≈ 1/c` and `t = q x − 1`, `√x = √(1 + t)/√q`. By Taylor's theorem `√(1 + t) = 1 + t/2 − t²/8 + t³/(16 (1 + ξ)^{5/2})` with `ξ`
    /// between 0 and `t`, so that the last term is at most `s³/(16 (1 − s)^{5/2})` for `|t| ≤ s < 1`.
    pub fn sqrt(&self) -> Self {
        let q = 1.0 / self.constant;
        let t = self.times(q) - Self::exactly(1.0);
        let s = t.largest();
        if !(s < 1.0 && q > 0.0) {
            return Self::exactly(f64::NAN);
        }
        let mut sum = Self::exactly(1.0) + t.times(0.5) - t.squared().times(0.125);
        let rest = 1.0 - s;
        sum.remainder = remainder(sum.remainder + s * s * s / (16.0 * rest * rest * rest.sqrt()), 0.0);
        let root = Interval::exactly(1.0) / Interval::exactly(q).sqrt();
        sum.scaled(root)
    }

    /// Returns the value of the polynomial at `ε`, in plain doubles.
    pub fn value(&self, epsilon: [f64; VARIABLES]) -> f64 {
        let mut sum = self.constant;
        for k in 0..VARIABLES {
            sum += epsilon[k] * (self.linear[k] + epsilon[k] * self.square[k]);
        }
        for (&b, [i, j]) in self.mixed.iter().zip(PAIRS) {
            sum += b * epsilon[i] * epsilon[j];
        }
        sum
    }
}

impl Add for TaylorModel {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        let add = |a: [f64; 3], b: [f64; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
        Self {
            constant: self.constant + other.constant,
            linear: add(self.linear, other.linear),
            square: add(self.square, other.square),
            mixed: add(self.mixed, other.mixed),
            remainder: remainder(self.remainder + other.remainder, self.size() + other.size()),
        }
    }
}

impl Neg for TaylorModel {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        self.mapped(|part| -part, self.remainder)
    }
}

impl Sub for TaylorModel {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for TaylorModel {
    type Output = Self;

    /// Products up to degree 2 are kept. The others are at most `A₁B₂ + A₂B₁ + B₁B₂`, because `|ε| ≤ 1`, and the products
    /// with a remainder at most `e₁(M₂ + e₂) + e₂M₁`.
    #[inline]
    fn mul(self, other: Self) -> Self {
        let (c, d) = (self.constant, other.constant);
        let (a, b) = (&self.linear, &other.linear);
        let (a1, b1) = (self.linear_size(), self.quadratic_size());
        let (a2, b2) = (other.linear_size(), other.quadratic_size());
        // Lengths of bars are often constants, whose products are simpler and the same.
        if a1 + b1 == 0.0 {
            return other.multiple(c, self.remainder, d.abs() + a2 + b2);
        }
        if a2 + b2 == 0.0 {
            return self.multiple(d, other.remainder, c.abs() + a1 + b1);
        }
        let mut product = Self::exactly(c * d);
        for k in 0..VARIABLES {
            product.linear[k] = c * b[k] + a[k] * d;
            product.square[k] = c * other.square[k] + self.square[k] * d + a[k] * b[k];
        }
        for (k, [i, j]) in PAIRS.into_iter().enumerate() {
            product.mixed[k] = c * other.mixed[k] + self.mixed[k] * d + a[i] * b[j] + a[j] * b[i];
        }
        let (m1, m2) = (c.abs() + a1 + b1, d.abs() + a2 + b2);
        let dropped = a1 * b2 + a2 * b1 + b1 * b2;
        let carried = self.remainder * (m2 + other.remainder) + other.remainder * m1;
        product.remainder = remainder(dropped + carried, m1 * m2);
        product
    }
}
