//! The interfaces between a problem, an algorithm and the caller that runs the algorithm on the problem.

use std::ops::Deref;

/// One variable of a problem.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Variable {
    /// A real number in `[lower, upper]`.
    Real {
        /// Smallest value.
        lower: f64,
        /// Largest value.
        upper: f64,
    },
    /// One of `choices` unordered alternatives, represented as 0.0, 1.0, ….
    Categorical {
        /// Number of alternatives, at least 1.
        choices: usize,
    },
}

/// The values of one to three objectives, which are minimised and finite. They dereference to a slice.
///
/// ```
/// use kinefront_optimize::Objectives;
///
/// let objectives = Objectives::from([3.0, -1.0]);
/// assert_eq!(objectives.len(), 2);
/// assert_eq!(objectives[1], -1.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Objectives {
    values: [f64; Self::MOST],
    count: usize,
}

impl Objectives {
    /// Largest number of objectives.
    pub const MOST: usize = 3;

    /// Takes up to [`Objectives::MOST`] values; further ones are ignored.
    pub fn new(values: impl IntoIterator<Item = f64>) -> Self {
        let mut objectives = Self {
            values: [0.0; Self::MOST],
            count: 0,
        };
        for (place, value) in objectives.values.iter_mut().zip(values) {
            *place = value;
            objectives.count += 1;
        }
        objectives
    }
}

impl<const N: usize> From<[f64; N]> for Objectives {
    fn from(values: [f64; N]) -> Self {
        const { assert!(N >= 1 && N <= Self::MOST) };
        Self::new(values)
    }
}

impl Deref for Objectives {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.values[..self.count]
    }
}

impl AsRef<[f64]> for Objectives {
    fn as_ref(&self) -> &[f64] {
        self
    }
}

/// Result of an evaluation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome {
    /// The objectives, which are minimised and finite.
    pub objectives: Objectives,
    /// Constraint violation: 0 for a feasible candidate, otherwise positive and finite.
    pub violation: f64,
}

impl Outcome {
    /// Returns whether all constraints are satisfied.
    pub fn is_feasible(&self) -> bool {
        self.violation <= 0.0
    }
}

/// Target that a candidate is completed for before it is evaluated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// The best first objective for which the [leveled](Problem::leveled_objective) one is at most this level.
    Level(f64),
    /// The best first objective for which the leveled one is the best attainable.
    Best,
}

/// A candidate that an algorithm proposes for evaluation.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// One value per variable.
    pub x: Vec<f64>,
    /// Target that the problem may complete the candidate for; `None` if it is to be evaluated unchanged.
    pub target: Option<Target>,
}

impl Candidate {
    /// The candidate that is to be completed for the best leveled objective.
    pub(crate) fn seeking_best(x: Vec<f64>) -> Self {
        let target = Some(Target::Best);
        Self { x, target }
    }
}

impl From<Vec<f64>> for Candidate {
    fn from(x: Vec<f64>) -> Self {
        Self { x, target: None }
    }
}

/// An evaluated candidate with its outcome.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluated {
    /// One value per variable, as evaluated.
    pub x: Vec<f64>,
    /// Outcome of the evaluation.
    pub outcome: Outcome,
}

/// An optimization problem: its variables and its evaluation function.
pub trait Problem: Sync {
    /// Returns the variables, in the order of a candidate's values.
    fn variables(&self) -> Vec<Variable>;

    /// Evaluates one candidate.
    fn evaluate(&self, x: &[f64]) -> Outcome;

    /// Returns the place of the objective to which the level of a [`Target`] applies; by default the second one.
    fn leveled_objective(&self) -> usize {
        1
    }

    /// Returns the place of the objective that an algorithm may learn together with the sized one, of two objectives: for a candidate that is
    /// completed for [`Target::Best`], both are smooth functions of the variables that are not
    /// [determined](Problem::determined_variables). By default it is the leveled one.
    fn learned_objective(&self) -> usize {
        self.leveled_objective()
    }

    /// Sets those variables of a candidate that follow from the other variables and from the target. Returns `None` if
    /// there are no such variables, or if the other variables do not allow the target.
    ///
    /// With this function a problem exposes its structure: some variables may be the solution of a cheaper subproblem.
    /// Bars, for example, must carry the load that the other variables imply and are best as thin as that load allows.
    /// The function is not an evaluation and need not be exact: the completed candidate is evaluated like any other.
    fn complete(&self, x: &[f64], target: Target) -> Option<Vec<f64>> {
        let _ = (x, target);
        None
    }

    /// Returns the places of the variables that [`Problem::complete`] sets whatever values they have; by default none. It may
    /// change other variables too, for example to repair a candidate.
    fn determined_variables(&self) -> Vec<usize> {
        Vec::new()
    }

    /// Returns the values at which a candidate is evaluated: the completed ones, or its own if it cannot be completed.
    fn completed(&self, candidate: Candidate) -> Vec<f64> {
        candidate
            .target
            .and_then(|target| self.complete(&candidate.x, target))
            .unwrap_or(candidate.x)
    }
}

/// An optimization algorithm with an ask-and-tell interface; each step is one generation.
pub trait Algorithm: Send {
    /// Returns the candidates of the next generation, at least one.
    fn ask(&mut self) -> Vec<Candidate>;

    /// Receives the outcomes of the candidates returned by the last call of [`Algorithm::ask`], in the same order and
    /// with the values as completed. The last generation may be truncated.
    fn tell(&mut self, evaluated: Vec<Evaluated>);
}
