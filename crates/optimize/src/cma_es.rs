//! `CMA-ES` for one objective: evolution strategies with covariance matrix adaptation (Hansen 2016), in the form with a Cholesky
//! factor (Krause, Arbonès and Igel 2016), one for each combination of the categorical variables.
//!
//! - **Constraints**: a small violation costs a penalty, whose weight follows the share of feasible candidates, so that a strategy
//!   sees both sides of a constraint; candidates with a larger one rank behind, by violation. What counts as the best is feasible.
//! - **Structure**: every candidate asks to be [completed](super::Problem::complete). Variables that the problem sets itself are
//!   recognised by comparing what was asked with what was told, and the strategy adapts only the others.
//! - **Bounds**: steps beyond a bound are reflected.
//! - **Restarts**: a strategy that has converged starts again with a larger population, in turn from a sampled point and near its
//!   best candidate (Auger and Hansen 2005).
//! - **Categories**: generations go to the combination with the best candidate, and a small share to each of the others.

use std::cmp::Ordering;

use super::random::Random;
use super::{Algorithm, Candidate, Evaluated, Outcome, Target, Variable, doe};

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
            population: 12,
            step: 0.15,
        }
    }
}

/// Every how many generations one goes to the niches that are not leading, in turn.
const OTHERS: usize = 8;

/// Number of generations that every niche gets before the best one leads.
const TRIAL: usize = 12;

/// A strategy has converged when its steps are smaller than this fraction of the ranges.
const SMALLEST_STEP: f64 = 1e-10;

/// Largest number of times that the population of a restart is doubled.
const DOUBLINGS: u32 = 3;

/// The algorithm's state between generations.
#[derive(Debug, Clone)]
pub struct CmaEs {
    variables: Vec<Variable>,
    settings: CmaEsSettings,
    random: Random,
    seed: u64,
    niches: Vec<StrategyNiche>,
    generation: usize,
    /// Niche of each candidate of the current generation, and what was asked.
    pending: Vec<(usize, Vec<f64>)>,
}

/// Largest violation that costs a penalty.
const SLIGHT: f64 = 0.2;

/// One combination of the categorical variables.
#[derive(Debug, Clone)]
struct StrategyNiche {
    categories: Vec<f64>,
    sample: Vec<Evaluated>,
    best: Option<Evaluated>,
    /// Whether the problem sets a variable itself.
    is_completed: Vec<bool>,
    strategy: Option<Strategy>,
    generations: usize,
    restarts: u32,
}

/// An evolution strategy over the free variables, scaled to \[0, 1\].
#[derive(Debug, Clone)]
struct Strategy {
    /// Indices of the free variables.
    free: Vec<usize>,
    /// Values of the other variables.
    fixed: Vec<f64>,
    mean: Vec<f64>,
    step: f64,
    /// Lower triangular factor of the covariance matrix.
    factor: Vec<Vec<f64>>,
    step_path: Vec<f64>,
    path: Vec<f64>,
    population: usize,
    /// Relative growth of the objective that a violation of 1 costs.
    penalty: f64,
    /// Standard normal vectors of the candidates of the current generation.
    normals: Vec<Vec<f64>>,
}

impl CmaEs {
    /// Creates the algorithm in its state before the first generation.
    pub fn new(variables: Vec<Variable>, settings: CmaEsSettings, seed: u64) -> Self {
        let niches = super::front_de::combinations(&variables)
            .into_iter()
            .map(|categories| StrategyNiche {
                categories,
                sample: Vec::new(),
                best: None,
                is_completed: vec![false; variables.len()],
                strategy: None,
                generations: 0,
                restarts: 0,
            })
            .collect();
        Self {
            variables,
            settings,
            random: Random::new(seed),
            seed,
            niches,
            generation: 0,
            pending: Vec::new(),
        }
    }

    fn sample(&self) -> Vec<(usize, Vec<f64>)> {
        let count = self.settings.sample.max(4) * self.niches.len();
        doe::sobol(&self.variables, count, self.seed)
            .into_iter()
            .enumerate()
            .map(|(index, mut x)| {
                let niche = index % self.niches.len();
                super::front_de::set_categories(&self.variables, &mut x, &self.niches[niche].categories);
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

    /// Starts a strategy in a niche: from the best of its sample, then in turn from another point and near its best.
    fn start(&mut self, niche: usize) -> Strategy {
        let state = &self.niches[niche];
        let mut sample: Vec<&Evaluated> = state.sample.iter().collect();
        sample.sort_by(|a, b| order(&a.outcome, &b.outcome));
        let place = (state.restarts as usize).div_ceil(2) % sample.len();
        let near_best = state.restarts % 2 == 1;
        let start = match &state.best {
            Some(best) if near_best || place == 0 => best,
            _ => sample[place],
        };
        let x = start.x.clone();
        let free: Vec<usize> = (0..self.variables.len())
            .filter(|&k| {
                let [lower, upper] = self.range(k);
                upper > lower && !state.is_completed[k]
            })
            .collect();
        let mean: Vec<f64> = free
            .iter()
            .map(|&k| {
                let [lower, upper] = self.range(k);
                (x[k] - lower) / (upper - lower)
            })
            .collect();
        let count = mean.len();
        let population = self.settings.population.max(4) << state.restarts.div_ceil(2).min(DOUBLINGS);
        Strategy {
            fixed: x,
            mean,
            step: self.settings.step * if near_best { 0.1 } else { 1.0 },
            factor: (0..count)
                .map(|row| (0..count).map(|column| f64::from(u8::from(row == column))).collect())
                .collect(),
            step_path: vec![0.0; count],
            path: vec![0.0; count],
            population,
            penalty: 10.0,
            normals: Vec::new(),
            free,
        }
    }

    /// Draws a standard normal number (Box and Muller).
    fn normal(&mut self) -> f64 {
        let radius = libm::sqrt(-2.0 * libm::log(1.0 - self.random.uniform()));
        radius * libm::cos(std::f64::consts::TAU * self.random.uniform())
    }

    fn generation_of(&mut self, niche: usize) -> Vec<(usize, Vec<f64>)> {
        let mut strategy = match self.niches[niche].strategy.take() {
            Some(strategy) => strategy,
            None => self.start(niche),
        };
        let count = strategy.mean.len();
        strategy.normals = (0..strategy.population)
            .map(|_| (0..count).map(|_| self.normal()).collect())
            .collect();
        let candidates = strategy
            .normals
            .iter()
            .map(|normal| {
                let mut x = strategy.fixed.clone();
                for (at, &k) in strategy.free.iter().enumerate() {
                    let moved = strategy.mean[at] + strategy.step * dot(&strategy.factor[at][..=at], normal);
                    let [lower, upper] = self.range(k);
                    x[k] = (lower + reflected(moved) * (upper - lower)).clamp(lower, upper);
                }
                (niche, x)
            })
            .collect();
        self.niches[niche].strategy = Some(strategy);
        candidates
    }
}

impl Algorithm for CmaEs {
    fn ask(&mut self) -> Vec<Candidate> {
        self.pending = if self.generation == 0 {
            self.sample()
        } else {
            let niche = self.next_niche();
            self.generation_of(niche)
        };
        self.pending
            .iter()
            .map(|(_, x)| Candidate {
                x: x.clone(),
                target: Some(Target::Best),
            })
            .collect()
    }

    fn tell(&mut self, evaluated: Vec<Evaluated>) {
        let is_whole = evaluated.len() == self.pending.len();
        let pending = std::mem::take(&mut self.pending);
        for ((niche, asked), candidate) in pending.iter().zip(&evaluated) {
            let state = &mut self.niches[*niche];
            for (k, is_completed) in state.is_completed.iter_mut().enumerate() {
                *is_completed |= asked[k] != candidate.x[k];
            }
            let better = |best: &Evaluated| order(&candidate.outcome, &best.outcome) == Ordering::Less;
            if state.best.as_ref().is_none_or(better) {
                state.best = Some(candidate.clone());
            }
            if self.generation == 0 {
                state.sample.push(candidate.clone());
            }
        }
        if self.generation > 0 && is_whole {
            let niche = pending[0].0;
            let state = &mut self.niches[niche];
            state.generations += 1;
            if let Some(strategy) = &mut state.strategy {
                strategy.learn(&evaluated);
                if let Some(best) = &state.best {
                    for (k, value) in strategy.fixed.iter_mut().enumerate() {
                        if state.is_completed[k] {
                            *value = best.x[k];
                        }
                    }
                }
                if strategy.has_converged() {
                    state.strategy = None;
                    state.restarts += 1;
                }
            }
        }
        self.generation += 1;
    }
}

impl Strategy {
    /// Adapts mean, step and covariance to the ranking of the current generation.
    fn learn(&mut self, evaluated: &[Evaluated]) {
        let count = self.mean.len();
        if count == 0 {
            return;
        }
        let n = count as f64;
        let ranked = self.rank(evaluated);
        let parents = (evaluated.len() / 2).max(1);
        let raw = |place: usize| libm::log(parents as f64 + 0.5) - libm::log(place as f64 + 1.0);
        let total: f64 = (0..parents).map(raw).sum();
        let weights: Vec<f64> = (0..parents).map(|place| raw(place) / total).collect();
        let effective = 1.0 / weights.iter().map(|weight| weight * weight).sum::<f64>();
        // The standard parameters (Hansen 2016, table 1).
        let step_rate = (effective + 2.0) / (n + effective + 5.0);
        let damping = 1.0 + 2.0 * (libm::sqrt((effective - 1.0) / (n + 1.0)) - 1.0).max(0.0) + step_rate;
        let rate = (4.0 + effective / n) / (n + 4.0 + 2.0 * effective / n);
        let rank_one = 2.0 / ((n + 1.3) * (n + 1.3) + effective);
        let rank_many = (2.0 * (effective - 2.0 + 1.0 / effective) / ((n + 2.0) * (n + 2.0) + effective))
            .clamp(0.0, 1.0 - rank_one);
        let expected = libm::sqrt(n) * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));

        let mean_normal: Vec<f64> = (0..count)
            .map(|k| {
                ranked
                    .iter()
                    .zip(&weights)
                    .map(|(&i, weight)| weight * self.normals[i][k])
                    .sum()
            })
            .collect();
        let moved: Vec<f64> = (0..count).map(|k| dot(&self.factor[k][..=k], &mean_normal)).collect();
        for (mean, by) in self.mean.iter_mut().zip(&moved) {
            *mean = reflected(*mean + self.step * by);
        }
        let gain = libm::sqrt(step_rate * (2.0 - step_rate) * effective);
        for (path, normal) in self.step_path.iter_mut().zip(&mean_normal) {
            *path = (1.0 - step_rate) * *path + gain * normal;
        }
        let length = libm::sqrt(dot(&self.step_path, &self.step_path));
        let is_short = length < (1.4 + 2.0 / (n + 1.0)) * expected;
        let gain = if is_short {
            libm::sqrt(rate * (2.0 - rate) * effective)
        } else {
            0.0
        };
        for (path, by) in self.path.iter_mut().zip(&moved) {
            *path = (1.0 - rate) * *path + gain * by;
        }
        let lost = if is_short { 0.0 } else { rank_one * rate * (2.0 - rate) };
        let kept = 1.0 - rank_one - rank_many + lost;
        let steps: Vec<Vec<f64>> = ranked[..parents]
            .iter()
            .map(|&i| {
                (0..count)
                    .map(|k| dot(&self.factor[k][..=k], &self.normals[i]))
                    .collect()
            })
            .collect();
        let mut covariance = vec![vec![0.0; count]; count];
        for row in 0..count {
            for column in 0..=row {
                let before = dot(&self.factor[row][..=column], &self.factor[column][..=column]);
                let many: f64 = steps
                    .iter()
                    .zip(&weights)
                    .map(|(step, weight)| weight * step[row] * step[column])
                    .sum();
                covariance[row][column] =
                    kept * before + rank_one * self.path[row] * self.path[column] + rank_many * many;
            }
        }
        if let Some(factor) = cholesky(&covariance) {
            self.factor = factor;
        }
        self.step *= libm::exp((step_rate / damping * (length / expected - 1.0)).min(1.0));
    }

    /// Ranks candidates by the objective with its penalty, then those with a larger violation, and adapts the penalty so that a
    /// part of the better half is feasible.
    fn rank(&mut self, evaluated: &[Evaluated]) -> Vec<usize> {
        let penalty = self.penalty;
        let key = |outcome: &Outcome| {
            let violation = outcome.violation.max(0.0);
            let objective = outcome.objectives[0];
            if violation <= SLIGHT {
                (0.0, objective + penalty * violation * libm::fabs(objective))
            } else {
                (violation, objective)
            }
        };
        let mut ranked: Vec<usize> = (0..evaluated.len()).collect();
        ranked.sort_by(|&a, &b| {
            let ((tier_a, value_a), (tier_b, value_b)) = (key(&evaluated[a].outcome), key(&evaluated[b].outcome));
            tier_a.total_cmp(&tier_b).then(value_a.total_cmp(&value_b))
        });
        let better = &ranked[..ranked.len().div_ceil(2)];
        let feasible = better
            .iter()
            .filter(|&&place| evaluated[place].outcome.is_feasible())
            .count();
        let share = feasible as f64 / better.len() as f64;
        if share < 0.3 {
            self.penalty = (1.5 * self.penalty).min(1e9);
        } else if share > 0.8 {
            self.penalty = (self.penalty / 1.2).max(1e-3);
        }
        ranked
    }

    fn has_converged(&self) -> bool {
        let widest = self
            .factor
            .iter()
            .map(|row| libm::sqrt(dot(row, row)))
            .fold(0.0, f64::max);
        self.step * widest < SMALLEST_STEP || !self.step.is_finite() || self.mean.is_empty()
    }
}

/// Ranks feasible outcomes by the objective, then infeasible ones by violation.
fn order(a: &Outcome, b: &Outcome) -> Ordering {
    let key = |outcome: &Outcome| (outcome.violation.max(0.0), outcome.objectives[0]);
    let ((violation_a, objective_a), (violation_b, objective_b)) = (key(a), key(b));
    violation_a
        .total_cmp(&violation_b)
        .then(objective_a.total_cmp(&objective_b))
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |sum, (a, b)| sum + a * b)
}

/// Reflects a number at 0 and 1 until it lies between them.
fn reflected(value: f64) -> f64 {
    let turned = libm::fmod(libm::fabs(value), 2.0);
    if turned > 1.0 { 2.0 - turned } else { turned }
}

/// Returns the lower triangular factor of a symmetric matrix, of which the lower triangle is given; `None` if it is not positive
/// definite.
fn cholesky(matrix: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let count = matrix.len();
    let mut factor = vec![vec![0.0; count]; count];
    for row in 0..count {
        for column in 0..=row {
            let rest = matrix[row][column] - dot(&factor[row][..column], &factor[column][..column]);
            factor[row][column] = if row == column {
                let square = Some(rest).filter(|rest| *rest > 0.0 && rest.is_finite())?;
                libm::sqrt(square)
            } else {
                rest / factor[column][column]
            };
        }
    }
    Some(factor)
}
