//! Pareto fronts of a report, of each architecture and of all architectures together, verified on the fine grid.

use rayon::prelude::*;

use super::Source;
use kinefront_model::evaluation::{Evaluation, Objective};
use kinefront_model::mechanism::{Architecture, Design};
use kinefront_optimize::{Archive, Objectives, Outcome, knee, spread};
use kinefront_study::{DesignProblem, FrontMember, FrontProofs, FrontProver, Study, keep_runners_up, proved_front};

/// A front: non-dominated evaluations on the fine grid, the best in the first objective first.
#[derive(Debug, Clone, Default)]
pub struct Front {
    /// All designs of the front.
    pub members: Vec<Evaluation>,
    /// The designs that are drawn and tabulated: evenly spread, with both ends and the knee; once they are certified, with
    /// the proved radii.
    pub shown: Vec<Evaluation>,
    /// What the proofs of the workspaces of the designs shown found.
    pub proofs: Option<FrontProofs>,
}

impl Front {
    /// Collects the non-dominated feasible designs among `evaluations`; at most `most` of them are shown.
    pub fn new(evaluations: Vec<Evaluation>, most: usize) -> Self {
        let mut archive = Archive::default();
        for (id, evaluation) in evaluations.iter().enumerate().filter(|(_, found)| found.is_feasible()) {
            archive.insert(id, &[], &DesignProblem::outcome(evaluation));
        }
        let members: Vec<Evaluation> = archive.iter().map(|member| evaluations[member.id].clone()).collect();
        let objectives: Vec<Objectives> = archive.iter().map(|member| member.objectives).collect();
        let shown = spread(&objectives, most);
        Self {
            shown: shown.into_iter().map(|place| members[place].clone()).collect(),
            members,
            proofs: None,
        }
    }

    /// Proves the workspaces of the designs that are shown, as a run does.
    fn certify(&mut self, study: &Study, problem: &DesignProblem) {
        let shown = self.shown.drain(..).enumerate();
        let shown: Vec<FrontMember> = shown.map(|(id, found)| FrontMember::of(id, found)).collect();
        let prover = FrontProver::new(problem, &|| true);
        let proved = shown.par_iter().map(|member| prover.prove(member)).collect();
        let (proved, proofs) = proved_front(proved, shown.len(), study.hypervolume_reference(), shown.len());
        self.shown = proved.into_iter().map(|member| member.evaluation).collect();
        self.proofs = Some(proofs);
    }

    /// Returns the designs that are shown.
    pub fn shown(&self) -> impl Iterator<Item = &Evaluation> {
        self.shown.iter()
    }

    /// Returns the objectives of the designs that are shown.
    fn objectives(&self) -> Vec<Objectives> {
        self.shown()
            .map(|member| DesignProblem::outcome(member).objectives)
            .collect()
    }

    /// Returns at most `most` of the designs that are shown, evenly spread, in their order.
    pub fn spread(&self, most: usize) -> Vec<Evaluation> {
        let mut places = spread(&self.objectives(), most);
        places.sort_unstable();
        places.into_iter().map(|place| self.shown[place].clone()).collect()
    }

    /// Returns the design that is best in the first objective of those whose other objectives, as they are minimised, are at most
    /// `others`.
    pub fn best_with(&self, others: &[f64]) -> Option<&Evaluation> {
        // The members are in the order of the first objective.
        let is_good = |member: &&Evaluation| {
            member.objectives[1..]
                .iter()
                .zip(others)
                .all(|(value, most)| value <= most)
        };
        self.members.iter().find(is_good)
    }

    /// Returns the design that is best in one objective.
    pub fn best(&self, objective: usize) -> Option<&Evaluation> {
        let value = |member: &Evaluation| member.objectives[objective];
        self.members.iter().min_by(|a, b| value(a).total_cmp(&value(b)))
    }

    /// Returns the designs to be pictured, each with its name: the best in each objective, and the knee.
    pub fn marked(&self, objectives: &[Objective]) -> Vec<(String, &Evaluation)> {
        let values = self.objectives();
        let best = |k: usize| (0..values.len()).min_by(|&a, &b| values[a][k].total_cmp(&values[b][k]));
        let named = objectives
            .iter()
            .enumerate()
            .map(|(k, objective)| (best(k), objective.best_name()));
        let mut named: Vec<(Option<usize>, String)> = named.collect();
        // The knee lies between the ends.
        named.insert(named.len().min(1), (knee(&values), "knee".to_owned()));
        let mut marked: Vec<(String, &Evaluation)> = Vec::new();
        for (place, name) in named {
            if let Some(member) = place.and_then(|place| self.shown.get(place))
                && !marked.iter().any(|(_, other)| std::ptr::eq(*other, member))
            {
                marked.push((name, member));
            }
        }
        marked
    }
}

/// Largest number of designs of a front of which prices are determined.
const PRICED: usize = 12;

/// Fronts of several searches, pooled.
#[derive(Debug, Clone)]
pub struct Fronts {
    /// Front of each architecture that has a feasible design, in the order of [`Architecture::ALL`], which is the
    /// paper's.
    pub alone: Vec<(Architecture, Front)>,
    /// Front of all architectures together.
    pub together: Front,
}

impl Fronts {
    /// Computes the fronts of all designs of the sources: the designs that are non-dominated on the reference grid are
    /// verified on the fine grid of `problem`. `None` if there is no feasible design.
    pub fn new(sources: &[Source], problem: &DesignProblem, most: usize) -> Option<Self> {
        let mut alone = Vec::new();
        for &architecture in Architecture::ALL {
            let candidates = candidates(sources, architecture);
            let evaluations: Vec<Evaluation> = match problem.model().settings().objectives[..] {
                [_] => first_that_holds(&candidates, problem).into_iter().collect(),
                _ => candidates.par_iter().map(|design| problem.verify(design)).collect(),
            };
            let front = Front::new(evaluations, most);
            if !front.members.is_empty() {
                alone.push((architecture, front));
            }
        }
        let all = alone.iter().flat_map(|(_, front)| front.members.iter().cloned());
        let together = Front::new(all.collect(), most);
        (!together.members.is_empty()).then_some(Self { alone, together })
    }

    /// Proves the workspaces of the designs that are shown of each front.
    pub fn certify(&mut self, study: &Study, problem: &DesignProblem) {
        let alone = self.alone.iter_mut().map(|(_, front)| front);
        for front in alone.chain([&mut self.together]) {
            front.certify(study, problem);
        }
    }

    /// Returns the designs of which prices are determined: some of those that are shown of each front, evenly spread.
    pub fn priced(&self) -> Vec<Evaluation> {
        self.alone.iter().flat_map(|(_, front)| front.spread(PRICED)).collect()
    }

    /// Returns the front of an architecture.
    pub fn of(&self, architecture: Architecture) -> Option<&Front> {
        front_of(&self.alone, architecture)
    }
}

/// Returns the front of an architecture among those of several.
pub(super) fn front_of(alone: &[(Architecture, Front)], architecture: Architecture) -> Option<&Front> {
    let found = alone.iter().find(|(other, _)| *other == architecture);
    found.map(|(_, front)| front)
}

/// Returns the first of the designs that is feasible on the fine grid.
fn first_that_holds(candidates: &[Design], problem: &DesignProblem) -> Option<Evaluation> {
    let mut verified = candidates.iter().map(|design| problem.verify(design));
    verified.find(Evaluation::is_feasible)
}

/// Returns the designs of an architecture that are non-dominated on the reference grid; with one objective, the best one and
/// runners-up.
fn candidates(sources: &[Source], architecture: Architecture) -> Vec<Design> {
    let mut archive = Archive::default();
    let rows: Vec<_> = sources
        .iter()
        .flat_map(|source| &source.rows)
        .filter(|row| row.design.architecture() == architecture && row.is_feasible())
        .collect();
    if rows.first().is_some_and(|row| row.objectives.len() == 1) {
        let mut rows = rows;
        keep_runners_up(&mut rows, |row| row.objectives[0]);
        return rows.into_iter().map(|row| row.design).collect();
    }
    for (id, row) in rows.iter().enumerate() {
        let outcome = Outcome {
            objectives: row.objectives,
            violation: 0.0,
        };
        archive.insert(id, &[], &outcome);
    }
    archive.iter().map(|member| rows[member.id].design).collect()
}

/// Fronts of individual searches, not pooled: each shows the result of a single search.
#[derive(Debug, Clone, Default)]
pub struct SearchFronts {
    /// Front of the search over each architecture on its own.
    pub alone: Vec<(Architecture, Front)>,
    /// Front of the search over all architectures together.
    pub joint: Option<Front>,
}

/// Returns the fronts of the first search over exactly these architectures; `None` if there is none or none is
/// feasible.
fn of_search(
    sources: &[Source],
    architectures: &[Architecture],
    problem: &DesignProblem,
    most: usize,
) -> Option<Fronts> {
    let source = sources
        .iter()
        .find(|source| source.study.architectures == architectures)?;
    Fronts::new(std::slice::from_ref(source), problem, most)
}

/// Returns the front of the search over all architectures of the study together, if there is one.
pub(super) fn joint(sources: &[Source], study: &Study, problem: &DesignProblem) -> Option<Front> {
    match study.architectures[..] {
        [_] => None,
        _ => of_search(sources, &study.architectures, problem, study.optimizer.front_designs)
            .map(|fronts| fronts.together),
    }
}

impl SearchFronts {
    /// Determines the fronts of the first search over each architecture and of the first search over all of them.
    pub fn new(sources: &[Source], study: &Study, problem: &DesignProblem) -> Self {
        let most = study.optimizer.front_designs;
        let fronts = |&architecture| of_search(sources, &[architecture], problem, most);
        Self {
            alone: study
                .architectures
                .iter()
                .filter_map(fronts)
                .flat_map(|fronts| fronts.alone)
                .collect(),
            joint: joint(sources, study, problem),
        }
    }

    /// Returns the front of the search over one architecture.
    pub fn of(&self, architecture: Architecture) -> Option<&Front> {
        front_of(&self.alone, architecture)
    }
}

impl Front {
    /// Returns the fraction of the front's designs that have the given architecture.
    pub fn fraction(&self, architecture: Architecture) -> f64 {
        let of = self
            .members
            .iter()
            .filter(|member| member.design.architecture() == architecture);
        of.count() as f64 / self.members.len().max(1) as f64
    }
}

/// Determines which architecture is best in the first of two objectives at which values of the second: intervals from `worst` to `best`,
/// given as they are minimised.
pub fn best_intervals(fronts: &Fronts, [worst, best]: [f64; 2]) -> Vec<(Architecture, [f64; 2])> {
    const LEVELS: u32 = 400;
    let mut intervals: Vec<(Architecture, [f64; 2])> = Vec::new();
    for k in 1..=LEVELS {
        let level = |k: u32| worst + f64::from(k) / f64::from(LEVELS) * (best - worst);
        let [from, to] = [level(k - 1), level(k)];
        let Some(found) = fronts.together.best_with(&[to]) else {
            continue;
        };
        match intervals.last_mut() {
            Some((architecture, interval)) if *architecture == found.design.architecture() => interval[1] = to,
            _ => intervals.push((found.design.architecture(), [from, to])),
        }
    }
    intervals
}
