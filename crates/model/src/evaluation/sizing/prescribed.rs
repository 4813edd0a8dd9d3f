//! Sizing of the bars for a prescribed region, on the poses that the evaluation examines (docs/model.md, section 9).

use glam::DVec2;

use super::lightest::{Ratios, SizingAccuracy, StiffnessRatios};
use super::sizer::{Shape, Sizer};
use crate::evaluation::GridChoice;
use crate::mechanism::{Design, Leg};
use crate::workers::OneWorker;
use crate::workspace::{RegionPositions, directions, search_prescribed};

/// How bars are sized at many poses.
#[derive(Debug, Clone, Copy)]
pub(super) struct SizedPoses {
    /// Whether every pose must be feasible with the thickest bars.
    pub must_hold: bool,
    /// Poses whose ratio is larger than this multiple of the smallest of its kind do not determine the bars, unless the result
    /// shows that they do.
    pub near: f64,
    pub accuracy: SizingAccuracy,
    /// Whether the design's own bars are the lightest ones of some of the poses, so that they are taken if they carry at all of them.
    pub keeps_bars: bool,
    /// Largest number of times that poses are added and the bars sized again.
    pub repeats: usize,
}

impl SizedPoses {
    /// For designs of which the next is a little better.
    const COARSELY: SizedPoses = SizedPoses {
        must_hold: true,
        near: 1.7,
        accuracy: SizingAccuracy::COARSE,
        keeps_bars: false,
        repeats: 5,
    };

    /// For bars that are known nearly, to an accuracy.
    pub fn exactly(accuracy: SizingAccuracy) -> Self {
        Self {
            near: 1.1,
            accuracy,
            repeats: 10,
            ..Self::COARSELY
        }
    }

    /// For bars that were sized at some of the poses of a geometry that is known to hold the region.
    pub fn at_the_others(accuracy: SizingAccuracy) -> Self {
        Self {
            must_hold: false,
            keeps_bars: true,
            near: 1.002,
            repeats: 30,
            ..Self::exactly(accuracy)
        }
    }
}

/// Worst margin that a geometry may miss to be sized all the same.
const NEARLY: f64 = 0.15;

/// Number of home orientations that are tried.
const HOMES: usize = 4;

impl<L: Leg> Sizer<'_, L> {
    /// Lays out the region as the evaluation examines it.
    pub(super) fn samples(&mut self, grid_choice: GridChoice) -> RegionPositions {
        let spec = &self.model.settings().workspace;
        let grid = self.model.sampling(grid_choice).grid();
        let step = self.design.base_radius() / grid.ray_steps() as f64;
        let symmetric = self.sectors == 1 && matches!(spec.region, crate::workspace::Region::Disc(_));
        self.shape = Shape::Sampled;
        spec.region
            .positions(DVec2::ZERO, grid, step, &directions(grid, symmetric))
    }

    /// Returns the design with light bars for the region that the study prescribes, in the home orientation that is stiffest.
    pub(super) fn sized_prescribed(mut self, grid_choice: GridChoice) -> Option<Design> {
        let samples = self.samples(grid_choice);
        let all: Vec<usize> = (0..self.arms.len()).collect();
        let signs = self.feasible_signs(&samples.all[..samples.first], &all);
        let candidates = self.windows(&signs);
        self.lay_positions(&samples.all[..samples.first], &candidates);
        let homes = self.stiffest_first(self.homes(&signs), samples.first, &candidates);
        homes
            .into_iter()
            .take(HOMES)
            .find_map(|home| self.sized_at(home, &samples.all, SizedPoses::COARSELY))
    }

    /// Sizes the bars of a geometry that misses the region by little, as if it did not: a search that approaches a geometric
    /// constraint then sees how the mass goes on beyond it.
    pub(super) fn sized_nearly(mut self, grid: GridChoice) -> Option<Design> {
        let samples = self.samples(grid);
        let thickest = self.design.with_bars([self.ranges.leg[1], self.ranges.platform[1]]);
        let (home, margin) = self.best_home(&thickest, grid);
        if margin < -NEARLY {
            return None;
        }
        let regardless = SizedPoses {
            must_hold: false,
            ..SizedPoses::exactly(SizingAccuracy::EXACT)
        };
        self.sized_at(home, &samples.all, regardless)
    }

    /// Returns the lightest pair of two lists that is feasible in any home orientation: `design`, or a lighter one that the home
    /// orientations examined so far do not show.
    pub(super) fn lighter_listed(&self, design: Design, grid: GridChoice) -> Design {
        let (model, [Some(legs), Some(platform)]) = (self.model, &self.ranges.listed) else {
            return design;
        };
        let pairs = legs.iter().flat_map(|&leg| platform.iter().map(move |&bar| [leg, bar]));
        let mut lighter: Vec<(f64, Design)> = pairs
            .map(|bars| self.design.with_bars(bars))
            .map(|pair| (model.mass(&pair), pair))
            .filter(|(mass, _)| *mass < model.mass(&design))
            .collect();
        lighter.sort_by(|a, b| a.0.total_cmp(&b.0));
        let carries = |pair: &Design| self.best_home(pair, grid).1 >= 0.0;
        lighter
            .into_iter()
            .map(|(_, pair)| pair)
            .find(carries)
            .unwrap_or(design)
    }

    /// Returns the home orientation of a design, which may differ from that in which its bars were sized, and its worst margin.
    fn best_home(&self, design: &Design, grid: GridChoice) -> (usize, f64) {
        let sampling = self.model.sampling(grid);
        let checker = self.model.checker::<L>(design);
        let (found, margin) = search_prescribed(
            &checker,
            sampling,
            design.base_radius(),
            self.sectors == 1,
            None,
            &OneWorker,
        );
        (found.home.unwrap_or(0), margin)
    }

    /// Sizes the bars for one home orientation.
    pub(super) fn sized_at(&mut self, home: usize, positions: &[DVec2], how: SizedPoses) -> Option<Design> {
        let window: Vec<usize> = self.orientation_grid.window(home).collect();
        self.set_bars([self.ranges.leg[1], self.ranges.platform[1]]);
        if how.must_hold {
            let signs = self.feasible_signs(positions, &window);
            let first = signs[window[0]]?;
            if window.iter().any(|&k| signs[k] != Some(first)) {
                return None;
            }
        } else {
            self.lay_positions(positions, &window);
        }
        let own = [self.design.leg_bar_radius(), self.design.platform_bar_radius()];
        let ratios = self.ratios_at_all(own);
        if how.keeps_bars && below_one(&ratios).is_empty() {
            return Some(self.design);
        }
        let mut near = near_weakest(&ratios, how.near);
        let mut everything = std::mem::take(&mut self.laid);
        for _ in 0..how.repeats {
            self.laid = everything.chosen(&near);
            let bars = self.lightest_bars(how.accuracy)?;
            std::mem::swap(&mut self.laid, &mut everything);
            let ratios = self.ratios_at_all(bars);
            std::mem::swap(&mut self.laid, &mut everything);
            if below_one(&ratios).is_empty() {
                return Some(self.design.with_bars(bars));
            }
            near.extend(near_weakest(&ratios, how.near));
            near.sort_unstable();
            near.dedup();
        }
        None
    }

    /// Returns the sign of `det A` over the positions for each orientation; `None` if the orientation is not among the given
    /// ones or any pose is infeasible.
    fn feasible_signs(&mut self, positions: &[DVec2], orientations: &[usize]) -> Vec<Option<f64>> {
        self.lay_positions(positions, orientations);
        self.signs_of_laid(positions.len(), orientations)
    }
}

/// Returns the poses whose ratio is near the smallest of its kind. A kind that exceeds its limit by far more than another one, or has
/// none, determines no bars.
fn near_weakest(ratios: &Ratios, near: f64) -> Vec<usize> {
    const FAR: f64 = 4.0;
    let least_of = |column: &[f64]| column.iter().copied().fold(f64::INFINITY, f64::min);
    let weakest = ratios
        .iter()
        .map(|column| least_of(column))
        .fold(f64::INFINITY, f64::min);
    let mut poses = Vec::new();
    for column in ratios {
        let least = least_of(column);
        if least > FAR * weakest && weakest > 0.0 {
            continue;
        }
        poses.extend((0..column.len()).filter(|&pose| column[pose] <= near * least));
    }
    poses.sort_unstable();
    poses.dedup();
    poses
}

/// Returns the poses at which some stiffness is not sufficient.
fn below_one(ratios: &Ratios) -> Vec<usize> {
    let below = |column: &Vec<f64>| {
        let column = column.clone();
        (0..column.len()).filter(move |&pose| column[pose] < 1.0)
    };
    ratios.iter().flat_map(below).collect()
}
