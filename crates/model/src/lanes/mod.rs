//! Arithmetic on one number or on several at once, with bit-identical results.
//!
//! A formula that is generic over [`Real`] runs on an `f64`, on the widest registers of the processor
//! ([`InstructionSet`]), or on a type that counts operations. Every operation is rounded separately, as IEEE 754
//! requires (no fused multiply-add, no approximate reciprocal), and lanes never mix. Every instruction set therefore
//! gives the same bits.
//!
//! Every function that is generic over [`Real`] is `#[inline(always)]`, because a function that is not inlined is
//! compiled for the baseline processor. A closure that is called more than once may not be inlined, so that its place is taken by
//! a function.

mod planar;
mod registers;

pub use planar::Planar;
pub(crate) use registers::Lanes;

use std::ops::{Add, BitAnd, Div, Mul, Neg, Sub};

use pulp::{NullaryFnOnce, WithSimd};

/// A computation on lanes that may be compiled as a function of its own ([`Real::call_apart`]).
pub trait LaneJob {
    /// What it computes.
    type Output;

    /// Runs it; to be marked `#[inline(always)]`.
    fn run(self) -> Self::Output;
}

/// A job in the form that instruction sets run.
struct ApartJob<J>(J);

impl<J: LaneJob> NullaryFnOnce for ApartJob<J> {
    type Output = J::Output;

    #[inline(always)]
    fn call(self) -> J::Output {
        self.0.run()
    }
}

/// One number, or several numbers in parallel lanes.
pub trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// Result of a comparison, one truth value per lane.
    type Mask: Copy + BitAnd<Output = Self::Mask>;

    /// Returns `value` in as many lanes as `self` has.
    fn splat(self, value: f64) -> Self;
    /// Returns the square root.
    fn sqrt(self) -> Self;
    /// Returns the absolute value.
    fn abs(self) -> Self;
    /// Returns a number that the absolute value nowhere exceeds, and with which it takes few operations to compute.
    #[inline(always)]
    fn magnitude_bound(self) -> Self {
        self.abs()
    }
    /// Returns the number, which would be `value` if nothing were rounded.
    #[inline(always)]
    fn known_to_be(self, _value: f64) -> Self {
        self
    }
    /// Compares `self ≥ other`; false if either is NaN.
    fn at_least(self, other: Self) -> Self::Mask;
    /// Compares `self > other`; false if either is NaN.
    fn exceeds(self, other: Self) -> Self::Mask;
    /// Selects `self` in the lanes where the mask is set and `other` in the rest.
    fn select(self, mask: Self::Mask, other: Self) -> Self;
    /// Returns whether the mask is set in any lane.
    fn any(mask: Self::Mask) -> bool;
    /// Runs `job` in a function of its own, which is compiled for the instruction set of `self`. It saves the compiler from copying
    /// a job into every loop that needs it.
    #[inline(always)]
    fn call_apart<J: LaneJob>(self, job: J) -> J::Output {
        job.run()
    }

    /// Returns the inverse of a symmetric matrix, both given as upper triangles, row by row.
    #[inline(always)]
    fn symmetric_inverse(matrix: &[Self; 6]) -> [Self; 6] {
        let [a, b, c, d, e, f] = *matrix;
        let cofactors = [
            d * f - e * e,
            c * e - b * f,
            b * e - c * d,
            a * f - c * c,
            b * c - a * e,
            a * d - b * b,
        ];
        let one = a.splat(1.0) / (a * cofactors[0] + b * cofactors[1] + c * cofactors[2]);
        [
            cofactors[0] * one,
            cofactors[1] * one,
            cofactors[2] * one,
            cofactors[3] * one,
            cofactors[4] * one,
            cofactors[5] * one,
        ]
    }

    /// Returns the lower triangle, column by column, of the Cholesky factor of a symmetric matrix, given as an upper triangle; not a number
    /// where the matrix is not positive definite.
    #[inline(always)]
    fn cholesky(matrix: &[Self; 6]) -> [Self; 6] {
        let a = matrix[0].sqrt();
        let (b, c) = (matrix[1] / a, matrix[2] / a);
        let d = (matrix[3] - b * b).sqrt();
        let e = (matrix[4] - b * c) / d;
        let f = (matrix[5] - c * c - e * e).sqrt();
        [a, b, c, d, e, f]
    }

    /// Returns the rows of the inverse of the transpose of a matrix, which is given by its rows.
    #[inline(always)]
    fn inverse_transpose([a, b, c]: &[[Self; 3]; 3]) -> [[Self; 3]; 3] {
        let first = cross(b, c);
        let one = a[0].splat(1.0) / (a[0] * first[0] + a[1] * first[1] + a[2] * first[2]);
        [
            scaled(&first, one),
            scaled(&cross(c, a), one),
            scaled(&cross(a, b), one),
        ]
    }

    /// Returns the smaller of two numbers, or `other` if either is NaN.
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        self.select(other.exceeds(self), other)
    }

    /// Returns the larger of two numbers, or `other` if either is NaN.
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        self.select(self.exceeds(other), other)
    }
}

#[inline(always)]
fn cross<V: Real>(a: &[V; 3], b: &[V; 3]) -> [V; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Returns the dot product of two vectors.
#[inline(always)]
pub(crate) fn dot<V: Real>(a: &[V; 3], b: &[V; 3]) -> V {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns the sum of two vectors.
#[inline(always)]
pub(crate) fn sum<V: Real>(a: &[V; 3], b: &[V; 3]) -> [V; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// Returns the difference of two vectors.
#[inline(always)]
pub(crate) fn less<V: Real>(a: &[V; 3], b: &[V; 3]) -> [V; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Returns the multiple of a vector.
#[inline(always)]
pub(crate) fn scaled<V: Real>(a: &[V; 3], by: V) -> [V; 3] {
    [a[0] * by, a[1] * by, a[2] * by]
}

impl Real for f64 {
    type Mask = bool;

    #[inline(always)]
    fn splat(self, value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }

    #[inline(always)]
    fn at_least(self, other: Self) -> bool {
        self >= other
    }

    #[inline(always)]
    fn exceeds(self, other: Self) -> bool {
        self > other
    }

    #[inline(always)]
    fn select(self, mask: bool, other: Self) -> Self {
        if mask { self } else { other }
    }

    #[inline(always)]
    fn any(mask: bool) -> bool {
        mask
    }
}

/// Largest number of lanes of any instruction set; columns of poses are padded to a multiple of it.
pub const MAX_LANES: usize = 16;

/// Returns `count` rounded up to a multiple of [`MAX_LANES`].
pub fn padded_length(count: usize) -> usize {
    count.next_multiple_of(MAX_LANES)
}

/// An instruction set that this processor supports.
#[derive(Debug, Clone, Copy)]
pub struct InstructionSet(pulp::Arch);

impl InstructionSet {
    /// Returns the instruction set with the widest registers.
    pub fn best() -> Self {
        Self(pulp::Arch::new())
    }

    /// Returns all supported instruction sets, from the baseline to the widest.
    pub fn available() -> Vec<Self> {
        #[allow(unused_mut, reason = "processors without wider registers add nothing")]
        let mut sets = vec![pulp::Arch::Scalar];
        #[cfg(target_arch = "x86_64")]
        {
            sets.extend(pulp::x86::V3::try_new().map(pulp::Arch::V3));
            sets.extend(pulp::x86::V4::try_new().map(pulp::Arch::V4));
        }
        #[cfg(target_arch = "aarch64")]
        sets.extend(pulp::aarch64::Neon::try_new().map(pulp::Arch::Neon));
        sets.into_iter().map(Self).collect()
    }

    /// Returns the name for display.
    pub fn name(self) -> &'static str {
        match self.0 {
            pulp::Arch::Scalar => "baseline",
            #[cfg(target_arch = "x86_64")]
            pulp::Arch::V3(_) => "AVX2",
            #[cfg(target_arch = "x86_64")]
            pulp::Arch::V4(_) => "AVX-512",
            #[cfg(target_arch = "aarch64")]
            pulp::Arch::Neon(_) => "NEON",
            #[allow(unreachable_patterns, reason = "the sets of other processors are not compiled")]
            _ => "other",
        }
    }

    /// Runs `job` compiled for this instruction set.
    #[inline]
    pub(crate) fn run<J: WithSimd>(self, job: J) -> J::Output {
        self.0.dispatch(job)
    }
}
