//! Intervals with outward rounding, for the constants of an enclosure.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A closed interval that contains a real number.
///
/// Each operation rounds its ends outwards by one place. IEEE 754 rounds sums, products, quotients and square roots to
/// nearest, so that the exact result lies between the neighbours of the computed one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    lower: f64,
    upper: f64,
}

impl Interval {
    /// π: the nearest double lies below it.
    pub const PI: Interval = Interval {
        lower: std::f64::consts::PI,
        upper: f64::from_bits(std::f64::consts::PI.to_bits() + 1),
    };

    /// The numbers between two doubles; where either is not a number, nothing is known.
    pub fn new(lower: f64, upper: f64) -> Self {
        debug_assert!(
            lower <= upper || lower.is_nan() || upper.is_nan(),
            "the lower end {lower} lies above the upper end {upper}"
        );
        Self { lower, upper }
    }

    /// Lower end.
    #[inline]
    pub const fn lower(self) -> f64 {
        self.lower
    }

    /// Upper end.
    #[inline]
    pub const fn upper(self) -> f64 {
        self.upper
    }

    /// The number that a double is.
    pub const fn exactly(number: f64) -> Self {
        Self {
            lower: number,
            upper: number,
        }
    }

    fn outwards(lower: f64, upper: f64) -> Self {
        Self {
            lower: lower.next_down(),
            upper: upper.next_up(),
        }
    }

    /// Returns √3.
    pub fn sqrt_3() -> Self {
        Self::exactly(3.0).sqrt()
    }

    /// Returns an angle in degrees in radians.
    pub fn radians(degrees: f64) -> Self {
        Self::exactly(degrees) * Self::PI / Self::exactly(180.0)
    }

    /// Returns the square root of an interval of numbers that are not negative; NaN otherwise.
    pub fn sqrt(self) -> Self {
        let root = Self::outwards(self.lower.sqrt(), self.upper.sqrt());
        Self {
            lower: if root.lower < 0.0 { 0.0 } else { root.lower },
            ..root
        }
    }

    /// Returns the middle, and a radius with which it covers the interval.
    pub fn middle_and_radius(self) -> (f64, f64) {
        let middle = 0.5 * (self.lower + self.upper);
        let radius = (self.upper - middle).max(middle - self.lower);
        (middle, if radius == 0.0 { 0.0 } else { radius.next_up() })
    }

    /// Returns sine and cosine of every number of the interval, from their power series about the nearest multiple of
    /// π/2.
    ///
    /// The series alternates with decreasing terms there, so that the remainder is at most the first term left out.
    pub fn sine_and_cosine(self) -> (Self, Self) {
        let half_pi = Self::PI / Self::exactly(2.0);
        let turns = (0.5 * (self.lower + self.upper) / half_pi.lower).round();
        let x = self - Self::exactly(turns) * half_pi;
        let square = x.square();
        let (sine, cosine) = (x * series(square, 1), series(square, 0));
        match turns.rem_euclid(4.0) as u8 {
            0 => (sine, cosine),
            1 => (cosine, -sine),
            2 => (-sine, -cosine),
            _ => (-cosine, sine),
        }
    }

    /// Returns the squares of the numbers of the interval, which are not negative.
    pub fn square(self) -> Self {
        let product = self * self;
        Self {
            lower: product.lower.max(0.0),
            ..product
        }
    }

    /// Returns the larger of two numbers.
    pub(crate) fn max(self, other: Self) -> Self {
        Self::new(self.lower.max(other.lower), self.upper.max(other.upper))
    }

    /// Returns the smaller of two numbers.
    pub(crate) fn min(self, other: Self) -> Self {
        Self::new(self.lower.min(other.lower), self.upper.min(other.upper))
    }
}

/// Sums `Σ (−1)^k s^k / (2k + first)!`, which is the cosine of `√s` for `first` = 0, and its sine over `√s` for 1, for `s` up to 0.7.
///
/// In the middle `s` of the interval, Horner's scheme `p ← 1 − (s/c) p` with `0 ≤ p ≤ 1` and `s/c ≤ 0.35` rounds three times: to `s/c`,
/// to the product, and to the difference. With `u` the unit roundoff, its error `e` obeys `e ← 0.35 e + 2 · 0.35 u + u` and stays
/// below `3u`. The slope of the sums in `s` is at most 1/2.
fn series(square: Interval, first: u32) -> Interval {
    /// The first term left out is below 1e-25.
    const TERMS: u32 = 12;
    let (middle, radius) = square.middle_and_radius();
    if !(-0.1..0.7).contains(&middle) {
        return Interval::exactly(f64::NAN);
    }
    let mut sum = 1.0;
    for k in (1..=TERMS).rev() {
        let last = f64::from(2 * k + first);
        sum = 1.0 - middle / ((last - 1.0) * last) * sum;
    }
    let error = 2.0 * f64::EPSILON + 0.5 * radius + 1e-24;
    Interval::outwards(sum - error, sum + error)
}

impl Add for Interval {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::outwards(self.lower + other.lower, self.upper + other.upper)
    }
}

impl Sub for Interval {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self::outwards(self.lower - other.upper, self.upper - other.lower)
    }
}

impl Neg for Interval {
    type Output = Self;

    fn neg(self) -> Self {
        Self {
            lower: -self.upper,
            upper: -self.lower,
        }
    }
}

impl Mul for Interval {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        hull([
            self.lower * other.lower,
            self.lower * other.upper,
            self.upper * other.lower,
            self.upper * other.upper,
        ])
    }
}

impl Div for Interval {
    type Output = Self;

    /// The divisor must not contain 0; the result is NaN otherwise.
    fn div(self, other: Self) -> Self {
        if other.lower <= 0.0 && other.upper >= 0.0 {
            return Self::exactly(f64::NAN);
        }
        hull([
            self.lower / other.lower,
            self.lower / other.upper,
            self.upper / other.lower,
            self.upper / other.upper,
        ])
    }
}

/// Returns the interval of the results at the corners, rounded outwards. A NaN among them makes both ends NaN.
fn hull(corners: [f64; 4]) -> Interval {
    let [first, ..] = corners;
    let (mut lower, mut upper) = (first, first);
    for corner in corners {
        if corner.is_nan() {
            return Interval::exactly(f64::NAN);
        }
        lower = lower.min(corner);
        upper = upper.max(corner);
    }
    Interval::outwards(lower, upper)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The values of the library differ from the exact ones by less than one place.
    #[test]
    fn sine_and_cosine_are_enclosed() {
        for k in -4000..4000 {
            let x = f64::from(k) * 0.001_7;
            let (sine, cosine) = Interval::exactly(x).sine_and_cosine();
            for (found, expected) in [(sine, libm::sin(x)), (cosine, libm::cos(x))] {
                assert!(
                    found.lower <= expected.next_up() && found.upper >= expected.next_down(),
                    "{x}: {found:?}"
                );
                assert!(found.upper - found.lower < 1e-14, "{x}: {found:?}");
            }
            let one = sine.square() + cosine.square();
            assert!(one.lower <= 1.0 && one.upper >= 1.0);
        }
    }

    #[test]
    fn operations_round_outwards() {
        let third = Interval::exactly(1.0) / Interval::exactly(3.0);
        assert!(third.lower < third.upper);
        let one = third * Interval::exactly(3.0);
        assert!(one.lower < 1.0 && one.upper > 1.0);
        let root = Interval::sqrt_3();
        assert!(root.lower * root.lower < 3.0 && root.upper * root.upper > 3.0);
        assert!((Interval::exactly(1.0) / Interval::new(-1.0, 1.0)).lower.is_nan());
        // sin(π) = 0.
        let (sine, cosine) = Interval::PI.sine_and_cosine();
        assert!(sine.lower <= 0.0 && sine.upper >= 0.0 && cosine.lower <= -1.0 && cosine.upper >= -1.0);
    }
}
