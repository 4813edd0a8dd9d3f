//! Designs as rows of a table, and the reading of such tables.

use std::path::{Path, PathBuf};

use super::Study;
use kinefront_model::evaluation::{Constraint, Evaluation};
use kinefront_model::mechanism::{DESIGN_VARIABLES, Design};

/// Stored values of one design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Number of the generation, counted from 1.
    pub generation: u32,
    /// The design.
    pub design: Design,
    /// Mass in motion \[kg\].
    pub mass: f64,
    /// Workspace radius `R_w` \[m\]; 0 for an infeasible design.
    pub radius: f64,
    /// Home orientation `φ_c` \[deg\]; `None` for an infeasible design.
    pub phi: Option<f64>,
    /// Constraint violation; 0 for a feasible design.
    pub violation: f64,
    /// Relative margins in the order of [`Constraint::ALL`]; `None` for a constraint that the study does not require.
    pub margins: [Option<f64>; Constraint::ALL.len()],
    /// Smallest clearance of members that are not joined \[m\], whether or not the study requires a clearance; `None`
    /// if no pose has one, and for tables of earlier versions.
    pub clearance: Option<f64>,
    /// Bit set of the active constraints; the lowest bit is that of the first constraint.
    pub active: u8,
}

impl Row {
    /// Creates the row of an evaluation.
    pub fn new(generation: usize, evaluation: &Evaluation) -> Self {
        Self {
            generation: generation.try_into().unwrap_or(u32::MAX),
            design: evaluation.design,
            mass: evaluation.mass,
            radius: evaluation.workspace_radius,
            phi: evaluation.home_phi_deg,
            violation: evaluation.violation,
            margins: evaluation.constraints.map(|report| report.required_margin()),
            clearance: evaluation.clearance(),
            active: bits(evaluation.active()),
        }
    }

    /// Reads a row from texts and numbers that are named as the columns of `designs.csv`.
    ///
    /// # Errors
    /// A message that names the missing or invalid value.
    pub fn read<'a>(
        study: &Study,
        generation: usize,
        text: impl Fn(&str) -> Option<&'a str>,
        number: impl Fn(&str) -> Option<f64>,
    ) -> Result<Self, String> {
        let wanted = |name: &str| number(name).ok_or_else(|| format!("`{name}` is missing or not a number"));
        let architecture = text("architecture")
            .ok_or("`architecture` is missing")?
            .parse()
            .map_err(|error| format!("{error}"))?;
        let mode = match text("working_mode") {
            Some(mode) => mode.parse().map_err(|error| format!("{error}"))?,
            None => study.working_mode,
        };
        let mut values = [0.0; DESIGN_VARIABLES.len()];
        for (value, variable) in values.iter_mut().zip(DESIGN_VARIABLES) {
            *value = wanted(variable.key())?;
        }
        let design = Design::new(architecture, mode, values).map_err(|error| error.to_string())?;
        let required = study.thresholds();
        let mut margins = [None; Constraint::ALL.len()];
        for (margin, constraint) in margins.iter_mut().zip(Constraint::ALL) {
            if constraint.is_required(&required) {
                *margin = Some(wanted(&format!("margin_{}", constraint.id()))?);
            }
        }
        let active = text("active").unwrap_or_default();
        let named = |constraint: &Constraint| active.split('+').any(|id| id == constraint.id());
        Ok(Self {
            generation: generation.try_into().unwrap_or(u32::MAX),
            design,
            mass: wanted("mass_kg")?,
            radius: wanted("workspace_radius_m")?,
            phi: number("phi_deg"),
            violation: wanted("violation")?,
            margins,
            clearance: number(&format!("value_{}", Constraint::Clearance.id())),
            active: bits(Constraint::ALL.into_iter().filter(named)),
        })
    }

    /// Returns both objectives, which are minimised.
    pub fn objectives(&self) -> [f64; 2] {
        [self.mass, -self.radius]
    }

    /// Iterates over the active constraints.
    pub fn active_constraints(&self) -> impl Iterator<Item = Constraint> {
        let active = self.active;
        Constraint::ALL
            .into_iter()
            .filter(move |&constraint| active & bits([constraint]) != 0)
    }
}

/// Returns the bit set of the constraints.
fn bits(constraints: impl IntoIterator<Item = Constraint>) -> u8 {
    constraints
        .into_iter()
        .fold(0, |bits, constraint| bits | 1 << constraint as u8)
}

/// A row of `designs.csv` or `front.csv`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TableRow {
    /// Id of the design in its run.
    pub id: usize,
    /// Stored values of the design.
    pub row: Row,
    /// Workspace radius `R_w` on the reference grid \[m\]; only the table of a front has it.
    pub reference_radius: Option<f64>,
}

/// Error of reading a table of a run.
#[derive(Debug, thiserror::Error)]
#[error("{}: {message}", path.display())]
pub struct TableError {
    /// Path of the file.
    pub path: PathBuf,
    /// Message that says what is wrong, and where.
    pub message: String,
}

/// Reads `designs.csv` or `front.csv` of a run of `study`. An incomplete last line, as a killed run leaves it, is
/// ignored.
///
/// # Errors
/// [`TableError`] with the line and a description of the error in it.
pub fn read_table(path: &Path, study: &Study) -> Result<Vec<TableRow>, TableError> {
    let fault = |message: String| TableError {
        path: path.to_owned(),
        message,
    };
    let mut reader = csv::Reader::from_path(path).map_err(|error| fault(error.to_string()))?;
    let header = reader.headers().map_err(|error| fault(error.to_string()))?.clone();
    let place = |name: &str| header.iter().position(|title| title == name);
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = match record {
            Ok(record) => record,
            // A run that was killed may leave an incomplete last line.
            Err(error) if matches!(error.kind(), csv::ErrorKind::UnequalLengths { .. }) && !rows.is_empty() => break,
            Err(error) => return Err(fault(error.to_string())),
        };
        let line = record.position().map_or(0, csv::Position::line);
        let text = |name: &str| record.get(place(name)?);
        let number = |name: &str| text(name)?.parse::<f64>().ok();
        let whole = |name: &str| {
            number(name)
                .map(|value| value as usize)
                .ok_or_else(|| fault(format!("line {line}: `{name}` is missing or not a number")))
        };
        let row = Row::read(study, whole("generation")?, text, number)
            .map_err(|message| fault(format!("line {line}: {message}")))?;
        rows.push(TableRow {
            id: whole("id")?,
            row,
            reference_radius: number("workspace_radius_reference_m"),
        });
    }
    Ok(rows)
}
