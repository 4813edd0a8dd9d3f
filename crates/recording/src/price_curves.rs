//! Prices along a front as curves.

use rerun::TimeColumn;

use super::writer::{RecordingError, RecordingWriter};
use super::{paths, timelines};
use kinefront_model::mechanism::Architecture;
use kinefront_scene::palette;
use kinefront_study::{DriversAlong, ParameterKind};

/// Least price that has a curve \[% for 1 %\], at a tenth of the designs.
const DRAWN: f64 = 0.02;

/// Curves that stand in one view: their name in the path, the title of the view, and what their parameters are part of.
pub(super) const VIEWS: [(&str, &str, &[ParameterKind]); 2] = [
    ("limits", "Prices of the limits", &[ParameterKind::Limit]),
    (
        "others",
        "Prices of the region, the travels and the bounds",
        &[ParameterKind::Region, ParameterKind::Travel, ParameterKind::Bound],
    ),
];

/// Returns the path of the curves of a view.
pub(super) fn view_path(architecture: Architecture, view: &str) -> String {
    format!("{}/{architecture}/{view}", paths::PRICES)
}

/// Records the prices of the designs of one architecture at their steps.
pub(super) fn record_curves(
    writer: &RecordingWriter,
    along: &DriversAlong,
    steps: &[i64],
) -> Result<(), RecordingError> {
    for (view, _, kinds) in VIEWS {
        let drawn = along.curves(kinds).into_iter().filter(|curve| curve.is_usual(DRAWN));
        for (curve, color) in drawn.zip(palette::SERIES.into_iter().cycle()) {
            let entity = format!("{}/{}", view_path(along.architecture, view), curve.parameter);
            let name = format!("{} [% for 1 %]", curve.label);
            let times = TimeColumn::new_sequence(timelines::FRONT, steps.iter().copied());
            let prices = curve.points.iter().map(|[_, price]| *price);
            writer.curve(&entity, name, color, times, prices)?;
        }
    }
    Ok(())
}
