//! The poses at which a disc and its orientations are sampled (docs/model.md, section 7.2).

/// Sampling of orientations, directions and radii; every grid divides the full turn into whole steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    phi_step_deg: f64,
    orientations: usize,
    directions: usize,
    ray_steps: usize,
    halvings: u32,
}

/// Reason why a grid cannot be laid out.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum GridError {
    /// 360° is not a multiple of the step.
    #[error("a step of {0}° does not divide the full turn into whole steps")]
    TurnNotWhole(f64),
    /// The home window does not start and end on the grid.
    #[error("half the rotation range, {half_range_deg}°, is not a whole number of steps of {step_deg}°")]
    WindowNotWhole {
        /// Half of `Δφ` \[deg\].
        half_range_deg: f64,
        /// Spacing of the orientations \[deg\].
        step_deg: f64,
    },
    /// The home window does not fit into the full turn.
    #[error("the rotation range of {0}° and one step more do not fit into the full turn")]
    WindowTooWide(f64),
    /// The grid has more poses than a workspace can be searched on in a sensible time.
    #[error(
        "{orientations} orientations × {directions} directions × {ray_steps} ray steps exceed {} poses",
        Grid::MAX_POSES
    )]
    TooFine {
        /// Number of orientations over the full turn.
        orientations: usize,
        /// Number of directions.
        directions: usize,
        /// Number of steps of a ray.
        ray_steps: usize,
    },
    /// A grid without a direction or a step has no pose besides the centre.
    #[error("the number of {0} is 0; it must be at least 1")]
    Empty(&'static str),
}

impl Grid {
    /// Grid on which `R_w` is defined.
    pub const REFERENCE: Grid = Grid {
        phi_step_deg: 2.5,
        orientations: 144,
        directions: 36,
        ray_steps: 50,
        halvings: 12,
    };

    /// Grid on which reported designs are verified.
    pub const FINE: Grid = Grid {
        phi_step_deg: 0.5,
        orientations: 720,
        directions: 180,
        ray_steps: 200,
        halvings: 12,
    };

    /// Largest number of poses of a grid up to the distance `R`, about 40 times that of the fine grid.
    pub const MAX_POSES: usize = 1_000_000_000;

    /// A grid with orientations `phi_step_deg` \[deg\] apart, `directions` over the full turn from 0°, `ray_steps` steps
    /// of a ray per base radius `R`, and `halvings` of the step in which a ray fails.
    ///
    /// ```
    /// use kinefront_model::workspace::{Grid, GridError};
    ///
    /// assert_eq!(Grid::new(2.5, 36, 50, 12)?, Grid::REFERENCE);
    /// assert_eq!(Grid::new(7.0, 36, 50, 12), Err(GridError::TurnNotWhole(7.0)));
    /// # Ok::<(), GridError>(())
    /// ```
    ///
    /// # Errors
    /// [`GridError::TurnNotWhole`], [`GridError::Empty`] or [`GridError::TooFine`].
    pub fn new(phi_step_deg: f64, directions: usize, ray_steps: usize, halvings: u32) -> Result<Self, GridError> {
        for (name, count) in [("directions", directions), ("ray steps", ray_steps)] {
            if count == 0 {
                return Err(GridError::Empty(name));
            }
        }
        let orientations = whole(360.0 / phi_step_deg)
            .filter(|&orientations| orientations > 0)
            .ok_or(GridError::TurnNotWhole(phi_step_deg))?;
        let poses = orientations
            .checked_mul(directions)
            .and_then(|rays| rays.checked_mul(ray_steps));
        if poses.is_none_or(|poses| poses > Self::MAX_POSES) {
            return Err(GridError::TooFine {
                orientations,
                directions,
                ray_steps,
            });
        }
        Ok(Self {
            phi_step_deg,
            orientations,
            directions,
            ray_steps,
            halvings,
        })
    }

    /// Spacing of the orientations over the full turn \[deg\].
    pub fn phi_step_deg(&self) -> f64 {
        self.phi_step_deg
    }

    /// Returns the number of orientations over the full turn.
    pub fn orientations(&self) -> usize {
        self.orientations
    }

    /// Number of directions over the full turn, from 0°.
    pub fn directions(&self) -> usize {
        self.directions
    }

    /// Number of steps of a ray per base radius `R`.
    pub fn ray_steps(&self) -> usize {
        self.ray_steps
    }

    /// Number of halvings of the step in which a ray fails.
    pub fn halvings(&self) -> u32 {
        self.halvings
    }

    /// Returns the length to which the end of a ray is determined, for steps of a length `step` along it.
    pub fn resolution(&self, step: f64) -> f64 {
        step / f64::from(1u32 << self.halvings.min(30))
    }

    /// Returns the number of steps from a home orientation to the end of its window, `Δφ/2` away.
    ///
    /// # Errors
    /// [`GridError::WindowNotWhole`] when `Δφ/2` is not a multiple of the step, [`GridError::WindowTooWide`] when the
    /// window would contain an orientation twice.
    pub fn half_window(&self, rotation_range_deg: f64) -> Result<usize, GridError> {
        let half_range_deg = 0.5 * rotation_range_deg;
        let half = whole(half_range_deg / self.phi_step_deg).ok_or(GridError::WindowNotWhole {
            half_range_deg,
            step_deg: self.phi_step_deg,
        })?;
        if 2 * half < self.orientations {
            Ok(half)
        } else {
            Err(GridError::WindowTooWide(rotation_range_deg))
        }
    }
}

/// Returns `ratio` as a whole number, if it is one to within rounding.
fn whole(ratio: f64) -> Option<usize> {
    let nearest = ratio.round();
    ((0.0..=1e6).contains(&nearest) && (ratio - nearest).abs() <= 1e-9 * nearest.max(1.0)).then_some(nearest as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_two_grids_are_as_if_built() {
        for (grid, half) in [(Grid::REFERENCE, 4), (Grid::FINE, 20)] {
            let built = Grid::new(grid.phi_step_deg, grid.directions, grid.ray_steps, grid.halvings);
            assert_eq!(built, Ok(grid));
            assert_eq!(grid.half_window(20.0), Ok(half));
        }
    }

    #[test]
    fn a_grid_that_cannot_be_laid_is_refused() {
        for step in [7.0, 0.0, -2.5, f64::NAN, f64::INFINITY] {
            assert!(
                matches!(Grid::new(step, 36, 50, 12), Err(GridError::TurnNotWhole(_))),
                "{step}"
            );
        }
        assert_eq!(Grid::new(2.5, 0, 50, 12), Err(GridError::Empty("directions")));
        assert_eq!(Grid::new(2.5, 36, 0, 12), Err(GridError::Empty("ray steps")));
        assert!(matches!(
            Grid::new(0.01, 3600, 10_000, 12),
            Err(GridError::TooFine { .. })
        ));
        assert!(matches!(
            Grid::new(2.5, usize::MAX, 50, 12),
            Err(GridError::TooFine { .. })
        ));
        assert!(Grid::REFERENCE.half_window(7.0).is_err());
        assert_eq!(Grid::REFERENCE.half_window(355.0), Ok(71));
        for range in [360.0, 1000.0] {
            assert_eq!(Grid::REFERENCE.half_window(range), Err(GridError::WindowTooWide(range)));
        }
    }
}
