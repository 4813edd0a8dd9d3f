//! Tables of designs: their columns, their rows, and the reading and writing of both.

mod cell;
mod column;
mod named;
mod read;
mod row;
mod write;

pub use cell::Cell;
pub use column::{Column, ColumnType};
pub(crate) use named::archive_of;
pub use named::{front_marks, is_row_name, named_row, row_names};
pub use read::{TableContents, TableError, TableFault, read_designs, read_run_table, read_table};
pub use row::{Row, RowError, TableRow, read_design};
pub(super) use write::rows_as_csv;
pub use write::table_bytes;
