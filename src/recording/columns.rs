//! Typed columns of the entity `/designs`, one row per design.

use std::sync::Arc;

use rerun::external::arrow::array::{ArrayRef, BooleanArray, Float64Array, ListArray, StringArray};
use rerun::external::arrow::datatypes::Float64Type;
use rerun::{ComponentDescriptor, ComponentIdentifier, SerializedComponentBatch, SerializedComponentColumn};

use super::writer::RecordingError;
use kinefront_model::evaluation::{Constraint, Evaluation};
use kinefront_model::mechanism::DESIGN_VARIABLES;

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

fn numbers(name: &str, values: impl Iterator<Item = f64>) -> Result<SerializedComponentColumn, RecordingError> {
    dense(name, Arc::new(Float64Array::from_iter_values(values)))
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

/// Returns the columns of consecutive designs, named as in `designs.csv`.
pub(super) fn designs(evaluations: &[&Evaluation]) -> Result<Vec<SerializedComponentColumn>, RecordingError> {
    let each = || evaluations.iter().copied();
    let mut columns = vec![
        texts("architecture", each().map(|e| e.design.architecture.to_string()))?,
        texts("working_mode", each().map(|e| e.design.working_mode.to_string()))?,
    ];
    for (index, variable) in DESIGN_VARIABLES.into_iter().enumerate() {
        columns.push(numbers(variable.key(), each().map(|e| e.design.values()[index]))?);
    }
    columns.push(numbers("mass_kg", each().map(|e| e.mass))?);
    columns.push(numbers("workspace_radius_m", each().map(|e| e.workspace_radius))?);
    columns.push(sparse("phi_deg", each().map(|e| e.home_phi_deg))?);
    let feasible: Vec<bool> = each().map(Evaluation::is_feasible).collect();
    columns.push(dense("feasible", Arc::new(BooleanArray::from(feasible)))?);
    for constraint in Constraint::ALL {
        let report = |e: &Evaluation| *e.constraint(constraint);
        let id = constraint.id();
        columns.push(sparse(
            &format!("margin_{id}"),
            each().map(|e| report(e).required_margin()),
        )?);
        columns.push(sparse(&format!("value_{id}"), each().map(|e| report(e).value))?);
    }
    let active = |e: &Evaluation| e.active().map(Constraint::id).collect::<Vec<_>>().join("+");
    columns.push(texts("active", each().map(active))?);
    columns.push(numbers("violation", each().map(|e| e.violation))?);
    Ok(columns)
}
