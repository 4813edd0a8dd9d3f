//! Enclosures of real functions over boxes, with which statements about every pose of a region are proved.
//!
//! | item | purpose |
//! |---|---|
//! | [`Interval`] | a constant between two doubles |
//! | [`TaylorModel`] | a function over a box: a polynomial of degree 2 and a bound of its remainder |
//! | [`EnclosedNumber`] | a number of the formulas that the evaluation uses, over a box |
//! | [`PoseEnclosure`], [`MembersEnclosure`] | a box of poses, and what the members of a leg are over it |

mod interval;
mod number;
mod pose;
mod taylor;

pub use interval::Interval;
pub use number::{Comparison, EnclosedNumber};
pub use pose::{AxisEnclosure, MembersEnclosure, PlanarModel, PoseEnclosure, TurnedFrame, cross, difference, dot, sum};
pub use taylor::{TaylorModel, VARIABLES};
