//! An upper bound of the workspace radius over all home orientations (docs/model.md, section 13.4).
//!
//! Every window of orientations contains an infeasible pose at most `U` away from the centre if the orientations of such poses leave
//! no gap wider than a window.

use std::f64::consts::TAU;

use super::CertifyError;
use super::forms::{Forms, ProvedForms};
use crate::enclosure::{Interval, PoseEnclosure};
use crate::evaluation::{Model, PoseScalar};
use crate::mechanism::Design;

/// Number of orientations of the first sample per window.
const PER_WINDOW: f64 = 16.0;

/// Number of directions over the full turn in which infeasible poses are looked for.
const DIRECTIONS: usize = 72;

/// Number of times that the widest gap is made smaller.
const ROUNDS: usize = 24;

/// Distances at which infeasible poses are looked for, as multiples of the first one.
const GROWTH: f64 = 1.02;

/// An infeasible pose: its orientation, within a turn \[rad\], and its distance from the centre \[m\], as the doubles of the proof.
#[derive(Debug, Clone, Copy)]
struct BadPose {
    phi: f64,
    distance: f64,
}

struct Homes<'a> {
    model: &'a Model,
    forms: Forms<'a>,
    /// Distance below which infeasible poses are all alike \[m\].
    near: f64,
    /// Distance beyond which none is looked for \[m\].
    far: f64,
    directions: usize,
    found: Vec<BadPose>,
}

pub(super) fn upper_bound(model: &Model, design: &Design, proved: f64) -> Result<Option<f64>, CertifyError> {
    let spec = &model.settings().workspace;
    // With a prescribed home orientation, that is the only one; in a window without width, no double is known to lie.
    if spec.home_phi_deg.is_some() || spec.rotation_range_deg <= 0.0 {
        return Ok(None);
    }
    let reach = model.extent(design) + spec.centre.length();
    let near = proved.max(1e-3 * design.base_radius()) * (1.0 + 1e-6);
    let mut homes = Homes {
        forms: Forms::new(model, design)?,
        model,
        near,
        far: (2.0 * near).min(4.0 * reach),
        directions: if model.is_symmetric(design) {
            DIRECTIONS / 3
        } else {
            DIRECTIONS
        },
        found: Vec::new(),
    };
    homes.sample();
    let mut bound = homes.bound();
    for _ in 0..ROUNDS {
        let Some((distance, gap)) = bound else { break };
        if distance <= near {
            break;
        }
        homes.narrow(distance, gap);
        bound = homes.bound();
    }
    Ok(bound.map(|(distance, _)| distance))
}

impl Homes<'_> {
    /// Looks for infeasible poses at orientations over the whole turn.
    fn sample(&mut self) {
        let count = (PER_WINDOW * 360.0 / self.model.settings().workspace.rotation_range_deg).ceil() as usize;
        for k in 0..count {
            self.look_at(TAU * k as f64 / count as f64);
        }
        self.found.sort_by(|a, b| a.phi.total_cmp(&b.phi));
    }

    /// Looks for the infeasible pose of an orientation that is nearest to the centre, ring by ring.
    fn look_at(&mut self, phi: f64) {
        let mut inner = 0.0;
        let mut distance = 0.0;
        while distance <= self.far {
            for direction in 0..self.directions {
                let theta = TAU * direction as f64 / DIRECTIONS as f64;
                if self.is_bad(distance, theta, phi) {
                    let nearest = self.move_inwards(inner, distance, theta, phi);
                    self.found.push(BadPose { phi, distance: nearest });
                    return;
                }
                if distance == 0.0 {
                    break;
                }
            }
            inner = distance;
            distance = if distance == 0.0 { self.near } else { distance * GROWTH };
        }
    }

    /// Returns the least distance found at which the orientation has an infeasible pose, near the direction `theta`.
    fn move_inwards(&self, inner: f64, outer: f64, mut theta: f64, phi: f64) -> f64 {
        let mut best = outer;
        let mut step = TAU / DIRECTIONS as f64;
        // Nearer than that, all are alike.
        let least = inner.max(if outer > self.near { self.near } else { outer });
        for _ in 0..12 {
            let (mut good, mut bad) = (least, best);
            for _ in 0..10 {
                let middle = 0.5 * (good + bad);
                if self.is_bad(middle, theta, phi) {
                    bad = middle;
                } else {
                    good = middle;
                }
            }
            best = bad;
            let turned = [theta - step, theta + step];
            match turned
                .into_iter()
                .find(|&turned| self.is_bad(0.5 * (best + good), turned, phi))
            {
                Some(turned) => theta = turned,
                None => step *= 0.5,
            }
        }
        best
    }

    fn is_bad(&self, distance: f64, theta: f64, phi: f64) -> bool {
        let (theta_sine, theta_cosine) = Interval::exactly(theta).sine_and_cosine();
        let centre = self.model.settings().workspace.centre;
        let radius = Interval::exactly(distance);
        let position = [
            radius * theta_cosine + Interval::exactly(centre.x),
            radius * theta_sine + Interval::exactly(centre.y),
        ];
        let pose = PoseEnclosure::point(position, Interval::exactly(phi));
        let found = self.forms.enclose_pose(&pose, ProvedForms::default());
        // The sign of det A that counts is that of each home orientation, not that of one of them.
        let is_of_all_homes = |scalar| scalar != PoseScalar::Determinant;
        found.violated().any(is_of_all_homes)
    }

    /// Returns the least distance up to which infeasible poses leave no gap wider than a window, and the gap (by the places of its
    /// ends) that the last of them closes; `None` if those that are known leave one.
    fn bound(&self) -> Option<(f64, [usize; 2])> {
        let window = Interval::radians(self.model.settings().workspace.rotation_range_deg).lower();
        let mut order: Vec<usize> = (0..self.found.len()).collect();
        order.sort_by(|&a, &b| {
            self.found[a]
                .distance
                .total_cmp(&self.found[b].distance)
                .then(a.cmp(&b))
        });
        // By bisection over the number of poses that count, from the nearest.
        let covers = |count: usize| self.widest_gap(&order[..count]).is_some_and(|(gap, _)| gap <= window);
        if !covers(order.len()) {
            return None;
        }
        let (mut open, mut closed) = (0, order.len());
        while closed - open > 1 {
            let middle = usize::midpoint(open, closed);
            if covers(middle) {
                closed = middle;
            } else {
                open = middle;
            }
        }
        let (_, gap) = self.widest_gap(&order[..open])?;
        Some((self.found[order[closed - 1]].distance, gap))
    }

    /// Returns the widest gap between the orientations of some poses, rounded upwards, and the places of its ends.
    fn widest_gap(&self, places: &[usize]) -> Option<(f64, [usize; 2])> {
        let mut places = places.to_vec();
        places.sort_unstable();
        let turn = Interval::radians(360.0).upper();
        let gap = |k: usize| {
            let (from, to) = (places[k], places[(k + 1) % places.len()]);
            let way = Interval::exactly(self.found[to].phi) - Interval::exactly(self.found[from].phi);
            let around = if k + 1 < places.len() { 0.0 } else { turn };
            ((way.upper() + around).next_up(), [from, to])
        };
        (0..places.len())
            .map(gap)
            .reduce(|widest, next| if next.0 > widest.0 { next } else { widest })
    }

    /// Adds poses next to the ends of a gap in which every pose known is at least `distance` away.
    fn narrow(&mut self, distance: f64, [from, to]: [usize; 2]) {
        let count = self.found.len();
        let middle = |a: usize, b: usize| {
            let (first, second) = (self.found[a].phi, self.found[b].phi);
            let second = if second < first { second + TAU } else { second };
            (0.5 * (first + second)) % TAU
        };
        let mut at = vec![middle(from, (from + 1) % count), middle((to + count - 1) % count, to)];
        // And next to the pose that closes it.
        if let Some(last) = (0..count).find(|&place| self.found[place].distance == distance) {
            at.push(middle(last, (last + 1) % count));
            at.push(middle((last + count - 1) % count, last));
        }
        for phi in at {
            if !self.found.iter().any(|known| known.phi == phi) {
                self.look_at(phi);
            }
        }
        self.found.sort_by(|a, b| a.phi.total_cmp(&b.phi));
    }
}
