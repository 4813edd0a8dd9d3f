//! The end of a run: the designs that are reported are selected, verified on the fine grid, and proved.
//!
//! A search leaves many more designs than a person looks at. Those that together cover the front best are selected first, and only they
//! are verified and proved. One that does not hold, or that another one dominates then, is replaced by its neighbours. Gaps that are left are
//! filled with designs that are optimised for them.

use std::sync::Arc;
use std::time::Instant;

use rayon::prelude::*;

mod families;
mod first_designs;
mod gaps;

use super::prove::{FrontProver, ProvedMember, proved_front};
use super::search::{Found, StudySearch};
use super::{DesignProblem, EndReason, Event, FrontMember, FrontProofs, RunControl, RunSummary, RunTimes, TableRow};
use kinefront_model::evaluation::Evaluation;
use kinefront_model::mechanism::Design;
use kinefront_optimize::{Archive, Objectives, hypervolume, scaled, subset};

/// Number of times that designs which fell are replaced by their neighbours.
const ROUNDS: usize = 8;

/// Relative difference of objectives up to which two designs are the same to a reader.
const SAME: f64 = 1e-5;

/// Verifies the front of a search that was resumed, as at the end of its run; returns the summary of a run that ended for
/// the reason `outcome`.
pub(super) fn verify_replayed(mut search: StudySearch, outcome: EndReason) -> Option<RunSummary> {
    let control = RunControl::default();
    search.send_replayed(&control, |_| {});
    conclude(search, outcome, &control, &mut |_| {})
}

/// Selects, verifies and proves the designs to be reported of a search that has ended, and sums it up; `None` if the run was
/// abandoned.
pub(super) fn conclude(
    mut search: StudySearch,
    outcome: EndReason,
    control: &RunControl,
    send: &mut dyn FnMut(Event),
) -> Option<RunSummary> {
    let interrupted = |search| Some(summary(search, EndReason::Interrupted, Reported::default()));
    if outcome == EndReason::Interrupted {
        return interrupted(search);
    }
    let mut times = search.times;
    match Settling::new(&search, control).run(&mut times, send) {
        Some(reported) => {
            search.times = times;
            Some(summary(search, outcome, reported))
        }
        None if control.is_interrupted() => interrupted(search),
        None => None,
    }
}

/// What a run reports.
#[derive(Default)]
struct Reported {
    /// Number of designs that hold on the fine grid and are non-dominated there.
    verified: usize,
    /// Number of designs that were verified and do not hold, or are dominated.
    dropped: usize,
    /// Hypervolume of those that hold.
    hypervolume: f64,
    /// The designs that are reported.
    front: Vec<FrontMember>,
    proofs: Option<FrontProofs>,
}

fn summary(search: StudySearch, outcome: EndReason, reported: Reported) -> RunSummary {
    let threads = search.threads();
    let StudySearch {
        found: Found { history, .. },
        times,
        ..
    } = search;
    RunSummary {
        outcome,
        threads,
        history,
        dropped: reported.dropped,
        verified_hypervolume: reported.hypervolume,
        verified: reported.verified,
        front: reported.front,
        proofs: reported.proofs,
        times,
    }
}

/// Which designs are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Keep {
    /// Those that hold on the fine grid.
    All,
    /// Those of them whose proof is not left open, if they are proved at all: the search has found other designs.
    Proved,
}

/// The designs of a search that are being verified and proved.
struct Settling<'a> {
    search: &'a StudySearch,
    control: &'a RunControl,
    /// The front of the search; with one objective, the best design and its runners-up.
    candidates: Vec<Arc<TableRow>>,
    is_tried: Vec<bool>,
    /// The designs that hold on the fine grid, each with the place of its candidate.
    held: Vec<(usize, ProvedMember)>,
    /// Next id of a design that is not one of the search.
    next_id: usize,
    tried: usize,
    planned: usize,
    /// Number of designs that were looked for beside those of the search, and not found or not kept.
    in_vain: usize,
}

impl<'a> Settling<'a> {
    fn new(search: &'a StudySearch, control: &'a RunControl) -> Self {
        let candidates = search.found.candidates();
        Self {
            search,
            control,
            is_tried: vec![false; candidates.len()],
            candidates,
            held: Vec::new(),
            next_id: search.found.evaluated,
            tried: 0,
            planned: 0,
            in_vain: 0,
        }
    }

    /// Settles which designs are reported; `None` if the run was abandoned.
    fn run(mut self, times: &mut RunTimes, send: &mut dyn FnMut(Event)) -> Option<Reported> {
        let study = self.search.study();
        let most = study.optimizer.front_designs;
        if study.objectives.len() == 1 {
            self.settle_best(times, send)?;
            self.settle_promising(times, send)?;
        } else {
            let objectives: Vec<Objectives> = self.candidates.iter().map(|entry| entry.row.objectives).collect();
            let points = scaled(&objectives);
            let chosen = subset(&objectives, &self.search.found.reference, most);
            let wanted = chosen.len();
            self.settle(&chosen, times, send)?;
            for round in 0..ROUNDS {
                let replacements = self.replacements(&points, wanted, round);
                if replacements.is_empty() {
                    break;
                }
                self.settle(&replacements, times, send)?;
            }
            self.follow_first_designs(times, send)?;
            self.fill_gaps(times, send)?;
        }
        Some(self.reported(most))
    }

    /// Verifies and proves the best designs, one after the other, until one holds and those that are left promise hardly more. Once one
    /// holds, only a few more are tried: on the fine grid, all become worse alike.
    fn settle_best(&mut self, times: &mut RunTimes, send: &mut dyn FnMut(Event)) -> Option<()> {
        /// Relative gain for which no other design is tried.
        const HARDLY: f64 = 1e-5;
        const MORE: usize = 3;
        let mut since_held = 0;
        for place in 0..self.candidates.len() {
            let value = self.candidates[place].row.objectives[0];
            let enough = value + HARDLY * value.abs();
            let mut held = self.held.iter().filter_map(|(_, proved)| proved.reported()).peekable();
            if held.peek().is_some() {
                since_held += 1;
            }
            if since_held > MORE || held.any(|member| member.objectives()[0] <= enough) {
                break;
            }
            self.settle(&[place], times, send)?;
        }
        Some(())
    }

    /// Verifies some candidates and proves those that hold; `None` if the run was abandoned.
    fn settle(&mut self, places: &[usize], times: &mut RunTimes, send: &mut dyn FnMut(Event)) -> Option<()> {
        let problem = &self.search.problem;
        let design = |&place: &usize| (place, self.candidates[place].row.design);
        let designs: Vec<(usize, Design)> = places.iter().map(design).collect();
        let verify = |design: &Design| Some(problem.verify_improved(design));
        self.verify_and_prove(&designs, verify, Keep::All, times, send)?;
        places.iter().for_each(|&place| self.is_tried[place] = true);
        Some(())
    }

    /// Obtains an evaluation on the fine grid for each of some tasks, if there is one, and proves those that hold; `None` if the run was
    /// abandoned. Each task has the place of the candidate with which it begins.
    fn verify_and_prove<T: Sync>(
        &mut self,
        tasks: &[(usize, T)],
        verify: impl Fn(&T) -> Option<Evaluation> + Sync,
        keep: Keep,
        times: &mut RunTimes,
        send: &mut dyn FnMut(Event),
    ) -> Option<()> {
        let (control, pool) = (self.control, &self.search.pool);
        let goes_on = || !control.is_abandoned();
        let prover = FrontProver::new(&self.search.problem, &goes_on);
        self.planned += tasks.len();
        for part in tasks.chunks(4 * self.search.threads()) {
            send(Event::Verifying {
                done: self.tried,
                total: self.planned,
            });
            let verifying = Instant::now();
            let verified = |(_, task): &(usize, T)| goes_on().then(|| verify(task));
            let evaluations: Option<Vec<_>> = pool.install(|| part.par_iter().map(verified).collect());
            let mut members = Vec::new();
            for ((place, _), evaluation) in part.iter().zip(evaluations?) {
                if let Some(evaluation) = evaluation.filter(Evaluation::is_feasible) {
                    members.push((*place, self.member(*place, evaluation)));
                }
            }
            times.verification_s += verifying.elapsed().as_secs_f64();
            let held = self.held.len();
            self.prove(members, &prover, keep, times);
            if keep == Keep::Proved {
                self.in_vain += part.len() - (self.held.len() - held);
            }
            if !goes_on() {
                return None;
            }
            self.tried += part.len();
        }
        Some(())
    }

    /// Proves designs, each with the place of its candidate, and keeps those that repeat no other one.
    fn prove(&mut self, members: Vec<(usize, FrontMember)>, prover: &FrontProver, keep: Keep, times: &mut RunTimes) {
        let proving = Instant::now();
        let (places, members): (Vec<usize>, Vec<FrontMember>) = members.into_iter().unzip();
        let proved = if self.search.study().workspace.certify {
            self.search.pool.install(|| prover.prove(&members))
        } else {
            members.into_iter().map(ProvedMember::unproved).collect()
        };
        for (place, proved) in places.into_iter().zip(proved) {
            let certified = proved.reported().and_then(|member| member.certified);
            let is_open = certified.is_some_and(|certified| !certified.is_proved);
            let is_left_out = is_open && keep == Keep::Proved;
            if !is_left_out && !self.repeats(&proved) {
                self.held.push((place, proved));
            }
        }
        times.certification_s += proving.elapsed().as_secs_f64();
    }

    /// Returns whether a design has the same objectives as one that holds, up to what no table shows: neighbours that are improved can end
    /// at the same optimum.
    fn repeats(&self, proved: &ProvedMember) -> bool {
        let Some(member) = proved.reported() else {
            return false;
        };
        let objectives = member.objectives();
        let is_same = |other: &FrontMember| {
            let others = other.objectives();
            let mut pairs = objectives.iter().zip(others.iter());
            pairs.all(|(a, b)| (a - b).abs() <= SAME * a.abs().max(b.abs()))
        };
        self.held.iter().filter_map(|(_, held)| held.reported()).any(is_same)
    }

    /// The member of the front that a candidate becomes.
    fn member(&mut self, place: usize, evaluation: Evaluation) -> FrontMember {
        let entry = &self.candidates[place];
        let mut id = entry.id;
        if evaluation.design != entry.row.design {
            // A design whose bars were sized again is not one of the search.
            id = self.next_id;
            self.next_id += 1;
        }
        FrontMember {
            id,
            generation: entry.row.generation as usize,
            evaluation,
            reference_radius: entry.row.workspace_radius(),
            certified: None,
        }
    }

    /// The designs that hold and that no other one of them dominates, as places in `held`.
    fn standing(&self) -> Archive {
        let mut archive = Archive::default();
        for (index, (_, proved)) in self.held.iter().enumerate() {
            if let Some(member) = proved.reported() {
                archive.insert(index, &[], &DesignProblem::outcome(&member.evaluation));
            }
        }
        archive
    }

    /// Returns the candidates that take the place of those that fell: of each the nearest that was not tried, as many as designs are
    /// missing, and one more in every round, because neighbours may fall together. `points` are the scaled objectives of the candidates.
    fn replacements(&self, points: &[Vec<f64>], wanted: usize, round: usize) -> Vec<usize> {
        let standing = self.standing();
        let missing = match wanted.saturating_sub(standing.len()) {
            0 => return Vec::new(),
            missing => missing + round,
        };
        let mut stands = vec![false; points.len()];
        for member in standing.iter() {
            stands[self.held[member.id].0] = true;
        }
        let mut taken = self.is_tried.clone();
        let mut found = Vec::new();
        let all_fallen: Vec<usize> = (0..points.len())
            .filter(|&place| self.is_tried[place] && !stands[place])
            .collect();
        for &fallen in all_fallen.iter().cycle().take(missing) {
            let distance = |place: usize| -> f64 {
                let parts = points[place].iter().zip(&points[fallen]);
                parts.map(|(a, b)| (a - b) * (a - b)).sum()
            };
            let nearest = (0..points.len())
                .filter(|&place| !taken[place])
                .min_by(|&a, &b| distance(a).total_cmp(&distance(b)));
            if let Some(place) = nearest {
                taken[place] = true;
                found.push(place);
            }
        }
        found
    }

    /// Returns what is reported of the designs that were settled.
    fn reported(self, most: usize) -> Reported {
        let reference = self.search.found.reference;
        let standing = self.standing();
        let (verified, whole) = (
            standing.len(),
            hypervolume(standing.iter().map(|member| member.objectives), reference),
        );
        let proved = self.held.into_iter().map(|(_, proved)| proved).collect();
        let (front, proofs) = proved_front(proved, self.next_id, reference, most);
        Reported {
            verified,
            dropped: self.tried - self.in_vain - verified,
            hypervolume: whole,
            front,
            proofs: self.search.study().workspace.certify.then_some(proofs),
        }
    }
}
