//! What stands in the way of a study of which no design is feasible: each requirement with the nearest value of it that can be had.

use kinefront_model::evaluation::{
    Better, Evaluation, GridChoice, Model, ModelSettings, Objective, Quantity, QuantityLimit,
};
use kinefront_model::mechanism::Design;
use kinefront_model::workspace::Region;
use kinefront_optimum::{LocalProblem, Parameter, Polished};
use rayon::prelude::*;
use serde::Serialize;

use super::grid::ROOM;
use crate::DesignProblem;

/// Designs of an architecture from which a feasible one is looked for: those that miss the requirements least.
const STARTS: usize = 2;

/// Largest number of designs from which one is looked for.
const ALL_STARTS: usize = 8;

/// Radius of the disc for which a design is looked for where the study asks for no size, as a share of `R`.
const SMALL: f64 = 0.01;

/// A requirement that stands in the way: relaxed alone, it leaves a feasible design.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Hindrance {
    /// Name of the requirement.
    pub parameter: String,
    /// Name for a person.
    pub label: String,
    /// The value that the study states.
    pub stated: f64,
    /// The nearest value that can be had while all other requirements are kept.
    pub possible: f64,
    /// Unit of both.
    pub unit: &'static str,
    /// Whether it asks no less than the study: the design is feasible, and the search has not found it.
    pub is_enough: bool,
    /// The design that keeps it.
    pub design: String,
    /// Its home orientation \[deg\].
    pub home_phi_deg: f64,
}

impl DesignProblem {
    /// Returns the requirements that stand in the way of every design, the one nearest to what the study states first. `designs` are
    /// infeasible ones, each with its violation. A requirement of which no relaxation suffices is left out: it is not the only one in the
    /// way. A limit that is not part of a local problem, such as one over a motion, has the value of the lightest design that keeps
    /// everything else.
    pub fn hindrances(&self, designs: &[(f64, Design)]) -> Vec<Hindrance> {
        let starts = self.starts(designs).into_iter();
        let problems: Vec<LocalProblem> = starts.filter_map(|start| self.any_design(&start)).collect();
        let asked: Vec<(LocalProblem, Parameter)> = problems
            .iter()
            .flat_map(|problem| {
                let parameters = problem.may_be_relaxed().into_iter();
                let of_size = |parameter: &Parameter| self.has_size() || *parameter != Parameter::WorkspaceRadius;
                let asked = parameters.filter(of_size).map(|parameter| (problem.clone(), parameter));
                asked.collect::<Vec<_>>()
            })
            .collect();
        let relaxed = asked
            .par_iter()
            .filter_map(|(problem, parameter)| self.hindrance(problem, *parameter));
        let mut found: Vec<Hindrance> = relaxed.collect();
        found.par_extend(problems.par_iter().filter_map(|problem| self.missed_limit(problem)));
        let mut nearest: Vec<Hindrance> = Vec::new();
        for next in found {
            match nearest.iter_mut().find(|other| other.parameter == next.parameter) {
                Some(other) if next.distance() < other.distance() => *other = next,
                Some(_) => {}
                None => nearest.push(next),
            }
        }
        nearest.sort_by(|a, b| a.distance().total_cmp(&b.distance()));
        nearest
    }

    /// Returns the designs that miss the requirements least: some of each architecture.
    fn starts(&self, designs: &[(f64, Design)]) -> Vec<Design> {
        let mut sorted: Vec<&(f64, Design)> = designs.iter().collect();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut starts: Vec<Design> = Vec::new();
        for (_, design) in sorted {
            let is_same = |other: &&Design| other.architecture() == design.architecture();
            if starts.iter().filter(is_same).count() < STARTS {
                starts.push(*design);
            }
        }
        starts.truncate(ALL_STARTS);
        starts
    }

    /// Whether the study asks for a region of some size.
    fn has_size(&self) -> bool {
        self.model().settings().workspace.region != Region::Largest || self.least_radius().is_some()
    }

    /// Returns the problem of finding any design: no objective holds.
    fn any_design(&self, start: &Design) -> Option<LocalProblem> {
        let region = match &self.model().settings().workspace.region {
            Region::Largest => Region::Disc(self.least_radius().unwrap_or(SMALL * start.base_radius())),
            region => region.clone(),
        };
        let objective = Objective {
            quantity: Quantity::Mass,
            goal: Better::Lower,
        };
        let question = self.question_for(region, objective, start.architecture());
        LocalProblem::new(question, start).ok()
    }

    /// Returns a requirement that suffices when it is relaxed alone.
    fn hindrance(&self, problem: &LocalProblem, parameter: Parameter) -> Option<Hindrance> {
        let question = problem.question();
        let start = problem.start();
        let actuator = start.architecture().actuator();
        let stated = parameter.value(question, actuator)?;
        let mut found = problem.relaxed_alone(parameter, start)?;
        if !problem.left_out().is_empty() {
            // What has no value at a pose, such as a limit over a motion, is not part of the local problem.
            let relaxed = problem.with_relaxed(parameter, &found)?;
            let polished = relaxed.polish(&found.design, found.home)?;
            let evaluation = self.evaluation_for(&relaxed, &polished)?;
            if missed(&relaxed, &evaluation).next().is_some() {
                return None;
            }
            found.design = evaluation.design;
            found.home = evaluation.home_phi_deg?.to_radians();
        }
        Some(Hindrance {
            parameter: parameter.name(question),
            label: parameter.label(question),
            stated,
            possible: found.value,
            unit: parameter.unit(question, actuator),
            is_enough: parameter.asks_no_less(question, found.value, stated),
            design: found.design.to_string(),
            home_phi_deg: found.home.to_degrees().rem_euclid(360.0),
        })
    }

    /// Returns the limit that the lightest design near the start misses, if it is the only one, and not part of the local problem.
    fn missed_limit(&self, problem: &LocalProblem) -> Option<Hindrance> {
        if problem.left_out().is_empty() {
            return None;
        }
        let polished = problem.best(problem.start(), None).filter(Polished::is_feasible)?;
        let evaluation = self.evaluation_for(problem, &polished)?;
        let mut missed = missed(problem, &evaluation);
        let (limit, None) = (missed.next()?, missed.next()) else {
            return None;
        };
        let entry = limit.quantity.entry();
        Some(Hindrance {
            parameter: entry.key.to_owned(),
            label: entry.label.to_owned(),
            stated: limit.threshold(),
            possible: evaluation.quantities.get(limit.quantity)?,
            unit: entry.unit,
            is_enough: false,
            design: evaluation.design.to_string(),
            home_phi_deg: evaluation.home_phi_deg?,
        })
    }

    /// Evaluates an optimum on the fine grid, with every quantity, under the requirements of its problem.
    fn evaluation_for(&self, problem: &LocalProblem, polished: &Polished) -> Option<Evaluation> {
        let design = self.for_fine_grid(problem, polished, 0.0, ROOM)?;
        let question = problem.question();
        let settings = ModelSettings {
            workspace: question.workspace.clone(),
            ..question.settings.clone()
        };
        let model = Model::new(settings).ok()?.with_all_quantities();
        Some(model.evaluate(&design, GridChoice::Fine))
    }
}

/// Limits that are not part of a local problem, and that a design misses or has no value for.
fn missed<'a>(problem: &'a LocalProblem, evaluation: &'a Evaluation) -> impl Iterator<Item = &'a QuantityLimit> {
    let left_out = problem.left_out();
    let limits = problem.question().settings.limits.iter();
    limits.filter(move |limit| {
        let value = evaluation.quantities.get(limit.quantity);
        left_out.contains(&limit.quantity) && value.is_none_or(|value| limit.margin(value) < -1e-6)
    })
}

impl Hindrance {
    /// Returns how far the possible value is from the stated one, as a logarithm; 0 if it asks no less.
    fn distance(&self) -> f64 {
        match self.is_enough {
            true => 0.0,
            // A value of another sign is no factor away.
            false => match libm::log(self.possible / self.stated).abs() {
                distance if distance.is_nan() => f64::INFINITY,
                distance => distance,
            },
        }
    }
}
