//! Sizing of the bars for a disc, on a few rings of it (docs/model.md, section 9).

use std::f64::consts::TAU;

use glam::DVec2;

use super::lightest::SizingAccuracy;
use super::pose_columns::PlacedPose;
use super::sizer::{Shape, Sizer};
use crate::mechanism::{Design, Leg};
use crate::spatial::LEGS;

/// Number of directions of a ring over a sector of 120°.
const DIRECTIONS: usize = 16;

/// Radii of the rings on which bars are sized, besides the centre, as fractions of the radius of the disc.
const RINGS: [f64; 4] = [1.0, 0.75, 0.5, 0.25];

/// Number of halvings in the search for the largest radius.
const HALVINGS: usize = 10;

impl<L: Leg> Sizer<'_, L> {
    /// Returns the design with the lightest bars for a disc of a given radius \[m\], or of the largest one without one.
    pub(super) fn sized_for_disc(mut self, radius: Option<f64>) -> Option<Design> {
        // The candidates are the orientations with a feasible centre that belong to a whole window of such
        // orientations.
        let all: Vec<usize> = (0..self.arms.len()).collect();
        let centres = self.ring(0.0, &all);
        let candidates = self.windows(&centres);
        if candidates.is_empty() {
            return None;
        }
        let radius = match radius {
            Some(radius) => radius,
            None => self.largest(&candidates)?,
        };
        let home = self.home(radius, &candidates)?;
        let window: Vec<usize> = self.orientation_grid.window(home).collect();
        self.lay_disc(radius, &window);
        let bars = self.lightest_bars(SizingAccuracy::COARSE)?;
        Some(self.design.with_bars(bars))
    }

    /// Lays out the ring of a radius in the given orientations, and returns the number of poses in each orientation.
    fn lay_ring(&mut self, radius: f64, orientations: &[usize]) -> usize {
        let count = if radius > 0.0 { DIRECTIONS * self.sectors } else { 1 };
        let step = TAU / (LEGS * DIRECTIONS) as f64;
        let ring: Vec<DVec2> = (0..count).map(|k| self.position(radius, k as f64 * step)).collect();
        self.lay(&ring, orientations);
        count
    }

    /// Lays out the disc of a radius, including its centre. Each ring is rotated by half a step relative to the one
    /// before, so that together they cover more directions.
    fn lay_disc(&mut self, radius: f64, orientations: &[usize]) {
        let step = TAU / (LEGS * DIRECTIONS) as f64;
        let spacing = [radius / RINGS.len() as f64, step];
        self.shape = Shape::Disc(radius);
        self.places.clear();
        let placed = |orientation: usize, place: [f64; 2]| PlacedPose {
            orientation,
            place,
            spacing,
            refined: false,
        };
        for &orientation in orientations {
            self.places.push(placed(orientation, [0.0, 0.0]));
            for (ring, fraction) in RINGS.iter().enumerate() {
                let offset = if ring % 2 == 0 { 0.0 } else { 0.5 };
                let on_ring = |k: usize| [fraction * radius, (k as f64 + offset) * step];
                let ring = (0..DIRECTIONS * self.sectors).map(|k| placed(orientation, on_ring(k)));
                self.places.extend(ring);
            }
        }
        let of_one = 1 + RINGS.len() * DIRECTIONS * self.sectors;
        let disc: Vec<DVec2> = self.places[..of_one]
            .iter()
            .map(|pose| self.position_of(pose.place))
            .collect();
        self.lay(&disc, orientations);
    }

    /// Returns the sign of `det A` on the ring for each orientation; `None` if the orientation is not among the given
    /// ones or any pose of the ring is infeasible.
    fn ring(&mut self, radius: f64, orientations: &[usize]) -> Vec<Option<f64>> {
        let count = self.lay_ring(radius, orientations);
        self.signs_of_laid(count, orientations)
    }

    /// Returns the largest radius whose ring is feasible over some window, found by doubling and halving; `None` if no
    /// ring is.
    fn largest(&mut self, candidates: &[usize]) -> Option<f64> {
        let mut candidates = candidates.to_vec();
        let (mut good, mut bad) = (0.0, None);
        let mut radius = self.design.base_radius() / 8.0;
        let mut halvings = 0;
        while halvings < HALVINGS && !candidates.is_empty() {
            let signs = self.ring(radius, &candidates);
            let left = self.windows(&signs);
            if left.is_empty() {
                bad = Some(radius);
            } else {
                (good, candidates) = (radius, left);
            }
            radius = match bad {
                None => 2.0 * radius,
                Some(bad) => 0.5 * (good + bad),
            };
            halvings += usize::from(bad.is_some());
        }
        (good > 0.0).then_some(good)
    }

    /// Returns the home orientation in whose window the rim is stiffest with the design's own bars.
    fn home(&mut self, radius: f64, candidates: &[usize]) -> Option<usize> {
        let signs = self.ring(radius, candidates);
        let homes = self.homes(&signs);
        if homes.len() < 2 {
            return homes.first().copied();
        }
        let orientations = self.windows(&signs);
        let count = self.lay_ring(radius, &orientations);
        self.stiffest_first(homes, count, &orientations).first().copied()
    }
}
