//! What the manipulator is at a pose: its scalars, which constraints bound them, and whether the pose is feasible (docs/model.md,
//! section 6).
//!
//! [`PoseScalar`] is the table of the scalars; [`PoseChecker`] is one design, prepared for many poses. Several poses are evaluated at
//! a time ([`PoseChecker::lanes`]); `plain` evaluates one by the closed form as it is defined, and the lanes are compared with it.

mod checker;
mod constraint;
mod entry;
mod lanes;
mod plain;
mod scalars;
mod values;

pub(crate) use checker::{PoseChecker, computed};
pub use constraint::ConstraintSet;
pub use entry::{Better, QuantityEntry, Reference, Scale, Scope};
pub use scalars::{Constraint, MarginUnit, PoseScalar, PoseScalarEntry};
pub(crate) use values::{CoreLanes, EXAMINED_ALWAYS, finite, is_within};
pub use values::{PoseScalars, PoseValues, ScalarSet, Thresholds};
