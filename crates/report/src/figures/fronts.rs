//! Charts of fronts: of architectures, beside reference designs, and of variations of the study.

use super::{GREY, color, values};
use crate::chart::{Chart, ChartAxis, Mark, Series};
use crate::fronts::Front;
use crate::{ClearanceCost, Report};
use kinefront_model::evaluation::{Evaluation, Scale};
use kinefront_model::mechanism::Architecture;
use kinefront_scene::palette;
use kinefront_scene::text::short;

/// Colours of the values that the source of a reference design states, and of those that this model computes.
const STATED: [u8; 3] = [200, 40, 40];
const MODELLED: [u8; 3] = [20, 20, 20];
/// Colour of the study as it is stated, among its variations.
const BLACK: [u8; 3] = [0, 0, 0];

/// Returns the first two objectives of a design.
fn place(report: &Report, member: &Evaluation) -> [f64; 2] {
    [0, 1].map(|k| report.question.value(k, member))
}

fn points(report: &Report, front: &Front) -> Vec<[f64; 2]> {
    front.shown().map(|member| place(report, member)).collect()
}

/// Returns the reference designs of one architecture or of all: a series of the stated values, a series of the values
/// computed by this model, and the names beside the latter.
fn references(report: &Report, of: Option<Architecture>) -> (Vec<Series>, Vec<([f64; 2], String)>) {
    let of = |architecture: Architecture| of.is_none_or(|of| of == architecture);
    let found: Vec<_> = report
        .references
        .iter()
        .filter(|reference| of(reference.fine.design.architecture()))
        .collect();
    let [x, y] = [0, 1].map(|k| report.question.objectives[k].quantity);
    let stated: Vec<[f64; 2]> = found
        .iter()
        .filter_map(|reference| Some([reference.stated(x)?, reference.stated(y)?]))
        .collect();
    let modelled: Vec<[f64; 2]> = found.iter().map(|reference| place(report, &reference.fine)).collect();
    let notes = found
        .iter()
        .zip(&modelled)
        .map(|(reference, &at)| (at, reference.stated.name.clone()))
        .collect();
    let mut all = vec![
        Series::new("reference designs, stated", STATED, Mark::Rings, stated),
        Series::new("reference designs, this model", MODELLED, Mark::Crosses, modelled),
    ];
    all.retain(|series| !series.points.is_empty());
    (all, notes)
}

/// Creates a chart of fronts; with `decades`, over a logarithmic axis of the first objective. Otherwise this axis ends near the
/// reference point of the hypervolume if fewer than a quarter of the designs of the first `own` series lie beyond: at the end of a front
/// a millimetre of workspace may cost tons, which would compress the rest.
fn front_chart(
    report: &Report,
    own: usize,
    series: Vec<Series>,
    notes: Vec<([f64; 2], String)>,
    decades: bool,
) -> Chart {
    let question = &report.question;
    let (x, mut beyond) = (question.label(0), 0);
    let x = if decades {
        ChartAxis::decades(x, values(&series, 0))
    } else {
        let most = question.objectives[0].value(question.reference[0]);
        let costs = || values(&series[..own], 0);
        let is_cut = most > 0.0 && 4 * costs().filter(|&cost| cost > most).count() < costs().count();
        let shown = values(&series, 0).map(|cost| if is_cut { cost.min(most) } else { cost });
        let axis = ChartAxis::from_zero_if_near(x, shown);
        beyond = costs().filter(|&cost| cost > axis.range[1]).count();
        axis
    };
    let y = ChartAxis::from_zero_if_near(question.label(1), values(&series, 1));
    Chart {
        notes,
        beyond,
        // Fronts rise at the left end of a linear axis but at the right end of a logarithmic one.
        legend_above: decades,
        ..Chart::new(x, y, series)
    }
}

fn line(report: &Report, name: &str, color: [u8; 3], front: &Front) -> Series {
    Series::new(name, color, Mark::DottedLine, points(report, front))
}

pub(super) fn alone(report: &Report, architecture: Architecture, front: &Front) -> Chart {
    let mut series = vec![line(report, architecture.name(), color(architecture), front)];
    if let Some(moga2) = report.moga2.as_ref().and_then(|moga2| moga2.of(architecture)) {
        let name = "MOGA-II (reimplementation), one architecture";
        series.push(line(report, name, GREY, moga2));
    }
    let (references, notes) = references(report, Some(architecture));
    series.extend(references);
    front_chart(report, 1, series, notes, false)
}

pub(super) fn together(report: &Report, decades: bool) -> Chart {
    let alone = report.fronts.alone.iter();
    let mut series: Vec<Series> = alone
        .map(|(architecture, front)| line(report, architecture.name(), color(*architecture), front))
        .collect();
    let own = series.len();
    let (references, notes) = references(report, None);
    series.extend(references);
    front_chart(report, own, series, notes, decades)
}

/// Creates the chart of the front of all architectures, beside that of MOGA-II (reimplementation).
pub(super) fn joint(report: &Report) -> Chart {
    let front = &report.fronts.together;
    let of = |architecture: Architecture| {
        let members = front
            .shown()
            .filter(move |member| member.design.architecture() == architecture);
        members.map(|member| place(report, member)).collect()
    };
    let series =
        report.fronts.alone.iter().map(|&(architecture, _)| {
            Series::new(architecture.name(), color(architecture), Mark::Dots, of(architecture))
        });
    let mut series: Vec<Series> = series.filter(|series| !series.points.is_empty()).collect();
    let own = series.len();
    if let Some(moga2) = report.moga2.as_ref().and_then(|moga2| moga2.joint.as_ref()) {
        let name = "MOGA-II (reimplementation), all architectures";
        series.push(line(report, name, GREY, moga2));
    }
    let (references, notes) = references(report, None);
    series.extend(references);
    front_chart(report, own, series, notes, false)
}

/// Creates a chart of the fronts of an architecture with and without a required clearance.
pub(super) fn clearance(report: &Report, cost: &ClearanceCost<'_>, architecture: Architecture) -> Chart {
    let names = [
        (cost.without, "members may collide".to_owned(), GREY, Mark::ThinLine),
        (
            cost.with,
            format!("{} mm clearance", short(1e3 * cost.clearance)),
            color(architecture),
            Mark::Line,
        ),
    ];
    let series = names.into_iter().filter_map(|(variation, name, color, mark)| {
        Some(Series::new(
            name,
            color,
            mark,
            points(report, variation.of(architecture)?),
        ))
    });
    variations_chart(report, series.collect())
}

/// Creates a chart of the fronts of an architecture under every alternative assumption.
pub(super) fn sensitivity(report: &Report, architecture: Architecture) -> Chart {
    let mut chance = false;
    let series = report
        .variations
        .iter()
        .zip(std::iter::once(&BLACK).chain(&palette::SERIES).cycle())
        .filter_map(|(variation, &color)| {
            // All variations of the random seed share one legend entry.
            let name = match (variation.is_chance(), chance) {
                (true, true) => String::new(),
                (true, false) => "other random seeds".to_owned(),
                (false, _) => variation.name().to_owned(),
            };
            chance |= variation.is_chance();
            let color = if variation.is_chance() { GREY } else { color };
            let mark = variation.alternative.map_or(Mark::Line, |_| Mark::ThinLine);
            Some(Series::new(
                name,
                color,
                mark,
                points(report, variation.of(architecture)?),
            ))
        });
    variations_chart(report, series.collect())
}

fn variations_chart(report: &Report, series: Vec<Series>) -> Chart {
    let decades = report.question.objectives[0].quantity.entry().scale == Scale::Logarithmic;
    let own = series.len();
    front_chart(report, own, series, Vec::new(), decades)
}
