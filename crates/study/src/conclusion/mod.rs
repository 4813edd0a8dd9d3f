//! The end of a run: the designs that are reported are selected, verified on the fine grid, and proved.
//!
//! A search leaves many more designs than a person looks at. Those that together cover the front best are selected first, and only they
//! are verified. One that does not hold, or that another one dominates then, is replaced by its neighbours. Gaps that are left are
//! filled with designs that are optimised for them. Proofs come last, because they take longest, and only of the designs that would be reported.

use std::sync::{Arc, mpsc};
use std::time::Instant;

use rayon::prelude::*;

mod families;
mod first_designs;
mod gaps;
mod proofs;

use gaps::Sought;
use proofs::Held;

use super::prove::proved_front;
use super::search::StudySearch;
use super::{
    ConclusionPart, DesignProblem, EndReason, Event, FrontMember, FrontProofs, RunControl, RunSummary, RunTimes,
    TableRow,
};
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
    search: StudySearch,
    outcome: EndReason,
    control: &RunControl,
    send: &mut dyn FnMut(Event),
) -> Option<RunSummary> {
    let nothing = Reported {
        times: search.times,
        ..Reported::default()
    };
    if outcome == EndReason::Interrupted {
        return Some(summary(search, outcome, nothing));
    }
    match Settling::new(&search, control, send).run() {
        Some(reported) => Some(summary(search, outcome, reported)),
        None if control.is_interrupted() => Some(summary(search, EndReason::Interrupted, nothing)),
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
    times: RunTimes,
}

fn summary(search: StudySearch, outcome: EndReason, reported: Reported) -> RunSummary {
    RunSummary {
        outcome,
        threads: search.threads(),
        history: search.found.history,
        dropped: reported.dropped,
        verified_hypervolume: reported.hypervolume,
        verified: reported.verified,
        front: reported.front,
        proofs: reported.proofs,
        times: reported.times,
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
    send: &'a mut dyn FnMut(Event),
    times: RunTimes,
    /// The front of the search; with one objective, the best design and its runners-up. Designs beside the front come after these.
    candidates: Vec<Arc<TableRow>>,
    /// The objectives of the front of the search, scaled.
    points: Vec<Vec<f64>>,
    is_tried: Vec<bool>,
    /// The designs that hold on the fine grid.
    held: Vec<Held>,
    /// Next id of a design that is not one of the search.
    next_id: usize,
    tried: usize,
    planned: usize,
    /// Number of designs that were looked for beside those of the search, and not found or not kept.
    in_vain: usize,
    sought: Sought,
}

impl<'a> Settling<'a> {
    fn new(search: &'a StudySearch, control: &'a RunControl, send: &'a mut dyn FnMut(Event)) -> Self {
        let candidates = search.found.candidates();
        let objectives: Vec<Objectives> = candidates.iter().map(|entry| entry.row.objectives).collect();
        Self {
            search,
            control,
            send,
            times: search.times,
            is_tried: vec![false; candidates.len()],
            points: scaled(&objectives),
            candidates,
            held: Vec::new(),
            next_id: search.found.evaluated,
            tried: 0,
            planned: 0,
            in_vain: 0,
            sought: Sought::default(),
        }
    }

    /// Settles which designs are reported; `None` if the run was abandoned.
    fn run(mut self) -> Option<Reported> {
        if self.has_one_objective() {
            self.settle_best()?;
            self.settle_promising()?;
        } else {
            let objectives: Vec<Objectives> = self.candidates.iter().map(|entry| entry.row.objectives).collect();
            let chosen = subset(&objectives, &self.search.found.reference, self.most());
            let wanted = chosen.len();
            self.settle(&chosen)?;
            for round in 0..ROUNDS {
                let replacements = self.replacements(wanted, round);
                if replacements.is_empty() {
                    break;
                }
                self.settle(&replacements)?;
            }
            self.follow_first_designs()?;
            self.fill_gaps()?;
        }
        self.prove_reported()?;
        Some(self.reported())
    }

    fn has_one_objective(&self) -> bool {
        self.search.study().objectives.len() == 1
    }

    /// Number of designs that are reported at most.
    fn most(&self) -> usize {
        self.search.study().optimizer.front_designs
    }

    /// Verifies the best designs that were not tried, one after the other, until one holds and those that are left promise hardly more. Once
    /// one holds, only a few more are tried: on the fine grid, all become worse alike.
    fn settle_best(&mut self) -> Option<()> {
        /// Relative gain for which no other design is tried.
        const HARDLY: f64 = 1e-5;
        const MORE: usize = 3;
        let mut since_held = 0;
        for place in 0..self.points.len() {
            if self.is_tried[place] {
                continue;
            }
            let value = self.candidates[place].row.objectives[0];
            let enough = value + HARDLY * value.abs();
            let mut held = self.held.iter().filter_map(Held::reported).peekable();
            if held.peek().is_some() {
                since_held += 1;
            }
            if since_held > MORE || held.any(|member| member.objectives()[0] <= enough) {
                break;
            }
            self.settle(&[place])?;
        }
        Some(())
    }

    /// Verifies some candidates; `None` if the run was abandoned.
    fn settle(&mut self, places: &[usize]) -> Option<()> {
        let problem = &self.search.problem;
        let design = |&place: &usize| (place, self.candidates[place].row.design);
        let designs: Vec<(usize, Design)> = places.iter().map(design).collect();
        let verify = |design: &Design| Some(problem.verify_improved(design));
        self.verify(&designs, verify, Keep::All)?;
        places.iter().for_each(|&place| self.is_tried[place] = true);
        Some(())
    }

    /// Obtains an evaluation on the fine grid for each of some tasks, if there is one, and keeps those that hold; `None` if the run was
    /// abandoned. Each task has the place of the candidate with which it begins.
    fn verify<T: Sync>(
        &mut self,
        tasks: &[(usize, T)],
        verify: impl Fn(&T) -> Option<Evaluation> + Sync,
        keep: Keep,
    ) -> Option<()> {
        if tasks.is_empty() {
            return Some(());
        }
        let verifying = Instant::now();
        self.planned += tasks.len();
        let (before, total) = (self.tried, self.planned);
        let tell = |done| {
            (self.send)(Event::Concluding {
                part: ConclusionPart::Verification,
                done: before + done,
                total,
            });
        };
        let evaluations = each(self.search, self.control, tasks, |(_, task)| verify(task), tell)?;
        self.tried += tasks.len();
        for ((place, _), evaluation) in tasks.iter().zip(evaluations) {
            let member = evaluation.filter(Evaluation::is_feasible);
            let member = member.map(|evaluation| self.member(*place, evaluation));
            match member.filter(|member| !self.repeats(member)) {
                Some(member) => self.held.push(Held::new(*place, member, keep)),
                None if keep == Keep::Proved => self.in_vain += 1,
                None => {}
            }
        }
        self.times.verification_s += verifying.elapsed().as_secs_f64();
        Some(())
    }

    /// Returns whether a design has the same objectives as one that holds, up to what no table shows: neighbours that are improved can end
    /// at the same optimum.
    fn repeats(&self, member: &FrontMember) -> bool {
        let objectives = member.objectives();
        let is_same = |other: &FrontMember| {
            let others = other.objectives();
            let mut pairs = objectives.iter().zip(others.iter());
            pairs.all(|(a, b)| (a - b).abs() <= SAME * a.abs().max(b.abs()))
        };
        self.held.iter().filter_map(Held::reported).any(is_same)
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
            generation: entry.row.generation as usize,
            reference_radius: entry.row.workspace_radius(),
            ..FrontMember::of(id, evaluation)
        }
    }

    /// The designs that hold and that no other one of them dominates, as places in `held`.
    fn standing(&self) -> Archive {
        let mut archive = Archive::default();
        for (index, held) in self.held.iter().enumerate() {
            if let Some(member) = held.reported() {
                archive.insert(index, &[], &DesignProblem::outcome(&member.evaluation));
            }
        }
        archive
    }

    /// Returns the candidates that take the place of those that fell: of each the nearest that was not tried, as many as designs are
    /// missing, and one more in every round, because neighbours may fall together.
    fn replacements(&self, wanted: usize, round: usize) -> Vec<usize> {
        let (standing, points) = (self.standing(), &self.points);
        let missing = match wanted.saturating_sub(standing.len()) {
            0 => return Vec::new(),
            missing => missing + round,
        };
        let mut stands = vec![false; self.candidates.len()];
        for member in standing.iter() {
            stands[self.held[member.id].place] = true;
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
    fn reported(self) -> Reported {
        let (reference, most) = (self.search.found.reference, self.most());
        let standing = self.standing();
        let (verified, whole) = (
            standing.len(),
            hypervolume(standing.iter().map(|member| member.objectives), reference),
        );
        let proved = self.held.into_iter().filter_map(Held::into_proved).collect();
        let (front, proofs) = proved_front(proved, self.next_id, reference, most);
        Reported {
            verified,
            dropped: self.tried - self.in_vain - verified,
            hypervolume: whole,
            front,
            proofs: self.search.study().workspace.certify.then_some(proofs),
            times: self.times,
        }
    }
}

/// Does some tasks on the threads of the search, and tells how many are done after each, beginning with 0; returns the results in the order
/// of the tasks, or `None` if the run was abandoned.
fn each<T: Sync, R: Send>(
    search: &StudySearch,
    control: &RunControl,
    tasks: &[T],
    work: impl Fn(&T) -> R + Sync,
    mut tell: impl FnMut(usize),
) -> Option<Vec<R>> {
    let goes_on = || !control.is_abandoned();
    let mut results: Vec<Option<R>> = tasks.iter().map(|_| None).collect();
    tell(0);
    search.pool.in_place_scope(|scope| {
        let (sender, received) = mpsc::channel();
        // A task takes up to seconds, so that each is given to a thread by itself.
        let tasks = tasks.par_iter().enumerate().with_max_len(1);
        scope.spawn(|_| {
            tasks.for_each_with(sender, |sender, (place, task)| {
                if goes_on() {
                    // The receiver lives until all senders are gone.
                    let _ = sender.send((place, work(task)));
                }
            });
        });
        for (done, (place, result)) in received.into_iter().enumerate() {
            results[place] = Some(result);
            tell(done + 1);
        }
    });
    results.into_iter().collect::<Option<_>>().filter(|_| goes_on())
}
