//! Gaps of the front that is reported: designs between two neighbours, and at the ends.

use kinefront_model::evaluation::{Evaluation, Quantity};
use kinefront_optimize::{Archive, Objectives, added_share, gaps, halfway};

use super::{Keep, Settling};
use crate::DesignProblem;
use crate::local::Aim;

/// Largest number of gaps that are filled before they are looked for again.
const AT_ONCE: usize = 16;

/// Number of evaluations of the search for which one design is looked for, so that a short search has a short end.
const EVALUATIONS: usize = 3;

/// Designs that are looked for at least, if the evaluations allow it, though fewer are reported: the gap next to an end of the front is
/// found only after the end itself.
const FEWEST: usize = 16;

/// Number of designs that are looked for in gaps for one beyond the boundary of a family.
const OF_GAPS: usize = 4;

/// Gaps are left if as many of them as designs are reported would add less than this share to what the front covers.
const WORTH: f64 = 0.02;

/// The same for designs that were found for a gap or an end: they are kept only if they add more.
const KEPT: f64 = 0.005;

/// Distance of the reference point from the worst values of a front, as a share of its extent.
const BEYOND: f64 = 0.1;

/// Share of its radius that the best design in an objective keeps as it is improved. A region without a size has no design.
const RADIUS: f64 = 0.5;

/// The designs that were looked for in gaps and at ends so far.
#[derive(Default)]
pub(super) struct Sought {
    /// The pairs of neighbours between which a design was looked for, once for each time.
    between: Vec<[usize; 2]>,
    /// The pairs of a design of which one was started from across a boundary, and of one whose values were aimed at.
    across: Vec<[usize; 2]>,
    /// For each objective, the design from which its end was improved.
    at_ends: Vec<Option<usize>>,
    /// Number of designs that were looked for in gaps and at ends.
    count: usize,
    /// Number of designs that were looked for across boundaries.
    count_across: usize,
}

impl Settling<'_> {
    /// Fills the gaps of a front of two or three objectives, and improves its ends; `None` if the run was abandoned.
    ///
    /// The search leaves gaps where the designs that it found end at the same optimum, and its ends are seldom the best designs. Beside a
    /// gap there is an optimum, from which another one with a value in the gap is a short way. Where no gap is left, families of designs are
    /// followed across the boundaries between them, which may leave further gaps. No more designs are looked for than are
    /// reported, and no more than a third of the evaluations, even if gaps are filled several times.
    pub(super) fn fill_gaps(&mut self) -> Option<()> {
        let most = self.most_wanted();
        let mut sought = std::mem::take(&mut self.sought);
        sought.at_ends.resize(self.search.found.reference.len(), None);
        loop {
            let standing = self.standing();
            let mut wanted = self.wanted_at_ends(&standing, &mut sought.at_ends);
            wanted.extend(self.wanted_between(&standing, &mut sought.between));
            wanted.truncate(most - sought.count);
            sought.count += wanted.len();
            if wanted.is_empty() {
                wanted = self.wanted_across(&standing, &mut sought.across);
                wanted.truncate(most / OF_GAPS - sought.count_across);
                sought.count_across += wanted.len();
            }
            if wanted.is_empty() {
                break;
            }
            self.verify_wanted(&standing, wanted)?;
        }
        self.sought = sought;
        Some(())
    }

    /// Number of designs that are looked for at most: as many as are reported, and no more than a third of the evaluations.
    pub(super) fn most_wanted(&self) -> usize {
        let most = self.most();
        most.max(FEWEST).min(self.search.found.evaluated / EVALUATIONS)
    }

    /// Verifies the optima for some aims, each with the design to start from as a place in `held`, and keeps those that add something to the
    /// front; `None` if the run was abandoned.
    pub(super) fn verify_wanted(&mut self, standing: &Archive, wanted: Vec<(usize, Aim)>) -> Option<()> {
        let start = |(near, aim): (usize, Aim)| {
            let held = &self.held[near];
            Some((held.place, (held.reported()?.evaluation.clone(), aim)))
        };
        let starts: Vec<(usize, (Evaluation, Aim))> = wanted.into_iter().filter_map(start).collect();
        let adds = self.adds_to(standing, KEPT);
        let problem = &self.search.problem;
        let verify = |(near, aim): &(Evaluation, Aim)| problem.verify_toward(near, aim).filter(&adds);
        self.verify(&starts, verify, Keep::Proved)
    }

    /// Returns whether a design adds more to the front that stands than `least` designs of a mean share, as a function of its evaluation.
    pub(super) fn adds_to(&self, standing: &Archive, least: f64) -> impl Fn(&Evaluation) -> bool + Sync + use<> {
        let points = objectives(standing);
        // Beyond the ends, a design adds something only as the study's own reference point shows it.
        let references = [self.reference_near(&points), self.search.found.reference];
        let most = self.most();
        move |found| {
            let found = DesignProblem::outcome(found).objectives;
            let mut shares = references
                .iter()
                .map(|reference| added_share(&points, reference, &found));
            shares.any(|share| share * most as f64 > least)
        }
    }

    /// Returns the designs that are wanted in the largest gaps: each the design to start from, as a place in `held`, and the aim. `tried` are
    /// the pairs of neighbours between which a design was looked for already, once for each time.
    fn wanted_between(&self, standing: &Archive, tried: &mut Vec<[usize; 2]>) -> Vec<(usize, Aim)> {
        let (points, most) = (objectives(standing), self.most());
        let mut found = gaps(&points, &self.reference_near(&points));
        found.retain(|gap| gap.share * most as f64 > WORTH);
        found.sort_by(|a, b| b.share.total_cmp(&a.share));
        let mut wanted = Vec::new();
        for gap in found {
            let [first, second] = gap.between.map(|place| standing[place].id);
            let [near_first, near_second] = gap.between.map(|place| halfway(&gap.middle, &points[place]));
            // The second one keeps more of what is asked of the other objectives. A shorter way may lead where the middle is out of reach.
            let ways = [
                (second, gap.middle),
                (first, gap.middle),
                (second, near_second),
                (first, near_first),
            ];
            let times = tried.iter().filter(|pair| **pair == [first, second]).count();
            if let Some((near, target)) = ways.get(times).filter(|_| wanted.len() < AT_ONCE) {
                tried.push([first, second]);
                wanted.push((*near, self.aim(0, target)));
            }
        }
        wanted
    }

    /// The same for the designs that are best in one objective, where the others are no worse than the reference point; none where the end
    /// was tried before.
    fn wanted_at_ends(&self, standing: &Archive, ends: &mut [Option<usize>]) -> Vec<(usize, Aim)> {
        let (points, reference) = (objectives(standing), &self.search.found.reference);
        let counts = |point: &Objectives| point.iter().zip(reference.iter()).all(|(value, worst)| value < worst);
        let mut wanted = Vec::new();
        for (improved, tried) in ends.iter_mut().enumerate() {
            let places = (0..points.len()).filter(|&place| counts(&points[place]));
            let end = places.min_by(|&a, &b| points[a][improved].total_cmp(&points[b][improved]));
            let Some(near) = end.map(|end| standing[end].id).filter(|near| *tried != Some(*near)) else {
                continue;
            };
            *tried = Some(near);
            let mut aim = self.aim(improved, reference);
            let radius = self.held[near]
                .reported()
                .map(|member| member.evaluation.workspace_radius());
            for (quantity, value) in &mut aim.held {
                if let (Quantity::WorkspaceRadius, Some(radius)) = (*quantity, radius) {
                    *value = RADIUS * radius;
                }
            }
            wanted.push((near, aim));
        }
        wanted
    }

    /// Returns the reference point, no farther from a front than a tenth of its extent: where it is far away, no gap would matter.
    pub(super) fn reference_near(&self, points: &[Objectives]) -> Objectives {
        let stated = self.search.found.reference.iter().enumerate();
        Objectives::new(stated.map(|(place, stated)| {
            let values = || points.iter().map(|point| point[place]);
            let (best, worst) = (
                values().fold(f64::INFINITY, f64::min),
                values().fold(f64::NEG_INFINITY, f64::max),
            );
            stated.min(worst + BEYOND * (worst - best))
        }))
    }

    /// Returns the aim to improve an objective while the others are no worse than some minimised values.
    pub(super) fn aim(&self, improved: usize, minimised: &Objectives) -> Aim {
        let objectives = &self.search.problem.model().settings().objectives;
        let held = objectives.iter().zip(minimised.iter()).enumerate();
        let held = held.filter(|(place, _)| *place != improved);
        Aim {
            improved,
            held: held
                .map(|(_, (objective, minimised))| (objective.quantity, objective.value(*minimised)))
                .collect(),
            keeps_entries: false,
        }
    }
}

pub(super) fn objectives(standing: &Archive) -> Vec<Objectives> {
    standing.iter().map(|member| member.objectives).collect()
}
