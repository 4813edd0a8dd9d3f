//! Why a study cannot be read, shown with file, line and key.

use std::path::PathBuf;
use std::sync::Arc;

use miette::{Diagnostic, LabeledSpan, NamedSource, SourceSpan};

use super::Fault;
use crate::Builtin;

/// Largest length of a line of a study \[bytes\].
pub(crate) const LONGEST_LINE: usize = 4096;

/// Error of reading a study.
#[derive(Debug, thiserror::Error, Diagnostic)]
pub enum StudyError {
    /// The file cannot be read.
    #[error("cannot read the study {}: {cause}", path.display())]
    Read {
        /// Path of the file.
        path: PathBuf,
        /// Cause of the error.
        cause: std::io::Error,
    },
    /// There is neither a file nor a built-in study of that name.
    #[error("there is neither a study file nor a built-in study named `{}`", path.display())]
    #[diagnostic(help("the built-in studies are: {}", Builtin::names()))]
    Unknown {
        /// What was given as the path or the name.
        path: PathBuf,
    },
    /// A line is too long to be one of a study, and to be shown.
    #[error("line {line} of the study {name} has {length} bytes; the lines of a study have at most {LONGEST_LINE}")]
    Line {
        /// Name of the study's file.
        name: String,
        /// Number of the line, from 1.
        line: usize,
        /// Its length.
        length: usize,
    },
    /// A line has a character that a terminal does not show.
    #[error("line {line} of the study {name} has the character {found}, which a terminal does not show; remove it")]
    Hidden {
        /// Name of the study's file.
        name: String,
        /// Number of the line, from 1.
        line: usize,
        /// The character, escaped.
        found: String,
    },
    /// The text is not TOML, or a key is unknown or has a value of the wrong type.
    #[error("cannot parse the study{}: {message}", key.as_ref().map(|key| format!(" at `{key}`")).unwrap_or_default())]
    Shape {
        /// Message of the parser.
        message: String,
        /// Dotted key, if it is known.
        key: Option<String>,
        /// Text of the study.
        #[source_code]
        source_code: Arc<NamedSource<String>>,
        /// Location of the error in the text.
        #[label("here")]
        span: Option<SourceSpan>,
    },
    /// The study has invalid values.
    #[error("the study has invalid values: {}", summary(.faults))]
    Values {
        /// Each key with an invalid value, what is wrong about the value and what would be right.
        faults: Vec<Fault>,
        /// Text of the study.
        #[source_code]
        source_code: Arc<NamedSource<String>>,
        /// Locations of the faults in the text.
        #[label(collection)]
        labels: Vec<LabeledSpan>,
    },
}

/// Returns the faults in a line, with a message that several keys share only once.
fn summary(faults: &[Fault]) -> String {
    let text = |(place, fault): (usize, &Fault)| {
        let first = faults[..place].iter().find(|other| other.message == fault.message);
        match first {
            Some(first) => format!("`{}` has the same fault as `{}`", fault.key, first.key),
            None => format!("`{}` {}", fault.key, fault.message),
        }
    };
    faults.iter().enumerate().map(text).collect::<Vec<String>>().join("; ")
}
