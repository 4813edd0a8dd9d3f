//! A pose as JSON. Keys are a contract: new ones may be added, none may be renamed.

use serde::Serialize;

use kinefront_model::spatial::Pose;

/// A pose of the platform.
#[derive(Debug, Serialize)]
pub struct PoseJson {
    /// Abscissa of the platform's centre \[m\].
    pub x_m: f64,
    /// Ordinate of the platform's centre \[m\].
    pub y_m: f64,
    /// Orientation \[deg\].
    pub phi_deg: f64,
}

impl PoseJson {
    /// Creates the output for a pose whose orientation is known in degrees.
    pub fn new(pose: &Pose, phi_deg: f64) -> Self {
        Self {
            x_m: pose.position.x,
            y_m: pose.position.y,
            phi_deg,
        }
    }
}
