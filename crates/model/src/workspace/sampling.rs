//! A workspace to be found, and the grid that it is sampled on.

use super::{Grid, GridError, OrientationGrid, WorkspaceSpec};

/// A [`WorkspaceSpec`] and a [`Grid`] that fit each other.
#[derive(Debug, Clone, PartialEq)]
pub struct WorkspaceSampling {
    spec: WorkspaceSpec,
    grid: Grid,
    orientation_grid: OrientationGrid,
}

impl WorkspaceSampling {
    /// The sampling of a workspace on a grid.
    ///
    /// # Errors
    /// [`GridError::WindowNotWhole`] when half the rotation range is no whole number of the grid's orientation steps.
    pub fn new(spec: WorkspaceSpec, grid: Grid) -> Result<Self, GridError> {
        let orientation_grid = OrientationGrid::new(&grid, &spec)?;
        Ok(Self {
            spec,
            grid,
            orientation_grid,
        })
    }

    /// The workspace to be found.
    pub fn spec(&self) -> &WorkspaceSpec {
        &self.spec
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The orientations that are sampled, and the windows over them.
    pub fn orientation_grid(&self) -> &OrientationGrid {
        &self.orientation_grid
    }
}
