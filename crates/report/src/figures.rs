//! Figures of a report.

use super::chart::{Chart, ChartAxis, Mark, Series};
use super::fits::Trend;
use super::fronts::Front;
use super::{ClearanceCost, Figure, Report, ReportError, Topic, slug};
use kinefront_model::evaluation::{Constraint, Evaluation, Scale, Thresholds};
use kinefront_model::mechanism::{Architecture, DesignVariable};
use kinefront_scene::palette;
use kinefront_scene::text::short;
use kinefront_study::{Column, DriversAlong, ParameterKind, PriceCurve, stacked, usual_range};

/// Colours of the values that the source of a reference design states, and of those that this model computes.
const STATED: [u8; 3] = [200, 40, 40];
const MODELLED: [u8; 3] = [20, 20, 20];
/// Colour of MOGA-II (reimplementation).
const GREY: [u8; 3] = [150, 150, 150];
/// Colour of the study as it is stated, among its variations.
const BLACK: [u8; 3] = [0, 0, 0];

/// Draws all figures in the order of the page.
pub(super) fn all(report: &Report) -> Result<Vec<Figure>, ReportError> {
    let mut figures = Figures(Vec::new());
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
            figures.add(Topic::Clearance, name, words, clearance(report, &cost, architecture))?;
        }
    }
    for architecture in alone().filter(|_| !report.variations.is_empty()) {
        let words = format!("Fronts of the {architecture} under alternative assumptions");
        let name = format!("sensitivity-{}", slug(architecture.name()));
        figures.add(Topic::Sensitivity, name, words, sensitivity(report, architecture))?;
    }
    Ok(figures.0)
}

struct Figures(Vec<Figure>);

impl Figures {
    /// Draws a chart and adds it.
    fn add(&mut self, topic: Topic, name: String, words: String, chart: Chart) -> Result<(), ReportError> {
        let svg = chart.svg().map_err(|cause| ReportError::Figure {
            name: name.clone(),
            cause,
        })?;
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
        let series: Vec<Series> = series
            .map(|((name, points), color)| Series {
                name: if question.progress.len() > 1 {
                    name.clone()
                } else {
                    String::new()
                },
                color,
                mark: Mark::Line,
                points: points.clone(),
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
        self.add(Topic::Fronts, "front-progress".to_owned(), words, chart)
    }

    /// The fronts of two objectives.
    fn fronts(&mut self, report: &Report) -> Result<(), ReportError> {
        let words = "Pareto fronts of the architectures".to_owned();
        self.add(Topic::Fronts, "fronts".to_owned(), words, together(report, false))?;
        if report.question.objectives[0].quantity.entry().scale == Scale::Logarithmic {
            let words = format!(
                "The same fronts with a logarithmic axis of the {}, which separates its small values",
                report.question.name(0)
            );
            self.add(Topic::Fronts, "fronts-log".to_owned(), words, together(report, true))?;
        }
        if report.fronts.alone.len() > 1 {
            let words = "Pareto front of all architectures together, coloured by the architecture of each design";
            self.add(
                Topic::Fronts,
                "front-together".to_owned(),
                words.to_owned(),
                joint(report),
            )?;
        }
        for (architecture, front) in &report.fronts.alone {
            let name = format!("front-{}", slug(architecture.name()));
            let words = format!("Pareto front of the {architecture}");
            self.add(Topic::Fronts, name, words, alone(report, *architecture, front))?;
        }
        Ok(())
    }

    /// The fronts over each pair of more objectives.
    fn pairs(&mut self, report: &Report) -> Result<(), ReportError> {
        let question = &report.question;
        let count = question.objectives.len();
        for [x, y] in (0..count).flat_map(|x| (x + 1..count).map(move |y| [x, y])) {
            let series = report.fronts.alone.iter().map(|(architecture, front)| Series {
                name: architecture.to_string(),
                color: color(*architecture),
                mark: Mark::Dots,
                points: front
                    .shown()
                    .map(|member| [x, y].map(|axis| question.value(axis, member)))
                    .collect(),
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
                    prices(along, &[ParameterKind::Limit], Mark::Area),
                ),
                (
                    "prices-bounds",
                    "Prices of the region, the travels and the bounds",
                    prices(
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
                self.add(topic, format!("{kind}-{slug}"), words, along(report, &shown))?;
            }
            if let Some(front) = report.fronts.of(*architecture) {
                let words = format!("Active constraints along the front of the {architecture}");
                let chart = active(report, *architecture, front);
                self.add(Topic::Active, format!("active-{slug}"), words, chart)?;
            }
        }
        Ok(())
    }
}

/// Least price that a figure shows \[% for 1 %\].
const SHOWN: f64 = 0.02;

/// Creates a chart of the prices of the limits along a front, each area on top of those of the others, or of those of the region, the
/// travels and the bounds, as lines.
fn prices(along: &DriversAlong, kinds: &[ParameterKind], mark: Mark) -> Chart {
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
        .map(|(curve, color)| Series {
            name: curve.label,
            color,
            mark,
            points: curve
                .points
                .iter()
                .map(|[at, price]| [*at, price.clamp(low, high)])
                .collect(),
        })
        .collect();
    // The highest area is drawn first, so that the lower ones cover it.
    series.reverse();
    series.extend(along.crossings.iter().enumerate().map(|(index, crossing)| Series {
        name: if index == 0 { "change of architecture" } else { "" }.to_owned(),
        color: GREY,
        mark: Mark::ThinLine,
        points: vec![[crossing.at, low], [crossing.at, high]],
    }));
    let x = ChartAxis::about(Column::Quantity(along.along).title(), values(&series, 0));
    let y = ChartAxis {
        label: "price [% for 1 %]".into(),
        range: [low, high],
        logarithmic: false,
    };
    Chart {
        beyond,
        ..Chart::new(x, y, series)
    }
}

/// Returns the colour of an architecture, darkened for lines on white.
fn color(architecture: Architecture) -> [u8; 3] {
    palette::architecture(architecture).map(|value| (f64::from(value) * 0.82) as u8)
}

/// Iterates over the coordinates of all points on one axis.
fn values(series: &[Series], axis: usize) -> impl Iterator<Item = f64> {
    series
        .iter()
        .flat_map(|series| &series.points)
        .map(move |point| point[axis])
}

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
    let series = |name: &str, color: [u8; 3], mark: Mark, points: Vec<[f64; 2]>| Series {
        name: name.to_owned(),
        color,
        mark,
        points,
    };
    let mut all = vec![
        series("reference designs, stated", STATED, Mark::Rings, stated),
        series("reference designs, this model", MODELLED, Mark::Crosses, modelled),
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
    Series {
        name: name.to_owned(),
        color,
        mark: Mark::DottedLine,
        points: points(report, front),
    }
}

fn alone(report: &Report, architecture: Architecture, front: &Front) -> Chart {
    let mut series = vec![line(report, architecture.name(), color(architecture), front)];
    if let Some(moga2) = report.moga2.as_ref().and_then(|moga2| moga2.of(architecture)) {
        let name = "MOGA-II (reimplementation), one architecture";
        series.push(line(report, name, GREY, moga2));
    }
    let (references, notes) = references(report, Some(architecture));
    series.extend(references);
    front_chart(report, 1, series, notes, false)
}

fn together(report: &Report, decades: bool) -> Chart {
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
fn joint(report: &Report) -> Chart {
    let front = &report.fronts.together;
    let of = |architecture: Architecture| {
        let members = front
            .shown()
            .filter(move |member| member.design.architecture() == architecture);
        members.map(|member| place(report, member)).collect()
    };
    let series = report.fronts.alone.iter().map(|(architecture, _)| Series {
        name: architecture.to_string(),
        color: color(*architecture),
        mark: Mark::Dots,
        points: of(*architecture),
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

/// Creates a chart of design variables over the objective by which designs are compared, with straight lines, and a parabola for `r_p`.
fn along(report: &Report, trends: &[&Trend]) -> Chart {
    let values = |axis: usize| {
        let points = trends.iter().flat_map(|trend| &trend.points);
        points.map(move |point| point[axis])
    };
    let x = ChartAxis::from_zero_if_near(report.question.label(report.question.compared()), values(0));
    let y = ChartAxis::from_zero("design variable [m]", values(1));
    let mut series = Vec::new();
    for (trend, color) in trends.iter().zip(palette::SERIES) {
        series.push(Series {
            name: trend.variable.symbol().to_owned(),
            color,
            mark: Mark::Dots,
            points: trend.points.clone(),
        });
        let fit = if trend.variable == DesignVariable::PlatformBarRadius {
            &trend.quadratic
        } else {
            &trend.linear
        };
        if let Some(fit) = fit {
            let places = || trend.free.iter().map(|point| point[0]);
            let (low, high) = (
                places().fold(f64::INFINITY, f64::min),
                places().fold(f64::NEG_INFINITY, f64::max),
            );
            let at = (0..=60).map(|k| low + (high - low) * f64::from(k) / 60.0);
            series.push(Series {
                name: String::new(),
                color,
                mark: Mark::ThinLine,
                points: at.map(|place| [place, fit.at(place)]).collect(),
            });
        }
    }
    Chart::new(x, y, series)
}

/// Creates a chart of the active constraints of each design over the objective by which designs are compared.
fn active(report: &Report, architecture: Architecture, front: &Front) -> Chart {
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
    let y = ChartAxis {
        label: "".into(),
        range: [-0.5, names.len() as f64 - 0.5],
        logarithmic: false,
    };
    let series = vec![Series {
        name: String::new(),
        color: color(architecture),
        mark: Mark::Dots,
        points,
    }];
    Chart {
        names: Some(names),
        legend_above: false,
        ..Chart::new(x, y, series)
    }
}

/// Creates a chart of the fronts of an architecture with and without a required clearance.
fn clearance(report: &Report, cost: &ClearanceCost<'_>, architecture: Architecture) -> Chart {
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
        Some(Series {
            name,
            color,
            mark,
            points: points(report, variation.of(architecture)?),
        })
    });
    variations_chart(report, series.collect())
}

/// Creates a chart of the fronts of an architecture under every alternative assumption.
fn sensitivity(report: &Report, architecture: Architecture) -> Chart {
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
            Some(Series {
                name,
                color: if variation.is_chance() { GREY } else { color },
                mark: if variation.alternative.is_none() {
                    Mark::Line
                } else {
                    Mark::ThinLine
                },
                points: points(report, variation.of(architecture)?),
            })
        });
    variations_chart(report, series.collect())
}

fn variations_chart(report: &Report, series: Vec<Series>) -> Chart {
    let decades = report.question.objectives[0].quantity.entry().scale == Scale::Logarithmic;
    let own = series.len();
    front_chart(report, own, series, Vec::new(), decades)
}
