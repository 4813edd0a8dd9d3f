//! Counts the floating-point operations of a formula; each distinct operation counts once, as a compiler shares its
//! result.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ops::{Add, Div, Mul, Neg, Sub};

use kinefront_model::lanes::Real;

/// Numbers of operations for one pose.
#[derive(Debug, Clone, Copy, Default)]
pub struct Operations {
    pub sums_and_products: usize,
    pub quotients: usize,
    pub roots: usize,
    pub comparisons_and_choices: usize,
}

/// A number that counts the operations on it. Operations that do not depend on the position are done once per
/// orientation and are not counted.
#[derive(Clone, Copy)]
pub struct Counted {
    value: f64,
    /// Number of the result; `None` if it does not depend on the position.
    id: Option<usize>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Operation {
    Add,
    Sub,
    Mul,
    Div,
    Neg,
    Sqrt,
    Abs,
    AtLeast,
    Exceeds,
    Choice,
}

/// An operand, identified by its number if it is a result, otherwise by its bits.
type Operand = Result<usize, u64>;

thread_local! {
    static DONE: RefCell<BTreeMap<(Operation, Operand, Operand), usize>> = const { RefCell::new(BTreeMap::new()) };
}

/// Counts the operations of `formula` on the coordinates of a position.
pub fn operations(x: f64, y: f64, formula: impl FnOnce(Counted, Counted)) -> Operations {
    DONE.take();
    formula(
        Counted {
            value: x,
            id: Some(usize::MAX),
        },
        Counted {
            value: y,
            id: Some(usize::MAX - 1),
        },
    );
    let mut counts = Operations::default();
    for (operation, _, _) in DONE.take().into_keys() {
        *match operation {
            Operation::Add | Operation::Sub | Operation::Mul => &mut counts.sums_and_products,
            Operation::Div => &mut counts.quotients,
            Operation::Sqrt => &mut counts.roots,
            _ => &mut counts.comparisons_and_choices,
        } += 1;
    }
    counts
}

impl Counted {
    pub fn value(self) -> f64 {
        self.value
    }

    fn made(value: f64, operation: Operation, a: Self, b: Self) -> Self {
        if a.id.is_none() && b.id.is_none() {
            return Self { value, id: None };
        }
        let operand = |x: Self| x.id.ok_or(x.value.to_bits());
        let (mut a, mut b) = (operand(a), operand(b));
        if matches!(operation, Operation::Add | Operation::Mul) && b < a {
            std::mem::swap(&mut a, &mut b);
        }
        let id = DONE.with_borrow_mut(|done| {
            let next = done.len();
            *done.entry((operation, a, b)).or_insert(next)
        });
        Self { value, id: Some(id) }
    }
}

impl Add for Counted {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::made(self.value + other.value, Operation::Add, self, other)
    }
}

impl Sub for Counted {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::made(self.value - other.value, Operation::Sub, self, other)
    }
}

impl Mul for Counted {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        // A factor of 1 (the transmission of a telescopic leg) is known to the compiler.
        let one = |operand: Self| operand.id.is_none() && operand.value == 1.0;
        if one(self) {
            other
        } else if one(other) {
            self
        } else {
            Self::made(self.value * other.value, Operation::Mul, self, other)
        }
    }
}

impl Div for Counted {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        Self::made(self.value / other.value, Operation::Div, self, other)
    }
}

impl Neg for Counted {
    type Output = Self;
    fn neg(self) -> Self {
        Self::made(-self.value, Operation::Neg, self, self)
    }
}

impl Real for Counted {
    type Mask = bool;

    fn any(mask: bool) -> bool {
        mask
    }

    fn splat(self, value: f64) -> Self {
        Self { value, id: None }
    }

    fn sqrt(self) -> Self {
        Self::made(self.value.sqrt(), Operation::Sqrt, self, self)
    }

    fn abs(self) -> Self {
        Self::made(self.value.abs(), Operation::Abs, self, self)
    }

    fn at_least(self, other: Self) -> bool {
        Self::made(0.0, Operation::AtLeast, self, other);
        self.value >= other.value
    }

    fn exceeds(self, other: Self) -> bool {
        Self::made(0.0, Operation::Exceeds, self, other);
        self.value > other.value
    }

    fn select(self, mask: bool, other: Self) -> Self {
        Self::made(
            if mask { self.value } else { other.value },
            Operation::Choice,
            self,
            other,
        )
    }
}
