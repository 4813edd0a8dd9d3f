//! A run folder with any files, which a line of `===` separates, is opened, resumed and checked, or refused.

use kinefront_study::{ResumeOptions, Resumption, RunFolder};

pub fn check(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let folder = tempfile::tempdir().expect("a folder");
    let names = ["study.toml", "designs.csv", "front.csv", "run.json", "progress.json"];
    for (name, text) in names.into_iter().zip(text.split("===\n")) {
        if !text.is_empty() {
            std::fs::write(folder.path().join(name), text).expect("a file");
        }
    }
    if let Ok(run) = RunFolder::open(folder.path()) {
        let _ = (run.designs(), run.front());
        // A study of large grids is valid, but takes its time.
        if run.study().grid.reference.directions < 40 && run.study().grid.reference.ray_steps < 60 {
            let options = ResumeOptions {
                threads: Some(1),
                accept_unverified: true,
                ..ResumeOptions::default()
            };
            let _ = Resumption::open(folder.path(), &options);
        }
    }
}
