//! Small forms of the fuzz targets: mutated texts and files are read or refused, and never give a number that is not finite.

use std::fs;

use kinefront_model::evaluation::{Model, Quantity};
use kinefront_model::mechanism::{Design, WorkingMode};
use kinefront_model::spatial::Pose;
use kinefront_study::{BUILTIN, RunFolder, Study, read_designs, read_table};
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
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn a_mutated_study_is_read_or_refused(which in 0..BUILTIN.len(), edits in edits()) {
        let bytes = edited(BUILTIN[which].text.as_bytes(), &edits);
        let text = String::from_utf8_lossy(&bytes);
        match Study::parse(&text, "mutated") {
            Ok(study) => {
                prop_assert!(study.model().is_ok());
                let written = toml::to_string(&study).expect("a study is TOML");
                prop_assert_eq!(Study::parse(&written, "again").expect("a valid study"), study);
            }
            Err(error) => prop_assert!(!error.to_string().is_empty()),
        }
    }

    #[test]
    fn mutated_designs_and_poses_are_read_or_refused(design in edits(), pose in edits()) {
        let design = edited(b"3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056 mode=+-+", &design);
        let pose = edited(b"x=0.1 y=-0.2 phi_deg=30", &pose);
        let (Ok(design), Ok(pose)) = (
            Design::parse(&String::from_utf8_lossy(&design), WorkingMode::ALL_PLUS),
            String::from_utf8_lossy(&pose).parse::<Pose>(),
        ) else {
            return Ok(());
        };
        prop_assert!(design.values().iter().all(|value| value.is_finite()));
        let model = Model::default();
        prop_assert!(model.mass(&design).is_finite());
        if let Ok(found) = model.pose(&design, &pose) {
            prop_assert!(found.actuators.iter().all(|value| value.is_finite()));
        }
    }
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
