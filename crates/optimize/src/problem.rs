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

/// What a candidate is to be completed for, before it is evaluated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Aim {
    /// The least first objective at which the second is at most this.
    Level(f64),
    /// The least first objective at the best second one that there is.
    Best,
}

/// What an algorithm asks for.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// A value per variable.
    pub x: Vec<f64>,
    /// What the problem may complete it for; `None` to have it evaluated as it stands.
    pub aim: Option<Aim>,
}

impl From<Vec<f64>> for Candidate {
    fn from(x: Vec<f64>) -> Self {
        Self { x, aim: None }
    }
}

/// A candidate and its outcome.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluated {
    /// A value per variable, as evaluated.
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

    /// Sets those variables of a candidate that follow from the others and from what it aims at; `None` where there are
    /// none, or where nothing the others allow has the aim.
    ///
    /// This is where a problem tells of its structure. Some variables may be settled by a cheaper problem of their own:
    /// bars, say, that must carry what the other variables ask of them and are best as thin as that allows. It is no
    /// evaluation, and need not be exact: what comes of it is evaluated like any candidate.
    fn complete(&self, x: &[f64], aim: Aim) -> Option<Vec<f64>> {
        let _ = (x, aim);
        None
    }

    /// The values that a candidate is evaluated at.
    fn completed(&self, candidate: Candidate) -> Vec<f64> {
        candidate
            .aim
            .and_then(|aim| self.complete(&candidate.x, aim))
            .unwrap_or(candidate.x)
    }
}

/// An algorithm that is asked and told, a generation at a time.
pub trait Algorithm: Send {
    /// The candidates of the next generation; never empty.
    fn ask(&mut self) -> Vec<Candidate>;

    /// The outcomes of the candidates last asked for, in their order and as they were completed; a last generation may
    /// be cut short.
    fn tell(&mut self, evaluated: Vec<Evaluated>);
}

/// Runs `algorithm` on `problem` for `evaluations` evaluations in this thread and returns the archive of its
/// non-dominated feasible candidates.
pub fn drive(problem: &impl Problem, algorithm: &mut (impl Algorithm + ?Sized), evaluations: usize) -> Archive {
    let mut archive = Archive::default();
    let mut done = 0;
    while done < evaluations {
        let mut candidates = algorithm.ask();
        candidates.truncate(evaluations - done);
        let evaluated: Vec<Evaluated> = candidates
            .into_iter()
            .map(|candidate| {
                let x = problem.completed(candidate);
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
