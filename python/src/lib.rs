//! The native part of the Python package `kinefront`: studies, designs, tables and runs.
//!
//! Python sees these types without the prefix `Py`, which tells them from those of the crates that they wrap. The package adds what
//! is simpler in Python: data frames, and the adapters to other libraries.

mod convert;
mod design;
mod designs;
mod errors;
mod local;
mod poses;
mod run;
mod search;
mod study;
mod table;

use pyo3::prelude::*;

/// The native module of the package.
#[pymodule]
mod _kinefront {
    #[pymodule_export]
    use crate::design::PyDesign;
    #[pymodule_export]
    use crate::run::PyRun;
    #[pymodule_export]
    use crate::search::PyProgress;
    #[pymodule_export]
    use crate::study::PyStudy;
    #[pymodule_export]
    use crate::table::PyTable;

    use super::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
