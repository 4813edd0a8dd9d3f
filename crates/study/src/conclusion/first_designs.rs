//! Designs with which a search began, followed to the optima near them.
//!
//! A search settles on the family of designs that leads early, and another family, or another architecture, may have the better optima.
//! The first designs of a search are spread over its bounds, so that an optimum near one of them is a way into each family.

use std::sync::Arc;
use std::time::Instant;

use rayon::prelude::*;

use super::gaps::objectives;
use super::proofs::Held;
use super::{Keep, Settling};
use crate::TableRow;
use crate::local::Aim;
use crate::search::FIRST_DESIGNS;

/// Number of evaluations of the search for which one of its first designs is followed, so that a short search has a short end.
const EVALUATIONS: usize = 200;

/// Number of designs of a mean share that an optimum has to add to a front, so that it is one of another family rather than of a gap.
const FAMILY: f64 = 0.1;

/// Number of first designs of each architecture that may be followed; of few architectures, [`FIRST_DESIGNS`] in all may be.
const OF_EACH: usize = 3;

impl Settling<'_> {
    /// Verifies the optima near the first designs of a search with two or three objectives that add something to its front, and those of
    /// other architectures, also for the values at its end in the first objective; `None` if the run was abandoned.
    pub(super) fn follow_first_designs(&mut self) -> Option<()> {
        let standing = self.standing();
        let adds = self.adds_to(&standing, FAMILY);
        let points = objectives(&standing);
        let at_end = points.first().map(|point| self.aim(0, point));
        let aims: Vec<Aim> = at_end.into_iter().chain([Aim::default()]).collect();
        let mut starts: Vec<(usize, (Arc<TableRow>, Aim))> = Vec::new();
        for entry in self.search.found.best_of_other_architectures() {
            let place = self.add(&entry);
            starts.extend(aims.iter().map(|aim| (place, (Arc::clone(&entry), aim.clone()))));
        }
        for entry in self.first_designs() {
            starts.push((self.add(&entry), (entry, Aim::default())));
        }
        let problem = &self.search.problem;
        let optimum = |(entry, aim): &(Arc<TableRow>, Aim)| {
            let near = problem.evaluate_design(&entry.row.design);
            problem.verify_toward(&near, aim).filter(&adds)
        };
        self.verify(&starts, optimum, Keep::Proved)
    }

    /// Verifies the designs of a search with one objective near which there is a better optimum than what holds: its first ones, and the
    /// best one of each other architecture, because a search that has settled on one leaves the others far from their optima. Returns `None`
    /// if the run was abandoned.
    pub(super) fn settle_promising(&mut self) -> Option<()> {
        let verifying = Instant::now();
        let (control, problem) = (self.control, &self.search.problem);
        let mut others = self.search.found.best_of_other_architectures();
        others.extend(self.first_designs());
        let promise = |entry: &Arc<TableRow>| {
            let is_wanted = !control.is_abandoned();
            is_wanted.then(|| problem.objective_near(&entry.row.design)).flatten()
        };
        let promises: Vec<Option<f64>> = self.search.pool.install(|| others.par_iter().map(promise).collect());
        self.times.verification_s += verifying.elapsed().as_secs_f64();
        if control.is_abandoned() {
            return None;
        }
        let pairs = promises.into_iter().zip(others);
        let mut promising: Vec<(f64, Arc<TableRow>)> =
            pairs.filter_map(|(promise, entry)| Some((promise?, entry))).collect();
        promising.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (promise, entry) in promising {
            let mut held = self.held.iter().filter_map(Held::reported);
            if held.any(|member| member.objectives()[0] <= promise) {
                break;
            }
            let place = self.add(&entry);
            self.settle(&[place])?;
        }
        Some(())
    }

    /// Returns the first designs of the search that are followed.
    fn first_designs(&self) -> Vec<Arc<TableRow>> {
        let found = &self.search.found;
        let most = FIRST_DESIGNS.max(OF_EACH * self.search.study().architectures.len());
        found.first_designs((found.evaluated / EVALUATIONS).min(most))
    }

    /// Adds a candidate; returns its place.
    fn add(&mut self, entry: &Arc<TableRow>) -> usize {
        self.candidates.push(Arc::clone(entry));
        self.is_tried.push(false);
        self.candidates.len() - 1
    }
}
