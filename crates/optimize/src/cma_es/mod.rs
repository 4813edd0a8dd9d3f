//! `CMA-ES` for one objective: evolution strategies with covariance matrix adaptation, and descents by cutting planes, for each
//! combination of the categorical variables.
//!
//! - **Constraints**: a small violation costs a penalty, so that a search sees both sides of a constraint; candidates with a larger
//!   one rank behind, by violation. What counts as the best is feasible.
//! - **Structure**: every candidate asks to be [completed](super::Problem::complete). Variables that the problem
//!   [determines](super::Problem::determined_variables) are left to it, and the search adapts only the others.
//! - **Bounds**: steps beyond a bound are reflected.
//! - **Restarts**: a strategy that has ended starts again with a larger population, in turn from a sampled point and near the
//!   best candidate (Auger and Hansen 2005).
//! - **Descents**: two of three generations go to descents, which follow valleys with sharp floors to their lowest point. They start
//!   at the best candidate, near it, and at sampled points.
//! - **Categories**: generations go to the combination with the best candidate, and a small share to each of the others.

mod descent;
mod polyhedron;
mod strategy;

use std::cmp::Ordering;

use descent::Descent;
use strategy::{Strategy, reflected};

use super::dominance::order;
use super::random::Random;
use super::{Algorithm, Candidate, Evaluated, Outcome, Problem, Variable, doe};

/// Parameters of [`CmaEs`].
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CmaEsSettings {
    /// Number of candidates of the first sample for each combination of the categorical variables, at least 4.
    pub sample: usize,
    /// Number of candidates of a generation, at least 4.
    pub population: usize,
    /// Initial step as a fraction of the range of a variable.
    pub step: f64,
}

impl Default for CmaEsSettings {
    fn default() -> Self {
        Self {
            sample: 40,
            population: 8,
            step: 0.15,
        }
    }
}

/// Every how many generations one goes to the niches that are not leading, in turn.
const OTHERS: usize = 8;

/// Number of generations that every niche gets before the best one leads.
const TRIAL: usize = 8;

/// Largest number of times that the population of a restart is doubled.
const DOUBLINGS: u32 = 3;

/// Relative growth of the objective that a violation of 1 costs a descent.
const PENALTY: f64 = 30.0;

/// Violation from which on nothing is to be learned from a candidate.
const MISSED: f64 = 10.0;

/// Where a descent starts.
#[derive(Debug, Clone, Copy)]
enum DescentStart {
    Best,
    /// At this distance from the best candidate, as a fraction of the ranges.
    Near(f64),
    Sampled,
}

/// Starts of descents, in turn.
const STARTS: [DescentStart; 6] = [
    DescentStart::Near(0.003),
    DescentStart::Near(0.01),
    DescentStart::Best,
    DescentStart::Near(0.03),
    DescentStart::Near(0.003),
    DescentStart::Sampled,
];

/// Width of the trust region of a descent that starts at the best candidate, and the largest one of the others.
const POLISHING: f64 = 3e-4;
const SEARCHING: f64 = 5e-3;

/// Of so many generations one goes to the strategy, the others to descents.
const STRATEGY: usize = 3;

/// The algorithm's state between generations.
#[derive(Debug, Clone)]
pub struct CmaEs {
    variables: Vec<Variable>,
    /// Variables that the search adapts.
    free: Vec<usize>,
    settings: CmaEsSettings,
    random: Random,
    seed: u64,
    niches: Vec<StrategyNiche>,
    generation: usize,
    /// Niche of each candidate of the current generation.
    pending: Vec<usize>,
}

/// One combination of the categorical variables.
#[derive(Debug, Clone, Default)]
struct StrategyNiche {
    categories: Vec<f64>,
    sample: Vec<Evaluated>,
    best: Option<Evaluated>,
    strategy: Option<Placed<Strategy>>,
    descents: Vec<Placed<Descent>>,
    generations: usize,
    /// Numbers of strategies and of descents that were started.
    started: [usize; 2],
}

/// A search over the free variables, scaled to the unit cube, with the values of the others.
#[derive(Debug, Clone)]
struct Placed<S> {
    search: S,
    fixed: Vec<f64>,
}

impl CmaEs {
    /// Creates the algorithm in its state before the first generation, for a problem without structure.
    pub fn new(variables: Vec<Variable>, settings: CmaEsSettings, seed: u64) -> Self {
        let niches = super::categories::combinations(&variables)
            .into_iter()
            .map(|categories| StrategyNiche {
                categories,
                ..StrategyNiche::default()
            })
            .collect();
        let mut algorithm = Self {
            variables,
            free: Vec::new(),
            settings,
            random: Random::new(seed),
            seed,
            niches,
            generation: 0,
            pending: Vec::new(),
        };
        algorithm.free = (0..algorithm.variables.len())
            .filter(|&k| algorithm.range(k)[1] > algorithm.range(k)[0])
            .collect();
        algorithm
    }

    /// Creates the algorithm for a problem that may determine variables
    /// ([`determined_variables`](super::Problem::determined_variables)): these are left to it.
    pub fn for_problem(problem: &impl Problem, settings: CmaEsSettings, seed: u64) -> Self {
        let mut algorithm = Self::new(problem.variables(), settings, seed);
        let determined = problem.determined_variables();
        algorithm.free.retain(|k| !determined.contains(k));
        algorithm
    }

    fn sample(&self) -> Vec<(usize, Vec<f64>)> {
        let count = self.settings.sample.max(4) * self.niches.len();
        doe::sobol(&self.variables, count, self.seed)
            .into_iter()
            .enumerate()
            .map(|(index, mut x)| {
                let niche = index % self.niches.len();
                super::categories::set_categories(&self.variables, &mut x, &self.niches[niche].categories);
                (niche, x)
            })
            .collect()
    }

    /// Returns the niche of the next generation.
    fn next_niche(&self) -> usize {
        let trial = self.niches.iter().position(|niche| niche.generations < TRIAL);
        if let Some(niche) = trial {
            return niche;
        }
        let best = (0..self.niches.len()).min_by(|&a, &b| {
            let [a, b] = [a, b].map(|niche| self.niches[niche].best.as_ref().map(|best| best.outcome));
            match (a, b) {
                (Some(a), Some(b)) => order(&a, &b),
                (a, b) => b.is_some().cmp(&a.is_some()),
            }
        });
        let best = best.unwrap_or(0);
        let others = self.niches.len() - 1;
        if others > 0 && self.generation.is_multiple_of(OTHERS) {
            let other = self.generation / OTHERS % others;
            return other + usize::from(other >= best);
        }
        best
    }

    fn range(&self, variable: usize) -> [f64; 2] {
        match self.variables[variable] {
            Variable::Real { lower, upper } => [lower, upper],
            Variable::Categorical { .. } => [0.0, 0.0],
        }
    }

    /// Returns the free variables of a candidate, scaled to the unit cube.
    fn scaled(&self, x: &[f64]) -> Vec<f64> {
        let scaled = |&k: &usize| {
            let [lower, upper] = self.range(k);
            (x[k] - lower) / (upper - lower)
        };
        self.free.iter().map(scaled).collect()
    }

    /// Returns the candidate with free variables from the unit cube and the others fixed.
    fn unscaled(&self, point: &[f64], fixed: &[f64]) -> Vec<f64> {
        let mut x = fixed.to_vec();
        for (value, &k) in point.iter().zip(&self.free) {
            let [lower, upper] = self.range(k);
            x[k] = (lower + value * (upper - lower)).clamp(lower, upper);
        }
        x
    }

    /// Starts a strategy in a niche: from the best of its sample, then in turn near its best and from another point.
    fn start(&mut self, niche: usize) -> Placed<Strategy> {
        let state = &mut self.niches[niche];
        let restarts = state.started[0];
        state.started[0] += 1;
        let near_best = restarts % 2 == 1;
        let fixed = state.origin(if near_best { 0 } else { restarts / 2 });
        let doublings = (restarts as u32).div_ceil(2).min(DOUBLINGS);
        let step = self.settings.step * if near_best { 0.1 } else { 1.0 };
        let population = self.settings.population.max(4) << doublings;
        Placed {
            search: Strategy::new(self.scaled(&fixed), step, population),
            fixed,
        }
    }

    /// Starts a descent in a niche: at its best candidate, near it at several distances, and at a point of its sample, in turn.
    fn start_descent(&mut self, niche: usize) -> Placed<Descent> {
        let state = &mut self.niches[niche];
        let [round, place] = [state.started[1] / STARTS.len(), state.started[1] % STARTS.len()];
        state.started[1] += 1;
        let (hop, width, is_near_best) = match STARTS[place] {
            DescentStart::Best => (0.0, POLISHING, true),
            DescentStart::Near(hop) => (hop, SEARCHING.min(0.5 * hop), true),
            DescentStart::Sampled => (0.0, SEARCHING, false),
        };
        let fixed = state.origin(if is_near_best { 0 } else { round });
        let mut start = self.scaled(&fixed);
        if hop > 0.0 {
            for value in &mut start {
                *value = reflected(*value + hop * self.normal());
            }
        }
        Placed {
            search: Descent::new(start, width),
            fixed,
        }
    }

    /// Draws a standard normal number (Box and Muller).
    fn normal(&mut self) -> f64 {
        let radius = libm::sqrt(-2.0 * libm::log(1.0 - self.random.uniform()));
        radius * libm::cos(std::f64::consts::TAU * self.random.uniform())
    }

    fn generation_of(&mut self, niche: usize) -> Vec<Vec<f64>> {
        if self.niches[niche].is_descending() && !self.free.is_empty() {
            self.descend(niche)
        } else {
            self.evolve(niche)
        }
    }

    fn evolve(&mut self, niche: usize) -> Vec<Vec<f64>> {
        let mut strategy = match self.niches[niche].strategy.take() {
            Some(strategy) => strategy,
            None => self.start(niche),
        };
        let normals = (0..strategy.search.population)
            .map(|_| (0..self.free.len()).map(|_| self.normal()).collect())
            .collect();
        let points = strategy.search.ask(normals);
        let candidates = points
            .iter()
            .map(|point| self.unscaled(point, &strategy.fixed))
            .collect();
        self.niches[niche].strategy = Some(strategy);
        candidates
    }

    fn descend(&mut self, niche: usize) -> Vec<Vec<f64>> {
        let count = (self.settings.population / (self.free.len() + 2)).max(1);
        while self.niches[niche].descents.len() < count {
            let descent = self.start_descent(niche);
            self.niches[niche].descents.push(descent);
        }
        let descents = self.niches[niche].descents.iter();
        let points = descents.flat_map(|descent| descent.search.ask().into_iter().map(|point| (point, &descent.fixed)));
        points.map(|(point, fixed)| self.unscaled(&point, fixed)).collect()
    }
}

impl StrategyNiche {
    /// Whether the next generation consists of descents.
    fn is_descending(&self) -> bool {
        !self.generations.is_multiple_of(STRATEGY)
    }

    /// Returns where a search starts: at the best candidate for the place 0, then at the points of the sample in their order.
    fn origin(&self, place: usize) -> Vec<f64> {
        match &self.best {
            Some(best) if place == 0 => best.x.clone(),
            _ => {
                let mut sample: Vec<&Evaluated> = self.sample.iter().collect();
                sample.sort_by(|a, b| order(&a.outcome, &b.outcome));
                sample[place % sample.len()].x.clone()
            }
        }
    }

    /// Takes the outcomes of a whole generation.
    fn learn(&mut self, evaluated: &[Evaluated]) {
        if self.is_descending() && !self.descents.is_empty() {
            let merit = |candidate: &Evaluated| merit(&candidate.outcome);
            let best = self.best.as_ref().map_or(f64::INFINITY, merit);
            let mut rest = evaluated;
            for descent in &mut self.descents {
                let (own, others) = rest.split_at(descent.search.points());
                descent.search.tell(&own.iter().map(merit).collect::<Vec<_>>(), best);
                rest = others;
            }
            self.descents.retain(|descent| !descent.search.is_over());
        } else if let Some(strategy) = &mut self.strategy {
            strategy.search.learn(evaluated);
            let own = evaluated.iter().map(|candidate| candidate.outcome).min_by(order);
            let leads = match (&own, &self.best) {
                (Some(own), Some(best)) => order(own, &best.outcome) != Ordering::Greater,
                _ => false,
            };
            if strategy.search.is_over(leads) {
                self.strategy = None;
            }
        }
        self.generations += 1;
    }
}

impl Algorithm for CmaEs {
    fn ask(&mut self) -> Vec<Candidate> {
        let asked: Vec<(usize, Vec<f64>)> = if self.generation == 0 {
            self.sample()
        } else {
            let niche = self.next_niche();
            let candidates = self.generation_of(niche).into_iter();
            candidates.map(|x| (niche, x)).collect()
        };
        self.pending = asked.iter().map(|(niche, _)| *niche).collect();
        asked.into_iter().map(|(_, x)| Candidate::seeking_best(x)).collect()
    }

    fn tell(&mut self, evaluated: Vec<Evaluated>) {
        let is_whole = evaluated.len() == self.pending.len();
        let pending = std::mem::take(&mut self.pending);
        for (niche, candidate) in pending.iter().zip(&evaluated) {
            let state = &mut self.niches[*niche];
            let better = |best: &Evaluated| order(&candidate.outcome, &best.outcome) == Ordering::Less;
            if state.best.as_ref().is_none_or(better) {
                state.best = Some(candidate.clone());
            }
            if self.generation == 0 {
                state.sample.push(candidate.clone());
            }
        }
        if self.generation > 0 && is_whole {
            self.niches[pending[0]].learn(&evaluated);
        }
        self.generation += 1;
    }
}

/// Returns the value that a descent sees: the objective with a penalty; infinite for a very large violation.
fn merit(outcome: &Outcome) -> f64 {
    let (violation, objective) = (outcome.violation.max(0.0), outcome.objectives[0]);
    if violation > MISSED {
        return f64::INFINITY;
    }
    objective + PENALTY * violation * libm::fabs(objective)
}
