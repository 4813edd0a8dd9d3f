//! What stands beside the manipulator: obstacles and a room (docs/model.md, section 8.3).

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::{RegionKind, RegionSection, wrong_name};
use kinefront_model::clearance::{Obstacle, ObstacleShape};
use kinefront_model::polygon::Polygon;
use kinefront_model::workspace::Region;

/// One of the sections `[[obstacles]]`: an upright body that no member may touch.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ObstacleSection {
    /// Name, as messages show it.
    pub name: String,
    /// Outline: a disc, a rectangle or a polygon.
    pub kind: RegionKind,
    /// Middle of a disc or a rectangle, and origin of the corners of a polygon, in the base frame.
    pub centre_m: [f64; 2],
    /// Radius of a disc.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radius_m: Option<f64>,
    /// Width of a rectangle along `Ox`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub width_m: Option<f64>,
    /// Height of a rectangle along `Oy`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub height_m: Option<f64>,
    /// Corners of a polygon.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub corners_m: Option<Vec<[f64; 2]>>,
    /// Lowest and highest point above the layer of the platform bars; if omitted, the body has no end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub heights_m: Option<[f64; 2]>,
}

/// The section `[room]`: the outline that no member may leave.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RoomSection {
    /// Outline: a rectangle or a polygon.
    pub kind: RegionKind,
    /// Middle of a rectangle, and origin of the corners of a polygon, in the base frame.
    pub centre_m: [f64; 2],
    /// Width of a rectangle along `Ox`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub width_m: Option<f64>,
    /// Height of a rectangle along `Oy`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub height_m: Option<f64>,
    /// Corners of a polygon.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub corners_m: Option<Vec<[f64; 2]>>,
}

/// A key that is at fault, and what is wrong.
type KeyFault = (&'static str, String);

fn centre(centre: [f64; 2]) -> Result<DVec2, KeyFault> {
    let is_usable = centre.iter().all(|part| part.abs() <= 1e6);
    let message = || format!("is {centre:?}; both must be numbers within ±1e6 m");
    is_usable
        .then_some(DVec2::from_array(centre))
        .ok_or_else(|| ("centre_m", message()))
}

impl ObstacleSection {
    /// Returns the obstacle, or the key that is at fault and what is wrong.
    ///
    /// # Errors
    /// The key within the section, and a message.
    pub(crate) fn obstacle(&self) -> Result<Obstacle, KeyFault> {
        if self.name.is_empty() {
            return Err(("name", "is missing; messages and drawings show it".to_owned()));
        }
        if let Some(message) = wrong_name(&self.name) {
            return Err(("name", message));
        }
        let outline = RegionSection {
            kind: self.kind,
            radius_m: self.radius_m,
            width_m: self.width_m,
            height_m: self.height_m,
            corners_m: self.corners_m.clone(),
        };
        let centre = centre(self.centre_m)?;
        let shape = match outline.region()? {
            Region::Largest => {
                return Err((
                    "kind",
                    "is missing; an obstacle is a \"disc\", a \"rectangle\" or a \"polygon\"".to_owned(),
                ));
            }
            Region::Disc(radius) => ObstacleShape::Disc { centre, radius },
            Region::Polygon(polygon) => ObstacleShape::Polygon(polygon.mapped(|corner| centre + corner)),
        };
        let heights = self.heights_m.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        let [low, high] = heights;
        let is_range = low < high;
        if !is_range || self.heights_m.is_some() && heights.iter().any(|height| height.abs() > 1e6) {
            let message = format!("is {heights:?}; the second height must be above the first, both within ±1e6 m");
            return Err(("heights_m", message));
        }
        Ok(Obstacle {
            name: self.name.as_str().into(),
            shape,
            heights,
        })
    }
}

impl RoomSection {
    /// Returns the outline, or the key that is at fault and what is wrong.
    ///
    /// # Errors
    /// The key within the section, and a message.
    pub(crate) fn outline(&self) -> Result<Polygon, KeyFault> {
        let outline = RegionSection {
            kind: self.kind,
            width_m: self.width_m,
            height_m: self.height_m,
            corners_m: self.corners_m.clone(),
            ..RegionSection::default()
        };
        let wrong = match self.kind {
            RegionKind::Largest => Some("is missing; a room is a \"rectangle\" or a \"polygon\""),
            RegionKind::Disc => Some("is \"disc\"; a room is a \"rectangle\" or a \"polygon\""),
            _ => None,
        };
        if let Some(message) = wrong {
            return Err(("kind", message.to_owned()));
        }
        let centre = centre(self.centre_m)?;
        match outline.region()? {
            Region::Polygon(polygon) => Ok(polygon.mapped(|corner| centre + corner)),
            Region::Largest | Region::Disc(_) => unreachable!("the kind is that of a polygon"),
        }
    }
}
