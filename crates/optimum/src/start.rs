//! Home orientations from which a design is polished: those in which it comes nearest to keeping every requirement.

use kinefront_model::evaluation::PoseScalar;
use kinefront_model::mechanism::Design;
use kinefront_model::spatial::Rotation;

use super::place::Density;
use super::polished::Polished;
use super::prepared::Prepared;
use super::problem::LocalProblem;
use super::requirement::{NOWHERE, Requirement};
use super::survey::Fields;

/// Orientations that are examined.
const ORIENTATIONS: usize = 144;

/// Home orientations from which a design is polished if none is given.
const HOMES: usize = 3;

impl LocalProblem {
    /// Returns the best design near one: from a home orientation \[rad\], or from those in which it comes nearest to keeping the
    /// requirements; `None` if there is none that keeps them.
    pub fn best(&self, design: &Design, home: Option<f64>) -> Option<Polished> {
        let homes = match home {
            Some(home) => vec![home],
            None => self.homes(design),
        };
        let found = homes.into_iter().filter_map(|home| self.polish(design, home));
        let key = |found: &Polished| (!found.is_optimal(), self.minimised(&found.unknowns));
        found.reduce(|best, next| if key(&next) < key(&best) { next } else { best })
    }

    /// Returns home orientations \[rad\] in which a design comes nearest to keeping the requirements, the best first.
    pub fn homes(&self, design: &Design) -> Vec<f64> {
        if !self.has_free_home() {
            return vec![self.question().workspace.home_phi_deg.unwrap_or(0.0).to_radians()];
        }
        let Some(prepared) = self.prepare(&self.unknowns(design, 0.0)) else {
            return Vec::new();
        };
        let worst = self.worst_of_orientations(&prepared);
        let step = std::f64::consts::TAU / ORIENTATIONS as f64;
        let reach = (0.5 * self.question().workspace.rotation_range_deg.to_radians() / step).round() as usize;
        let of_window = |home: usize| {
            let window =
                (0..=2 * reach).map(|k| worst[(home + ORIENTATIONS + k - reach.min(ORIENTATIONS)) % ORIENTATIONS]);
            window.fold(f64::INFINITY, f64::min)
        };
        let windows: Vec<f64> = (0..ORIENTATIONS).map(of_window).collect();
        let is_peak = |home: &usize| {
            let (before, after) = ((home + ORIENTATIONS - 1) % ORIENTATIONS, (home + 1) % ORIENTATIONS);
            windows[*home] >= windows[before] && windows[*home] > windows[after] && windows[*home] > NOWHERE
        };
        let mut peaks: Vec<usize> = (0..ORIENTATIONS).filter(is_peak).collect();
        peaks.sort_by(|a, b| windows[*b].total_cmp(&windows[*a]).then(a.cmp(b)));
        peaks.truncate(HOMES);
        peaks.into_iter().map(|home| home as f64 * step).collect()
    }

    /// Returns the least value of any requirement over the region in each orientation.
    fn worst_of_orientations(&self, prepared: &Prepared) -> Vec<f64> {
        let angle = |k: usize| std::f64::consts::TAU * k as f64 / ORIENTATIONS as f64;
        let arms = (0..ORIENTATIONS).map(|k| prepared.evaluator().arms(&Rotation::new(angle(k))));
        let fields = Fields::new(self.spots(Density::Coarse), prepared, arms);
        let of_scalars = |requirement: &&Requirement| matches!(requirement, Requirement::Scalar(_));
        let of_pose = |index: usize| {
            let value = |scalar: PoseScalar| fields.scalar(scalar, index);
            let reach = self.reach(prepared, value(PoseScalar::Reach));
            let scalars = self.requirements().iter().filter(of_scalars);
            let values = scalars.map(|requirement| self.of_scalars(prepared, *requirement, value));
            values.fold(reach, |least, value| {
                least.min(if value.is_nan() { NOWHERE } else { value })
            })
        };
        let of_orientation = |k: usize| {
            let poses = k * fields.count()..(k + 1) * fields.count();
            poses.map(of_pose).fold(f64::INFINITY, f64::min).max(NOWHERE)
        };
        (0..ORIENTATIONS).map(of_orientation).collect()
    }
}
