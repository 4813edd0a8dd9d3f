//! Rays of one orientation, marched in all directions at once: determines which rings of poses about the centre are
//! feasible.
//!
//! Ring `k` consists of the poses in all directions at `k` steps from the centre. A ring is feasible if all its poses
//! are; otherwise it fails. `R(φ)` lies in the step that ends at the first failing ring, and halvings locate it within
//! that step. A failing ring bounds `R(φ)` from above whether the rings before it fail or not, so that a bound costs a
//! few rings, whereas the value costs all of them.

use glam::DVec2;

use super::batch::OrientationLanes;
use super::{Grid, Positions};
use crate::mechanism::Leg;
use crate::pose::PoseChecker;

/// A design in one orientation.
#[derive(Clone, Copy)]
pub(super) struct InOrientation<'a, L> {
    /// Tells which poses are feasible.
    pub checker: &'a PoseChecker<L>,
    /// The orientation.
    pub oriented: OrientationLanes<'a>,
}

/// Directions and step of all rays, with a buffer for the positions of a few rings.
#[derive(Debug)]
pub(super) struct Rings {
    centre: DVec2,
    /// Directions in which rays are marched.
    pub directions: Vec<DVec2>,
    step: f64,
    positions: Positions,
}

/// Approximate number of positions that a march evaluates at a time.
const BLOCK: usize = 256;

/// Bracket of the radius at which the disc of one orientation ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bracket {
    /// `R(φ)`: the lower end of the last bracket \[m\].
    pub radius: f64,
    /// Upper end of the last bracket: a pose at this radius is infeasible in some direction \[m\].
    pub beyond: f64,
}

/// Known feasible and failing rings of one orientation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reach {
    /// Rings 1 to `good` are feasible.
    pub good: usize,
    /// Farthest single ring known to be feasible.
    pub probed: usize,
    /// Nearest ring known to fail; `usize::MAX` while none is known.
    pub failing: usize,
    /// Bracket of `R(φ)`, once it has been computed.
    pub bracket: Option<Bracket>,
}

impl Reach {
    pub const UNKNOWN: Reach = Reach {
        good: 0,
        probed: 0,
        failing: usize::MAX,
        bracket: None,
    };
}

impl Rings {
    pub fn new(centre: DVec2, directions: Vec<DVec2>, step: f64) -> Self {
        Self {
            centre,
            directions,
            step,
            positions: Positions::default(),
        }
    }

    /// Returns an upper bound of `R(φ)` \[m\], which is its value once that is known.
    pub fn bound(&self, reach: &Reach) -> f64 {
        match (reach.bracket, reach.failing) {
            (Some(bracket), _) => bracket.radius,
            (None, usize::MAX) => f64::INFINITY,
            (None, failing) => failing as f64 * self.step,
        }
    }

    /// Returns the number of poses of rings `first` to `last`, counted ring after ring, before the first infeasible
    /// one.
    fn count_leading_feasible<L: Leg>(&mut self, at: InOrientation<'_, L>, first: usize, last: usize) -> usize {
        self.positions.clear();
        for ring in first..=last {
            let radius = ring as f64 * self.step;
            for direction in &self.directions {
                self.positions.push(self.centre + *direction * radius);
            }
        }
        let count = self.positions.xs.len();
        self.positions.pad();
        at.checker
            .count_leading_feasible(at.oriented, &self.positions.xs, &self.positions.ys, count)
    }

    /// Returns whether one ring is feasible, and records the result in `reach`.
    fn probe<L: Leg>(&mut self, at: InOrientation<'_, L>, reach: &mut Reach, ring: usize) -> bool {
        let good = self.count_leading_feasible(at, ring, ring) == self.directions.len();
        if good {
            reach.probed = reach.probed.max(ring);
            if ring == reach.good + 1 {
                reach.good = ring;
            }
        } else {
            reach.failing = reach.failing.min(ring);
        }
        good
    }

    /// Searches for the failing ring that is nearest to the centre, as far as bisection can find it. The search starts
    /// at `hint`, a ring likely to fail, and goes outwards to `farthest` at most. It is meant for an orientation
    /// without a known failing ring up to `farthest`.
    pub fn estimate<L: Leg>(&mut self, at: InOrientation<'_, L>, reach: &mut Reach, hint: usize, farthest: usize) {
        // Step outwards until a ring fails. The loop ends because the reach of every leg is bounded.
        let mut ring = hint.clamp(1, farthest);
        while self.probe(at, reach, ring) {
            if ring == farthest {
                return;
            }
            ring = (ring + ring.div_ceil(4)).min(farthest);
        }
        // Step inwards in growing strides until a ring is feasible, then bisect between the two.
        let mut good = reach.probed;
        let mut stride = 1;
        while reach.failing > good + 2 * stride {
            let ring = reach.failing - stride;
            if self.probe(at, reach, ring) {
                good = ring;
                break;
            }
            stride *= 2;
        }
        while reach.failing > good + 1 {
            let ring = usize::midpoint(good, reach.failing);
            if self.probe(at, reach, ring) {
                good = ring;
            }
        }
    }

    /// Marches outwards from ring `reach.good` to ring `last`, or to the first ring that fails.
    pub fn march<L: Leg>(&mut self, at: InOrientation<'_, L>, reach: &mut Reach, last: usize) {
        let count = self.directions.len();
        while reach.good < last {
            let first = reach.good + 1;
            let end = (first + BLOCK / count).min(last);
            let count_leading_feasible = self.count_leading_feasible(at, first, end);
            reach.good += count_leading_feasible / count;
            if reach.good < end {
                reach.failing = reach.failing.min(reach.good + 1);
                return;
            }
        }
    }

    /// Computes `R(φ)` of an orientation whose rings are feasible up to the failing one, by halving the last step in
    /// the directions that fail.
    ///
    /// A ray that is feasible at a radius where another one fails reaches farther than that one, so it is dropped at
    /// once; the smallest radius over the directions is the same as if every ray were marched to its own end. Each
    /// halving depends on the one before. Where few directions are left, all midpoints that the next halvings could
    /// need are therefore evaluated together.
    pub fn halve<L: Leg>(&mut self, at: InOrientation<'_, L>, reach: &mut Reach, grid: &Grid) {
        let mut bracket = [(reach.failing - 1) as f64 * self.step, reach.failing as f64 * self.step];
        let mut middles = Middles::new(&self.directions);
        middles.look(at, self.centre, &[bracket[1]]);
        middles.keep_failing(0);
        let mut left = grid.halvings() as usize;
        while left > 0 {
            let depth = match middles.failing.len() {
                0..=2 => Self::MOST_HALVINGS,
                3..=5 => 2,
                _ => 1,
            }
            .min(left);
            // The brackets form a tree: the halves of bracket k are brackets 2k (near) and 2k + 1 (far).
            let mut brackets = [bracket; 1 << Self::MOST_HALVINGS];
            let mut radii = [0.0; 1 << Self::MOST_HALVINGS];
            for k in 1..1 << depth {
                let [near, far] = brackets[k];
                radii[k] = 0.5 * (near + far);
                if 2 * k + 1 < brackets.len() {
                    brackets[2 * k] = [near, radii[k]];
                    brackets[2 * k + 1] = [radii[k], far];
                }
            }
            middles.look(at, self.centre, &radii[1..1 << depth]);
            let mut k = 1;
            for _ in 0..depth {
                if middles.keep_failing(k - 1) {
                    bracket[1] = radii[k];
                    k *= 2;
                } else {
                    bracket[0] = radii[k];
                    k = 2 * k + 1;
                }
            }
            left -= depth;
        }
        reach.bracket = Some(Bracket {
            radius: bracket[0],
            beyond: bracket[1],
        });
    }

    /// Largest number of halvings whose midpoints are evaluated together.
    const MOST_HALVINGS: usize = 3;
}

/// Poses at several radii in the directions that still fail.
struct Middles {
    /// Directions that are evaluated.
    directions: Vec<DVec2>,
    /// Indices of the directions that fail at every radius examined so far at which any direction fails.
    failing: Vec<usize>,
    positions: Positions,
    good: Vec<f64>,
}

impl Middles {
    fn new(directions: &[DVec2]) -> Self {
        Self {
            directions: directions.to_vec(),
            failing: (0..directions.len()).collect(),
            positions: Positions::default(),
            good: Vec::new(),
        }
    }

    /// Evaluates the poses of the failing directions at all `radii`.
    fn look<L: Leg>(&mut self, at: InOrientation<'_, L>, centre: DVec2, radii: &[f64]) {
        self.directions = self.failing.iter().map(|&index| self.directions[index]).collect();
        self.failing = (0..self.directions.len()).collect();
        self.positions.clear();
        for radius in radii {
            for direction in &self.directions {
                self.positions.push(centre + *direction * *radius);
            }
        }
        self.positions.pad();
        self.good.resize(self.positions.xs.len(), 0.0);
        at.checker
            .mark_feasible(at.oriented, &self.positions.xs, &self.positions.ys, &mut self.good);
    }

    /// Returns whether any direction fails at the radius of index `radius`; if so, drops the directions that do not
    /// fail there.
    fn keep_failing(&mut self, radius: usize) -> bool {
        let good = &self.good[radius * self.directions.len()..];
        let any = self.failing.iter().any(|&direction| good[direction] == 0.0);
        if any {
            self.failing.retain(|&direction| good[direction] == 0.0);
        }
        any
    }
}
