//! Arithmetic on one number or on several at once, the same to the bit.
//!
//! A formula written over [`Real`] runs on an `f64`, on the widest registers the processor has ([`InstructionSet`]), or
//! on a type that counts. Every operation is rounded on its own as IEEE 754 asks (no fused multiply-add, no
//! approximate reciprocal) and lanes never mix, so that every instruction set gives the same bits.
//!
//! What is generic over [`Real`] is `#[inline(always)]`: code that is left in a function of its own is compiled for the
//! baseline processor.

use std::ops::{Add, BitAnd, Div, Mul, Neg, Sub};

use pulp::{Simd, WithSimd};

/// One number, or several side by side.
pub trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// Outcome of a comparison, lane by lane.
    type Mask: Copy + BitAnd<Output = Self::Mask>;

    /// `value` in as many lanes as `self` has.
    fn splat(self, value: f64) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// `self ≥ other`; false where either is no number.
    fn at_least(self, other: Self) -> Self::Mask;
    /// `self > other`; false where either is no number.
    fn exceeds(self, other: Self) -> Self::Mask;
    /// `self` where the mask is set, `other` elsewhere.
    fn where_set(self, mask: Self::Mask, other: Self) -> Self;

    /// The smaller of two numbers; `other` where either is no number.
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        self.where_set(other.exceeds(self), other)
    }

    /// The larger of two numbers; `other` where either is no number.
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        self.where_set(self.exceeds(other), other)
    }
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
    fn where_set(self, mask: bool, other: Self) -> Self {
        if mask { self } else { other }
    }
}

/// A vector of the plane, or several side by side.
#[derive(Clone, Copy)]
pub struct Planar<V> {
    /// First component.
    pub x: V,
    /// Second component.
    pub y: V,
}

impl<V: Real> Planar<V> {
    /// The vector of two components.
    #[inline(always)]
    pub fn new(x: V, y: V) -> Self {
        Self { x, y }
    }

    /// `self · other`.
    #[inline(always)]
    pub fn dot(self, other: Self) -> V {
        self.x * other.x + self.y * other.y
    }

    /// z component of `self × other`.
    #[inline(always)]
    pub fn cross(self, other: Self) -> V {
        self.x * other.y - self.y * other.x
    }

    /// `self` turned by +90°.
    #[inline(always)]
    pub fn perp(self) -> Self {
        Self::new(-self.y, self.x)
    }

    /// `factor · self`.
    #[inline(always)]
    pub fn scaled(self, factor: V) -> Self {
        Self::new(factor * self.x, factor * self.y)
    }

    /// `self + other`.
    #[inline(always)]
    pub fn plus(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y)
    }

    /// `self − other`.
    #[inline(always)]
    pub fn minus(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y)
    }

    /// `vector` in as many lanes as `like` has.
    #[inline(always)]
    pub fn splat(like: V, vector: glam::DVec2) -> Self {
        Self::new(like.splat(vector.x), like.splat(vector.y))
    }
}

impl From<glam::DVec2> for Planar<f64> {
    fn from(vector: glam::DVec2) -> Self {
        Self::new(vector.x, vector.y)
    }
}

/// As many numbers as a register of the instruction set `S` holds.
#[derive(Clone, Copy)]
pub struct Lanes<S: Simd> {
    simd: S,
    values: S::f64s,
}

/// Outcome of comparing [`Lanes`].
#[derive(Clone, Copy)]
pub struct LaneMask<S: Simd> {
    simd: S,
    mask: S::m64s,
}

impl<S: Simd> Lanes<S> {
    /// The numbers of one register.
    #[inline(always)]
    pub fn new(simd: S, values: S::f64s) -> Self {
        Self { simd, values }
    }

    /// `value` in every lane.
    #[inline(always)]
    pub fn all(simd: S, value: f64) -> Self {
        Self::new(simd, simd.splat_f64s(value))
    }

    /// The register.
    #[inline(always)]
    pub fn values(self) -> S::f64s {
        self.values
    }
}

impl<S: Simd> LaneMask<S> {
    /// The lanes before the first that is not set.
    ///
    /// Read from the mask's bytes: `first_true_m64s` of pulp 0.22 counts from the wrong end where masks are bits.
    #[inline(always)]
    pub fn leading(self) -> usize {
        let bytes = pulp::bytemuck::bytes_of(&self.mask);
        if bytes.len() < size_of::<u64>() * S::F64_LANES {
            // A bit for each lane.
            return bytes[0].trailing_ones() as usize;
        }
        let mut bits = 0u32;
        for lane in 0..S::F64_LANES {
            bits |= u32::from(bytes[size_of::<u64>() * lane] & 1) << lane;
        }
        bits.trailing_ones() as usize
    }
}

impl<S: Simd> BitAnd for LaneMask<S> {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self {
            simd: self.simd,
            mask: self.simd.and_m64s(self.mask, other.mask),
        }
    }
}

macro_rules! operators {
    ($($trait:ident $method:ident $lanewise:ident),+) => {
        $(impl<S: Simd> $trait for Lanes<S> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self::new(self.simd, self.simd.$lanewise(self.values, other.values))
            }
        })+
    };
}

operators!(Add add add_f64s, Sub sub sub_f64s, Mul mul mul_f64s, Div div div_f64s);

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(self.simd, self.simd.neg_f64s(self.values))
    }
}

impl<S: Simd> Real for Lanes<S> {
    type Mask = LaneMask<S>;

    #[inline(always)]
    fn splat(self, value: f64) -> Self {
        Self::all(self.simd, value)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::new(self.simd, self.simd.sqrt_f64s(self.values))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self::new(self.simd, self.simd.abs_f64s(self.values))
    }

    #[inline(always)]
    fn at_least(self, other: Self) -> LaneMask<S> {
        LaneMask {
            simd: self.simd,
            mask: self.simd.greater_than_or_equal_f64s(self.values, other.values),
        }
    }

    #[inline(always)]
    fn exceeds(self, other: Self) -> LaneMask<S> {
        LaneMask {
            simd: self.simd,
            mask: self.simd.greater_than_f64s(self.values, other.values),
        }
    }

    #[inline(always)]
    fn where_set(self, mask: LaneMask<S>, other: Self) -> Self {
        Self::new(self.simd, self.simd.select_f64s(mask.mask, self.values, other.values))
    }
}

/// Lanes of the widest register: buffers of poses are padded to a multiple of it.
pub const MOST_LANES: usize = 8;

/// `count` rounded up to whole registers.
pub fn padded(count: usize) -> usize {
    count.next_multiple_of(MOST_LANES)
}

/// A set of instructions that this processor has.
#[derive(Debug, Clone, Copy)]
pub struct InstructionSet(pulp::Arch);

impl InstructionSet {
    /// The widest one.
    pub fn best() -> Self {
        Self(pulp::Arch::new())
    }

    /// All of them, from the baseline to the widest.
    pub fn available() -> Vec<Self> {
        #[allow(unused_mut)]
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

    /// Its name, for people.
    pub fn name(self) -> &'static str {
        match self.0 {
            pulp::Arch::Scalar => "baseline",
            #[cfg(target_arch = "x86_64")]
            pulp::Arch::V3(_) => "AVX2",
            #[cfg(target_arch = "x86_64")]
            pulp::Arch::V4(_) => "AVX-512",
            #[cfg(target_arch = "aarch64")]
            pulp::Arch::Neon(_) => "NEON",
            #[allow(unreachable_patterns)]
            _ => "other",
        }
    }

    /// Runs `job` compiled for this set.
    #[inline]
    pub(crate) fn run<J: WithSimd>(self, job: J) -> J::Output {
        self.0.dispatch(job)
    }
}
