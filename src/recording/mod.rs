//! Events to Rerun entities: the only place that names entity paths.
//!
//! | entity | holds | timelines |
//! |---|---|---|
//! | `/study` | the study as run, markdown | static |
//! | `/designs` | a row per evaluated design: the columns of `designs.csv` | `evaluation`, `generation` |
//! | `/scatter/plot/designs/…` | points (log₁₀ mass, R_w), one row per generation and kind of design | both |
//! | `/scatter/plot/front/…` | the front as it stood: its designs, labelled, and its staircase | both |
//! | `/scatter/plot/axes/…` | axes, ticks, titles and legend of the scatter | both |
//! | `/run/hypervolume`, `/run/feasible_share`, `/run/front_size` | curves, a value per generation | both |
//! | `/summary` | the verified front as a table, markdown | static |
//! | `/design/manipulator/…` | a design: base, legs, platform, joints, frames, labels | `front`, or `tour` |
//! | `/design/workspace/…`, `/design/limits` | its regular workspace and the poses that stop it from growing | `front`, or static |
//! | `/design/heatmap/FIELD/…`, `/design/legend/FIELD/…` | a field with threshold, singularities and edge of reach | `front`, or static |
//! | `/design/ellipsoids/KIND/…` | stiffness or displacement ellipsoids | `front`, or static |
//! | `/configuration/…` | the workspace in (x, y, φ): cylinder, heatmaps over φ, the pose | `front`, or static and `tour` |
//! | `/card` | the design's numbers, markdown | `front`, or static |
//! | `/along_front/…` | design variables along the front | `front` |
//! | `/pins/N/…` | designs side by side; in a window only | static |
//!
//! `evaluation` is the id of the design; a row that belongs to a generation stands at the generation's last design.
//! `front` counts the verified designs from the lightest, and the knee of the front stands at the end of the run's own
//! timelines too. `tour` counts the poses of a tour. A design recorded by itself has only the last six rows.

mod blueprint;
mod card;
mod colors;
mod columns;
mod design;
mod draw;
mod live;
#[cfg(feature = "explorer")]
mod read;
mod recorder;
mod scatter;
mod sink;
mod stage;
mod subject;
mod writer;

pub use design::record_design;
pub use live::{Layers, LiveScene, Picked, Pinned, Shown};
#[cfg(feature = "explorer")]
pub use read::{ReadError, RecordedDesign, RecordedRun, read_run, save_copy};
pub use recorder::Recorder;
pub use scatter::FrontPoint;
pub use writer::RecordingError;

/// Application id of our recordings; the viewer keeps layouts by it.
pub const APPLICATION_ID: &str = "kinefront";

mod paths {
    //! Entity paths.
    pub const MANIPULATOR: &str = "/design/manipulator";
    pub const WORKSPACE: &str = "/design/workspace";
    pub const LIMITS: &str = "/design/limits";
    pub const HEATMAP: &str = "/design/heatmap";
    pub const HEATMAP_LEGEND: &str = "/design/legend";
    pub const ELLIPSOIDS: &str = "/design/ellipsoids";
    pub const DESIGN: &str = "/design";
    pub const CONFIGURATION: &str = "/configuration";
    pub const PINS: &str = "/pins";
    pub const CARD: &str = "/card";
    pub const ALONG_FRONT: &str = "/along_front";
    pub const SELECTED: &str = "/scatter/plot/front/selected";
    pub const STUDY: &str = "/study";
    pub const SUMMARY: &str = "/summary";
    pub const DESIGNS: &str = "/designs";
    pub const HYPERVOLUME: &str = "/run/hypervolume";
    pub const FEASIBLE_SHARE: &str = "/run/feasible_share";
    pub const FRONT_SIZE: &str = "/run/front_size";
    pub const SCATTER: &str = "/scatter";
    pub const PLOT: &str = "/scatter/plot";
    pub const CLOUD: &str = "/scatter/plot/designs";
    pub const INFEASIBLE: &str = "/scatter/plot/designs/infeasible";
    pub const FRONT_DESIGNS: &str = "/scatter/plot/front/designs";
    pub const FRONT_LINE: &str = "/scatter/plot/front/staircase";
    pub const AXES: &str = "/scatter/plot/axes/lines";
    pub const TICKS: &str = "/scatter/plot/axes/ticks";
    pub const LEGEND: &str = "/scatter/plot/axes/legend";
}

/// Timelines of a run.
mod timelines {
    pub const EVALUATION: &str = "evaluation";
    pub const GENERATION: &str = "generation";
    pub const FRONT: &str = "front";
    pub const TOUR: &str = "tour";
}
