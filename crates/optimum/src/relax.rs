//! Why a wished value of the objective cannot be had: what each requirement would have to give for it.

use kinefront_model::evaluation::{Better, Bound, PoseScalar};
use kinefront_model::mechanism::Design;

use super::parameter::Parameter;
use super::polish::Polished;
use super::prices::Price;
use super::problem::{LocalProblem, LocalQuestion};

/// Largest change of the logarithm of a requirement: a factor of 20.
const MOST: f64 = 2.995_732_273_553_991;

/// Largest change of the logarithm of a requirement from one optimum to the next.
const STEP: f64 = 0.5;

/// Accuracy of the logarithm of the objective.
const ACCURACY: f64 = 1e-7;

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
        let deficit = self.goal_sign() * (libm::log(wished) - self.log_of(polished));
        let is_priced = |price: &&Price| price.parameter.is_requirement() && price.price.abs() > FREE;
        let mut found: Vec<Relaxation> = Vec::new();
        for price in prices.iter().filter(is_priced) {
            let weights = [(price.parameter, way_of(self.question(), price.parameter))];
            let rate = price.price * weights[0].1 * self.goal_sign();
            let linear = deficit / rate;
            found.extend(self.relaxed(
                polished,
                RelaxationOf::Single(price.parameter),
                &weights,
                linear,
                deficit,
            ));
        }
        let is_threshold =
            |price: &Price| matches!(price.parameter, Parameter::Threshold(_)) && is_relative(price, self.question());
        let thresholds: Vec<(Parameter, f64)> = prices
            .iter()
            .filter(|price| is_threshold(price))
            .map(|price| (price.parameter, way_of(self.question(), price.parameter)))
            .collect();
        let rate: f64 = prices
            .iter()
            .filter(|price| is_threshold(price))
            .map(|price| price.price * way_of(self.question(), price.parameter) * self.goal_sign())
            .sum();
        if thresholds.len() > 1 && rate.abs() > FREE {
            found.extend(self.relaxed(
                polished,
                RelaxationOf::AllThresholds,
                &thresholds,
                deficit / rate,
                deficit,
            ));
        }
        let in_norm = |price: &&Price| is_threshold(price) || price.parameter == Parameter::RotationRange;
        let squares: f64 = prices
            .iter()
            .filter(in_norm)
            .map(|price| price.price * price.price)
            .sum();
        let norm = squares.sqrt();
        if norm > FREE {
            let weights: Vec<(Parameter, f64)> = prices
                .iter()
                .filter(in_norm)
                .map(|price| (price.parameter, -self.goal_sign() * price.price / norm))
                .collect();
            found.extend(self.relaxed(polished, RelaxationOf::LeastNorm, &weights, deficit / -norm, deficit));
        }
        found
    }

    /// Solves for the change at which the objective has its wished value: `weights` are the changes of the logarithms of the parameters
    /// for a change of 1, and `linear` is the change by the prices.
    fn relaxed(
        &self,
        polished: &Polished,
        of: RelaxationOf,
        weights: &[(Parameter, f64)],
        linear: f64,
        deficit: f64,
    ) -> Option<Relaxation> {
        let start = self.log_of(polished);
        // The way to the wish, at most to the factor of 20.
        let short = |found: &Polished| self.goal_sign() * (self.log_of(found) - start) - deficit;
        let to = |from: &Polished, change: f64| self.after_all(from, weights, change);
        let (mut near, mut near_short) = ((0.0, polished.clone()), -deficit);
        let mut far: Option<((f64, Polished), f64)> = None;
        let mut change = linear.clamp(0.0, STEP);
        while far.is_none() && near.0 < MOST {
            let Some(next) = to(&near.1, change).filter(Polished::is_optimal) else {
                // A step that fails is tried shorter.
                let shorter = 0.5 * (change - near.0);
                if shorter < 1e-3 {
                    break;
                }
                change = near.0 + shorter;
                continue;
            };
            let next_short = short(&next);
            if next_short <= ACCURACY {
                far = Some(((change, next), next_short));
                break;
            }
            let is_free = (near_short - next_short).abs() < 1e-9 && change - near.0 > 0.4;
            (near, near_short) = ((change, next), next_short);
            if is_free {
                break;
            }
            let rate = -deficit - near_short;
            let guess = if rate > 1e-12 { near.0 * -deficit / rate } else { MOST };
            change = guess.clamp(near.0 + 0.02, near.0 + STEP).min(MOST);
        }
        if let Some((mut beyond, mut beyond_short)) = far {
            for _ in 0..30 {
                if beyond_short.abs() <= ACCURACY {
                    break;
                }
                let share = near_short / (near_short - beyond_short);
                let middle = near.0 + share.clamp(0.02, 0.98) * (beyond.0 - near.0);
                let Some(next) = to(&beyond.1, middle).filter(Polished::is_optimal) else {
                    break;
                };
                let next_short = short(&next);
                if next_short > 0.0 {
                    (near, near_short) = ((middle, next), next_short);
                } else {
                    (beyond, beyond_short) = ((middle, next), next_short);
                }
                if near_short <= ACCURACY {
                    (beyond, beyond_short) = (near.clone(), near_short);
                }
            }
            return Some(self.result(of, weights, linear, Some(beyond.0), &beyond.1));
        }
        Some(self.result(of, weights, linear, None, &near.1))
    }

    fn result(
        &self,
        of: RelaxationOf,
        weights: &[(Parameter, f64)],
        linear: f64,
        needed: Option<f64>,
        found: &Polished,
    ) -> Relaxation {
        // A factor is that of the parameter itself; of several, that of a requirement from below.
        let sign = match of {
            RelaxationOf::Single(_) => weights[0].1,
            _ => -1.0,
        };
        let factor = |change: f64| libm::exp(sign * change);
        Relaxation {
            linear: Some(factor(linear)).filter(|factor| factor.is_finite() && *factor > 0.0),
            needed: needed.map(factor),
            objective: found.objective,
            design: found.design,
            home: found.home,
            of,
        }
    }

    /// Returns the optimum with several parameters changed.
    fn after_all(&self, from: &Polished, weights: &[(Parameter, f64)], change: f64) -> Option<Polished> {
        let actuator = from.design.architecture().actuator();
        let mut question = self.question.clone();
        for (parameter, weight) in weights {
            question = parameter.changed(&question, weight * change, from.design.base_radius(), actuator)?;
        }
        self.with_question(question).ok()?.polish_from(&from.unknowns)
    }
}

/// Returns the change of the logarithm of a parameter that asks for less: −1 for a requirement from below, 1 for one from above.
fn way_of(question: &LocalQuestion, parameter: Parameter) -> f64 {
    let better_is_higher = match parameter {
        Parameter::Threshold(scalar) => scalar.entry().quantity.better == Better::Higher,
        Parameter::Limit(place) => matches!(question.settings.limits[place].bound, Bound::AtLeast(_)),
        _ => true,
    };
    if better_is_higher { -1.0 } else { 1.0 }
}

fn is_relative(price: &Price, question: &LocalQuestion) -> bool {
    match price.parameter {
        Parameter::Threshold(PoseScalar::Clearance | PoseScalar::Reach) => false,
        Parameter::Threshold(scalar) => question
            .settings
            .thresholds
            .get(scalar)
            .is_some_and(|limit| limit > 0.0),
        _ => true,
    }
}
