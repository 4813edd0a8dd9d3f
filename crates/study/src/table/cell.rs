//! The values of the columns of a table.

use std::borrow::Cow;
use std::fmt;

use super::{Column, TableRow};
use crate::Catalogues;
use kinefront_model::evaluation::Constraint;

/// One value of a row.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// There is no value; an empty text in CSV.
    Missing,
    /// A whole number.
    Integer(u64),
    /// A floating-point number, written as the shortest text that parses to the same number.
    Number(f64),
    /// True or false.
    Flag(bool),
    /// A text.
    Text(Cow<'static, str>),
}

impl From<Option<f64>> for Cell {
    fn from(number: Option<f64>) -> Self {
        number.map_or(Cell::Missing, Cell::Number)
    }
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Cell::Missing => Ok(()),
            Cell::Integer(number) => number.fmt(f),
            Cell::Number(number) => number.fmt(f),
            Cell::Flag(flag) => flag.fmt(f),
            Cell::Text(text) => text.fmt(f),
        }
    }
}

impl Column {
    /// The value of an entry of a front, whose design is marked with `mark` and selected from catalogues.
    pub fn cell_of_front(self, entry: &TableRow, mark: &str, catalogues: &Catalogues) -> Cell {
        let name = match self {
            Self::Mark => Some(mark),
            column => column.selected_of(catalogues, &entry.row.design, entry.drive),
        };
        name.map_or_else(|| self.cell(entry), |name| Cell::Text(name.to_owned().into()))
    }

    /// The value of an entry. Missing for the columns that only some tables have: whoever writes such a table adds the
    /// cells itself.
    pub fn cell(self, entry: &TableRow) -> Cell {
        let row = &entry.row;
        match self {
            Self::Id => Cell::Integer(entry.id as u64),
            Self::Generation => Cell::Integer(u64::from(row.generation)),
            Self::Architecture => Cell::Text(row.design.architecture().name().into()),
            Self::WorkingMode => Cell::Text(row.design.working_mode().to_string().into()),
            Self::Feasible => Cell::Flag(row.is_feasible()),
            Self::Active => {
                let active: Vec<&str> = row.active.iter().map(Constraint::id).collect();
                Cell::Text(active.join("+").into())
            }
            Self::ReferenceRadius => entry.reference_radius.into(),
            Self::CertifiedLower => entry.certified.map(|certified| certified.lower).into(),
            Self::CertifiedUpper => entry.certified.and_then(|certified| certified.upper).into(),
            Self::Certificate => match entry.certified {
                Some(certified) => Cell::Text(certified.state().into()),
                None => Cell::Missing,
            },
            Self::Mark
            | Self::LegSection
            | Self::PlatformSection
            | Self::Drive
            | Self::OnJointFront
            | Self::Verified
            | Self::Starred
            | Self::Note => Cell::Missing,
            _ => row.number(self).into(),
        }
    }
}
