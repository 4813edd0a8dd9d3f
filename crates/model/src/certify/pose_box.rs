//! Boxes of poses.

use std::cmp::Ordering;

use super::forms::ProvedForms;
use super::patch::Patch;
use crate::enclosure::{Interval, TaylorModel, VARIABLES};

/// A box of poses: two coordinates of the position in its patch and the orientation, by its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseBox {
    /// Part of the region in which it lies.
    pub patch: Patch,
    /// Lower ends.
    pub lower: [f64; VARIABLES],
    /// Upper ends.
    pub upper: [f64; VARIABLES],
    /// What is proved on it.
    pub proved: ProvedForms,
    /// Number of divisions that led to it.
    pub depth: u32,
    /// Number of its creation, which decides between boxes of equal distance.
    pub number: usize,
}

impl PoseBox {
    /// A box of a disc, of which nothing is proved.
    #[cfg(test)]
    pub fn between(lower: [f64; VARIABLES], upper: [f64; VARIABLES]) -> Self {
        Self {
            patch: Patch::Disc,
            lower,
            upper,
            proved: ProvedForms::default(),
            depth: 0,
            number: 1,
        }
    }

    /// Middle, and a radius that reaches both ends.
    pub fn middle_and_radius(&self, k: usize) -> (f64, f64) {
        Interval::new(self.lower[k], self.upper[k]).middle_and_radius()
    }

    /// Volume in the units of its variables.
    pub fn volume(&self) -> f64 {
        (0..VARIABLES).map(|k| self.upper[k] - self.lower[k]).product()
    }

    /// The point at `ε ∈ [−1, 1]³`.
    pub fn point(&self, epsilon: [f64; VARIABLES]) -> [f64; VARIABLES] {
        std::array::from_fn(|k| {
            let (middle, radius) = self.middle_and_radius(k);
            (middle + epsilon[k] * radius).clamp(self.lower[k], self.upper[k])
        })
    }

    /// Returns the parts of a box that a smaller box within it leaves out.
    pub fn cut_to(&self, inner: &Self) -> impl Iterator<Item = Self> {
        let mut rest = *self;
        let mut parts = Vec::new();
        for k in 0..VARIABLES {
            let (mut below, mut above) = (rest, rest);
            below.upper[k] = inner.lower[k];
            above.lower[k] = inner.upper[k];
            (rest.lower[k], rest.upper[k]) = (inner.lower[k], inner.upper[k]);
            parts.extend([below, above].into_iter().filter(|part| part.lower[k] < part.upper[k]));
        }
        parts.into_iter()
    }

    /// Shrinks a box to the hull of the parts in which one of the constraints may not hold; returns whether any part is left.
    ///
    /// In a variable, a constraint may fail only where `a ε + b ε² + k ≤ 0`, with `k` the least of all its other terms.
    pub fn contract(&mut self, open: &[&TaylorModel]) -> bool {
        for k in 0..VARIABLES {
            let (mut first, mut last) = (f64::INFINITY, f64::NEG_INFINITY);
            for value in open {
                if let Some([low, high]) = part_not_above_zero(value.linear[k], value.square[k], value.least_without(k))
                {
                    first = first.min(low);
                    last = last.max(high);
                }
            }
            if first > last {
                return false;
            }
            let (middle, radius) = self.middle_and_radius(k);
            let (lower, upper) = (self.lower[k], self.upper[k]);
            let place =
                |epsilon: f64| Interval::exactly(middle) + Interval::exactly(epsilon) * Interval::exactly(radius);
            if first > -1.0 {
                self.lower[k] = place(first).lower().clamp(lower, upper);
            }
            if last < 1.0 {
                self.upper[k] = place(last).upper().clamp(lower, upper);
            }
        }
        true
    }
}

impl Eq for PoseBox {}

impl PartialOrd for PoseBox {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for PoseBox {
    fn cmp(&self, other: &Self) -> Ordering {
        self.lower[0]
            .total_cmp(&other.lower[0])
            .then(self.number.cmp(&other.number))
    }
}

/// Returns an interval that contains every `ε ∈ [−1, 1]` with `a ε + b ε² + k ≤ 0`; `None` if there is no such number.
fn part_not_above_zero(a: f64, b: f64, k: f64) -> Option<[f64; 2]> {
    // A part is cut off only if the polynomial is proved positive on it.
    let is_positive = |from: f64, to: f64| {
        let value = |at: f64| {
            (
                a * at + b * at * at + k,
                a.abs() * at.abs() + b.abs() * at * at + k.abs(),
            )
        };
        let (low, low_size) = value(from);
        let (high, high_size) = value(to);
        let mut least = low.min(high);
        let mut size = low_size.max(high_size);
        let vertex = -a / (2.0 * b);
        if b > 0.0 && vertex > from && vertex < to {
            let (at_vertex, vertex_size) = value(vertex);
            least = least.min(at_vertex);
            size = size.max(vertex_size);
        }
        // The vertex is known to a few places, and the polynomial is flat there.
        least > 32.0 * f64::EPSILON * size
    };
    if k.is_nan() {
        return Some([-1.0, 1.0]);
    }
    if is_positive(-1.0, 1.0) {
        return None;
    }
    let cut = |sign: f64| {
        // The greatest part [−1, at] (for sign = −1) or [at, 1] on which the polynomial is positive, by halving.
        let end = sign;
        if !is_positive(end, end) {
            return end;
        }
        let (mut positive, mut open) = (end, -sign);
        for _ in 0..20 {
            let middle = 0.5 * (positive + open);
            let (from, to) = if sign < 0.0 { (end, middle) } else { (middle, end) };
            if is_positive(from, to) {
                positive = middle;
            } else {
                open = middle;
            }
        }
        positive
    };
    Some([cut(-1.0), cut(1.0)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    /// Numbers between −1 and 1 that look random.
    fn numbers() -> impl FnMut() -> f64 {
        let mut state = 7u64;
        move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }
    }

    /// No point at which a constraint may fail leaves a box that is contracted.
    #[test]
    fn a_contraction_keeps_every_point_that_may_fail() {
        let mut next = numbers();
        let mut cut = 0;
        for _ in 0..3000 {
            let mut model = |shift: f64| {
                let mut terms = || [next(), next(), next()];
                TaylorModel {
                    linear: terms(),
                    square: terms(),
                    mixed: terms().map(|term| 0.2 * term),
                    constant: shift + terms()[0],
                    remainder: 0.01,
                }
            };
            let open = [model(1.0), model(0.7)];
            let before = PoseBox::between([1.0, -0.3, 2.0], [1.5, 0.4, 2.2]);
            let mut after = before;
            let is_left = after.contract(&open.iter().collect::<Vec<_>>());
            cut += usize::from(after != before || !is_left);
            for _ in 0..200 {
                let epsilon = [next(), next(), next()];
                let may_fail = open.iter().any(|model| model.value(epsilon) - model.remainder <= 0.0);
                let point = before.point(epsilon);
                let is_inside = is_left
                    && (0..VARIABLES).all(|k| point[k] >= after.lower[k] - 1e-12 && point[k] <= after.upper[k] + 1e-12);
                assert!(!may_fail || is_inside, "{epsilon:?} of {after:?}");
            }
        }
        assert!(cut > 500, "{cut} contractions");
    }

    /// The enclosure of a box of each kind of patch contains its positions.
    #[test]
    fn boxes_contain_their_positions() {
        let corners = [[0.1, 0.2], [0.7, -0.3], [0.4, 0.9]].map(|[x, y]| DVec2::new(x, y));
        let patches = [
            Patch::Disc,
            Patch::Rectangle([DVec2::new(-0.3, -0.2), DVec2::new(0.3, 0.2)]),
            Patch::Triangle(corners),
        ];
        for patch in patches {
            let part = PoseBox {
                patch,
                ..PoseBox::between([0.1, -0.15, 0.0], [0.25, 0.1, 0.1])
            };
            let enclosed = patch.enclose([0, 1].map(|k| part.middle_and_radius(k)));
            for epsilon in [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.3, 0.7, 0.0], [1.0, 1.0, 0.0]] {
                let [a, b, _] = part.point(epsilon);
                let position = patch.position([a, b]).to_array();
                for (model, value) in enclosed.iter().zip(position) {
                    let off = (model.value(epsilon) - value).abs();
                    assert!(off <= model.remainder + 1e-15, "{patch:?}: {off}");
                }
            }
        }
    }
}
