//! Recordings, read back with the Rerun package for Python.

use std::path::Path;

use super::support::{folder, optimize, python, script, small_study};

/// The recording of a run folder passes `rerun rrd verify` and holds the rows of its tables.
pub fn agrees_with_its_tables(run: &Path) {
    if let Some(python) = python(&["rerun", "pyarrow", "numpy"]) {
        println!("{}", script(python, "check_recording.py", &[run]));
    }
}

#[test]
fn a_recording_holds_what_the_tables_hold() {
    let folder = folder();
    let out = folder.path().join("run");
    optimize(&small_study(folder.path()), &out, &[]);
    agrees_with_its_tables(&out);
}
