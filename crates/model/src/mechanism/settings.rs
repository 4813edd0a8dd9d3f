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

impl LegSettings {
    /// Returns the length of the tube of a telescopic leg whose largest length is `link_length` \[m\]: half of that, so that the leg can
    /// retract to half of it. If the smallest leg length is shorter than that, the tube has this length and the rod can protrude behind
    /// it.
    pub fn tube_length(&self, link_length: f64) -> f64 {
        link_length * self.telescopic_shortest.min(0.5)
    }
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
