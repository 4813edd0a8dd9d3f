//! The assembly modes of a design.

use serde::Serialize;

use super::pose::PoseJson;
use kinefront_model::kinematics::AssemblyMode;
use kinefront_model::mechanism::WorkingMode;

/// The output of `kinefront pose --actuators --json`.
#[derive(Debug, Serialize)]
pub struct AssemblyModesJson {
    modes: Vec<AssemblyModeJson>,
}

#[derive(Debug, Serialize)]
struct AssemblyModeJson {
    pose: PoseJson,
    working_mode: Option<[i8; 3]>,
    within_limits: bool,
    of_this_design: bool,
}

impl AssemblyModesJson {
    /// Creates the output for the modes of a design.
    pub fn new(modes: &[AssemblyMode]) -> Self {
        let mode = |mode: &AssemblyMode| AssemblyModeJson {
            pose: PoseJson::new(&mode.pose, mode.pose.phi.to_degrees()),
            working_mode: mode.working_mode.map(WorkingMode::signs),
            within_limits: mode.is_within_limits,
            of_this_design: mode.is_of_design,
        };
        Self {
            modes: modes.iter().map(mode).collect(),
        }
    }
}
