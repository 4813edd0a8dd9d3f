//! The rays of one orientation, in all directions at once: which rings of poses about the centre are good.
//!
//! Ring `k` holds the poses of all directions at `k` steps from the centre. `R(φ)` lies in the step that ends at the
//! first ring with a pose that fails; where in it, halvings tell. A ring that fails bounds `R(φ)` from above whatever the
//! rings before it do, so bounds are had for a few rings where the value costs all of them.

use glam::DVec2;

use super::batch::Turned;
use super::{Grid, PoseChecker};
use crate::lanes::{MOST_LANES, padded};
use crate::mechanism::Leg;

/// Positions of all rings, ring after ring, as far as they were needed.
#[derive(Debug)]
pub(super) struct Rings {
    centre: DVec2,
    /// The directions marched.
    pub directions: Vec<DVec2>,
    step: f64,
    xs: Vec<f64>,
    ys: Vec<f64>,
}

/// How far the disc of one orientation reaches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
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
    pub ray: Option<Ray>,
}

impl Reach {
    pub const UNKNOWN: Reach = Reach {
        good: 0,
        probed: 0,
        failing: usize::MAX,
        ray: None,
    };

    /// Upper bound of `R(φ)` \[m\], its value once that is known.
    pub fn bound(&self, step: f64) -> f64 {
        match (self.ray, self.failing) {
            (Some(ray), _) => ray.radius,
            (None, usize::MAX) => f64::INFINITY,
            (None, failing) => failing as f64 * step,
        }
    }
}

impl Rings {
    pub fn new(centre: DVec2, directions: Vec<DVec2>, step: f64) -> Self {
        Self {
            centre,
            directions,
            step,
            xs: Vec::new(),
            ys: Vec::new(),
        }
    }

    /// Makes the positions of rings 1 to `ring` available, and what is read beyond them.
    fn extend(&mut self, ring: usize) {
        let count = self.directions.len();
        let needed = padded(ring * count) + MOST_LANES;
        if self.xs.len() >= needed {
            return;
        }
        // As many rings as fill whole registers, and a few more than are needed now.
        let rings = (ring + 8).next_multiple_of(MOST_LANES);
        for k in self.xs.len() / count + 1..=rings {
            let radius = k as f64 * self.step;
            for direction in &self.directions {
                let position = self.centre + *direction * radius;
                self.xs.push(position.x);
                self.ys.push(position.y);
            }
        }
    }

    /// Whether all poses of one ring are good; lowers `reach` where one is not.
    pub fn probe<L: Leg>(
        &mut self,
        checker: &PoseChecker<L>,
        turned: Turned<'_>,
        reach: &mut Reach,
        ring: usize,
    ) -> bool {
        self.extend(ring);
        let count = self.directions.len();
        let from = (ring - 1) * count;
        let good = checker.leading(turned, &self.xs[from..], &self.ys[from..], count) == count;
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

    /// Looks for a failing ring as near to the centre as can be had by bisection, not beyond `farthest`; `hint` is a
    /// likely one.
    pub fn estimate<L: Leg>(
        &mut self,
        checker: &PoseChecker<L>,
        turned: Turned<'_>,
        reach: &mut Reach,
        hint: usize,
        farthest: usize,
    ) {
        // Outwards from the hint until a ring fails. Ends: the reach of every leg is bounded.
        let mut ring = hint.clamp(1, farthest);
        while reach.failing == usize::MAX {
            if !self.probe(checker, turned, reach, ring) {
                break;
            }
            if ring == farthest {
                return;
            }
            ring = (ring + ring.div_ceil(4)).min(farthest);
        }
        // Inwards in growing strides until one is good, then between the two.
        let mut low = if reach.probed < reach.failing {
            reach.probed
        } else {
            reach.good
        };
        let mut stride = 1;
        while reach.failing > low + 1 {
            let far = reach.failing - low > 2 * stride;
            let ring = if far {
                reach.failing - stride
            } else {
                usize::midpoint(low, reach.failing)
            };
            if self.probe(checker, turned, reach, ring) {
                low = ring;
                stride = usize::MAX / 4;
            } else if far {
                stride *= 2;
            }
        }
    }

    /// Marches from the last ring known to be good to ring `last`, or to the first that fails.
    pub fn march<L: Leg>(&mut self, checker: &PoseChecker<L>, turned: Turned<'_>, reach: &mut Reach, last: usize) {
        if reach.good >= last {
            return;
        }
        self.extend(last);
        let count = self.directions.len();
        let from = reach.good * count;
        let wanted = last * count - from;
        let leading = checker.leading(turned, &self.xs[from..], &self.ys[from..], wanted);
        reach.good += leading / count;
        if leading < wanted {
            reach.failing = reach.failing.min(reach.good + 1);
        }
    }

    /// `R(φ)` of an orientation whose rings are good up to the failing one: halvings of that step, in the directions
    /// that fail.
    ///
    /// Rays that pass where another fails reach farther than it, so they are left behind at once; the smallest radius
    /// over the directions is the same as if each were marched to its own end. One halving waits for the one before, so
    /// where few directions are left, all the middles that the next ones could ask for are looked at together.
    pub fn halve<L: Leg>(&mut self, checker: &PoseChecker<L>, turned: Turned<'_>, reach: &mut Reach, grid: &Grid) {
        let mut bracket = [(reach.failing - 1) as f64 * self.step, reach.failing as f64 * self.step];
        let mut middles = Middles::new(&self.directions);
        middles.look(checker, turned, self.centre, &[bracket[1]]);
        middles.keep_failing(0);
        let mut left = grid.halvings as usize;
        while left > 0 {
            let depth = match middles.failing.len() {
                0..=2 => 3,
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
            middles.look(checker, turned, self.centre, &radii[1..1 << depth]);
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
        reach.ray = Some(Ray {
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
    xs: Vec<f64>,
    ys: Vec<f64>,
    good: Vec<f64>,
}

impl Middles {
    fn new(directions: &[DVec2]) -> Self {
        Self {
            directions: directions.to_vec(),
            failing: (0..directions.len()).collect(),
            xs: Vec::new(),
            ys: Vec::new(),
            good: Vec::new(),
        }
    }

    /// Looks at all poses of the failing directions at `radii`.
    fn look<L: Leg>(&mut self, checker: &PoseChecker<L>, turned: Turned<'_>, centre: DVec2, radii: &[f64]) {
        self.directions = self.failing.iter().map(|&index| self.directions[index]).collect();
        self.failing = (0..self.directions.len()).collect();
        self.xs.clear();
        self.ys.clear();
        for radius in radii {
            for direction in &self.directions {
                let position = centre + *direction * *radius;
                self.xs.push(position.x);
                self.ys.push(position.y);
            }
        }
        let length = padded(self.xs.len());
        self.xs.resize(length, 0.0);
        self.ys.resize(length, 0.0);
        self.good.resize(length, 0.0);
        checker.mark_good(turned, &self.xs, &self.ys, &mut self.good);
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
