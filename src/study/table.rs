//! Designs as rows of a table, and reading them back.

use std::path::{Path, PathBuf};

use super::Study;
use kinefront_model::evaluation::{Constraint, Evaluation};
use kinefront_model::mechanism::{Design, VARIABLES};

/// What is stored of one design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Generation, from 1.
    pub generation: u32,
    /// The design.
    pub design: Design,
    /// Mass in motion \[kg\].
    pub mass: f64,
    /// `R_w` \[m\]; 0 for an infeasible design.
    pub radius: f64,
    /// `φ_c` \[deg\].
    pub phi: Option<f64>,
    /// Violation, 0 for a feasible design.
    pub violation: f64,
    /// Relative margins in the order of [`Constraint::ALL`], of those that the study asks for.
    pub margins: [Option<f64>; Constraint::ALL.len()],
    /// Least clearance of bodies that are not joined \[m\], asked for or not; `None` where no pose has one, and in tables
    /// of earlier versions.
    pub clearance: Option<f64>,
    /// A bit for each active constraint, the first the lowest.
    pub active: u8,
}

impl Row {
    /// The row of an evaluation.
    pub fn new(generation: usize, evaluation: &Evaluation) -> Self {
        Self {
            generation: generation.try_into().unwrap_or(u32::MAX),
            design: evaluation.design,
            mass: evaluation.mass,
            radius: evaluation.workspace_radius,
            phi: evaluation.home_phi_deg,
            violation: evaluation.violation,
            margins: evaluation.constraints.map(|report| report.asked_margin()),
            clearance: evaluation.clearance(),
            active: bits(evaluation.active()),
        }
    }

    /// The row of named texts and numbers, as in `designs.csv`.
    ///
    /// # Errors
    /// What is missing or wrong, in words.
    pub fn read<'a>(
        study: &Study,
        generation: usize,
        text: impl Fn(&str) -> Option<&'a str>,
        number: impl Fn(&str) -> Option<f64>,
    ) -> Result<Self, String> {
        let wanted = |name: &str| number(name).ok_or_else(|| format!("no number `{name}`"));
        let architecture = text("architecture")
            .ok_or("no `architecture`")?
            .parse()
            .map_err(|error| format!("{error}"))?;
        let mode = match text("working_mode") {
            Some(mode) => mode.parse().map_err(|error| format!("{error}"))?,
            None => study.working_mode,
        };
        let mut values = [0.0; VARIABLES.len()];
        for (value, variable) in values.iter_mut().zip(VARIABLES) {
            *value = wanted(variable.key())?;
        }
        let design = Design::new(architecture, mode, values).map_err(|error| error.to_string())?;
        let asked = study.model().thresholds;
        let mut margins = [None; Constraint::ALL.len()];
        for (margin, constraint) in margins.iter_mut().zip(Constraint::ALL) {
            if constraint.is_asked(&asked) {
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

    /// Both objectives, minimised.
    pub fn objectives(&self) -> [f64; 2] {
        [self.mass, -self.radius]
    }

    /// The active constraints.
    pub fn active_constraints(&self) -> impl Iterator<Item = Constraint> {
        let active = self.active;
        Constraint::ALL
            .into_iter()
            .filter(move |&constraint| active & bits([constraint]) != 0)
    }
}

/// A bit for each of the constraints.
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
    /// Its numbers.
    pub row: Row,
    /// `R_w` on the reference grid \[m\], in a front's table.
    pub reference_radius: Option<f64>,
}

/// A table of a run that cannot be read.
#[derive(Debug, thiserror::Error)]
#[error("{}: {message}", path.display())]
pub struct TableError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong, and where.
    pub message: String,
}

/// Reads `designs.csv` or `front.csv` of a run of `study`. Half a line at the end, as a killed run leaves it, is left out.
///
/// # Errors
/// [`TableError`] with the line and what is wrong in it.
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
            // The last line of a run that was killed may be half a line.
            Err(error) if matches!(error.kind(), csv::ErrorKind::UnequalLengths { .. }) && !rows.is_empty() => break,
            Err(error) => return Err(fault(error.to_string())),
        };
        let line = record.position().map_or(0, csv::Position::line);
        let text = |name: &str| record.get(place(name)?);
        let number = |name: &str| text(name)?.parse::<f64>().ok();
        let whole = |name: &str| {
            number(name)
                .map(|value| value as usize)
                .ok_or_else(|| fault(format!("line {line}: no `{name}`")))
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
