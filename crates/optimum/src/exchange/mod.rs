//! The search for the best design near a start: critical poses are exchanged, and a sequential quadratic programme keeps them.

mod step;

use nalgebra::{DMatrix, DVector};

use super::hessian::Hessian;
use super::multipliers::Multipliers;
use super::patience::Patience;
use super::place::Density;
use super::polished::Polished;
use super::problem::LocalProblem;
use super::requirement::{Critical, Kind, NOWHERE};
use super::survey::{FOLLOWED, is_same, largest_violation, missed};
use step::Step;

/// Largest number of times that critical poses are added.
const ROUNDS: usize = 40;

/// Largest number of steps with the same critical poses.
const STEPS: usize = 40;

/// Largest change of an unknown in a step at first.
const TRUST: f64 = 0.1;

/// Largest change of an unknown from one set of critical poses to the next.
const WIDEST: f64 = 0.5;

/// Violation beyond which a round is taken back, if it was not there before.
const ASTRAY: f64 = 1.0;

/// Violation and change of the unknowns in a round, below which a search is about to end.
const SLOW: f64 = 1e-5;

/// Violation below which a search goes on, whatever its progress.
const TRIVIAL: f64 = 1e-6;

/// Residual of the multipliers at which a search has reached its end.
const EXPLAINED: f64 = 1e-6;

/// Number of times that the Hessian is determined anew.
const RENEWALS: usize = 8;

/// Two critical poses at one place whose slacks differ by less than this are one constraint.
const IDENTICAL: f64 = 1e-11;

/// Violation at which a search is exact.
const MISSED: f64 = 1e-10;

/// An optimum misses no requirement by more than this.
const HELD: f64 = 1e-8;

/// Share of the slack that an optimum may miss.
const ALLOWED: f64 = 0.5;

/// Largest change of an unknown in a step that is no longer taken.
const SHORTEST: f64 = 1e-10;

/// The same where the requirements keep some slack, which the step would hardly use.
const SHORT: f64 = 1e-6;

/// Changes of the unknowns that are no longer followed.
const STILL: f64 = 1e-7;

/// The same where the requirements keep some slack, which a last change may use.
const ENOUGH: f64 = 1e-3;

/// Least weight of the violations.
const LIGHTEST: f64 = 20.0;

/// Largest weight of the violations.
const HEAVIEST: f64 = 2e3;

/// Critical poses with more slack than this are forgotten.
const SLACK: f64 = 0.25;

/// A search for the best design near a start.
pub(crate) struct Exchange<'a> {
    problem: &'a LocalProblem,
    unknowns: Vec<f64>,
    bounds: Vec<[f64; 2]>,
    /// Bounds of the unknowns in a round.
    reach: Vec<[f64; 2]>,
    critical: Vec<Critical>,
    /// Approximation of the Hessian of the Lagrangian.
    hessian: Hessian,
    /// Weight of the violations.
    weight: f64,
    /// Sum of the multipliers of the last step.
    pressure: f64,
    /// What the critical poses that are known miss after the last step.
    left: f64,
    /// The kinds of requirements that there are.
    kinds: Vec<Kind>,
}

impl<'a> Exchange<'a> {
    pub fn new(problem: &'a LocalProblem, start: &[f64]) -> Self {
        let bounds = problem.bounds();
        let unknowns: Vec<f64> = start
            .iter()
            .zip(&bounds)
            .map(|(value, [lower, upper])| value.clamp(*lower, *upper))
            .collect();
        let count = unknowns.len();
        let mut kinds: Vec<Kind> = Vec::new();
        for requirement in problem.requirements() {
            if !kinds.contains(&requirement.kind()) {
                kinds.push(requirement.kind());
            }
        }
        Self {
            problem,
            unknowns,
            reach: bounds.clone(),
            bounds,
            critical: Vec::new(),
            hessian: Hessian::identity(count),
            weight: LIGHTEST,
            pressure: 0.0,
            left: 0.0,
            kinds,
        }
    }

    pub fn run(mut self) -> Option<Polished> {
        let mut survey = self.survey(Density::Coarse)?;
        let slack = self.problem.question().slack;
        let mut patience = Patience::new(slack > 0.0 && self.problem.question().settings.objectives.len() > 1);
        let mut renewed = 0;
        let mut span = TRUST;
        for round in 0..ROUNDS {
            let known = missed(&survey);
            let (before, hessian, pressure) = (self.unknowns.clone(), self.hessian.clone(), self.pressure);
            let moved = self.descend_with(&survey, span);
            let found = self.survey(Density::Coarse)?;
            if missed(&found) > (2.0 * known).max(ASTRAY) {
                // The design went past a singularity that was not known: nothing there leads back.
                (self.unknowns, self.hessian, self.pressure) = (before, hessian, pressure);
                span *= 0.5;
                if known > TRIVIAL && patience.is_spent_in_vain() {
                    break;
                }
                continue;
            }
            survey = found;
            // A design for a grid is examined on that grid afterwards.
            if missed(&survey) <= SLOW && slack == 0.0 {
                survey = self.survey(Density::Fine)?;
            }
            let missed = missed(&survey);
            // Poses that are not known yet were missed: the next round goes less far.
            span = if missed > (2.0 * known).max(0.05) {
                0.5 * span
            } else {
                (1.5 * span).min(WIDEST)
            };
            let is_spent = patience.is_spent(missed, self.left, self.weight >= HEAVIEST);
            let is_stuck = moved <= 1e-12 && round > 0 || missed > TRIVIAL && is_spent;
            // The approximation of the curvature may have grown so steep that steps stay short.
            if missed <= SLOW && moved <= SLOW && renewed < RENEWALS {
                let found = Multipliers::new(self.problem, &self.unknowns, &survey);
                if found.residual > EXPLAINED {
                    self.hessian.renew(self.problem, &self.unknowns, &found);
                    renewed += 1;
                    continue;
                }
            }
            let is_enough = slack > 0.0 && missed <= ALLOWED * slack && moved <= ENOUGH;
            if missed <= MISSED && (moved <= STILL || round > 12) || is_enough || is_stuck {
                break;
            }
        }
        self.polished(survey)
    }

    /// Returns the result of a search that has ended, with its last steps where no slack is asked for.
    fn polished(mut self, mut survey: Vec<Critical>) -> Option<Polished> {
        let (problem, slack) = (self.problem, self.problem.question().slack);
        if slack == 0.0 && missed(&survey) <= HELD {
            (self.unknowns, survey) = problem.finished(self.unknowns, survey, HELD);
        }
        let missed = missed(&survey);
        let prepared = problem.prepare(&self.unknowns)?;
        let multipliers = Multipliers::new(problem, &self.unknowns, &survey);
        Some(Polished {
            design: prepared.design,
            home: prepared.home,
            objective: problem.objective(&self.unknowns),
            missed,
            allowed: HELD.max(ALLOWED * slack),
            critical: survey,
            multipliers,
            unknowns: self.unknowns,
        })
    }

    /// Returns the critical poses of the design.
    fn survey(&self, density: Density) -> Option<Vec<Critical>> {
        let prepared = self.problem.prepare(&self.unknowns)?;
        Some(self.problem.survey_from(&prepared, density, &self.critical, FOLLOWED))
    }

    /// Adds critical poses that are new, and forgets those that are far from being critical.
    fn adopt(&mut self, survey: &[Critical]) {
        let values = self.problem.values_of(&self.unknowns, &self.critical);
        let mut kept: Vec<Critical> = Vec::new();
        for (critical, slack) in self.critical.drain(..).zip(values) {
            if slack < SLACK && slack > NOWHERE {
                kept.push(Critical { slack, ..critical });
            }
        }
        // Of many constraints, those with the least slack matter.
        kept.sort_by(|a, b| a.slack.total_cmp(&b.slack));
        kept.truncate(40);
        for next in survey.iter().filter(|next| next.slack < SLACK && next.slack > NOWHERE) {
            let is_of_poses = next.requirement.is_of_poses(self.problem);
            let is_known = |other: &Critical| {
                let is_identical = is_same(&other.place, &next.place) && (other.slack - next.slack).abs() < IDENTICAL;
                other.requirement == next.requirement && (is_identical || !is_of_poses)
            };
            if !kept.iter().any(is_known) {
                kept.push(*next);
            }
        }
        self.critical = kept;
    }

    /// Adds the critical poses of a survey, and takes steps that change no unknown by more than `span` in all. Returns the largest change.
    fn descend_with(&mut self, survey: &[Critical], span: f64) -> f64 {
        self.adopt(survey);
        // Near the optimum, a heavy weight would drown the decrease of what is minimised in rounding.
        self.weight = (2.0 * self.pressure).clamp(LIGHTEST, HEAVIEST);
        let within = |(value, [lower, upper]): (&f64, &[f64; 2])| [lower.max(value - span), upper.min(value + span)];
        self.reach = self.unknowns.iter().zip(&self.bounds).map(within).collect();
        let before = self.unknowns.clone();
        self.descend(TRUST.min(span));
        let changes = before.iter().zip(&self.unknowns);
        changes.fold(0.0f64, |most, (a, b)| most.max((a - b).abs()))
    }

    /// Takes steps until none improves the design that keeps the critical poses.
    fn descend(&mut self, first_trust: f64) {
        let problem = self.problem;
        let mut trust = first_trust;
        let mut values = problem.values_of(&self.unknowns, &self.critical);
        let (mut gradient, mut rows) = problem.derivatives(&self.unknowns, &self.critical);
        self.left = largest_violation(values.iter().copied());
        for _ in 0..STEPS {
            let Some(step) = self.step(&gradient, &rows, &values, trust) else {
                trust *= 0.25;
                if trust < 1e-9 {
                    return;
                }
                continue;
            };
            let size = step.change.amax();
            if size < self.smallest_step() {
                return;
            }
            let (changed, new_values, gain) = self.better_end(&step, &gradient, &rows, &values, trust);
            let is_good = gain > 1e-4 * step.promised.max(0.0) && gain > 0.0;
            if !is_good {
                if size < 1e-8 || step.promised < 1e-13 {
                    return;
                }
                trust = 0.3 * size.min(trust);
                continue;
            }
            self.pressure = step.multipliers.iter().sum();
            let (new_gradient, new_rows) = problem.derivatives(&changed, &self.critical);
            let of_lagrangian = |gradient: &DVector<f64>, rows: &DMatrix<f64>| {
                let multipliers = DVector::from_column_slice(&step.multipliers);
                gradient - rows.transpose() * multipliers
            };
            let way = DVector::from_iterator(
                changed.len(),
                changed.iter().zip(&self.unknowns).map(|(new, old)| new - old),
            );
            let turned = of_lagrangian(&new_gradient, &new_rows) - of_lagrangian(&gradient, &rows);
            self.hessian.bend(&way, turned);
            if gain > 0.7 * step.promised && size > 0.8 * trust {
                trust = (2.0 * trust).min(2.0 * first_trust);
            }
            (self.unknowns, values, gradient, rows) = (changed, new_values, new_gradient, new_rows);
            self.left = largest_violation(values.iter().copied());
        }
    }

    /// Returns the unknowns after a step, the values of the critical requirements there, and the decrease of the merit. A step that keeps
    /// less than it promises is taken again for constraints that bend, if that is better.
    fn better_end(
        &mut self,
        step: &Step,
        gradient: &DVector<f64>,
        rows: &DMatrix<f64>,
        values: &[f64],
        trust: f64,
    ) -> (Vec<f64>, Vec<f64>, f64) {
        let merit = self.merit(&self.unknowns, values);
        let (changed, new_values) = self.tried(&step.change);
        let gain = merit - self.merit(&changed, &new_values);
        if gain < 0.1 * step.promised {
            // The constraints bend: their values at the end of the step take the place of those at its beginning.
            let linear = rows * &step.change;
            let bent = new_values.iter().zip(linear.iter());
            let bent: Vec<f64> = bent.map(|(value, linear)| value - linear).collect();
            if let Some(second) = self.step(gradient, rows, &bent, trust) {
                let (again, values_again) = self.tried(&second.change);
                let gain_again = merit - self.merit(&again, &values_again);
                if gain_again > gain {
                    return (again, values_again, gain_again);
                }
            }
        }
        (changed, new_values, gain)
    }

    /// Returns the size of a step that is no longer taken. What it leaves of the minimised value is less than the slack, so that it is larger
    /// once the requirements miss no more than the slack allows.
    fn smallest_step(&self) -> f64 {
        let slack = self.problem.question().slack;
        if slack > 0.0 && self.left <= ALLOWED * slack {
            SHORT
        } else {
            SHORTEST
        }
    }

    /// Returns the unknowns after a change, and the values of the critical requirements there.
    fn tried(&self, change: &DVector<f64>) -> (Vec<f64>, Vec<f64>) {
        let moved = self.unknowns.iter().zip(change.iter()).zip(&self.reach);
        let moved: Vec<f64> = moved
            .map(|((value, change), [lower, upper])| (value + change).clamp(*lower, *upper))
            .collect();
        let values = self.problem.values_of(&moved, &self.critical);
        (moved, values)
    }
}
