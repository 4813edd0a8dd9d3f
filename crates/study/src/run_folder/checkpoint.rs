//! Contents of `progress.json`, which stands beside the files of a run that has not ended.

use serde::{Deserialize, Serialize};

use super::MergedRun;
use crate::FileSum;

/// Contents of `progress.json`: what was on the disk at the last checkpoint of a run in progress. The file is removed
/// once all files of the run are complete.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Checkpoint {
    /// Version of the program.
    pub kinefront_version: String,
    /// Every how many generations one is recorded; `None` for a run without a recording.
    pub record_every: Option<usize>,
    /// Sum of `study.toml`; unknown while that file is replaced.
    pub study: Option<FileSum>,
    /// Sum of the rows that `designs.csv` had.
    pub designs: FileSum,
    /// The runs whose designs the folder holds; absent for a folder of one run.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub merged: Vec<MergedRun>,
}
