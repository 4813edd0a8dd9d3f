//! The `front-de` algorithm: differential evolution along the front, which can exploit the structure of a problem.
//!
//! With two objectives the best candidates lie on a curve in objective space, and their variables lie on a piecewise
//! curve as well; with three, both lie on surfaces. The population is therefore kept in the order of the front, and differences
//! are taken between neighbours only (Storn and Price 1997): such differences point along the curve and shrink with the width of the
//! population around it, whereas differences between the far ends do not. Survivors are selected by non-domination and
//! crowding (Deb et al. 2002; the crowding distances are recomputed after each removal), as in GDE3 (Kukkonen and
//! Lampinen 2005); with three objectives by the distance to the nearest member instead. The population starts small, to find the front, and grows to cover it.
//!
//! - **Structure**: each candidate has a target, which is either the best leveled objective (by default the second) that its
//!   other variables allow or a level of it, obtained from the levels of its parents by the same difference. A
//!   problem that can [complete](super::Problem::complete) candidates solves part of the search itself; other problems
//!   ignore the target.
//! - **Categories**: each combination of the categorical variables is a niche with its own population, because
//!   differences between candidates of different categories have no meaning. Evaluations go mainly to the niches whose
//!   candidates reach the common front. Every niche receives a small fraction, so that no niche is given up early; the
//!   fraction is small, so that few evaluations are spent on niches that no longer contribute.
//! - **Learning**: where the problem determines variables, both objectives are smooth functions of the few that are left free,
//!   as long as each candidate has the best level that they allow. Most candidates are then proposed by a local model: a gap of
//!   the niche's front is drawn by its area, the logarithm of the first objective and the level are fitted as
//!   quadratics to the nearest candidates, and the best of many trial points is asked for. Some candidates extend an end
//!   of the front instead, and a few are random. Problems whose variables are not determined are searched without a model.
//! - **Crossover**: where differences do not help (many local fronts, separable variables), simulated binary crossover
//!   and polynomial mutation do. The probability of each of the two operators follows its recent success: with two objectives,
//!   how often its candidates reach the common front; with three, where almost every candidate does, how often they dominate one of its
//!   members.

mod gaps;
mod learner;
mod niche;
mod operators;
mod quadratic;

use learner::Learner;
use niche::{Niche, along_front, nearest};

use super::categories::{combinations, set_categories};
use super::population::best;
use super::random::Random;
use super::{Algorithm, Archive, Candidate, Evaluated, Problem, Target, Variable, doe};

/// Parameters of [`FrontDe`].
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FrontDeSettings {
    /// Number of candidates of a generation, at least 2. The first sample has as many, but at least four per niche.
    pub generation: usize,
    /// Initial size of a population, at least 4; three times as many with three objectives.
    pub population: usize,
    /// Number of evaluations of a niche after which its population grows by one member, at least 1; three times as many with three
    /// objectives.
    pub growth: usize,
    /// Largest size of a population, at least 4.
    pub most: usize,
    /// Number of neighbours on either side along the front, at least 1.
    pub neighbours: usize,
    /// Scale factor of the differences.
    pub scale: f64,
    /// Probability that a variable takes part in a difference.
    pub crossover: f64,
    /// Fraction of candidates whose target is the best second objective that their other variables allow, rather than a
    /// level.
    pub best: f64,
    /// Fraction of candidates that a local model of the front proposes, if the problem determines variables.
    pub learned: f64,
}

impl Default for FrontDeSettings {
    fn default() -> Self {
        Self {
            generation: 30,
            population: 20,
            growth: 40,
            most: 100,
            neighbours: 10,
            scale: 0.5,
            crossover: 0.9,
            best: 0.7,
            learned: 0.95,
        }
    }
}

/// Smallest probability with which a niche, or one of the two operators, is drawn for a candidate.
const MIN_PROBABILITY: f64 = 0.03;

/// Smallest probability with which a niche is drawn where it learns: a few candidates suffice to see whether its ends matter.
const MIN_LEARNING: f64 = 0.05;

/// Probability that a candidate is random where niches learn, before the first evaluation; it is half of this after [`EXPLORED`].
const RANDOM: f64 = 0.1;
const EXPLORED: f64 = 1000.0;

/// Probability that a proposed candidate is to extend the front past an end, before the first evaluation of a niche; it is half of this
/// after [`EXTENDED`].
const PAST: f64 = 0.15;
const EXTENDED: f64 = 1500.0;

/// The same for a niche none of whose candidates reach the common front: only its ends may still do so. From a success of
/// [`SUCCESSFUL`] on it does not matter.
const PAST_OF_FAILING: f64 = 0.5;
const SUCCESSFUL: f64 = 0.2;

/// Weight of one candidate in the exponential moving averages of the success of its niche and of its operator.
const MEMORY: f64 = 0.02;

/// Factor of the initial size of a population with three objectives, and of the evaluations after which it grows.
const SURFACE: usize = 3;

/// The algorithm's state between generations.
#[derive(Debug, Clone)]
pub struct FrontDe {
    variables: Vec<Variable>,
    settings: FrontDeSettings,
    random: Random,
    seed: u64,
    niches: Vec<Niche>,
    ways: [Success; 2],
    /// How each candidate of the current generation was made.
    pending: Vec<Origin>,
    archive: Archive,
    evaluated: usize,
    /// Place of the objective to which levels apply.
    leveled: usize,
}

/// How a candidate was made.
#[derive(Debug, Clone, Copy)]
struct Origin {
    niche: usize,
    /// The operator; `None` for a candidate drawn without one.
    way: Option<usize>,
    target: Option<Target>,
}

/// Exponential moving average of the fraction of candidates that reached the common front, or dominated a member of it.
#[derive(Debug, Clone, Copy)]
struct Success(f64);

impl Success {
    const UNKNOWN: Success = Success(0.5);

    fn learn(&mut self, succeeded: bool) {
        self.0 += MEMORY * (f64::from(u8::from(succeeded)) - self.0);
    }
}

impl FrontDe {
    /// Creates the algorithm in its state before the first generation, for a problem without structure.
    pub fn new(variables: Vec<Variable>, settings: FrontDeSettings, seed: u64) -> Self {
        let niches = combinations(&variables).into_iter().map(Niche::new).collect();
        Self {
            variables,
            settings,
            random: Random::new(seed),
            seed,
            niches,
            ways: [Success::UNKNOWN; 2],
            pending: Vec::new(),
            archive: Archive::default(),
            evaluated: 0,
            leveled: 1,
        }
    }

    /// Creates the algorithm for a problem with the structure that it states: the objective to which levels apply
    /// ([`leveled_objective`](super::Problem::leveled_objective)), and the variables that it determines
    /// ([`determined_variables`](super::Problem::determined_variables)). If there are any, the algorithm learns how the objectives
    /// depend on the others.
    pub fn for_problem(problem: &impl Problem, settings: FrontDeSettings, seed: u64) -> Self {
        let mut algorithm = Self::new(problem.variables(), settings, seed);
        algorithm.leveled = problem.leveled_objective();
        let learned = problem.learned_objective();
        let determined = problem.determined_variables();
        if !determined.is_empty() && settings.learned > 0.0 {
            for niche in &mut algorithm.niches {
                niche.learner = Learner::new(&algorithm.variables, &determined, learned);
            }
        }
        algorithm
    }

    /// Returns the level of a member; `None` if no objective has levels.
    fn level_of(&self, member: &Evaluated) -> Option<f64> {
        member.outcome.objectives.get(self.leveled).copied()
    }

    /// Returns the first sample: a Sobol sample whose candidates are assigned to the niches in turn.
    fn sample(&mut self) -> Vec<Candidate> {
        let count = self.settings.generation.max(2).max(4 * self.niches.len());
        let mut sample = doe::sobol(&self.variables, count, self.seed);
        let target = Some(Target::Best);
        for (index, x) in sample.iter_mut().enumerate() {
            let niche = index % self.niches.len();
            self.pending.push(Origin {
                niche,
                way: None,
                target,
            });
            set_categories(&self.variables, x, &self.niches[niche].categories);
        }
        sample.into_iter().map(Candidate::seeking_best).collect()
    }

    /// Draws an index with a probability in proportion to the success, but at least `least` for each.
    fn draw(&mut self, successes: &[Success], least: f64) -> usize {
        let sum: f64 = successes.iter().map(|success| success.0).sum();
        let count = successes.len();
        let least = least.min(1.0 / count as f64);
        let mut draw = self.random.uniform();
        for (index, success) in successes.iter().enumerate() {
            let fraction = if sum > 0.0 { success.0 / sum } else { 1.0 / count as f64 };
            draw -= least + (1.0 - count as f64 * least) * fraction;
            if draw < 0.0 {
                return index;
            }
        }
        count - 1
    }

    /// Makes a candidate, and notes how.
    fn child(&mut self) -> Candidate {
        let successes: Vec<Success> = self.niches.iter().map(|niche| niche.success).collect();
        let learns = self.niches.iter().any(Niche::can_propose);
        let niche = self.draw(&successes, if learns { MIN_LEARNING } else { MIN_PROBABILITY });
        let (candidate, way) = if self.niches[niche].population.len() < 4 {
            (self.random_candidate(niche), None)
        } else if let Some(candidate) = self.learned(niche) {
            (candidate, None)
        } else {
            let way = self.draw(&self.operator_weights(niche), MIN_PROBABILITY);
            (self.offspring(niche, way), Some(way))
        };
        let target = candidate.target;
        self.pending.push(Origin { niche, way, target });
        candidate
    }

    /// Returns a candidate that a niche proposes from what it has learned, or a random one; `None` if the operators are to
    /// make it.
    fn learned(&mut self, niche: usize) -> Option<Candidate> {
        if !self.niches[niche].can_propose() {
            return None;
        }
        if self.random.chance(RANDOM / (1.0 + self.evaluated as f64 / EXPLORED)) {
            return Some(self.random_candidate(niche));
        }
        if !self.random.chance(self.settings.learned) {
            return None;
        }
        let niche = &mut self.niches[niche];
        let failing = (1.0 - niche.success.0 / SUCCESSFUL).max(0.0);
        let past = (PAST / (1.0 + niche.evaluated as f64 / EXTENDED)).max(PAST_OF_FAILING * failing);
        let x = niche.learner.as_mut()?.propose(&mut self.random, &self.archive, past)?;
        Some(Candidate::seeking_best(x))
    }

    /// Returns a uniformly distributed random candidate of a niche.
    fn random_candidate(&mut self, niche: usize) -> Candidate {
        let mut x: Vec<f64> = self
            .variables
            .iter()
            .map(|variable| match *variable {
                Variable::Real { lower, upper } => lower + self.random.uniform() * (upper - lower),
                Variable::Categorical { .. } => 0.0,
            })
            .collect();
        set_categories(&self.variables, &mut x, &self.niches[niche].categories);
        Candidate::seeking_best(x)
    }
}

impl Algorithm for FrontDe {
    fn ask(&mut self) -> Vec<Candidate> {
        self.pending.clear();
        if self.evaluated == 0 {
            return self.sample();
        }
        (0..self.settings.generation.max(2)).map(|_| self.child()).collect()
    }

    fn tell(&mut self, evaluated: Vec<Evaluated>) {
        let mut offspring: Vec<Vec<Evaluated>> = vec![Vec::new(); self.niches.len()];
        let is_surface = evaluated
            .first()
            .is_some_and(|first| first.outcome.objectives.len() > 2);
        for (candidate, &Origin { niche, way, target }) in evaluated.into_iter().zip(&self.pending) {
            if let Some(learner) = &mut self.niches[niche].learner {
                learner.learn(self.evaluated, &candidate, target);
            }
            let known = self.archive.len();
            let reached = self.archive.insert(self.evaluated, &candidate.x, &candidate.outcome);
            self.evaluated += 1;
            self.niches[niche].evaluated += 1;
            self.niches[niche].success.learn(reached);
            if let Some(way) = way {
                self.ways[way].learn(reached && (!is_surface || self.archive.len() <= known));
            }
            offspring[niche].push(candidate);
        }
        let settings = &self.settings;
        let scale = if is_surface { SURFACE } else { 1 };
        for (niche, offspring) in self.niches.iter_mut().zip(offspring) {
            if !offspring.is_empty() {
                let size = (scale * settings.population).max(4) + niche.evaluated / (scale * settings.growth.max(1));
                let members = niche.population.drain(..).map(|member| member.candidate);
                let pool = members.chain(offspring).collect();
                niche.population = along_front(best(pool, size.min(settings.most.max(4))));
                niche.nearest = nearest(&niche.population, 2 * settings.neighbours.max(1) + 1);
            }
        }
    }
}
