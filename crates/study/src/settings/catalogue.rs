//! Catalogues of what can be bought: one that comes with the program, a CSV file beside the study, or entries in the study
//! (docs/interfaces.md).

use std::path::Path;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::declare::wrong_name;
use crate::durable::{or_here, read_regular};
use kinefront_model::dynamics::DriveCatalogueError;
use kinefront_model::mechanism::CatalogueError;

/// An entry of a catalogue, as in a study file and as a line of a CSV file.
pub trait CatalogueItem: Clone + DeserializeOwned {
    /// The columns of a CSV file, in words.
    const COLUMNS: &'static str;
    /// Names of those that a file must have.
    const REQUIRED: &'static [&'static str];
    /// Names of those that a file may have.
    const OPTIONAL: &'static [&'static str] = &[];
    /// The catalogues of such entries that come with the program.
    const BUILTIN: &'static [BuiltinCatalogue];

    /// Name, as it is ordered.
    fn name(&self) -> &str;
}

/// A catalogue: the name of one that comes with the program, the path of a CSV file, or the entries themselves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum CatalogueChoice<Item> {
    /// Name or path.
    Named(String),
    /// The entries.
    Rows(Vec<Item>),
}

/// A catalogue that comes with the program.
#[derive(Debug, Clone, Copy)]
pub struct BuiltinCatalogue {
    /// Name in study files.
    pub name: &'static str,
    /// Where its figures come from.
    pub source: &'static str,
    pub(super) text: &'static str,
}

/// Why a catalogue cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum CatalogueFault {
    /// The file cannot be read.
    #[error("cannot be read: {cause}; give the path of a CSV file beside the study, or {known}")]
    Read {
        /// Why.
        cause: std::io::Error,
        /// Names of the catalogues that come with the program.
        known: String,
    },
    /// The file is neither in the folder of the study nor below it.
    #[error(
        "is a file outside the folder of the study, which is not read by default: move it into that folder, or pass --outside-files"
    )]
    Outside,
    /// A line is not an entry of a catalogue.
    #[error(
        "is wrong: line {line} of {file} is not an entry of a catalogue; its columns, separated by commas, are {columns}"
    )]
    Row {
        /// The file, or the name of the catalogue.
        file: String,
        /// The line.
        line: u64,
        /// The columns.
        columns: &'static str,
    },
    /// The first line does not name the columns.
    #[error("is wrong: the first line of {file} must name the columns, separated by commas: {columns}")]
    Header {
        /// The file, or the name of the catalogue.
        file: String,
        /// The columns.
        columns: &'static str,
    },
    /// The file is not text.
    #[error("is wrong: {0} is not UTF-8 text; save it in that encoding")]
    Encoding(String),
    /// The name of an entry is wrong.
    #[error("is wrong: the name in line {line} of {file} {fault}")]
    Name {
        /// The file, or the name of the catalogue.
        file: String,
        /// The line.
        line: u64,
        /// What is wrong.
        fault: String,
    },
    /// The entries do not form a catalogue of bars.
    #[error("is wrong: {0}")]
    Bars(#[from] CatalogueError),
    /// The entries do not form a catalogue of drives.
    #[error("is wrong: {0}")]
    Drives(#[from] DriveCatalogueError),
}

/// Which files a study may name.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum FileScope {
    /// Those in its folder and below it.
    #[default]
    BesideStudy,
    /// Any file.
    Anywhere,
}

/// A catalogue whose entries are read from the file that a study names.
pub(crate) trait LoadCatalogue {
    /// Replaces the path of a file, relative to `folder`, by the entries of the file, if the file is within the scope.
    ///
    /// # Errors
    /// [`CatalogueFault`].
    fn load(&mut self, folder: &Path, scope: FileScope) -> Result<(), CatalogueFault>;
}

impl<Item: CatalogueItem> LoadCatalogue for CatalogueChoice<Item> {
    fn load(&mut self, folder: &Path, scope: FileScope) -> Result<(), CatalogueFault> {
        if let Self::Named(name) = self
            && builtin::<Item>(name).is_none()
        {
            *self = Self::Rows(read_rows(folder, name, scope)?);
        }
        Ok(())
    }
}

impl<Item: CatalogueItem> CatalogueChoice<Item> {
    /// Returns the entries.
    pub(super) fn rows(&self) -> Result<Vec<Item>, CatalogueFault> {
        match self {
            Self::Rows(rows) => Ok(rows.clone()),
            Self::Named(name) => match builtin::<Item>(name) {
                Some(builtin) => rows(builtin.text, name),
                None => read_rows(Path::new(""), name, FileScope::BesideStudy),
            },
        }
    }
}

fn builtin<Item: CatalogueItem>(name: &str) -> Option<&'static BuiltinCatalogue> {
    Item::BUILTIN.iter().find(|builtin| builtin.name == name)
}

/// Largest catalogue \[bytes\].
const LARGEST_CATALOGUE: u64 = 1 << 20;

fn rows<Item: CatalogueItem>(text: &str, file: &str) -> Result<Vec<Item>, CatalogueFault> {
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let columns = Item::COLUMNS;
    let wrong_header = || CatalogueFault::Header {
        file: file.to_owned(),
        columns,
    };
    let headers = reader.headers().map_err(|_| wrong_header())?.clone();
    let is_named = |column: &&str| headers.iter().any(|header| header == *column);
    let is_known = |header: &str| Item::REQUIRED.contains(&header) || Item::OPTIONAL.contains(&header);
    if !Item::REQUIRED.iter().all(is_named) || !headers.iter().all(is_known) {
        return Err(wrong_header());
    }
    let mut rows = Vec::new();
    for record in reader.into_records() {
        // What is in a file that is not a catalogue is not told.
        let wrong = |line: u64| CatalogueFault::Row {
            file: file.to_owned(),
            line,
            columns,
        };
        let record = record.map_err(|error| wrong(error.position().map_or(1, |position| position.line())))?;
        let line = record.position().map_or(1, |position| position.line());
        let row: Item = record.deserialize(Some(&headers)).map_err(|_| wrong(line))?;
        if let Some(fault) = wrong_name(row.name()) {
            let file = file.to_owned();
            return Err(CatalogueFault::Name { file, line, fault });
        }
        rows.push(row);
    }
    Ok(rows)
}

/// Reads the catalogue in a file that a study names.
fn read_rows<Item: CatalogueItem>(folder: &Path, name: &str, scope: FileScope) -> Result<Vec<Item>, CatalogueFault> {
    let unreadable = |cause| {
        let known: Vec<String> = Item::BUILTIN
            .iter()
            .map(|builtin| format!("\"{}\"", builtin.name))
            .collect();
        CatalogueFault::Read {
            cause,
            known: known.join(", "),
        }
    };
    let path = folder.join(name);
    if scope == FileScope::BesideStudy {
        // A link may lead out of the folder.
        let [folder, file] = [or_here(folder), &path].map(|path| path.canonicalize().map_err(unreadable));
        if !file?.starts_with(folder?) {
            return Err(CatalogueFault::Outside);
        }
    }
    let text = read_regular(&path, LARGEST_CATALOGUE).map_err(unreadable)?;
    let text = String::from_utf8(text).map_err(|_| CatalogueFault::Encoding(name.to_owned()))?;
    rows(&text, name)
}
