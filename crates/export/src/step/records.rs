//! The numbered records of a file, with points, directions and placements, and how numbers and texts are written.

use std::fmt::Write as _;

use glam::{DVec2, DVec3};

/// A right-handed frame: its origin \[mm\], its z axis and its x axis.
#[derive(Clone, Copy)]
pub(super) struct Placement {
    pub(super) origin: DVec3,
    pub(super) z: DVec3,
    pub(super) x: DVec3,
}

impl Placement {
    pub(super) const ORIGIN: Self = Self::at(DVec3::ZERO, DVec3::Z, DVec3::X);

    pub(super) const fn at(origin: DVec3, z: DVec3, x: DVec3) -> Self {
        Self { origin, z, x }
    }

    /// Returns the point at coordinates across the z axis.
    pub(super) fn point(&self, at: DVec2, along: f64) -> DVec3 {
        self.origin + self.x * at.x + self.z.cross(self.x) * at.y + self.z * along
    }
}

/// The records so far; a record is named by its number.
#[derive(Default)]
pub(super) struct File {
    records: Vec<String>,
}

impl File {
    pub(super) fn add(&mut self, record: impl Into<String>) -> usize {
        self.records.push(record.into());
        self.records.len()
    }

    pub(super) fn point(&mut self, at: DVec3) -> usize {
        self.add(format!("CARTESIAN_POINT('',({}))", coordinates(at)))
    }

    pub(super) fn direction(&mut self, along: DVec3) -> usize {
        self.add(format!("DIRECTION('',({}))", coordinates(along)))
    }

    pub(super) fn placement(&mut self, place: &Placement) -> usize {
        let (at, z, x) = (
            self.point(place.origin),
            self.direction(place.z),
            self.direction(place.x),
        );
        self.add(format!("AXIS2_PLACEMENT_3D('',#{at},#{z},#{x})"))
    }

    /// Returns the file with a description. It has no date, so that the same design gives the same file.
    pub(super) fn document(&self, description: &str, name: &str) -> String {
        let lines: Vec<String> = description.lines().map(string).collect();
        let mut text = format!(
            "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(({}),'2;1');\n\
             FILE_NAME({},'1970-01-01T00:00:00',(''),(''),'Kinefront {}','Kinefront','');\n\
             FILE_SCHEMA(('AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF {{ 1 0 10303 442 3 1 4 }}'));\nENDSEC;\nDATA;\n",
            lines.join(","),
            string(name),
            env!("CARGO_PKG_VERSION")
        );
        for (place, record) in self.records.iter().enumerate() {
            let _ = writeln!(text, "#{}={record};", place + 1);
        }
        text + "ENDSEC;\nEND-ISO-10303-21;\n"
    }
}

/// Writes record numbers: `#1,#2`.
pub(super) fn list(records: &[usize]) -> String {
    let records: Vec<String> = records.iter().map(|record| format!("#{record}")).collect();
    records.join(",")
}

pub(super) fn truth(value: bool) -> &'static str {
    if value { ".T." } else { ".F." }
}

fn coordinates(at: DVec3) -> String {
    at.to_array().map(real).join(",")
}

/// Writes a number with the decimal point that the format requires.
pub(super) fn real(value: f64) -> String {
    let text = crate::prepared::text(value);
    if text.contains('.') { text } else { format!("{text}.") }
}

/// Writes a text: apostrophes and backslashes are doubled, and what is not ASCII is written by its code.
pub(super) fn string(text: &str) -> String {
    let mut written = "'".to_owned();
    for letter in text.chars() {
        match letter {
            '\'' => written += "''",
            '\\' => written += "\\\\",
            ' '..='~' => written.push(letter),
            _ => {
                let code = u32::from(letter);
                let _ = match code {
                    0..=0xFFFF => write!(written, "\\X2\\{code:04X}\\X0\\"),
                    _ => write!(written, "\\X4\\{code:08X}\\X0\\"),
                };
            }
        }
    }
    written + "'"
}
