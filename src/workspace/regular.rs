//! Largest disc of good poses over a window of orientations, and the home orientation that has it.
//!
//! `R(φ)` costs some thousand poses, and most orientations cannot be the ones that decide: windows are taken best
//! first, by the smallest `R(φ)` known so far of their orientations, and an orientation is only marched when it lies in
//! the window that leads. The result is the defined maximum, not an estimate of it.

use glam::DVec2;

use super::{Grid, GridError, PoseChecker};
use crate::mechanism::Leg;
use crate::spatial::{LEGS, Rotation, unit};

/// Where and over what turn the workspace is asked for (SPEC section 8, no. 7).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorkspaceSpec {
    /// `Δφ` \[deg\].
    pub rotation_range_deg: f64,
    /// Centre of the disc in the base frame \[m\].
    pub centre: DVec2,
    /// Home orientation `φ_c` \[deg\] where it is given; the best one otherwise.
    pub home_phi_deg: Option<f64>,
}

/// How far the disc of one orientation reaches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// `R(φ)`: the lower end of the last bracket \[m\].
    pub radius: f64,
    /// The upper end: a pose at this radius fails in some direction \[m\].
    pub beyond: f64,
}

/// An orientation of the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orientation {
    /// Orientation \[deg\], in \[0, 360).
    pub phi_deg: f64,
    /// `C_i − P` in base axes \[m\].
    pub arms: [DVec2; LEGS],
    /// Sign of `det A` at the centre where the centre pose is good.
    pub centre_sign: Option<f64>,
}

/// Outcome of the search.
#[derive(Debug, Clone, PartialEq)]
pub struct RegularWorkspace {
    /// `R_w` \[m\]; 0 where no window has a disc.
    pub radius: f64,
    /// Index in `orientations` of the home orientation, where `radius` > 0.
    pub home: Option<usize>,
    /// The grid's orientations.
    pub orientations: Vec<Orientation>,
    /// Steps from a home orientation to either end of its window.
    pub half_window: usize,
    /// The home window's `R(φ)`, from its first orientation to its last; empty without a home.
    pub home_rays: Vec<Ray>,
    /// The directions marched.
    pub directions: Vec<DVec2>,
}

impl RegularWorkspace {
    /// Indices of the orientations in the window about orientation `home`.
    pub fn window(&self, home: usize) -> impl Iterator<Item = usize> + use<> {
        window(home, self.half_window, self.orientations.len())
    }

    /// Indices at which a window can have its centre.
    pub fn homes(&self, spec: &WorkspaceSpec) -> std::ops::Range<usize> {
        homes(spec, self.half_window, self.orientations.len())
    }
}

fn window(home: usize, half: usize, count: usize) -> impl Iterator<Item = usize> + use<> {
    (0..=2 * half).map(move |offset| (home + count - half + offset) % count)
}

fn homes(spec: &WorkspaceSpec, half: usize, count: usize) -> std::ops::Range<usize> {
    match spec.home_phi_deg {
        Some(_) => half..half + 1,
        None => 0..count,
    }
}

/// The orientations that a search looks at: the full turn, or the one window of a given home.
///
/// # Errors
/// [`GridError`] when the turn or the window is no whole number of steps.
pub fn orientations<L: Leg>(
    checker: &PoseChecker<L>,
    spec: &WorkspaceSpec,
    grid: &Grid,
) -> Result<Vec<Orientation>, GridError> {
    let half = grid.half_window(spec.rotation_range_deg)?;
    let (first_deg, count) = match spec.home_phi_deg {
        Some(home) => (home - half as f64 * grid.phi_step_deg, 2 * half + 1),
        None => (0.0, grid.orientations()?),
    };
    Ok((0..count)
        .map(|k| {
            let phi_deg = first_deg + k as f64 * grid.phi_step_deg;
            let arms = checker.manipulator.arms(&Rotation::new(phi_deg.to_radians()));
            Orientation {
                phi_deg: libm::fmod(libm::fmod(phi_deg, 360.0) + 360.0, 360.0),
                arms,
                centre_sign: checker.good_sign(spec.centre, &arms),
            }
        })
        .collect())
}

/// Finds the regular workspace of the design in `checker`.
///
/// `step_base` is `R`, which the ray steps are a share of; `symmetric` says that a turn by 120° maps the design on
/// itself, so that one sector of directions suffices.
///
/// # Errors
/// [`GridError`] when the grid does not fit the rotation range.
pub fn search<L: Leg>(
    checker: &PoseChecker<L>,
    spec: &WorkspaceSpec,
    grid: &Grid,
    step_base: f64,
    symmetric: bool,
) -> Result<RegularWorkspace, GridError> {
    let half_window = grid.half_window(spec.rotation_range_deg)?;
    let orientations = orientations(checker, spec, grid)?;
    let sector = if symmetric && grid.directions.is_multiple_of(LEGS) {
        grid.directions / LEGS
    } else {
        grid.directions
    };
    let directions = (0..sector)
        .map(|k| unit((k as f64 * 360.0 / grid.directions as f64).to_radians()))
        .collect();
    let mut result = RegularWorkspace {
        radius: 0.0,
        home: None,
        orientations,
        half_window,
        home_rays: Vec::new(),
        directions,
    };

    let count = result.orientations.len();
    let mut rays: Vec<Option<Ray>> = vec![None; count];
    // Upper bound of each window: infinite until one of its orientations is marched.
    let mut bounds: Vec<f64> = vec![0.0; count];
    for home in result.homes(spec) {
        let mut signs = result.window(home).map(|k| result.orientations[k].centre_sign);
        let first = signs.next().flatten();
        if first.is_some() && signs.all(|sign| sign == first) {
            bounds[home] = f64::INFINITY;
        }
    }
    let order = spread(2 * half_window + 1);
    let step = step_base / grid.ray_steps as f64;
    while let Some(home) = leader(&bounds) {
        let indices: Vec<usize> = result.window(home).collect();
        let Some(&next) = order
            .iter()
            .map(|&offset| &indices[offset])
            .find(|&&k| rays[k].is_none())
        else {
            result.radius = bounds[home];
            result.home = Some(home);
            result.home_rays = indices.iter().filter_map(|&k| rays[k]).collect();
            break;
        };
        let ray = march(
            checker,
            spec.centre,
            &result.orientations[next],
            &result.directions,
            step,
            grid.halvings,
        );
        rays[next] = Some(ray);
        // The windows that hold `next` are those about the orientations of the window about it.
        for affected in window(next, half_window, count) {
            bounds[affected] = bounds[affected].min(ray.radius);
        }
    }
    Ok(result)
}

/// The window with the largest bound above 0, the first among equals.
fn leader(bounds: &[f64]) -> Option<usize> {
    let mut best: Option<usize> = None;
    for (home, &bound) in bounds.iter().enumerate() {
        if bound > best.map_or(0.0, |other| bounds[other]) {
            best = Some(home);
        }
    }
    best
}

/// The numbers 0 … `count` − 1, ends first, then ever finer in between: a window falls soonest by its ends.
fn spread(count: usize) -> Vec<usize> {
    let mut order = vec![0];
    let mut stride = count.next_power_of_two();
    if count > 1 {
        order.push(count - 1);
    }
    while stride > 0 {
        for k in (0..count).step_by(stride) {
            if !order.contains(&k) {
                order.push(k);
            }
        }
        stride /= 2;
    }
    order
}

/// `R(φ)`: rays from the centre in all directions at once, in steps, to the first failing pose, then halvings.
///
/// Rays that pass where another fails reach farther than it, so they are left behind at once; the smallest radius over
/// the directions is the same as if each were marched to its own end.
fn march<L: Leg>(
    checker: &PoseChecker<L>,
    centre: DVec2,
    orientation: &Orientation,
    directions: &[DVec2],
    step: f64,
    halvings: u32,
) -> Ray {
    let Some(sign) = orientation.centre_sign else {
        return Ray {
            radius: 0.0,
            beyond: 0.0,
        };
    };
    let fails =
        |direction: &DVec2, radius: f64| !checker.is_good(centre + *direction * radius, &orientation.arms, sign);
    let mut failing: Vec<DVec2> = Vec::new();
    let mut steps = 0.0;
    while failing.is_empty() {
        // Ends: the reach of every leg is bounded.
        steps += 1.0;
        failing.extend(directions.iter().filter(|direction| fails(direction, steps * step)));
    }
    let (mut radius, mut beyond) = ((steps - 1.0) * step, steps * step);
    for _ in 0..halvings {
        let middle = 0.5 * (radius + beyond);
        let nearer: Vec<DVec2> = failing
            .iter()
            .copied()
            .filter(|direction| fails(direction, middle))
            .collect();
        if nearer.is_empty() {
            radius = middle;
        } else {
            beyond = middle;
            failing = nearer;
        }
    }
    Ray { radius, beyond }
}
