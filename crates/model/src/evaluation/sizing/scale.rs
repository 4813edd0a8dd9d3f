//! Exact sizing for a prescribed region: the lightest bars together with the scale of the geometry and the home orientation
//! (docs/model.md, section 9).

use glam::DVec2;

use super::golden_section::golden_section;
use super::growth::{GrownHome, Growth};
use super::lightest::SizingAccuracy;
use super::prescribed::SizedPoses;
use super::sizer::Sizer;
use crate::evaluation::GridChoice;
use crate::mechanism::{Design, Leg};
use crate::workspace::RegionPositions;

/// Relative change of the scale by which it is found whether a larger design is lighter.
const PROBE: f64 = 1e-3;

/// Relative change of the scale at which the search for a lighter design starts.
const FIRST: f64 = 4e-3;

/// Ratio of consecutive changes in that search.
const WIDENING: f64 = 3.0;

/// Home orientations whose mass, found coarsely, exceeds the least one by more than this ratio are left out.
const NEAR: f64 = 1.004;

/// Number of positions, besides those that are examined first, on which scales and home orientations are compared.
const SPREAD: usize = 40;

/// How exactly a scale is sought: bars and the logarithm of the scale.
#[derive(Debug, Clone, Copy)]
struct FitAccuracy {
    bars: SizingAccuracy,
    scale: f64,
}

const COARSE: FitAccuracy = FitAccuracy {
    bars: SizingAccuracy::COARSE,
    scale: 1e-3,
};

const EXACT: FitAccuracy = FitAccuracy {
    bars: SizingAccuracy::EXACT,
    scale: 1e-8,
};

/// Geometry and bars that carry in one home orientation.
#[derive(Debug, Clone, Copy)]
struct Fitted {
    /// Mass \[kg\].
    mass: f64,
    grown: GrownHome,
    design: Design,
}

impl<L: Leg> Sizer<'_, L> {
    /// Returns the lightest design for the region that the study prescribes: with the scale and the home orientation in which the
    /// bars are lightest.
    pub(super) fn sized_exactly(self, grid: GridChoice) -> Option<Design> {
        let model = self.model;
        let [smallest, largest] = if model.is_free_of_scale() {
            self.ranges.scale
        } else {
            [1.0; 2]
        };
        let homes = Growth::<L>::new(model, &self.design, model.sampling(grid)).homes([smallest, largest]);
        let fit = |least: &GrownHome| {
            self.fitted(*least, largest, grid, COARSE)
                .map(|fitted| (*least, fitted))
        };
        let fitted: Vec<(GrownHome, Fitted)> = homes.iter().filter_map(fit).collect();
        let least = fitted
            .iter()
            .fold(f64::INFINITY, |least, (_, fitted)| fitted.mass.min(least));
        let near = fitted.iter().filter(|(_, fitted)| fitted.mass <= NEAR * least);
        let exact = |(home, coarse): &(GrownHome, Fitted)| {
            let with_bars = self.starting_with(&coarse.design, grid);
            let fitted = with_bars.fitted(*home, largest, grid, EXACT)?;
            self.sized_everywhere(&fitted, grid)
        };
        let lightest = near
            .filter_map(exact)
            .reduce(|best, next| if next.mass < best.mass { next } else { best });
        match lightest {
            Some(found) => {
                let sized = self.starting_with(&found.design, grid);
                Some(sized.lighter_listed(found.design, grid))
            }
            None => {
                let largest = self.design.with_lengths_times(largest);
                Self::new(model, &largest, self.ranges, grid).sized_nearly(grid)
            }
        }
    }

    /// Returns a sizer of the same geometry that starts with the bars of another design.
    fn starting_with(&self, bars: &Design, grid: GridChoice) -> Self {
        let design = self.design.with_bars(bars_of(bars));
        Self::new(self.model, &design, self.ranges, grid)
    }

    /// Returns the design that is similar to this one, with bars sized for one home orientation at the positions on which scales are
    /// compared. `start` are the radii of the bars at which sizing starts.
    fn sized_in(&self, grown: GrownHome, start: [f64; 2], grid: GridChoice, bars: SizingAccuracy) -> Option<Fitted> {
        let larger = self.design.with_bars(start).with_lengths_times(grown.factor);
        let mut sizer = Self::new(self.model, &larger, self.ranges, grid);
        let samples = sizer.samples(grid);
        let design = sizer.sized_at(grown.home, &spread(&samples), SizedPoses::exactly(bars))?;
        Some(Fitted {
            mass: self.model.mass(&design),
            grown,
            design,
        })
    }

    /// Returns a design that was sized at some positions with bars that carry at all of them.
    fn sized_everywhere(&self, fitted: &Fitted, grid: GridChoice) -> Option<Fitted> {
        let mut sizer = Self::new(self.model, &fitted.design, self.ranges, grid);
        let positions = sizer.samples(grid).all;
        let how = SizedPoses::at_the_others(EXACT.bars);
        let design = sizer.sized_at(fitted.grown.home, &positions, how)?;
        Some(Fitted {
            mass: self.model.mass(&design),
            design,
            ..*fitted
        })
    }

    /// Returns the design with the scale that is lightest in one home orientation, from the least scale with which the geometry
    /// holds the region to `largest`. The mass grows with the scale, unless poses near the limits of reach require thick bars.
    fn fitted(&self, least: GrownHome, largest: f64, grid: GridChoice, accuracy: FitAccuracy) -> Option<Fitted> {
        // The bars of one scale are nearly those of the next.
        let mut start = bars_of(&self.design);
        let mut at = |factor: f64| {
            let found = self.sized_in(GrownHome { factor, ..least }, start, grid, accuracy.bars);
            start = found.map_or(start, |fitted| bars_of(&fitted.design));
            found
        };
        let mass = |fitted: &Option<Fitted>| fitted.map_or(f64::INFINITY, |fitted| fitted.mass);
        let larger = |change: f64| (least.factor * (1.0 + change)).min(largest);
        let mut lightest = at(least.factor);
        if larger(PROBE) == least.factor {
            return lightest;
        }
        if lightest.is_some() && mass(&lightest) <= mass(&at(larger(PROBE))) {
            return lightest;
        }
        let mut below = least.factor;
        let mut change = FIRST;
        let above = loop {
            let factor = larger(change);
            let found = at(factor);
            if found.is_some() && mass(&found) >= mass(&lightest) || factor >= largest {
                break factor;
            }
            below = lightest.map_or(factor, |fitted| fitted.grown.factor);
            lightest = found;
            change *= WIDENING;
        };
        let of_logarithm = |logarithm: f64| mass(&at(libm::exp(logarithm)));
        let logarithm = golden_section([below, above].map(libm::log), accuracy.scale, of_logarithm);
        at(libm::exp(logarithm).clamp(below, above))
    }
}

fn bars_of(design: &Design) -> [f64; 2] {
    [design.leg_bar_radius(), design.platform_bar_radius()]
}

/// Returns the positions that are examined first, and some of the others.
fn spread(samples: &RegionPositions) -> Vec<DVec2> {
    let (first, others) = samples.all.split_at(samples.first);
    // An odd stride meets different directions on consecutive rings.
    let stride = (others.len() / SPREAD) | 1;
    first.iter().chain(others.iter().step_by(stride)).copied().collect()
}
