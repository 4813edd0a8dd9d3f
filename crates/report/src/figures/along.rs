//! Charts of what changes along a front: prices, design variables, and active constraints.

use super::{GREY, color, values};
use crate::Report;
use crate::chart::{Chart, ChartAxis, Mark, Series, extremes};
use crate::fits::Trend;
use crate::fronts::Front;
use kinefront_model::evaluation::{Constraint, Thresholds};
use kinefront_model::mechanism::{Architecture, DesignVariable};
use kinefront_scene::palette;
use kinefront_study::{Column, DriversAlong, ParameterKind, PriceCurve, stacked, usual_range};

/// Least price that a figure shows \[% for 1 %\].
const SHOWN: f64 = 0.02;

/// Creates a chart of the prices of the limits along a front, each area on top of those of the others, or of those of the region, the
/// travels and the bounds, as lines.
pub(super) fn prices(along: &DriversAlong, kinds: &[ParameterKind], mark: Mark) -> Chart {
    let mut curves = along.curves(kinds);
    curves.retain(|curve| curve.is_usual(SHOWN));
    if mark == Mark::Area {
        curves = stacked(&curves);
    }
    let [low, high] = usual_range(&curves);
    let is_beyond = |curve: &PriceCurve, place: usize| !(low..=high).contains(&curve.points[place][1]);
    let beyond = (0..along.designs.len()).filter(|place| curves.iter().any(|curve| is_beyond(curve, *place)));
    let beyond = beyond.count();
    let coloured = curves.into_iter().zip(palette::SERIES.into_iter().cycle());
    let mut series: Vec<Series> = coloured
        .map(|(curve, color)| {
            let points = curve.points.iter().map(|[at, price]| [*at, price.clamp(low, high)]);
            Series::new(curve.label, color, mark, points.collect())
        })
        .collect();
    // The highest area is drawn first, so that the lower ones cover it.
    series.reverse();
    series.extend(along.crossings.iter().enumerate().map(|(index, crossing)| {
        let name = if index == 0 { "change of architecture" } else { "" };
        Series::new(
            name,
            GREY,
            Mark::ThinLine,
            vec![[crossing.at, low], [crossing.at, high]],
        )
    }));
    let x = ChartAxis::about(Column::Quantity(along.along).title(), values(&series, 0));
    let y = ChartAxis::linear("price [% for 1 %]", [low, high]);
    Chart {
        beyond,
        ..Chart::new(x, y, series)
    }
}

/// Creates a chart of design variables over the objective by which designs are compared, with straight lines, and a parabola for `r_p`.
pub(super) fn variables(report: &Report, trends: &[&Trend]) -> Chart {
    let values = |axis: usize| {
        let points = trends.iter().flat_map(|trend| &trend.points);
        points.map(move |point| point[axis])
    };
    let x = ChartAxis::from_zero_if_near(report.question.label(report.question.compared()), values(0));
    let y = ChartAxis::from_zero("design variable [m]", values(1));
    let mut series = Vec::new();
    for (trend, color) in trends.iter().zip(palette::SERIES) {
        let points = trend.points.clone();
        series.push(Series::new(trend.variable.symbol(), color, Mark::Dots, points));
        let fit = if trend.variable == DesignVariable::PlatformBarRadius {
            &trend.quadratic
        } else {
            &trend.linear
        };
        if let Some(fit) = fit {
            let [low, high] = extremes(trend.free.iter().map(|point| point[0]));
            let at = (0..=60).map(|k| low + (high - low) * f64::from(k) / 60.0);
            let points = at.map(|place| [place, fit.at(place)]).collect();
            series.push(Series::new("", color, Mark::ThinLine, points));
        }
    }
    Chart::new(x, y, series)
}

/// Creates a chart of the active constraints of each design over the objective by which designs are compared.
pub(super) fn active(report: &Report, architecture: Architecture, front: &Front) -> Chart {
    let question = &report.question;
    let axis = question.compared();
    let thresholds: &Thresholds = &report.model.settings().thresholds;
    let required: Vec<Constraint> = Constraint::required(thresholds).collect();
    let row = |constraint: Constraint| required.iter().position(|other| *other == constraint);
    let points: Vec<[f64; 2]> = front
        .shown()
        .flat_map(|member| {
            let at = question.value(axis, member);
            member.active().filter_map(row).map(move |row| [at, row as f64])
        })
        .collect();
    let names: Vec<String> = required
        .iter()
        .map(|constraint| format!("{} {}", constraint.id(), constraint.name().replace('_', " ")))
        .collect();
    let places = front.shown().map(|member| question.value(axis, member));
    let x = ChartAxis::from_zero_if_near(question.label(axis), places);
    let y = ChartAxis::linear("", [-0.5, names.len() as f64 - 0.5]);
    let series = vec![Series::new("", color(architecture), Mark::Dots, points)];
    Chart {
        names: Some(names),
        legend_above: false,
        ..Chart::new(x, y, series)
    }
}
