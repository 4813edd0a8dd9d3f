//! Conversions between values of Python and of Rust that several types share.

use pyo3::prelude::*;

use kinefront_model::evaluation::GridChoice;

use crate::errors::InputError;

/// Returns a value of Python with the contents of a value that JSON can hold.
pub(crate) fn from_serializable<'py>(py: Python<'py>, value: &impl serde::Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(value).map_err(|cause| InputError::new_err(cause.to_string()))?;
    py.import("json")?.call_method1("loads", (text,))
}

/// Returns the grid of a name.
pub(crate) fn grid_choice(name: &str) -> PyResult<GridChoice> {
    match name {
        "reference" => Ok(GridChoice::Reference),
        "fine" => Ok(GridChoice::Fine),
        _ => Err(InputError::new_err(format!(
            "there is no grid `{name}`; expected `reference` or `fine`"
        ))),
    }
}

/// Returns numbers as a contiguous and aligned array: a field of a structured array is neither.
pub(crate) fn contiguous<'py>(given: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    given
        .py()
        .import("numpy")?
        .call_method1("require", (given, "float64", ["C", "A"]))
}
