//! A study being edited: its text is what counts, and it is checked as it is typed.

use std::path::{Path, PathBuf};

use crate::study::{BUILTIN, Builtin, Fault, Study, StudyError};

/// A study being edited.
#[derive(Debug, Clone)]
pub struct StudyEditor {
    /// Its text, comments and all.
    text: String,
    /// The study of the text, or the last sound one.
    study: Study,
    /// What is wrong with the text.
    faults: Vec<Fault>,
    /// Where it was read from or saved to.
    path: Option<PathBuf>,
    changed: bool,
}

impl StudyEditor {
    /// An editor of a sound study.
    pub fn new(study: Study, path: Option<PathBuf>) -> Self {
        let text = toml::to_string(&study).unwrap_or_default();
        Self {
            text,
            study,
            faults: Vec::new(),
            path,
            changed: false,
        }
    }

    /// An editor of a study that comes with the program.
    ///
    /// # Errors
    /// None for a file that passed the tests.
    pub fn builtin(builtin: &Builtin) -> Result<Self, StudyError> {
        Ok(Self {
            text: builtin.text.to_owned(),
            ..Self::new(builtin.study()?, None)
        })
    }

    /// An editor of the paper's study.
    pub fn paper() -> Self {
        Self::builtin(&BUILTIN[0]).unwrap_or_else(|_| Self::new(Study::default(), None))
    }

    /// An editor of a study file.
    ///
    /// # Errors
    /// [`StudyError`].
    pub fn read(path: &Path) -> Result<Self, StudyError> {
        let study = Study::read(path)?;
        let text = std::fs::read_to_string(path).map_err(|source| StudyError::Read {
            path: path.to_owned(),
            source,
        })?;
        Ok(Self {
            text,
            ..Self::new(study, Some(path.to_owned()))
        })
    }

    /// Writes the text; a file that stands there is replaced whole or not at all.
    ///
    /// # Errors
    /// What went wrong, in words.
    pub fn save(&mut self, path: &Path) -> Result<(), String> {
        super::files::write_whole(path, self.text.as_bytes())?;
        self.path = Some(path.to_owned());
        self.changed = false;
        Ok(())
    }

    /// The text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The study: of the text if it is sound, else the last one that was.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// What is wrong with the text; empty for a sound study.
    pub fn faults(&self) -> &[Fault] {
        &self.faults
    }

    /// Where it was read from or saved to.
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// Whether it differs from the file.
    pub fn is_changed(&self) -> bool {
        self.changed
    }

    /// Takes a text as typed.
    pub fn set_text(&mut self, text: String) {
        self.changed |= text != self.text;
        self.text = text;
        self.faults.clear();
        match Study::parse(&self.text, "study") {
            Ok(study) => self.study = study,
            Err(StudyError::Values { faults, .. }) => self.faults = faults,
            Err(StudyError::Shape { message, key, span, .. }) => {
                let line = span.map(|span| self.text[..span.offset().min(self.text.len())].lines().count().max(1));
                let place = line.map_or_else(|| "study".to_owned(), |line| format!("line {line}"));
                self.faults.push(Fault {
                    key: key.unwrap_or(place),
                    message,
                });
            }
            Err(error) => self.faults.push(Fault {
                key: "study".to_owned(),
                message: error.to_string(),
            }),
        }
    }

    /// Changes the study by hand; a change that cannot be is told and not made.
    pub fn change(&mut self, change: impl FnOnce(&mut Study)) {
        let mut study = self.study.clone();
        change(&mut study);
        if study == self.study && self.faults.is_empty() {
            return;
        }
        self.faults = study.faults();
        if self.faults.is_empty() {
            // The text is written anew: what a person wrote beside the values is kept by editing the text itself.
            self.text = toml::to_string(&study).unwrap_or_default();
            self.study = study;
        }
        self.changed = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_are_told_as_typed_and_the_sound_study_stays() {
        let mut editor = StudyEditor::paper();
        let sound = editor.text().to_owned();
        editor.set_text(sound.replace("evaluations = 6000", "evaluations = 0"));
        assert_eq!(editor.faults()[0].key, "optimizer.evaluations");
        assert_eq!(editor.study().optimizer.evaluations, 6000);
        editor.set_text(sound.replace("[optimizer]", "[optimiser]"));
        assert!(
            editor.faults()[0].message.contains("optimiser"),
            "{:?}",
            editor.faults()
        );
        editor.set_text(sound);
        assert!(editor.faults().is_empty());
        editor.change(|study| study.optimizer.seed = 7);
        assert!(editor.text().contains("seed = 7") && editor.is_changed());
        editor.change(|study| study.bounds.R_m = [2.0, 1.0]);
        assert_eq!(editor.faults()[0].key, "bounds.R_m");
        assert_eq!(editor.study().bounds.R_m, [0.5, 4.0]);
    }
}
