//! Writing tables of designs as CSV.

use std::io::{self, Write};

use super::{Cell, Column};

/// Appends one row to a table.
///
/// # Errors
/// The error of the file.
pub(crate) fn append_row<W: Write>(
    table: &mut csv::Writer<W>,
    cells: impl IntoIterator<Item = Cell>,
) -> io::Result<()> {
    for cell in cells {
        table.write_field(cell.to_string())?;
    }
    Ok(table.write_record(None::<&[u8]>)?)
}

/// Returns a whole table as CSV.
///
/// # Errors
/// When a row has not a cell for each column.
pub fn table_bytes(
    columns: impl IntoIterator<Item = Column>,
    rows: impl IntoIterator<Item = Vec<Cell>>,
) -> io::Result<Vec<u8>> {
    let mut table = csv::Writer::from_writer(Vec::new());
    let names: Vec<_> = columns.into_iter().map(Column::name).collect();
    table.write_record(names.iter().map(|name| name.as_bytes()))?;
    for row in rows {
        append_row(&mut table, row)?;
    }
    table.into_inner().map_err(|error| error.into_error())
}
