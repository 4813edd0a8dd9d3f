//! A study being edited: its text is authoritative and is checked as it is typed.

use crate::AnyError;
use std::path::{Path, PathBuf};

use toml::{Table, Value};
use toml_edit::{DocumentMut, Item, TableLike};

use super::History;
use kinefront_study::{BUILTIN, Builtin, Fault, Study, StudyError, settings};

/// The text of a study and the file that it was read from or saved to.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StudySource {
    text: String,
    path: Option<PathBuf>,
}

/// A study being edited.
#[derive(Debug, Clone)]
pub struct StudyEditor {
    /// Its text, including comments, and its file, with their earlier states.
    source: History<StudySource>,
    /// The study that the text describes, or the last valid one.
    study: Study,
    /// Faults in the text.
    faults: Vec<Fault>,
    /// Faults of the last change by hand, which was not made; empty if it was.
    rejected: Vec<Fault>,
    changed: bool,
}

impl StudyEditor {
    /// Makes an editor for a valid study.
    pub fn new(study: Study, path: Option<PathBuf>) -> Self {
        let text = toml::to_string(&study).unwrap_or_default();
        Self {
            source: history_of(text, path),
            study,
            faults: Vec::new(),
            rejected: Vec::new(),
            changed: false,
        }
    }

    /// Makes an editor for a built-in study.
    ///
    /// # Errors
    /// Returns a [`StudyError`] if the built-in study is invalid, which the tests exclude.
    pub fn builtin(builtin: &Builtin) -> Result<Self, StudyError> {
        Ok(Self {
            source: history_of(builtin.text.to_owned(), None),
            ..Self::new(builtin.study()?, None)
        })
    }

    /// Makes an editor for the paper's study.
    pub fn paper() -> Self {
        Self::builtin(&BUILTIN[0]).unwrap_or_else(|_| Self::new(Study::default(), None))
    }

    /// Makes an editor for a study file.
    ///
    /// # Errors
    /// Returns a [`StudyError`] if the file cannot be read or the study is invalid.
    pub fn read(path: &Path) -> Result<Self, StudyError> {
        let study = Study::read(path)?;
        let text = std::fs::read_to_string(path).map_err(|cause| StudyError::Read {
            path: path.to_owned(),
            cause,
        })?;
        Ok(Self {
            source: history_of(text, Some(path.to_owned())),
            ..Self::new(study, Some(path.to_owned()))
        })
    }

    /// Makes an editor for a study that was read from `path` or is built in, and then changed by options: the text keeps
    /// its comments.
    pub fn opened(study: &Study, path: Option<&Path>) -> Self {
        let source = match path {
            Some(path) => Self::read(path).ok(),
            None => Builtin::find(&study.name).and_then(|builtin| Self::builtin(&builtin).ok()),
        };
        let changed = source.map(|mut editor| {
            editor.change(|as_read| as_read.clone_from(study));
            editor
        });
        changed
            .filter(|editor| editor.study == *study)
            .unwrap_or_else(|| Self::new(study.clone(), path.map(Path::to_owned)))
    }

    /// Saves the text atomically: an existing file is either replaced completely or left unchanged.
    ///
    /// # Errors
    /// Returns a message that says why the file cannot be written.
    pub fn save(&mut self, path: &Path) -> Result<(), AnyError> {
        kinefront_study::write_whole(path, self.text().as_bytes())?;
        // Where a text was saved is no step to undo.
        self.source.follow(|source| source.path = Some(path.to_owned()));
        self.changed = false;
        Ok(())
    }

    /// Returns the text.
    pub fn text(&self) -> &str {
        &self.source.present().text
    }

    /// Returns the study that the text describes if it is valid, otherwise the last valid one.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// Iterates over the faults in the text, then over those of the last change by hand if it was not made.
    pub fn faults(&self) -> impl Iterator<Item = &Fault> {
        self.faults.iter().chain(&self.rejected)
    }

    /// Returns the first fault in the text; a valid study has none.
    pub fn text_fault(&self) -> Option<&Fault> {
        self.faults.first()
    }

    /// Returns the file that the study was read from or saved to, if there is one.
    pub fn path(&self) -> Option<&Path> {
        self.source.present().path.as_deref()
    }

    /// Returns whether the study was changed since it was read or saved.
    pub fn is_changed(&self) -> bool {
        self.changed
    }

    /// Sets the text as typed and checks it.
    pub fn set_text(&mut self, text: String) {
        self.changed |= text != *self.text();
        self.source.edit(|source| source.text = text);
        self.check();
    }

    /// Puts another study in the place of this one, as a step that can be undone.
    pub fn replace(&mut self, other: &Self) {
        self.source.edit(|source| source.clone_from(other.source.present()));
        self.check();
        self.changed = false;
    }

    /// Returns the text and its file with their earlier states.
    pub fn history(&self) -> &History<StudySource> {
        &self.source
    }

    /// Undoes the last change.
    pub fn undo(&mut self) {
        self.source.undo();
        self.changed = true;
        self.check();
    }

    /// Redoes the change undone last.
    pub fn redo(&mut self) {
        self.source.redo();
        self.changed = true;
        self.check();
    }

    /// Ends the gesture to which changes by hand belong.
    pub fn end_gesture(&mut self) {
        self.source.end_gesture();
    }

    /// Reads the study from the text, or the faults of the text.
    fn check(&mut self) {
        self.faults.clear();
        self.rejected.clear();
        match self.parse(self.text()) {
            Ok(study) => self.study = study,
            Err(StudyError::Values { faults, .. }) => self.faults = faults,
            Err(StudyError::Shape { message, key, span, .. }) => {
                let line = span.map(|span| {
                    self.text()[..span.offset().min(self.text().len())]
                        .lines()
                        .count()
                        .max(1)
                });
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

    /// Parses a text whose paths are relative to the folder of the study's file.
    fn parse(&self, text: &str) -> Result<Study, StudyError> {
        let folder = self.path().and_then(Path::parent).unwrap_or(Path::new(""));
        Study::parse_in(folder, text, "study")
    }

    /// Changes the study by hand; an invalid change is reported as faults and not made.
    pub fn change(&mut self, change: impl FnOnce(&mut Study)) {
        let mut study = self.study.clone();
        change(&mut study);
        if study == self.study {
            return;
        }
        self.rejected = study.faults();
        if self.rejected.is_empty() {
            let text = self.text_of(&study);
            self.source.drag("by hand", |source| source.text = text);
            self.study = study;
            self.faults.clear();
            self.changed = true;
        }
    }

    /// Returns the text of a study: the present text with the values that differ replaced, so that its comments and its
    /// order stay. A text that does not give the study then, because it has faults of its own, is generated anew.
    fn text_of(&self, study: &Study) -> String {
        let edited = || {
            let (before, after) = (Table::try_from(&self.study).ok()?, Table::try_from(study).ok()?);
            let text = replace_values(self.text(), &before, &after)?;
            self.parse(&text).is_ok_and(|found| found == *study).then_some(text)
        };
        edited().unwrap_or_else(|| toml::to_string(study).unwrap_or_default())
    }
}

/// Returns a history that begins with a text and its file.
fn history_of(text: String, path: Option<PathBuf>) -> History<StudySource> {
    let mut history = History::default();
    history.restart(StudySource { text, path });
    history
}

/// Replaces the settings of `text` that differ between two studies. `None` if the text is not TOML.
fn replace_values(text: &str, before: &Table, after: &Table) -> Option<String> {
    let mut document: DocumentMut = text.parse().ok()?;
    for setting in settings() {
        let value = setting.value(after);
        if setting.value(before) == value {
            continue;
        }
        let mut table = document.as_table_mut() as &mut dyn TableLike;
        for section in setting.section.split('.').filter(|part| !part.is_empty()) {
            table = table
                .entry(section)
                .or_insert_with(toml_edit::table)
                .as_table_like_mut()?;
        }
        match value {
            Some(value) => {
                let mut value = edit_value(value)?;
                let item = table.entry(setting.key).or_insert(Item::None);
                if let Some(old) = item.as_value() {
                    *value.decor_mut() = old.decor().clone();
                }
                *item = Item::Value(value);
            }
            None => {
                table.remove(setting.key);
            }
        }
    }
    Some(document.to_string())
}

/// Converts a value for the text; `None` for what no setting is: a date.
fn edit_value(value: &Value) -> Option<toml_edit::Value> {
    Some(match value {
        Value::String(text) => text.as_str().into(),
        Value::Integer(number) => (*number).into(),
        Value::Float(number) => (*number).into(),
        Value::Boolean(flag) => (*flag).into(),
        Value::Array(items) => {
            let items: toml_edit::Array = items.iter().map(edit_value).collect::<Option<_>>()?;
            items.into()
        }
        Value::Table(table) => {
            let entries = table
                .iter()
                .map(|(key, value)| Some((key.as_str(), edit_value(value)?)));
            let table: toml_edit::InlineTable = entries.collect::<Option<_>>()?;
            table.into()
        }
        Value::Datetime(_) => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_are_told_as_typed_and_the_sound_study_stays() {
        let mut editor = StudyEditor::paper();
        let valid = editor.text().to_owned();
        editor.set_text(valid.replace("evaluations = 6000", "evaluations = 0"));
        assert_eq!(editor.faults().next().expect("a fault").key, "optimizer.evaluations");
        assert_eq!(editor.study().optimizer.evaluations, 6000);
        editor.set_text(valid.replace("[optimizer]", "[optimiser]"));
        assert!(
            editor
                .faults()
                .next()
                .is_some_and(|fault| fault.message.contains("optimiser")),
            "{:?}",
            editor.faults().next()
        );
        editor.set_text(valid);
        assert!(editor.faults().next().is_none());
        editor.change(|study| study.optimizer.seed = 7);
        editor.undo();
        assert!(editor.study().optimizer.seed == 1 && editor.history().can_redo());
        editor.redo();
        assert_eq!(editor.study().optimizer.seed, 7);
        assert!(editor.text().contains("seed = 7") && editor.is_changed());
        let kept = editor.text().replace("seed = 7", "seed = 1");
        assert_eq!(kept, BUILTIN[0].text, "everything but the value stays, comments too");
        // Another study takes its place, and undo brings the edits back.
        let edited = editor.text().to_owned();
        let other = StudyEditor::builtin(&BUILTIN[1]).expect("a built-in study");
        editor.replace(&other);
        assert!(editor.study() == other.study() && !editor.is_changed());
        editor.undo();
        assert!(editor.text() == edited && editor.study().optimizer.seed == 7);
        editor.change(|study| study.bounds.R_m = [2.0, 1.0]);
        assert_eq!(editor.faults().next().expect("a fault").key, "bounds.R_m");
        assert_eq!(editor.study().bounds.R_m, [0.5, 4.0]);
        assert!(editor.text_fault().is_none(), "the text is still valid");
        editor.change(|study| study.bounds.R_m = [1.0, 2.0]);
        assert!(editor.faults().next().is_none() && editor.text().contains("# circumradius of the base joints"));
    }

    #[test]
    fn values_are_added_to_and_removed_from_a_text() {
        let mut editor = StudyEditor::paper();
        editor.set_text("# mine\nname = \"mine\"\n\n[bounds] # wide\nR_m = [1, 2] # m\n".to_owned());
        editor.change(|study| {
            study.bounds.R_m = [1.0, 3.0];
            study.requirements.clearance_min_m = Some(0.005);
            study.optimizer.front_de.scale = 0.4;
        });
        assert!(editor.faults().next().is_none(), "{:?}", editor.faults().next());
        for part in [
            "# mine",
            "[bounds] # wide",
            "R_m = [1.0, 3.0] # m",
            "[requirements]",
            "clearance_min_m = 0.005",
        ] {
            assert!(editor.text().contains(part), "{part}: {}", editor.text());
        }
        editor.change(|study| study.requirements.clearance_min_m = None);
        assert!(!editor.text().contains("clearance_min_m"), "{}", editor.text());
        assert_eq!(editor.study().optimizer.front_de.scale, 0.4);
    }

    #[test]
    fn a_catalogue_is_read_beside_the_file_of_the_study() {
        let folder = tempfile::tempdir().expect("a folder");
        let (path, catalogue) = (folder.path().join("mine.toml"), folder.path().join("tubes.csv"));
        let text = "[sections.legs]\nkind = \"tube\"\ncatalogue = \"tubes.csv\"\n";
        std::fs::write(&path, text).expect("a study");
        let error = StudyEditor::read(&path).expect_err("no catalogue").to_string();
        assert!(error.contains("sections.legs.catalogue"), "{error}");
        std::fs::write(&catalogue, "name,outer_mm,wall_mm,kg_per_m\n40 x 2,40,2,1.87\n").expect("a catalogue");
        let mut editor = StudyEditor::read(&path).expect("a study");
        editor.set_text(format!("{text}# as typed\n"));
        assert!(editor.faults().next().is_none(), "{:?}", editor.faults().next());
        let sections = editor.study().sections.cross_sections();
        assert_eq!(sections.legs.mass_per_length(7850.0, 0.02), 1.87);
    }
}
