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
//!
//! `evaluation` is the id of the design; a row that belongs to a generation stands at the generation's last design.

mod blueprint;
mod columns;
mod recorder;
mod scatter;
mod sink;

pub use recorder::{Recorder, RecordingError};

/// Application id of our recordings; the viewer keeps layouts by it.
pub const APPLICATION_ID: &str = "kinefront";

mod paths {
    //! Entity paths.
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
}
