//! Designs as the plot of a run places them.

use kinefront_model::evaluation::Evaluation;
use kinefront_model::mechanism::Architecture;
use kinefront_optimize::Objectives;
use kinefront_study::{Row, TableRow};

/// A design as a plot places it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PlotPoint {
    /// Id of the evaluation, if it has one.
    pub id: Option<usize>,
    /// The objectives, as they are minimised.
    pub objectives: Objectives,
    pub is_feasible: bool,
}

impl PlotPoint {
    pub fn of_row(id: usize, row: &Row) -> Self {
        Self {
            id: Some(id),
            objectives: row.objectives,
            is_feasible: row.is_feasible(),
        }
    }

    pub fn of_evaluation(id: Option<usize>, evaluation: &Evaluation) -> Self {
        Self {
            id,
            objectives: Objectives::new(evaluation.objectives.iter().copied()),
            is_feasible: evaluation.is_feasible(),
        }
    }
}

/// A design of the front as drawn in the plot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrontPoint {
    /// Id of the evaluation.
    pub id: usize,
    /// Architecture.
    pub architecture: Architecture,
    /// The objectives, as they are minimised.
    pub objectives: Objectives,
    /// Whether the design passes the filter; otherwise it is dimmed.
    pub passes_filter: bool,
}

impl FrontPoint {
    pub(super) fn at(&self) -> PlotPoint {
        PlotPoint {
            id: Some(self.id),
            objectives: self.objectives,
            is_feasible: true,
        }
    }
}

impl From<&TableRow> for FrontPoint {
    fn from(entry: &TableRow) -> Self {
        Self {
            id: entry.id,
            architecture: entry.row.design.architecture(),
            objectives: entry.row.objectives,
            passes_filter: true,
        }
    }
}
