//! The exceptions, which are Python classes, so that each can have several base classes.

use pyo3::prelude::*;

use kinefront_study::StudyError as StudyFault;

pyo3::import_exception!(kinefront._errors, StudyError);
pyo3::import_exception!(kinefront._errors, DesignError);
pyo3::import_exception!(kinefront._errors, RunError);
pyo3::import_exception!(kinefront._errors, FileError);
pyo3::import_exception!(kinefront._errors, SearchError);
pyo3::import_exception!(kinefront._errors, InputError);

/// Returns the exception of an invalid study, which lists its faults.
pub(crate) fn of_study(py: Python<'_>, fault: &StudyFault) -> PyErr {
    let error = StudyError::new_err(fault.to_string());
    let faults: Vec<(String, String)> = match fault {
        StudyFault::Values { faults, .. } => {
            let pair = |fault: &kinefront_study::Fault| (fault.key.clone(), fault.message.clone());
            faults.iter().map(pair).collect()
        }
        StudyFault::Shape { message, key, .. } => vec![(key.clone().unwrap_or_default(), message.clone())],
        _ => Vec::new(),
    };
    // An exception without its list is still the right exception.
    let _ = error.value(py).setattr("faults", faults);
    error
}

/// Returns the exception of an invalid design.
pub(crate) fn of_design(fault: impl std::fmt::Display) -> PyErr {
    DesignError::new_err(fault.to_string())
}

/// Returns the exception of a run folder.
pub(crate) fn of_run(fault: impl std::fmt::Display) -> PyErr {
    RunError::new_err(fault.to_string())
}

/// Returns the exception of a search that fails.
pub(crate) fn of_search(fault: impl std::fmt::Display) -> PyErr {
    SearchError::new_err(fault.to_string())
}
