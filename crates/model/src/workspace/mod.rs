//! Regular dexterous workspace of a design (docs/model.md, section 7).
//!
//! [`Grid`] defines which poses are examined, and the search finds the largest disc of feasible poses and its home orientation;
//! `prescribed` finds the home orientation of a region that the study prescribes. [`plain`] follows the definition
//! literally; the search is compared with it.

mod batch;
mod columns;
mod evaluator;
mod grid;
mod margins;
mod orientations;
pub mod plain;
mod prescribed;
mod region;
mod regular;
mod rings;
mod sampling;
mod spec;

pub(crate) use batch::OrientationLanes;
pub use columns::ValueColumns;
pub(crate) use columns::{ArmColumns, Positions};
pub use evaluator::PoseEvaluator;
pub use grid::{Grid, GridError};
pub use orientations::OrientationGrid;
pub(crate) use prescribed::RegionMargins;
pub(crate) use prescribed::search_prescribed;
pub use region::Region;
pub(crate) use region::{RegionPositions, directions};
pub(crate) use regular::{RegularWorkspace, search};
pub use sampling::WorkspaceSampling;
pub use spec::WorkspaceSpec;
