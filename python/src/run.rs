//! Runs: their study, designs and front, from a search or from a run folder.

use std::path::PathBuf;
use std::sync::OnceLock;

use pyo3::prelude::*;

use kinefront_study::{Column, RunFolder, RunReport, RunSummary, Study, TableRow, front_marks};

use crate::convert::from_serializable;
use crate::errors::of_run;
use crate::study::PyStudy;
use crate::table::PyTable;

/// A run of a study.
#[pyclass(name = "Run", module = "kinefront", frozen)]
pub struct PyRun {
    study: Study,
    rows: Vec<TableRow>,
    front: Option<Vec<TableRow>>,
    report: Option<RunReport>,
    path: Option<PathBuf>,
    // Tables are made once: their arrays belong to Python then.
    designs: OnceLock<Py<PyTable>>,
    front_table: OnceLock<Py<PyTable>>,
}

impl PyRun {
    /// Makes the run of a search that has ended.
    pub(crate) fn of_search(study: Study, rows: Vec<TableRow>, summary: &RunSummary, path: Option<PathBuf>) -> Self {
        Self {
            rows,
            front: summary
                .verified_front()
                .then(|| summary.front.iter().map(|member| member.row()).collect()),
            report: Some(RunReport::new(&study, summary)),
            study,
            path,
            designs: OnceLock::new(),
            front_table: OnceLock::new(),
        }
    }
}

#[pymethods]
impl PyRun {
    /// Opens a run folder.
    #[staticmethod]
    fn open(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        py.detach(|| {
            let folder = RunFolder::open(&path).map_err(of_run)?;
            let front = folder.front().map_err(of_run)?;
            Ok(Self {
                rows: folder.designs().map_err(of_run)?.rows,
                front: front.map(|contents| contents.rows),
                report: folder.report().cloned(),
                study: folder.study().clone(),
                path: Some(path),
                designs: OnceLock::new(),
                front_table: OnceLock::new(),
            })
        })
    }

    /// The study as run.
    #[getter]
    fn study(&self) -> PyResult<PyStudy> {
        PyStudy::new(self.study.clone())
    }

    /// All evaluated designs, in the order of their ids.
    #[getter]
    fn designs(&self, py: Python<'_>) -> PyResult<Py<PyTable>> {
        if let Some(made) = self.designs.get() {
            return Ok(made.clone_ref(py));
        }
        let columns: Vec<Column> = Column::of_designs(&self.study).collect();
        let made = Py::new(py, PyTable::new(py, &columns, &self.rows)?)?;
        Ok(self.designs.get_or_init(|| made).clone_ref(py))
    }

    /// The verified front, sorted by the first objective, as in `front.csv`.
    #[getter]
    fn front(&self, py: Python<'_>) -> PyResult<Py<PyTable>> {
        if let Some(made) = self.front_table.get() {
            return Ok(made.clone_ref(py));
        }
        let Some(front) = &self.front else {
            return Err(of_run(
                "the run has not verified a front; `kinefront optimize --resume` continues it",
            ));
        };
        let columns: Vec<Column> = Column::of_front(&self.study).collect();
        let objectives: Vec<_> = front.iter().map(|entry| entry.row.objectives).collect();
        let marks = front_marks(&self.study, &objectives);
        let catalogues = self.study.catalogues();
        let cell =
            |place: usize, column: Column, entry: &TableRow| column.cell_of_front(entry, &marks[place], &catalogues);
        let made = Py::new(py, PyTable::with(py, &columns, front, cell)?)?;
        Ok(self.front_table.get_or_init(|| made).clone_ref(py))
    }

    /// The contents of `run.json`; `None` for a run that has not ended.
    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.report
            .as_ref()
            .map(|report| from_serializable(py, report))
            .transpose()
    }

    /// Path of the run folder, if there is one.
    #[getter]
    fn path(&self) -> Option<PathBuf> {
        self.path.clone()
    }

    fn __repr__(&self) -> String {
        let front = self.front.as_ref().map_or(0, Vec::len);
        format!(
            "<kinefront.Run of {}: {} designs, {front} on the front>",
            self.study.name,
            self.rows.len()
        )
    }
}
