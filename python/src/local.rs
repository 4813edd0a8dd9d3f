//! What drives the mass of designs, wishes, and why a point beyond a front cannot be had.

use std::collections::BTreeMap;

use pyo3::prelude::*;

use kinefront_model::evaluation::Quantity;
use kinefront_model::mechanism::Design;
use kinefront_study::{AlongJson, Condition, DesignProblem, DriversOptions, Study, Wish};

use crate::convert::from_serializable;
use crate::errors::{InputError, of_design};

/// Reads values of quantities by their keys.
fn quantities(stated: &BTreeMap<String, f64>) -> PyResult<Vec<(Quantity, f64)>> {
    let read = |(key, value): (&String, &f64)| {
        let quantity = quantity(key)?;
        match value.is_finite() && *value > 0.0 {
            true => Ok((quantity, *value)),
            false => Err(InputError::new_err(format!(
                "{key} is {value}; it must be a number above 0"
            ))),
        }
    };
    stated.iter().map(read).collect()
}

fn quantity(key: &str) -> PyResult<Quantity> {
    Wish::quantity(key).map_err(|error| InputError::new_err(error.to_string()))
}

/// Returns what drives the first objective of a design.
pub(crate) fn prices<'py>(
    py: Python<'py>,
    study: &Study,
    design: &Design,
    held: &BTreeMap<String, f64>,
    options: DriversOptions,
) -> PyResult<Bound<'py, PyAny>> {
    let held = quantities(held)?;
    let problem = DesignProblem::new(study).map_err(of_design)?;
    let drivers = py.detach(|| problem.local(design, &held)?.drivers(options));
    from_serializable(py, &drivers.map_err(of_design)?)
}

/// Returns what drives the first objective along a front, for each architecture; the id of a design is its place.
pub(crate) fn prices_along<'py>(py: Python<'py>, study: &Study, designs: &[Design]) -> PyResult<Bound<'py, PyAny>> {
    let problem = DesignProblem::new(study).map_err(of_design)?;
    let along = py.detach(|| problem.drivers_along(&problem.evaluate_on_fine_grid(designs)));
    let all: Vec<AlongJson<'_>> = along.iter().map(|along| along.to_json(&[])).collect();
    from_serializable(py, &all)
}

/// Returns what became of a wish about a design.
pub(crate) fn wish<'py>(
    py: Python<'py>,
    study: &Study,
    design: &Design,
    conditions: &[String],
    keep: &[String],
) -> PyResult<Bound<'py, PyAny>> {
    let conditions = conditions
        .iter()
        .map(|text| text.parse::<Condition>().map_err(of_design));
    let wish = Wish {
        conditions: conditions.collect::<PyResult<_>>()?,
        keep: keep.iter().map(|key| quantity(key)).collect::<PyResult<_>>()?,
    };
    let problem = DesignProblem::new(study).map_err(of_design)?;
    let outcome = py.detach(|| problem.grant(design, &wish)).map_err(of_design)?;
    from_serializable(py, &outcome.to_json(&wish.shown(study)))
}

/// Returns why a value of the first objective cannot be had.
pub(crate) fn why<'py>(
    py: Python<'py>,
    study: &Study,
    designs: &[Design],
    wished: f64,
    held: &BTreeMap<String, f64>,
) -> PyResult<Bound<'py, PyAny>> {
    let held = quantities(held)?;
    let problem = DesignProblem::new(study).map_err(of_design)?;
    let drivers = py.detach(|| problem.why(designs, &held, wished)).map_err(of_design)?;
    from_serializable(py, &drivers)
}
