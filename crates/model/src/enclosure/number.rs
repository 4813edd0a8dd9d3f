//! Numbers of the formulas that are shared with the evaluation, enclosed over a box.

use std::ops::{Add, BitAnd, Div, Mul, Neg, Sub};

use super::{Interval, TaylorModel};
use crate::lanes::Real;

/// Part of its value by which a constant of a formula may differ from the exact one: the constants of a design are products and
/// quotients of few doubles.
const OF_CONSTANTS: f64 = 1.0 / (1u64 << 44) as f64;

/// A number of a formula over [`Real`], enclosed over a box: what the formula gives at a pose of the box lies within it.
///
/// Where the box does not decide a comparison, both results are enclosed, so that no branch is left out. Magnitudes, the larger of two
/// numbers and roots keep their slopes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnclosedNumber(pub TaylorModel);

/// Where a comparison holds on a box.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Comparison {
    /// At every pose.
    Always,
    /// At none.
    Never,
    /// It is not known.
    Unknown,
}

impl BitAnd for Comparison {
    type Output = Self;

    fn bitand(self, other: Self) -> Self {
        match (self, other) {
            (Comparison::Never, _) | (_, Comparison::Never) => Comparison::Never,
            (Comparison::Always, Comparison::Always) => Comparison::Always,
            _ => Comparison::Unknown,
        }
    }
}

impl EnclosedNumber {
    /// What is not known at all.
    const UNKNOWN: TaylorModel = TaylorModel {
        constant: f64::NAN,
        linear: [f64::NAN; 3],
        square: [f64::NAN; 3],
        mixed: [f64::NAN; 3],
        remainder: f64::NAN,
    };

    /// The polynomial alone, and the bound of the remainder.
    fn parts(self) -> (Self, f64) {
        let polynomial = TaylorModel {
            remainder: 0.0,
            ..self.0
        };
        (Self(polynomial), self.0.remainder)
    }

    /// Returns where the difference of the number and another one satisfies a condition, which holds above 0 and not below it.
    fn compared(self, other: Self, holds: impl Fn(f64) -> bool) -> Comparison {
        let difference = self.0 - other.0;
        let [lower, upper] = match difference.sure_sign() {
            Some(sign) => [sign; 2],
            None => difference.range(),
        };
        if holds(lower) {
            Comparison::Always
        } else if upper.is_nan() || holds(upper) {
            Comparison::Unknown
        } else {
            Comparison::Never
        }
    }

    /// Encloses what lies within a distance of the number.
    fn widened(self, by: f64) -> Self {
        if by.is_nan() {
            return Self(Self::UNKNOWN);
        }
        Self(self.0.plus(Interval::new(-by, by)))
    }

    /// Encloses the larger of the number and 0.
    fn or_zero(self) -> Self {
        let [lower, upper] = self.0.range();
        if lower >= 0.0 {
            return self;
        }
        if upper <= 0.0 {
            return Self(TaylorModel::exactly(0.0));
        }
        self.bent_at_zero([lower, upper], [0.0, upper])
    }

    /// Encloses a function of the number that vanishes at 0 and is linear on both sides of it, with the larger slope above 0; `values` are
    /// those at the ends of the range `[l, u]`, with `l < 0 < u`.
    ///
    /// With the slope `m` of the chord, which lies between those of both sides also if it is rounded, `f(x) − m x` lies between 0 and the
    /// larger of its values at the ends.
    fn bent_at_zero(self, [lower, upper]: [f64; 2], values: [f64; 2]) -> Self {
        let slope = (values[1] - values[0]) / (upper - lower);
        if !slope.is_finite() {
            return Self(Self::UNKNOWN);
        }
        let above_chord = |end: f64, value: f64| {
            let above = Interval::exactly(value) - Interval::exactly(slope) * Interval::exactly(end);
            above.upper()
        };
        let most = above_chord(lower, values[0]).max(above_chord(upper, values[1]));
        Self(self.0.times(slope).plus(Interval::new(0.0, most)))
    }

    /// Encloses the reciprocal.
    ///
    /// On `[l, u]` with `l > 0`, for every `s > 0`, `1/x + s x` is convex: it lies between `2√s` and the larger of its values at the
    /// ends.
    fn reciprocal(self) -> Self {
        let [lower, upper] = self.0.range();
        if upper < 0.0 {
            return -(-self).reciprocal();
        }
        if upper < 1.5 * lower {
            return Self(self.0.reciprocal());
        }
        let slope = 1.0 / (lower * upper);
        if !(lower > 0.0 && slope > 0.0 && slope.is_finite()) {
            return Self(Self::UNKNOWN);
        }
        let exactly = Interval::exactly;
        let at = |end: f64| exactly(1.0) / exactly(end) + exactly(slope) * exactly(end);
        let least = exactly(2.0) * exactly(slope).sqrt();
        let most = at(lower).upper().max(at(upper).upper());
        Self(self.0.times(-slope).plus(Interval::new(least.lower().min(most), most)))
    }
}

/// Encloses the inverse of a matrix, without the cancellation of its cofactors.
///
/// Let `Y` be the inverse in the middle of the box, however it is rounded, and `E = I − Y M`. Then `M⁻¹ = (I − E)⁻¹ Y`, which is
/// `(I + E + E²) Y + (I − E)⁻¹ E³ Y`. With positive weights `t`, `|E v|_i ≤ s t_i` for every `|v|_i ≤ t_i`, if `s` is the largest row
/// sum of `|E_ij| t_j/t_i`: an entry of the last term is at most `t_i/(1 − s) max_j (|E|³ |Y|)_jk/t_j`. A row of `E` that nearly vanishes
/// has a small weight, and a small row of `|E|³ |Y|`.
fn inverse(matrix: &[[EnclosedNumber; 3]; 3]) -> [[EnclosedNumber; 3]; 3] {
    const INDICES: [usize; 3] = [0, 1, 2];
    let unknown = [[EnclosedNumber(EnclosedNumber::UNKNOWN); 3]; 3];
    let middle = matrix.map(|row| row.map(|entry| entry.0.constant));
    let transposed = f64::inverse_transpose(&middle);
    let inverse = INDICES.map(|row| INDICES.map(|column| transposed[column][row]));
    let one = TaylorModel::exactly(1.0);
    let times = |row: &[f64; 3], column: usize, of: &dyn Fn(usize, usize) -> TaylorModel| {
        of(0, column).times(row[0]) + of(1, column).times(row[1]) + of(2, column).times(row[2])
    };
    let error = INDICES.map(|i| {
        INDICES.map(|k| {
            let product = times(&inverse[i], k, &|row, column| matrix[row][column].0);
            if i == k { one - product } else { -product }
        })
    });
    let size = error.map(|row| row.map(|entry| entry.largest()));
    let (weights, norm) = row_norm(&size);
    let contracts = norm < 1.0;
    if !contracts {
        return unknown;
    }
    // The factor covers the rounding of the bound itself.
    let rest = (1.0 + 1e-9) / (1.0 - norm);
    let grown = |column: [f64; 3]| size.map(|row| row[0] * column[0] + row[1] * column[1] + row[2] * column[2]);
    let series = INDICES.map(|i| {
        INDICES.map(|k| {
            let square = error[i][0] * error[0][k] + error[i][1] * error[1][k] + error[i][2] * error[2][k];
            let sum = error[i][k] + square;
            if i == k { one + sum } else { sum }
        })
    });
    INDICES.map(|i| {
        INDICES.map(|k| {
            let column = INDICES.map(|j| inverse[j][k]);
            let cube = grown(grown(grown(column.map(f64::abs))));
            let largest = INDICES.map(|j| cube[j] / weights[j]).into_iter().fold(0.0, f64::max);
            let bound = weights[i] * rest * largest;
            if !bound.is_finite() {
                return EnclosedNumber(EnclosedNumber::UNKNOWN);
            }
            let near = series[i][0].times(column[0]) + series[i][1].times(column[1]) + series[i][2].times(column[2]);
            EnclosedNumber(near.plus(Interval::new(-bound, bound)))
        })
    })
}

/// Returns positive weights with which the largest weighted row sum of a matrix without negative entries is small, near its spectral
/// radius, and that sum; NaN if an entry is.
fn row_norm(matrix: &[[f64; 3]; 3]) -> ([f64; 3], f64) {
    let sum = |row: &[f64; 3], weights: &[f64; 3]| row[0] * weights[0] + row[1] * weights[1] + row[2] * weights[2];
    let mut weights = [1.0; 3];
    for _ in 0..12 {
        let next = matrix.map(|row| sum(&row, &weights));
        let largest = next.into_iter().fold(0.0, f64::max);
        if !(largest > 0.0 && largest.is_finite()) {
            break;
        }
        // A weight that vanishes would divide by 0.
        weights = next.map(|weight| (weight / largest).max(1e-12));
    }
    let rows = [0, 1, 2].map(|i| sum(&matrix[i], &weights) / weights[i]);
    let is_known = rows.iter().all(|row| !row.is_nan());
    let norm = rows.into_iter().fold(0.0, f64::max);
    (weights, if is_known { norm * (1.0 + 1e-9) } else { f64::NAN })
}

impl Add for EnclosedNumber {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Sub for EnclosedNumber {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl Mul for EnclosedNumber {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0)
    }
}

impl Div for EnclosedNumber {
    type Output = Self;

    #[allow(
        clippy::suspicious_arithmetic_impl,
        reason = "a quotient is the product with a reciprocal"
    )]
    fn div(self, other: Self) -> Self {
        self * other.reciprocal()
    }
}

impl Neg for EnclosedNumber {
    type Output = Self;

    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Real for EnclosedNumber {
    type Mask = Comparison;

    /// Encloses a constant of which `value` is the nearest double but for a few roundings.
    fn splat(self, value: f64) -> Self {
        let radius = (value * OF_CONSTANTS).abs();
        Self(TaylorModel::constant(Interval::new(value - radius, value + radius)))
    }

    /// Encloses the square root of a number of which it is known that it is not negative.
    ///
    /// On `[l, u]` with `l ≥ 0`, for every `s > 0`, `√x − s x` is concave: it lies between the smaller of its values at the ends and
    /// `1/(4s)`.
    fn sqrt(self) -> Self {
        let [lower, upper] = self.0.range();
        if lower.is_nan() || upper.is_nan() {
            return Self(Self::UNKNOWN);
        }
        if upper < 1.5 * lower {
            return Self(self.0.sqrt());
        }
        let (lower, upper) = (lower.max(0.0), upper.max(f64::MIN_POSITIVE));
        let slope = 1.0 / (lower.sqrt() + upper.sqrt());
        let exactly = Interval::exactly;
        let at = |end: f64| exactly(end).sqrt() - exactly(slope) * exactly(end);
        let least = at(lower).lower().min(at(upper).lower());
        let most = exactly(1.0) / (exactly(4.0) * exactly(slope));
        Self(
            self.0
                .times(slope)
                .plus(Interval::new(least.min(most.upper()), most.upper())),
        )
    }

    fn abs(self) -> Self {
        if let Some(sign) = self.0.sure_sign() {
            return if sign > 0.0 { self } else { -self };
        }
        // `||x| − |y|| ≤ |x − y|`: the remainder is not counted twice.
        let (polynomial, remainder) = self.parts();
        let [lower, upper] = polynomial.0.range();
        if lower >= 0.0 {
            self
        } else if upper <= 0.0 {
            -self
        } else {
            let magnitude = polynomial.bent_at_zero([lower, upper], [-lower, upper]);
            magnitude.widened(remainder)
        }
    }

    fn magnitude_bound(self) -> Self {
        let largest = self.0.largest();
        if largest.is_nan() {
            return Self(Self::UNKNOWN);
        }
        Self(TaylorModel::exactly(largest))
    }

    fn known_to_be(self, value: f64) -> Self {
        Self(TaylorModel::exactly(value))
    }

    fn at_least(self, other: Self) -> Comparison {
        self.compared(other, |difference| difference >= 0.0)
    }

    fn exceeds(self, other: Self) -> Comparison {
        self.compared(other, |difference| difference > 0.0)
    }

    fn select(self, mask: Comparison, other: Self) -> Self {
        match mask {
            Comparison::Always => self,
            Comparison::Never => other,
            Comparison::Unknown => {
                // Both lie within half of their difference about their mean.
                let half = (self.0 - other.0).times(0.5).largest();
                Self((self.0 + other.0).times(0.5)).widened(half)
            }
        }
    }

    fn symmetric_inverse(&[a, b, c, d, e, f]: &[Self; 6]) -> [Self; 6] {
        let [first, second, third] = inverse(&[[a, b, c], [b, d, e], [c, e, f]]);
        [first[0], first[1], first[2], second[1], second[2], third[2]]
    }

    fn inverse_transpose(rows: &[[Self; 3]; 3]) -> [[Self; 3]; 3] {
        let inverse = inverse(rows);
        [0, 1, 2].map(|column| [0, 1, 2].map(|row| inverse[row][column]))
    }

    fn any(mask: Comparison) -> bool {
        mask != Comparison::Never
    }

    fn smaller(self, other: Self) -> Self {
        match self.exceeds(other) {
            Comparison::Always => other,
            Comparison::Never => self,
            Comparison::Unknown => -(-self).larger(-other),
        }
    }

    fn larger(self, other: Self) -> Self {
        match self.exceeds(other) {
            Comparison::Always => self,
            Comparison::Never => other,
            Comparison::Unknown => {
                // `|max(x, y) − max(p, q)|` is at most the larger of `|x − p|` and `|y − q|`: remainders do not add up.
                let ((first, of_first), (second, of_second)) = (self.parts(), other.parts());
                // The function max passes over NaN, a sum does not.
                let larger = of_first + of_second - of_first.min(of_second);
                (second + (first - second).or_zero()).widened(larger)
            }
        }
    }
}
