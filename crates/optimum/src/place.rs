//! Poses of a region that move with it: shares of its size, and of the rotation range.

use glam::DVec2;
use kinefront_model::polygon::Polygon;
use kinefront_model::spatial::unit;
use kinefront_model::workspace::Region;

/// A position of a region, as a share of its size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spot {
    /// On the rim of a disc, at an angle to `Ox` \[rad\].
    Rim(f64),
    /// On a side of a polygon, at a share of it in \[0, 1\].
    Side(usize, f64),
    /// Within the region: for a disc, in multiples of its radius; for a polygon, of half the sides of the smallest rectangle about the
    /// centre that holds it.
    Inside([f64; 2]),
}

/// A pose of a region, as a share of its size and of the rotation range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// The position.
    pub spot: Spot,
    /// The orientation from the home orientation, as a share of half the rotation range, in \[−1, 1\].
    pub turn: f64,
}

/// A region with the measures of its places.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Area {
    Disc(f64),
    /// The polygon, and half the sides of the smallest rectangle about the centre that holds it.
    Polygon(Polygon, DVec2),
}

impl Area {
    /// Returns the area of a region; `None` for the largest disc, whose radius is not known.
    pub fn new(region: &Region) -> Option<Self> {
        match region {
            Region::Largest => None,
            Region::Disc(radius) => Some(Area::Disc(*radius)),
            Region::Polygon(polygon) => {
                let farthest = |most: DVec2, corner: &DVec2| most.max(corner.abs());
                let half = polygon.corners().iter().fold(DVec2::ZERO, farthest);
                Some(Area::Polygon(polygon.clone(), half))
            }
        }
    }

    /// Returns the position of a spot relative to the centre \[m\].
    pub fn position(&self, spot: Spot) -> DVec2 {
        match (self, spot) {
            (Area::Disc(radius), Spot::Rim(angle)) => unit(angle) * *radius,
            (Area::Disc(radius), Spot::Inside(at)) => DVec2::from(at) * *radius,
            (Area::Polygon(_, half), Spot::Inside(at)) => DVec2::from(at) * *half,
            (Area::Polygon(polygon, _), Spot::Side(side, share)) => {
                let corners = polygon.corners();
                let (from, to) = (corners[side], corners[(side + 1) % corners.len()]);
                from + (to - from) * share
            }
            // A spot of the other kind of region, which no caller has.
            (Area::Disc(_), Spot::Side(..)) | (Area::Polygon(..), Spot::Rim(_)) => DVec2::ZERO,
        }
    }

    /// Returns the ways in which a spot moves: by its first or its second coordinate.
    pub fn freedoms(spot: Spot) -> usize {
        match spot {
            Spot::Rim(_) | Spot::Side(..) => 1,
            Spot::Inside(_) => 2,
        }
    }

    /// Returns a spot moved by a step in one of its freedoms; `None` beyond the end of the region.
    pub fn moved(&self, spot: Spot, freedom: usize, step: f64) -> Option<Spot> {
        match spot {
            Spot::Rim(angle) => Some(Spot::Rim(angle + step)),
            Spot::Side(side, share) => {
                let moved = (share + step).clamp(0.0, 1.0);
                (moved != share).then_some(Spot::Side(side, moved))
            }
            Spot::Inside(mut at) => {
                at[freedom] += step;
                let moved = Spot::Inside(at);
                let is_inside = match self {
                    Area::Disc(_) => at[0] * at[0] + at[1] * at[1] <= 1.0,
                    Area::Polygon(polygon, _) => polygon.contains(self.position(moved)),
                };
                is_inside.then_some(moved)
            }
        }
    }

    /// Returns spots that cover the region, with the neighbours of each. Of a disc that looks alike after a third of a turn, a sector is
    /// covered.
    pub fn spots(&self, is_three_fold: bool, density: Density) -> Spots {
        let [directions, rings, per_side] = [DIRECTIONS, RINGS, PER_SIDE].map(|count| count * density.times());
        let mut spots = Vec::new();
        match self {
            Area::Disc(_) => {
                let count = if is_three_fold { directions / 3 } else { directions };
                let angle = |k: usize| std::f64::consts::TAU * k as f64 / directions as f64;
                spots.extend((0..count).map(|k| Spot::Rim(angle(k))));
                for ring in (1..rings).rev() {
                    let share = ring as f64 / rings as f64;
                    spots.extend((0..count).map(|k| Spot::Inside((unit(angle(k)) * share).to_array())));
                }
                spots.push(Spot::Inside([0.0; 2]));
            }
            Area::Polygon(polygon, half) => {
                for side in 0..polygon.corners().len() {
                    spots.extend((0..per_side).map(|k| Spot::Side(side, k as f64 / per_side as f64)));
                }
                let inside = polygon.lattice(per_side);
                spots.extend(inside.into_iter().map(|at| Spot::Inside((at / *half).to_array())));
            }
        }
        let reach = match self {
            Area::Disc(radius) => *radius * DISC_SPACING / density.times() as f64,
            Area::Polygon(_, half) => 2.0 * half.max_element() * POLYGON_SPACING / per_side as f64,
        };
        Spots::new(self, spots, reach, is_three_fold, density)
    }
}

/// Directions in which a disc is examined.
const DIRECTIONS: usize = 36;

/// Rings on which a disc is examined, with the rim.
const RINGS: usize = 6;

/// Spots of a disc that are nearer to each other than this multiple of its radius are neighbours.
const DISC_SPACING: f64 = 0.25;

/// Spots on a side of a polygon, and cells along the longer side of the rectangle that holds it.
const PER_SIDE: usize = 12;

/// Spots of a polygon that are nearer to each other than this multiple of their spacing are neighbours.
const POLYGON_SPACING: f64 = 1.5;

/// Steps of the orientations that are examined, from one end of the rotation range to the other.
const TURNS: usize = 8;

/// How densely a region is examined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Density {
    /// While a design changes.
    Coarse,
    /// To confirm that it holds: a pocket near a serial singularity is narrow.
    Fine,
}

impl Density {
    fn times(self) -> usize {
        match self {
            Density::Coarse => 1,
            Density::Fine => 2,
        }
    }
}

/// Spots that cover a region.
#[derive(Debug, Clone)]
pub(crate) struct Spots {
    pub all: Vec<Spot>,
    /// Of each spot, the places of its neighbours.
    pub neighbours: Vec<Vec<usize>>,
    /// Orientations, as shares of half the rotation range.
    pub turns: Vec<f64>,
}

impl Spots {
    fn new(area: &Area, all: Vec<Spot>, reach: f64, is_three_fold: bool, density: Density) -> Self {
        let positions: Vec<DVec2> = all.iter().map(|spot| area.position(*spot)).collect();
        let turns = if is_three_fold { 3 } else { 1 };
        let third = |turn: usize| unit(std::f64::consts::TAU * turn as f64 / 3.0);
        let near = |a: DVec2, b: DVec2| (0..turns).any(|turn| third(turn).rotate(a).distance(b) < reach);
        let neighbours = |place: usize| {
            let others = (0..positions.len()).filter(|&other| other != place);
            others
                .filter(|&other| near(positions[place], positions[other]))
                .collect()
        };
        let neighbours = (0..positions.len()).map(neighbours).collect();
        let steps = TURNS * density.times();
        let turns = (0..=steps)
            .map(|index| 2.0 * index as f64 / steps as f64 - 1.0)
            .collect();
        Self { all, neighbours, turns }
    }
}
