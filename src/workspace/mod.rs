//! Regular dexterous workspace of a design (SPEC section 4).
//!
//! [`PoseChecker`] says whether one pose is good, [`Grid`] which poses are asked, [`search`] finds the largest disc of
//! good poses and the home orientation.

mod batch;
mod checker;
mod grid;
mod rays;
mod regular;

pub use batch::{ArmColumns, Minima, Minimum, Turned, ValueColumns};
pub use checker::{PoseChecker, PoseLanes, PoseValues, Thresholds};
pub use grid::{Grid, GridError};
pub use regular::{RegularWorkspace, WorkspaceSpec, search};
