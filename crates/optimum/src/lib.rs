//! # Kinefront: the best design near a given one
//!
//! A search finds designs that are good on a grid of poses. This crate finds the best design near one of them with every pose of the
//! region as a constraint ([`LocalProblem::polish`]), what each requirement costs there ([`LocalProblem::prices`]), and what would have to
//! be given up for a wished value of the objective ([`LocalProblem::relaxations`]) or for any design at all
//! ([`LocalProblem::relaxed_alone`]). `docs/model.md` derives it in section 16.

mod convex;
mod exchange;
mod finish;
mod hessian;
mod meeting;
mod multipliers;
mod nearest;
mod parameter;
mod patience;
mod place;
mod polish;
mod polished;
mod prepared;
mod prices;
mod problem;
mod question;
mod relax;
mod requirement;
mod shortfall;
mod start;
mod survey;
mod value;

pub use meeting::{Branch, Meeting};
pub use multipliers::Multipliers;
pub use parameter::{Change, Parameter, ParameterKind};
pub use place::{Place, Spot};
pub use polished::Polished;
pub use prices::{PRICE_STEPS, Price, PriceStep, Prices, reported_place};
pub use problem::{LocalError, LocalProblem};
pub use question::{FreeVariable, LocalQuestion};
pub use relax::{Relaxation, RelaxationOf};
pub use requirement::{Critical, End, Requirement};
pub use shortfall::Relaxed;
