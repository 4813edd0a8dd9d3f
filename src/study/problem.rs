//! A study as an optimization problem; `x` consists of the architecture and the five lengths.

use super::Study;
use kinefront_model::evaluation::{BarRanges, Evaluation, GridChoice, Model, WorkspaceTarget};
use kinefront_model::mechanism::{Architecture, DESIGN_VARIABLES, Design, DesignError, DesignVariable, WorkingMode};
use kinefront_model::workspace::GridError;
use kinefront_optimize::{Candidate, Outcome, Problem, Target, Variable};

/// The optimization problem of a study, with designs encoded as vectors of values.
///
/// The first value is the index of the architecture in the study's list; the lengths follow in the order of
/// [`DESIGN_VARIABLES`]. If the study has one architecture, the first variable has a single choice.
#[derive(Debug, Clone)]
pub struct DesignProblem {
    model: Model,
    architectures: Vec<Architecture>,
    working_mode: WorkingMode,
    ranges: [[f64; 2]; DESIGN_VARIABLES.len()],
}

impl DesignProblem {
    /// Creates the optimization problem of a study.
    ///
    /// # Errors
    /// [`GridError`] if a grid of the study is invalid, which [`Study::faults`] tells beforehand.
    pub fn new(study: &Study) -> Result<Self, GridError> {
        Ok(Self {
            model: study.model()?,
            architectures: study.architectures.clone(),
            working_mode: study.working_mode,
            ranges: DESIGN_VARIABLES.map(|variable| study.bounds.range(variable)),
        })
    }

    /// Returns the model with which designs are evaluated.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Returns the design that `x` encodes.
    ///
    /// # Errors
    /// [`DesignError`] if the bounds allow values that are not a valid design.
    pub fn design(&self, x: &[f64]) -> Result<Design, DesignError> {
        let architecture = self.architectures[(x[0] as usize).min(self.architectures.len() - 1)];
        Design::new(architecture, self.working_mode, [x[1], x[2], x[3], x[4], x[5]])
    }

    /// Evaluates the design that `x` encodes on the reference grid.
    ///
    /// # Errors
    /// [`DesignError`] when the values are no design.
    pub fn evaluation(&self, x: &[f64]) -> Result<Evaluation, DesignError> {
        Ok(self.evaluate_design(&self.design(x)?))
    }

    /// Evaluates a design on the reference grid.
    pub fn evaluate_design(&self, design: &Design) -> Evaluation {
        self.model.evaluate(design, GridChoice::Reference)
    }

    /// Whether a design is one at which a candidate is evaluated: its values are those of the candidate, but for the bars
    /// if the candidate is completed.
    pub fn follows(&self, candidate: &Candidate, design: &Design) -> bool {
        let Ok(asked) = self.design(&candidate.x) else {
            return false;
        };
        let bars = [DesignVariable::LegBarRadius, DesignVariable::PlatformBarRadius];
        let free = |variable: DesignVariable| candidate.target.is_some() && bars.contains(&variable);
        let same = |variable: &DesignVariable| {
            let [asked, found] = [&asked, design].map(|design| design.values()[*variable as usize]);
            free(*variable) || asked.to_bits() == found.to_bits()
        };
        asked.architecture == design.architecture
            && asked.working_mode == design.working_mode
            && DESIGN_VARIABLES.iter().all(same)
    }

    /// Returns the values at which a candidate was evaluated as `design`.
    pub fn values(candidate: &Candidate, design: &Design) -> Vec<f64> {
        let architecture = candidate.x.first().copied();
        architecture.into_iter().chain(design.values()).collect()
    }

    /// Converts an evaluation into the outcome that the optimizer uses: mass and −`R_w`, both minimised, and the
    /// violation.
    pub fn outcome(evaluation: &Evaluation) -> Outcome {
        Outcome {
            objectives: [evaluation.mass, -evaluation.workspace_radius],
            violation: evaluation.violation,
        }
    }

    /// Returns the variables of the problem.
    pub fn variables(&self) -> Vec<Variable> {
        std::iter::once(Variable::Categorical {
            choices: self.architectures.len(),
        })
        .chain(
            self.ranges
                .iter()
                .map(|&[lower, upper]| Variable::Real { lower, upper }),
        )
        .collect()
    }
}

impl Problem for DesignProblem {
    fn variables(&self) -> Vec<Variable> {
        DesignProblem::variables(self)
    }

    /// Sets the lightest bars for the geometry in `x` that provide the workspace radius of the target. For the target
    /// [`Target::Best`], or for a radius that the geometry does not allow, the bars are sized for the largest radius that
    /// it allows.
    fn complete(&self, x: &[f64], target: Target) -> Option<Vec<f64>> {
        let design = self.design(x).ok()?;
        let range = |variable: DesignVariable| self.ranges[variable as usize];
        let ranges = BarRanges {
            leg: range(DesignVariable::LegBarRadius),
            platform: range(DesignVariable::PlatformBarRadius),
        };
        let sized = |target| self.model.sized(&design, &ranges, target);
        let sized = match target {
            Target::Level(level) if level < 0.0 => {
                sized(WorkspaceTarget::Radius(-level)).or_else(|| sized(WorkspaceTarget::Largest))
            }
            Target::Level(_) | Target::Best => sized(WorkspaceTarget::Largest),
        }?;
        let mut x = x.to_vec();
        x[1 + DesignVariable::LegBarRadius as usize] = sized.leg_bar_radius;
        x[1 + DesignVariable::PlatformBarRadius as usize] = sized.platform_bar_radius;
        Some(x)
    }

    fn evaluate(&self, x: &[f64]) -> Outcome {
        match self.evaluation(x) {
            Ok(evaluation) => Self::outcome(&evaluation),
            // Values that are not a valid design are worse than every valid design.
            Err(_) => Outcome {
                objectives: [f64::MAX, 0.0],
                violation: f64::MAX,
            },
        }
    }
}
