//! Studies.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;

use kinefront_model::evaluation::Quantity;
use kinefront_study::{AlgorithmName, BUILTIN, Column, Overrides, PreparedStudy, Row, Study, TableRow, sensitivity};

use crate::convert::{from_serializable, grid_choice};
use crate::design::PyDesign;
use crate::errors::{InputError, of_design, of_study};
use crate::run::PyRun;
use crate::table::PyTable;
use crate::{designs, local, poses, search};

/// Number of designs that are evaluated between two looks at the signals, such as Ctrl-C.
const CHUNK: usize = 512;

/// What to design, under which assumptions, and how to search.
#[pyclass(name = "Study", module = "kinefront", frozen)]
pub struct PyStudy {
    shared: Arc<PreparedStudy>,
}

impl PyStudy {
    pub(crate) fn new(study: Study) -> PyResult<Self> {
        // Every quantity is computed, as the methods return them.
        let prepared = PreparedStudy::new(study).map_err(of_design)?;
        Ok(Self {
            shared: Arc::new(prepared.with_all_quantities()),
        })
    }

    fn study(&self) -> &Study {
        self.shared.study()
    }
}

/// The columns of evaluated designs: those of `designs.csv` with every quantity, without those that only a run gives.
fn columns(study: &Study) -> Vec<Column> {
    let mut full = study.clone();
    full.quantities = Quantity::all()
        .map(|quantity| quantity.entry().key.to_owned())
        .collect();
    let of_run = [Column::Id, Column::Generation];
    Column::of_designs(&full)
        .filter(|column| !of_run.contains(column))
        .collect()
}

#[pymethods]
impl PyStudy {
    /// The study of the 2010 paper.
    #[staticmethod]
    fn paper(py: Python<'_>) -> PyResult<Self> {
        Self::new(BUILTIN[0].study().map_err(|fault| of_study(py, &fault))?)
    }

    /// Names of the built-in studies.
    #[staticmethod]
    fn names() -> Vec<&'static str> {
        BUILTIN.iter().map(|builtin| builtin.name).collect()
    }

    /// Reads a study file, or a built-in study by its name.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let argument: &OsStr = path.as_os_str();
        Self::new(Study::load(argument).map_err(|fault| of_study(py, &fault))?)
    }

    /// Reads a study from the text of a study file.
    #[staticmethod]
    #[pyo3(signature = (text, name="study"))]
    fn from_toml(py: Python<'_>, text: &str, name: &str) -> PyResult<Self> {
        Self::new(Study::parse(text, name).map_err(|fault| of_study(py, &fault))?)
    }

    /// The text of the study file, without comments.
    fn to_toml(&self) -> PyResult<String> {
        toml::to_string(self.study()).map_err(|cause| InputError::new_err(cause.to_string()))
    }

    /// Returns the study with the settings of a text replaced, for example `[material]\nyoungs_modulus_pa = 7e10`.
    fn replace(&self, py: Python<'_>, text: &str) -> PyResult<Self> {
        let parse = |text: &str| text.parse::<toml::Table>();
        let invalid =
            |cause: toml::de::Error| InputError::new_err(format!("the settings are not TOML: {}", cause.message()));
        let changes = parse(text).map_err(invalid)?;
        let mut whole = parse(&self.to_toml()?).map_err(invalid)?;
        merge(&mut whole, changes);
        let text = toml::to_string(&whole).map_err(|cause| InputError::new_err(cause.to_string()))?;
        Self::from_toml(py, &text, &self.study().name)
    }

    /// Returns the searches of the sensitivity analysis of the report, as studies by name: for the study as given and for each
    /// alternative assumption, each architecture alone, with `evaluations` evaluations.
    fn sensitivity<'py>(&self, py: Python<'py>, evaluations: usize) -> PyResult<Bound<'py, PyDict>> {
        let searches = PyDict::new(py);
        for (alternative, study) in sensitivity::studies(self.study(), evaluations) {
            let name = sensitivity::name_of(alternative.as_ref());
            for &architecture in &study.architectures {
                let single = Self::new(study.with_one_architecture(architecture))?;
                searches.set_item(format!("{name}, {architecture}"), single)?;
            }
        }
        Ok(searches)
    }

    /// Name of the study.
    #[getter]
    fn name(&self) -> &str {
        &self.study().name
    }

    /// Architectures that the study searches.
    #[getter]
    fn architectures(&self) -> Vec<&'static str> {
        self.study()
            .architectures
            .iter()
            .map(|architecture| architecture.name())
            .collect()
    }

    /// Objectives, as pairs of `minimize` or `maximize` and the key of a quantity.
    #[getter]
    fn objectives(&self) -> Vec<(&'static str, &'static str)> {
        use kinefront_model::evaluation::Better;
        let pair = |objective: &kinefront_model::evaluation::Objective| {
            let goal = match objective.goal {
                Better::Lower => "minimize",
                Better::Higher => "maximize",
            };
            (goal, objective.quantity.entry().key)
        };
        self.study().objectives().iter().map(pair).collect()
    }

    /// Names of the columns that hold the objectives.
    #[getter]
    fn objective_columns(&self) -> Vec<String> {
        let objectives = self.study().objectives().into_iter();
        objectives
            .map(|objective| Column::Quantity(objective.quantity).name().into_owned())
            .collect()
    }

    /// Ranges of the variables, by their keys, in metres and degrees.
    #[getter]
    fn bounds<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let bounds = PyDict::new(py);
        let variables = kinefront_model::mechanism::DESIGN_VARIABLES.into_iter();
        for variable in variables.chain(self.study().bounds.further_variables()) {
            let [low, high] = self.study().range(variable);
            bounds.set_item(variable.key(), (low, high))?;
        }
        Ok(bounds)
    }

    /// Values in metres of the variables that the study lists or takes from a catalogue of bars, by their keys.
    #[getter]
    fn choices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let choices = PyDict::new(py);
        for variable in kinefront_model::mechanism::DESIGN_VARIABLES {
            if let Some(values) = self.study().listed(variable) {
                choices.set_item(variable.key(), values)?;
            }
        }
        Ok(choices)
    }

    /// Variables that are a factor times another one, by their keys: the other variable and the factor.
    #[getter]
    fn ties<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let ties = PyDict::new(py);
        for variable in kinefront_model::mechanism::DESIGN_VARIABLES {
            if let Some(tie) = self.study().tie(variable) {
                ties.set_item(variable.key(), (tie.source.key(), tie.factor))?;
            }
        }
        Ok(ties)
    }

    /// Settings of the optimizer.
    #[getter]
    fn optimizer<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        from_serializable(py, &self.study().optimizer)
    }

    /// Reads one design from its text.
    fn design(&self, text: &str) -> PyResult<PyDesign> {
        let design = kinefront_model::mechanism::Design::parse(text, self.study().working_mode).map_err(of_design)?;
        Ok(PyDesign::new(Arc::clone(&self.shared), design))
    }

    /// Returns the designs of texts, or of columns, as objects.
    fn designs(&self, designs: &Bound<'_, PyAny>) -> PyResult<Vec<PyDesign>> {
        let found = designs::read(self.study(), designs)?;
        Ok(found
            .into_iter()
            .map(|design| PyDesign::new(Arc::clone(&self.shared), design))
            .collect())
    }

    /// Evaluate designs, on all cores unless `threads` says otherwise.
    ///
    /// `designs` is a `Design` or its text, a sequence of n of them, or columns of length n: a dictionary, a `Table`, a data frame
    /// or a structured array with `architecture`, `R`, `r`, `Lb`, `rj`, `rp` \[m\], and, for some chains, `La`, `alpha_deg`,
    /// `beta_deg` and `gamma_deg`; a single value stands for all designs. `grid` is `reference` or `fine`. Designs are evaluated as they are
    /// given, also beyond `bounds` and with values that `choices` does not have.
    ///
    /// Returns a `Table` of n rows with the columns of `designs.csv` and every quantity. A missing number is NaN. The result
    /// depends on neither the number of threads nor the processor, to the last bit.
    #[pyo3(signature = (designs, *, grid="reference", threads=None))]
    fn evaluate(
        &self,
        py: Python<'_>,
        designs: &Bound<'_, PyAny>,
        grid: &str,
        threads: Option<usize>,
    ) -> PyResult<PyTable> {
        let grid = grid_choice(grid)?;
        let designs = designs::read(self.study(), designs)?;
        let pool = threads.map(|threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build());
        let pool = pool
            .transpose()
            .map_err(|cause| InputError::new_err(cause.to_string()))?;
        let mut rows: Vec<TableRow> = Vec::with_capacity(designs.len());
        for chunk in designs.chunks(CHUNK) {
            let evaluated: Vec<Row> = py.detach(|| {
                let evaluate = || {
                    chunk
                        .par_iter()
                        .map(|design| Row::new(0, &self.shared.model().evaluate(design, grid)))
                        .collect()
                };
                match &pool {
                    Some(pool) => pool.install(evaluate),
                    None => evaluate(),
                }
            });
            let first = rows.len();
            let evaluated = evaluated.into_iter().enumerate();
            rows.extend(evaluated.map(|(place, row)| TableRow::new(first + place, row)));
            py.check_signals()?;
        }
        PyTable::new(py, &columns(self.study()), &rows)
    }

    /// Evaluate a design at poses, an array of shape (n, 3) with x and y \[m\] and phi \[rad\].
    ///
    /// Returns arrays by name: `reachable` (n,), `actuators` (n, 3) \[m or rad\], the points `B` and `C` (n, 3, 2) \[m\], `kappa` (n,),
    /// the inverse condition number, `det_a` (n,), `limit_margin_m` (n,), the other scalars of a pose by the keys of their quantities (n,),
    /// such as `k_xy_n_per_m` and `clearance_m`, the stiffness matrix `K` (n, 6, 6) in base axes with the linear components first, and `margins` (n, c) of
    /// the c `constraints`, whose names are a list. All but `reachable` are NaN where a leg does not reach the pose.
    fn poses<'py>(
        &self,
        py: Python<'py>,
        design: &Bound<'py, PyAny>,
        poses: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let [design] = designs::read(self.study(), design)?[..] else {
            return Err(InputError::new_err("expected one design"));
        };
        poses::evaluate(py, self.shared.model(), &design, poses)
    }

    /// Returns what drives the first objective along a front, as `kinefront prices TABLE --json` does: for each architecture, sentences, and
    /// the prices of each design in the order of the second objective. The `id` of a design is its place among `designs`.
    fn prices<'py>(&self, py: Python<'py>, designs: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let designs = designs::read(self.study(), designs)?;
        local::prices_along(py, self.study(), &designs)
    }

    /// Returns why the first objective cannot have the value `wished`, as `kinefront why --json` does: by how much each requirement would have
    /// to be relaxed for it, or that it is achievable.
    ///
    /// `designs` are those of a front; `held` states desired values of other objectives by their keys, such as
    /// `{"workspace_radius_m": 1.2}`.
    #[pyo3(signature = (designs, wished, *, held=BTreeMap::new()))]
    fn why<'py>(
        &self,
        py: Python<'py>,
        designs: &Bound<'py, PyAny>,
        wished: f64,
        held: BTreeMap<String, f64>,
    ) -> PyResult<Bound<'py, PyAny>> {
        if !(wished.is_finite() && wished > 0.0) {
            let words = format!("the wished value is {wished}; it must be a number above 0");
            return Err(InputError::new_err(words));
        }
        let designs = designs::read(self.study(), designs)?;
        local::why(py, self.study(), &designs, wished, &held)
    }

    /// Search for the front of the study; returns a `Run`.
    ///
    /// `callback` is called with a `Progress` after each generation and during the verification; if it returns `False`, the search
    /// ends and its front is verified. `out` names a folder to which the run is written, without a recording. Ctrl-C interrupts the
    /// search; a run that is written can be resumed with `kinefront optimize --resume`.
    #[pyo3(signature = (*, seed=None, evaluations=None, algorithm=None, architectures=None, callback=None, threads=None, out=None))]
    #[expect(clippy::too_many_arguments, reason = "they are keywords of Python")]
    fn optimize(
        &self,
        py: Python<'_>,
        seed: Option<u64>,
        evaluations: Option<usize>,
        algorithm: Option<&str>,
        architectures: Option<Vec<String>>,
        callback: Option<Py<PyAny>>,
        threads: Option<usize>,
        out: Option<PathBuf>,
    ) -> PyResult<PyRun> {
        let find = |name: &str| {
            AlgorithmName::find(name).ok_or_else(|| {
                let known = AlgorithmName::ALL.map(|name| name.to_string()).join(", ");
                InputError::new_err(format!("there is no algorithm `{name}`; expected one of {known}"))
            })
        };
        let parse = |names: Vec<String>| names.iter().map(|name| name.parse()).collect::<Result<Vec<_>, _>>();
        let overrides = Overrides {
            algorithm: algorithm.map(find).transpose()?,
            evaluations,
            seed,
            threads,
            front_designs: None,
            architectures: architectures.map(parse).transpose().map_err(of_design)?,
        };
        let study = overrides.apply(self.study().clone());
        let study = study.map_err(|fault| InputError::new_err(format!("`{}` {}", fault.key, fault.message)))?;
        search::run(py, study, callback, out)
    }

    fn __repr__(&self) -> String {
        format!(
            "<kinefront.Study {}: {}>",
            self.study().name,
            self.architectures().join(", ")
        )
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.study() == other.study()
    }

    /// Studies travel to other processes as their text.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (String, String))> {
        let study = slf.get();
        let restore = slf.get_type().getattr("from_toml")?;
        Ok((restore, (study.to_toml()?, study.study().name.clone())))
    }
}

/// Replaces the values of `table` by those of `changes`, table by table.
fn merge(table: &mut toml::Table, changes: toml::Table) {
    for (key, change) in changes {
        match (table.get_mut(&key), change) {
            (Some(toml::Value::Table(present)), toml::Value::Table(change)) => merge(present, change),
            (_, change) => drop(table.insert(key, change)),
        }
    }
}
