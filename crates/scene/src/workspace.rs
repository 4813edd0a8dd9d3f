//! The regular workspace as a cylinder, on the manipulator and in the configuration space.

use glam::{DVec2, DVec3};

use kinefront_model::evaluation::{Evaluation, Model};
use kinefront_model::workspace::Region;

/// The regular workspace: a disc of positions of `P` over a range of orientations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RegularCylinder {
    /// Centre in the base frame \[m\].
    pub centre: DVec2,
    /// `R_w` \[m\].
    pub radius: f64,
    /// `φ_c` \[rad\].
    pub phi: f64,
    /// `Δφ` \[rad\].
    pub phi_range: f64,
}

/// Returns the regular workspace of a design; `None` if it has none.
pub fn regular_workspace(evaluation: &Evaluation, rotation_range_deg: f64) -> Option<RegularCylinder> {
    let home = evaluation.home?;
    Some(RegularCylinder {
        centre: home.position,
        radius: evaluation.workspace_radius(),
        phi: home.phi,
        phi_range: rotation_range_deg.to_radians(),
    })
}

/// Returns the corners of a prescribed region that is no disc, in the base frame \[m\].
pub fn region_corners(model: &Model) -> Option<Vec<DVec2>> {
    let workspace = &model.settings().workspace;
    match &workspace.region {
        Region::Polygon(polygon) => {
            let corners = polygon.corners().iter();
            Some(corners.map(|corner| workspace.centre + *corner).collect())
        }
        Region::Largest | Region::Disc(_) => None,
    }
}

/// The space of `(x, y, φ)` with φ drawn upwards: the home orientation has height 0 and a quarter turn has height `R`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConfigurationSpace {
    /// Orientation at height 0 \[rad\].
    pub origin: f64,
    /// Height per radian \[m/rad\].
    pub height: f64,
}

impl ConfigurationSpace {
    /// Creates the space about a home orientation \[rad\] for a design of base radius `R` \[m\].
    pub fn new(home: f64, base_radius: f64) -> Self {
        Self {
            origin: home,
            height: base_radius / std::f64::consts::FRAC_PI_2,
        }
    }

    /// Returns the point at which a pose is drawn.
    pub fn place(&self, position: DVec2, phi: f64) -> DVec3 {
        position.extend((phi - self.origin) * self.height)
    }
}
