//! Reading tables of designs.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use super::row::read_design;
use super::{Column, ColumnType, Row, RowError, TableRow};
use crate::{CertifiedWorkspace, Study, open_regular};
use kinefront_model::evaluation::Constraint;
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

impl TableError {
    /// Converts what is wrong with the table at `path`.
    pub(crate) fn at(path: &Path) -> impl Fn(TableFault) -> Self {
        move |fault| Self {
            path: path.to_owned(),
            fault,
        }
    }
}

/// What is wrong with a table.
#[derive(Debug, thiserror::Error)]
pub enum TableFault {
    /// The file cannot be read.
    #[error("cannot read the table: {0}")]
    Read(#[from] io::Error),
    /// The file is not CSV.
    #[error("line {line}: {message}")]
    Csv {
        /// Line in the file, from 1.
        line: u64,
        /// What is wrong in it.
        message: String,
    },
    /// Columns are missing.
    #[error("line 1: the columns {} are missing; is this a table of designs?", .0.join(", "))]
    Columns(Vec<String>),
    /// The columns are not those of this version, in their order.
    #[error("line 1: the columns or their order differ from designs.csv of this version; no rows can be appended")]
    Header,
    /// A row is invalid.
    #[error("line {line}: {error}")]
    Row {
        /// Line in the file, from 1.
        line: u64,
        /// What is wrong in it.
        error: RowError,
    },
    /// Rows of a run are missing, duplicated or out of order.
    #[error(
        "line {line}: the id is {found}, but {expected} was expected; rows are missing, duplicated or out of order"
    )]
    Order {
        /// Line in the file, from 1.
        line: u64,
        /// Id of the row.
        found: usize,
        /// Id that follows the row before.
        expected: usize,
    },
    /// The generation of a row does not follow that of the row before.
    #[error("line {line}: generation {found} does not follow generation {before}")]
    Generation {
        /// Line in the file, from 1.
        line: u64,
        /// Generation of the row.
        found: u32,
        /// Generation of the row before.
        before: u32,
    },
    /// A design of a recording is invalid.
    #[error("design #{index}: {error}")]
    Design {
        /// Index of the design, from 0.
        index: usize,
        /// What is wrong with it.
        error: RowError,
    },
    /// The file is not the one that the run wrote.
    #[error("{0}")]
    Differs(#[from] crate::Difference),
}

/// The rows of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct TableContents {
    /// The complete rows.
    pub rows: Vec<TableRow>,
    /// Line of an incomplete last row, left by a run that was killed while it wrote; the row is ignored.
    pub cut_line: Option<u64>,
}

/// Reads `designs.csv` or `front.csv` of a run of `study`. A last row without its end of line is incomplete and is
/// ignored; every other row must be complete and valid.
///
/// # Errors
/// [`TableError`], which names the line and what is wrong in it.
pub fn read_table(path: &Path, study: &Study) -> Result<TableContents, TableError> {
    let read = || -> Result<TableContents, TableFault> {
        let mut reader = TableReader::open(path)?;
        reader.require(Column::common().chain([Column::Violation]))?;
        let mut rows = reader.rows(|fields| fields.table_row(study))?;
        // A row that happens to parse may still be cut within its last number.
        let cut_line = reader.is_cut.then_some(reader.line);
        if reader.is_cut && reader.last_parsed {
            rows.pop();
        }
        Ok(TableContents { rows, cut_line })
    };
    read().map_err(TableError::at(path))
}

/// Reads the table of all designs of a run, whose ids count from 0 without gaps and whose generations never decrease.
///
/// # Errors
/// [`TableError`], which names the line and what is wrong in it.
pub fn read_run_table(path: &Path, study: &Study) -> Result<TableContents, TableError> {
    let contents = read_table(path, study)?;
    check_order(&contents.rows).map_err(TableError::at(path))?;
    Ok(contents)
}

/// Checks that ids count from 0 without gaps, and that generations count from 1 without gaps.
fn check_order(rows: &[TableRow]) -> Result<(), TableFault> {
    let mut before = 0;
    for ((expected, row), line) in rows.iter().enumerate().zip(2..) {
        if row.id != expected {
            let found = row.id;
            return Err(TableFault::Order { line, found, expected });
        }
        let found = row.row.generation;
        if found != before && found != before + 1 || found == 0 {
            return Err(TableFault::Generation { line, found, before });
        }
        before = found;
    }
    Ok(())
}

/// Reads the ids and designs of any table that has the columns `id`, `architecture` and the dimensions; the column
/// `working_mode` is optional, and whatever else the table has is ignored.
///
/// # Errors
/// As [`read_table`].
pub fn read_designs(path: &Path, study: &Study) -> Result<Vec<(usize, Design)>, TableError> {
    let read = || -> Result<Vec<(usize, Design)>, TableFault> {
        let mut reader = TableReader::open(path)?;
        reader.require(
            Column::of_designs(study)
                .filter(|column| matches!(column, Column::Id | Column::Architecture | Column::Dimension(_))),
        )?;
        reader.rows(|fields| {
            let design = read_design(study, |column| fields.text(column), |column| fields.number(column))?;
            Ok((fields.whole(Column::Id)?, design))
        })
    };
    read().map_err(TableError::at(path))
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
        finite(self.text(column)?)
    }

    fn whole(&self, column: Column) -> Result<usize, RowError> {
        let value = self.text(column).and_then(|text| text.parse().ok());
        value.ok_or(RowError::Value(column))
    }

    /// Checks that every known field is a value of its column: a damaged one must not read as missing.
    fn check(&self) -> Result<(), RowError> {
        for (column, text) in self.columns.iter().zip(self.record) {
            let Some(column) = *column else { continue };
            let is_value = match column.kind() {
                ColumnType::Integer => text.parse::<u64>().is_ok(),
                ColumnType::Number if text.is_empty() => column.is_optional(),
                ColumnType::Number => finite(text).is_some(),
                ColumnType::Flag => matches!(text, "true" | "false"),
                ColumnType::Text if column == Column::Active => is_list_of_constraints(text),
                ColumnType::Text if column == Column::Certificate => {
                    matches!(text, "" | CertifiedWorkspace::PROVED | CertifiedWorkspace::OPEN)
                }
                ColumnType::Text => true,
            };
            if !is_value {
                return Err(RowError::Value(column));
            }
        }
        Ok(())
    }

    fn certified(&self, study: &Study) -> Result<Option<CertifiedWorkspace>, RowError> {
        let state = self.text(Column::Certificate).filter(|state| !state.is_empty());
        let Some(state) = state else { return Ok(None) };
        let lower = self.number(Column::CertifiedLower);
        Ok(Some(CertifiedWorkspace {
            lower: lower.ok_or(RowError::Value(Column::CertifiedLower))?,
            upper: self.number(Column::CertifiedUpper),
            is_proved: state == CertifiedWorkspace::PROVED,
            is_of_region: study.workspace.region.is_prescribed(),
        }))
    }

    fn table_row(&self, study: &Study) -> Result<TableRow, RowError> {
        self.check()?;
        let row = Row::read(
            study,
            self.whole(Column::Generation)?,
            |column| self.text(column),
            |column| self.number(column),
        )?;
        let stated = self.text(Column::Feasible);
        if stated.is_some_and(|stated| stated != row.is_feasible().to_string()) {
            return Err(RowError::Value(Column::Feasible));
        }
        if row.is_feasible() && row.phi.is_none() {
            return Err(RowError::Value(Column::HomePhi));
        }
        Ok(TableRow {
            id: self.whole(Column::Id)?,
            row,
            reference_radius: self.number(Column::ReferenceRadius),
            certified: self.certified(study)?,
            drive: self.drive(study)?,
        })
    }

    fn drive(&self, study: &Study) -> Result<Option<usize>, RowError> {
        let Some(name) = self.text(Column::Drive).filter(|name| !name.is_empty()) else {
            return Ok(None);
        };
        let place = study.drives.drives().ok().and_then(|drives| drives.find(name));
        place.map(Some).ok_or(RowError::Value(Column::Drive))
    }
}

fn finite(text: &str) -> Option<f64> {
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

fn is_list_of_constraints(text: &str) -> bool {
    text.is_empty()
        || text
            .split('+')
            .all(|id| Constraint::ALL.iter().any(|constraint| constraint.id() == id))
}

/// Largest length of a line of a table \[bytes\].
const LONGEST_LINE: usize = 1 << 16;

/// A file whose lines are limited: what is not a table may be one line without an end.
struct LineLimit {
    file: File,
    /// Bytes since the last end of a line.
    since: usize,
}

impl Read for LineLimit {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.file.read(buffer)?;
        let read = &buffer[..count];
        self.since = match read.iter().rposition(|&byte| byte == b'\n') {
            Some(end) => count - end - 1,
            None => self.since + count,
        };
        if self.since > LONGEST_LINE {
            let message = format!("it has a line of more than {LONGEST_LINE} bytes; is it a table of designs?");
            return Err(io::Error::new(io::ErrorKind::InvalidData, message));
        }
        Ok(count)
    }
}

/// Reads a table line by line.
struct TableReader {
    records: csv::Reader<BufReader<LineLimit>>,
    columns: Vec<Option<Column>>,
    record: csv::StringRecord,
    length: u64,
    /// Whether the last line lacks its end.
    ends_open: bool,
    /// Line of the current row.
    line: u64,
    /// Whether the last row is incomplete.
    is_cut: bool,
    /// Whether the incomplete last row could be parsed all the same.
    last_parsed: bool,
}

impl TableReader {
    fn open(path: &Path) -> Result<Self, TableFault> {
        let mut file = open_regular(path, u64::MAX)?;
        let length = file.metadata()?.len();
        let mut last = [b'\n'];
        if length > 0 {
            file.seek(SeekFrom::End(-1))?;
            file.read_exact(&mut last)?;
            file.rewind()?;
        }
        let mut records = csv::Reader::from_reader(BufReader::new(LineLimit { file, since: 0 }));
        let columns = match records.headers() {
            Ok(header) => header.iter().map(Column::find).collect(),
            Err(error) => return Err(csv_fault(&error, 1)),
        };
        Ok(Self {
            records,
            columns,
            record: csv::StringRecord::new(),
            length,
            ends_open: last != [b'\n'],
            line: 1,
            is_cut: false,
            last_parsed: false,
        })
    }

    fn require(&self, columns: impl Iterator<Item = Column>) -> Result<(), TableFault> {
        let missing: Vec<String> = columns
            .filter(|column| !self.columns.contains(&Some(*column)))
            .map(|column| column.name().into_owned())
            .collect();
        if missing.is_empty() {
            Ok(())
        } else {
            Err(TableFault::Columns(missing))
        }
    }

    /// Reads the rows up to the end, or to an incomplete last row that does not parse.
    fn rows<T>(&mut self, parse: impl Fn(&Fields<'_>) -> Result<T, RowError>) -> Result<Vec<T>, TableFault> {
        let mut rows = Vec::new();
        loop {
            self.line = self.records.position().line();
            let found = self.records.read_record(&mut self.record);
            // The reader reaches the end of the file with the last line only.
            let position = self.records.position();
            // A row that begins on an earlier line was not cut: a quotation mark that is not closed swallowed the others.
            let is_open = self.ends_open && position.byte() >= self.length && position.line() <= self.line;
            let line = self.line;
            let parsed = match found {
                Ok(false) => return Ok(rows),
                Ok(true) => {
                    let fields = Fields {
                        columns: &self.columns,
                        record: &self.record,
                    };
                    parse(&fields).map_err(|error| TableFault::Row { line, error })
                }
                Err(error) => Err(csv_fault(&error, line)),
            };
            self.is_cut = is_open;
            self.last_parsed = is_open && parsed.is_ok();
            match parsed {
                Ok(row) => rows.push(row),
                Err(_) if is_open => return Ok(rows),
                Err(fault) => return Err(fault),
            }
        }
    }
}

fn csv_fault(error: &csv::Error, line: u64) -> TableFault {
    let message = match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            format!("the row has {len} fields, but the header has {expected_len}")
        }
        csv::ErrorKind::Utf8 { .. } => "the row is not UTF-8 text".to_owned(),
        _ => error.to_string(),
    };
    TableFault::Csv { line, message }
}
