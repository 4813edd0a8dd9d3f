//! The grids of a study.

use serde::{Deserialize, Deserializer, Serialize};

use kinefront_model::workspace::{Grid, GridError};

/// One sampling grid.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GridSection {
    /// Spacing of orientations.
    pub phi_step_deg: f64,
    /// Number of directions over the full turn.
    pub directions: usize,
    /// Number of steps of a ray per length `R`.
    pub ray_steps: usize,
    /// Number of halvings of the first failing step of a ray.
    pub halvings: u32,
}

impl From<Grid> for GridSection {
    fn from(grid: Grid) -> Self {
        Self {
            phi_step_deg: grid.phi_step_deg(),
            directions: grid.directions(),
            ray_steps: grid.ray_steps(),
            halvings: grid.halvings(),
        }
    }
}

impl TryFrom<&GridSection> for Grid {
    type Error = GridError;

    fn try_from(section: &GridSection) -> Result<Self, GridError> {
        Grid::new(
            section.phi_step_deg,
            section.directions,
            section.ray_steps,
            section.halvings,
        )
    }
}

/// What a study states of a grid.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct StatedGrid {
    phi_step_deg: Option<f64>,
    directions: Option<usize>,
    ray_steps: Option<usize>,
    halvings: Option<u32>,
}

impl StatedGrid {
    /// Reads what is stated of a grid; what is not stated is that of `default`.
    fn read<'de, D: Deserializer<'de>>(section: D, default: Grid) -> Result<GridSection, D::Error> {
        let stated = Self::deserialize(section)?;
        let default = GridSection::from(default);
        Ok(GridSection {
            phi_step_deg: stated.phi_step_deg.unwrap_or(default.phi_step_deg),
            directions: stated.directions.unwrap_or(default.directions),
            ray_steps: stated.ray_steps.unwrap_or(default.ray_steps),
            halvings: stated.halvings.unwrap_or(default.halvings),
        })
    }
}

/// Grids for the search and for the verification.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Grids {
    /// Reference grid, used in the search.
    #[serde(deserialize_with = "reference_grid")]
    pub reference: GridSection,
    /// Fine grid, on which reported designs are verified.
    #[serde(deserialize_with = "fine_grid")]
    pub fine: GridSection,
}

fn reference_grid<'de, D: Deserializer<'de>>(section: D) -> Result<GridSection, D::Error> {
    StatedGrid::read(section, Grid::REFERENCE)
}

fn fine_grid<'de, D: Deserializer<'de>>(section: D) -> Result<GridSection, D::Error> {
    StatedGrid::read(section, Grid::FINE)
}

impl Default for Grids {
    fn default() -> Self {
        Self {
            reference: Grid::REFERENCE.into(),
            fine: Grid::FINE.into(),
        }
    }
}
