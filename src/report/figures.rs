//! Figures of a report.

use super::chart::{Chart, ChartAxis, Mark, Series};
use super::fits::Trend;
use super::fronts::Front;
use super::question::Question;
use super::{ClearanceCost, Figure, Report, ReportError, slug};
use crate::palette;
use crate::text::short;
use kinefront_model::evaluation::Constraint;
use kinefront_model::mechanism::{Architecture, DesignVariable};
use kinefront_model::workspace::Thresholds;

const MASS: &str = "mass in motion [kg]";
const RADIUS: &str = "workspace radius R_w [m]";
/// Colours of the values that the source of a reference design states, and of those that this model computes.
const STATED: [u8; 3] = [200, 40, 40];
const MODELLED: [u8; 3] = [20, 20, 20];
/// Colour of MOGA-II (reimplementation), the algorithm of the paper.
const GREY: [u8; 3] = [150, 150, 150];
/// Colours of the alternative assumptions, distinguishable on white.
const ALTERNATIVE_COLORS: [[u8; 3]; 14] = [
    [0, 0, 0],
    [213, 94, 0],
    [0, 114, 178],
    [0, 158, 115],
    [204, 121, 167],
    [230, 159, 0],
    [86, 180, 233],
    [120, 94, 240],
    [154, 99, 36],
    [100, 143, 20],
    [70, 90, 110],
    [190, 190, 190],
    [190, 190, 190],
    [190, 190, 190],
];

/// Draws all figures in the order of the page.
pub(super) fn all(report: &Report) -> Result<Vec<Figure>, ReportError> {
    let mut figures = Figures(Vec::new());
    if let Some(question) = &report.question {
        of_question(report, question, &mut figures)?;
        return Ok(figures.0);
    }
    for (name, words, logarithmic) in [
        ("fronts", "Pareto fronts of the architectures", false),
        (
            "fronts-log",
            "The same fronts over a logarithmic mass axis, which separates the light designs",
            true,
        ),
    ] {
        figures.add(name.to_owned(), words.to_owned(), together(report, logarithmic))?;
    }
    if report.fronts.alone.len() > 1 {
        let words = "Pareto front of all architectures together, coloured by the architecture of each design";
        figures.add("front-together".to_owned(), words.to_owned(), joint(report))?;
    }
    for (architecture, front) in &report.fronts.alone {
        let name = format!("front-{}", slug(architecture.name()));
        let words = format!("Pareto front of the {architecture}");
        figures.add(name, words, alone(report, *architecture, front))?;
    }
    for (architecture, trends) in &report.trends {
        let slug = slug(architecture.name());
        let of = |bars: bool| trends.iter().filter(move |trend| trend.variable.may_be_zero() == bars);
        for (kind, words, bars) in [
            (
                "lengths",
                "R, r and L_b along the front, with fitted straight lines",
                false,
            ),
            (
                "bars",
                "r_j and r_p along the front, with a fitted straight line and a fitted parabola, respectively",
                true,
            ),
        ] {
            let shown: Vec<&Trend> = of(bars).collect();
            let words = format!("{words} ({architecture})");
            figures.add(format!("{kind}-{slug}"), words, (along(&shown), 0))?;
        }
        let front = report.fronts.of(*architecture);
        if let Some(front) = front {
            let words = format!("Active constraints, which limit the workspace, along the front of the {architecture}");
            figures.add(
                format!("active-{slug}"),
                words,
                (active(*architecture, front, &report.model.thresholds), 0),
            )?;
        }
    }
    if let Some(cost) = ClearanceCost::of(&report.study, &report.variations) {
        for &(architecture, _) in &report.fronts.alone {
            let words = format!("Fronts of the {architecture} without and with a required clearance between members");
            let name = format!("clearance-{}", slug(architecture.name()));
            figures.add(name, words, clearance(&cost, architecture))?;
        }
    }
    for &(architecture, _) in report.fronts.alone.iter().filter(|_| !report.variations.is_empty()) {
        let words = format!("Fronts of the {architecture} under alternative assumptions");
        let name = format!("sensitivity-{}", slug(architecture.name()));
        figures.add(name, words, sensitivity(report, architecture))?;
    }
    Ok(figures.0)
}

/// Draws the figures of another question than the paper's.
fn of_question(report: &Report, question: &Question, figures: &mut Figures) -> Result<(), ReportError> {
    for (name, words, chart) in question.charts(&report.fronts) {
        figures.add(name, words, (chart, 0))?;
    }
    for (architecture, front) in &report.fronts.alone {
        for (kind, words, bars) in [
            ("lengths", "R, r and L_b along the front", false),
            ("bars", "r_j and r_p along the front", true),
        ] {
            if let Some(chart) = question.variables(front, bars) {
                let name = format!("{kind}-{}", slug(architecture.name()));
                figures.add(name, format!("{words} ({architecture})"), (chart, 0))?;
            }
        }
    }
    Ok(())
}

struct Figures(Vec<Figure>);

impl Figures {
    /// Draws a chart and adds it; `beyond` designs lie beyond the end of its mass axis.
    fn add(&mut self, name: String, words: String, (chart, beyond): (Chart, usize)) -> Result<(), ReportError> {
        let svg = chart.svg().map_err(|cause| ReportError::Figure {
            name: name.clone(),
            cause,
        })?;
        let caption = match beyond {
            0 => format!("{words}."),
            _ => format!("{words}. Designs beyond the end of the mass axis: {beyond}."),
        };
        self.0.push(Figure { name, caption, svg });
        Ok(())
    }
}

/// Returns the colour of an architecture, darkened for lines on white.
pub(super) fn color(architecture: Architecture) -> [u8; 3] {
    palette::architecture(architecture).map(|value| (f64::from(value) * 0.82) as u8)
}

/// Returns the reference designs of one architecture or of all: a series of the stated values, a series of the values
/// computed by this model, and the names beside the latter.
fn references(report: &Report, of: Option<Architecture>) -> (Vec<Series>, Vec<([f64; 2], String)>) {
    let of = |architecture: Architecture| of.is_none_or(|of| of == architecture);
    let found: Vec<_> = report
        .references
        .iter()
        .filter(|reference| of(reference.fine.design.architecture))
        .collect();
    let stated: Vec<[f64; 2]> = found
        .iter()
        .filter_map(|reference| Some([reference.stated_mass?, reference.stated_radius?]))
        .collect();
    let modelled: Vec<[f64; 2]> = found
        .iter()
        .map(|reference| [reference.fine.mass, reference.fine.workspace_radius])
        .collect();
    let notes = found
        .iter()
        .zip(&modelled)
        .map(|(reference, &at)| (at, reference.name.clone()))
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

/// Creates a chart of fronts over a logarithmic mass axis.
fn decades(series: Vec<Series>, notes: Vec<([f64; 2], String)>) -> (Chart, usize) {
    let x = ChartAxis::decades(MASS, values(&series, 0));
    (front_chart(x, series, notes, true), 0)
}

/// Creates a chart of fronts over a linear mass axis, and counts the designs of the first `own` series beyond its end.
/// The axis ends near the reference mass of the hypervolume if fewer than a quarter of these designs are heavier: at
/// the end of a front a millimetre of workspace may cost tons, which would compress the rest.
fn plain(report: &Report, own: usize, series: Vec<Series>, notes: Vec<([f64; 2], String)>) -> (Chart, usize) {
    let most = report.study.hypervolume.reference_mass_kg;
    let masses = || values(&series[..own], 0);
    let heavier = masses().filter(|&mass| mass > most).count();
    let is_cut = 4 * heavier < masses().count();
    let x = ChartAxis::from_zero(
        MASS,
        values(&series, 0).map(|mass| if is_cut { mass.min(most) } else { mass }),
    );
    let beyond = masses().filter(|&mass| mass > x.range[1]).count();
    (front_chart(x, series, notes, false), beyond)
}

/// Iterates over the coordinates of all points on one axis.
pub(super) fn values(series: &[Series], axis: usize) -> impl Iterator<Item = f64> {
    series
        .iter()
        .flat_map(|series| &series.points)
        .map(move |point| point[axis])
}

fn front_chart(x: ChartAxis, series: Vec<Series>, notes: Vec<([f64; 2], String)>, logarithmic: bool) -> Chart {
    Chart {
        x,
        y: ChartAxis::from_zero(RADIUS, values(&series, 1)),
        names: None,
        series,
        notes,
        // Fronts rise at the left end of a linear axis but at the right end of a logarithmic one.
        legend_above: logarithmic,
    }
}

fn alone(report: &Report, architecture: Architecture, front: &Front) -> (Chart, usize) {
    let mut series = vec![Series {
        name: architecture.to_string(),
        color: color(architecture),
        mark: Mark::DottedLine,
        points: front.points(),
    }];
    if let Some(moga2) = report.moga2.as_ref().and_then(|moga2| moga2.of(architecture)) {
        series.push(moga2_series("MOGA-II (reimplementation), one architecture", moga2));
    }
    let (references, notes) = references(report, Some(architecture));
    series.extend(references);
    plain(report, 1, series, notes)
}

fn moga2_series(name: &str, front: &Front) -> Series {
    Series {
        name: name.to_owned(),
        color: GREY,
        mark: Mark::DottedLine,
        points: front.points(),
    }
}

fn together(report: &Report, logarithmic: bool) -> (Chart, usize) {
    let mut series: Vec<Series> = report
        .fronts
        .alone
        .iter()
        .map(|(architecture, front)| Series {
            name: architecture.to_string(),
            color: color(*architecture),
            mark: Mark::DottedLine,
            points: front.points(),
        })
        .collect();
    let own = series.len();
    let (references, notes) = references(report, None);
    series.extend(references);
    if logarithmic {
        decades(series, notes)
    } else {
        plain(report, own, series, notes)
    }
}

/// Creates the chart of the front of all architectures, beside that of MOGA-II (reimplementation).
fn joint(report: &Report) -> (Chart, usize) {
    let front = &report.fronts.together;
    let mut series: Vec<Series> = report
        .fronts
        .alone
        .iter()
        .map(|(architecture, _)| {
            let of = front
                .shown()
                .filter(|member| member.design.architecture == *architecture);
            Series {
                name: architecture.to_string(),
                color: color(*architecture),
                mark: Mark::Dots,
                points: of.map(|member| [member.mass, member.workspace_radius]).collect(),
            }
        })
        .filter(|series| !series.points.is_empty())
        .collect();
    let own = series.len();
    if let Some(moga2) = report.moga2.as_ref().and_then(|moga2| moga2.joint.as_ref()) {
        series.push(moga2_series("MOGA-II (reimplementation), all architectures", moga2));
    }
    let (references, notes) = references(report, None);
    series.extend(references);
    plain(report, own, series, notes)
}

/// Creates a chart of design variables over `R_w` with the kinds of fit that the paper claims: straight lines, and a
/// parabola for `r_p`.
fn along(trends: &[&Trend]) -> Chart {
    const COLORS: [[u8; 3]; 3] = [[0, 114, 178], [213, 94, 0], [0, 158, 115]];
    let values = |axis: usize| {
        let points = trends.iter().flat_map(|trend| &trend.points);
        points.map(move |point| point[axis])
    };
    let x = ChartAxis::from_zero(RADIUS, values(0));
    let y = ChartAxis::from_zero("[m]", values(1));
    let mut series = Vec::new();
    for (trend, color) in trends.iter().zip(COLORS) {
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
            let radii = trend.free.iter().map(|point| point[0]);
            let [low, high] = radii.fold([f64::INFINITY, 0.0f64], |[low, high], radius| {
                [low.min(radius), high.max(radius)]
            });
            let at = (0..=60).map(|k| low + (high - low) * f64::from(k) / 60.0);
            series.push(Series {
                name: String::new(),
                color,
                mark: Mark::ThinLine,
                points: at.map(|radius| [radius, fit.at(radius)]).collect(),
            });
        }
    }
    Chart {
        x,
        y,
        names: None,
        series,
        notes: Vec::new(),
        legend_above: true,
    }
}

/// Creates a chart of the active constraints of each design over its `R_w`.
fn active(architecture: Architecture, front: &Front, thresholds: &Thresholds) -> Chart {
    let points: Vec<[f64; 2]> = front
        .shown()
        .flat_map(|member| {
            member
                .active()
                .map(|constraint| [member.workspace_radius, constraint as u8 as f64])
        })
        .collect();
    // The y value is the index among all constraints: only the last one, g7, is optional.
    let names: Vec<String> = Constraint::required(thresholds)
        .map(|constraint| format!("{} {}", constraint.id(), constraint.name().replace('_', " ")))
        .collect();
    Chart {
        x: ChartAxis::from_zero(RADIUS, front.shown().map(|member| member.workspace_radius)),
        y: ChartAxis {
            label: "".into(),
            range: [-0.5, names.len() as f64 - 0.5],
            logarithmic: false,
        },
        names: Some(names),
        series: vec![Series {
            name: String::new(),
            color: color(architecture),
            mark: Mark::Dots,
            points,
        }],
        notes: Vec::new(),
        legend_above: false,
    }
}

/// Creates a chart of the fronts of an architecture with and without a required clearance.
fn clearance(cost: &ClearanceCost<'_>, architecture: Architecture) -> (Chart, usize) {
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
            points: variation.of(architecture)?.points(),
        })
    });
    decades(series.collect(), Vec::new())
}

/// Creates a chart of the fronts of an architecture under every alternative assumption.
fn sensitivity(report: &Report, architecture: Architecture) -> (Chart, usize) {
    let mut chance = false;
    let series = report
        .variations
        .iter()
        .zip(ALTERNATIVE_COLORS.iter().cycle())
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
                points: variation.of(architecture)?.points(),
            })
        });
    decades(series.collect(), Vec::new())
}
