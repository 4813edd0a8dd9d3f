//! Drawing charts as SVG and converting SVG to PNG.

use std::borrow::Cow;

use crate::error::AnyError;
use std::sync::{Arc, OnceLock};

use plotters::coord::Shift;
use plotters::coord::ranged1d::{Ranged, ValueFormatter};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use resvg::{tiny_skia, usvg};

/// An axis of a chart.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ChartAxis {
    pub label: Cow<'static, str>,
    pub range: [f64; 2],
    pub logarithmic: bool,
}

/// Returns the smallest and the largest of some values; the first is the larger one if there are none.
pub(super) fn extremes(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    let values = values.into_iter();
    values.fold(none, |[low, high], value| [low.min(value), high.max(value)])
}

impl ChartAxis {
    /// Creates a linear axis over a range.
    pub fn linear(label: impl Into<Cow<'static, str>>, range: [f64; 2]) -> Self {
        Self {
            label: label.into(),
            range,
            logarithmic: false,
        }
    }

    /// Creates a linear axis from 0 to slightly beyond the largest value.
    pub fn from_zero(label: impl Into<Cow<'static, str>>, values: impl Iterator<Item = f64>) -> Self {
        let largest = values.fold(0.0, f64::max);
        Self::linear(label, [0.0, if largest > 0.0 { 1.06 * largest } else { 1.0 }])
    }

    /// Creates a linear axis from 0 if no value is negative and 0 is near compared with the largest one, otherwise about the values.
    pub fn from_zero_if_near(label: impl Into<Cow<'static, str>>, values: impl Iterator<Item = f64>) -> Self {
        let values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
        let [low, high] = extremes(values.iter().copied());
        if (0.0..=0.7 * high).contains(&low) {
            Self::from_zero(label, values.into_iter())
        } else {
            Self::about(label, values.into_iter())
        }
    }

    /// Creates a linear axis from slightly below the smallest value to slightly beyond the largest one.
    pub fn about(label: impl Into<Cow<'static, str>>, values: impl Iterator<Item = f64>) -> Self {
        let [low, high] = extremes(values.filter(|value| value.is_finite()));
        let (low, high) = if low <= high { (low, high) } else { (0.0, 1.0) };
        // Equal values get an axis that has a length, too.
        let spare = (0.06 * (high - low)).max(1e-3 * high.abs()).max(1e-9);
        Self::linear(label, [low - spare, high + spare])
    }

    /// Creates a logarithmic axis over the positive values.
    pub fn decades(label: impl Into<Cow<'static, str>>, values: impl Iterator<Item = f64>) -> Self {
        let [low, high] = extremes(values.filter(|&value| value > 0.0));
        let range = if low <= high {
            [0.8 * low, 1.25 * high]
        } else {
            [0.1, 10.0]
        };
        Self {
            logarithmic: true,
            ..Self::linear(label, range)
        }
    }
}

/// How the points of a series are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Mark {
    /// Joined by a line.
    Line,
    /// Joined by a thin line.
    ThinLine,
    /// Filled dots.
    Dots,
    /// Dots joined by a line.
    DottedLine,
    /// Rings.
    Rings,
    /// Crosses.
    Crosses,
    /// The area between the points and 0; a later series is drawn over an earlier one.
    Area,
}

/// A series of points that are drawn alike.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Series {
    /// Entry in the legend; empty for none.
    pub name: String,
    pub color: [u8; 3],
    pub mark: Mark,
    pub points: Vec<[f64; 2]>,
}

impl Series {
    pub fn new(name: impl Into<String>, color: [u8; 3], mark: Mark, points: Vec<[f64; 2]>) -> Self {
        Self {
            name: name.into(),
            color,
            mark,
            points,
        }
    }
}

/// A chart.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Chart {
    pub x: ChartAxis,
    pub y: ChartAxis,
    /// Labels for the integers 0, 1, 2, … of the y axis, shown instead of numbers.
    pub names: Option<Vec<String>>,
    pub series: Vec<Series>,
    /// Labels beside points.
    pub notes: Vec<([f64; 2], String)>,
    /// Whether the legend is in the upper left corner rather than in the lower right one.
    pub legend_above: bool,
    /// Number of designs that lie beyond an end of an axis.
    pub beyond: usize,
}

/// Width and height of a figure in units of its SVG.
const SIZE: (u32, u32) = (640, 430);
/// Drawing steps per unit: the plotting library rounds coordinates to integers.
const FINE: u32 = 4;

/// Opacity of an area, so that the grid is visible through it.
const AREA_OPACITY: f64 = 0.85;

type DrawingResult = Result<(), DrawingAreaErrorKind<std::io::Error>>;

const INK: RGBColor = RGBColor(40, 44, 52);
const GRID: RGBColor = RGBColor(226, 229, 234);

impl Chart {
    /// Creates a chart with numbers on both axes and its legend above.
    pub fn new(x: ChartAxis, y: ChartAxis, series: Vec<Series>) -> Self {
        Self {
            x,
            y,
            names: None,
            series,
            notes: Vec::new(),
            legend_above: true,
            beyond: 0,
        }
    }

    /// Draws the chart as SVG.
    pub fn svg(&self) -> Result<String, AnyError> {
        register_font()?;
        let mut text = String::new();
        let root = SVGBackend::with_string(&mut text, (FINE * SIZE.0, FINE * SIZE.1)).into_drawing_area();
        self.paint(&root).map_err(|error| format!("drawing failed: {error}"))?;
        drop(root);
        // The figure is displayed at its nominal size although it was drawn in finer steps.
        let drawn = format!("width=\"{}\" height=\"{}\"", FINE * SIZE.0, FINE * SIZE.1);
        let shown = format!("width=\"{}\" height=\"{}\"", SIZE.0, SIZE.1);
        Ok(text.replacen(&drawn, &shown, 1))
    }

    fn paint(&self, root: &DrawingArea<SVGBackend<'_>, Shift>) -> DrawingResult {
        root.fill(&WHITE)?;
        let mut builder = ChartBuilder::on(root);
        builder
            .margin(14 * FINE)
            .x_label_area_size(48 * FINE)
            .y_label_area_size(FINE * if self.names.is_some() { 150 } else { 60 });
        let [low, high] = self.x.range;
        let [bottom, top] = self.y.range;
        if self.x.logarithmic {
            self.draw(builder.build_cartesian_2d((low..high).log_scale(), bottom..top)?)?;
        } else {
            self.draw(builder.build_cartesian_2d(low..high, bottom..top)?)?;
        }
        root.present()
    }

    fn holds(&self, point: &[f64; 2]) -> bool {
        let inside = |axis: &ChartAxis, value: f64| (axis.range[0]..=axis.range[1]).contains(&value);
        inside(&self.x, point[0]) && inside(&self.y, point[1])
    }

    fn draw<'a, 'b: 'a, X>(
        &self,
        mut chart: ChartContext<'a, SVGBackend<'b>, Cartesian2d<X, RangedCoordf64>>,
    ) -> DrawingResult
    where
        X: Ranged<ValueType = f64> + ValueFormatter<f64>,
    {
        let font = |size: u32| ("sans-serif", FINE * size).into_font().color(&INK);
        // A tick at zero may carry a rounding error.
        let number = |value: &f64| kinefront_scene::text::short(if value.abs() < 1e-12 { 0.0 } else { *value });
        let name = |value: &f64| {
            let whole = value.round();
            let names = self.names.as_deref().unwrap_or_default();
            if (value - whole).abs() > 1e-6 || whole < 0.0 {
                return String::new();
            }
            names.get(whole as usize).cloned().unwrap_or_default()
        };
        let y_text: &dyn Fn(&f64) -> String = if self.names.is_some() { &name } else { &number };
        chart
            .configure_mesh()
            .light_line_style(WHITE)
            .bold_line_style(GRID.stroke_width(FINE))
            .axis_style(INK.stroke_width(FINE))
            .set_all_tick_mark_size(5 * FINE)
            .x_desc(self.x.label.as_ref())
            .y_desc(self.y.label.as_ref())
            .axis_desc_style(font(17))
            .label_style(font(15))
            .x_labels(9)
            .y_labels(self.names.as_ref().map_or(9, |names| 2 * names.len() + 1))
            .x_label_formatter(&number)
            .y_label_formatter(y_text)
            .draw()?;
        for series in &self.series {
            self.series(&mut chart, series)?;
        }
        let step = FINE as i32;
        for (at, words) in self.notes.iter().filter(|(at, _)| self.holds(at)) {
            let text = Text::new(words.clone(), (8 * step, -6 * step), font(15));
            chart.draw_series([EmptyElement::at((at[0], at[1])) + text])?;
        }
        if self.series.iter().any(|series| !series.name.is_empty()) {
            chart
                .configure_series_labels()
                .position(if self.legend_above {
                    SeriesLabelPosition::UpperLeft
                } else {
                    SeriesLabelPosition::LowerRight
                })
                .margin(10 * FINE)
                .legend_area_size(26 * FINE)
                .background_style(WHITE.mix(0.85))
                .border_style(GRID)
                .label_font(font(15))
                .draw()?;
        }
        Ok(())
    }

    fn series<'a, 'b: 'a, X>(
        &self,
        chart: &mut ChartContext<'a, SVGBackend<'b>, Cartesian2d<X, RangedCoordf64>>,
        series: &Series,
    ) -> DrawingResult
    where
        X: Ranged<ValueType = f64>,
    {
        let [r, g, b] = series.color;
        let color = RGBColor(r, g, b);
        let within = series.points.iter().filter(|point| self.holds(point));
        let points: Vec<(f64, f64)> = within.map(|&[x, y]| (x, y)).collect();
        let width = FINE * if series.mark == Mark::ThinLine { 1 } else { 2 };
        let step = FINE as i32;
        if matches!(series.mark, Mark::Line | Mark::ThinLine | Mark::DottedLine) {
            let drawn = chart.draw_series(LineSeries::new(points.iter().copied(), color.stroke_width(width)))?;
            if !series.name.is_empty() {
                drawn
                    .label(&series.name)
                    .legend(move |(x, y)| PathElement::new([(x, y), (x + 18 * step, y)], color.stroke_width(width)));
            }
        }
        // The library uses different types for markers on the chart and in the legend, so a function cannot serve both.
        macro_rules! marks {
            ($mark:ident, $size:expr, $style:expr) => {{
                let (size, style) = ($size * step, $style);
                let drawn = chart.draw_series(points.iter().map(|&at| $mark::new(at, size, style)))?;
                if !series.name.is_empty() && series.mark != Mark::DottedLine {
                    drawn
                        .label(&series.name)
                        .legend(move |(x, y)| $mark::new((x + 9 * step, y), size, style));
                }
            }};
        }
        if series.mark == Mark::Area {
            let style = color.mix(AREA_OPACITY).filled();
            let drawn = chart.draw_series(AreaSeries::new(points.iter().copied(), 0.0, color.mix(AREA_OPACITY)))?;
            let corners = move |(x, y)| Rectangle::new([(x, y - 5 * step), (x + 18 * step, y + 5 * step)], style);
            drawn.label(&series.name).legend(corners);
        }
        match series.mark {
            Mark::Line | Mark::ThinLine | Mark::Area => {}
            Mark::DottedLine => marks!(Circle, 2, color.filled()),
            Mark::Dots => marks!(Circle, 3, color.filled()),
            Mark::Rings => marks!(Circle, 6, color.stroke_width(2 * FINE)),
            Mark::Crosses => marks!(Cross, 5, color.stroke_width(2 * FINE)),
        }
        Ok(())
    }
}

/// The font with which figures are laid out; embedding it makes them identical on every machine.
const FONT: &[u8] = epaint_default_fonts::UBUNTU_LIGHT;

fn register_font() -> Result<(), AnyError> {
    static REGISTERED: OnceLock<bool> = OnceLock::new();
    let registered =
        REGISTERED.get_or_init(|| plotters::style::register_font("sans-serif", FontStyle::Normal, FONT).is_ok());
    if *registered {
        Ok(())
    } else {
        Err("cannot read the embedded font".into())
    }
}

/// Renders an SVG as PNG with `scale` pixels per unit.
pub(super) fn png(svg: &str, scale: f32) -> Result<Vec<u8>, AnyError> {
    static FONTS: OnceLock<Arc<usvg::fontdb::Database>> = OnceLock::new();
    let fonts = FONTS.get_or_init(|| {
        let mut fonts = usvg::fontdb::Database::new();
        fonts.load_font_data(FONT.to_vec());
        let family = fonts
            .faces()
            .next()
            .and_then(|face| face.families.first().map(|(name, _)| name.clone()));
        fonts.set_sans_serif_family(family.unwrap_or_default());
        Arc::new(fonts)
    });
    let options = usvg::Options {
        fontdb: Arc::clone(fonts),
        ..usvg::Options::default()
    };
    let tree = usvg::Tree::from_str(svg, &options)?;
    let size = tree.size();
    let (width, height) = ((size.width() * scale) as u32, (size.height() * scale) as u32);
    let mut picture = tiny_skia::Pixmap::new(width, height).ok_or("the width or the height of the picture is 0")?;
    resvg::render(
        &tree,
        tiny_skia::Transform::from_scale(scale, scale),
        &mut picture.as_mut(),
    );
    Ok(picture.encode_png()?)
}

/// Encodes pixels (red, green, blue, row by row) as PNG.
pub(super) fn pixels_to_png(width: u32, height: u32, pixels: &[[u8; 3]]) -> Result<Vec<u8>, AnyError> {
    let mut picture = tiny_skia::Pixmap::new(width, height).ok_or("the width or the height of the picture is 0")?;
    for (target, &[r, g, b]) in picture.pixels_mut().iter_mut().zip(pixels) {
        *target = tiny_skia::ColorU8::from_rgba(r, g, b, 255).premultiply();
    }
    Ok(picture.encode_png()?)
}
