//! The region of positions of a study (docs/interfaces.md).

use glam::DVec2;
use serde::{Deserialize, Serialize};

use kinefront_model::polygon::Polygon;
use kinefront_model::workspace::Region;

/// Kind of a region.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RegionKind {
    /// The largest disc about the centre, determined for each design.
    #[default]
    Largest,
    /// A disc of a prescribed radius.
    Disc,
    /// A rectangle with sides along `Ox` and `Oy`.
    Rectangle,
    /// A polygon.
    Polygon,
}

impl RegionKind {
    /// Names of all kinds.
    pub const NAMES: &'static [&'static str] = &["largest", "disc", "rectangle", "polygon"];
}

/// The section `[workspace.region]` of a study.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RegionSection {
    /// Kind of the region.
    pub kind: RegionKind,
    /// Radius of a disc.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radius_m: Option<f64>,
    /// Width of a rectangle along `Ox`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub width_m: Option<f64>,
    /// Height of a rectangle along `Oy`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub height_m: Option<f64>,
    /// Corners of a polygon, relative to the centre of the workspace.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub corners_m: Option<Vec<[f64; 2]>>,
}

impl RegionSection {
    /// Whether the study prescribes the region, so that `R_w` is not determined.
    pub fn is_prescribed(&self) -> bool {
        self.kind != RegionKind::Largest
    }

    /// Returns the region, or the key that is at fault and what is wrong.
    ///
    /// # Errors
    /// The key within the section, and a message.
    pub(crate) fn region(&self) -> Result<Region, (&'static str, String)> {
        let stated = [
            ("radius_m", self.radius_m.is_some(), RegionKind::Disc),
            ("width_m", self.width_m.is_some(), RegionKind::Rectangle),
            ("height_m", self.height_m.is_some(), RegionKind::Rectangle),
            ("corners_m", self.corners_m.is_some(), RegionKind::Polygon),
        ];
        for (key, is_stated, kind) in stated {
            let name = RegionKind::NAMES[kind as usize];
            match (is_stated, kind == self.kind) {
                (true, false) => return Err((key, format!("has no effect unless kind = \"{name}\""))),
                (false, true) => return Err(("kind", format!("is \"{name}\", which also requires `{key}`"))),
                _ => {}
            }
        }
        let length = |key: &'static str, value: Option<f64>| match value {
            Some(value) if (1e-6..=1e6).contains(&value) => Ok(value),
            value => {
                let value = value.unwrap_or_default();
                Err((key, format!("is {value}; it must be a length of 1e-6 m to 1e6 m")))
            }
        };
        match self.kind {
            RegionKind::Largest => Ok(Region::Largest),
            RegionKind::Disc => Ok(Region::Disc(length("radius_m", self.radius_m)?)),
            RegionKind::Rectangle => {
                let (width, height) = (length("width_m", self.width_m)?, length("height_m", self.height_m)?);
                let polygon = Polygon::rectangle(width, height);
                polygon
                    .map(Region::Polygon)
                    .map_err(|error| ("width_m", error.to_string()))
            }
            RegionKind::Polygon => {
                let corners = self.corners_m.iter().flatten().copied().map(DVec2::from_array);
                let polygon = Polygon::new(corners.collect());
                polygon
                    .map(Region::Polygon)
                    .map_err(|error| ("corners_m", error.to_string()))
            }
        }
    }
}
