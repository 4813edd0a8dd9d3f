//! An external optimizer uses the evaluator.

use std::path::Path;

use super::support::{list, number, python, script_json};

#[test]
fn pymoo_finds_a_front_through_the_stream() {
    if let Some(python) = python(&["pymoo", "numpy"]) {
        let report = script_json(python, "pymoo_nsga2.py", &[Path::new(env!("CARGO_BIN_EXE_kinefront"))]);
        let front = list(&report["front"]);
        assert!(front.len() >= 10, "{report}");
        let [masses, radii] =
            [0, 1].map(|place: usize| -> Vec<f64> { front.iter().map(|design| number(&design[place])).collect() });
        assert!(masses.is_sorted() && radii.is_sorted() && radii[0] > 0.0);
        // The final front is better than the initial sample.
        let (first, last) = (&report["first_hypervolume"], &report["last_hypervolume"]);
        assert!(number(last) > 1.2 * number(first), "{report}");
    }
}
