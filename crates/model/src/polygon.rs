//! Simple polygons in the plane.

use std::sync::Arc;

use glam::DVec2;

use crate::spatial::nearest_on_segment;

/// A simple polygon, given by its corners \[m\].
///
/// ```
/// use glam::DVec2;
/// use kinefront_model::polygon::Polygon;
///
/// let rectangle = Polygon::rectangle(0.6, 0.4)?;
/// assert!(rectangle.contains(DVec2::new(0.29, -0.19)) && !rectangle.contains(DVec2::new(0.31, 0.0)));
/// assert!((rectangle.inscribed_radius() - 0.2).abs() < 1e-15);
/// # Ok::<(), kinefront_model::polygon::PolygonError>(())
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

    /// Returns the polygon with the image of each corner under a map that keeps it simple.
    pub fn mapped(&self, map: impl Fn(DVec2) -> DVec2) -> Self {
        Self(self.0.iter().map(|corner| map(*corner)).collect())
    }

    /// Iterates over the sides, each from one corner to the next.
    pub fn sides(&self) -> impl Iterator<Item = [DVec2; 2]> {
        let next = self.0.iter().cycle().skip(1);
        self.0.iter().zip(next).map(|(from, to)| [*from, *to])
    }

    /// Returns whether a point lies within the polygon.
    pub fn contains(&self, point: DVec2) -> bool {
        self.sides().fold(false, |inside, [from, to]| {
            let straddles = (from.y > point.y) != (to.y > point.y);
            let crosses = || point.x < from.x + (point.y - from.y) / (to.y - from.y) * (to.x - from.x);
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
    pub fn bounds(&self) -> [DVec2; 2] {
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
    pub fn lattice(&self, count: usize) -> Vec<DVec2> {
        let [low, high] = self.bounds();
        let spacing = self.spacing(count);
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
    pub(crate) fn spacing(&self, count: usize) -> f64 {
        let [low, high] = self.bounds();
        (high - low).max_element() / count as f64
    }
}

/// Returns whether two sides have a point in common.
fn meet(a: &[DVec2; 2], b: &[DVec2; 2]) -> bool {
    let turn = |from: DVec2, to: DVec2, point: DVec2| (to - from).perp_dot(point - from);
    let (first, second) = (turn(a[0], a[1], b[0]), turn(a[0], a[1], b[1]));
    let (third, fourth) = (turn(b[0], b[1], a[0]), turn(b[0], b[1], a[1]));
    let on = |[from, to]: &[DVec2; 2], point: DVec2| from.lerp(*to, nearest_on_segment(point, *from, *to)) == point;
    (first * second < 0.0 && third * fourth < 0.0) || on(a, b[0]) || on(a, b[1]) || on(b, a[0]) || on(b, a[1])
}

/// Returns whether two neighbouring sides lie on top of each other.
fn is_folded(a: &[DVec2; 2], b: &[DVec2; 2]) -> bool {
    let (a, b) = if a[1] == b[0] { (a, b) } else { (b, a) };
    let (back, on) = (a[0] - a[1], b[1] - b[0]);
    back.perp_dot(on) == 0.0 && back.dot(on) > 0.0
}
