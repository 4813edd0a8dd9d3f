//! Reading tables of designs.

use std::path::{Path, PathBuf};

use super::row::read_design;
use super::{Column, Row, RowError, TableRow};
use crate::study::Study;
use kinefront_model::mechanism::Design;

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
    read(path, |fields| {
        Ok(TableRow {
            id: fields.whole(Column::Id)?,
            row: Row::read(
                study,
                fields.whole(Column::Generation)?,
                |column| fields.text(column),
                |column| fields.number(column),
            )?,
            reference_radius: fields.number(Column::ReferenceRadius),
        })
    })
}

/// Reads the ids and designs of any table that has the columns `id`, `architecture`, `working_mode` and the dimensions;
/// whatever else it has is ignored.
///
/// # Errors
/// As [`read_table`].
pub fn read_designs(path: &Path, study: &Study) -> Result<Vec<(usize, Design)>, TableError> {
    read(path, |fields| {
        let design = read_design(study, |column| fields.text(column), |column| fields.number(column))?;
        Ok((fields.whole(Column::Id)?, design))
    })
}

/// The fields of a line, by column.
struct Fields<'a> {
    columns: &'a [Option<Column>],
    record: &'a csv::StringRecord,
}

impl<'a> Fields<'a> {
    fn text(&self, column: Column) -> Option<&'a str> {
        self.record
            .get(self.columns.iter().position(|&found| found == Some(column))?)
    }

    fn number(&self, column: Column) -> Option<f64> {
        self.text(column)?.parse().ok()
    }

    fn whole(&self, column: Column) -> Result<usize, RowError> {
        let value = self.text(column).and_then(|text| text.parse().ok());
        value.ok_or(RowError::Value(column))
    }
}

fn read<T>(path: &Path, row: impl Fn(&Fields<'_>) -> Result<T, RowError>) -> Result<Vec<T>, TableError> {
    read_rows(path, row).map_err(|fault| TableError {
        path: path.to_owned(),
        fault,
    })
}

fn read_rows<T>(path: &Path, row: impl Fn(&Fields<'_>) -> Result<T, RowError>) -> Result<Vec<T>, TableFault> {
    let mut reader = csv::Reader::from_path(path)?;
    let columns: Vec<Option<Column>> = reader.headers()?.iter().map(Column::find).collect();
    let mut rows = Vec::new();
    let mut records = reader.records().peekable();
    while let Some(record) = records.next() {
        let record = match record {
            Ok(record) => record,
            Err(error) => {
                let is_cut = matches!(
                    error.kind(),
                    csv::ErrorKind::UnequalLengths { expected_len, len, .. } if len < expected_len
                );
                if is_cut && !rows.is_empty() && records.peek().is_none() {
                    break;
                }
                return Err(error.into());
            }
        };
        let line = record.position().map_or(0, csv::Position::line);
        let fields = Fields {
            columns: &columns,
            record: &record,
        };
        rows.push(row(&fields).map_err(|error| TableFault::Row { line, error })?);
    }
    Ok(rows)
}
