//! What the tests of several packages share.

pub mod oracle;

use std::path::{Path, PathBuf};

/// The paper's design II.
pub const DESIGN: &str = "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056";

/// Returns the text of a small study, which runs quickly and has all three architectures of the paper.
pub fn small_study(evaluations: usize) -> String {
    format!(
        "name = \"small\"\n[grid.reference]\nphi_step_deg = 5\ndirections = 12\nray_steps = 20\nhalvings = 6\n\
         [grid.fine]\nphi_step_deg = 2.5\ndirections = 24\nray_steps = 40\nhalvings = 8\n\
         [optimizer]\nevaluations = {evaluations}\nseed = 5\n"
    )
}

/// Returns the folder of a run of a small study that an earlier version wrote.
pub fn run_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/run")
}
