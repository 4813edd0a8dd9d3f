//! The seam between a problem, an algorithm and whoever drives it.

use super::Archive;

/// One variable of a problem.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Variable {
    /// A real number in `[lower, upper]`.
    Real {
        /// Least value.
        lower: f64,
        /// Largest value.
        upper: f64,
    },
    /// One of `choices` alternatives without order, held as 0.0, 1.0, ….
    Categorical {
        /// Number of alternatives, at least 1.
        choices: usize,
    },
}

/// What an evaluation gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome {
    /// Both minimised; finite.
    pub objectives: [f64; 2],
    /// 0 where feasible, else positive and finite.
    pub violation: f64,
}

impl Outcome {
    /// Whether all constraints hold.
    pub fn is_feasible(&self) -> bool {
        self.violation <= 0.0
    }
}

/// A candidate and its outcome.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluated {
    /// A value per variable.
    pub x: Vec<f64>,
    /// Its outcome.
    pub outcome: Outcome,
}

/// A problem: its variables and an evaluation.
pub trait Problem: Sync {
    /// The variables, in the order of a candidate's values.
    fn variables(&self) -> Vec<Variable>;
    /// Evaluates one candidate.
    fn evaluate(&self, x: &[f64]) -> Outcome;
}

/// An algorithm that is asked and told, a generation at a time.
pub trait Algorithm: Send {
    /// The candidates of the next generation; never empty.
    fn ask(&mut self) -> Vec<Vec<f64>>;

    /// The outcomes of the candidates last asked for, in their order; a last generation may be cut short.
    fn tell(&mut self, evaluated: Vec<Evaluated>);
}

/// Runs `algorithm` on `problem` for `evaluations` evaluations in this thread and returns the archive of its
/// non-dominated feasible candidates.
pub fn drive(problem: &impl Problem, algorithm: &mut impl Algorithm, evaluations: usize) -> Archive {
    let mut archive = Archive::default();
    let mut done = 0;
    while done < evaluations {
        let mut candidates = algorithm.ask();
        candidates.truncate(evaluations - done);
        let evaluated: Vec<Evaluated> = candidates
            .into_iter()
            .map(|x| {
                let outcome = problem.evaluate(&x);
                Evaluated { x, outcome }
            })
            .collect();
        for (offset, candidate) in evaluated.iter().enumerate() {
            archive.insert(done + offset, candidate);
        }
        done += evaluated.len();
        algorithm.tell(evaluated);
    }
    archive
}
