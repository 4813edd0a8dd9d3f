//! NSGA-II (Deb, Pratap, Agarwal, Meyarivan 2002) with constraint domination, for mixed variables.
//!
//! Real variables: simulated binary crossover and polynomial mutation, both bounded (Deb and Agrawal 1995; Deb and Goyal
//! 1996). Categorical variables: taken from either parent, redrawn with the mutation's probability. The first generation is
//! a Sobol sample and counts as a generation. Copies of candidates that are in the population or already among the
//! offspring are not evaluated again: another pair of parents is drawn instead.

use super::dominance::{crowding_distances, non_dominated_ranks};
use super::random::Random;
use super::{Algorithm, Evaluated, Outcome, Variable, doe};

/// Parameters of [`Nsga2`].
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Nsga2Settings {
    /// Population size, at least 2.
    pub population: usize,
    /// Probability that a pair is crossed rather than copied.
    pub crossover: f64,
    /// Distribution index of the crossover: the larger, the nearer to the parents.
    pub crossover_index: f64,
    /// Mutation probability of a variable; `None` for one over the number of variables.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mutation: Option<f64>,
    /// Distribution index of the mutation.
    pub mutation_index: f64,
}

impl Default for Nsga2Settings {
    fn default() -> Self {
        Self {
            population: 60,
            crossover: 0.9,
            crossover_index: 15.0,
            mutation: None,
            mutation_index: 20.0,
        }
    }
}

/// The algorithm's state between generations.
#[derive(Debug, Clone)]
pub struct Nsga2 {
    variables: Vec<Variable>,
    settings: Nsga2Settings,
    random: Random,
    seed: u64,
    population: Vec<Ranked>,
}

#[derive(Debug, Clone)]
struct Ranked {
    candidate: Evaluated,
    rank: usize,
    crowding: f64,
}

/// Pairs drawn in search of offspring that are no copies, per individual, before copies are accepted.
const PATIENCE: usize = 50;

impl Nsga2 {
    /// The algorithm before its first generation.
    pub fn new(variables: Vec<Variable>, settings: Nsga2Settings, seed: u64) -> Self {
        Self {
            variables,
            settings,
            random: Random::new(seed),
            seed,
            population: Vec::new(),
        }
    }

    /// Binary tournament by rank, then crowding, then a coin.
    fn tournament(&mut self) -> usize {
        let a = self.random.below(self.population.len());
        let b = self.random.below(self.population.len());
        let coin = self.random.chance(0.5);
        let (first, second) = (&self.population[a], &self.population[b]);
        let better = first
            .rank
            .cmp(&second.rank)
            .then(second.crowding.total_cmp(&first.crowding));
        match better {
            std::cmp::Ordering::Less => a,
            std::cmp::Ordering::Greater => b,
            std::cmp::Ordering::Equal if coin => a,
            std::cmp::Ordering::Equal => b,
        }
    }

    fn children(&mut self) -> [Vec<f64>; 2] {
        let (a, b) = (self.tournament(), self.tournament());
        let mut pair = [
            self.population[a].candidate.x.clone(),
            self.population[b].candidate.x.clone(),
        ];
        if self.random.chance(self.settings.crossover) {
            self.cross(&mut pair);
        }
        for child in &mut pair {
            self.mutate(child);
        }
        pair
    }

    fn cross(&mut self, [first, second]: &mut [Vec<f64>; 2]) {
        for (k, variable) in self.variables.iter().enumerate() {
            // Each variable is exchanged or left with equal chance, as in Deb's own program.
            if !self.random.chance(0.5) {
                continue;
            }
            match *variable {
                Variable::Categorical { .. } => std::mem::swap(&mut first[k], &mut second[k]),
                Variable::Real { lower, upper } => {
                    let (low, high) = (first[k].min(second[k]), first[k].max(second[k]));
                    let share = self.random.uniform();
                    let swap = self.random.chance(0.5);
                    if high - low <= 1e-14 * (upper - lower) {
                        continue;
                    }
                    let spread = |room: f64| {
                        let beta = 1.0 + 2.0 * room / (high - low);
                        let index = self.settings.crossover_index + 1.0;
                        let alpha = 2.0 - libm::pow(beta, -index);
                        let base = if share <= 1.0 / alpha {
                            share * alpha
                        } else {
                            1.0 / (2.0 - share * alpha)
                        };
                        libm::pow(base, 1.0 / index)
                    };
                    let middle = 0.5 * (low + high);
                    let half = 0.5 * (high - low);
                    let below = (middle - spread(low - lower) * half).clamp(lower, upper);
                    let above = (middle + spread(upper - high) * half).clamp(lower, upper);
                    (first[k], second[k]) = if swap { (above, below) } else { (below, above) };
                }
            }
        }
    }

    fn mutate(&mut self, x: &mut [f64]) {
        let probability = self.settings.mutation.unwrap_or(1.0 / self.variables.len() as f64);
        for (value, variable) in x.iter_mut().zip(&self.variables) {
            if !self.random.chance(probability) {
                continue;
            }
            match *variable {
                Variable::Categorical { choices } => *value = self.random.below(choices) as f64,
                Variable::Real { lower, upper } => {
                    let range = upper - lower;
                    if range <= 0.0 {
                        continue;
                    }
                    let index = self.settings.mutation_index + 1.0;
                    let share = self.random.uniform();
                    let step = if share < 0.5 {
                        let room = 1.0 - (*value - lower) / range;
                        libm::pow(2.0 * share + (1.0 - 2.0 * share) * libm::pow(room, index), 1.0 / index) - 1.0
                    } else {
                        let room = 1.0 - (upper - *value) / range;
                        1.0 - libm::pow(
                            2.0 * (1.0 - share) + (2.0 * share - 1.0) * libm::pow(room, index),
                            1.0 / index,
                        )
                    };
                    *value = (*value + step * range).clamp(lower, upper);
                }
            }
        }
    }
}

impl Algorithm for Nsga2 {
    fn ask(&mut self) -> Vec<Vec<f64>> {
        let size = self.settings.population.max(2);
        if self.population.is_empty() {
            return doe::sobol(&self.variables, size, self.seed);
        }
        let mut offspring: Vec<Vec<f64>> = Vec::with_capacity(size);
        let mut draws = 0;
        while offspring.len() < size {
            for child in self.children() {
                let is_copy =
                    offspring.contains(&child) || self.population.iter().any(|member| member.candidate.x == child);
                if offspring.len() < size && (!is_copy || draws > PATIENCE * size) {
                    offspring.push(child);
                }
            }
            draws += 1;
        }
        offspring
    }

    fn tell(&mut self, evaluated: Vec<Evaluated>) {
        let pool: Vec<Evaluated> = self
            .population
            .drain(..)
            .map(|member| member.candidate)
            .chain(evaluated)
            .collect();
        self.population = survive(pool, self.settings.population.max(2));
    }
}

/// Best `size` of `pool` by rank, the last rank thinned by crowding.
fn survive(pool: Vec<Evaluated>, size: usize) -> Vec<Ranked> {
    let outcomes: Vec<Outcome> = pool.iter().map(|candidate| candidate.outcome).collect();
    let ranks = non_dominated_ranks(&outcomes);
    let mut crowding = vec![0.0; pool.len()];
    for rank in 0..=ranks.iter().copied().max().unwrap_or(0) {
        let front: Vec<usize> = (0..pool.len()).filter(|&i| ranks[i] == rank).collect();
        let objectives: Vec<[f64; 2]> = front.iter().map(|&i| outcomes[i].objectives).collect();
        for (&i, distance) in front.iter().zip(crowding_distances(&objectives)) {
            crowding[i] = distance;
        }
    }
    let mut order: Vec<usize> = (0..pool.len()).collect();
    order.sort_by(|&a, &b| {
        ranks[a]
            .cmp(&ranks[b])
            .then(crowding[b].total_cmp(&crowding[a]))
            .then(a.cmp(&b))
    });
    order.truncate(size);
    let mut pool: Vec<Option<Evaluated>> = pool.into_iter().map(Some).collect();
    order
        .into_iter()
        .filter_map(|i| {
            pool[i].take().map(|candidate| Ranked {
                candidate,
                rank: ranks[i],
                crowding: crowding[i],
            })
        })
        .collect()
}
