//! Largest disc of good poses over a window of orientations, and the home orientation that has it.
//!
//! `R(φ)` costs some thousand poses, and most orientations cannot be the ones that decide: windows are taken best
//! first, by the smallest bound of `R(φ)` known so far of their orientations. Of the window that leads, single rings are
//! probed first, which lowers its bound cheaply where it is too high; what withstands that is marched ring by ring, no
//! farther than the bound; and only the orientations that set the bound are worked out to the last halving. The result
//! is the defined maximum, not an estimate of it.

use glam::DVec2;

use super::batch::Oriented;
use super::rings::{Reach, Rings};
use super::{ArmColumns, Grid, PoseChecker, Turn, ValueColumns, WorkspaceSampling};
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
#[derive(Debug, Clone)]
pub struct RegularWorkspace {
    /// `R_w` \[m\]; 0 where no window has a disc.
    pub radius: f64,
    /// Index in `orientations` of the home orientation, where `radius` > 0.
    pub home: Option<usize>,
    /// The grid's orientations.
    pub orientations: Vec<Orientation>,
    /// How they are spaced, and the windows over them.
    pub turn: Turn,
    /// The orientations of the home window that `radius` is the `R(φ)` of, and for each a radius just beyond, at which
    /// a pose fails in some direction \[m\]. Without a home, one such of a window that came out empty, if there was one.
    pub limits: Vec<(usize, f64)>,
    /// Values at the centre, orientation by orientation.
    pub centres: ValueColumns,
    /// The directions marched.
    pub directions: Vec<DVec2>,
}

/// The orientations that a search looks at, with what is known of their centres.
fn orientations<L: Leg>(
    checker: &PoseChecker<L>,
    spec: &WorkspaceSpec,
    turn: &Turn,
) -> (Vec<Orientation>, ValueColumns) {
    let mut orientations: Vec<Orientation> = (0..turn.count)
        .map(|k| {
            let phi_deg = turn.phi_deg(k);
            Orientation {
                phi_deg: libm::fmod(libm::fmod(phi_deg, 360.0) + 360.0, 360.0),
                arms: checker.manipulator.arms(&Rotation::new(phi_deg.to_radians())),
                centre_sign: None,
            }
        })
        .collect();
    let arms = ArmColumns::new(orientations.iter().map(|orientation| orientation.arms));
    let centres = checker.in_orientations(spec.centre, &arms);
    for (index, orientation) in orientations.iter_mut().enumerate() {
        orientation.centre_sign = centres
            .get(index)
            .ok()
            .filter(|values| values.determinant != 0.0 && checker.thresholds.hold(values))
            .map(|values| values.determinant.signum());
    }
    (orientations, centres)
}

/// Finds the regular workspace of the design in `checker`.
///
/// `step_base` is `R`, which the ray steps are a share of; `symmetric` says that a turn by 120° maps the design on
/// itself, so that one sector of directions suffices.
pub fn search<L: Leg>(
    checker: &PoseChecker<L>,
    sampling: &WorkspaceSampling,
    step_base: f64,
    symmetric: bool,
) -> RegularWorkspace {
    let (spec, grid, turn) = (sampling.spec(), sampling.grid(), *sampling.turn());
    let (orientations, centres) = orientations(checker, spec, &turn);
    let sector = if symmetric && grid.directions().is_multiple_of(LEGS) {
        grid.directions() / LEGS
    } else {
        grid.directions()
    };
    let directions = (0..sector)
        .map(|k| unit((k as f64 * 360.0 / grid.directions() as f64).to_radians()))
        .collect();
    let mut result = RegularWorkspace {
        radius: 0.0,
        home: None,
        orientations,
        turn,
        limits: Vec::new(),
        centres,
        directions: Vec::new(),
    };
    let step = step_base / grid.ray_steps() as f64;
    let mut search = Search {
        checker,
        grid,
        rings: Rings::new(spec.centre, directions, step),
        reaches: vec![Reach::UNKNOWN; result.orientations.len()],
        hint: grid.ray_steps() / 4,
        order: spread(2 * turn.half_window + 1),
        found: &mut result,
    };
    search.run();
    result.directions = search.rings.directions;
    result
}

struct Search<'a, L> {
    checker: &'a PoseChecker<L>,
    grid: &'a Grid,
    rings: Rings,
    /// Orientation by orientation.
    reaches: Vec<Reach>,
    /// A ring near which orientations lately failed.
    hint: usize,
    /// The order in which a window's orientations are looked at.
    order: Vec<usize>,
    found: &'a mut RegularWorkspace,
}

impl<L: Leg> Search<'_, L> {
    fn run(&mut self) {
        let turn = self.found.turn;
        // Upper bound of each window: infinite until a ring of one of its orientations is known to fail.
        let mut bounds: Vec<f64> = vec![0.0; turn.count];
        for home in turn.homes_of_one_sign(|place| self.found.orientations[place].centre_sign) {
            bounds[home] = f64::INFINITY;
        }
        while let Some((home, rival)) = leader(&bounds) {
            let window: Vec<usize> = turn.window(home).collect();
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
                // The windows that hold an orientation are those about the orientations of the window about it.
                let bound = self.rings.bound(&self.reaches[changed]);
                for affected in turn.window(changed) {
                    bounds[affected] = bounds[affected].min(bound);
                }
                if bounds[home] == 0.0 && self.found.limits.is_empty() {
                    // What keeps the first of the windows that came out empty from having a workspace.
                    let beyond = self.reaches[changed].bracket.map(|bracket| (changed, bracket.beyond));
                    self.found.limits.extend(beyond);
                }
                if bounds[home] <= rival {
                    break;
                }
            }
        }
    }

    /// Learns more of an orientation of the leading window that may lower its bound, by the cheapest means that has not
    /// been tried, and gives it; `None` when the window's bound is its radius.
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
        let oriented = |k: usize| Oriented {
            arms: &found.orientations[k].arms,
            // A leading window has good centres of one sign.
            sign: found.orientations[k].centre_sign.unwrap_or(1.0),
        };
        let last = window.iter().map(|&k| reaches[k].failing).min().unwrap_or(usize::MAX);
        for &offset in order.iter() {
            let k = window[offset];
            let reach = &mut reaches[k];
            if reach.failing > last && reach.good.max(reach.probed) < last || last == usize::MAX {
                rings.estimate(
                    checker,
                    oriented(k),
                    reach,
                    if last == usize::MAX { *hint } else { last },
                    last,
                );
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
            rings.march(checker, oriented(k), reach, last.min(known - 1));
            if reach.failing < known {
                return Some(k);
            }
        }
        let k = *window
            .iter()
            .find(|&&k| reaches[k].failing == last && reaches[k].bracket.is_none())?;
        rings.halve(checker, oriented(k), &mut reaches[k], grid);
        Some(k)
    }
}

/// The window with the largest bound above 0, the first among equals, and the largest bound of the others.
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
