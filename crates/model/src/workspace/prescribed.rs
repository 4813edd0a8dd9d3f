//! The home orientation of a prescribed region: the one with the best worst margin (docs/model.md, section 7.4).
//!
//! The worst margin of an orientation over a few positions of the boundary bounds that over the whole region. Windows are
//! therefore examined best first, and only the orientations of leading windows are examined at all positions.

use glam::DVec2;
use pulp::{Simd, WithSimd};

use super::batch::OrientationLanes;
use super::columns::Positions;
use super::region::directions;
use super::regular::{RegularWorkspace, orientations};
use super::{PoseChecker, Region, WorkspaceSampling};
use crate::lanes::{Lanes, MAX_LANES, Planar, Real};
use crate::mechanism::Leg;

/// Margin of a window that a singularity cuts: as if a constraint were missed entirely.
const CUT: f64 = -1.0;

/// Finds the home orientation of the prescribed region of the design in `checker`, and the worst margin over its window.
///
/// `step_base` is the base radius `R`, by which margins of lengths are divided and of which the ray step is a fraction.
/// `symmetric` states that a rotation by 120° maps the design onto itself.
pub fn search_prescribed<L: Leg>(
    checker: &PoseChecker<L>,
    sampling: &WorkspaceSampling,
    step_base: f64,
    symmetric: bool,
) -> (RegularWorkspace, f64) {
    let (spec, grid, orientation_grid) = (sampling.spec(), sampling.grid(), *sampling.orientation_grid());
    let symmetric = symmetric && matches!(spec.region, Region::Disc(_));
    let directions = directions(grid, symmetric);
    let step = step_base / grid.ray_steps() as f64;
    let samples = spec.region.positions(spec.centre, grid, step, &directions);
    let reference = match spec.region {
        Region::Polygon(_) => samples.all[0],
        _ => spec.centre,
    };
    let (orientations, centres) = orientations(checker, spec.centre, &orientation_grid);
    let signs: Vec<f64> = if reference == spec.centre {
        signs(&centres, orientations.len())
    } else {
        signs(
            &super::regular::orientations(checker, reference, &orientation_grid).1,
            orientations.len(),
        )
    };
    let columns = |positions: &[DVec2]| {
        let mut columns = Positions::default();
        columns.extend(positions);
        columns.pad();
        columns
    };
    let parts = [
        columns(&samples.all[..samples.first]),
        columns(&samples.all[samples.first..]),
    ];
    let margin = |k: usize, part: &Positions| {
        let oriented = OrientationLanes {
            arms: &orientations[k].arms,
            sign: signs[k],
        };
        checker.worst_margin(oriented, &part.xs, &part.ys, step_base)
    };
    let mut worst: Vec<f64> = (0..orientations.len()).map(|k| margin(k, &parts[0])).collect();
    let mut is_known = vec![samples.first == samples.all.len(); worst.len()];
    let of_window = |home: usize, worst: &[f64]| {
        let mut least = f64::INFINITY;
        for k in orientation_grid.window(home) {
            least = least.min(worst[k]);
            if signs[k] != signs[home] {
                least = least.min(CUT);
            }
        }
        least
    };
    let homes = orientation_grid.homes();
    let mut bounds: Vec<f64> = homes.clone().map(|home| of_window(home, &worst)).collect();
    let (home, margin) = loop {
        let leader = bounds.iter().enumerate().fold(
            0,
            |best, (place, bound)| if *bound > bounds[best] { place } else { best },
        );
        let home = homes.start + leader;
        let unknown = orientation_grid.window(home).find(|&k| !is_known[k]);
        let Some(k) = unknown else {
            break (home, bounds[leader]);
        };
        worst[k] = worst[k].min(margin(k, &parts[1]));
        is_known[k] = true;
        // An orientation belongs to the windows of exactly those home orientations that lie in the window about it.
        for (place, bound) in bounds.iter_mut().enumerate() {
            *bound = bound.min(
                if orientation_grid.window(homes.start + place).any(|other| other == k) {
                    worst[k]
                } else {
                    f64::INFINITY
                },
            );
        }
    };
    let found = RegularWorkspace {
        radius: spec.region.inscribed_radius().unwrap_or(0.0),
        home: Some(home),
        home_sign: signs[home],
        orientations,
        orientation_grid,
        limits: Vec::new(),
        centres,
        directions,
        samples: samples.all,
    };
    (found, margin)
}

/// Returns the sign of `det A` in each orientation; that of an unreachable pose is positive, which makes no difference.
fn signs(values: &super::ValueColumns, count: usize) -> Vec<f64> {
    let sign = |k: usize| {
        values
            .get(k)
            .map_or(1.0, |values| if values.determinant < 0.0 { -1.0 } else { 1.0 })
    };
    (0..count).map(sign).collect()
}

/// Determines the worst margin over many positions in one orientation.
struct WorstMargin<'a, L> {
    checker: &'a PoseChecker<L>,
    oriented: OrientationLanes<'a>,
    xs: &'a [f64],
    ys: &'a [f64],
    base_radius: f64,
}

impl<L: Leg> WithSimd for WorstMargin<'_, L> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let (arms, sign) = self.oriented.lanes(simd);
        let mut least = sign.splat(f64::INFINITY);
        let (xs, ys) = (Lanes::<S>::column(self.xs), Lanes::<S>::column(self.ys));
        for (x, y) in xs.iter().zip(ys) {
            let position = Planar::new(Lanes::load(simd, x), Lanes::load(simd, y));
            let margin = self.checker.margin_lanes(position, &arms, sign, self.base_radius);
            least = margin.smaller(least);
        }
        let mut lanes = [0.0; MAX_LANES];
        least.store(&mut Lanes::<S>::column_mut(&mut lanes)[0]);
        lanes[..Lanes::<S>::COUNT].iter().copied().fold(f64::INFINITY, f64::min)
    }
}

impl<L: Leg> PoseChecker<L> {
    /// Returns the worst margin over many positions in one orientation, in the columns of equal lengths, a multiple of
    /// [`MAX_LANES`].
    fn worst_margin(&self, oriented: OrientationLanes<'_>, xs: &[f64], ys: &[f64], base_radius: f64) -> f64 {
        assert!(xs.len() == ys.len() && xs.len().is_multiple_of(MAX_LANES));
        self.instructions.run(WorstMargin {
            checker: self,
            oriented,
            xs,
            ys,
            base_radius,
        })
    }

    /// Returns the worst margin of the required constraints at several poses at once, no less than −1, and less than −1 where a
    /// leg does not reach the pose. Margins of lengths are divided by `base_radius`.
    #[inline(always)]
    fn margin_lanes<V: Real>(&self, position: Planar<V>, arms: &[Planar<V>; 3], sign: V, base_radius: f64) -> V {
        let (values, directions) = self.lanes_without_clearance(position, arms);
        let least = &self.thresholds;
        let none = sign.splat(-1.0);
        let per_length = sign.splat(1.0 / base_radius);
        // A margin that is not a number counts as a constraint that is missed entirely.
        let mut worst = (values.limit_margin * per_length).larger(none);
        let unreached = none + worst.smaller(sign.splat(0.0));
        macro_rules! lower {
            ($value:expr, $threshold:expr) => {
                let threshold = $threshold;
                let margin = if threshold > 0.0 {
                    ($value - sign.splat(threshold)) * sign.splat(1.0 / threshold)
                } else {
                    $value - sign.splat(threshold)
                };
                worst = worst.smaller(margin.larger(none));
            };
        }
        lower!(values.inverse_condition, least.inverse_condition);
        lower!(values.k_xy, least.k_xy);
        lower!(values.k_phi_z, least.k_phi_z);
        lower!(values.k_z, least.k_z);
        // The determinant must not vanish, so that a margin of 0 is one that is missed.
        let determinant = values.determinant * sign;
        let vanishing = sign.splat(-f64::MIN_POSITIVE);
        worst = worst.smaller(
            determinant
                .select(determinant.exceeds(sign.splat(0.0)), determinant.smaller(vanishing))
                .larger(none),
        );
        if let Some(further) = &least.further {
            let found = self.further_lanes(position, arms);
            if let Some(limit) = further.limit_margin {
                worst = worst.smaller(((values.limit_margin - sign.splat(limit)) * per_length).larger(none));
            }
            if let Some(limit) = further.transmission {
                lower!(found.transmission, limit);
            }
            if let Some(limit) = further.displacement {
                let margin = (sign.splat(limit) - found.displacement) * sign.splat(1.0 / limit);
                worst = worst.smaller(margin.larger(none));
            }
        }
        if let Some(threshold) = least.clearance {
            let limit = worst * sign.splat(base_radius) + sign.splat(threshold);
            let limit = limit.select(values.reachable, sign.splat(f64::NEG_INFINITY));
            let clearance = self.compute_clearance_up_to(position, arms, &directions, limit);
            worst = worst.smaller(((clearance - sign.splat(threshold)) * per_length).larger(none));
        }
        worst.select(values.reachable, unreached)
    }
}
