//! Pareto fronts of a report, of each architecture and of all architectures together, verified on the fine grid.

use rayon::prelude::*;

use super::Source;
use crate::study::{DesignProblem, FrontMember, FrontProofs, FrontProver, Study, keep_runners_up};
use kinefront_model::evaluation::{Evaluation, Model, Objective};
use kinefront_model::mechanism::{Architecture, Design};
use kinefront_optimize::{Archive, Objectives, Outcome, knee, spread};

/// A front: non-dominated evaluations on the fine grid in ascending order of mass, and hence of `R_w`.
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
    fn certify(&mut self, study: &Study, model: &Model) {
        let shown = self.shown.drain(..).enumerate();
        let shown: Vec<FrontMember> = shown.map(|(id, found)| FrontMember::of(id, found)).collect();
        let mut prover = FrontProver::new(model, study.thickest_bars(), &|| true);
        prover.prove(&shown);
        let (proved, proofs) = prover.conclude(shown.len(), study.hypervolume_reference());
        self.shown = proved.into_iter().map(|member| member.evaluation).collect();
        self.proofs = Some(proofs);
    }

    /// Returns the designs that are shown.
    pub fn shown(&self) -> impl Iterator<Item = &Evaluation> {
        self.shown.iter()
    }

    /// Returns mass and `R_w` of the designs that are shown.
    pub fn points(&self) -> Vec<[f64; 2]> {
        self.shown()
            .map(|member| [member.mass, member.workspace_radius])
            .collect()
    }

    /// Returns the lightest design whose `R_w` is at least `radius` \[m\].
    pub fn lightest(&self, radius: f64) -> Option<&Evaluation> {
        self.members.iter().find(|member| member.workspace_radius >= radius)
    }

    /// Returns the largest `R_w` of the front \[m\]; 0 for an empty front.
    pub fn largest(&self) -> f64 {
        self.members.last().map_or(0.0, |member| member.workspace_radius)
    }

    /// Returns the designs to be pictured, each with its name: the lightest, the knee and the largest, or the best in each of
    /// other `objectives` and the knee.
    pub fn marked(&self, objectives: Option<&[Objective]>) -> Vec<(String, &Evaluation)> {
        let mut marked = Vec::new();
        let last = self.shown.len().saturating_sub(1);
        let values: Vec<Objectives> = self
            .shown()
            .map(|member| DesignProblem::outcome(member).objectives)
            .collect();
        let best = |k: usize| (0..values.len()).min_by(|&a, &b| values[a][k].total_cmp(&values[b][k]));
        let named = match objectives {
            None => vec![
                (Some(0), "lightest".to_owned()),
                (knee(&values), "knee".to_owned()),
                (Some(last), "largest".to_owned()),
            ],
            Some(objectives) => {
                let of_each = objectives.iter().enumerate();
                let best =
                    of_each.map(|(k, objective)| (best(k), format!("best {}", objective.quantity.entry().label)));
                best.chain([(knee(&values), "knee".to_owned())]).collect()
            }
        };
        for (place, name) in named {
            if let Some(member) = place.and_then(|place| self.shown.get(place))
                && !marked
                    .iter()
                    .any(|(_, other): &(_, &Evaluation)| std::ptr::eq(*other, member))
            {
                marked.push((name, member));
            }
        }
        marked
    }
}

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
            let evaluations: Vec<Evaluation> = match problem.model().objectives[..] {
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
    pub fn certify(&mut self, study: &Study, model: &Model) {
        let alone = self.alone.iter_mut().map(|(_, front)| front);
        for front in alone.chain([&mut self.together]) {
            front.certify(study, model);
        }
    }

    /// Returns the front of an architecture.
    pub fn of(&self, architecture: Architecture) -> Option<&Front> {
        self.alone
            .iter()
            .find(|(other, _)| *other == architecture)
            .map(|(_, front)| front)
    }
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
        .filter(|row| row.design.architecture == architecture && row.is_feasible())
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
        let found = self.alone.iter().find(|(other, _)| *other == architecture);
        found.map(|(_, front)| front)
    }
}

impl Front {
    /// Returns the fraction of the front's designs that have the given architecture.
    pub fn fraction(&self, architecture: Architecture) -> f64 {
        let of = self
            .members
            .iter()
            .filter(|member| member.design.architecture == architecture);
        of.count() as f64 / self.members.len().max(1) as f64
    }
}

/// Determines which architecture is the lightest at which radii: intervals of `R_w` \[m\] in ascending order.
pub fn lightest_intervals(fronts: &Fronts) -> Vec<(Architecture, [f64; 2])> {
    const LEVELS: u32 = 400;
    let largest = fronts.together.largest();
    let mut intervals: Vec<(Architecture, [f64; 2])> = Vec::new();
    for k in 1..=LEVELS {
        let (from, to) = (f64::from(k - 1), f64::from(k));
        let [from, to] = [from, to].map(|level| level / f64::from(LEVELS) * largest);
        let Some(best) = fronts.together.lightest(to) else {
            continue;
        };
        match intervals.last_mut() {
            Some((architecture, interval)) if *architecture == best.design.architecture => interval[1] = to,
            _ => intervals.push((best.design.architecture, [from, to])),
        }
    }
    intervals
}
