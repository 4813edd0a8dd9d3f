//! Tables: named columns of one length, as NumPy arrays and through the C data interface of Arrow.

use std::sync::Arc;

use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::{ArrayRef, BooleanArray, Float64Array, Int64Array, RecordBatch, RecordBatchIterator, StringArray};
use arrow_schema::{DataType, Field, Schema};
use numpy::{IntoPyArray, PyReadonlyArray1};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyList};

use kinefront_study::{Cell, Column, ColumnType, TableRow};

use crate::errors::{InputError, of_run};

/// The values of a column.
enum Values {
    Number(Vec<f64>),
    Integer(Vec<i64>),
    Flag(Vec<bool>),
    Text(Vec<String>),
}

/// A column, as a NumPy array or, for texts, as a list.
struct NamedColumn {
    name: String,
    unit: &'static str,
    kind: ColumnType,
    values: Py<PyAny>,
}

/// Designs as named columns.
#[pyclass(name = "Table", module = "kinefront", frozen)]
pub struct PyTable {
    columns: Vec<NamedColumn>,
    rows: usize,
}

impl PyTable {
    /// Makes a table of the given columns of designs.
    pub(crate) fn new(py: Python<'_>, columns: &[Column], rows: &[TableRow]) -> PyResult<Self> {
        Self::with(py, columns, rows, |_, column, row| column.cell(row))
    }

    /// Makes a table whose cells `cell` gives for the place of a row, a column, and the row.
    pub(crate) fn with(
        py: Python<'_>,
        columns: &[Column],
        rows: &[TableRow],
        cell: impl Fn(usize, Column, &TableRow) -> Cell + Sync,
    ) -> PyResult<Self> {
        let filled: Vec<Values> = py.detach(|| {
            use rayon::prelude::*;
            columns.par_iter().map(|&column| values(column, rows, &cell)).collect()
        });
        let named = columns.iter().zip(filled).map(|(column, values)| {
            Ok(NamedColumn {
                name: column.name().into_owned(),
                unit: column.unit(),
                kind: column.kind(),
                values: to_python(py, values)?,
            })
        });
        Ok(Self {
            columns: named.collect::<PyResult<_>>()?,
            rows: rows.len(),
        })
    }

    fn find(&self, name: &str) -> PyResult<&NamedColumn> {
        self.columns.iter().find(|column| column.name == name).ok_or_else(|| {
            let names: Vec<&str> = self.columns.iter().map(|column| column.name.as_str()).collect();
            PyKeyError::new_err(format!("there is no column `{name}`; there are {}", names.join(", ")))
        })
    }

    fn batch(&self, py: Python<'_>) -> PyResult<RecordBatch> {
        let (mut fields, mut arrays) = (Vec::new(), Vec::new());
        for column in &self.columns {
            let values = column.values.bind(py);
            let (kind, array): (DataType, ArrayRef) = match column.kind {
                ColumnType::Number => {
                    let numbers: PyReadonlyArray1<'_, f64> = values.extract()?;
                    let numbers = numbers.as_array();
                    let known = numbers
                        .iter()
                        .map(|number| Some(*number).filter(|number| !number.is_nan()));
                    (DataType::Float64, Arc::new(known.collect::<Float64Array>()))
                }
                ColumnType::Integer => {
                    let numbers: PyReadonlyArray1<'_, i64> = values.extract()?;
                    (
                        DataType::Int64,
                        Arc::new(Int64Array::from_iter_values(numbers.as_array().iter().copied())),
                    )
                }
                ColumnType::Flag => {
                    let flags: PyReadonlyArray1<'_, bool> = values.extract()?;
                    let flags: Vec<bool> = flags.as_array().iter().copied().collect();
                    (DataType::Boolean, Arc::new(BooleanArray::from(flags)))
                }
                ColumnType::Text => {
                    let texts: Vec<String> = values.extract()?;
                    (DataType::Utf8, Arc::new(StringArray::from(texts)))
                }
            };
            fields.push(Field::new(&column.name, kind, column.kind == ColumnType::Number));
            arrays.push(array);
        }
        RecordBatch::try_new(Arc::new(Schema::new(fields)), arrays).map_err(of_run)
    }
}

fn values(column: Column, rows: &[TableRow], cell: impl Fn(usize, Column, &TableRow) -> Cell) -> Values {
    let cells = rows.iter().enumerate().map(|(place, row)| cell(place, column, row));
    match column.kind() {
        // The shortest way for what most columns are.
        ColumnType::Number => Values::Number(
            cells
                .map(|cell| match cell {
                    Cell::Number(number) => number,
                    _ => f64::NAN,
                })
                .collect(),
        ),
        ColumnType::Integer => Values::Integer(
            cells
                .map(|cell| match cell {
                    Cell::Integer(number) => i64::try_from(number).unwrap_or(i64::MAX),
                    _ => -1,
                })
                .collect(),
        ),
        ColumnType::Flag => Values::Flag(cells.map(|cell| matches!(cell, Cell::Flag(true))).collect()),
        ColumnType::Text => Values::Text(cells.map(|cell| cell.to_string()).collect()),
    }
}

fn to_python(py: Python<'_>, values: Values) -> PyResult<Py<PyAny>> {
    Ok(match values {
        Values::Number(numbers) => numbers.into_pyarray(py).into_any().unbind(),
        Values::Integer(numbers) => numbers.into_pyarray(py).into_any().unbind(),
        Values::Flag(flags) => flags.into_pyarray(py).into_any().unbind(),
        Values::Text(texts) => PyList::new(py, texts)?.into_any().unbind(),
    })
}

/// What a table is restored from: its columns by name, and the number of its rows.
type Pickled = (Vec<(String, Py<PyAny>)>, usize);

#[pymethods]
impl PyTable {
    /// Names of the columns.
    #[getter]
    fn columns(&self) -> Vec<String> {
        self.columns.iter().map(|column| column.name.clone()).collect()
    }

    /// Units of the columns; an empty text for a column without one.
    #[getter]
    fn units(&self) -> std::collections::BTreeMap<String, &'static str> {
        let units = self.columns.iter().map(|column| (column.name.clone(), column.unit));
        units.collect()
    }

    fn __len__(&self) -> usize {
        self.rows
    }

    fn __contains__(&self, name: &str) -> bool {
        self.columns.iter().any(|column| column.name == name)
    }

    /// The values of a column: an array of shape (rows,), or a list of texts. A missing number is NaN.
    fn __getitem__(&self, py: Python<'_>, name: &str) -> PyResult<Py<PyAny>> {
        Ok(self.find(name)?.values.clone_ref(py))
    }

    fn __repr__(&self) -> String {
        format!(
            "<kinefront.Table of {} designs, {} columns>",
            self.rows,
            self.columns.len()
        )
    }

    /// Returns one table of the rows of several, which must have the same columns.
    #[staticmethod]
    fn concat(py: Python<'_>, tables: Vec<Py<Self>>) -> PyResult<Self> {
        let Some(first) = tables.first() else {
            return Err(InputError::new_err("there is no table to join"));
        };
        let names = first.get().columns();
        let numpy = py.import("numpy")?;
        let mut joined = Vec::new();
        for name in names {
            let parts = tables.iter().map(|table| table.get().__getitem__(py, &name));
            let parts = parts.collect::<PyResult<Vec<_>>>()?;
            let is_text = Column::find(&name).is_some_and(|column| column.kind() == ColumnType::Text);
            let values = if is_text {
                let all: Vec<String> = parts
                    .iter()
                    .map(|part| part.extract::<Vec<String>>(py))
                    .collect::<PyResult<Vec<_>>>()?
                    .concat();
                PyList::new(py, all)?.into_any().unbind()
            } else {
                numpy.call_method1("concatenate", (parts,))?.unbind()
            };
            joined.push((name, values));
        }
        let rows = tables.iter().map(|table| table.get().rows).sum();
        Self::_restore(joined, rows)
    }

    /// Makes the table that was taken apart for another process.
    #[staticmethod]
    fn _restore(columns: Vec<(String, Py<PyAny>)>, rows: usize) -> PyResult<Self> {
        let restore = |(name, values): (String, Py<PyAny>)| {
            let column =
                Column::find(&name).ok_or_else(|| InputError::new_err(format!("there is no column `{name}`")))?;
            Ok(NamedColumn {
                unit: column.unit(),
                kind: column.kind(),
                name,
                values,
            })
        };
        Ok(Self {
            columns: columns.into_iter().map(restore).collect::<PyResult<_>>()?,
            rows,
        })
    }

    /// Tables travel to other processes as their columns.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Pickled)> {
        let (py, table) = (slf.py(), slf.get());
        let columns = table
            .columns
            .iter()
            .map(|column| (column.name.clone(), column.values.clone_ref(py)));
        Ok((slf.get_type().getattr("_restore")?, (columns.collect(), table.rows)))
    }

    /// Return the table as a structured array of NumPy, of shape (rows,), with a field for each column.
    fn to_numpy<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        frame(slf, "to_numpy")
    }

    /// Return the table as a `pandas.DataFrame`; the numbers are not copied.
    fn to_pandas<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        frame(slf, "to_pandas")
    }

    /// Return the table as a `polars.DataFrame`, through the C data interface of Arrow.
    fn to_polars<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        frame(slf, "to_polars")
    }

    /// Return the table as a `pyarrow.Table`, through the C data interface of Arrow.
    fn to_arrow<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        frame(slf, "to_arrow")
    }

    /// The table as a stream of the C data interface of Arrow, for pyarrow, Polars, DuckDB and others.
    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        // The protocol allows the schema to be another one than was requested.
        drop(requested_schema);
        let batch = self.batch(py)?;
        let schema = batch.schema();
        let stream = FFI_ArrowArrayStream::new(Box::new(RecordBatchIterator::new([Ok(batch)], schema)));
        PyCapsule::new_with_value(py, stream, c"arrow_array_stream")
    }
}

/// Converts a table by a function of the Python part of the package, which imports the library that it needs.
fn frame<'py>(table: &Bound<'py, PyTable>, function: &str) -> PyResult<Bound<'py, PyAny>> {
    table.py().import("kinefront._frames")?.call_method1(function, (table,))
}

/// Returns the exception of columns that differ in length.
pub(crate) fn unequal(name: &str, rows: usize, expected: usize) -> PyErr {
    InputError::new_err(format!(
        "the column `{name}` has {rows} values; expected {expected}, as the others have"
    ))
}
