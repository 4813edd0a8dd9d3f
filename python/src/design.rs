//! A design of a study.

use std::collections::BTreeMap;
use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyString};

use kinefront_export::{CertificateJson, Claim, EvaluationJson, ExportSubject, Format, export};
use kinefront_model::mechanism::{DESIGN_VARIABLES, Design};
use kinefront_model::spatial::Pose;
use kinefront_study::{DriversOptions, PreparedStudy};

use crate::convert::{from_serializable, grid_choice};
use crate::errors::{InputError, of_design};
use crate::{local, poses};

/// A design of a study.
#[pyclass(name = "Design", module = "kinefront", frozen)]
pub struct PyDesign {
    shared: Arc<PreparedStudy>,
    design: Design,
}

impl PyDesign {
    pub(crate) fn new(shared: Arc<PreparedStudy>, design: Design) -> Self {
        Self { shared, design }
    }

    pub(crate) fn design(&self) -> &Design {
        &self.design
    }
}

#[pymethods]
impl PyDesign {
    /// Name of the architecture.
    #[getter]
    fn architecture(&self) -> &'static str {
        self.design.architecture().name()
    }

    /// Working mode, a sign for each leg.
    #[getter]
    fn working_mode(&self) -> String {
        self.design.working_mode().to_string()
    }

    /// The variables of the design by their keys, in metres and degrees.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let values = PyDict::new(py);
        let further = self.design.architecture().further_variables().iter().copied();
        for variable in DESIGN_VARIABLES.into_iter().chain(further) {
            values.set_item(variable.key(), self.design.value(variable))?;
        }
        Ok(values)
    }

    /// Evaluates the design; returns mass, workspace radius, constraints and quantities as `kinefront evaluate --json` does.
    #[pyo3(signature = (grid="reference"))]
    fn evaluate<'py>(&self, py: Python<'py>, grid: &str) -> PyResult<Bound<'py, PyAny>> {
        let grid = grid_choice(grid)?;
        let evaluation = py.detach(|| self.shared.model().evaluate_in_full(&self.design, grid));
        from_serializable(py, &EvaluationJson::new(&evaluation, self.shared.model()))
    }

    /// Proves the region of the study for the design, or a workspace radius \[m\], as `kinefront certify --json` does: `verdict` is `proved`,
    /// `refuted` or `open`.
    ///
    /// `radius` is by default that of the fine grid where the study prescribes no region, and `phi_deg` its home orientation there.
    #[pyo3(signature = (*, radius=None, phi_deg=None, tolerance=Claim::default().tolerance, max_boxes=Claim::default().max_boxes, all_homes=false))]
    fn certify<'py>(
        &self,
        py: Python<'py>,
        radius: Option<f64>,
        phi_deg: Option<f64>,
        tolerance: f64,
        max_boxes: usize,
        all_homes: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        let claim = Claim {
            phi_deg,
            radius,
            tolerance,
            max_boxes,
            all_homes,
        };
        let found = py.detach(|| CertificateJson::prove(&self.shared, &self.design, &claim));
        from_serializable(py, &found.map_err(|error| InputError::new_err(error.to_string()))?)
    }

    /// Evaluates the design at poses, an array of shape (n, 3) with x and y in metres and phi in radians.
    fn poses<'py>(&self, py: Python<'py>, poses: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        poses::evaluate(py, self.shared.model(), &self.design, poses)
    }

    /// Returns what drives the first objective of the study at the best design near this one, as `kinefront prices --json` does: the
    /// active requirements with their poses, and the change of the objective in per cent for 1 % of each parameter.
    ///
    /// `held` states values of other objectives by their keys, such as `{"workspace_radius_m": 1.2}`, in place of those of the design.
    /// `bars_only` keeps the geometry; `steps` optimizes again after finite steps; `wish` computes by how much each requirement has to be relaxed
    /// for this value of the objective.
    #[pyo3(signature = (*, held=BTreeMap::new(), bars_only=false, steps=false, wish=None))]
    fn prices<'py>(
        &self,
        py: Python<'py>,
        held: BTreeMap<String, f64>,
        bars_only: bool,
        steps: bool,
        wish: Option<f64>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let options = DriversOptions {
            bars_only,
            steps,
            alternatives: !bars_only,
            wish,
        };
        local::prices(py, self.shared.study(), &self.design, &held, options)
    }

    /// Returns the nearest design that meets the conditions, verified and proved, as `kinefront wish --json` does.
    ///
    /// `conditions` are texts such as `"k_xy_n_per_m >= 1.2e6"`; the quantities of `keep` must not become worse.
    #[pyo3(signature = (conditions, *, keep=Vec::new()))]
    fn wish<'py>(&self, py: Python<'py>, conditions: Vec<String>, keep: Vec<String>) -> PyResult<Bound<'py, PyAny>> {
        local::wish(py, self.shared.study(), &self.design, &conditions, &keep)
    }

    /// Writes the design in a format of other programs: a text, or bytes for glTF.
    #[pyo3(signature = (format, pose=None))]
    fn export<'py>(&self, py: Python<'py>, format: &str, pose: Option<[f64; 3]>) -> PyResult<Bound<'py, PyAny>> {
        let Some(format) = Format::find(format) else {
            let known: Vec<&str> = Format::ALL.iter().map(Format::key).collect();
            let known = known.join(", ");
            return Err(InputError::new_err(format!(
                "there is no format `{format}`; expected one of {known}"
            )));
        };
        let written = py.detach(|| {
            let evaluation = self
                .shared
                .model()
                .evaluate(&self.design, kinefront_model::evaluation::GridChoice::Fine);
            let subject = ExportSubject {
                study: &self.shared,
                evaluation: &evaluation,
                pose: pose.map(|[x, y, phi]| Pose::new(x, y, phi)),
            };
            export(&subject, format)
        });
        let written = written.map_err(of_design)?;
        Ok(match String::from_utf8(written) {
            Ok(text) if format.is_text() => PyString::new(py, &text).into_any(),
            Ok(text) => PyBytes::new(py, text.as_bytes()).into_any(),
            Err(bytes) => PyBytes::new(py, bytes.as_bytes()).into_any(),
        })
    }

    fn __str__(&self) -> String {
        self.design.to_string()
    }

    fn __repr__(&self) -> String {
        format!("<kinefront.Design {}>", self.design)
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.design == other.design
    }
}
