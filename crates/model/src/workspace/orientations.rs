//! Orientations that a search examines, and the windows over them.

use std::ops::Range;

use super::{Grid, GridError, WorkspaceSpec};

/// Evenly spaced orientations: the full turn of a grid, or the single window of a prescribed home orientation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrientationGrid {
    first_deg: f64,
    step_deg: f64,
    /// Number of orientations.
    pub count: usize,
    /// Number of steps from a home orientation to either end of its window.
    pub half_window: usize,
    home_is_given: bool,
}

impl OrientationGrid {
    /// Returns the orientations of `grid` that `spec` requires.
    ///
    /// # Errors
    /// [`GridError::WindowNotWhole`].
    pub fn new(grid: &Grid, spec: &WorkspaceSpec) -> Result<Self, GridError> {
        let half_window = grid.half_window(spec.rotation_range_deg)?;
        let (first_deg, count) = match spec.home_phi_deg {
            Some(home) => (home - half_window as f64 * grid.phi_step_deg(), 2 * half_window + 1),
            None => (0.0, grid.orientations()),
        };
        Ok(Self {
            first_deg,
            step_deg: grid.phi_step_deg(),
            count,
            half_window,
            home_is_given: spec.home_phi_deg.is_some(),
        })
    }

    /// Returns the orientation of index `place` \[deg\]; with a prescribed home orientation it may lie outside
    /// \[0, 360).
    pub fn phi_deg(&self, place: usize) -> f64 {
        self.first_deg + place as f64 * self.step_deg
    }

    /// Returns the indices of the orientations in the window about `home`.
    pub fn window(&self, home: usize) -> impl Iterator<Item = usize> + use<> {
        let (count, half) = (self.count, self.half_window);
        (0..=2 * half).map(move |offset| (home + count - half + offset) % count)
    }

    /// Returns the indices of the orientations that can be the centre of a window.
    pub fn homes(&self) -> Range<usize> {
        if self.home_is_given {
            self.half_window..self.half_window + 1
        } else {
            0..self.count
        }
    }

    /// Returns the home orientations in whose window every orientation has a sign and all signs are equal.
    pub fn homes_of_one_sign(&self, sign: impl Fn(usize) -> Option<f64>) -> impl Iterator<Item = usize> {
        self.homes().filter(move |&home| {
            let first = sign(home);
            first.is_some() && self.window(home).all(|place| sign(place) == first)
        })
    }
}
