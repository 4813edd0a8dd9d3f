//! The home orientation of a prescribed region: of those that keep all limits, the one with the best objective, and else the one with the
//! best worst margin (docs/model.md, section 7.4).
//!
//! The worst values of an orientation over a few positions of the boundary bound those over the whole region, and those without limits that
//! take long bound those with them. Windows are therefore examined best first and in stages: only the orientations of leading windows
//! are examined at all positions, and only those that still lead then for the limits that take long.

use glam::DVec2;

use super::batch::OrientationLanes;
use super::columns::Positions;
use super::margins::Examined;
use super::region::{RegionPositions, directions};
use super::regular::{Orientation, RegularWorkspace, orientations};
use super::{Grid, Region, ValueColumns, WorkspaceSampling, WorkspaceSpec};
use crate::lanes::MAX_LANES;
use crate::mechanism::Leg;
use crate::pose::{PoseChecker, PoseScalar, PoseScalars, ScalarSet};
use crate::workers::{Workers, map};

/// Margin of a window that a singularity cuts: as if a constraint were missed entirely.
const CUT: f64 = -1.0;

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

/// A part of what there is to examine in an orientation.
#[derive(Debug, Clone, Copy)]
enum Stage {
    /// The positions that are examined first, without the limits that take long.
    First,
    /// All other positions, without these limits.
    Others,
    /// These limits at the positions that are examined first.
    SlowAtFirst,
    /// These limits at all other positions.
    SlowAtOthers,
}

/// Worst margins of a design over a region that is prescribed, one orientation at a time.
pub(crate) struct RegionMargins<'a, L> {
    checker: PoseChecker<L>,
    /// The same without the limits that take long; `None` if there are none.
    quick: Option<PoseChecker<L>>,
    sampling: &'a WorkspaceSampling,
    step_base: f64,
    /// Scalars whose worst values are kept; those that take long are not, where their limits are left out.
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
            kept: checker.slow_limits(),
            quick: checker.without_slow_limits(),
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
            columns.lay(positions);
        }
    }

    /// Lays out only the boundary of the region multiplied by `factor`, as the positions that are examined first.
    pub fn lay_boundary(&mut self, factor: f64) {
        let (spec, grid, step) = self.grid();
        let region = spec.region.scaled(factor);
        let boundary = region.boundary_positions(spec.centre * factor, grid, step, &self.directions);
        self.parts[0].lay(&boundary);
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
        let columns = self.parts[0].columns();
        self.checker
            .worst_margin::<false>(self.oriented(orientation), columns, self.step_base, self.kept)
            .margin
    }

    /// Returns what a stage shows in one orientation. What one shows of the limits that take long alone means nothing where a leg does
    /// not reach one of its positions, of which the other limits tell.
    fn examine(&self, orientation: usize, stage: Stage) -> Examined {
        let [first, others] = &self.parts;
        let (takes_long, positions) = match stage {
            Stage::First => (false, first),
            Stage::Others => (false, others),
            Stage::SlowAtFirst => (true, first),
            Stage::SlowAtOthers => (true, others),
        };
        let (oriented, columns) = (self.oriented(orientation), positions.columns());
        let slow = self.checker.slow_limits();
        if takes_long {
            return self
                .checker
                .worst_margin::<true>(oriented, columns, self.step_base, slow);
        }
        let checker = self.quick.as_ref().unwrap_or(&self.checker);
        let kept = self.kept.iter().filter(|scalar| !slow.contains(*scalar)).collect();
        checker.worst_margin::<false>(oriented, columns, self.step_base, kept)
    }

    /// Returns the stages that show everything, in their order. An objective that takes long is bounded early.
    fn stages(&self, objective: Option<PoseScalar>) -> &'static [Stage] {
        const QUICK: [Stage; 2] = [Stage::First, Stage::Others];
        const SLOW_LAST: [Stage; 4] = [Stage::First, Stage::Others, Stage::SlowAtFirst, Stage::SlowAtOthers];
        const SLOW_EARLY: [Stage; 4] = [Stage::First, Stage::SlowAtFirst, Stage::Others, Stage::SlowAtOthers];
        let has_others = self.samples.first < self.samples.all.len();
        match &self.quick {
            Some(_) if objective.is_some_and(PoseScalar::takes_long) => &SLOW_EARLY,
            Some(_) => &SLOW_LAST,
            None if has_others => &QUICK,
            None => &QUICK[..1],
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
            .map(|columns| {
                self.checker
                    .worst_margin::<false>(oriented, columns, self.step_base, self.kept)
            })
            .all(|found| found.margin >= 0.0)
    }

    /// Returns the standing of the window about a home orientation, given those of all orientations.
    fn of_window(&self, home: usize, standings: &[Standing]) -> Standing {
        let window = self.sampling.orientation_grid().window(home);
        window.fold(Standing::BEST, |least, k| {
            let mut least = least.and(standings[k]);
            if self.signs[k] != self.signs[home] {
                least.margin = least.margin.min(CUT);
            }
            least
        })
    }

    fn oriented(&self, orientation: usize) -> OrientationLanes<'_> {
        OrientationLanes {
            arms: &self.orientations[orientation].arms,
            sign: self.signs[orientation],
        }
    }
}

/// Finds the home orientation of the prescribed region of the design in `checker`, and the worst margin over its window.
///
/// `step_base` is the base radius `R`, by which margins of lengths are divided and of which the ray step is a fraction.
/// `symmetric` states that a rotation by 120° maps the design onto itself. Of the home orientations that keep all limits, the one is
/// returned whose worst value of `objective` is the best, which is a scalar that is examined at every pose. It is the first of the best,
/// whatever is examined besides it, so that the number of `workers` changes nothing.
pub fn search_prescribed<L: Leg>(
    checker: &PoseChecker<L>,
    sampling: &WorkspaceSampling,
    step_base: f64,
    symmetric: bool,
    objective: Option<PoseScalar>,
    workers: &dyn Workers,
) -> (RegularWorkspace, f64) {
    let (spec, orientation_grid) = (sampling.spec(), *sampling.orientation_grid());
    let mut margins = RegionMargins::new(checker.clone(), sampling, step_base, symmetric);
    margins.kept = objective.into_iter().fold(margins.kept, ScalarSet::with);
    let standing_of = |found: &Examined| Standing::new(found, objective);
    let all: Vec<usize> = (0..margins.signs.len()).collect();
    let mut worst = map(workers, &all, |k| standing_of(&margins.examine(*k, Stage::First)));
    let stages = margins.stages(objective);
    let mut examined = vec![1; worst.len()];
    let mut slow = match margins.quick {
        Some(_) => vec![PoseScalars::splat(f64::INFINITY); worst.len()],
        None => Vec::new(),
    };
    let homes = orientation_grid.homes();
    let mut bounds: Vec<Standing> = homes.clone().map(|home| margins.of_window(home, &worst)).collect();
    let (home, margin) = loop {
        let leader = leader(&bounds);
        let home = homes.start + leader;
        // Within a window, a stage begins when those before it have ended: they may show that another window is better.
        let stage = orientation_grid.window(home).map(|k| examined[k]).min();
        let Some((stage, &part)) = stage.and_then(|stage| Some((stage, stages.get(stage)?))) else {
            break (home, bounds[leader].margin);
        };
        let due = orientation_grid.window(home).filter(|k| examined[*k] == stage);
        let due: Vec<usize> = due.take(workers.count()).collect();
        for (k, found) in due.iter().zip(map(workers, &due, |k| margins.examine(*k, part))) {
            examined[*k] += 1;
            worst[*k] = worst[*k].and(standing_of(&found));
            if let Some(slow) = slow.get_mut(*k) {
                for scalar in margins.kept.iter() {
                    slow[scalar] = slow[scalar].min(found.kept[scalar]);
                }
            }
            // An orientation belongs to the windows of exactly those home orientations that lie in the window about it.
            for home in orientation_grid.window(*k).filter(|home| homes.contains(home)) {
                let bound = &mut bounds[home - homes.start];
                *bound = bound.and(worst[*k]);
            }
        }
    };
    let found = RegularWorkspace {
        radius: spec.region.inscribed_radius().unwrap_or(0.0),
        home: Some(home),
        home_sign: margins.signs[home],
        orientations: margins.orientations,
        orientation_grid,
        limits: Vec::new(),
        centres: margins.centres,
        directions: margins.directions,
        samples: margins.samples.all,
        slow,
    };
    (found, margin)
}

/// Returns the place of the best of some bounds, the first one among equals.
fn leader(bounds: &[Standing]) -> usize {
    (0..bounds.len()).fold(0, |best, place| {
        let is_better = bounds[place].is_better_than(bounds[best]);
        if is_better { place } else { best }
    })
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
