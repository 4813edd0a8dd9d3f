//! What stands beside the manipulator: obstacles and a room (docs/model.md, section 8.3).

use glam::DVec2;

use super::declare::{Check, Initial, Setting, section};
use super::{RegionKind, RegionSection, wrong_name};
use kinefront_model::clearance::{Obstacle, ObstacleShape};
use kinefront_model::polygon::Polygon;
use kinefront_model::workspace::Region;

section! {
    /// One of the sections `[[obstacles]]`: an upright body that no member may touch.
    pub struct ObstacleSection in "obstacles" {
        /// Name, as messages show it.
        name: String = String::new(), Check::Name;
        /// Outline: a disc, a rectangle or a polygon.
        kind: RegionKind = RegionKind::default(), Check::Choice(OUTLINES);
        /// Middle of a disc or a rectangle, and origin of the corners of a polygon, in the base frame.
        centre_m: [f64; 2] = [0.0; 2], Check::Finite;
        optional {
            /// Radius of a disc.
            radius_m: f64, Check::Positive, Initial::AsText;
            /// Width of a rectangle along `Ox`.
            width_m: f64, Check::Positive, Initial::AsText;
            /// Height of a rectangle along `Oy`.
            height_m: f64, Check::Positive, Initial::AsText;
            /// Corners of a polygon.
            corners_m: Vec<[f64; 2]>, Check::Finite, Initial::AsText;
            /// Lowest and highest point above the layer of the platform bars; if omitted, its height is unlimited.
            heights_m: [f64; 2], Check::Finite, Initial::AsText;
        }
    }
}

section! {
    /// The section `[room]`: the outline that no member may leave.
    pub struct RoomSection in "room" {
        /// Outline: a rectangle or a polygon.
        kind: RegionKind = RegionKind::default(), Check::Choice(OUTLINES_OF_ROOM);
        /// Middle of a rectangle, and origin of the corners of a polygon, in the base frame.
        centre_m: [f64; 2] = [0.0; 2], Check::Finite;
        optional {
            /// Width of a rectangle along `Ox`.
            width_m: f64, Check::Positive, Initial::AsText;
            /// Height of a rectangle along `Oy`.
            height_m: f64, Check::Positive, Initial::AsText;
            /// Corners of a polygon.
            corners_m: Vec<[f64; 2]>, Check::Finite, Initial::AsText;
        }
    }
}

const OUTLINES: &[&str] = &["disc", "rectangle", "polygon"];
const OUTLINES_OF_ROOM: &[&str] = &["rectangle", "polygon"];

/// Iterates over the settings of an obstacle and of the room, which [`super::settings`] does not hold: their sections may be absent, or
/// occur several times, and are checked as a whole.
pub fn settings_of_surroundings() -> impl Iterator<Item = &'static Setting> {
    ObstacleSection::SETTINGS.iter().chain(RoomSection::SETTINGS)
}

/// A key that is at fault, and what is wrong.
pub type KeyFault = (&'static str, String);

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
    pub fn obstacle(&self) -> Result<Obstacle, KeyFault> {
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
