//! NSGA-II (Deb, Pratap, Agarwal, Meyarivan 2002) with constraint domination, for mixed variables.
//!
//! Real variables undergo simulated binary crossover and polynomial mutation. A categorical variable is taken from
//! either parent and redrawn with the probability of mutation. The first generation is a Sobol sample and counts as a
//! generation. A child that equals a member of the population or another child is not evaluated; a further pair of
//! parents is drawn instead.

use super::population::{PopulationMember, best, has_member, ranked, tournament};
use super::random::Random;
use super::variation::{cross, mutate};
use super::{Algorithm, Candidate, Evaluated, Variable, doe};

/// Parameters of [`Nsga2`].
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Nsga2Settings {
    /// Population size, at least 2.
    pub population: usize,
    /// Probability that a pair is crossed rather than copied.
    pub crossover: f64,
    /// Distribution index of the crossover: the larger it is, the closer the children are to their parents.
    pub crossover_index: f64,
    /// Mutation probability of a variable; `None` means the reciprocal of the number of variables.
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
    population: Vec<PopulationMember>,
}

/// Number of pairs of parents, per individual of the population, that are drawn before copies are accepted as
/// offspring.
const PATIENCE: usize = 50;

impl Nsga2 {
    /// Creates the algorithm in its state before the first generation.
    pub fn new(variables: Vec<Variable>, settings: Nsga2Settings, seed: u64) -> Self {
        Self {
            variables,
            settings,
            random: Random::new(seed),
            seed,
            population: Vec::new(),
        }
    }

    fn children(&mut self) -> [Vec<f64>; 2] {
        let [a, b] = [(); 2].map(|()| tournament(&mut self.random, &self.population));
        let mut pair = [
            self.population[a].candidate.x.clone(),
            self.population[b].candidate.x.clone(),
        ];
        if self.random.chance(self.settings.crossover) {
            cross(
                &mut self.random,
                &self.variables,
                self.settings.crossover_index,
                &mut pair,
            );
        }
        let probability = self.settings.mutation.unwrap_or(1.0 / self.variables.len() as f64);
        for child in &mut pair {
            let index = self.settings.mutation_index;
            mutate(&mut self.random, &self.variables, probability, index, child);
        }
        pair
    }
}

impl Algorithm for Nsga2 {
    fn ask(&mut self) -> Vec<Candidate> {
        let size = self.settings.population.max(2);
        if self.population.is_empty() {
            let sample = doe::sobol(&self.variables, size, self.seed);
            return sample.into_iter().map(Candidate::from).collect();
        }
        let mut offspring: Vec<Vec<f64>> = Vec::with_capacity(size);
        let mut draws = 0;
        while offspring.len() < size {
            for child in self.children() {
                let is_copy = offspring.contains(&child) || has_member(&self.population, &child);
                if offspring.len() < size && (!is_copy || draws > PATIENCE * size) {
                    offspring.push(child);
                }
            }
            draws += 1;
        }
        offspring.into_iter().map(Candidate::from).collect()
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

/// Keeps the best `size` candidates of `pool` by rank and, within the last rank kept, by crowding distance; with three objectives
/// by the distance to the nearest member, because the crowding distance says little then.
fn survive(pool: Vec<Evaluated>, size: usize) -> Vec<PopulationMember> {
    if pool.first().is_some_and(|first| first.outcome.objectives.len() > 2) {
        return ranked(best(pool, size));
    }
    let mut members = ranked(pool);
    // The sort is stable: among equals the older member is kept.
    members.sort_by(|a, b| a.rank.cmp(&b.rank).then(b.crowding.total_cmp(&a.crowding)));
    members.truncate(size);
    members
}
