//! Search for the largest disc of feasible poses over a window of orientations, and for its home orientation
//! (docs/model.md, section 7.3).
//!
//! Computing `R(φ)` takes some thousand poses, and most orientations cannot be the ones that determine the result.
//! Windows are therefore examined best first, in the order of the smallest upper bound of `R(φ)` known so far over
//! their orientations. In the leading window, single rings are probed first, which lowers its bound cheaply where it is
//! too high. Orientations that this does not rule out are marched ring by ring, no farther than the bound. Only the
//! orientations that set the bound are computed to the last halving. The result is the maximum as defined, not an
//! estimate of it.

use glam::DVec2;

use super::batch::OrientationLanes;
use super::region::directions;
use super::rings::{InOrientation, Reach, Rings};
use super::{ArmColumns, Grid, OrientationGrid, ValueColumns, WorkspaceSampling};
use crate::mechanism::Leg;
use crate::pose::{PoseChecker, PoseScalar, PoseScalars};
use crate::spatial::{LEGS, Rotation};

/// An orientation of the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orientation {
    /// Orientation \[deg\], in \[0, 360).
    pub phi_deg: f64,
    /// `C_i − P` in base axes \[m\].
    pub arms: [DVec2; LEGS],
    /// Sign of `det A` at the centre if the centre pose is feasible.
    pub centre_sign: Option<f64>,
}

/// Result of the search.
#[derive(Debug, Clone)]
pub struct RegularWorkspace {
    /// Workspace radius `R_w` \[m\]; 0 if no window has a disc of feasible poses.
    pub radius: f64,
    /// Index of the home orientation in `orientations`; `None` if `radius` is 0.
    pub home: Option<usize>,
    /// Orientations of the grid.
    pub orientations: Vec<Orientation>,
    /// Spacing of the orientations, and the windows over them.
    pub orientation_grid: OrientationGrid,
    /// Orientations of the home window whose `R(φ)` equals `radius`, each with a radius just beyond it at which a pose
    /// is infeasible in some direction \[m\]. Without a home orientation, one such orientation of a window that turned
    /// out to be empty, if there was one.
    pub limits: Vec<(usize, f64)>,
    /// Values at the centre for every orientation.
    pub centres: ValueColumns,
    /// Directions in which rays are marched.
    pub directions: Vec<DVec2>,
    /// Sign of `det A` in the home orientation.
    pub home_sign: f64,
    /// Positions at which a prescribed region was examined; empty for the largest disc.
    pub samples: Vec<DVec2>,
    /// The worst values over the samples of the limited scalars that take long, for the orientations of the home window and some
    /// others, with their signs reversed where smaller values are better; empty for the largest disc, and without such limits.
    pub slow: Vec<PoseScalars<f64>>,
}

/// Returns the orientations that the search examines, and the values at their centre poses.
pub(super) fn orientations<L: Leg>(
    checker: &PoseChecker<L>,
    centre: DVec2,
    orientation_grid: &OrientationGrid,
) -> (Vec<Orientation>, ValueColumns) {
    let mut orientations: Vec<Orientation> = (0..orientation_grid.count)
        .map(|k| {
            let phi_deg = orientation_grid.phi_deg(k);
            Orientation {
                phi_deg: libm::fmod(libm::fmod(phi_deg, 360.0) + 360.0, 360.0),
                arms: checker.manipulator.arms(&Rotation::new(phi_deg.to_radians())),
                centre_sign: None,
            }
        })
        .collect();
    let arms = ArmColumns::new(orientations.iter().map(|orientation| orientation.arms));
    let centres = checker.in_orientations(centre, &arms);
    let limits: Vec<(PoseScalar, f64)> = checker.thresholds.iter().collect();
    for (index, orientation) in orientations.iter_mut().enumerate() {
        let mut sign = None;
        let is_feasible = centres.keeps(index, &limits, &mut sign);
        orientation.centre_sign = sign.filter(|_| is_feasible);
    }
    (orientations, centres)
}

/// Finds the regular workspace of the design in `checker`.
///
/// `step_base` is the base radius `R`, of which the ray step is a fraction. `symmetric` states that a rotation by 120°
/// maps the design onto itself, so that one sector of directions suffices.
pub fn search<L: Leg>(
    checker: &PoseChecker<L>,
    sampling: &WorkspaceSampling,
    step_base: f64,
    symmetric: bool,
) -> RegularWorkspace {
    let (spec, grid, orientation_grid) = (sampling.spec(), sampling.grid(), *sampling.orientation_grid());
    let (orientations, centres) = orientations(checker, spec.centre, &orientation_grid);
    let directions = directions(grid, symmetric);
    let mut result = RegularWorkspace {
        radius: 0.0,
        home: None,
        orientations,
        orientation_grid,
        limits: Vec::new(),
        centres,
        directions: Vec::new(),
        home_sign: 1.0,
        samples: Vec::new(),
        slow: Vec::new(),
    };
    let step = step_base / grid.ray_steps() as f64;
    let mut search = Search {
        checker,
        grid,
        rings: Rings::new(spec.centre, directions, step),
        reaches: vec![Reach::UNKNOWN; result.orientations.len()],
        hint: grid.ray_steps() / 4,
        order: spread(2 * orientation_grid.half_window + 1),
        found: &mut result,
    };
    search.run();
    result.directions = search.rings.directions;
    result.home_sign = result
        .home
        .and_then(|home| result.orientations[home].centre_sign)
        .unwrap_or(1.0);
    result
}

struct Search<'a, L> {
    checker: &'a PoseChecker<L>,
    grid: &'a Grid,
    rings: Rings,
    /// Known rings of every orientation.
    reaches: Vec<Reach>,
    /// Ring near which the orientations examined last failed.
    hint: usize,
    /// Order in which the orientations of a window are examined.
    order: Vec<usize>,
    found: &'a mut RegularWorkspace,
}

impl<L: Leg> Search<'_, L> {
    fn run(&mut self) {
        let orientation_grid = self.found.orientation_grid;
        // Upper bound of each window: infinite until a ring of one of its orientations is known to fail.
        let mut bounds: Vec<f64> = vec![0.0; orientation_grid.count];
        for home in orientation_grid.homes_of_one_sign(|place| self.found.orientations[place].centre_sign) {
            bounds[home] = f64::INFINITY;
        }
        while let Some((home, rival)) = leader(&bounds) {
            let window: Vec<usize> = orientation_grid.window(home).collect();
            while bounds[home] > 0.0 {
                let Some(changed) = self.lower(&window) else {
                    self.found.radius = bounds[home];
                    self.found.home = Some(home);
                    self.found.limits = window
                        .iter()
                        .filter_map(|&k| Some((k, self.reaches[k].bracket?)))
                        .filter(|(_, bracket)| bracket.radius == bounds[home])
                        .map(|(k, bracket)| (k, bracket.beyond))
                        .collect();
                    return;
                };
                // An orientation belongs to the windows of exactly those home orientations that lie in the window about
                // it.
                let bound = self.rings.bound(&self.reaches[changed]);
                for affected in orientation_grid.window(changed) {
                    bounds[affected] = bounds[affected].min(bound);
                }
                if bounds[home] == 0.0 && self.found.limits.is_empty() {
                    // This orientation prevents the first empty window from having a workspace.
                    let beyond = self.reaches[changed].bracket.map(|bracket| (changed, bracket.beyond));
                    self.found.limits.extend(beyond);
                }
                if bounds[home] <= rival {
                    break;
                }
            }
        }
    }

    /// Examines an orientation of the leading window that may lower its bound, by the cheapest means not yet tried, and
    /// returns the index of that orientation. Returns `None` when the bound of the window is its radius.
    fn lower(&mut self, window: &[usize]) -> Option<usize> {
        let Self {
            checker,
            grid,
            rings,
            reaches,
            hint,
            order,
            found,
        } = self;
        let at = |k: usize| InOrientation {
            checker,
            oriented: OrientationLanes {
                arms: &found.orientations[k].arms,
                // The centres of a leading window are feasible and have one sign.
                sign: found.orientations[k].centre_sign.unwrap_or(1.0),
            },
        };
        let last = window.iter().map(|&k| reaches[k].failing).min().unwrap_or(usize::MAX);
        for &offset in order.iter() {
            let k = window[offset];
            let reach = &mut reaches[k];
            if reach.failing > last && reach.good.max(reach.probed) < last || last == usize::MAX {
                let start = if last == usize::MAX { *hint } else { last };
                rings.estimate(at(k), reach, start, last);
                if reach.failing <= last {
                    *hint = reach.failing;
                    return Some(k);
                }
            }
        }
        for &offset in order.iter() {
            let k = window[offset];
            let reach = &mut reaches[k];
            let known = reach.failing;
            rings.march(at(k), reach, last.min(known - 1));
            if reach.failing < known {
                return Some(k);
            }
        }
        let k = *window
            .iter()
            .find(|&&k| reaches[k].failing == last && reaches[k].bracket.is_none())?;
        rings.halve(at(k), &mut reaches[k], grid);
        Some(k)
    }
}

/// Returns the window with the largest bound above 0 (the first one among equals), and the largest bound of the other
/// windows.
fn leader(bounds: &[f64]) -> Option<(usize, f64)> {
    let (mut best, mut largest, mut rival) = (None, 0.0, 0.0);
    for (home, &bound) in bounds.iter().enumerate() {
        if bound > largest {
            rival = largest;
            (best, largest) = (Some(home), bound);
        } else if bound > rival {
            rival = bound;
        }
    }
    best.map(|home| (home, rival))
}

/// Returns the numbers 0 … `count` − 1, beginning with both ends and then in steps that become ever finer: the ends of
/// a window lower its bound soonest.
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
