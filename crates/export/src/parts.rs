//! The parts of a design as a table: what has to be ordered and cut.

use super::format::{AnyError, Contents, Format};
use super::prepared::Prepared;
use kinefront_model::evaluation::{CutBar, Part};

pub(super) const FORMAT: Format = Format {
    key: "csv-parts",
    file: "parts.csv",
    name: "the list of parts",
    title: "CSV, parts to order and cut",
    lost: Some("the assembly; the file lists bars, joints and motors; lengths of bars are those between the joints"),
    contents: Contents::Text,
    write,
};

/// Millimetres per metre.
const MM: f64 = 1e3;

const HEADINGS: [&str; 10] = [
    "part",
    "section",
    "shape",
    "outer_mm",
    "wall_mm",
    "length_mm",
    "pieces",
    "mass_kg",
    "total_kg",
    "counts",
];

fn write(subject: &Prepared) -> Result<Vec<u8>, AnyError> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(HEADINGS)?;
    for part in subject
        .model
        .parts(&subject.evaluation.design, subject.evaluation.drive)
    {
        writer.write_record(record(&part))?;
    }
    Ok(writer.into_inner()?)
}

fn record(part: &Part) -> [String; HEADINGS.len()] {
    let bar = part.bar.as_ref();
    let text = |of: &dyn Fn(&CutBar) -> String| bar.map(of).unwrap_or_default();
    let micrometres = |length: f64| format!("{:.3}", MM * length);
    // Without the rounding of a sum.
    let nanokilograms = |mass: f64| ((1e9 * mass).round() / 1e9).to_string();
    [
        part.name.to_owned(),
        section_name(part).unwrap_or_default(),
        text(&|bar| shape(bar).to_owned()),
        text(&|bar| micrometres(2.0 * bar.radius)),
        text(&|bar| micrometres(wall(bar))),
        text(&|bar| micrometres(bar.length)),
        part.pieces.to_string(),
        nanokilograms(part.mass),
        nanokilograms(part.total_mass()),
        part.counts.to_string(),
    ]
}

/// Returns the name under which a part is ordered, if it has one: that of a bar of a catalogue, or of a drive.
pub(super) fn section_name(part: &Part) -> Option<String> {
    let of_bar = || part.bar.as_ref()?.catalogue_name().map(str::to_owned);
    part.drive.clone().or_else(of_bar)
}

/// Returns the section of a bar in words, in millimetres, without characters that drawings lack: `tube 33.7 x 3.2`.
pub(super) fn outline(bar: &CutBar) -> String {
    let outer = format!("{:.1}", 2.0 * MM * bar.radius);
    match shape(bar) {
        "round" => format!("round {outer}"),
        shape => format!("{shape} {outer} x {:.1}", MM * wall(bar)),
    }
}

fn wall(bar: &CutBar) -> f64 {
    bar.radius - bar.section.inner_radius(bar.radius)
}

fn shape(bar: &CutBar) -> &'static str {
    match (bar.section.is_square(), wall(bar) < bar.radius) {
        (true, _) => "square tube",
        (false, true) => "tube",
        (false, false) => "round",
    }
}
