//! The home orientation of a prescribed region: of those that keep all limits, the one with the best objective, and else the one with the
//! best worst margin (docs/model.md, section 7.4).
//!
//! The worst values of an orientation over a few positions of the boundary bound those over the whole region. Windows are
//! therefore examined best first, and only the orientations of leading windows are examined at all positions.

use glam::DVec2;
use pulp::{Simd, WithSimd};

use super::batch::OrientationLanes;
use super::columns::Positions;
use super::region::{RegionPositions, directions};
use super::regular::{Orientation, RegularWorkspace, orientations};
use super::{Grid, Region, ValueColumns, WorkspaceSampling, WorkspaceSpec};
use crate::lanes::{Lanes, MAX_LANES, Planar, Real};
use crate::mechanism::Leg;
use crate::pose::{Better, EXAMINED_ALWAYS, MarginUnit, PoseChecker, PoseScalar, PoseScalars, ScalarSet};
use crate::spatial::LEGS;

/// Margin of a window that a singularity cuts: as if a constraint were missed entirely.
const CUT: f64 = -1.0;

/// What many positions in one orientation have shown.
#[derive(Clone, Copy)]
pub(crate) struct Examined {
    /// The worst margin of the limits.
    pub margin: f64,
    /// The worst values of the objective and of the limited scalars that depend on loads, with their signs reversed where smaller values are
    /// better; infinite for all others.
    pub kept: PoseScalars<f64>,
}

impl Examined {
    fn and(self, other: Self) -> Self {
        Self {
            margin: self.margin.min(other.margin),
            kept: PoseScalars::from_fn(|scalar| self.kept[scalar].min(other.kept[scalar])),
        }
    }
}

/// What orders orientations and windows, or bounds it from above.
#[derive(Clone, Copy)]
struct Standing {
    /// The worst margin.
    margin: f64,
    /// The worst value of the objective, whose larger values are better; the margin without an objective.
    objective: f64,
}

impl Standing {
    const BEST: Self = Self {
        margin: f64::INFINITY,
        objective: f64::INFINITY,
    };

    fn new(found: &Examined, objective: Option<PoseScalar>) -> Self {
        Self {
            margin: found.margin,
            objective: objective.map_or(found.margin, |scalar| found.kept[scalar]),
        }
    }

    fn and(self, other: Self) -> Self {
        Self {
            margin: self.margin.min(other.margin),
            objective: self.objective.min(other.objective),
        }
    }

    fn is_better_than(self, other: Self) -> bool {
        match (self.margin >= 0.0, other.margin >= 0.0) {
            (true, true) => self.objective > other.objective,
            (true, false) => true,
            (false, true) => false,
            (false, false) => self.margin > other.margin,
        }
    }
}

/// Worst margins of a design over a region that is prescribed, one orientation at a time.
pub(crate) struct RegionMargins<'a, L> {
    checker: PoseChecker<L>,
    /// The same without the limits that depend on loads, which cost most; `None` without such limits.
    without_loads: Option<PoseChecker<L>>,
    sampling: &'a WorkspaceSampling,
    step_base: f64,
    /// Scalars whose worst values are kept; those that depend on loads are not, where their limits are left out.
    kept: ScalarSet,
    /// Orientations of the grid.
    orientations: Vec<Orientation>,
    /// Values at the centre for every orientation.
    centres: ValueColumns,
    /// Sign of `det A` that is required in every orientation.
    pub signs: Vec<f64>,
    directions: Vec<DVec2>,
    samples: RegionPositions,
    /// Those of a polygon as it is, about the origin: they are in proportion to it.
    of_polygon: Option<RegionPositions>,
    /// The positions that are examined first, and the others.
    parts: [Positions; 2],
}

impl<'a, L: Leg> RegionMargins<'a, L> {
    /// Lays out the region of the study for the design in `checker`.
    ///
    /// `step_base` is the base radius `R`, by which margins of lengths are divided and of which the ray step is a fraction.
    /// `symmetric` states that a rotation by 120° maps the design onto itself.
    pub fn new(checker: PoseChecker<L>, sampling: &'a WorkspaceSampling, step_base: f64, symmetric: bool) -> Self {
        let spec = sampling.spec();
        let symmetric = symmetric && matches!(spec.region, Region::Disc(_));
        let (orientations, centres) = orientations(&checker, spec.centre, sampling.orientation_grid());
        let mut margins = Self {
            kept: checker.limited_of_loads(),
            without_loads: checker.without_loads(),
            checker,
            sampling,
            step_base,
            orientations,
            centres,
            signs: Vec::new(),
            directions: directions(sampling.grid(), symmetric),
            samples: RegionPositions::default(),
            of_polygon: None,
            parts: Default::default(),
        };
        if let Region::Polygon(_) = spec.region {
            let (_, grid, step) = margins.grid();
            margins.of_polygon = Some(spec.region.positions(DVec2::ZERO, grid, step, &margins.directions));
        }
        margins.lay(1.0);
        margins.read_signs(1.0);
        margins
    }

    /// Lays out the region with its centre and all its lengths multiplied by `factor`.
    pub fn lay(&mut self, factor: f64) {
        let (spec, grid, step) = self.grid();
        let centre = spec.centre * factor;
        self.samples = match &self.of_polygon {
            Some(samples) => RegionPositions {
                all: samples.all.iter().map(|position| centre + *position * factor).collect(),
                first: samples.first,
            },
            None => spec
                .region
                .scaled(factor)
                .positions(centre, grid, step, &self.directions),
        };
        let parts = self.samples.all.split_at(self.samples.first);
        for (columns, positions) in self.parts.iter_mut().zip([parts.0, parts.1]) {
            columns.clear();
            columns.extend(positions);
            columns.pad();
        }
    }

    /// Lays out only the boundary of the region multiplied by `factor`, as the positions that are examined first.
    pub fn lay_boundary(&mut self, factor: f64) {
        let (spec, grid, step) = self.grid();
        let region = spec.region.scaled(factor);
        let boundary = region.boundary_positions(spec.centre * factor, grid, step, &self.directions);
        self.parts[0].clear();
        self.parts[0].extend(&boundary);
        self.parts[0].pad();
    }

    fn grid(&self) -> (&'a WorkspaceSpec, &'a Grid, f64) {
        let grid = self.sampling.grid();
        (self.sampling.spec(), grid, self.step_base / grid.ray_steps() as f64)
    }

    /// Requires in each orientation the sign of `det A` that it has at the centre (at the first corner of a polygon) of the region
    /// multiplied by `factor`.
    pub fn read_signs(&mut self, factor: f64) {
        let spec = self.sampling.spec();
        let reference = match spec.region {
            Region::Polygon(_) => self.samples.all[0],
            _ => spec.centre * factor,
        };
        let count = self.orientations.len();
        self.signs = if reference == spec.centre {
            signs(&self.centres, count)
        } else {
            let grid = self.sampling.orientation_grid();
            signs(&orientations(&self.checker, reference, grid).1, count)
        };
    }

    /// Returns the worst margin in one orientation over the positions that are examined first.
    pub fn at_first(&self, orientation: usize) -> f64 {
        self.at(orientation, &self.parts[0]).margin
    }

    /// Returns an upper bound of what they show, which costs less where limits depend on loads; without such limits it is what they show.
    fn bound_at_first(&self, orientation: usize) -> Examined {
        let checker = self.without_loads.as_ref().unwrap_or(&self.checker);
        let without_loads = self.checker.limited_of_loads().complement();
        let kept = self
            .kept
            .iter()
            .filter(|scalar| without_loads.contains(*scalar))
            .collect();
        let Positions { xs, ys, .. } = &self.parts[0];
        checker.worst_margin(self.oriented(orientation), (xs, ys), self.step_base, kept)
    }

    /// Returns what all positions show in one orientation, but for what their bound has shown of those that are examined first.
    fn beyond_bound(&self, orientation: usize) -> Examined {
        let others = self.at(orientation, &self.parts[1]);
        match self.without_loads {
            None => others,
            Some(_) => self.at(orientation, &self.parts[0]).and(others),
        }
    }

    /// Returns whether no position that is not examined first has a negative margin in one orientation.
    pub fn holds_at_others(&self, orientation: usize) -> bool {
        /// Number of positions after which the margins so far are looked at.
        const PART: usize = 16 * MAX_LANES;
        let oriented = self.oriented(orientation);
        let [_, others] = &self.parts;
        let parts = others.xs.chunks(PART).zip(others.ys.chunks(PART));
        parts
            .map(|columns| self.checker.worst_margin(oriented, columns, self.step_base, self.kept))
            .all(|found| found.margin >= 0.0)
    }

    fn oriented(&self, orientation: usize) -> OrientationLanes<'_> {
        OrientationLanes {
            arms: &self.orientations[orientation].arms,
            sign: self.signs[orientation],
        }
    }

    fn at(&self, orientation: usize, positions: &Positions) -> Examined {
        let columns = (&positions.xs[..], &positions.ys[..]);
        self.checker
            .worst_margin(self.oriented(orientation), columns, self.step_base, self.kept)
    }
}

/// Finds the home orientation of the prescribed region of the design in `checker`, and the worst margin over its window.
///
/// `step_base` is the base radius `R`, by which margins of lengths are divided and of which the ray step is a fraction.
/// `symmetric` states that a rotation by 120° maps the design onto itself. Of the home orientations that keep all limits, the one is
/// returned whose worst value of `objective` is the best, which is a scalar that is examined at every pose.
pub fn search_prescribed<L: Leg>(
    checker: &PoseChecker<L>,
    sampling: &WorkspaceSampling,
    step_base: f64,
    symmetric: bool,
    objective: Option<PoseScalar>,
) -> (RegularWorkspace, f64) {
    let (spec, orientation_grid) = (sampling.spec(), *sampling.orientation_grid());
    let mut margins = RegionMargins::new(checker.clone(), sampling, step_base, symmetric);
    margins.kept = objective.into_iter().fold(margins.kept, ScalarSet::with);
    let signs = &margins.signs;
    let standing_of = |found: &Examined| Standing::new(found, objective);
    let mut worst: Vec<Standing> = (0..signs.len())
        .map(|k| standing_of(&margins.bound_at_first(k)))
        .collect();
    let has_loads = margins.without_loads.is_some();
    let are_known = !has_loads && margins.samples.first == margins.samples.all.len();
    let mut is_known = vec![are_known; worst.len()];
    let mut of_loads = Vec::new();
    if has_loads {
        of_loads = vec![PoseScalars::splat(f64::INFINITY); worst.len()];
    }
    let of_window = |home: usize, worst: &[Standing]| {
        let mut least = Standing::BEST;
        for k in orientation_grid.window(home) {
            least = least.and(worst[k]);
            if signs[k] != signs[home] {
                least.margin = least.margin.min(CUT);
            }
        }
        least
    };
    let homes = orientation_grid.homes();
    let mut bounds: Vec<Standing> = homes.clone().map(|home| of_window(home, &worst)).collect();
    let (home, margin) = loop {
        let leader = bounds.iter().enumerate().fold(0, |best, (place, bound)| {
            if bound.is_better_than(bounds[best]) {
                place
            } else {
                best
            }
        });
        let home = homes.start + leader;
        let unknown = orientation_grid.window(home).find(|&k| !is_known[k]);
        let Some(k) = unknown else {
            break (home, bounds[leader].margin);
        };
        let found = margins.beyond_bound(k);
        worst[k] = worst[k].and(standing_of(&found));
        if let Some(of_loads) = of_loads.get_mut(k) {
            *of_loads = found.kept;
        }
        is_known[k] = true;
        // An orientation belongs to the windows of exactly those home orientations that lie in the window about it.
        for (place, bound) in bounds.iter_mut().enumerate() {
            if orientation_grid.window(homes.start + place).any(|other| other == k) {
                *bound = bound.and(worst[k]);
            }
        }
    };
    let found = RegularWorkspace {
        radius: spec.region.inscribed_radius().unwrap_or(0.0),
        home: Some(home),
        home_sign: signs[home],
        orientations: margins.orientations,
        orientation_grid,
        limits: Vec::new(),
        centres: margins.centres,
        directions: margins.directions,
        samples: margins.samples.all,
        of_loads,
    };
    (found, margin)
}

/// Returns the sign of `det A` in each orientation; that of an unreachable pose is positive, which makes no difference.
fn signs(values: &ValueColumns, count: usize) -> Vec<f64> {
    let sign = |k: usize| {
        values.get(k).map_or(1.0, |values| {
            if values[PoseScalar::Determinant] < 0.0 {
                -1.0
            } else {
                1.0
            }
        })
    };
    (0..count).map(sign).collect()
}

/// Determines the worst margin over many positions in one orientation, and the worst values of some scalars.
struct WorstMargin<'a, L> {
    checker: &'a PoseChecker<L>,
    oriented: OrientationLanes<'a>,
    xs: &'a [f64],
    ys: &'a [f64],
    base_radius: f64,
    /// Scalars whose worst values are kept.
    kept: ScalarSet,
}

impl<L: Leg> WithSimd for WorstMargin<'_, L> {
    type Output = Examined;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Examined {
        let (arms, sign) = self.oriented.lanes(simd);
        let mut least = sign.splat(f64::INFINITY);
        let mut least_kept = PoseScalars::splat(least);
        let limited = self.checker.computed;
        let (xs, ys) = (Lanes::<S>::column(self.xs), Lanes::<S>::column(self.ys));
        for (x, y) in xs.iter().zip(ys) {
            let position = Planar::new(Lanes::load(simd, x), Lanes::load(simd, y));
            let margin = self.checker.margin_lanes(
                position,
                &arms,
                sign,
                self.base_radius,
                limited,
                (self.kept, &mut least_kept),
            );
            least = margin.smaller(least);
        }
        let mut kept = PoseScalars::splat(f64::INFINITY);
        for scalar in self.kept.iter() {
            kept[scalar] = least_lane(least_kept[scalar]);
        }
        Examined {
            margin: least_lane(least),
            kept,
        }
    }
}

/// Returns the least number of all lanes.
#[inline(always)]
fn least_lane<S: Simd>(numbers: Lanes<S>) -> f64 {
    let mut lanes = [0.0; MAX_LANES];
    numbers.store(&mut Lanes::<S>::column_mut(&mut lanes)[0]);
    lanes[..Lanes::<S>::COUNT].iter().copied().fold(f64::INFINITY, f64::min)
}

impl<L: Leg> PoseChecker<L> {
    /// Returns what many positions in one orientation show, in the columns of equal lengths, a multiple of [`MAX_LANES`]; `kept` are the
    /// scalars whose worst values are returned.
    fn worst_margin(
        &self,
        oriented: OrientationLanes<'_>,
        (xs, ys): (&[f64], &[f64]),
        base_radius: f64,
        kept: ScalarSet,
    ) -> Examined {
        assert!(xs.len() == ys.len() && xs.len().is_multiple_of(MAX_LANES));
        self.instructions.run(WorstMargin {
            checker: self,
            oriented,
            xs,
            ys,
            base_radius,
            kept,
        })
    }

    /// Returns the worst margin of the limits at several poses at once, no less than −1, and less than −1 where a leg does not reach
    /// the pose. Margins of lengths are divided by `base_radius`. `set` are the scalars that are limited; of those in `kept`, the worst
    /// values so far are kept.
    #[inline(always)]
    fn margin_lanes<V: Real>(
        &self,
        position: Planar<V>,
        arms: &[Planar<V>; LEGS],
        sign: V,
        base_radius: f64,
        set: ScalarSet,
        (kept, least_kept): (ScalarSet, &mut PoseScalars<V>),
    ) -> V {
        let (values, distals) = self.core_lanes(position, arms);
        let scalars = &values.scalars;
        let none = sign.splat(-1.0);
        let per_length = sign.splat(1.0 / base_radius);
        // A margin that is not a number counts as a constraint that is missed entirely.
        let mut worst = (scalars[PoseScalar::Reach] * per_length).larger(none);
        let unreached = none + worst.smaller(sign.splat(0.0));
        for scalar in [
            PoseScalar::Dexterity,
            PoseScalar::StiffnessXy,
            PoseScalar::StiffnessPhiZ,
            PoseScalar::StiffnessZ,
        ] {
            let margin = limit_margin(scalar, scalars[scalar], self.thresholds.bound(scalar), per_length);
            worst = worst.smaller(margin.larger(none));
        }
        // The determinant must not vanish, so that a margin of 0 is one that is missed.
        let determinant = scalars[PoseScalar::Determinant] * sign;
        let vanishing = sign.splat(-f64::MIN_POSITIVE);
        worst = worst.smaller(
            determinant
                .select(determinant.exceeds(sign.splat(0.0)), determinant.smaller(vanishing))
                .larger(none),
        );
        if self.examines_all {
            let mut scalars = PoseScalars::of_core(scalars);
            self.fill_on_demand(set, position, arms, &mut scalars);
            for &scalar in PoseScalar::ALL {
                if let Some(threshold) = self.thresholds.get(scalar)
                    && !EXAMINED_ALWAYS.contains(&scalar)
                {
                    let margin = limit_margin(scalar, scalars[scalar], threshold, per_length);
                    worst = worst.smaller(margin.larger(none));
                }
            }
            for scalar in kept.iter() {
                let reversed = sign.splat(scalar.entry().quantity.better.sign());
                least_kept[scalar] = (scalars[scalar] * reversed).smaller(least_kept[scalar]);
            }
        } else {
            // Of those that every loop over poses determines, larger values are better.
            for scalar in kept.iter() {
                least_kept[scalar] = scalars[scalar].smaller(least_kept[scalar]);
            }
        }
        if let Some(threshold) = self.thresholds.get(PoseScalar::Clearance) {
            let limit = worst * sign.splat(base_radius) + sign.splat(threshold);
            let limit = limit.select(values.reachable, sign.splat(f64::NEG_INFINITY));
            let clearance = self.compute_clearance_apart(position, arms, &distals, limit);
            worst = worst.smaller(((clearance - sign.splat(threshold)) * per_length).larger(none));
        }
        worst.select(values.reachable, unreached)
    }
}

/// Returns the margin of a limit at several poses at once, as [`PoseScalar::margin`] defines it; infinite without a limit.
#[inline(always)]
fn limit_margin<V: Real>(scalar: PoseScalar, value: V, threshold: f64, per_length: V) -> V {
    let entry = scalar.entry();
    let limit = value.splat(threshold);
    let excess = match entry.quantity.better {
        Better::Higher => value - limit,
        Better::Lower => limit - value,
    };
    match entry.margin {
        MarginUnit::BaseRadius => excess * per_length,
        MarginUnit::Threshold if threshold > 0.0 => excess * value.splat(1.0 / threshold),
        MarginUnit::Threshold => excess,
    }
}
