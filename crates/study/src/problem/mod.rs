//! A study as an optimization problem; `x` consists of the architecture, the five dimensions, and the further variables that have
//! bounds.
//!
//! Variables that are listed or tied take their values when a candidate is completed: the nearest of the list, and what follows
//! from the other variable.

mod sizing;
mod stronger;

use super::{Study, Tie};
use kinefront_model::evaluation::{
    Bound, Evaluation, GridChoice, Model, ModelSettings, Objective, Quantity, Thresholds, WorkspaceTarget,
};
use kinefront_model::mechanism::{Architecture, DESIGN_VARIABLES, Design, DesignError, DesignVariable, WorkingMode};
use kinefront_model::workspace::GridError;
use kinefront_optimize::{Candidate, Objectives, Outcome, Problem, Target, Variable};
use kinefront_optimum::FreeVariable;
use rayon::prelude::*;

/// Variables that are sized.
const BARS: [DesignVariable; 2] = [DesignVariable::LegBarRadius, DesignVariable::PlatformBarRadius];

/// Variables that change when a design is scaled.
const LENGTHS: [DesignVariable; 3] = [
    DesignVariable::BaseRadius,
    DesignVariable::PlatformRadius,
    DesignVariable::LinkLength,
];

/// Values of the five dimensions of a design.
type Dimensions = [f64; DESIGN_VARIABLES.len()];

/// The optimization problem of a study, with designs encoded as vectors of values.
///
/// The first value is the index of the architecture in the study's list; the lengths follow in the order of
/// [`DESIGN_VARIABLES`], and then the further variables; a chain that does not have one of these ignores it. If the study has one
/// architecture, the first variable has a single choice.
#[derive(Debug, Clone)]
pub struct DesignProblem {
    model: Model,
    architectures: Vec<Architecture>,
    working_mode: WorkingMode,
    ranges: [[f64; 2]; DESIGN_VARIABLES.len()],
    /// Values that a variable may have, if they are listed.
    listed: [Option<Vec<f64>>; DESIGN_VARIABLES.len()],
    ties: [Option<Tie>; DESIGN_VARIABLES.len()],
    /// Further variables that have bounds.
    further: Vec<(DesignVariable, [f64; 2])>,
    is_prescribed: bool,
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
            ranges: DESIGN_VARIABLES.map(|variable| study.range(variable)),
            listed: DESIGN_VARIABLES.map(|variable| study.listed(variable)),
            ties: DESIGN_VARIABLES.map(|variable| study.tie(variable)),
            further: study
                .bounds
                .further_variables()
                .map(|variable| (variable, study.bounds.range(variable)))
                .collect(),
            is_prescribed: study.workspace.region.is_prescribed(),
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
        let dimensions = self.settled([x[1], x[2], x[3], x[4], x[5]]);
        let design = Design::new(architecture, self.working_mode, dimensions)?;
        self.places_of_further(architecture)
            .try_fold(design, |design, (place, variable)| design.with(variable, x[place]))
    }

    /// Returns the further variables that an architecture has, each with its place in `x`.
    fn places_of_further(&self, architecture: Architecture) -> impl Iterator<Item = (usize, DesignVariable)> {
        let first = 1 + DESIGN_VARIABLES.len();
        let all = self
            .further
            .iter()
            .enumerate()
            .map(move |(place, (variable, _))| (first + place, *variable));
        all.filter(move |(_, variable)| architecture.has(*variable))
    }

    /// Returns the values of the variables with the listed ones at the nearest value of their list and the tied ones as they
    /// follow.
    fn settled(&self, mut values: Dimensions) -> Dimensions {
        for (value, listed) in values.iter_mut().zip(&self.listed) {
            let wanted = *value;
            let distance = |other: f64| (other - wanted).abs();
            let nearest = listed
                .iter()
                .flatten()
                .copied()
                .reduce(|best, next| if distance(next) < distance(best) { next } else { best });
            *value = nearest.unwrap_or(wanted);
        }
        let sources = values;
        for (value, tie) in values.iter_mut().zip(&self.ties) {
            if let Some(tie) = tie {
                *value = tie.factor * sources[tie.source as usize];
            }
        }
        values
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

    /// Evaluates designs on the fine grid, in parallel.
    pub fn evaluate_on_fine_grid(&self, designs: &[Design]) -> Vec<Evaluation> {
        let evaluate = |design: &Design| self.model.evaluate(design, GridChoice::Fine);
        designs.par_iter().map(evaluate).collect()
    }

    /// Whether a design is one at which a candidate is evaluated: its values are those of the candidate, but for the bars, and
    /// the lengths if the study leaves the scale open, if the candidate is completed.
    pub fn follows(&self, candidate: &Candidate, design: &Design) -> bool {
        let Ok(asked) = self.design(&candidate.x) else {
            return false;
        };
        let mut completed = BARS.to_vec();
        if self.may_scale() {
            completed.extend(LENGTHS);
        }
        let free = |variable: DesignVariable| {
            let follows = self.ties[variable as usize].is_some_and(|tie| completed.contains(&tie.source));
            candidate.target.is_some() && (completed.contains(&variable) || follows)
        };
        let same = |variable: &DesignVariable| {
            let [asked, found] = [&asked, design].map(|design| design.values()[*variable as usize]);
            free(*variable) || asked.to_bits() == found.to_bits()
        };
        asked.architecture() == design.architecture()
            && asked.working_mode() == design.working_mode()
            && DESIGN_VARIABLES.iter().all(same)
            && self
                .places_of_further(asked.architecture())
                .all(|(_, variable)| asked.value(variable).to_bits() == design.value(variable).to_bits())
    }

    /// Returns the values at which a candidate was evaluated as `design`.
    pub fn values(candidate: &Candidate, design: &Design) -> Vec<f64> {
        let mut x = candidate.x.clone();
        for (value, found) in x.iter_mut().skip(1).zip(design.values()) {
            *value = found;
        }
        x
    }

    /// Converts an evaluation into the outcome that the optimizer uses: the objectives, as they are minimised, and the
    /// violation.
    pub fn outcome(evaluation: &Evaluation) -> Outcome {
        Outcome {
            objectives: Objectives::new(evaluation.objectives.iter().copied()),
            violation: evaluation.violation,
        }
    }

    /// Returns the problem with other limits of the scalars at each pose.
    pub(super) fn with_thresholds(&self, thresholds: Thresholds) -> Result<Self, GridError> {
        let settings = ModelSettings {
            thresholds,
            ..self.model.settings().clone()
        };
        Ok(Self {
            model: Model::new(settings)?,
            ..self.clone()
        })
    }

    /// Returns the variables of an architecture that range freely between their bounds, each with those that are tied to it.
    pub(super) fn free_variables(&self, architecture: Architecture) -> Vec<FreeVariable> {
        let dimensions = DESIGN_VARIABLES
            .into_iter()
            .filter(|variable| self.is_free(*variable))
            .map(|variable| FreeVariable {
                variable,
                range: self.ranges[variable as usize],
                tied: self.tied_to(variable),
            });
        let further = self
            .further
            .iter()
            .filter(|(variable, [lower, upper])| architecture.has(*variable) && lower < upper);
        let further = further.map(|&(variable, range)| FreeVariable {
            variable,
            range,
            tied: Vec::new(),
        });
        dimensions.chain(further).collect()
    }

    /// Returns the largest difference of two designs of one architecture in a free variable other than a bar, as a share of its range.
    pub(super) fn largest_difference(&self, a: &Design, b: &Design) -> f64 {
        let free = self.free_variables(a.architecture()).into_iter();
        let shares = free.filter(|free| !BARS.contains(&free.variable)).map(|free| {
            let [lower, upper] = free.range;
            (a.value(free.variable) - b.value(free.variable)).abs() / (upper - lower)
        });
        shares.fold(0.0, f64::max)
    }

    /// Returns the dimensions that follow a dimension, each with its factor.
    pub(super) fn tied_to(&self, variable: DesignVariable) -> Vec<(DesignVariable, f64)> {
        let ties = DESIGN_VARIABLES.into_iter().zip(&self.ties);
        ties.filter_map(|(tied, tie)| tie.filter(|tie| tie.source == variable).map(|tie| (tied, tie.factor)))
            .collect()
    }

    /// Returns the values that a dimension may have, if they are listed; otherwise none.
    pub(super) fn entries_of(&self, variable: DesignVariable) -> &[f64] {
        self.listed[variable as usize].as_deref().unwrap_or_default()
    }

    /// Whether a dimension has a range of its own.
    fn is_free(&self, variable: DesignVariable) -> bool {
        let place = variable as usize;
        self.listed[place].is_none() && self.ties[place].is_none() && self.ranges[place][0] < self.ranges[place][1]
    }

    /// Returns the workspace radius that the study asks for at least \[m\].
    pub(super) fn least_radius(&self) -> Option<f64> {
        self.model.settings().limits.iter().find_map(|limit| match limit.bound {
            Bound::AtLeast(radius) if limit.quantity == Quantity::WorkspaceRadius => Some(radius),
            _ => None,
        })
    }

    pub(super) fn maximises_radius(&self) -> bool {
        let is_radius = |objective: &Objective| objective.quantity == Quantity::WorkspaceRadius;
        self.model.settings().objectives.iter().any(is_radius)
    }

    /// Returns the variables of the problem.
    pub fn variables(&self) -> Vec<Variable> {
        let choices = self.architectures.len();
        let ranges = self.ranges.iter().chain(self.further.iter().map(|(_, range)| range));
        let reals = ranges.map(|&[lower, upper]| Variable::Real { lower, upper });
        std::iter::once(Variable::Categorical { choices })
            .chain(reals)
            .collect()
    }
}

impl Problem for DesignProblem {
    fn variables(&self) -> Vec<Variable> {
        DesignProblem::variables(self)
    }

    /// Returns the place of the workspace radius among the objectives; without it there are no levels to aim at.
    fn leveled_objective(&self) -> usize {
        let is_radius = |objective: &Objective| objective.quantity == Quantity::WorkspaceRadius;
        let objectives = &self.model.settings().objectives;
        objectives.iter().position(is_radius).unwrap_or(objectives.len())
    }

    /// Returns the workspace radius, or, for a study without it, the objective besides the mass: with the lightest bars, both are functions of
    /// the geometry.
    fn learned_objective(&self) -> usize {
        let is_mass = |objective: &Objective| objective.quantity == Quantity::Mass;
        match self.model.settings().objectives.as_slice() {
            [first, second] if !self.maximises_radius() && (is_mass(first) || is_mass(second)) => {
                usize::from(is_mass(first))
            }
            _ => self.leveled_objective(),
        }
    }

    /// Sets the lightest bars for the geometry in `x` that provide the workspace radius of the target, or the region that the
    /// study prescribes, and for the latter also the scale of the geometry if the mass alone is sought. For the target
    /// [`Target::Best`], or for a radius that the geometry does not allow, the bars are sized for the largest radius that it
    /// allows, or for that which a limit asks for. Bars are not sized where thin ones are not what the study seeks.
    fn complete(&self, x: &[f64], target: Target) -> Option<Vec<f64>> {
        if !self.seeks_light_bars() {
            return None;
        }
        let design = self.design(x).ok()?;
        let ranges = self.sizing_ranges(&design);
        let sized = |target| self.model.sized(&design, &ranges, target);
        let sized = match target {
            _ if self.is_prescribed => sized(WorkspaceTarget::Prescribed(GridChoice::Reference)),
            Target::Best if self.least_radius().is_some() && !self.maximises_radius() => {
                sized(WorkspaceTarget::Radius(self.least_radius()?))
            }
            Target::Level(level) if level < 0.0 => {
                sized(WorkspaceTarget::Radius(-level)).or_else(|| sized(WorkspaceTarget::Largest))
            }
            Target::Level(_) | Target::Best => sized(WorkspaceTarget::Largest),
        }?;
        let mut x = x.to_vec();
        let values = self.with_ties_raised(&sized);
        for variable in DESIGN_VARIABLES {
            if BARS.contains(&variable) || self.may_scale() {
                x[1 + variable as usize] = values[variable as usize];
            }
        }
        Some(x)
    }

    fn determined_variables(&self) -> Vec<usize> {
        let bars = BARS.into_iter().filter(|_| self.seeks_light_bars());
        // With the scale, one length follows from the others.
        let scale = self.untied_lengths().take(usize::from(self.may_scale()));
        bars.chain(scale).map(|variable| 1 + variable as usize).collect()
    }

    fn completed(&self, candidate: Candidate) -> Vec<f64> {
        let mut x = candidate
            .target
            .and_then(|target| self.complete(&candidate.x, target))
            .unwrap_or(candidate.x);
        if let Some(values) = x.get_mut(1..=DESIGN_VARIABLES.len())
            && let Ok(all) = Dimensions::try_from(&*values)
        {
            values.copy_from_slice(&self.settled(all));
        }
        x
    }

    fn evaluate(&self, x: &[f64]) -> Outcome {
        match self.evaluation(x) {
            Ok(evaluation) => Self::outcome(&evaluation),
            // Values that are not a valid design are worse than every valid design.
            Err(_) => Outcome {
                objectives: Objectives::new(self.model.settings().objectives.iter().map(|_| f64::MAX)),
                violation: f64::MAX,
            },
        }
    }
}
