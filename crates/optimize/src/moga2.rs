//! MOGA-II (reimplementation), from its public descriptions (Poles 2003; Poles, Rigoni, Robič 2004).
//!
//! MOGA-II is proprietary. The following is publicly known. The algorithm keeps a population `P`, which starts from the
//! design of experiments, and an elite set `E`, which starts empty. In each generation `P ∪ E` is reduced at random to
//! `|P|` individuals, and one operator is drawn for each individual: directional crossover, mutation, selection, or
//! otherwise classical crossover. Non-dominated offspring enter `E`, dominated and duplicate members leave it, and `E`
//! is reduced at random to `|P|`. Directional crossover moves an individual along its differences to two reference
//! individuals, found by random walks on a toroidal grid, away from worse ones and towards better ones. Constraints are
//! handled by a penalty.
//!
//! The descriptions leave some details open. This implementation makes the following choices:
//!
//! - **Bits**: a real variable is encoded in 16 plain binary bits over its range, a categorical one in ⌈log₂ choices⌉
//!   bits. Variables are encoded only for mutation and classical crossover; until then values between the steps of the
//!   code are kept.
//! - **Categorical variables** such as the architecture `d`: a flipped bit redraws the variable uniformly among the
//!   other choices, so that no choice is favoured if their number is not a power of two. The first sample gives each
//!   choice an equal interval of \[0, 1). Directional crossover takes the value of the individual or of one of its two
//!   references, drawn at random.
//! - **Mutation** flips `⌈mutation_ratio · bits⌉` distinct bits of the whole string, drawn at random.
//! - **Classical crossover** is one-point crossover on the string with a partner drawn from the population; the first
//!   child is kept.
//! - **Grid**: the individuals are placed row by row, in their current order, on a torus of ⌊√P⌋ columns. A walk takes
//!   [`WALK`] steps, each to one of the four neighbours, and returns the best individual visited, the first among
//!   equals.
//! - **Better and worse** are defined by dominance of the penalised objectives; for incomparable individuals the
//!   direction is drawn at random.
//! - **Values out of bounds** are set to the bound.
//! - **Penalty**: `penalty · violation` is added to both objectives.
//! - **Generations**: the first sample counts as generation 1 of the budget: 30 individuals and 200 generations give
//!   6000 evaluations.
//! - **Selection** copies an individual; the copy is evaluated and counted again like any other offspring.

use super::dominance::{Relation, pareto};
use super::random::Random;
use super::{Algorithm, Candidate, Evaluated, Objectives, Variable, doe};

/// Number of bits that encode a real variable.
const REAL_BITS: u32 = 16;

/// Number of steps of a random walk.
pub const WALK: usize = 3;

/// Parameters of [`Moga2`]; the defaults are the paper's values; the paper does not state the penalty.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Moga2Settings {
    /// Population size, which is also the size of the first sample; at least 2.
    pub population: usize,
    /// Probability of directional crossover.
    pub directional_crossover: f64,
    /// Probability of selection.
    pub selection: f64,
    /// Probability of mutation.
    pub mutation: f64,
    /// Fraction of the string's bits that a mutation flips.
    pub mutation_ratio: f64,
    /// Penalty that is added to both objectives per unit of violation.
    pub penalty: f64,
}

impl Default for Moga2Settings {
    fn default() -> Self {
        Self {
            population: 30,
            directional_crossover: 0.5,
            selection: 0.05,
            mutation: 0.1,
            mutation_ratio: 0.05,
            penalty: 1e6,
        }
    }
}

/// The algorithm's state between generations.
#[derive(Debug, Clone)]
pub struct Moga2 {
    variables: Vec<Variable>,
    settings: Moga2Settings,
    random: Random,
    seed: u64,
    population: Vec<Individual>,
    elite: Vec<Individual>,
}

#[derive(Debug, Clone, PartialEq)]
struct Individual {
    x: Vec<f64>,
    /// Objectives with the penalty added.
    objectives: Objectives,
}

impl Moga2 {
    /// Creates the algorithm in its state before the first generation.
    pub fn new(variables: Vec<Variable>, settings: Moga2Settings, seed: u64) -> Self {
        Self {
            variables,
            settings,
            random: Random::new(seed),
            seed,
            population: Vec::new(),
            elite: Vec::new(),
        }
    }

    fn offspring(&mut self, index: usize) -> Vec<f64> {
        let draw = self.random.uniform();
        let settings = self.settings;
        let mutation = settings.directional_crossover + settings.mutation;
        if draw < settings.directional_crossover {
            self.directional(index)
        } else if draw < mutation {
            self.mutated(index)
        } else if draw < mutation + settings.selection {
            self.population[index].x.clone()
        } else {
            self.classical(index)
        }
    }

    fn directional(&mut self, index: usize) -> Vec<f64> {
        let references = [self.walk(index), self.walk(index)];
        let signs = references.map(|reference| self.sign(index, reference));
        let draws = [self.random.uniform(), self.random.uniform()];
        let lineage = [index, references[0], references[1]];
        (0..self.variables.len())
            .map(|k| {
                let value = |individual: usize| self.population[individual].x[k];
                match self.variables[k] {
                    Variable::Categorical { .. } => value(lineage[self.random.below(lineage.len())]),
                    Variable::Real { lower, upper } => {
                        let own = value(index);
                        let moved = own
                            + draws[0] * signs[0] * (own - value(references[0]))
                            + draws[1] * signs[1] * (own - value(references[1]));
                        moved.clamp(lower, upper)
                    }
                }
            })
            .collect()
    }

    /// Returns +1 if the individual dominates the reference, −1 if the reference dominates it, else either at random.
    fn sign(&mut self, individual: usize, reference: usize) -> f64 {
        let coin = if self.random.chance(0.5) { 1.0 } else { -1.0 };
        let relation = pareto(
            &self.population[individual].objectives,
            &self.population[reference].objectives,
        );
        match relation {
            Relation::Dominates => 1.0,
            Relation::Dominated => -1.0,
            Relation::Incomparable => coin,
        }
    }

    /// Returns the best individual visited on a random walk over the torus; the start is excluded.
    fn walk(&mut self, start: usize) -> usize {
        let count = self.population.len();
        let columns = (1..)
            .take_while(|columns| columns * columns <= count)
            .last()
            .unwrap_or(1);
        let steps = [1, count - 1, columns, count - columns % count];
        let mut place = start;
        let mut best: Option<usize> = None;
        for _ in 0..WALK {
            place = (place + steps[self.random.below(steps.len())]) % count;
            let better = best.is_none_or(|best| {
                pareto(&self.population[place].objectives, &self.population[best].objectives) == Relation::Dominates
            });
            if place != start && better {
                best = Some(place);
            }
        }
        best.unwrap_or(place)
    }

    fn bits(variable: &Variable) -> u32 {
        match *variable {
            Variable::Real { .. } => REAL_BITS,
            Variable::Categorical { choices } => usize::BITS - (choices.max(1) - 1).leading_zeros(),
        }
    }

    fn encode(value: f64, lower: f64, upper: f64) -> u32 {
        let steps = f64::from((1u32 << REAL_BITS) - 1);
        if upper > lower {
            ((value - lower) / (upper - lower) * steps).round() as u32
        } else {
            0
        }
    }

    fn decode(code: u32, lower: f64, upper: f64) -> f64 {
        let steps = f64::from((1u32 << REAL_BITS) - 1);
        (lower + f64::from(code) / steps * (upper - lower)).clamp(lower, upper)
    }

    fn mutated(&mut self, index: usize) -> Vec<f64> {
        let total: u32 = self.variables.iter().map(Self::bits).sum();
        let mut places: Vec<u32> = (0..total).collect();
        self.random.shuffle(&mut places);
        places.truncate((self.settings.mutation_ratio * f64::from(total)).ceil() as usize);
        let mut x = self.population[index].x.clone();
        let mut first = 0;
        for (value, variable) in x.iter_mut().zip(&self.variables) {
            let bits = Self::bits(variable);
            let mask = places
                .iter()
                .filter(|place| (first..first + bits).contains(*place))
                .fold(0u32, |mask, place| mask | 1 << (place - first));
            first += bits;
            match *variable {
                _ if mask == 0 => {}
                Variable::Real { lower, upper } => {
                    *value = Self::decode(Self::encode(*value, lower, upper) ^ mask, lower, upper);
                }
                Variable::Categorical { choices } => {
                    let other = self.random.below(choices - 1);
                    *value = (other + usize::from(other >= *value as usize)) as f64;
                }
            }
        }
        x
    }

    /// Performs one-point crossover on the bit strings: the bits before the point come from the individual, the others
    /// from its partner.
    fn classical(&mut self, index: usize) -> Vec<f64> {
        let partner = self.random.below(self.population.len());
        let total: u32 = self.variables.iter().map(Self::bits).sum();
        let point = self.random.below(total as usize + 1) as u32;
        let (own, other) = (&self.population[index].x, &self.population[partner].x);
        let mut first = 0;
        self.variables
            .iter()
            .enumerate()
            .map(|(k, variable)| {
                let bits = Self::bits(variable);
                // Number of bits of this variable before the point; its most significant bits come first.
                let kept = point.saturating_sub(first).min(bits);
                first += bits;
                match *variable {
                    Variable::Real { lower, upper } if kept > 0 && kept < bits => {
                        let low = (1u32 << (bits - kept)) - 1;
                        let code =
                            (Self::encode(own[k], lower, upper) & !low) | (Self::encode(other[k], lower, upper) & low);
                        Self::decode(code, lower, upper)
                    }
                    // A choice cannot be split: it comes from the parent that contributes more of its bits.
                    _ if 2 * kept >= bits => own[k],
                    _ => other[k],
                }
            })
            .collect()
    }

    fn admit(&mut self, individual: &Individual) {
        let beaten = |other: &Individual| {
            pareto(&other.objectives, &individual.objectives) == Relation::Dominates
                || other.objectives == individual.objectives
        };
        if !self.elite.iter().any(beaten) {
            self.elite
                .retain(|other| pareto(&individual.objectives, &other.objectives) != Relation::Dominates);
            self.elite.push(individual.clone());
        }
    }
}

impl Algorithm for Moga2 {
    fn ask(&mut self) -> Vec<Candidate> {
        let size = self.settings.population.max(2);
        if self.population.is_empty() {
            let sample = doe::sobol(&self.variables, size, self.seed);
            return sample.into_iter().map(Candidate::from).collect();
        }
        let mut pool = std::mem::take(&mut self.population);
        pool.extend(self.elite.iter().cloned());
        self.random.shuffle(&mut pool);
        pool.truncate(size);
        self.population = pool;
        (0..self.population.len())
            .map(|index| self.offspring(index).into())
            .collect()
    }

    fn tell(&mut self, evaluated: Vec<Evaluated>) {
        let penalty = self.settings.penalty;
        let offspring: Vec<Individual> = evaluated
            .into_iter()
            .map(|candidate| Individual {
                objectives: Objectives::new(
                    candidate
                        .outcome
                        .objectives
                        .iter()
                        .map(|objective| objective + penalty * candidate.outcome.violation),
                ),
                x: candidate.x,
            })
            .collect();
        for individual in &offspring {
            self.admit(individual);
        }
        self.random.shuffle(&mut self.elite);
        self.elite.truncate(self.settings.population.max(2));
        self.population = offspring;
    }
}
