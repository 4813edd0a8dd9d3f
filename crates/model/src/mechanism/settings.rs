//! Settings of the legs that the study fixes in addition to the design vector.

use super::Geometry;

/// Length of a telescopic bar in the beam model (docs/model.md, section 11).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BarLength {
    /// Current length `ρ_i` of the leg.
    Current,
    /// Largest length `L_b`, independent of the pose.
    Longest,
}

/// Settings of the legs that the study fixes in addition to the design vector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegSettings {
    /// Beam length of a telescopic leg.
    pub telescopic_bar: BarLength,
    /// Smallest length of a telescopic leg as a fraction of `L_b`, in \[0, 1).
    pub telescopic_shortest: f64,
    /// Arrangement of the joints and travel of the guides.
    pub geometry: Geometry,
}

impl Default for LegSettings {
    fn default() -> Self {
        Self {
            telescopic_bar: BarLength::Current,
            telescopic_shortest: 0.5,
            geometry: Geometry::default(),
        }
    }
}
