//! The numbers that the registers of an instruction set hold.

use std::ops::{Add, BitAnd, Div, Mul, Neg, Sub};

use pulp::Simd;

use super::{ApartJob, LaneJob, MAX_LANES, Real};

/// Number of registers that are processed together: while one waits for the result of a division, the other proceeds.
const REGISTERS: usize = 2;

/// The numbers that two registers of the instruction set `S` hold.
#[derive(Clone, Copy)]
pub(crate) struct Lanes<S: Simd> {
    simd: S,
    registers: [S::f64s; REGISTERS],
}

/// Result of a comparison of [`Lanes`].
#[derive(Clone, Copy)]
pub(crate) struct LaneMask<S: Simd> {
    simd: S,
    registers: [S::m64s; REGISTERS],
}

/// Carries out an operation of an instruction set on each register of some operands.
macro_rules! lanewise {
    ($result:ident, $operation:ident, $first:ident $(, $other:ident)*) => {{
        let simd = $first.simd;
        $result {
            simd,
            registers: [
                simd.$operation($first.registers[0] $(, $other.registers[0])*),
                simd.$operation($first.registers[1] $(, $other.registers[1])*),
            ],
        }
    }};
}

impl<S: Simd> Lanes<S> {
    /// Number of lanes.
    pub(crate) const COUNT: usize = {
        assert!(REGISTERS * S::F64_LANES <= MAX_LANES);
        REGISTERS * S::F64_LANES
    };

    /// Returns the same number in every lane.
    #[inline(always)]
    pub(crate) fn all(simd: S, value: f64) -> Self {
        let register = simd.splat_f64s(value);
        Self {
            simd,
            registers: [register; REGISTERS],
        }
    }

    /// Splits a column of numbers into groups of [`Lanes::COUNT`]; numbers after the last complete group are omitted.
    #[inline(always)]
    pub(crate) fn column(column: &[f64]) -> &[[S::f64s; REGISTERS]] {
        S::as_simd_f64s(column).0.as_chunks().0
    }

    /// Does the same as [`Lanes::column`] for a column to be written.
    #[inline(always)]
    pub(crate) fn column_mut(column: &mut [f64]) -> &mut [[S::f64s; REGISTERS]] {
        S::as_mut_simd_f64s(column).0.as_chunks_mut().0
    }

    /// Loads a group of a column.
    #[inline(always)]
    pub(crate) fn load(simd: S, group: &[S::f64s; REGISTERS]) -> Self {
        Self {
            simd,
            registers: *group,
        }
    }

    /// Stores the numbers in a group of a column.
    #[inline(always)]
    pub(crate) fn store(self, group: &mut [S::f64s; REGISTERS]) {
        *group = self.registers;
    }
}

impl<S: Simd> LaneMask<S> {
    /// Returns the number of lanes before the first lane that is not set.
    #[inline(always)]
    pub(crate) fn count_leading_set(self) -> usize {
        self.bits().trailing_ones() as usize
    }

    /// Returns one bit per lane, with the first lane in the lowest bit.
    ///
    /// It reads the bytes of the mask, because `first_true_m64s` of pulp 0.22 counts from the wrong end for masks that
    /// are stored as bits.
    #[inline(always)]
    fn bits(self) -> u32 {
        let mut bits = 0u32;
        for (register, mask) in self.registers.iter().enumerate() {
            let bytes = pulp::bytemuck::bytes_of(mask);
            if bytes.len() == 1 {
                // The mask holds one bit per lane.
                bits |= u32::from(bytes[0]) << (S::F64_LANES * register);
            } else {
                for lane in 0..S::F64_LANES {
                    bits |= u32::from(bytes[size_of::<u64>() * lane] & 1) << (S::F64_LANES * register + lane);
                }
            }
        }
        bits
    }
}

impl<S: Simd> BitAnd for LaneMask<S> {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        lanewise!(Self, and_m64s, self, other)
    }
}

macro_rules! operators {
    ($($trait:ident $method:ident $operation:ident),+) => {
        $(impl<S: Simd> $trait for Lanes<S> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                lanewise!(Self, $operation, self, other)
            }
        })+
    };
}

operators!(Add add add_f64s, Sub sub sub_f64s, Mul mul mul_f64s, Div div div_f64s);

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        lanewise!(Self, neg_f64s, self)
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
        lanewise!(Self, sqrt_f64s, self)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        lanewise!(Self, abs_f64s, self)
    }

    #[inline(always)]
    fn at_least(self, other: Self) -> LaneMask<S> {
        lanewise!(LaneMask, greater_than_or_equal_f64s, self, other)
    }

    #[inline(always)]
    fn exceeds(self, other: Self) -> LaneMask<S> {
        lanewise!(LaneMask, greater_than_f64s, self, other)
    }

    #[inline(always)]
    fn select(self, mask: LaneMask<S>, other: Self) -> Self {
        lanewise!(Self, select_f64s, mask, self, other)
    }

    #[inline(always)]
    fn any(mask: LaneMask<S>) -> bool {
        mask.bits() != 0
    }

    #[inline(always)]
    fn call_apart<J: LaneJob>(self, job: J) -> J::Output {
        #[inline(never)]
        fn call<S: Simd, J: LaneJob>(simd: S, job: J) -> J::Output {
            simd.vectorize(ApartJob(job))
        }
        call(self.simd, job)
    }
}
