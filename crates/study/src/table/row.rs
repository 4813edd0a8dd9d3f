//! Designs as rows of a table.

use std::fmt;

use super::Column;
use crate::{CertifiedWorkspace, Study};
use kinefront_model::evaluation::{Constraint, ConstraintSet, Evaluation, Quantity, QuantityValues};
use kinefront_model::mechanism::{DESIGN_VARIABLES, Design, DesignError, TextError};
use kinefront_optimize::{Objectives, Outcome};

/// Stored values of one design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Number of the generation, counted from 1.
    pub generation: u32,
    /// The design.
    pub design: Design,
    /// Home orientation `φ_c` \[deg\]; `None` for an infeasible design.
    pub phi: Option<f64>,
    /// Constraint violation; 0 for a feasible design.
    pub violation: f64,
    /// Relative margins in the order of [`Constraint::ALL`]; `None` for a constraint that the study does not require.
    pub margins: [Option<f64>; Constraint::COUNT],
    /// The active constraints.
    pub active: ConstraintSet,
    /// Quantities that every evaluation determines, and those that the study names.
    pub quantities: QuantityValues,
    /// The objectives of the study, as they are minimised.
    pub objectives: Objectives,
}

/// Why texts and numbers are not a row.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RowError {
    /// A value is missing, or it is not of the type of its column.
    #[error("`{name}` is missing or not {kind}", name = .0.name(), kind = Expected(*.0))]
    Value(Column),
    /// The architecture or the working mode is unknown.
    #[error(transparent)]
    Text(#[from] TextError),
    /// The dimensions are not those of a design.
    #[error(transparent)]
    Design(#[from] DesignError),
}

struct Expected(Column);

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self.0.kind() {
            super::ColumnType::Integer => "a whole number",
            super::ColumnType::Number => "a number",
            super::ColumnType::Flag => "true or false",
            super::ColumnType::Text => "a text",
        })
    }
}

impl Row {
    /// Creates the row of an evaluation.
    pub fn new(generation: usize, evaluation: &Evaluation) -> Self {
        Self {
            generation: generation.try_into().unwrap_or(u32::MAX),
            design: evaluation.design,
            phi: evaluation.home_phi_deg,
            violation: evaluation.violation,
            margins: evaluation.constraints.map(|result| result.required_margin()),
            active: evaluation.active().collect(),
            quantities: evaluation.quantities,
            objectives: Objectives::new(evaluation.objectives.iter().copied()),
        }
    }

    /// Reads a row from the texts and numbers of the columns of `designs.csv`.
    ///
    /// # Errors
    /// [`RowError`] for the first missing or invalid value.
    pub fn read<'a>(
        study: &Study,
        generation: usize,
        text: impl Fn(Column) -> Option<&'a str>,
        number: impl Fn(Column) -> Option<f64>,
    ) -> Result<Self, RowError> {
        let design = read_design(study, &text, &number)?;
        let expected = |column: Column| number(column).ok_or(RowError::Value(column));
        let thresholds = study.thresholds();
        let mut margins = [None; Constraint::COUNT];
        for (margin, constraint) in margins.iter_mut().zip(Constraint::ALL) {
            if constraint.is_required(&thresholds) {
                *margin = Some(expected(Column::Margin(constraint))?);
            }
        }
        let active = text(Column::Active).unwrap_or_default();
        let named = |constraint: &Constraint| active.split('+').any(|id| id == constraint.id());
        let objectives = study
            .objectives()
            .into_iter()
            .map(|objective| objective.minimised(number(Column::Quantity(objective.quantity))));
        // Every design has these two.
        for quantity in [Quantity::Mass, Quantity::WorkspaceRadius] {
            expected(Column::Quantity(quantity))?;
        }
        Ok(Self {
            generation: generation.try_into().unwrap_or(u32::MAX),
            design,
            phi: number(Column::HomePhi),
            violation: expected(Column::Violation)?,
            margins,
            active: Constraint::ALL.into_iter().filter(named).collect(),
            quantities: Quantity::all()
                .map(|quantity| (quantity, number(Column::Quantity(quantity))))
                .collect(),
            objectives: Objectives::new(objectives),
        })
    }

    /// Whether the design has a workspace and keeps all limits.
    pub fn is_feasible(&self) -> bool {
        self.violation <= 0.0
    }

    /// What the row tells an optimizer.
    pub(crate) fn outcome(&self) -> Outcome {
        Outcome {
            objectives: self.objectives,
            violation: self.violation,
        }
    }

    /// Mass in motion \[kg\].
    pub fn mass(&self) -> f64 {
        self.quantities.get(Quantity::Mass).unwrap_or(0.0)
    }

    /// Workspace radius `R_w` \[m\]; 0 for an infeasible design.
    pub fn workspace_radius(&self) -> f64 {
        self.quantities.get(Quantity::WorkspaceRadius).unwrap_or(0.0)
    }

    /// Smallest clearance of members that are not joined \[m\], whether or not the study requires a clearance; `None` if
    /// no pose has one, and for tables of earlier versions.
    pub fn clearance(&self) -> Option<f64> {
        self.quantities.get(Quantity::of_constraint(Constraint::Clearance))
    }

    /// Value of a numerical column, if the design has one.
    pub fn number(&self, column: Column) -> Option<f64> {
        match column {
            Column::Dimension(variable) => {
                let has_it = self.design.architecture().has(variable);
                has_it.then(|| self.design.value(variable))
            }
            Column::HomePhi => self.phi,
            Column::Margin(constraint) => self.margins[constraint as usize],
            Column::Violation => Some(self.violation),
            Column::Quantity(quantity) => self.quantities.get(quantity),
            _ => None,
        }
    }
}

/// Reads the design of a row from the texts and numbers of its columns; a design without a working mode has that of the study, and the
/// variables of its chain that are not given follow from the others.
///
/// # Errors
/// [`RowError`] for the first missing or invalid value.
pub fn read_design<'a>(
    study: &Study,
    text: impl Fn(Column) -> Option<&'a str>,
    number: impl Fn(Column) -> Option<f64>,
) -> Result<Design, RowError> {
    let architecture = text(Column::Architecture)
        .ok_or(RowError::Value(Column::Architecture))?
        .parse()?;
    let mode = match text(Column::WorkingMode) {
        Some(mode) => mode.parse()?,
        None => study.working_mode,
    };
    let mut dimensions = [0.0; DESIGN_VARIABLES.len()];
    for (dimension, variable) in dimensions.iter_mut().zip(DESIGN_VARIABLES) {
        let column = Column::Dimension(variable);
        *dimension = number(column).ok_or(RowError::Value(column))?;
    }
    let design = Design::new(architecture, mode, dimensions)?;
    let further = architecture.further_variables().iter();
    let given = further.filter_map(|&variable| Some((variable, number(Column::Dimension(variable))?)));
    given
        .into_iter()
        .try_fold(design, |design, (variable, value)| Ok(design.with(variable, value)?))
}

/// A row of `designs.csv` or `front.csv`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TableRow {
    /// Id of the design in its run.
    pub id: usize,
    /// Values of the design.
    pub row: Row,
    /// `R_w` on the reference grid \[m\], in a verified front.
    pub reference_radius: Option<f64>,
    /// What is proved about `R_w`, in a front whose workspaces were proved.
    pub certified: Option<CertifiedWorkspace>,
    /// Place of the selected drive in the catalogue of the study, in a verified front.
    pub drive: Option<usize>,
}

impl TableRow {
    /// Makes the row of a design of which only the evaluation is known.
    pub fn new(id: usize, row: Row) -> Self {
        Self {
            id,
            row,
            reference_radius: None,
            certified: None,
            drive: None,
        }
    }
}
