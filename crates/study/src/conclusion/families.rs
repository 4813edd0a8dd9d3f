//! Families of designs along a front: where one takes over from another.
//!
//! A family that a search found late, or that only its end led to, reaches as far along the front as it was searched, and not as far as it is
//! the better one. From the last design of a family, optima are followed across its boundary as long as they are better than what stands.

use kinefront_optimize::{Archive, gaps};

use super::Settling;
use super::gaps::objectives;
use crate::local::Aim;

/// Share of its range by which a variable of two neighbours differs where they are of different families.
const APART: f64 = 0.1;

/// Share of the first objective by which neighbours at a jump differ: more than neighbours on a front that is covered.
const JUMP: f64 = 0.2;

/// Numbers of members beyond a boundary at whose values is aimed from the last design of a family: several at once, because a better family
/// is often better by far.
const STEPS: [usize; 3] = [1, 3, 8];

impl Settling<'_> {
    /// Returns the designs that are wanted beyond the boundaries of families where the first objective becomes worse at once: each the design
    /// to start from, as a place in `held`, and the aim. `tried` are the pairs of designs of which one was started from and the values of
    /// the other aimed at.
    pub(super) fn wanted_across(&self, standing: &Archive, tried: &mut Vec<[usize; 2]>) -> Vec<(usize, Aim)> {
        let points = objectives(standing);
        let steps = if points.first().is_some_and(|point| point.len() == 2) {
            &STEPS[..]
        } else {
            &STEPS[..1]
        };
        let mut wanted = Vec::new();
        for gap in gaps(&points, &self.reference_near(&points)) {
            let [first, second] = gap.between;
            let [better, worse] = [first, second].map(|place| points[place][0]);
            let is_jump = worse - better > JUMP * worse.abs();
            if !is_jump || !self.are_apart(standing[first].id, standing[second].id) {
                continue;
            }
            // The members of a front of two objectives are in its order.
            for target in steps
                .iter()
                .map(|step| second + step - 1)
                .filter(|target| *target < points.len())
            {
                let pair = [first, target].map(|place| standing[place].id);
                if !tried.contains(&pair) {
                    tried.push(pair);
                    wanted.push((pair[0], self.aim(0, &points[target])));
                }
            }
        }
        wanted
    }

    /// Returns whether two designs that hold, as places in `held`, are of different families.
    fn are_apart(&self, a: usize, b: usize) -> bool {
        let design = |place: usize| self.held[place].reported().map(|member| member.evaluation.design);
        let (Some(a), Some(b)) = (design(a), design(b)) else {
            return false;
        };
        a.architecture() != b.architecture() || self.search.problem.largest_difference(&a, &b) > APART
    }
}
