//! A design at many poses, as arrays.

use numpy::ndarray::{Array2, Array3};
use numpy::{IntoPyArray, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use rayon::prelude::*;

use kinefront_model::evaluation::{Constraint, Model, PoseEvaluation, PoseScalar};
use kinefront_model::mechanism::Design;
use kinefront_model::spatial::Pose;

use crate::convert::contiguous;
use crate::errors::InputError;

/// Number of poses that a thread evaluates at a time.
const CHUNK: usize = 1024;

/// Returns the name of the array of a scalar: the key of its quantity, or what this package called it first.
fn name(scalar: PoseScalar) -> &'static str {
    match scalar {
        PoseScalar::Dexterity => "kappa",
        PoseScalar::Determinant => "det_a",
        PoseScalar::Reach => "limit_margin_m",
        other => other.entry().quantity.key,
    }
}

/// Reads poses, whose rows are x, y \[m\] and φ \[rad\].
fn read_poses(poses: &Bound<'_, PyAny>) -> PyResult<Vec<Pose>> {
    let poses: PyReadonlyArray2<'_, f64> = contiguous(poses)?
        .extract()
        .map_err(|_| InputError::new_err("expected poses of shape (n, 3): x, y [m] and phi [rad]"))?;
    let given = poses.as_array();
    if given.ncols() != 3 {
        return Err(InputError::new_err(format!(
            "the poses have {} columns; expected x, y [m] and phi [rad]",
            given.ncols()
        )));
    }
    let rows = given.rows().into_iter();
    Ok(rows.map(|row| Pose::new(row[0], row[1], row[2])).collect())
}

/// Returns what a design is at each pose that it reaches, and the margins of its constraints there, row by row.
fn evaluate_all(model: &Model, design: &Design, poses: &[Pose]) -> (Vec<Option<PoseEvaluation>>, Vec<f64>) {
    let posed = model.posed(design);
    let found: Vec<Option<PoseEvaluation>> = poses
        .par_chunks(CHUNK)
        .flat_map_iter(|poses| poses.iter().map(|pose| posed.at(pose).ok()))
        .collect();
    let none = [f64::NAN; Constraint::ALL.len()];
    let margins = found.iter();
    let margins = margins.flat_map(|found| found.as_ref().map_or(none, |found| posed.margins(found)));
    let margins = margins.collect();
    (found, margins)
}

/// Evaluates a design at poses, whose rows are x, y \[m\] and φ \[rad\].
pub(crate) fn evaluate<'py>(
    py: Python<'py>,
    model: &Model,
    design: &Design,
    poses: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyDict>> {
    let poses = read_poses(poses)?;
    let (found, margins) = py.detach(|| evaluate_all(model, design, &poses));
    let count = found.len();
    let flat = |width: usize, values: &dyn Fn(&PoseEvaluation, &mut Vec<f64>)| {
        let mut all = Vec::with_capacity(width * count);
        for found in &found {
            match found {
                Some(found) => values(found, &mut all),
                None => all.resize(all.len() + width, f64::NAN),
            }
        }
        all
    };
    let table = PyDict::new(py);
    let reached: Vec<bool> = found.iter().map(Option::is_some).collect();
    table.set_item("reachable", reached.into_pyarray(py))?;
    let actuators = flat(3, &|found, all| all.extend(found.actuators));
    table.set_item("actuators", matrix(py, actuators, count, 3)?)?;
    let b = flat(6, &|found, all| all.extend(found.b.as_flattened()));
    table.set_item("B", cube(py, b, count, [3, 2])?)?;
    let c = flat(6, &|found, all| all.extend(found.c.as_flattened()));
    table.set_item("C", cube(py, c, count, [3, 2])?)?;
    for &scalar in PoseScalar::ALL {
        let numbers = flat(1, &|found, all| all.push(found.values.get(scalar).unwrap_or(f64::NAN)));
        table.set_item(name(scalar), numbers.into_pyarray(py))?;
    }
    let stiffness = flat(36, &|found, all| {
        // Row by row, as arrays of NumPy are; the matrix is symmetric but for rounding.
        all.extend(found.stiffness.transpose().iter());
    });
    table.set_item("K", cube(py, stiffness, count, [6, 6])?)?;
    table.set_item("margins", matrix(py, margins, count, Constraint::ALL.len())?)?;
    let names = Constraint::ALL.map(|constraint| constraint.id());
    table.set_item("constraints", PyList::new(py, names)?)?;
    Ok(table)
}

fn matrix(py: Python<'_>, values: Vec<f64>, rows: usize, columns: usize) -> PyResult<Py<PyAny>> {
    let array =
        Array2::from_shape_vec((rows, columns), values).map_err(|cause| InputError::new_err(cause.to_string()))?;
    Ok(array.into_pyarray(py).into_any().unbind())
}

fn cube(py: Python<'_>, values: Vec<f64>, rows: usize, [a, b]: [usize; 2]) -> PyResult<Py<PyAny>> {
    let array = Array3::from_shape_vec((rows, a, b), values).map_err(|cause| InputError::new_err(cause.to_string()))?;
    Ok(array.into_pyarray(py).into_any().unbind())
}
