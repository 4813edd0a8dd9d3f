//! Reading a study file: errors that show file, line and key.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use miette::{Diagnostic, LabeledSpan, NamedSource, SourceSpan};
use toml::de::{DeTable, DeValue};

use super::{Fault, Study};

/// Why a text is not a study.
#[derive(Debug, thiserror::Error, Diagnostic)]
pub enum StudyError {
    /// The file cannot be read.
    #[error("cannot read the study {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The text is no TOML, or a key is unknown or of the wrong type.
    #[error("the study does not read{}: {message}", key.as_ref().map(|key| format!(" at `{key}`")).unwrap_or_default())]
    Shape {
        /// What the reader found.
        message: String,
        /// Dotted key, where it is known.
        key: Option<String>,
        /// The text.
        #[source_code]
        source_code: Arc<NamedSource<String>>,
        /// Where.
        #[label("here")]
        span: Option<SourceSpan>,
    },
    /// Values that cannot be.
    #[error("the study asks for what cannot be: {}", summary(.faults))]
    Values {
        /// Each key with what is wrong about its value and what would be right.
        faults: Vec<Fault>,
        /// The text.
        #[source_code]
        source_code: Arc<NamedSource<String>>,
        /// Where.
        #[label(collection)]
        labels: Vec<LabeledSpan>,
    },
}

fn summary(faults: &[Fault]) -> String {
    let texts: Vec<String> = faults
        .iter()
        .map(|fault| format!("`{}` {}", fault.key, fault.message))
        .collect();
    texts.join("; ")
}

impl Study {
    /// Reads a study file.
    ///
    /// # Errors
    /// [`StudyError`], a diagnostic with the place in the file.
    pub fn read(path: &Path) -> Result<Self, StudyError> {
        let text = std::fs::read_to_string(path).map_err(|source| StudyError::Read {
            path: path.to_owned(),
            source,
        })?;
        Self::parse(&text, &path.display().to_string())
    }

    /// Reads a study from `text`; errors name it `name`.
    ///
    /// # Errors
    /// As [`Study::read`].
    pub fn parse(text: &str, name: &str) -> Result<Self, StudyError> {
        let source_code = || Arc::new(NamedSource::new(name, text.to_owned()).with_language("TOML"));
        let study: Study = toml::from_str(text).map_err(|error| StudyError::Shape {
            message: error.message().to_owned(),
            key: error.span().and_then(|span| key_at(text, span.start)),
            source_code: source_code(),
            span: error.span().map(SourceSpan::from),
        })?;
        let faults = study.faults();
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

/// Dotted key of the innermost value or key that contains byte `position`.
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

/// Place of the value of a dotted key, or of the nearest table around it that stands in the text.
fn span_of(text: &str, key: &str) -> Option<SourceSpan> {
    let document = DeTable::parse(text).ok()?;
    let mut table = document.get_ref();
    let mut span = None;
    for part in key.split('.') {
        let Some(value) = table.get(part) else { break };
        span = Some(SourceSpan::from(value.span()));
        match value.get_ref() {
            DeValue::Table(inner) => table = inner,
            _ => break,
        }
    }
    span
}
