//! What workspace is looked for.

use glam::DVec2;

use super::Region;

/// Centre, rotation range and home orientation of the regular workspace (docs/model.md, sections 7.1 and 11).
#[derive(Debug, Clone, PartialEq)]
pub struct WorkspaceSpec {
    /// Region of positions about the centre.
    pub region: Region,
    /// Rotation range `Δφ` \[deg\].
    pub rotation_range_deg: f64,
    /// Centre of the region in the base frame \[m\].
    pub centre: DVec2,
    /// Home orientation `φ_c` \[deg\] if it is prescribed; `None` selects the best one.
    pub home_phi_deg: Option<f64>,
}
