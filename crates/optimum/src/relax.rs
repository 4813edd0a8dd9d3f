//! Why a wished value of the objective cannot be had: what each requirement would have to give for it.

use kinefront_model::evaluation::{Better, Bound, PoseScalar};
use kinefront_model::mechanism::Design;

use super::parameter::Parameter;
use super::polished::Polished;
use super::prices::Price;
use super::problem::LocalProblem;
use super::question::LocalQuestion;

/// Largest change of the logarithm of a requirement: a factor of 20.
pub(crate) const MOST: f64 = 2.995_732_273_553_991;

/// Largest change of the logarithm of a requirement from one optimum to the next.
const STEP: f64 = 0.5;

/// Accuracy of the logarithm of the objective.
const ACCURACY: f64 = 1e-7;

/// Largest number of secants.
const SECANTS: usize = 30;

/// Prices below this leave a requirement out.
const FREE: f64 = 1e-9;

/// What gives.
#[derive(Debug, Clone, PartialEq)]
pub enum RelaxationOf {
    /// One requirement.
    Single(Parameter),
    /// All limits of scalars, by the same factor.
    AllThresholds,
    /// The limits of scalars and the rotation range, each in proportion to its price: the least change in all.
    LeastNorm,
}

/// What a requirement would have to give for a wished value of the objective.
#[derive(Debug, Clone)]
pub struct Relaxation {
    /// What gives.
    pub of: RelaxationOf,
    /// The factor by the prices alone; for the least change, of a change of unit length.
    pub linear: Option<f64>,
    /// The factor that is needed; `None` if no factor down to 1/20 suffices.
    pub needed: Option<f64>,
    /// The objective with that factor, or the best that can be had.
    pub objective: f64,
    /// The design that has it.
    pub design: Design,
    /// Its home orientation \[rad\].
    pub home: f64,
}

impl LocalProblem {
    /// Returns what each requirement with a price, and all together, would have to give for a wished value of the objective.
    pub fn relaxations(&self, polished: &Polished, prices: &[Price], wished: f64) -> Vec<Relaxation> {
        let way = |price: &Price| (price.parameter, way_of(self.question(), price.parameter));
        let single = prices
            .iter()
            .filter(|price| price.parameter.kind().is_requirement() && price.price.abs() > FREE)
            .map(|price| (RelaxationOf::Single(price.parameter), vec![way(price)]));
        let thresholds = prices.iter().filter(|price| is_factor(price, self.question()));
        let all: Vec<(Parameter, f64)> = thresholds.clone().map(way).collect();
        let all = (all.len() > 1).then_some((RelaxationOf::AllThresholds, all));
        let rotation = prices
            .iter()
            .filter(|price| price.parameter == Parameter::RotationRange);
        let in_norm: Vec<&Price> = thresholds.chain(rotation).collect();
        let norm = in_norm
            .iter()
            .map(|price| price.price * price.price)
            .sum::<f64>()
            .sqrt();
        let share = |price: &&Price| (price.parameter, -self.goal_sign() * price.price / norm.max(FREE));
        let least = (RelaxationOf::LeastNorm, in_norm.iter().map(share).collect());
        single
            .chain(all)
            .chain([least])
            .filter_map(|(of, weights)| {
                let price = |parameter: Parameter| prices.iter().find(|price| price.parameter == parameter);
                let rates = weights
                    .iter()
                    .filter_map(|(parameter, weight)| Some(price(*parameter)?.price * weight));
                let rate = self.goal_sign() * rates.sum::<f64>();
                (rate.abs() > FREE).then(|| self.relaxed(polished, of, &weights, rate, wished))
            })
            .collect()
    }

    /// Solves for the change at which the objective has its wished value: `weights` are the changes of the logarithms of the parameters
    /// for a change of 1, and `rate` is the change of the minimised logarithm by the prices.
    fn relaxed(
        &self,
        polished: &Polished,
        of: RelaxationOf,
        weights: &[(Parameter, f64)],
        rate: f64,
        wished: f64,
    ) -> Relaxation {
        let way = Way {
            problem: self,
            weights,
            wished,
        };
        let linear = -way.short(polished) / rate;
        let (near, beyond) = way.bracket(polished, linear);
        let is_enough = beyond.is_some();
        let at = match beyond {
            Some(beyond) => way.narrowed(near, beyond),
            None => near,
        };
        // A factor is that of the parameter itself; of several, that of a requirement from below.
        let sign = match of {
            RelaxationOf::Single(_) => weights[0].1,
            _ => -1.0,
        };
        let factor = |change: f64| libm::exp(sign * change);
        Relaxation {
            linear: Some(factor(linear)).filter(|factor| factor.is_finite() && *factor > 0.0),
            needed: is_enough.then(|| factor(at.change)),
            objective: at.found.objective,
            design: at.found.design,
            home: at.found.home,
            of,
        }
    }
}

/// The optima on the way to a wished value of the objective.
struct Way<'a> {
    problem: &'a LocalProblem,
    /// The parameters that change, each with the change of its logarithm for a change of 1.
    weights: &'a [(Parameter, f64)],
    wished: f64,
}

/// An optimum on the way.
struct Point {
    change: f64,
    found: Polished,
    /// Logarithm by which the minimised value exceeds the wished one.
    short: f64,
}

impl Way<'_> {
    fn short(&self, found: &Polished) -> f64 {
        self.problem.goal_sign() * (self.problem.log_of(found) - libm::log(self.wished))
    }

    fn point(&self, from: &Polished, change: f64) -> Option<Point> {
        let found = self
            .problem
            .after(from, self.weights, change)
            .filter(Polished::is_optimal)?;
        Some(Point {
            change,
            short: self.short(&found),
            found,
        })
    }

    /// Follows the optimum until it has the wished value, at most to a factor of 20: returns the last one that does not have it, and the
    /// first one that does. `linear` is the change that the prices promise.
    fn bracket(&self, start: &Polished, linear: f64) -> (Point, Option<Point>) {
        let deficit = self.short(start);
        let mut near = Point {
            change: 0.0,
            found: start.clone(),
            short: deficit,
        };
        let mut change = linear.clamp(0.0, STEP);
        while near.change < MOST {
            let Some(next) = self.point(&near.found, change) else {
                // A step that fails is tried shorter.
                let shorter = 0.5 * (change - near.change);
                if shorter < 1e-3 {
                    break;
                }
                change = near.change + shorter;
                continue;
            };
            if next.short <= ACCURACY {
                return (near, Some(next));
            }
            // The requirement is no longer active.
            let is_free = (near.short - next.short).abs() < 1e-9 && next.change - near.change > 0.4;
            near = next;
            if is_free {
                break;
            }
            let gained = deficit - near.short;
            let guess = if gained > 1e-12 {
                near.change * deficit / gained
            } else {
                MOST
            };
            change = guess.clamp(near.change + 0.02, near.change + STEP).min(MOST);
        }
        (near, None)
    }

    /// Returns the optimum that has the wished value, by secants between two that enclose it.
    fn narrowed(&self, mut near: Point, mut beyond: Point) -> Point {
        for _ in 0..SECANTS {
            if beyond.short.abs() <= ACCURACY {
                break;
            }
            let share = near.short / (near.short - beyond.short);
            let middle = near.change + share.clamp(0.02, 0.98) * (beyond.change - near.change);
            match self.point(&beyond.found, middle) {
                Some(next) if next.short > ACCURACY => near = next,
                Some(next) => beyond = next,
                None => break,
            }
        }
        beyond
    }
}

/// Returns the change of the logarithm of a parameter that asks for less: −1 for a requirement from below, 1 for one from above.
pub(crate) fn way_of(question: &LocalQuestion, parameter: Parameter) -> f64 {
    let better_is_higher = match parameter {
        Parameter::Threshold(scalar) => scalar.entry().quantity.better == Better::Higher,
        Parameter::Limit(place) => matches!(question.settings.limits[place].bound, Bound::AtLeast(_)),
        _ => true,
    };
    if better_is_higher { -1.0 } else { 1.0 }
}

/// Returns whether a price is of the limit of a scalar that a factor changes: not of a distance, and not of 0.
fn is_factor(price: &Price, question: &LocalQuestion) -> bool {
    match price.parameter {
        Parameter::Threshold(PoseScalar::Clearance | PoseScalar::Reach) => false,
        Parameter::Threshold(scalar) => question
            .settings
            .thresholds
            .get(scalar)
            .is_some_and(|limit| limit > 0.0),
        _ => false,
    }
}
