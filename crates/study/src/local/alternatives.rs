//! Designs beside an optimum that no derivative shows: those with other entries of lists and catalogues.

use std::cmp::Ordering;

use kinefront_model::mechanism::{DESIGN_VARIABLES, Design, DesignVariable};
use kinefront_optimum::{LocalProblem, Polished};
use rayon::prelude::*;
use serde::Serialize;

use super::LocalDesign;
use crate::DesignProblem;

/// Another entry of the list or catalogue of a dimension.
#[derive(Debug, Clone)]
pub(super) struct OtherEntry {
    /// Its name.
    label: String,
    /// The dimension and those that are tied to it, with their values.
    changes: Vec<(DesignVariable, f64)>,
}

/// An optimum that keeps the requirements of a local problem, or a part of what is wished.
pub(super) struct LocalAnswer {
    pub polished: Polished,
    pub problem: LocalProblem,
    /// The part of a wish, from what the design has (0) to the whole (1).
    pub part: f64,
}

impl LocalAnswer {
    /// Returns what orders answers, the best first: the part that is missing, and the objective.
    fn key(&self) -> [f64; 2] {
        [-self.part, self.problem.goal_sign() * self.polished.objective]
    }
}

/// A design beside an optimum, as other programs read it.
#[derive(Debug, Clone, Serialize)]
pub struct AlternativeJson {
    /// What is different, for a person.
    pub label: String,
    /// Value of the objective; absent if no design near the optimum satisfies every requirement.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// Relative change of the objective against the optimum.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub change: Option<f64>,
    /// The design, optimised again.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub design: Option<String>,
    /// Its home orientation \[deg\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub home_phi_deg: Option<f64>,
}

impl OtherEntry {
    /// Returns a design with this entry; `None` if it is none.
    pub(super) fn applied_to(&self, design: &Design) -> Option<Design> {
        let mut changes = self.changes.iter();
        changes.try_fold(*design, |design, (variable, value)| design.with(*variable, *value).ok())
    }
}

impl DesignProblem {
    /// Returns the dimensions that are listed or of a catalogue.
    pub(super) fn listed_variables(&self) -> impl Iterator<Item = DesignVariable> {
        DESIGN_VARIABLES
            .into_iter()
            .filter(|variable| !self.entries_of(*variable).is_empty())
    }

    /// Returns the next smaller and the next larger entry of each list and catalogue.
    pub(super) fn other_entries(&self, design: &Design) -> Vec<OtherEntry> {
        let beside = |variable: DesignVariable| {
            let value = design.value(variable);
            let listed = move || self.entries_of(variable).iter().copied();
            let smaller = listed().filter(|other| *other < value).reduce(f64::max);
            let larger = listed().filter(|other| *other > value).reduce(f64::min);
            [smaller, larger]
                .into_iter()
                .flatten()
                .map(move |value| self.entry(variable, value))
        };
        self.listed_variables().flat_map(beside).collect()
    }

    /// Follows the entries of lists and catalogues beside those of a design, as long as one of them is better. Returns all answers, the best
    /// first; `own` is that of the entries of the design itself. Where there is none yet, entries up to `reach` steps away are tried.
    /// `solve` answers for a design and a home orientation \[rad\] near it; it is told whether only an answer to the whole of a wish is of
    /// use.
    pub(super) fn follow_entries(
        &self,
        start: (Design, f64),
        own: Option<LocalAnswer>,
        reach: usize,
        solve: &(dyn Fn(&Design, f64, bool) -> Option<LocalAnswer> + Sync),
    ) -> Vec<LocalAnswer> {
        let mut tried = vec![self.listed_values(&start.0)];
        let mut found: Vec<LocalAnswer> = own.into_iter().collect();
        // Designs whose entries have no answer, and the number of steps to them.
        let (mut without, mut steps) = (vec![start.0], 0);
        loop {
            let best = found.first();
            let home = best.map_or(start.1, |best| best.polished.home);
            let is_whole = best.is_some_and(|best| best.part >= 1.0);
            let known = best.map(LocalAnswer::key);
            let from = best.map_or(without, |best| vec![best.polished.design]);
            let mut others: Vec<Design> = Vec::new();
            for design in &from {
                let entries = self.other_entries(design);
                for other in entries.iter().filter_map(|entry| entry.applied_to(design)) {
                    let values = self.listed_values(&other);
                    if !tried.contains(&values) {
                        tried.push(values);
                        others.push(other);
                    }
                }
            }
            let next: Vec<Option<LocalAnswer>> = others.par_iter().map(|other| solve(other, home, is_whole)).collect();
            found.extend(next.into_iter().flatten());
            found.sort_by(|a, b| a.key().partial_cmp(&b.key()).unwrap_or(Ordering::Equal));
            steps += 1;
            // What had no answer from far away may have one from nearby.
            if known.is_none() && steps > 1 {
                tried = found
                    .iter()
                    .map(|answer| self.listed_values(&answer.polished.design))
                    .collect();
            }
            let has_ended = match found.first() {
                Some(best) => Some(best.key()) == known,
                None => others.is_empty() || steps >= reach,
            };
            if has_ended {
                return found;
            }
            without = others;
        }
    }

    /// Returns the values of the dimensions that are listed.
    fn listed_values(&self, design: &Design) -> Vec<f64> {
        self.listed_variables().map(|variable| design.value(variable)).collect()
    }

    /// Returns the dimensions of lists and catalogues that differ between two designs, in words such as `legs: DN 20 becomes DN 25`.
    pub(super) fn changed_entries(&self, before: &Design, after: &Design) -> Vec<String> {
        let changed = self
            .listed_variables()
            .filter(|variable| before.value(*variable) != after.value(*variable));
        let words = changed.map(|variable| {
            let [(part, from), (_, to)] = [before, after].map(|design| self.named(variable, design.value(variable)));
            format!("{part}: {from} becomes {to}")
        });
        words.collect()
    }

    /// Returns the name of a listed dimension, and that of its value.
    fn named(&self, variable: DesignVariable, value: f64) -> (&'static str, String) {
        let sections = &self.model().settings().sections;
        let (part, name) = match variable {
            DesignVariable::LegBarRadius => ("legs", sections.legs.catalogue_name(value)),
            DesignVariable::PlatformBarRadius => ("platform", sections.platform.catalogue_name(value)),
            _ => ("", None),
        };
        match name {
            Some(name) => (part, name.to_owned()),
            None => (variable.symbol(), format!("{value} m")),
        }
    }

    fn entry(&self, variable: DesignVariable, value: f64) -> OtherEntry {
        let (part, name) = self.named(variable, value);
        let tied = self
            .tied_to(variable)
            .into_iter()
            .map(|(tied, factor)| (tied, factor * value));
        OtherEntry {
            label: format!("{part}: {name}"),
            changes: std::iter::once((variable, value)).chain(tied).collect(),
        }
    }
}

impl LocalDesign {
    /// Returns what an optimum becomes with the next entries of lists and catalogues.
    pub(super) fn alternatives(&self, problem: &LocalProblem, polished: &Polished) -> Vec<AlternativeJson> {
        let with_entry = |entry: &OtherEntry| {
            let start = entry.applied_to(&polished.design);
            let found = start.and_then(|start| optimum_of(problem, &start, polished.home));
            let found = found.as_ref();
            AlternativeJson {
                label: entry.label.clone(),
                value: found.map(|found| found.objective),
                change: found.map(|found| found.objective / polished.objective - 1.0),
                design: found.map(|found| found.design.to_string()),
                home_phi_deg: found.map(|found| found.home.to_degrees().rem_euclid(360.0)),
            }
        };
        self.entries.par_iter().map(with_entry).collect()
    }
}

/// Returns the optimum near a design whose listed dimensions differ from those of the problem.
fn optimum_of(problem: &LocalProblem, start: &Design, home: f64) -> Option<Polished> {
    let problem = LocalProblem::new(problem.question().clone(), start).ok()?;
    problem.polish(start, home).filter(Polished::is_feasible)
}
