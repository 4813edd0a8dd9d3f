//! Writing tables of designs as CSV.

use std::io;

use super::{Cell, Column};

/// Returns rows as CSV, without a header.
///
/// # Errors
/// When the rows differ in their number of cells.
pub(crate) fn rows_as_csv(rows: impl IntoIterator<Item = Vec<Cell>>) -> io::Result<Vec<u8>> {
    let mut table = csv::Writer::from_writer(Vec::new());
    for row in rows {
        table.write_record(row.iter().map(Cell::to_string))?;
    }
    table.into_inner().map_err(|error| error.into_error())
}

/// Returns a whole table as CSV.
///
/// # Errors
/// When a row has not a cell for each column.
pub fn table_bytes(
    columns: impl IntoIterator<Item = Column>,
    rows: impl IntoIterator<Item = Vec<Cell>>,
) -> io::Result<Vec<u8>> {
    let header = columns.into_iter().map(|column| Cell::Text(column.name())).collect();
    rows_as_csv(std::iter::once(header).chain(rows))
}
