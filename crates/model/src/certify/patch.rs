//! Parts of a region, each with coordinates of its positions.

use glam::DVec2;

use crate::enclosure::{Interval, PlanarModel, TaylorModel};
use crate::polygon::Polygon;
use crate::workspace::Region;

/// A part of a region, whose positions have two coordinates, relative to the centre of the region.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Patch {
    /// A disc about the centre: distance from it \[m\] and direction \[rad\].
    Disc,
    /// A rectangle with sides along the axes, from its lower to its upper corner \[m\]: the components of the position \[m\].
    Rectangle([DVec2; 2]),
    /// A triangle, by its corners \[m\]: with the fractions `a` and `b`, the position is `c₀ + a (c₁ − c₀ + b (c₂ − c₁))`.
    Triangle([DVec2; 3]),
}

impl Patch {
    /// Returns the parts of a region: a disc is one, and so is a rectangle with sides along the axes; any other polygon is cut into
    /// triangles.
    pub(super) fn of(region: &Region) -> Vec<Self> {
        match region {
            Region::Largest | Region::Disc(_) => vec![Self::Disc],
            Region::Polygon(polygon) => match polygon.as_rectangle() {
                Some(corners) => vec![Self::Rectangle(corners)],
                None => triangles(polygon).into_iter().map(Self::Triangle).collect(),
            },
        }
    }

    /// Returns the smallest and the largest coordinates; those of a disc of the radius `reach` \[m\] cover the directions from 0 to
    /// `sector` \[rad\].
    pub(super) fn ranges(&self, reach: f64, sector: f64) -> [[f64; 2]; 2] {
        match self {
            Self::Disc => [[0.0, reach], [0.0, sector]],
            Self::Rectangle([lower, upper]) => [[lower.x, upper.x], [lower.y, upper.y]],
            Self::Triangle(_) => [[0.0, 1.0]; 2],
        }
    }

    /// Returns the position at two coordinates, relative to the centre \[m\].
    pub fn position(&self, [first, second]: [f64; 2]) -> DVec2 {
        match self {
            Self::Disc => DVec2::new(first * libm::cos(second), first * libm::sin(second)),
            Self::Rectangle(_) => DVec2::new(first, second),
            Self::Triangle([apex, start, end]) => apex + (start - apex + (end - start) * second) * first,
        }
    }

    /// Returns the direction in which the first coordinate moves a position \[rad\].
    pub fn direction(&self, [_, second]: [f64; 2]) -> f64 {
        match self {
            Self::Disc => second,
            Self::Rectangle(_) => 0.0,
            Self::Triangle([apex, start, end]) => (start - apex + (end - start) * second).to_angle(),
        }
    }

    /// Returns by how much the coordinates move a position at `[first, second]` \[m per unit of the coordinate\].
    pub fn scale(&self, [first, second]: [f64; 2]) -> [f64; 2] {
        match self {
            Self::Disc => [1.0, first],
            Self::Rectangle(_) => [1.0; 2],
            Self::Triangle([apex, start, end]) => {
                let side = end - start;
                [(start - apex + side * second).length(), first * side.length()]
            }
        }
    }

    /// Encloses the positions of a box by the middles and radii of its coordinates, relative to the centre \[m\].
    pub(super) fn enclose(&self, [(first, by_first), (second, by_second)]: [(f64, f64); 2]) -> PlanarModel {
        let along = TaylorModel::variable(0, first, by_first);
        match self {
            Self::Disc => {
                let (sine, cosine) = TaylorModel::sine_and_cosine(1, second, by_second);
                [along * cosine, along * sine]
            }
            Self::Rectangle(_) => [along, TaylorModel::variable(1, second, by_second)],
            Self::Triangle(corners) => {
                let across = TaylorModel::variable(1, second, by_second);
                [0, 1].map(|k| {
                    let [apex, start, end] = corners.map(|corner| Interval::exactly(corner[k]));
                    let side = across.scaled(end - start).plus(start - apex);
                    (along * side).plus(apex)
                })
            }
        }
    }
}

/// Cuts a polygon into triangles, ear by ear (Meisters 1975).
fn triangles(polygon: &Polygon) -> Vec<[DVec2; 3]> {
    let mut corners = polygon.corners().to_vec();
    let turn = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - a);
    let doubled_area: f64 = (0..corners.len())
        .map(|k| corners[k].perp_dot(corners[(k + 1) % corners.len()]))
        .sum();
    if doubled_area < 0.0 {
        corners.reverse();
    }
    let mut found = Vec::with_capacity(corners.len() - 2);
    while corners.len() > 3 {
        let count = corners.len();
        let at = |k: usize| corners[k % count];
        let is_ear = |&k: &usize| {
            let [a, b, c] = [at(k + count - 1), at(k), at(k + 1)];
            let holds = |p: &DVec2| {
                let is_corner = [a, b, c].contains(p);
                !is_corner && turn(a, b, *p) >= 0.0 && turn(b, c, *p) >= 0.0 && turn(c, a, *p) >= 0.0
            };
            turn(a, b, c) > 0.0 && !corners.iter().any(holds)
        };
        // A corner between two sides on one line is no ear; it is cut off with no area once no other is left.
        let ear = (0..count).find(is_ear).unwrap_or(0);
        let triangle = [at(ear), at(ear + 1), at(ear + count - 1)];
        if turn(triangle[0], triangle[1], triangle[2]) != 0.0 {
            found.push(triangle);
        }
        corners.remove(ear);
    }
    found.extend(<[DVec2; 3]>::try_from(corners));
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The triangles of a polygon that is not convex have its area, and all of their points lie within it.
    #[test]
    fn triangles_fill_a_polygon() {
        let corners = [
            [0.0, 0.0],
            [2.0, 0.0],
            [4.0, 0.0],
            [4.0, 3.0],
            [2.0, 1.0],
            [1.0, 3.0],
            [0.5, 1.0],
        ];
        for reversed in [false, true] {
            let mut corners: Vec<DVec2> = corners.iter().map(|&[x, y]| DVec2::new(x, y)).collect();
            if reversed {
                corners.reverse();
            }
            let polygon = Polygon::new(corners.clone()).expect("a polygon");
            let found = triangles(&polygon);
            let of_triangle = |[a, b, c]: &[DVec2; 3]| 0.5 * (b - a).perp_dot(c - a).abs();
            let area: f64 = found.iter().map(of_triangle).sum();
            let expected: f64 = (0..corners.len())
                .map(|k| 0.5 * corners[k].perp_dot(corners[(k + 1) % corners.len()]))
                .sum();
            assert!((area - expected.abs()).abs() < 1e-12, "{area} of {expected}");
            for triangle in found {
                for (a, b) in [(0.1, 0.5), (0.5, 0.1), (0.5, 0.9), (0.99, 0.5)] {
                    let point = Patch::Triangle(triangle).position([a, b]);
                    assert!(polygon.contains(point), "{point} of {triangle:?}");
                }
            }
        }
    }
}
