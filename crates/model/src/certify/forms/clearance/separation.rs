//! Whether two axes keep a distance in the plane over a box of poses.

use super::super::Enclosures;
use crate::enclosure::{AxisEnclosure, Interval, PlanarModel, TaylorModel, difference, dot, sum};
use crate::evaluation::PoseScalar;

/// A rectangle that contains an axis.
pub(super) struct Bounds([[f64; 2]; 2]);

impl Bounds {
    pub fn of(axis: &AxisEnclosure) -> Self {
        let along = |k: usize| {
            let hull = |all: [f64; 2], [lower, upper]: [f64; 2]| {
                // The functions min and max pass over NaN.
                if lower.is_nan() || upper.is_nan() || all[0].is_nan() {
                    [f64::NAN; 2]
                } else {
                    [all[0].min(lower), all[1].max(upper)]
                }
            };
            let [first, second, third] = axis.points.map(|point| point[k].range());
            hull(hull(first, second), third)
        };
        Self([along(0), along(1)])
    }

    /// Whether two rectangles are farther apart than a distance. The factor covers the rounding of the comparison, and a comparison
    /// with NaN is false.
    pub fn is_farther(&self, other: &Self, distance: f64) -> bool {
        let gap = |k: usize| {
            (other.0[k][0] - self.0[k][1])
                .max(self.0[k][0] - other.0[k][1])
                .max(0.0)
        };
        let square = gap(0) * gap(0) + gap(1) * gap(1);
        let has_values = self.0.iter().chain(&other.0).flatten().all(|end| !end.is_nan());
        has_values && square > distance * distance * (1.0 + 1e-12)
    }
}

/// Pushes the forms of a pair that are not proved.
///
/// The direction of the shortest line is tried first. Between two ends that are near each other, it turns fast, and with it the projection
/// of the far end of an axis that is almost normal to it; the normal of that axis separates the two almost as well there, and turns no
/// faster than the axis. Where every direction leaves something open, the one whose least lower bound is largest is kept.
pub(super) fn separate(a: &AxisEnclosure, b: &AxisEnclosure, distance: f64, found: &mut Enclosures) {
    let Some([shortest, normals @ ..]) = directions(a, b) else {
        // They cross in the middle of the box.
        found.push(PoseScalar::Clearance, TaylorModel::exactly(-1.0));
        return;
    };
    let mut best = Separation::along(&shortest, a, b, distance);
    for normal in normals.iter().filter(|normal| **normal != shortest) {
        if best.open.is_empty() {
            return;
        }
        let next = Separation::along(normal, a, b, distance);
        if next.least > best.least {
            best = next;
        }
    }
    for value in best.open {
        found.push(PoseScalar::Clearance, value);
    }
}

/// What is open of a pair along a direction.
struct Separation {
    /// The forms that are not proved.
    open: Vec<TaylorModel>,
    /// The least of their lower bounds, as a length: infinite where nothing is open, and negative infinity where a bound is not known.
    least: f64,
}

impl Separation {
    fn along(direction: &Direction, a: &AxisEnclosure, b: &AxisEnclosure, distance: f64) -> Self {
        let keep = Interval::exactly(distance);
        let (mut open, mut least) = (Vec::new(), f64::INFINITY);
        let mut examine = |value: TaylorModel, scale: f64| {
            if !value.is_positive() {
                let length = value.range()[0] / scale;
                least = if length.is_nan() {
                    f64::NEG_INFINITY
                } else {
                    least.min(length)
                };
                open.push(value);
            }
        };
        match *direction {
            // All points of the axis to which the direction is normal lie on one side.
            Direction::Normal { of_first, sign } => {
                let (straight, other) = if of_first { (a, b) } else { (b, a) };
                let [x, y] = straight.direction;
                let normal = [-y.times(sign), x.times(sign)];
                for point in distinct(other) {
                    examine(dot(normal, difference(point, straight.points[0])).plus(-keep), 1.0);
                }
            }
            Direction::Between { from, to } => {
                let way = difference(b.points[to], a.points[from]);
                let square = dot(way, way);
                // |n| ≤ (|n|²/m + m)/2 for every m, with equality at m = |n|.
                let length = square.constant.sqrt();
                let half = Interval::exactly(0.5);
                let longest = square
                    .scaled(half / Interval::exactly(length))
                    .plus(half * Interval::exactly(length));
                let kept = longest.scaled(keep);
                for end in distinct(b) {
                    for start in distinct(a) {
                        examine(dot(way, difference(end, start)) - kept, length);
                    }
                }
            }
        }
        Self { open, least }
    }
}

/// A direction in which one axis may lie apart from another, in the middle of a box.
#[derive(Clone, Copy, PartialEq)]
enum Direction {
    /// Normal to one of the axes; `sign` tells to which side of it the other one lies.
    Normal { of_first: bool, sign: f64 },
    /// From a point of the first axis to a point of the second.
    Between { from: usize, to: usize },
}

/// Returns directions in which two axes may lie apart, in plain doubles: that of the shortest line between them first, then the normals of
/// both to the side on which the other one lies; `None` if they cross.
fn directions(a: &AxisEnclosure, b: &AxisEnclosure) -> Option<[Direction; 3]> {
    let [first, second] = [a, b].map(middle);
    if crossing(a, b).is_some() {
        return None;
    }
    let mut best: Option<(f64, Direction)> = None;
    let mut offer = |square: f64, direction: Direction| {
        if best.as_ref().is_none_or(|(least, _)| square < *least) {
            best = Some((square, direction));
        }
    };
    for (from, p) in first.iter().enumerate() {
        for (to, q) in second.iter().enumerate() {
            offer(length_squared(minus(*q, *p)), Direction::Between { from, to });
        }
    }
    let normals = [(true, &first, &second, a), (false, &second, &first, b)].map(|(of_first, straight, other, axis)| {
        let normal = |height: f64| Direction::Normal {
            of_first,
            sign: if height < 0.0 { -1.0 } else { 1.0 },
        };
        let along = axis.direction.map(|part| part.constant);
        let places = straight.map(|point| scalar(minus(point, straight[0]), along));
        let (least, most) = places
            .iter()
            .fold((0.0f64, 0.0f64), |(low, high), &at| (low.min(at), high.max(at)));
        let mut nearest = f64::INFINITY;
        for point in other {
            let way = minus(*point, straight[0]);
            let (place, height) = (scalar(way, along), along[0] * way[1] - along[1] * way[0]);
            if place > least && place < most {
                offer(height * height, normal(height));
            }
            if height.abs() < nearest.abs() {
                nearest = height;
            }
        }
        normal(nearest)
    });
    let (_, shortest) = best?;
    Some([shortest, normals[0], normals[1]])
}

/// Encloses the point of an axis that is nearest to another axis in the middle of a box; it lies on the axis in any case.
pub(super) fn nearest(of: &AxisEnclosure, to: &AxisEnclosure) -> PlanarModel {
    let (own, other) = (middle(of), middle(to));
    let [first, last] = ends(of);
    let way = minus(own[last], own[first]);
    let square = length_squared(way);
    let fraction = crossing(of, to).unwrap_or_else(|| {
        let on_segment = |from: [f64; 2], way: [f64; 2], point: [f64; 2]| {
            let square = length_squared(way);
            if square > 0.0 {
                (scalar(minus(point, from), way) / square).clamp(0.0, 1.0)
            } else {
                0.0
            }
        };
        let [start, end] = ends(to);
        let other_way = minus(other[end], other[start]);
        // An end of one of the axes is nearest.
        let mut best = (f64::INFINITY, 0.0);
        let mut offer = |fraction: f64, other_fraction: f64| {
            let between = minus(
                [0, 1].map(|k| other[start][k] + other_fraction * other_way[k]),
                [0, 1].map(|k| own[first][k] + fraction * way[k]),
            );
            if length_squared(between) < best.0 {
                best = (length_squared(between), fraction);
            }
        };
        for (at, point) in [(0.0, own[first]), (1.0, own[last])] {
            offer(at, on_segment(other[start], other_way, point));
        }
        for (at, point) in [(0.0, other[start]), (1.0, other[end])] {
            offer(on_segment(own[first], way, point), at);
        }
        best.1
    });
    if square == 0.0 {
        return of.points[first];
    }
    let part = difference(of.points[last], of.points[first]).map(|part| part.times(fraction));
    sum(of.points[first], part)
}

/// Returns the fraction of the first axis, from its first end, at which it crosses the second in the middle of a box, if it does.
fn crossing(a: &AxisEnclosure, b: &AxisEnclosure) -> Option<f64> {
    let span = |axis: &AxisEnclosure| {
        let points = middle(axis);
        let [first, last] = ends(axis);
        (points[first], minus(points[last], points[first]))
    };
    let ((from_a, way_a), (from_b, way_b)) = (span(a), span(b));
    let turn = way_a[0] * way_b[1] - way_a[1] * way_b[0];
    let between = minus(from_b, from_a);
    let on_a = (between[0] * way_b[1] - between[1] * way_b[0]) / turn;
    let on_b = (between[0] * way_a[1] - between[1] * way_a[0]) / turn;
    let crosses = (0.0..=1.0).contains(&on_a) && (0.0..=1.0).contains(&on_b);
    crosses.then_some(on_a)
}

/// The points of an axis in the middle of the box.
fn middle(axis: &AxisEnclosure) -> [[f64; 2]; 3] {
    axis.points.map(|point| point.map(|part| part.constant))
}

/// Places of the first and the last point of an axis along its direction, in the middle of the box.
fn ends(axis: &AxisEnclosure) -> [usize; 2] {
    let along = axis.direction.map(|part| part.constant);
    let points = middle(axis);
    let place = |k: usize| scalar(points[k], along);
    let order = |better: fn(&f64, &f64) -> bool| {
        (1..3).fold(0, |best, k| if better(&place(k), &place(best)) { k } else { best })
    };
    [order(f64::lt), order(f64::gt)]
}

/// The points of an axis, each once.
fn distinct(axis: &AxisEnclosure) -> impl Iterator<Item = PlanarModel> {
    let [_, second, third] = axis.points;
    let count = if second == third { 2 } else { 3 };
    axis.points.into_iter().take(count)
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn scalar(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn length_squared(a: [f64; 2]) -> f64 {
    scalar(a, a)
}
