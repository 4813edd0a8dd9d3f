//! Converts events and scenes to Rerun entities. Entity paths are named here and nowhere else.
//!
//! | entity | contents | timelines |
//! |---|---|---|
//! | `/study` | the study as run, as markdown | static |
//! | `/designs` | one row per evaluated design: the columns of `designs.csv` | `evaluation`, `generation` |
//! | `/scatter/plot/designs/…` | points of the objectives, decades of those that span them, one row per generation and kind of design | both |
//! | `/scatter/plot/front/…` | the front at that time: its designs, labelled, and its staircase line (two objectives only) | both |
//! | `/scatter/plot/axes/…` | axes, ticks, titles and legend of the scatter plot | both |
//! | `/run/hypervolume`, `/run/feasible_share`, `/run/front_size` | curves, one value per generation | both |
//! | `/summary` | the verified front as a table, as markdown | static |
//! | `/design/manipulator/…` | a design: base, legs, platform, joints, frames, labels | `front`, or `tour` |
//! | `/design/workspace/…`, `/design/limits` | its regular workspace and the poses that limit it | `front`, or static |
//! | `/design/heatmap/FIELD/…`, `/legend/FIELD/…` | a field with threshold, singularities and edge of reach, and its colours | `front`, or static |
//! | `/design/ellipsoids/KIND/…` | stiffness or displacement ellipsoids | `front`, or static |
//! | `/configuration/…` | the workspace in (x, y, φ): cylinder, heatmaps over φ, the pose | `front`, or static and `tour` |
//! | `/design/proof/…`, `/configuration/proof/…` | the boxes of the proof of the workspace, and an infeasible pose | static |
//! | `/card` | the design's numbers, as markdown | `front`, or static |
//! | `/along_front/…` | design variables and `R_w` along the front | `front` |
//! | `/prices/ARCHITECTURE/…` | prices along the front; in the recording of `kinefront prices` only | `front` |
//! | `/pins/N/…` | pinned designs side by side; in a window only | static |
//!
//! `evaluation` is the id of the design; a row that belongs to a generation is recorded at the generation's last
//! design. `front` counts the verified designs in the order of the first objective; the knee of the front is also recorded at the end of
//! `evaluation` and `generation`. `tour` counts the poses of a tour. The recording of a single design has only the rows
//! from `/design/manipulator` to `/card`.

mod apart;
mod axis;
mod blueprint;
mod card;
mod colors;
mod columns;
mod design;
mod draw;
mod legend;
mod live;
mod motion;
mod plot;
mod point;
mod pointed;
mod price_curves;
mod prices;
mod proof;
mod read;
mod recorder;
mod rows;
mod run_files;
mod sink;
mod stage;
mod subject;
mod viewpoint;
mod writer;

pub use apart::{RecordedRunError, UNPACK_COMMAND, read_apart, unpack, unpack_with};
pub use design::record_design;
pub use live::{LiveScene, Picked, Pinned, SceneLegends, Shown, VisibleLayers};
pub use point::FrontPoint;
pub use pointed::SceneTarget;
pub use prices::record_prices;
pub use read::{CopyError, ReadError, RecordedDesign, RecordedRun, read_run, save_copy};
pub use recorder::{Recorder, is_recorded};
pub use run_files::{RunFileError, RunFiles};
pub use viewpoint::Viewpoint;
pub use writer::RecordingError;

/// Application id of Kinefront's recordings; the viewer stores layouts under it.
pub const APPLICATION_ID: &str = "kinefront";

mod paths {
    //! Entity paths.
    pub const MANIPULATOR: &str = "/design/manipulator";
    pub const WORKSPACE: &str = "/design/workspace";
    pub const LIMITS: &str = "/design/limits";
    pub const PROOF: &str = "/design/proof";
    pub const PATH: &str = "/design/path";
    pub const MOTION: &str = "/motion";
    pub const WRENCH: &str = "/design/wrench";
    pub const VIBRATION: &str = "/design/vibration";
    pub const HEATMAP: &str = "/design/heatmap";
    pub const HEATMAP_LEGEND: &str = "/legend";
    pub const ELLIPSOIDS: &str = "/design/ellipsoids";
    pub const DESIGN: &str = "/design";
    pub const CONFIGURATION: &str = "/configuration";
    pub const PINS: &str = "/pins";
    pub const CARD: &str = "/card";
    pub const ALONG_FRONT: &str = "/along_front";
    pub const PRICES: &str = "/prices";
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
    /// Time of a motion, in nanoseconds.
    pub const TIME: &str = "time";
}
