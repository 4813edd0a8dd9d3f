//! Regular workspace computed literally by its definition (docs/model.md, section 7.1): every ray of every orientation
//! is marched, one pose at a time.
//!
//! Tests and benchmarks compare the search with this implementation. The feasibility of a pose is determined by a
//! function that the caller passes, so that every form of the stiffness can be used.

use glam::DVec2;

use super::WorkspaceSampling;
use crate::spatial::{LEGS, Rotation, unit};

/// Workspace radius and the radii of all windows.
#[derive(Debug, Clone, PartialEq)]
pub struct PlainWorkspace {
    /// Workspace radius `R_w` \[m\]; 0 if no window has a workspace.
    pub radius: f64,
    /// Radius of the window about each orientation of the grid over the full turn \[m\]; 0 if the window has no
    /// workspace.
    pub windows: Vec<f64>,
}

/// Marches all rays and returns the radii of all windows.
///
/// `arms_at` returns `C_i − P` in base axes \[m\] at an orientation of the platform.
/// `feasible_sign` returns the sign of `det A` for a position of `P` and the arms of an orientation if the pose is
/// feasible, otherwise `None`. `step_base` is the base radius `R`, of which the ray step is a fraction.
pub fn plain(
    arms_at: impl Fn(&Rotation) -> [DVec2; LEGS],
    sampling: &WorkspaceSampling,
    step_base: f64,
    feasible_sign: impl Fn(DVec2, &[DVec2; LEGS]) -> Option<f64>,
) -> PlainWorkspace {
    let (spec, grid) = (sampling.spec(), sampling.grid());
    let (count, half) = (grid.orientations(), sampling.orientation_grid().half_window);
    let step = step_base / grid.ray_steps() as f64;
    let rays: Vec<(f64, f64)> = (0..count)
        .map(|k| {
            let arms = arms_at(&Rotation::new((k as f64 * grid.phi_step_deg()).to_radians()));
            let Some(sign) = feasible_sign(spec.centre, &arms) else {
                return (0.0, 0.0);
            };
            let radii = (0..grid.directions()).map(|d| {
                let direction = unit((d as f64 * 360.0 / grid.directions() as f64).to_radians());
                let good = |radius: f64| feasible_sign(spec.centre + direction * radius, &arms) == Some(sign);
                let mut steps = 1.0;
                while good(steps * step) {
                    steps += 1.0;
                }
                let (mut low, mut high) = ((steps - 1.0) * step, steps * step);
                for _ in 0..grid.halvings() {
                    let middle = 0.5 * (low + high);
                    if good(middle) {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                low
            });
            (radii.fold(f64::INFINITY, f64::min), sign)
        })
        .collect();
    let window = |home: usize| (0..=2 * half).map(move |offset| (home + count - half + offset) % count);
    let windows: Vec<f64> = (0..count)
        .map(|home| {
            let sign = rays[home].1;
            if sign == 0.0 || window(home).any(|k| rays[k].1 != sign) {
                return 0.0;
            }
            window(home).map(|k| rays[k].0).fold(f64::INFINITY, f64::min)
        })
        .collect();
    PlainWorkspace {
        radius: windows.iter().copied().fold(0.0, f64::max),
        windows,
    }
}
