//! Which poses stand for a disc and a turn (SPEC section 4: reference and fine grid).

/// Sampling of orientations, directions and radii.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Spacing of the orientations over the full turn \[deg\].
    pub phi_step_deg: f64,
    /// Directions over the full turn, from 0°.
    pub directions: usize,
    /// Steps of a ray per base radius `R`.
    pub ray_steps: usize,
    /// Halvings of the step in which a ray fails.
    pub halvings: u32,
}

/// Why a grid cannot be laid.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum GridError {
    /// 360° is no multiple of the step.
    #[error("a step of {0}° does not divide the full turn into whole steps")]
    TurnNotWhole(f64),
    /// The home window does not start and end on the grid.
    #[error("half the rotation range, {half_range_deg}°, is no whole number of steps of {step_deg}°")]
    WindowNotWhole {
        /// Half of `Δφ` \[deg\].
        half_range_deg: f64,
        /// Step \[deg\].
        step_deg: f64,
    },
}

impl Grid {
    /// The grid that `R_w` is defined on.
    pub const REFERENCE: Grid = Grid {
        phi_step_deg: 2.5,
        directions: 36,
        ray_steps: 50,
        halvings: 12,
    };

    /// The grid that a reported design is verified on.
    pub const FINE: Grid = Grid {
        phi_step_deg: 0.5,
        directions: 180,
        ray_steps: 200,
        halvings: 12,
    };

    /// Number of orientations over the full turn.
    ///
    /// # Errors
    /// [`GridError::TurnNotWhole`].
    pub fn orientations(&self) -> Result<usize, GridError> {
        whole(360.0 / self.phi_step_deg).ok_or(GridError::TurnNotWhole(self.phi_step_deg))
    }

    /// Steps from a home orientation to the end of its window, `Δφ/2` away.
    ///
    /// # Errors
    /// [`GridError::WindowNotWhole`].
    pub fn half_window(&self, rotation_range_deg: f64) -> Result<usize, GridError> {
        let half_range_deg = 0.5 * rotation_range_deg;
        whole(half_range_deg / self.phi_step_deg).ok_or(GridError::WindowNotWhole {
            half_range_deg,
            step_deg: self.phi_step_deg,
        })
    }
}

/// `ratio` as a whole number, if it is one to within rounding.
fn whole(ratio: f64) -> Option<usize> {
    let nearest = ratio.round();
    ((0.0..=1e6).contains(&nearest) && (ratio - nearest).abs() <= 1e-9 * nearest.max(1.0)).then_some(nearest as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_two_grids_of_the_specification_are_whole() {
        for (grid, orientations, half) in [(Grid::REFERENCE, 144, 4), (Grid::FINE, 720, 20)] {
            assert_eq!(grid.orientations(), Ok(orientations));
            assert_eq!(grid.half_window(20.0), Ok(half));
        }
        let odd = Grid {
            phi_step_deg: 7.0,
            ..Grid::REFERENCE
        };
        assert!(odd.orientations().is_err() && odd.half_window(20.0).is_err());
    }
}
