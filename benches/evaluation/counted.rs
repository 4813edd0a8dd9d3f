//! Counts the floating-point operations of a formula.

use std::cell::Cell;
use std::ops::{Add, Div, Mul, Neg, Sub};

use kinefront::lanes::Real;

/// A number that counts what is done with it; what does not depend on the position is done once an orientation and not
/// counted.
#[derive(Clone, Copy)]
pub struct Counted {
    pub value: f64,
    pub varies: bool,
}

thread_local! {
    /// Sums and products, quotients, square roots, comparisons and choices.
    pub static OPERATIONS: Cell<[u32; 4]> = const { Cell::new([0; 4]) };
}

impl Counted {
    fn made(value: f64, from: &[Counted], kind: usize) -> Self {
        let varies = from.iter().any(|operand| operand.varies);
        if varies {
            OPERATIONS.with(|cell| {
                let mut counts = cell.get();
                counts[kind] += 1;
                cell.set(counts);
            });
        }
        Self { value, varies }
    }
}

impl Add for Counted {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::made(self.value + other.value, &[self, other], 0)
    }
}

impl Sub for Counted {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::made(self.value - other.value, &[self, other], 0)
    }
}

impl Mul for Counted {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        // A factor of 1 (the drive of a telescopic leg) is known to the compiler.
        let one = |operand: Self| !operand.varies && operand.value == 1.0;
        if one(self) {
            other
        } else if one(other) {
            self
        } else {
            Self::made(self.value * other.value, &[self, other], 0)
        }
    }
}

impl Div for Counted {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        Self::made(self.value / other.value, &[self, other], 1)
    }
}

impl Neg for Counted {
    type Output = Self;
    fn neg(self) -> Self {
        Self::made(-self.value, &[self], 3)
    }
}

impl Real for Counted {
    type Mask = bool;

    fn splat(self, value: f64) -> Self {
        Self { value, varies: false }
    }

    fn sqrt(self) -> Self {
        Self::made(self.value.sqrt(), &[self], 2)
    }

    fn abs(self) -> Self {
        Self::made(self.value.abs(), &[self], 3)
    }

    fn at_least(self, other: Self) -> bool {
        Self::made(0.0, &[self, other], 3);
        self.value >= other.value
    }

    fn exceeds(self, other: Self) -> bool {
        Self::made(0.0, &[self, other], 3);
        self.value > other.value
    }

    fn where_set(self, mask: bool, other: Self) -> Self {
        Self::made(if mask { self.value } else { other.value }, &[self, other], 3)
    }
}
