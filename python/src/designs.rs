//! Designs as Python gives them: texts, `Design` objects, or columns of a dictionary, a table, a data frame or a structured array.

use numpy::PyReadonlyArray1;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

use kinefront_model::mechanism::{DESIGN_VARIABLES, Design, FURTHER_VARIABLES};
use kinefront_study::{Column, Study, read_design};

use crate::convert::contiguous;
use crate::design::PyDesign;
use crate::errors::{InputError, of_design};
use crate::table::unequal;

/// Reads one or several designs.
pub(crate) fn read(study: &Study, given: &Bound<'_, PyAny>) -> PyResult<Vec<Design>> {
    if let Some(design) = one(study, given)? {
        return Ok(vec![design]);
    }
    if let Some(names) = column_names(given)? {
        return of_columns(study, given, &names);
    }
    let items = given.try_iter().map_err(|_| {
        PyTypeError::new_err(
            "expected a design, its text, a sequence of them, or columns such as a dictionary or a data frame",
        )
    })?;
    let read = |item: PyResult<Bound<'_, PyAny>>| {
        let item = item?;
        one(study, &item)?.ok_or_else(|| PyTypeError::new_err(format!("expected a design or its text, got {item:?}")))
    };
    items.map(read).collect()
}

/// Reads a `Design` object or a text; `None` if it is neither.
fn one(study: &Study, given: &Bound<'_, PyAny>) -> PyResult<Option<Design>> {
    if let Ok(design) = given.cast::<PyDesign>() {
        return Ok(Some(*design.get().design()));
    }
    match given.cast::<PyString>() {
        Ok(text) => Design::parse(text.to_str()?, study.working_mode)
            .map(Some)
            .map_err(of_design),
        Err(_) => Ok(None),
    }
}

/// Returns the names of the columns of something that has columns.
fn column_names(given: &Bound<'_, PyAny>) -> PyResult<Option<Vec<String>>> {
    if let Ok(dict) = given.cast::<PyDict>() {
        return dict.keys().extract().map(Some);
    }
    if let Ok(columns) = given.getattr("columns") {
        let names = columns.try_iter()?.map(|name| name?.extract());
        return names.collect::<PyResult<_>>().map(Some);
    }
    let of_array = given.getattr("dtype").and_then(|dtype| dtype.getattr("names"));
    match of_array {
        Ok(names) if !names.is_none() => names.extract().map(Some),
        _ => Ok(None),
    }
}

/// A column of designs: a value for each of them, or one for all.
enum Given<T> {
    Each(Vec<T>),
    All(T),
}

impl<T> Given<T> {
    fn at(&self, place: usize) -> Option<&T> {
        match self {
            Self::Each(values) => values.get(place),
            Self::All(value) => Some(value),
        }
    }

    fn rows(&self) -> Option<usize> {
        match self {
            Self::Each(values) => Some(values.len()),
            Self::All(_) => None,
        }
    }
}

/// Refuses a column whose name differs from that of a dimension in its unit, in underscores or in capital letters alone. Other columns, such
/// as those of a table of results, are of no concern.
fn refuse_misspelt(names: &[String]) -> PyResult<()> {
    let without_unit = |name: &str| {
        let unit = ["_deg", "_rad", "_mm", "_m"]
            .into_iter()
            .find_map(|unit| name.strip_suffix(unit));
        unit.unwrap_or(name).to_owned()
    };
    let plain = |name: &str| without_unit(&name.to_lowercase()).replace('_', "");
    let dimensions = DESIGN_VARIABLES.into_iter().chain(FURTHER_VARIABLES);
    let known: Vec<String> = dimensions
        .map(|variable| Column::Dimension(variable).name().into_owned())
        .collect();
    for name in names.iter().filter(|name| !known.contains(name)) {
        // `R` and `r` differ in capital letters alone.
        let is_meant =
            |known: &&String| **known == without_unit(name) || known.len() > 1 && plain(known) == plain(name);
        let meant = known.iter().find(is_meant).filter(|meant| !names.contains(meant));
        if let Some(meant) = meant {
            return Err(InputError::new_err(format!(
                "the column `{name}` is not known; did you mean `{meant}`?"
            )));
        }
    }
    Ok(())
}

fn of_columns(study: &Study, given: &Bound<'_, PyAny>, names: &[String]) -> PyResult<Vec<Design>> {
    let mut texts: Vec<(Column, Given<String>)> = Vec::new();
    let mut numbers: Vec<(Column, Given<f64>)> = Vec::new();
    let mut rows = None;
    let mut check = |name: &str, found: Option<usize>| match (rows, found) {
        (None, Some(found)) => {
            rows = Some(found);
            Ok(())
        }
        (Some(expected), Some(found)) if expected != found => Err(unequal(name, found, expected)),
        _ => Ok(()),
    };
    for column in [Column::Architecture, Column::WorkingMode] {
        let name = column.name();
        if names.iter().any(|found| *found == name) {
            let values = read_texts(&given.get_item(&*name)?)?;
            check(&name, values.rows())?;
            texts.push((column, values));
        }
    }
    for variable in DESIGN_VARIABLES.into_iter().chain(FURTHER_VARIABLES) {
        let column = Column::Dimension(variable);
        let name = column.name();
        if names.iter().any(|found| *found == name) {
            let values = read_numbers(&given.get_item(&*name)?)?;
            check(&name, values.rows())?;
            numbers.push((column, values));
        }
    }
    refuse_misspelt(names)?;
    if texts.iter().all(|(column, _)| *column != Column::Architecture) {
        let [only] = study.architectures[..] else {
            return Err(InputError::new_err(
                "the designs have no column `architecture`, and the study has several architectures",
            ));
        };
        texts.push((Column::Architecture, Given::All(only.name().to_owned())));
    }
    let design = |place: usize| {
        let text = |wanted: Column| {
            let (_, values) = texts.iter().find(|(column, _)| *column == wanted)?;
            values.at(place).map(String::as_str)
        };
        let number = |wanted: Column| {
            let (_, values) = numbers.iter().find(|(column, _)| *column == wanted)?;
            values.at(place).copied().filter(|number| !number.is_nan())
        };
        read_design(study, text, number).map_err(|fault| of_design(format!("row {place}: {fault}")))
    };
    (0..rows.unwrap_or(1)).map(design).collect()
}

fn read_texts(given: &Bound<'_, PyAny>) -> PyResult<Given<String>> {
    if let Ok(text) = given.cast::<PyString>() {
        return Ok(Given::All(text.to_str()?.to_owned()));
    }
    let texts = given.try_iter()?.map(|text| text?.str()?.extract());
    Ok(Given::Each(texts.collect::<PyResult<_>>()?))
}

fn read_numbers(given: &Bound<'_, PyAny>) -> PyResult<Given<f64>> {
    let numbers = given
        .py()
        .import("numpy")?
        .call_method1("asarray", (given, "float64"))?;
    if numbers.getattr("ndim")?.extract::<usize>()? == 0 {
        return Ok(Given::All(numbers.call_method0("item")?.extract()?));
    }
    let numbers: PyReadonlyArray1<'_, f64> = contiguous(&numbers)?.extract()?;
    Ok(Given::Each(numbers.as_array().to_vec()))
}
