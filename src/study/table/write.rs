//! Writing tables of designs as CSV.

use std::io::{self, Write};

use super::{Cell, Column};

/// A CSV table that grows row by row.
#[derive(Debug)]
pub struct TableWriter<W: Write>(csv::Writer<W>);

impl<W: Write> TableWriter<W> {
    /// Begins a table with the names of its columns.
    ///
    /// # Errors
    /// The error of the file.
    pub fn new(file: W, columns: impl IntoIterator<Item = Column>) -> io::Result<Self> {
        let mut table = csv::Writer::from_writer(file);
        let names: Vec<_> = columns.into_iter().map(Column::name).collect();
        table.write_record(names.iter().map(|name| name.as_bytes()))?;
        table.flush()?;
        Ok(Self(table))
    }

    /// Writes one row, a cell for each column.
    ///
    /// # Errors
    /// The error of the file.
    pub fn write(&mut self, cells: impl IntoIterator<Item = Cell>) -> io::Result<()> {
        for cell in cells {
            self.0.write_field(cell.to_string())?;
        }
        Ok(self.0.write_record(None::<&[u8]>)?)
    }

    /// Hands all rows to the file.
    ///
    /// # Errors
    /// The error of the file.
    pub fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

/// Returns a whole table as CSV.
///
/// # Errors
/// When a row has not a cell for each column.
pub fn table_bytes(
    columns: impl IntoIterator<Item = Column>,
    rows: impl IntoIterator<Item = Vec<Cell>>,
) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut table = TableWriter::new(&mut bytes, columns)?;
    for row in rows {
        table.write(row)?;
    }
    table.flush()?;
    drop(table);
    Ok(bytes)
}
