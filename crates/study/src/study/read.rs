//! Reading of study files: the location of whatever is wrong in one is found in its text.

use std::ffi::OsStr;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::sync::Arc;

use miette::{LabeledSpan, NamedSource, SourceSpan};
use toml::de::{DeTable, DeValue};

use super::error::LONGEST_LINE;
use super::{Fault, Study};
use crate::settings::{FileScope, LoadCatalogue, is_shown};
use crate::{Builtin, StudyError};

/// Largest size of a study file \[bytes\].
const LARGEST_STUDY: u64 = 1 << 18;

impl Builtin {
    /// Parses the study.
    ///
    /// # Errors
    /// [`StudyError`]; the tests make sure that no built-in study causes one.
    pub fn study(&self) -> Result<Study, StudyError> {
        Study::parse(self.text, self.name)
    }
}

impl Study {
    /// Reads the study that an argument specifies: a study file, or the name of a built-in study.
    ///
    /// # Errors
    /// [`StudyError`].
    pub fn load(argument: &OsStr) -> Result<Self, StudyError> {
        Self::load_within(argument, FileScope::BesideStudy)
    }

    /// As [`Study::load`], for a study that may name other files than those in its folder and below it.
    ///
    /// # Errors
    /// [`StudyError`].
    pub fn load_within(argument: &OsStr, scope: FileScope) -> Result<Self, StudyError> {
        let path = Path::new(argument);
        // A study may come from a pipe, but not from a folder.
        let is_file = path.exists() && !path.is_dir();
        match argument.to_str().and_then(Builtin::find) {
            // A folder of that name does not take precedence over the built-in study.
            Some(builtin) if !is_file => builtin.study(),
            None if !is_file => Err(StudyError::Unknown { path: path.to_owned() }),
            _ => Self::read_within(path, scope),
        }
    }

    /// Reads a study file, which may name other files in its folder and below it.
    ///
    /// # Errors
    /// [`StudyError`], a diagnostic that shows the location in the file.
    pub fn read(path: &Path) -> Result<Self, StudyError> {
        Self::read_within(path, FileScope::BesideStudy)
    }

    fn read_within(path: &Path, scope: FileScope) -> Result<Self, StudyError> {
        let text = read_limited(path).map_err(|cause| StudyError::Read {
            path: path.to_owned(),
            cause,
        })?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::parse_within(folder, scope, &text, &path.display().to_string())
    }

    /// Parses a study from `text`; error messages refer to it by `name`.
    ///
    /// # Errors
    /// As [`Study::read`].
    pub fn parse(text: &str, name: &str) -> Result<Self, StudyError> {
        Self::parse_in(Path::new(""), text, name)
    }

    /// Parses a study whose paths are relative to `folder`.
    ///
    /// # Errors
    /// As [`Study::read`].
    pub fn parse_in(folder: &Path, text: &str, name: &str) -> Result<Self, StudyError> {
        Self::parse_within(folder, FileScope::BesideStudy, text, name)
    }

    fn parse_within(folder: &Path, scope: FileScope, text: &str, name: &str) -> Result<Self, StudyError> {
        // What a terminal would not show must not be in a message that quotes the study.
        let hidden = |(line, text): (usize, &str)| Some((line, text.chars().find(|&found| !is_shown(found))?));
        if let Some((line, found)) = (1..).zip(text.lines()).find_map(hidden) {
            return Err(StudyError::Hidden {
                name: name.to_owned(),
                line,
                found: found.escape_unicode().to_string(),
            });
        }
        if let Some((line, text)) = (1..).zip(text.lines()).find(|(_, text)| text.len() > LONGEST_LINE) {
            return Err(StudyError::Line {
                name: name.to_owned(),
                line,
                length: text.len(),
            });
        }
        let source_code = || Arc::new(NamedSource::new(name, text.to_owned()).with_language("TOML"));
        let mut study: Study = toml::from_str(text).map_err(|error| StudyError::Shape {
            message: explained(error.message()),
            key: error.span().and_then(|span| key_at(text, span.start)),
            source_code: source_code(),
            span: error.span().map(SourceSpan::from),
        })?;
        study.material.take_named_values(|key| states(text, "material", key));
        let load = |(key, catalogue): (&'static str, &mut dyn LoadCatalogue)| {
            let message = catalogue.load(folder, scope).err()?.to_string();
            Some(Fault::new(key, message))
        };
        let mut faults: Vec<Fault> = study.catalogue_choices().filter_map(load).collect();
        if faults.is_empty() {
            faults = study.faults();
        }
        if faults.is_empty() {
            return Ok(study);
        }
        let labels = faults
            .iter()
            .filter_map(|fault| {
                let span = span_of(text, &fault.key)?;
                Some(LabeledSpan::new_with_span(Some(fault.message.clone()), span))
            })
            .collect();
        Err(StudyError::Values {
            faults,
            source_code: source_code(),
            labels,
        })
    }
}

/// Reads a text of at most [`LARGEST_STUDY`].
fn read_limited(path: &Path) -> io::Result<String> {
    let mut text = String::new();
    File::open(path)?.take(LARGEST_STUDY + 1).read_to_string(&mut text)?;
    if text.len() as u64 > LARGEST_STUDY {
        let message = format!("it has more than {LARGEST_STUDY} bytes; a study has about 5000");
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, message));
    }
    Ok(text)
}

/// Returns the dotted key of the innermost key or value that contains byte `position`.
fn key_at(text: &str, position: usize) -> Option<String> {
    fn find(table: &DeTable<'_>, position: usize) -> Option<String> {
        for (key, value) in table {
            let inside = |span: std::ops::Range<usize>| span.contains(&position);
            if inside(key.span()) {
                return Some(key.get_ref().to_string());
            }
            if let DeValue::Table(inner) = value.get_ref()
                && let Some(rest) = find(inner, position)
            {
                return Some(format!("{}.{rest}", key.get_ref()));
            }
            if inside(value.span()) {
                return Some(key.get_ref().to_string());
            }
        }
        None
    }
    find(DeTable::parse(text).ok()?.get_ref(), position)
}

/// Returns whether a section of the text states a key.
fn states(text: &str, section: &str, key: &str) -> bool {
    let document = DeTable::parse(text).ok();
    let section = document.as_ref().and_then(|document| document.get_ref().get(section));
    let stated = section.and_then(|section| section.get_ref().as_table()?.get(key));
    stated.is_some()
}

/// Returns the location of the value of a dotted key, or of the innermost enclosing table that the text contains.
fn span_of(text: &str, key: &str) -> Option<SourceSpan> {
    let document = DeTable::parse(text).ok()?;
    let mut table = document.get_ref();
    let mut span = None;
    for part in key.split('.') {
        // `obstacles[2]` is the second of a list of tables.
        let (name, place) = match part.strip_suffix(']').and_then(|part| part.split_once('[')) {
            Some((name, place)) => (name, place.parse().ok()),
            None => (part, None::<usize>),
        };
        let Some(mut value) = table.get(name) else { break };
        if let (Some(place), DeValue::Array(list)) = (place, value.get_ref()) {
            let Some(found) = list.get(place.wrapping_sub(1)) else {
                break;
            };
            value = found;
        }
        span = Some(SourceSpan::from(value.span()));
        match value.get_ref() {
            DeValue::Table(inner) => table = inner,
            _ => break,
        }
    }
    span
}

/// Returns the message of the parser, with an example where its words are those of the program's types.
fn explained(message: &str) -> String {
    match message {
        _ if message.contains("expected `minimize` or `maximize`") => {
            format!("{message}; write an objective as in {{ minimize = \"mass_kg\" }}")
        }
        _ => message
            .replace("expected f64", "expected a number")
            .replace("expected a sequence", "expected a list"),
    }
}
