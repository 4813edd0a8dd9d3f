//! The rays of one orientation, in all directions at once: which rings of poses about the centre are good.
//!
//! Ring `k` holds the poses of all directions at `k` steps from the centre. `R(φ)` lies in the step that ends at the
//! first ring with a pose that fails; where in it, halvings tell. A ring that fails bounds `R(φ)` from above whatever the
//! rings before it do, so bounds are had for a few rings where the value costs all of them.

use glam::DVec2;

use super::batch::Oriented;
use super::{Grid, PoseChecker, Positions};
use crate::mechanism::Leg;

/// The directions and steps of all rays, and room for the positions of a few rings.
#[derive(Debug)]
pub(super) struct Rings {
    centre: DVec2,
    /// The directions marched.
    pub directions: Vec<DVec2>,
    step: f64,
    positions: Positions,
}

/// Positions laid out at a time on a march.
const BLOCK: usize = 256;

/// Where the disc of one orientation ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bracket {
    /// `R(φ)`: the lower end of the last bracket \[m\].
    pub radius: f64,
    /// The upper end: a pose at this radius fails in some direction \[m\].
    pub beyond: f64,
}

/// What is known of the rings of one orientation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reach {
    /// Rings 1 to this are good.
    pub good: usize,
    /// The farthest single ring known to be good.
    pub probed: usize,
    /// The nearest ring known to fail; `usize::MAX` while none is.
    pub failing: usize,
    /// `R(φ)`, once it is worked out.
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

    /// Upper bound of `R(φ)` \[m\], its value once that is known.
    pub fn bound(&self, reach: &Reach) -> f64 {
        match (reach.bracket, reach.failing) {
            (Some(bracket), _) => bracket.radius,
            (None, usize::MAX) => f64::INFINITY,
            (None, failing) => failing as f64 * self.step,
        }
    }

    /// The poses of rings `first` to `last`, ring after ring, before the first that is not good.
    fn leading<L: Leg>(
        &mut self,
        checker: &PoseChecker<L>,
        oriented: Oriented<'_>,
        first: usize,
        last: usize,
    ) -> usize {
        self.positions.clear();
        for ring in first..=last {
            let radius = ring as f64 * self.step;
            for direction in &self.directions {
                self.positions.push(self.centre + *direction * radius);
            }
        }
        let count = self.positions.xs.len();
        self.positions.pad();
        checker.leading(oriented, &self.positions.xs, &self.positions.ys, count)
    }

    /// Whether all poses of one ring are good; lowers `reach` where one is not.
    fn probe<L: Leg>(
        &mut self,
        checker: &PoseChecker<L>,
        oriented: Oriented<'_>,
        reach: &mut Reach,
        ring: usize,
    ) -> bool {
        let good = self.leading(checker, oriented, ring, ring) == self.directions.len();
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

    /// Looks for a failing ring as near to the centre as can be had by bisection, from `hint`, a likely one, outwards to
    /// `farthest`. For an orientation of which no failing ring is known.
    pub fn estimate<L: Leg>(
        &mut self,
        checker: &PoseChecker<L>,
        oriented: Oriented<'_>,
        reach: &mut Reach,
        hint: usize,
        farthest: usize,
    ) {
        // Outwards until a ring fails. Ends: the reach of every leg is bounded.
        let mut ring = hint.clamp(1, farthest);
        while self.probe(checker, oriented, reach, ring) {
            if ring == farthest {
                return;
            }
            ring = (ring + ring.div_ceil(4)).min(farthest);
        }
        // Inwards in growing strides until one is good, then between the two.
        let mut good = reach.probed;
        let mut stride = 1;
        while reach.failing > good + 2 * stride {
            let ring = reach.failing - stride;
            if self.probe(checker, oriented, reach, ring) {
                good = ring;
                break;
            }
            stride *= 2;
        }
        while reach.failing > good + 1 {
            let ring = usize::midpoint(good, reach.failing);
            if self.probe(checker, oriented, reach, ring) {
                good = ring;
            }
        }
    }

    /// Marches from the last ring known to be good to ring `last`, or to the first that fails.
    pub fn march<L: Leg>(&mut self, checker: &PoseChecker<L>, oriented: Oriented<'_>, reach: &mut Reach, last: usize) {
        let count = self.directions.len();
        while reach.good < last {
            let first = reach.good + 1;
            let end = (first + BLOCK / count).min(last);
            let leading = self.leading(checker, oriented, first, end);
            reach.good += leading / count;
            if reach.good < end {
                reach.failing = reach.failing.min(reach.good + 1);
                return;
            }
        }
    }

    /// `R(φ)` of an orientation whose rings are good up to the failing one: halvings of that step, in the directions
    /// that fail.
    ///
    /// Rays that pass where another fails reach farther than it, so they are left behind at once; the smallest radius
    /// over the directions is the same as if each were marched to its own end. One halving waits for the one before, so
    /// where few directions are left, all the middles that the next ones could ask for are looked at together.
    pub fn halve<L: Leg>(&mut self, checker: &PoseChecker<L>, oriented: Oriented<'_>, reach: &mut Reach, grid: &Grid) {
        let mut bracket = [(reach.failing - 1) as f64 * self.step, reach.failing as f64 * self.step];
        let mut middles = Middles::new(&self.directions);
        middles.look(checker, oriented, self.centre, &[bracket[1]]);
        middles.keep_failing(0);
        let mut left = grid.halvings() as usize;
        while left > 0 {
            let depth = match middles.failing.len() {
                0..=2 => Self::MOST_HALVINGS,
                3..=5 => 2,
                _ => 1,
            }
            .min(left);
            // A tree: the halves of bracket k are brackets 2k (near) and 2k + 1 (far).
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
            middles.look(checker, oriented, self.centre, &radii[1..1 << depth]);
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

    /// Most halvings whose middles are looked at together.
    const MOST_HALVINGS: usize = 3;
}

/// Poses at several radii in the directions that still fail.
struct Middles {
    /// The directions looked at.
    directions: Vec<DVec2>,
    /// Those of them, by index, that fail at every radius at which one did.
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

    /// Looks at all poses of the failing directions at `radii`.
    fn look<L: Leg>(&mut self, checker: &PoseChecker<L>, oriented: Oriented<'_>, centre: DVec2, radii: &[f64]) {
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
        checker.mark_good(oriented, &self.positions.xs, &self.positions.ys, &mut self.good);
    }

    /// Leaves behind the directions that do not fail at the radius of index `radius`, if one fails there, and says so.
    fn keep_failing(&mut self, radius: usize) -> bool {
        let good = &self.good[radius * self.directions.len()..];
        let any = self.failing.iter().any(|&direction| good[direction] == 0.0);
        if any {
            self.failing.retain(|&direction| good[direction] == 0.0);
        }
        any
    }
}
