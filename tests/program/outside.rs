//! An external optimizer uses the evaluator.

use std::path::Path;

use super::support::{python, script};

#[test]
fn pymoo_finds_a_front_through_the_stream() {
    if let Some(python) = python(&["pymoo", "numpy"]) {
        let printed = script(python, "pymoo_nsga2.py", &[Path::new(env!("CARGO_BIN_EXE_kinefront"))]);
        let report: serde_json::Value = serde_json::from_str(&printed).expect("JSON");
        let front = report["front"].as_array().expect("a list");
        assert!(front.len() >= 10, "{printed}");
        let masses: Vec<f64> = front
            .iter()
            .map(|design| design[0].as_f64().expect("a number"))
            .collect();
        let radii: Vec<f64> = front
            .iter()
            .map(|design| design[1].as_f64().expect("a number"))
            .collect();
        assert!(masses.is_sorted() && radii.is_sorted() && radii[0] > 0.0);
        // The final front is better than the initial sample.
        let volume = |key: &str| report[key].as_f64().expect("a number");
        assert!(
            volume("last_hypervolume") > 1.2 * volume("first_hypervolume"),
            "{printed}"
        );
    }
}
