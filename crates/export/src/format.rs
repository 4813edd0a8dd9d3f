//! The file formats.

use std::fmt;

use super::prepared::{MASSLESS, Prepared};
use kinefront_model::spatial::LEGS;

/// An error of a library that writes a format, whose message is shown with the name of what could not be written.
pub(super) type AnyError = Box<dyn std::error::Error + Send + Sync>;

/// A file format; each is declared in the file that writes it.
#[derive(Clone, Copy)]
pub struct Format {
    pub(super) key: &'static str,
    pub(super) file: &'static str,
    pub(super) name: &'static str,
    pub(super) title: &'static str,
    pub(super) lost: Option<&'static str>,
    pub(super) contents: Contents,
    pub(super) write: fn(&Prepared) -> Result<Vec<u8>, AnyError>,
}

/// What a file contains.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Contents {
    /// Numbers as bytes.
    Binary,
    /// Text.
    Text,
    /// Text for a simulator, which requires masses and shapes of all bodies.
    Simulator {
        /// Whether joint values count from the exported pose.
        joints_from_zero: bool,
    },
}

impl fmt::Debug for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

impl PartialEq for Format {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

impl Eq for Format {}

impl Format {
    /// Returns the format with a short name.
    pub fn find(key: &str) -> Option<Format> {
        Self::ALL.iter().copied().find(|format| format.key == key)
    }

    /// Returns the short name, as in arguments.
    pub fn key(&self) -> &'static str {
        self.key
    }

    /// Returns a default file name.
    pub fn file(&self) -> &'static str {
        self.file
    }

    /// Returns the file name extension.
    pub fn extension(&self) -> &'static str {
        self.file.rsplit('.').next().unwrap_or_default()
    }

    /// Returns whether the format is a text.
    pub fn is_text(&self) -> bool {
        self.contents != Contents::Binary
    }

    /// Returns the display name.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Returns the display name with the intended use.
    pub fn title(&self) -> &'static str {
        self.title
    }

    /// Returns a text that lists what the format omits of a design's mechanics; `None` if it omits nothing.
    pub fn lost(&self) -> Option<&'static str> {
        self.lost
    }

    /// Returns the comment at the head of every simulator file.
    pub(super) fn preamble(&self, subject: &Prepared) -> String {
        let mut words = format!(
            "{}\nWritten by Kinefront {}. Lengths in m, angles in rad, masses in kg; base frame, z out of the plane of motion.\n\
             Masses are those of the cross-sections of the study with a density of {} kg/m^3; bodies without mass in the model are given \
             {MASSLESS} kg.",
            subject.title(),
            env!("CARGO_PKG_VERSION"),
            subject.model.settings().material.density,
        );
        let counted = subject.model.settings().platform_bars;
        if counted as usize != LEGS {
            words +=
                &format!(" The study counts {counted} of the three platform bars; their masses are scaled to match.");
        }
        let payload = subject.model.settings().dynamics.payload.mass;
        if payload > 0.0 {
            words += &format!(" The platform carries the payload of {payload} kg.");
        }
        if matches!(self.contents, Contents::Simulator { joints_from_zero: true }) {
            words += "\nJoint values are relative to the exported pose, at which they are 0.";
        }
        if let Some(lost) = self.lost {
            words += "\nNot in this file: ";
            words += lost;
            words.push('.');
        }
        words
    }
}
