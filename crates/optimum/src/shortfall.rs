//! How far a single requirement must be relaxed, so that a design near a given one keeps it and all the others: the answer to a question
//! that no design satisfies.

use kinefront_model::evaluation::{Objective, PoseScalar, Quantity};
use kinefront_model::mechanism::Design;
use kinefront_model::workspace::Region;

use super::parameter::Parameter;
use super::polished::Polished;
use super::problem::LocalProblem;
use super::question::LocalQuestion;
use super::relax::{MOST, way_of};

/// Factor from the stated limit at which a limit that is an unknown starts.
const FROM: f64 = 0.05;

/// Accuracy of the logarithm of a factor that is found by bisection.
const RESOLUTION: f64 = 2e-3;

/// Logarithm of the factor by which a requirement is relaxed beyond a value that a design has, so that another one keeps it with ease.
const ROOM: f64 = 1e-3;

/// A requirement that a design keeps after it was relaxed.
#[derive(Debug, Clone)]
pub struct Relaxed {
    /// The value of the requirement that the design keeps, in its unit.
    pub value: f64,
    /// The design.
    pub design: Design,
    /// Its home orientation \[rad\].
    pub home: f64,
}

impl LocalProblem {
    /// Returns the requirements of the question that may be relaxed one at a time: its limits, and the size of the region.
    pub fn may_be_relaxed(&self) -> Vec<Parameter> {
        let is_stated = |parameter: &Parameter| match parameter {
            Parameter::Threshold(PoseScalar::Reach) => false,
            parameter => parameter.kind().is_requirement(),
        };
        Parameter::all(self).into_iter().filter(is_stated).collect()
    }

    /// Returns a design near `start` that keeps all requirements but one, and of these the one that comes nearest to keeping it; `None` if
    /// no such design was found. A limit of a scalar and the radius of a disc are made the objective; of the others, the least factor is
    /// found that suffices, down to 1/20.
    pub fn relaxed_alone(&self, parameter: Parameter, start: &Design) -> Option<Relaxed> {
        match self.as_objective(parameter) {
            Some(question) => {
                let problem = LocalProblem::new(question, start).ok()?;
                let found = problem.best(start, None).filter(Polished::is_feasible)?;
                Some(Relaxed {
                    value: found.objective,
                    design: found.design,
                    home: found.home,
                })
            }
            None => self.least_factor(parameter, start),
        }
    }

    /// Returns the problem with a requirement relaxed as far as a design was found for it, and a little further.
    pub fn with_relaxed(&self, parameter: Parameter, found: &Relaxed) -> Option<LocalProblem> {
        let actuator = found.design.architecture().actuator();
        let stated = parameter.value(self.question(), actuator)?;
        let step = libm::log(found.value / stated) + ROOM * way_of(self.question(), parameter);
        let question = parameter.changed(self.question(), step, found.design.base_radius(), actuator)?;
        self.with_question(question).ok()
    }

    /// Returns the question with a requirement as the objective, if it can be one.
    fn as_objective(&self, parameter: Parameter) -> Option<LocalQuestion> {
        let mut question = self.question().clone();
        let quantity = match parameter {
            Parameter::Threshold(scalar) if scalar.bounds_poses() => {
                let stated = question
                    .settings
                    .thresholds
                    .get(scalar)
                    .filter(|stated| *stated > 0.0)?;
                let is_from_below = way_of(&question, parameter) < 0.0;
                let first = if is_from_below { FROM * stated } else { stated / FROM };
                question.settings.thresholds.set(scalar, Some(first));
                Quantity::Worst(scalar)
            }
            Parameter::WorkspaceRadius => {
                let radius = question.workspace.region.inscribed_radius()?;
                question.workspace.region = Region::Disc(FROM * radius);
                Quantity::WorkspaceRadius
            }
            _ => return None,
        };
        question.objective = Objective {
            quantity,
            goal: quantity.entry().better,
        };
        Some(question)
    }

    /// Returns the design for the least change of a parameter at which there is one.
    fn least_factor(&self, parameter: Parameter, start: &Design) -> Option<Relaxed> {
        let way = way_of(self.question(), parameter);
        let actuator = start.architecture().actuator();
        let question = |change: f64| parameter.changed(self.question(), way * change, start.base_radius(), actuator);
        let problem = |change: f64| self.with_question(question(change)?).ok();
        let mut found = problem(MOST)?.best(start, None).filter(Polished::is_feasible)?;
        let (mut short, mut enough) = (0.0, MOST);
        while enough - short > RESOLUTION {
            let middle = 0.5 * (short + enough);
            let next = problem(middle)?.polish(&found.design, found.home);
            match next.filter(Polished::is_feasible) {
                Some(next) => (found, enough) = (next, middle),
                None => short = middle,
            }
        }
        Some(Relaxed {
            value: parameter.value(&question(enough)?, actuator)?,
            design: found.design,
            home: found.home,
        })
    }
}

impl Parameter {
    /// Returns whether a value of the parameter asks no less of a design than another one.
    pub fn asks_no_less(self, question: &LocalQuestion, value: f64, than: f64) -> bool {
        way_of(question, self) * (than - value) >= 0.0
    }
}
