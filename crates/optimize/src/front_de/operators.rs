//! The two operators: differences between neighbours along the front, and crossover with mutation.

use super::{FrontDe, Success};
use crate::categories::set_categories;
use crate::population::{has_member, tournament};
use crate::variation::{cross, mutate};
use crate::{Candidate, Evaluated, Target, Variable};

/// Power of the success by which an operator is drawn with three objectives.
const SHARPNESS: f64 = 8.0;

/// Number of times that a candidate is made again with three objectives because it is a member already.
const PATIENCE: usize = 20;

/// Probability that two parents are crossed before mutation.
const CROSSED: f64 = 0.9;

/// Distribution indices of the crossover and of the mutation.
const INDICES: [f64; 2] = [15.0, 20.0];

impl FrontDe {
    /// Returns a candidate that one of the two operators makes. With three objectives, it is made again while it is a copy of a member, which
    /// would be a neighbour without a distance.
    pub(super) fn offspring(&mut self, niche: usize, way: usize) -> Candidate {
        let mut made = self.varied(niche, way);
        for _ in 0..PATIENCE {
            let of_niche = &self.niches[niche];
            if !of_niche.is_on_surface() || !has_member(&of_niche.population, &made.x) {
                break;
            }
            made = self.varied(niche, way);
        }
        made
    }

    /// Returns a candidate that one of the two operators makes.
    fn varied(&mut self, niche: usize, way: usize) -> Candidate {
        let size = self.niches[niche].population.len();
        let place = self.random.below(size);
        let seeks_best = self.random.chance(self.settings.best);
        let (x, level) = if way == 0 {
            self.difference(niche, place)
        } else {
            self.crossed(niche)
        };
        let target = match level {
            Some(level) if !seeks_best => Target::Level(level),
            _ => Target::Best,
        };
        Candidate {
            x,
            target: Some(target),
        }
    }

    /// Returns the weights with which the operators are drawn. On a surface the better operator succeeds only somewhat more often, so that
    /// their success is sharpened.
    pub(super) fn operator_weights(&self, niche: usize) -> [Success; 2] {
        if self.niches[niche].is_on_surface() {
            self.ways.map(|Success(share)| Success(libm::pow(share, SHARPNESS)))
        } else {
            self.ways
        }
    }

    /// Draws a place near `place` along the front; with three objectives, one of the members that are nearest in them.
    fn near(&mut self, niche: usize, place: usize) -> usize {
        let size = self.niches[niche].population.len();
        // A smaller reach would leave no two other members to take a difference of.
        let reach = self.settings.neighbours.max(1);
        if 2 * reach + 1 >= size {
            return self.random.below(size);
        }
        if let Some(nearest) = self.niches[niche].nearest.get(place) {
            return nearest[self.random.below(2 * reach + 1)];
        }
        let first = place.saturating_sub(reach).min(size - 2 * reach - 1);
        first + self.random.below(2 * reach + 1)
    }

    /// Moves the member at `place`, or a neighbour of it, by the scaled difference of two other neighbours. Returns the
    /// new variables and the level of the second objective that the same difference leads to; the level is `None`
    /// unless all three members are feasible.
    fn difference(&mut self, niche: usize, place: usize) -> (Vec<f64>, Option<f64>) {
        let base = if self.random.chance(0.5) {
            place
        } else {
            self.near(niche, place)
        };
        let (mut to, mut from) = (self.near(niche, place), self.near(niche, place));
        while to == base {
            to = self.near(niche, place);
        }
        while from == base || from == to {
            from = self.near(niche, place);
        }
        let forced = self.random.below(self.variables.len());
        let population = &self.niches[niche].population;
        let mut x = population[place].candidate.x.clone();
        let [base, to, from] = [base, to, from].map(|place| &population[place].candidate);
        for (k, variable) in self.variables.iter().enumerate() {
            if let Variable::Real { lower, upper } = *variable
                && (k == forced || self.random.chance(self.settings.crossover))
            {
                let moved = base.x[k] + self.settings.scale * (to.x[k] - from.x[k]);
                // A value beyond a bound is redrawn between the bound and the base, so that the bound is not favoured.
                x[k] = if moved < lower {
                    lower + self.random.uniform() * (base.x[k] - lower)
                } else if moved > upper {
                    upper - self.random.uniform() * (upper - base.x[k])
                } else {
                    moved
                };
            }
        }
        let level = |member: &Evaluated| self.level_of(member).filter(|_| member.outcome.is_feasible());
        let moved = match [level(base), level(to), level(from)] {
            [Some(base), Some(to), Some(from)] => Some(base + self.settings.scale * (to - from)),
            _ => None,
        };
        (x, moved)
    }

    /// Crosses two members selected by tournament and mutates the result. Returns the new variables and the second
    /// objective of the first parent, or `None` if that parent is infeasible.
    fn crossed(&mut self, niche: usize) -> (Vec<f64>, Option<f64>) {
        let population = &self.niches[niche].population;
        let parents = [(); 2].map(|()| &population[tournament(&mut self.random, population)].candidate);
        let (outcome, level) = (parents[0].outcome, self.level_of(parents[0]));
        let mut pair = parents.map(|parent| parent.x.clone());
        if self.random.chance(CROSSED) {
            cross(&mut self.random, &self.variables, INDICES[0], &mut pair);
        }
        let [mut x, _] = pair;
        let probability = 1.0 / self.variables.len() as f64;
        mutate(&mut self.random, &self.variables, probability, INDICES[1], &mut x);
        set_categories(&self.variables, &mut x, &self.niches[niche].categories);
        (x, level.filter(|_| outcome.is_feasible()))
    }
}
