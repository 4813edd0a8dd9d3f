//! Regular dexterous workspace of a design (SPEC section 4).
//!
//! [`PoseChecker`] says whether one pose is good, [`Grid`] which poses are asked, [`search`] finds the largest disc of
//! good poses and the home orientation. Poses are taken several at a time ([`PoseChecker::lanes`]); [`plain`] is the
//! definition as it reads, which that and the search are compared with.

mod batch;
mod checker;
mod columns;
mod grid;
pub mod plain;
mod regular;
mod rings;
mod sampling;
mod turn;

pub(crate) use batch::Oriented;
pub use checker::{PoseChecker, PoseLanes, PoseValues, Thresholds};
pub use columns::ValueColumns;
pub(crate) use columns::{ArmColumns, Positions};
pub use grid::{Grid, GridError};
pub use regular::{RegularWorkspace, WorkspaceSpec, search};
pub use sampling::WorkspaceSampling;
pub use turn::Turn;
