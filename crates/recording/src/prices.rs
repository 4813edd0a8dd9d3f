//! Records what drives the first objective along a front: the prices as curves, with each design beside them.

use std::path::Path;

use super::design::{record_step, write_new};
use super::price_curves::record_curves;
use super::writer::{ALWAYS, RecordingError, RecordingWriter};
use super::{blueprint, paths, timelines};
use kinefront_model::evaluation::{Evaluation, Model};
use kinefront_model::mechanism::Architecture;
use kinefront_study::DriversAlong;

/// Records the prices of the designs of a front to a file. `name` is that of the study, `ids` are those of the designs, and `along` holds their prices.
///
/// The timeline `front` counts the designs that have prices in the order of the quantity along the front.
///
/// # Errors
/// [`RecordingError::Write`] when the file exists or cannot be written; [`RecordingError::Encode`] otherwise.
pub fn record_prices(
    path: &Path,
    name: &str,
    model: &Model,
    evaluations: &[Evaluation],
    ids: &[usize],
    along: &[DriversAlong],
) -> Result<(), RecordingError> {
    write_new(path, |part| {
        let writer = RecordingWriter::create(part, &format!("prices of {name}"))?;
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
            record_curves(&writer, front, &steps)?;
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
                model,
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
