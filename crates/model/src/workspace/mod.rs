//! Regular dexterous workspace of a design (docs/model.md, section 7).
//!
//! [`PoseChecker`] determines whether a pose is feasible, [`Grid`] defines which poses are examined, and [`search`]
//! finds the largest disc of feasible poses and its home orientation; [`search_prescribed`] finds the home orientation of a
//! region that the study prescribes. Several poses are evaluated at a time
//! ([`PoseChecker::lanes`]). [`plain`] follows the definition literally; the lanes and the search are compared with it.

mod batch;
mod checker;
mod columns;
mod evaluator;
mod further;
mod grid;
mod orientations;
pub mod plain;
mod prescribed;
mod region;
mod regular;
mod rings;
mod sampling;

pub(crate) use batch::OrientationLanes;
pub use checker::{PoseChecker, PoseLanes, PoseValues, Thresholds};
pub use columns::ValueColumns;
pub(crate) use columns::{ArmColumns, Positions};
pub use evaluator::PoseEvaluator;
pub(crate) use further::FurtherColumns;
pub use further::{FurtherLanes, FurtherLimits, FurtherValues};
pub use grid::{Grid, GridError};
pub use orientations::OrientationGrid;
pub(crate) use prescribed::RegionMargins;
pub use prescribed::search_prescribed;
pub use region::{Polygon, PolygonError, Region};
pub(crate) use region::{RegionPositions, directions};
pub use regular::{RegularWorkspace, WorkspaceSpec, search};
pub use sampling::WorkspaceSampling;
