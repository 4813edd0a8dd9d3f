//! Regions of positions: the largest disc, or a region that the study prescribes (docs/model.md, section 7.4).

use std::sync::Arc;

use glam::DVec2;

use super::Grid;
use crate::spatial::{nearest_on_segment, unit};

/// Region of positions of `P` over which every pose must be feasible.
#[derive(Debug, Clone, PartialEq)]
pub enum Region {
    /// The largest disc about the centre, which is determined for each design.
    Largest,
    /// The disc of this radius about the centre \[m\].
    Disc(f64),
    /// A polygon, which need not contain the centre.
    Polygon(Polygon),
}

/// A simple polygon, given by its corners relative to the centre of the workspace \[m\].
///
/// ```
/// use glam::DVec2;
/// use kinefront_model::workspace::Polygon;
///
/// let rectangle = Polygon::rectangle(0.6, 0.4)?;
/// assert!(rectangle.contains(DVec2::new(0.29, -0.19)) && !rectangle.contains(DVec2::new(0.31, 0.0)));
/// assert!((rectangle.inscribed_radius() - 0.2).abs() < 1e-15);
/// # Ok::<(), kinefront_model::workspace::PolygonError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Polygon(Arc<[DVec2]>);

/// Why corners do not form a polygon.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum PolygonError {
    /// Fewer than three corners.
    #[error("it has {0} corners; a polygon has at least three")]
    TooFew(usize),
    /// A coordinate is not finite.
    #[error("corner {0} has a coordinate that is not finite")]
    NotFinite(usize),
    /// Two sides meet other than at their common corner.
    #[error("sides {0} and {1} meet; the sides of the polygon must not touch or cross each other")]
    Crossing(usize, usize),
}

/// Positions at which a region is examined \[m\].
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct RegionPositions {
    /// The positions; the first ones are spread over the boundary.
    pub all: Vec<DVec2>,
    /// Number of the first ones, which bound the worst margin at little cost.
    pub first: usize,
}

/// Resolution of the grid, as a fraction of the radius of a disc, above which the radius of the rim is rounded up to the resolution.
const COARSE: f64 = 5e-5;

/// Number of positions of the boundary of a polygon that are examined first.
const FIRST: usize = 16;

impl Polygon {
    /// Creates the polygon with the given corners.
    ///
    /// # Errors
    /// [`PolygonError`].
    pub fn new(corners: Vec<DVec2>) -> Result<Self, PolygonError> {
        let count = corners.len();
        if count < 3 {
            return Err(PolygonError::TooFew(count));
        }
        if let Some(place) = corners.iter().position(|corner| !corner.is_finite()) {
            return Err(PolygonError::NotFinite(place + 1));
        }
        let polygon = Self(corners.into());
        let sides: Vec<[DVec2; 2]> = polygon.sides().collect();
        for first in 0..count {
            for second in first + 1..count {
                let neighbours = second == first + 1 || (first == 0 && second == count - 1);
                let folded =
                    sides[first][0] == sides[first][1] || neighbours && is_folded(&sides[first], &sides[second]);
                if folded || !neighbours && meet(&sides[first], &sides[second]) {
                    return Err(PolygonError::Crossing(first + 1, second + 1));
                }
            }
        }
        Ok(polygon)
    }

    /// Creates the rectangle of a width along `Ox` and a height along `Oy` \[m\] about the centre.
    ///
    /// # Errors
    /// [`PolygonError`] if a side is 0 or not finite.
    pub fn rectangle(width: f64, height: f64) -> Result<Self, PolygonError> {
        let corner = |x: f64, y: f64| DVec2::new(0.5 * x * width, 0.5 * y * height);
        Self::new(vec![
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ])
    }

    /// The corners \[m\].
    pub fn corners(&self) -> &[DVec2] {
        &self.0
    }

    /// Returns the lower and the upper corner \[m\] if the polygon is a rectangle with sides along the axes.
    pub fn as_rectangle(&self) -> Option<[DVec2; 2]> {
        let [low, high] = self.bounds();
        let is_corner = |corner: &DVec2| [low.x, high.x].contains(&corner.x) && [low.y, high.y].contains(&corner.y);
        let along_axes = self.sides().all(|[from, to]| from.x == to.x || from.y == to.y);
        (self.0.len() == 4 && along_axes && self.0.iter().all(is_corner)).then_some([low, high])
    }

    fn sides(&self) -> impl Iterator<Item = [DVec2; 2]> {
        let next = self.0.iter().cycle().skip(1);
        self.0.iter().zip(next).map(|(from, to)| [*from, *to])
    }

    /// Returns whether a point lies within the polygon.
    pub fn contains(&self, point: DVec2) -> bool {
        self.sides().fold(false, |inside, [from, to]| {
            let straddles = (from.y > point.y) != (to.y > point.y);
            let crosses = || {
                let x = from.x + (point.y - from.y) / (to.y - from.y) * (to.x - from.x);
                point.x < x
            };
            inside != (straddles && crosses())
        })
    }

    /// Returns the distance of a point from the boundary \[m\].
    pub fn distance_to_boundary(&self, point: DVec2) -> f64 {
        let to_side = |[from, to]: [DVec2; 2]| point.distance(from.lerp(to, nearest_on_segment(point, from, to)));
        self.sides().map(to_side).fold(f64::INFINITY, f64::min)
    }

    /// Returns the radius of the largest disc about the centre that lies within the polygon \[m\].
    pub fn inscribed_radius(&self) -> f64 {
        if self.contains(DVec2::ZERO) {
            self.distance_to_boundary(DVec2::ZERO)
        } else {
            0.0
        }
    }

    /// Returns the lower and the upper corner of the smallest rectangle with sides along the axes that holds the polygon \[m\].
    fn bounds(&self) -> [DVec2; 2] {
        let first = self.0[0];
        self.0.iter().fold([first, first], |[low, high], corner| {
            [low.min(*corner), high.max(*corner)]
        })
    }

    /// Returns positions on the boundary no farther apart than `spacing`, from corner to corner.
    pub(crate) fn boundary(&self, spacing: f64) -> Vec<DVec2> {
        let along = |[from, to]: [DVec2; 2]| {
            let count = (from.distance(to) / spacing).ceil().max(1.0) as usize;
            (0..count).map(move |k| from.lerp(to, k as f64 / count as f64))
        };
        self.sides().flat_map(along).collect()
    }

    /// Returns the middles of the cells of a square lattice that lie within the polygon, with `count` cells along the longer
    /// side of the rectangle that holds the polygon.
    pub(crate) fn lattice(&self, count: usize) -> Vec<DVec2> {
        let [low, high] = self.bounds();
        let spacing = (high - low).max_element() / count as f64;
        let [columns, rows] = (high - low)
            .to_array()
            .map(|side| (side / spacing).round().max(1.0) as usize);
        let cell = (high - low) / DVec2::new(columns as f64, rows as f64);
        (0..rows)
            .flat_map(|row| (0..columns).map(move |column| DVec2::new(column as f64 + 0.5, row as f64 + 0.5)))
            .map(|place| low + place * cell)
            .filter(|place| self.contains(*place))
            .collect()
    }

    /// Returns the distance of positions that divides the longer side of the rectangle that holds the polygon into `count` steps.
    fn spacing(&self, count: usize) -> f64 {
        let [low, high] = self.bounds();
        (high - low).max_element() / count as f64
    }

    /// Returns the positions at which the polygon is examined: its boundary and the lattice within it, with `count` steps along
    /// the longer side of the rectangle that holds it.
    fn positions(&self, count: usize) -> RegionPositions {
        let boundary = self.boundary(self.spacing(count));
        let stride = boundary.len().div_ceil(FIRST);
        let (mut first, rest): (Vec<_>, Vec<_>) = boundary
            .into_iter()
            .enumerate()
            .partition(|(place, _)| place % stride == 0);
        let examined_first = first.len();
        first.extend(rest);
        let mut all: Vec<DVec2> = first.into_iter().map(|(_, position)| position).collect();
        all.extend(self.lattice(count));
        RegionPositions {
            all,
            first: examined_first,
        }
    }
}

/// Returns whether two sides have a point in common.
fn meet(a: &[DVec2; 2], b: &[DVec2; 2]) -> bool {
    let turn = |from: DVec2, to: DVec2, point: DVec2| (to - from).perp_dot(point - from);
    let (first, second) = (turn(a[0], a[1], b[0]), turn(a[0], a[1], b[1]));
    let (third, fourth) = (turn(b[0], b[1], a[0]), turn(b[0], b[1], a[1]));
    let on = |side: &[DVec2; 2], point: DVec2| {
        let nearest = side[0].lerp(side[1], nearest_on_segment(point, side[0], side[1]));
        nearest == point
    };
    (first * second < 0.0 && third * fourth < 0.0) || on(a, b[0]) || on(a, b[1]) || on(b, a[0]) || on(b, a[1])
}

/// Returns whether two neighbouring sides lie on top of each other.
fn is_folded(a: &[DVec2; 2], b: &[DVec2; 2]) -> bool {
    let (a, b) = if a[1] == b[0] { (a, b) } else { (b, a) };
    let (back, on) = (a[0] - a[1], b[1] - b[0]);
    back.perp_dot(on) == 0.0 && back.dot(on) > 0.0
}

impl Region {
    /// Returns the radius of the largest disc about the centre within a prescribed region \[m\]; `None` for the largest disc.
    pub fn inscribed_radius(&self) -> Option<f64> {
        match self {
            Region::Largest => None,
            Region::Disc(radius) => Some(*radius),
            Region::Polygon(polygon) => Some(polygon.inscribed_radius()),
        }
    }

    /// Returns the region with all lengths multiplied by `factor`.
    pub(crate) fn scaled(&self, factor: f64) -> Self {
        match self {
            Region::Largest => Region::Largest,
            Region::Disc(radius) => Region::Disc(radius * factor),
            Region::Polygon(Polygon(corners)) => {
                Region::Polygon(Polygon(corners.iter().map(|corner| *corner * factor).collect()))
            }
        }
    }

    /// Whether the study prescribes the region.
    pub fn is_prescribed(&self) -> bool {
        *self != Region::Largest
    }

    /// Returns about `count` positions on the boundary, relative to the centre \[m\], with all corners.
    pub(crate) fn outline(&self, count: usize) -> Vec<DVec2> {
        match self {
            Region::Largest => Vec::new(),
            Region::Disc(radius) => {
                let angle = |k: usize| std::f64::consts::TAU * k as f64 / count as f64;
                (0..count).map(|k| unit(angle(k)) * *radius).collect()
            }
            Region::Polygon(polygon) => {
                let around: f64 = polygon.sides().map(|[from, to]| from.distance(to)).sum();
                polygon.boundary(around / count as f64)
            }
        }
    }

    /// Returns the positions at which a prescribed region about `centre` is examined. `step` is the step of a ray and
    /// `directions` are its directions. The radius of a very small disc is rounded up to the resolution of the grid, so that on
    /// the same grid a disc of 0.9999 `R_w` is feasible and one of 1.0001 `R_w` is not.
    pub(crate) fn positions(&self, centre: DVec2, grid: &Grid, step: f64, directions: &[DVec2]) -> RegionPositions {
        let mut found = match self {
            Region::Largest => RegionPositions::default(),
            Region::Disc(radius) => disc(rim(*radius, step, grid), step, directions),
            Region::Polygon(polygon) => polygon.positions(grid.ray_steps()),
        };
        for position in &mut found.all {
            *position += centre;
        }
        found
    }

    /// Returns only those positions of a prescribed region that lie on its boundary.
    pub(crate) fn boundary_positions(&self, centre: DVec2, grid: &Grid, step: f64, directions: &[DVec2]) -> Vec<DVec2> {
        match self {
            Region::Largest => Vec::new(),
            Region::Disc(radius) => {
                let rim = rim(*radius, step, grid);
                directions.iter().map(|direction| centre + *direction * rim).collect()
            }
            Region::Polygon(polygon) => {
                let boundary = polygon.boundary(polygon.spacing(grid.ray_steps())).into_iter();
                boundary.map(|position| centre + position).collect()
            }
        }
    }

    /// Returns positions about `centre` and their weights, which sum up to 1, for means over the region of a workspace of the
    /// radius `radius` \[m\].
    pub(crate) fn quadrature(
        &self,
        centre: DVec2,
        radius: f64,
        rings: usize,
        directions: &[DVec2],
    ) -> Vec<(DVec2, f64)> {
        match self {
            Region::Polygon(polygon) => {
                let cells = polygon.lattice(2 * rings);
                let weight = 1.0 / cells.len() as f64;
                cells.into_iter().map(|cell| (centre + cell, weight)).collect()
            }
            Region::Largest | Region::Disc(_) => {
                // The middle of each of the rings, weighted by its area.
                let rings = rings.max(1) as f64;
                let of_ring = |ring: f64| {
                    let weight = (2.0 * ring + 1.0) / (rings * rings * directions.len() as f64);
                    let distance = radius * (ring + 0.5) / rings;
                    directions
                        .iter()
                        .map(move |direction| (centre + *direction * distance, weight))
                };
                (0..rings as usize).flat_map(|ring| of_ring(ring as f64)).collect()
            }
        }
    }
}

/// Returns the radius of the rim on which a disc is examined.
fn rim(radius: f64, step: f64, grid: &Grid) -> f64 {
    let resolution = step / f64::from(1u32 << grid.halvings().min(30));
    if resolution <= COARSE * radius {
        return radius;
    }
    // A radius that is a multiple of the resolution but for rounding is not rounded up.
    (radius / resolution - 1e-9).ceil() * resolution
}

/// Returns the rings of a disc from its rim inwards, and its centre.
fn disc(rim: f64, step: f64, directions: &[DVec2]) -> RegionPositions {
    let inside = (rim / step - 1e-9).ceil() as usize;
    let inner = (1..inside).rev().map(|ring| ring as f64 * step);
    let mut all: Vec<DVec2> = Vec::new();
    for distance in std::iter::once(rim).chain(inner) {
        all.extend(directions.iter().map(|direction| *direction * distance));
    }
    all.push(DVec2::ZERO);
    RegionPositions {
        all,
        first: directions.len(),
    }
}

/// Returns the directions of rays, of which a symmetric design needs one sector.
pub(crate) fn directions(grid: &Grid, symmetric: bool) -> Vec<DVec2> {
    let sectors = crate::spatial::LEGS;
    let count = if symmetric && grid.directions().is_multiple_of(sectors) {
        grid.directions() / sectors
    } else {
        grid.directions()
    };
    (0..count)
        .map(|k| unit((k as f64 * 360.0 / grid.directions() as f64).to_radians()))
        .collect()
}
