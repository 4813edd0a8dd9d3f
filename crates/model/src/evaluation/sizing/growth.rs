//! Scale of a geometry that is to hold a prescribed region: the factors by which its lengths must be multiplied
//! (docs/model.md, section 9).
//!
//! Reach and dexterity do not depend on the size of a manipulator. Whether a geometry that is larger by a factor holds a region is
//! therefore found by examining the region divided by that factor, without bars.

use crate::evaluation::Model;
use crate::kinematics::CharacteristicLength;
use crate::mechanism::{Design, Leg};
use crate::pose::{MarginUnit, PoseScalar};
use crate::workspace::{OrientationGrid, RegionMargins, WorkspaceSampling};

/// Ratio of consecutive factors until one is found with which some window holds the region.
const WIDE: f64 = 1.25;

/// Ratio of consecutive factors from the one before that.
const NARROW: f64 = 1.01;

/// Number of factors that are tried after the first one with which some window holds the region: another home orientation may need
/// thinner bars with a slightly larger factor.
const MORE_FACTORS: usize = 2;

/// Number of times that a range of factors is halved before secants are taken: the margins of a disc have steps.
const HALVED: usize = 5;

/// Relative accuracy of a factor.
const ACCURACY: f64 = 1e-12;

/// Home orientation and the factor by which the lengths must be multiplied to hold the region in its window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct GrownHome {
    pub home: usize,
    pub factor: f64,
}

/// Geometry of a design, without bars, that is to hold a prescribed region.
pub(super) struct Growth<'a, L> {
    orientation_grid: OrientationGrid,
    margins: RegionMargins<'a, L>,
    /// Sign of `det A` in the orientations that are known to hold the region.
    signs: Vec<Option<f64>>,
}

impl Model {
    /// Returns whether a geometry without bars is as feasible as any similar one for which the region is larger in proportion, so
    /// that sizing may change its scale.
    pub fn is_free_of_scale(&self) -> bool {
        let is_length = |scalar: PoseScalar| scalar.entry().margin == MarginUnit::BaseRadius;
        !self.settings().thresholds.iter().any(|(scalar, _)| is_length(scalar))
            && !matches!(self.settings().characteristic_length, CharacteristicLength::Fixed(_))
    }
}

impl<'a, L: Leg> Growth<'a, L> {
    pub fn new(model: &Model, design: &Design, sampling: &'a WorkspaceSampling) -> Self {
        let mut checker = model.checker::<L>(design);
        // What depends on the bars is left to sizing.
        checker.drop_limits(|scalar| scalar.entry().is_of_bars);
        let orientation_grid = *sampling.orientation_grid();
        let symmetric = model.is_symmetric_in(design, checker.bodies.stack().order);
        Self {
            orientation_grid,
            margins: RegionMargins::new(checker, sampling, design.base_radius(), symmetric),
            signs: vec![None; orientation_grid.count],
        }
    }

    /// Returns the home orientations in whose window the geometry holds the region with nearly the smallest factor within `range`,
    /// each with its own smallest factor, in the order of these.
    pub fn homes(&mut self, range: [f64; 2]) -> Vec<GrownHome> {
        let mut homes: Vec<GrownHome> = Vec::new();
        let Some([below, _]) = self.first_held(range, WIDE) else {
            return homes;
        };
        self.signs.fill(None);
        let Some([mut below, mut factor]) = self.first_held([below, range[1]], NARROW) else {
            return homes;
        };
        for _ in 0..=MORE_FACTORS {
            for home in self.held() {
                if homes.iter().all(|other| other.home != home) {
                    homes.push(self.exactly(home, [below, factor]));
                }
            }
            if factor >= range[1] {
                break;
            }
            (below, factor) = (factor, (factor * NARROW).min(range[1]));
            self.examine(factor);
        }
        homes.sort_by(|a, b| a.factor.total_cmp(&b.factor).then(a.home.cmp(&b.home)));
        homes
    }

    /// Returns the first factor of a sequence within a range with which some window holds the region, and the factor before it.
    fn first_held(&mut self, [least, largest]: [f64; 2], ratio: f64) -> Option<[f64; 2]> {
        let (mut below, mut factor) = (least, least);
        loop {
            self.examine(factor);
            if !self.held().is_empty() {
                return Some([below, factor]);
            }
            if factor >= largest {
                return None;
            }
            (below, factor) = (factor, (factor * ratio).min(largest));
        }
    }

    /// Notes the orientations in which the geometry holds the region with a factor.
    fn examine(&mut self, factor: f64) {
        self.margins.lay(1.0 / factor);
        self.margins.read_signs(1.0 / factor);
        for (k, sign) in self.signs.iter_mut().enumerate() {
            if sign.is_none() && self.margins.at_first(k) >= 0.0 && self.margins.holds_at_others(k) {
                *sign = Some(self.margins.signs[k]);
            }
        }
    }

    /// Returns the home orientations whose window is known to hold the region.
    fn held(&self) -> Vec<usize> {
        self.orientation_grid.homes_of_one_sign(|k| self.signs[k]).collect()
    }

    /// Narrows a range of factors by halving and secants (the Illinois method, Dowell and Jarratt 1971): the upper end holds the region
    /// in the window of a home orientation, the lower one does not, unless both are equal.
    fn exactly(&mut self, home: usize, [mut below, mut above]: [f64; 2]) -> GrownHome {
        let window: Vec<usize> = self.orientation_grid.window(home).collect();
        for &k in &window {
            self.margins.signs[k] = self.signs[k].unwrap_or(1.0);
        }
        let mut worst = |factor: f64| {
            self.margins.lay_boundary(1.0 / factor);
            let margins = window.iter().map(|&k| self.margins.at_first(k));
            let worst = margins.fold(f64::INFINITY, f64::min);
            // Where a leg does not reach a pose, the margin jumps to −1 less the shortfall.
            if worst <= -1.0 {
                (worst + 1.0).min(-f64::MIN_POSITIVE)
            } else {
                worst
            }
        };
        let (mut at_below, mut at_above) = (worst(below), worst(above));
        if at_below >= 0.0 {
            above = below;
        }
        let mut has_lowered = None;
        for turn in 0_usize.. {
            if above - below <= ACCURACY * above {
                break;
            }
            let secant = above - (above - below) * at_above / (at_above - at_below);
            let at = if turn >= HALVED && turn % 4 < 3 && secant > below && secant < above {
                // Next to an end, the other one would stay where it is.
                let aside = 0.4 * ACCURACY * above;
                secant.max(below + aside).min(above - aside)
            } else {
                0.5 * (below + above)
            };
            let found = worst(at);
            let lowers = found >= 0.0;
            // An end that stays twice counts half, so that the next secant ends on its side.
            let factor = if has_lowered == Some(lowers) { 0.5 } else { 1.0 };
            if lowers {
                (above, at_above) = (at, found);
                at_below *= factor;
            } else {
                (below, at_below) = (at, found);
                at_above *= factor;
            }
            has_lowered = Some(lowers);
        }
        GrownHome { home, factor: above }
    }
}
