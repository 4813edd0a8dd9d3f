//! A design of a study as a local problem: the best design near it, what each requirement costs, wishes, and why a wish cannot be had.

mod along;
mod alternatives;
mod crossings;
mod drivers;
mod grid;
mod hindrances;
mod why;
mod wish;
mod wish_json;

use alternatives::{LocalAnswer, OtherEntry};

pub use along::{AlongJson, DrivenPart, DriversAlong, PriceCurve, PricedDesignJson, stacked, usual_range};
pub use alternatives::AlternativeJson;
pub use crossings::{Crossing, CrossingJson};
pub use drivers::{ActiveJson, Drivers, DriversOptions, InactiveJson, PriceJson, RelaxationJson, WhyNotJson};
pub(crate) use grid::Aim;
pub use hindrances::Hindrance;
pub use wish::{Condition, ConditionError, Wish, WishFault, WishOutcome};
pub use wish_json::{UnmetJson, WishJson};

use kinefront_model::evaluation::{Evaluation, GridChoice, Objective, Quantity};
use kinefront_model::mechanism::{Architecture, Design};
use kinefront_model::workspace::{Region, WorkspaceSpec};
use kinefront_optimum::{LocalError, LocalProblem, LocalQuestion, Polished};

use super::{DesignProblem, PoolWorkers};

/// Why there is no local problem of a design.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LocalFault {
    /// The question is none.
    #[error(transparent)]
    Question(#[from] LocalError),
    /// An objective that is to keep its value has none, because the design is infeasible.
    #[error("the design is infeasible, so its {0} is not known; state it, or use a design of a front")]
    Unknown(&'static str),
    /// No design near the given one keeps every requirement.
    #[error("no design near {0} satisfies every requirement at every pose of the region")]
    Infeasible(Box<Design>),
}

/// A design with its local problem.
#[derive(Debug, Clone)]
pub struct LocalDesign {
    /// The problem.
    pub problem: LocalProblem,
    /// The design as it was given.
    pub design: Design,
    /// Home orientation of the given design \[rad\], if it has one on the grid.
    pub home: Option<f64>,
    /// The next entries of lists and catalogues, whose dimensions the problem keeps.
    entries: Vec<OtherEntry>,
    /// The radius that is kept divided by that of the given design; 1 if the latter is not known.
    scale: f64,
}

impl DesignProblem {
    /// Returns the local problem of a design: the first objective is improved, the other objectives keep the values that the design has on
    /// the fine grid, or those of `held`.
    ///
    /// # Errors
    /// [`LocalFault`] if an objective is not known, or is none of a local problem.
    pub fn local(&self, design: &Design, held: &[(Quantity, f64)]) -> Result<LocalDesign, LocalFault> {
        self.local_of(&self.model().evaluate_by(&PoolWorkers, design, GridChoice::Fine), held)
    }

    /// Returns the local problem of a design that was evaluated.
    ///
    /// # Errors
    /// As [`DesignProblem::local`].
    pub fn local_of(&self, evaluation: &Evaluation, held: &[(Quantity, f64)]) -> Result<LocalDesign, LocalFault> {
        self.local_toward(evaluation, 0, held)
    }

    /// Returns the local problem of a design that was evaluated, in which the objective at the place `improved` is improved and the others
    /// are held.
    fn local_toward(
        &self,
        evaluation: &Evaluation,
        improved: usize,
        held: &[(Quantity, f64)],
    ) -> Result<LocalDesign, LocalFault> {
        let settings = self.model().settings();
        let is_feasible = evaluation.is_feasible();
        let stated = |quantity: Quantity| {
            held.iter()
                .find(|(other, _)| *other == quantity)
                .map(|(_, value)| *value)
        };
        let value = |quantity: Quantity| match (stated(quantity), quantity) {
            (Some(value), _) => Some(value),
            // A quantity of the design as a whole does not depend on any pose.
            (None, Quantity::Mass) => Some(self.model().mass(&evaluation.design)),
            (None, quantity) => evaluation.quantities.get(quantity).filter(|_| is_feasible),
        };
        let region = match &settings.workspace.region {
            Region::Largest => Region::Disc(
                self.held_radius()
                    .or_else(|| value(Quantity::WorkspaceRadius).filter(|radius| *radius > 0.0))
                    .ok_or(LocalFault::Unknown("workspace radius"))?,
            ),
            region => region.clone(),
        };
        let Some(objective) = settings.objectives.get(improved) else {
            return Err(LocalFault::Unknown("objective"));
        };
        let mut question = self.question_for(region, *objective, evaluation.design.architecture());
        let others = settings.objectives.iter().filter(|other| *other != objective);
        for objective in others {
            let quantity = objective.quantity;
            let held = value(quantity).ok_or(LocalFault::Unknown(quantity.entry().label))?;
            question.hold(*objective, held);
        }
        Ok(LocalDesign {
            problem: LocalProblem::new(question, &evaluation.design)?,
            design: evaluation.design,
            home: evaluation.home_phi_deg.map(f64::to_radians),
            entries: self.other_entries(&evaluation.design),
            scale: match (stated(Quantity::WorkspaceRadius), evaluation.workspace_radius()) {
                (Some(radius), own) if own > 0.0 => radius / own,
                _ => 1.0,
            },
        })
    }

    /// Returns the question of the study for a region of known size.
    fn question_for(&self, region: Region, objective: Objective, architecture: Architecture) -> LocalQuestion {
        let settings = self.model().settings();
        LocalQuestion {
            workspace: WorkspaceSpec {
                region,
                ..settings.workspace.clone()
            },
            objective,
            variables: self.free_variables(architecture),
            is_of_bars: false,
            slack: 0.0,
            settings: settings.clone(),
        }
    }

    /// Returns the workspace radius that is a limit, where it is no objective \[m\].
    fn held_radius(&self) -> Option<f64> {
        self.least_radius().filter(|_| !self.maximises_radius())
    }
}

impl LocalDesign {
    /// Returns the best design near the given one: near its own home orientation, or else near any other.
    ///
    /// # Errors
    /// [`LocalFault::Infeasible`] if none keeps every requirement.
    pub fn best(&self) -> Result<Polished, LocalFault> {
        let found = self.optimum().or_else(|| self.problem.best(&self.design, None));
        found.ok_or_else(|| LocalFault::Infeasible(Box::new(self.design)))
    }

    /// Returns the optimum near the given design and its home orientation, if there is one.
    pub fn optimum(&self) -> Option<Polished> {
        // A similar design has the radius that is kept, unless bounds are in the way.
        let scaled = self
            .problem
            .scaled(&self.design, self.scale)
            .filter(|scaled| *scaled != self.design);
        let from_home = |start: Design| self.home.and_then(|home| self.problem.polish(&start, home));
        let mut found = [scaled, Some(self.design)].into_iter().flatten().filter_map(from_home);
        found.find(Polished::is_optimal)
    }
}
