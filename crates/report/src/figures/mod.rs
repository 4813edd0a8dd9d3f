//! Figures of a report: charts of fronts (`fronts`) and of what changes along them (`along`).

mod along;
mod fronts;

use super::chart::{Chart, ChartAxis, Mark, Series};
use super::fits::Trend;
use super::{ClearanceCost, Figure, Report, ReportError, Topic, slug};
use kinefront_model::evaluation::Scale;
use kinefront_model::mechanism::Architecture;
use kinefront_scene::palette;
use kinefront_study::ParameterKind;

/// Colour of MOGA-II (reimplementation), and of what is beside the matter of a chart.
const GREY: [u8; 3] = [150, 150, 150];

/// Draws all figures in the order of the page.
pub(super) fn all(report: &Report) -> Result<Vec<Figure>, ReportError> {
    let mut figures = Figures::default();
    match report.question.objectives.len() {
        1 => figures.progress(report)?,
        2 => figures.fronts(report)?,
        _ => figures.pairs(report)?,
    }
    figures.along_fronts(report)?;
    figures.drivers(report)?;
    let alone = || report.fronts.alone.iter().map(|(architecture, _)| *architecture);
    if let Some(cost) = ClearanceCost::of(&report.study, &report.variations) {
        for architecture in alone() {
            let words = format!("Fronts of the {architecture} without and with a required clearance between members");
            let name = format!("clearance-{}", slug(architecture.name()));
            figures.add(
                Topic::Clearance,
                name,
                words,
                fronts::clearance(report, &cost, architecture),
            )?;
        }
    }
    for architecture in alone().filter(|_| !report.variations.is_empty()) {
        let words = format!("Fronts of the {architecture} under alternative assumptions");
        let name = format!("sensitivity-{}", slug(architecture.name()));
        figures.add(
            Topic::Sensitivity,
            name,
            words,
            fronts::sensitivity(report, architecture),
        )?;
    }
    Ok(figures.0)
}

/// The figures that were drawn.
#[derive(Default)]
pub(super) struct Figures(pub(super) Vec<Figure>);

impl Figures {
    /// Draws a chart and adds it.
    pub(super) fn add(
        &mut self,
        topic: Topic,
        name: impl Into<String>,
        words: impl std::fmt::Display,
        chart: Chart,
    ) -> Result<(), ReportError> {
        let name = name.into();
        let svg = chart.svg().map_err(ReportError::of(&name))?;
        let beyond = match chart.beyond {
            0 => String::new(),
            count => format!(" Designs outside the range of the axes: {count}."),
        };
        let caption = format!("{words}.{beyond}");
        self.0.push(Figure {
            topic,
            name,
            caption,
            svg,
        });
        Ok(())
    }

    /// The best value of the only objective over the evaluations of each search.
    fn progress(&mut self, report: &Report) -> Result<(), ReportError> {
        let question = &report.question;
        let series = question.progress.iter().zip(palette::SERIES.into_iter().cycle());
        let is_named = question.progress.len() > 1;
        let series: Vec<Series> = series
            .map(|((name, points), color)| {
                let name = if is_named { name.as_str() } else { "" };
                Series::new(name, color, Mark::Line, points.clone())
            })
            .collect();
        let x = ChartAxis::from_zero("evaluations", values(&series, 0));
        let y = ChartAxis::about(question.label(0), values(&series, 1));
        let words = format!(
            "{} of the best design against the number of evaluations",
            question.label(0)
        );
        let chart = Chart {
            legend_above: false,
            ..Chart::new(x, y, series)
        };
        self.add(Topic::Fronts, "front-progress", words, chart)
    }

    /// The fronts of two objectives.
    fn fronts(&mut self, report: &Report) -> Result<(), ReportError> {
        let words = "Pareto fronts of the architectures";
        self.add(Topic::Fronts, "fronts", words, fronts::together(report, false))?;
        if report.question.objectives[0].quantity.entry().scale == Scale::Logarithmic {
            let words = format!(
                "The same fronts with a logarithmic axis of the {}, which separates its small values",
                report.question.name(0)
            );
            self.add(Topic::Fronts, "fronts-log", words, fronts::together(report, true))?;
        }
        if report.fronts.alone.len() > 1 {
            let words = "Pareto front of all architectures together, coloured by the architecture of each design";
            self.add(Topic::Fronts, "front-together", words, fronts::joint(report))?;
        }
        for (architecture, front) in &report.fronts.alone {
            let name = format!("front-{}", slug(architecture.name()));
            let words = format!("Pareto front of the {architecture}");
            self.add(Topic::Fronts, name, words, fronts::alone(report, *architecture, front))?;
        }
        Ok(())
    }

    /// The fronts over each pair of more objectives.
    fn pairs(&mut self, report: &Report) -> Result<(), ReportError> {
        let question = &report.question;
        let count = question.objectives.len();
        for [x, y] in (0..count).flat_map(|x| (x + 1..count).map(move |y| [x, y])) {
            let series = report.fronts.alone.iter().map(|(architecture, front)| {
                let points = front
                    .shown()
                    .map(|member| [x, y].map(|axis| question.value(axis, member)));
                Series::new(architecture.name(), color(*architecture), Mark::Dots, points.collect())
            });
            let series: Vec<Series> = series.collect();
            let axis = |axis: usize, place: usize| ChartAxis::about(question.label(axis), values(&series, place));
            let (horizontal, vertical) = (axis(x, 0), axis(y, 1));
            let [a, b] = [x, y].map(|k| question.objectives[k].quantity.entry());
            let name = format!("front-{}-{}", a.key, b.key).replace('_', "-");
            let words = format!("Designs of the fronts: {} and {}", a.label, b.label);
            self.add(Topic::Fronts, name, words, Chart::new(horizontal, vertical, series))?;
        }
        Ok(())
    }

    /// The prices along each front.
    fn drivers(&mut self, report: &Report) -> Result<(), ReportError> {
        for along in report.drivers.iter().filter(|along| along.designs.len() > 1) {
            let (architecture, slug) = (along.architecture, slug(along.architecture.name()));
            for (kind, words, chart) in [
                (
                    "prices-limits",
                    "Stacked prices of the limits (negative prices count as 0)",
                    along::prices(along, &[ParameterKind::Limit], Mark::Area),
                ),
                (
                    "prices-bounds",
                    "Prices of the region, the travels and the bounds",
                    along::prices(
                        along,
                        &[ParameterKind::Region, ParameterKind::Travel, ParameterKind::Bound],
                        Mark::Line,
                    ),
                ),
            ] {
                let words = format!("{words} along the front of the {architecture}");
                if !chart.series.is_empty() {
                    self.add(Topic::Drivers, format!("{kind}-{slug}"), words, chart)?;
                }
            }
        }
        Ok(())
    }

    /// The design variables and the active constraints along each front.
    fn along_fronts(&mut self, report: &Report) -> Result<(), ReportError> {
        for (architecture, trends) in &report.trends {
            let slug = slug(architecture.name());
            for (topic, kind, words, bars) in [
                (
                    Topic::Lengths,
                    "lengths",
                    "R, r and L_b along the front, with fitted straight lines",
                    false,
                ),
                (
                    Topic::Bars,
                    "bars",
                    "r_j and r_p along the front, with a fitted straight line and a fitted parabola, respectively",
                    true,
                ),
            ] {
                let of_kind = trends.iter().filter(|trend| trend.variable.may_be_zero() == bars);
                let shown: Vec<&Trend> = of_kind.collect();
                let words = format!("{words} ({architecture})");
                self.add(topic, format!("{kind}-{slug}"), words, along::variables(report, &shown))?;
            }
            if let Some(front) = report.fronts.of(*architecture) {
                let words = format!("Active constraints along the front of the {architecture}");
                let chart = along::active(report, *architecture, front);
                self.add(Topic::Active, format!("active-{slug}"), words, chart)?;
            }
        }
        Ok(())
    }
}

/// Returns the colour of an architecture, darkened for lines on white.
fn color(architecture: Architecture) -> [u8; 3] {
    palette::architecture(architecture).map(|value| (f64::from(value) * 0.82) as u8)
}

/// Iterates over the coordinates of all points on one axis.
pub(super) fn values(series: &[Series], axis: usize) -> impl Iterator<Item = f64> {
    series
        .iter()
        .flat_map(|series| &series.points)
        .map(move |point| point[axis])
}
