//! Typed columns of the entity `/designs`, one row per design.

use std::sync::Arc;

use rerun::external::arrow::array::{ArrayRef, BooleanArray, Float64Array, ListArray, StringArray};
use rerun::external::arrow::datatypes::Float64Type;
use rerun::{ComponentDescriptor, ComponentIdentifier, SerializedComponentBatch, SerializedComponentColumn};

use super::writer::RecordingError;
use kinefront_study::{Cell, Column, ColumnType, TableRow};

fn descriptor(name: &str) -> Result<ComponentDescriptor, RecordingError> {
    let identifier = ComponentIdentifier::try_new(name).map_err(RecordingError::encode)?;
    Ok(ComponentDescriptor::partial(identifier))
}

/// Creates a column with a value in every row.
fn dense(name: &str, array: ArrayRef) -> Result<SerializedComponentColumn, RecordingError> {
    SerializedComponentBatch::new(array, descriptor(name)?)
        .column_of_unit_batches()
        .map_err(RecordingError::encode)
}

fn texts(name: &str, values: impl Iterator<Item = String>) -> Result<SerializedComponentColumn, RecordingError> {
    dense(name, Arc::new(StringArray::from_iter_values(values)))
}

/// Creates a column in which a row may have no value. A missing value is an empty list, because a viewer would
/// otherwise show the value of the previous row.
fn sparse(name: &str, values: impl Iterator<Item = Option<f64>>) -> Result<SerializedComponentColumn, RecordingError> {
    let list = ListArray::from_iter_primitive::<Float64Type, _, _>(
        values.map(|value| Some(value.map(Some).into_iter().collect::<Vec<_>>())),
    );
    Ok(SerializedComponentColumn::new(list, descriptor(name)?))
}

/// Returns the columns of consecutive designs, named as in `designs.csv`; the id and the generation are times of the
/// recording.
pub(super) fn designs(
    study: &kinefront_study::Study,
    rows: &[TableRow],
) -> Result<Vec<SerializedComponentColumn>, RecordingError> {
    Column::of_designs(study)
        .filter(|column| !matches!(column, Column::Id | Column::Generation))
        .map(|column| {
            let name = column.name();
            let values = rows.iter().map(|row| column.cell(row));
            match column.kind() {
                ColumnType::Text => texts(&name, values.map(|cell| cell.to_string())),
                ColumnType::Flag => {
                    let flags: Vec<bool> = values.map(|cell| cell == Cell::Flag(true)).collect();
                    dense(&name, Arc::new(BooleanArray::from(flags)))
                }
                ColumnType::Number | ColumnType::Integer => {
                    let numbers = rows.iter().map(|row| row.row.number(column));
                    if column.is_optional() {
                        sparse(&name, numbers)
                    } else {
                        dense(&name, Arc::new(Float64Array::from_iter_values(numbers.flatten())))
                    }
                }
            }
        })
        .collect()
}
