//! Mutated tables are read or refused, and never give a number that is not finite.

use std::fs;

use kinefront_model::evaluation::Quantity;
use kinefront_study::{RunFolder, read_designs, read_table};
use proptest::prelude::*;

/// Edits of a text: at a fraction of its length, a byte is replaced, inserted or removed.
fn edits() -> impl Strategy<Value = Vec<(f64, u8, u8)>> {
    prop::collection::vec((0.0..1.0f64, 0..3u8, any::<u8>()), 1..6)
}

fn edited(text: &[u8], edits: &[(f64, u8, u8)]) -> Vec<u8> {
    let mut text = text.to_vec();
    for &(place, kind, byte) in edits {
        let at = (place * text.len() as f64) as usize;
        match kind {
            0 if !text.is_empty() => text[at] = byte,
            1 if !text.is_empty() => drop(text.remove(at)),
            _ => text.insert(at, byte),
        }
    }
    text
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// A table that still reads has as many rows as it had, or its last row was cut; all its numbers are finite.
    #[test]
    fn a_mutated_table_is_read_or_refused(edits in edits()) {
        let fixture = kinefront_testkit::run_folder();
        let run = RunFolder::open(&fixture).expect("a run");
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("designs.csv");
        let original = fs::read(fixture.join("designs.csv")).expect("a table");
        fs::write(&path, edited(&original, &edits)).expect("a table");
        if let Ok(contents) = read_table(&path, run.study()) {
            let rows = contents.rows.len();
            prop_assert!(rows == 300 || rows == 299 && contents.cut_line.is_some() || edits.iter().any(|edit| edit.2 == b'\n' || edit.2 == b'\r'), "{} rows", rows);
            for entry in &contents.rows {
                let row = &entry.row;
                prop_assert!(row.mass().is_finite() && row.workspace_radius().is_finite() && row.violation.is_finite());
                prop_assert!(row.margins.iter().flatten().all(|value| value.is_finite()));
                prop_assert!(Quantity::all().filter_map(|quantity| row.quantities.get(quantity)).all(f64::is_finite));
            }
        }
        let _ = read_designs(&path, run.study());
    }
}
