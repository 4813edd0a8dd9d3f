//! A table that is read has finite numbers only.

use std::io::Write;

use kinefront_study::{Study, read_designs, read_table};

pub fn check(bytes: &[u8]) {
    let mut file = tempfile::NamedTempFile::new().expect("a file");
    file.write_all(bytes).expect("a table");
    let study = Study::default();
    if let Ok(contents) = read_table(file.path(), &study) {
        for entry in contents.rows {
            assert!(
                entry.row.mass().is_finite()
                    && entry.row.workspace_radius().is_finite()
                    && entry.row.violation.is_finite()
            );
            assert!(entry.row.margins.iter().flatten().all(|margin| margin.is_finite()));
        }
    }
    let _ = read_designs(file.path(), &study);
}
