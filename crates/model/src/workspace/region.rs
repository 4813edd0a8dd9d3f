//! Regions of positions: the largest disc, or a region that the study prescribes (docs/model.md, section 7.4).

use glam::DVec2;

use super::Grid;
use crate::polygon::Polygon;
use crate::spatial::unit;

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
            Region::Polygon(polygon) => Region::Polygon(polygon.mapped(|corner| corner * factor)),
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
            Region::Polygon(polygon) => of_polygon(polygon, grid.ray_steps()),
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
    let resolution = grid.resolution(step);
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

/// Returns the positions at which a polygon is examined: its boundary and the lattice within it, with `count` steps along
/// the longer side of the rectangle that holds it.
fn of_polygon(polygon: &Polygon, count: usize) -> RegionPositions {
    let boundary = polygon.boundary(polygon.spacing(count));
    let stride = boundary.len().div_ceil(FIRST);
    let (mut first, rest): (Vec<_>, Vec<_>) = boundary
        .into_iter()
        .enumerate()
        .partition(|(place, _)| place % stride == 0);
    let examined_first = first.len();
    first.extend(rest);
    let mut all: Vec<DVec2> = first.into_iter().map(|(_, position)| position).collect();
    all.extend(polygon.lattice(count));
    RegionPositions {
        all,
        first: examined_first,
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
