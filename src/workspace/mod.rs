//! Regular dexterous workspace of a design (SPEC section 4).
//!
//! [`PoseChecker`] says whether one pose is good, [`Grid`] which poses are asked, [`search`] finds the largest disc of
//! good poses and the home orientation.

mod checker;
mod grid;
mod regular;

pub use checker::{PoseChecker, PoseValues, Thresholds};
pub use grid::{Grid, GridError};
pub use regular::{Ray, RegularWorkspace, WorkspaceSpec, search};
