//! Where two optima meet: the value of a requirement at which a design of another kind becomes the better one.

use kinefront_model::evaluation::Quantity;
use kinefront_model::mechanism::Design;

use super::parameter::Parameter;
use super::polished::Polished;
use super::problem::LocalProblem;

/// Accuracy of the logarithm of the requirement.
const ACCURACY: f64 = 1e-9;

/// Least logarithm by which each of two optima of one architecture is worse than the other at the other's requirement; otherwise the two
/// are one optimum that was followed.
const DIFFERENT: f64 = 1e-5;

/// Unknowns of two such optima that differ by no more than this are those of one optimum.
const ALIKE: f64 = 1e-4;

/// Largest number of secants.
const SECANTS: usize = 40;

/// An optimum whose requirement changes.
#[derive(Debug, Clone, Copy)]
pub struct Branch<'a> {
    /// The problem.
    pub problem: &'a LocalProblem,
    /// Its optimum.
    pub optimum: &'a Polished,
    /// The requirement.
    pub parameter: Parameter,
}

/// The value of a requirement at which two optima have the same objective: a concave kink of the best that can be had.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meeting {
    /// The value of the requirement.
    pub at: f64,
    /// The objective of both.
    pub objective: f64,
    /// The design of each of them.
    pub designs: [Design; 2],
    /// The home orientation of each of them \[rad\].
    pub homes: [f64; 2],
    /// The price of the requirement at each of them.
    pub prices: [f64; 2],
}

/// Both optima at a value of the requirement.
struct Both {
    /// Logarithm of the value.
    at: f64,
    optima: [Polished; 2],
    /// Logarithm by which the first is worse than the second.
    worse: f64,
}

impl Both {
    /// Returns both optima at a logarithm of the requirement, each starting from another one.
    fn at(branches: &[Branch<'_>; 2], from: [&Polished; 2], at: f64) -> Option<Self> {
        let optima = [
            branches[0].optimum_at(from[0], at)?,
            branches[1].optimum_at(from[1], at)?,
        ];
        let [a, b] = [0, 1].map(|k| branches[k].problem.log_of(&optima[k]));
        Some(Self {
            at,
            worse: branches[0].problem.goal_sign() * (a - b),
            optima,
        })
    }

    /// Returns whether one of the branches has fallen into the other.
    fn is_one_optimum(&self) -> bool {
        let [first, second] = [0, 1].map(|place| &self.optima[place].unknowns);
        first.iter().zip(second).all(|(a, b)| (a - b).abs() <= ALIKE)
    }
}

impl Branch<'_> {
    /// Returns the logarithm of the requirement; `None` if it is 0.
    fn place(&self) -> Option<f64> {
        let actuator = self.optimum.design.architecture().actuator();
        let value = self.parameter.value(self.problem.question(), actuator)?;
        (value > 0.0).then(|| libm::log(value))
    }

    /// Returns the optimum for a logarithm of the requirement, starting from another one.
    fn optimum_at(&self, from: &Polished, at: f64) -> Option<Polished> {
        let step = at - self.place()?;
        let found = self.problem.after(from, &[(self.parameter, 1.0)], step);
        found.filter(Polished::is_optimal)
    }

    /// Returns the price of the requirement at an optimum for a logarithm of it.
    fn price_at(&self, optimum: &Polished, at: f64) -> Option<f64> {
        let step = at - self.place()?;
        let problem = self.problem.changed(optimum, &[(self.parameter, 1.0)], step)?;
        let prices = problem.prices(optimum, false).prices;
        let own = prices.iter().find(|price| price.parameter == self.parameter);
        own.map(|price| price.price)
    }
}

impl Meeting {
    /// Returns where two optima with the same objective meet, the first of which is the better one at its own requirement and the second at
    /// its own; `None` if no such place was found between them, or, for two architectures, as far beyond either.
    pub fn of(branches: [Branch<'_>; 2]) -> Option<Self> {
        let [first, second] = [branches[0].place()?, branches[1].place()?];
        let both = |from: [&Polished; 2], at: f64| Both::at(&branches, from, at);
        let starts = [branches[0].optimum, branches[1].optimum];
        let width = second - first;
        let is_one_architecture = starts[0].design.architecture() == starts[1].design.architecture();
        let mut near = both(starts, first)?;
        if is_one_architecture && near.worse > -DIFFERENT {
            return None;
        }
        if near.worse > 0.0 {
            near = both([&near.optima[0], &near.optima[1]], first - width)?;
        }
        let mut far = both(starts, second)?;
        if is_one_architecture && far.worse < DIFFERENT {
            return None;
        }
        if far.worse < 0.0 {
            far = both([&far.optima[0], &far.optima[1]], second + width)?;
        }
        if near.worse > 0.0 || far.worse < 0.0 {
            return None;
        }
        for _ in 0..SECANTS {
            if (far.at - near.at).abs() <= ACCURACY || near.worse == far.worse {
                break;
            }
            let share = (near.worse / (near.worse - far.worse)).clamp(0.01, 0.99);
            let from = if share < 0.5 { &near.optima } else { &far.optima };
            let next = both([&from[0], &from[1]], near.at + share * (far.at - near.at))?;
            if next.worse.abs() <= ACCURACY {
                near = next;
                break;
            }
            if next.worse < 0.0 { near = next } else { far = next }
        }
        if is_one_architecture && near.is_one_optimum() {
            return None;
        }
        let prices = [
            branches[0].price_at(&near.optima[0], near.at)?,
            branches[1].price_at(&near.optima[1], near.at)?,
        ];
        Some(Self {
            at: libm::exp(near.at),
            objective: near.optima[0].objective,
            designs: [near.optima[0].design, near.optima[1].design],
            homes: [near.optima[0].home, near.optima[1].home],
            prices,
        })
    }
}

impl LocalProblem {
    /// Returns the requirement of a quantity, if it is one of the problem: its limit, of several the last one, or the radius of the disc.
    pub fn parameter_of(&self, quantity: Quantity) -> Option<Parameter> {
        let is_of = |parameter: &Parameter| match *parameter {
            Parameter::WorkspaceRadius => quantity == Quantity::WorkspaceRadius,
            Parameter::Threshold(scalar) => quantity == Quantity::Worst(scalar),
            Parameter::Limit(place) => self.question().settings.limits[place].quantity == quantity,
            _ => false,
        };
        Parameter::all(self).into_iter().rfind(is_of)
    }
}
