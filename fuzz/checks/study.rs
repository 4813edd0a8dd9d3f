//! A study that is read is valid: its model can be built, and it reads back what it writes.

use kinefront_study::Study;

pub fn check(text: &str) {
    let study = match Study::parse(text, "fuzz") {
        Ok(study) => study,
        Err(error) => {
            assert!(!error.to_string().is_empty());
            return;
        }
    };
    study.model().expect("a valid study has a model");
    let written = toml::to_string(&study).expect("a study is TOML");
    assert_eq!(Study::parse(&written, "again").expect("a valid study"), study);
}
