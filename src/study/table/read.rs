//! Reading tables of designs.

use std::path::{Path, PathBuf};

use super::{Column, Row, RowError, TableRow};
use crate::study::Study;

/// A table of a run that cannot be read.
#[derive(Debug, thiserror::Error)]
#[error("{}: {fault}", path.display())]
pub struct TableError {
    /// Path of the file.
    pub path: PathBuf,
    /// What is wrong, and where.
    pub fault: TableFault,
}

/// What is wrong with a table.
#[derive(Debug, thiserror::Error)]
pub enum TableFault {
    /// The file cannot be read as CSV.
    #[error(transparent)]
    Csv(#[from] csv::Error),
    /// A row is invalid.
    #[error("line {line}: {error}")]
    Row {
        /// Line in the file, from 1.
        line: u64,
        /// What is wrong in it.
        error: RowError,
    },
    /// A design of a recording is invalid.
    #[error("design #{index}: {error}")]
    Design {
        /// Index of the design, from 0.
        index: usize,
        /// What is wrong with it.
        error: RowError,
    },
}

/// Reads `designs.csv` or `front.csv` of a run of `study`. An incomplete last line, left by a run that was killed, is
/// ignored; every other line must be whole.
///
/// # Errors
/// [`TableError`], which names the line and what is wrong in it.
pub fn read_table(path: &Path, study: &Study) -> Result<Vec<TableRow>, TableError> {
    read(path, study).map_err(|fault| TableError {
        path: path.to_owned(),
        fault,
    })
}

fn read(path: &Path, study: &Study) -> Result<Vec<TableRow>, TableFault> {
    let mut reader = csv::Reader::from_path(path)?;
    let columns: Vec<Option<Column>> = reader.headers()?.iter().map(Column::find).collect();
    let mut rows = Vec::new();
    let mut records = reader.records().peekable();
    while let Some(record) = records.next() {
        let record = match record {
            Ok(record) => record,
            Err(error) => {
                let is_short = matches!(error.kind(), csv::ErrorKind::UnequalLengths { .. });
                if is_short && !rows.is_empty() && records.peek().is_none() {
                    break;
                }
                return Err(error.into());
            }
        };
        let line = record.position().map_or(0, csv::Position::line);
        rows.push(table_row(&columns, &record, study).map_err(|error| TableFault::Row { line, error })?);
    }
    Ok(rows)
}

fn table_row(columns: &[Option<Column>], record: &csv::StringRecord, study: &Study) -> Result<TableRow, RowError> {
    let text = |column: Column| record.get(columns.iter().position(|&found| found == Some(column))?);
    let number = |column: Column| text(column)?.parse::<f64>().ok();
    let whole = |column: Column| {
        let value = text(column).and_then(|text| text.parse::<usize>().ok());
        value.ok_or(RowError::Value(column))
    };
    Ok(TableRow {
        id: whole(Column::Id)?,
        row: Row::read(study, whole(Column::Generation)?, text, number)?,
        reference_radius: number(Column::ReferenceRadius),
    })
}
