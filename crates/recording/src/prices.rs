//! Records what drives the first objective along a front: the prices as curves, with each design beside them.

use std::path::Path;

use rerun::{Scalars, SeriesLines, TimeColumn};

use super::colors::rgb;
use super::design::{record_step, write_new};
use super::writer::{ALWAYS, RecordingError, RecordingWriter};
use super::{blueprint, paths, timelines};
use kinefront_model::evaluation::Evaluation;
use kinefront_model::mechanism::Architecture;
use kinefront_scene::palette;
use kinefront_study::{DriversAlong, ParameterKind, PreparedStudy};

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

/// Records the prices of the designs of a front to a file. `ids` are those of the designs, and `along` holds their prices.
///
/// The timeline `front` counts the designs that have prices in the order of the quantity along the front.
///
/// # Errors
/// [`RecordingError::Write`] when the file exists or cannot be written; [`RecordingError::Encode`] otherwise.
pub fn record_prices(
    path: &Path,
    study: &PreparedStudy,
    evaluations: &[Evaluation],
    ids: &[usize],
    along: &[DriversAlong],
) -> Result<(), RecordingError> {
    write_new(path, |part| {
        let writer = RecordingWriter::create(part, &format!("prices of {}", study.study().name))?;
        let fronts: Vec<&DriversAlong> = along.iter().filter(|along| !along.designs.is_empty()).collect();
        let architectures: Vec<Architecture> = fronts.iter().map(|along| along.architecture).collect();
        let extent = evaluations.iter().map(|evaluation| evaluation.design.base_radius());
        let extent = extent.fold(0.0, f64::max);
        blueprint::send_prices_layout(writer.stream(), &architectures, extent)?;
        writer.text(paths::SUMMARY, ALWAYS, &sentences(along))?;
        let order = order(&fronts);
        for (number, front) in fronts.iter().enumerate() {
            let steps = order.iter().zip(0_i64..).filter(|((of, _), _)| *of == number);
            let steps: Vec<i64> = steps.map(|(_, step)| step).collect();
            curves(&writer, front, &steps)?;
        }
        for (step, &(front, place)) in order.iter().enumerate() {
            let (index, _, drivers) = &fronts[front].designs[place];
            let Some(evaluation) = evaluations.get(*index) else {
                continue;
            };
            let id = ids.get(*index).copied().unwrap_or(*index);
            let heading = format!("#{id}, design {} of {} with prices", step + 1, order.len());
            record_step(
                &writer,
                &[(timelines::FRONT, step)],
                study.model(),
                evaluation,
                None,
                Some(drivers),
                &heading,
            )?;
            writer.check()?;
        }
        writer.close()
    })
}

/// Returns the designs of all fronts in the order of the quantity along them, each as the indices of its front and of its place there.
fn order(fronts: &[&DriversAlong]) -> Vec<(usize, usize)> {
    let places = |(front, along): (usize, &&DriversAlong)| {
        let designs = along.designs.iter().enumerate();
        let places: Vec<_> = designs.map(|(place, (_, at, _))| (*at, (front, place))).collect();
        places
    };
    let mut order: Vec<(f64, (usize, usize))> = fronts.iter().enumerate().flat_map(places).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    order.into_iter().map(|(_, place)| place).collect()
}

/// Records the prices of the designs of one architecture at their steps.
fn curves(writer: &RecordingWriter, along: &DriversAlong, steps: &[i64]) -> Result<(), RecordingError> {
    for (view, _, kinds) in VIEWS {
        let drawn = along.curves(kinds).into_iter().filter(|curve| curve.is_usual(DRAWN));
        for (curve, color) in drawn.zip(palette::SERIES.into_iter().cycle()) {
            let entity = format!("{}/{}", view_path(along.architecture, view), curve.parameter);
            let line = SeriesLines::new()
                .with_names([format!("{} [% for 1 %]", curve.label)])
                .with_colors([rgb(color)]);
            writer.row(&entity, ALWAYS, &line)?;
            let prices = Scalars::new(curve.points.iter().map(|[_, price]| *price)).columns_of_unit_batches();
            writer.stream().send_columns(
                entity,
                [TimeColumn::new_sequence(timelines::FRONT, steps.iter().copied())],
                prices.map_err(RecordingError::encode)?,
            )?;
        }
    }
    Ok(())
}

/// Returns what drives the objective along each front, as markdown.
fn sentences(along: &[DriversAlong]) -> String {
    let of = |along: &DriversAlong| {
        let sentences: String = along
            .sentences()
            .iter()
            .map(|sentence| format!("- {sentence}\n"))
            .collect();
        format!("## {}\n\n{sentences}\n", along.architecture)
    };
    format!(
        "# What drives the front\n\nA price is the change of the first objective in % for 1 % more of a requirement.\n\n{}",
        along.iter().map(of).collect::<String>()
    )
}
