//! What a local problem asks, and what of it is held or left free.

use kinefront_model::evaluation::{Bound, ModelSettings, Objective, Quantity, QuantityLimit};
use kinefront_model::mechanism::DesignVariable;
use kinefront_model::workspace::WorkspaceSpec;

/// A variable that may change, and those that follow it.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeVariable {
    /// The variable.
    pub variable: DesignVariable,
    /// Smallest and largest value \[m or deg\].
    pub range: [f64; 2],
    /// Variables that are this one times a factor.
    pub tied: Vec<(DesignVariable, f64)>,
}

/// What a local problem asks: the best design near a given one for a fixed region.
#[derive(Debug, Clone, PartialEq)]
pub struct LocalQuestion {
    /// The model with all requirements. Its workspace and its objectives are not used.
    pub settings: ModelSettings,
    /// The region, whose size is known; its centre, the rotation range, and the home orientation if it is prescribed.
    pub workspace: WorkspaceSpec,
    /// What is minimised or maximised.
    pub objective: Objective,
    /// The variables that may change; every other one keeps the value of the design.
    pub variables: Vec<FreeVariable>,
    /// Whether only what depends on the bars is required.
    pub is_of_bars: bool,
    /// Slack that every requirement keeps, as a logarithm or a share of `R`.
    pub slack: f64,
}

impl LocalQuestion {
    /// Requires that a quantity is no worse than a value; a limit that is stricter already stays.
    pub fn hold(&mut self, objective: Objective, value: f64) {
        let better = objective.quantity.entry().better;
        match objective.quantity {
            Quantity::WorkspaceRadius => {}
            Quantity::Worst(scalar) if better == objective.goal => {
                let stated = self.settings.thresholds.get(scalar);
                let limit = stated.map_or(value, |stated| scalar.stricter(stated, value));
                self.settings.thresholds.set(scalar, Some(limit));
            }
            quantity => self.settings.limits.push(QuantityLimit {
                quantity,
                bound: Bound::no_worse_than(value, objective.goal),
            }),
        }
    }

    /// Returns the same question with the bars alone free, for a home orientation \[deg\].
    pub fn of_bars(&self, home_deg: f64) -> Self {
        let is_bar = |free: &&FreeVariable| free.variable.may_be_zero();
        Self {
            variables: self.variables.iter().filter(is_bar).cloned().collect(),
            workspace: WorkspaceSpec {
                home_phi_deg: Some(home_deg),
                ..self.workspace.clone()
            },
            is_of_bars: true,
            ..self.clone()
        }
    }
}
