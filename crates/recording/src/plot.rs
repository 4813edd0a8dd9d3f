//! The plot of a run, drawn in a 2-D view: the first two objectives of the study, or the only one over the evaluations.
//!
//! Rerun's 2-D view has no axes, and its y axis points downwards. The plot is therefore given in true coordinates or in decades,
//! under a transform that turns y upwards and gives both axes similar lengths, and it draws its own axes.

use rerun::datatypes::{Range1D, Range2D};
use rerun::{Color, LineStrips2D, Points2D, Radius, Transform3D};

use super::axis::{PlotAxis, Shows};
use super::colors;
use super::point::{FrontPoint, PlotPoint};
use kinefront_model::evaluation::Objective;
use kinefront_model::mechanism::Architecture;
use kinefront_optimize::Objectives;
use kinefront_scene::text::number;
use kinefront_study::Study;

/// Width and height of the plot in the view.
const SIZE: [f64; 2] = [4.0, 2.5];

const AXIS_COLOR: [u8; 3] = [150, 155, 165];
pub(super) const INFEASIBLE_COLOR: [u8; 3] = [95, 98, 108];
const FRONT_COLOR: [u8; 3] = [250, 250, 250];

/// The plot: its axes, and what the objectives are called. Its range never shrinks.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Plot {
    objectives: Vec<Objective>,
    axes: [PlotAxis; 2],
}

impl Plot {
    pub fn new(study: &Study) -> Self {
        let objectives = study.objectives();
        let of = |place: usize| Some(Shows::Objective(place, *objectives.get(place)?));
        let shown = match (of(0), of(1)) {
            (Some(first), Some(second)) => [first, second],
            (Some(only), None) => [Shows::Evaluations, only],
            (None, _) => [Shows::Evaluations; 2],
        };
        Self {
            axes: shown.map(PlotAxis::new),
            objectives,
        }
    }

    /// Extends the range to contain a feasible design; returns whether the axes changed.
    pub fn include(&mut self, point: &PlotPoint) -> bool {
        let before = self.axes.map(|axis| axis.scale());
        if point.is_feasible {
            for axis in &mut self.axes {
                axis.include(point);
            }
        }
        self.axes.map(|axis| axis.scale()) != before
    }

    /// Returns whether an infeasible design is drawn: it lies within the range.
    pub fn holds(&self, point: &PlotPoint) -> bool {
        self.axes.iter().all(|axis| {
            let scale = axis.scale();
            axis.coordinate(point)
                .is_some_and(|at| (scale.low..=scale.high).contains(&at))
        })
    }

    /// Returns the position of a design in the plot; `None` if it has none.
    pub fn position(&self, point: &PlotPoint) -> Option<[f32; 2]> {
        let [x, y] = self.axes.map(|axis| axis.coordinate(point));
        Some([x? as f32, y? as f32])
    }

    /// Returns the transform from plot coordinates to those of the view: y points upwards.
    pub fn transform(&self) -> Transform3D {
        let [x, y] = self.axes.map(|axis| axis.scale());
        let [wide, high] = [SIZE[0] / (x.high - x.low), SIZE[1] / (y.high - y.low)];
        Transform3D::from_translation_scale(
            [(-x.low * wide) as f32, (y.low * high) as f32, 0.0],
            [wide as f32, -high as f32, 1.0],
        )
    }

    /// Returns the visible range of the view, in its own coordinates: the plot, with space for its tick labels.
    pub fn bounds() -> Range2D {
        let [width, height] = SIZE;
        Range2D {
            x_range: Range1D([-0.13 * width, 1.07 * width]),
            y_range: Range1D([-1.16 * height, 0.2 * height]),
        }
    }

    /// Returns the axes and their ticks.
    pub fn grid(&self) -> PlotGrid {
        let [x, y] = self.axes.map(|axis| axis.scale());
        let [mut x_ticks, mut y_ticks] = self.axes.map(|axis| axis.ticks());
        // The lower end of the vertical axis meets the other one, whose first label is there.
        y_ticks.remove(0);
        if x_ticks.len() > 12 {
            x_ticks = x_ticks.into_iter().step_by(2).collect();
        }
        PlotGrid {
            x: [x.low as f32, x.high as f32],
            y: [y.low as f32, y.high as f32],
            x_ticks,
            y_ticks,
            titles: self.axes.map(|axis| axis.title()),
        }
    }

    /// Returns the boundary of the region that a front of two objectives dominates, up to the worst ends of both axes.
    pub fn staircase(&self, front: &[FrontPoint]) -> LineStrips2D {
        let [worst_x, worst_y] = self.axes.map(|axis| axis.worst_end() as f32);
        let mut strip: Vec<[f32; 2]> = Vec::new();
        // The front is in the order of the first objective.
        for [x, y] in front.iter().filter_map(|member| self.position(&member.at())) {
            strip.push([x, strip.last().map_or(worst_y, |last| last[1])]);
            strip.push([x, y]);
        }
        if let Some(&[_, y]) = strip.last() {
            strip.push([worst_x, y]);
        }
        LineStrips2D::new((self.objectives.len() == 2).then_some(strip))
            .with_colors([FRONT_COLOR])
            .with_radii([Radius::new_ui_points(1.0)])
            .with_draw_order(35.0)
    }

    /// States the values of the objectives.
    fn words(&self, objectives: &Objectives) -> String {
        let values = self.objectives.iter().zip(objectives.iter());
        let words = values.map(|(objective, minimised)| {
            let entry = objective.quantity.entry();
            let value = number(objective.value(*minimised));
            format!("{} {value} {}", entry.label, entry.unit).trim_end().to_owned()
        });
        words.collect::<Vec<_>>().join(", ")
    }

    /// Returns the points of designs in one colour and size.
    pub fn points(&self, designs: &[PlotPoint], color: Color, size: f32) -> Points2D {
        let positions: Vec<[f32; 2]> = designs.iter().filter_map(|design| self.position(design)).collect();
        let count = positions.len();
        Points2D::new(positions)
            .with_colors(std::iter::repeat_n(color, count))
            .with_radii(std::iter::repeat_n(Radius::new_ui_points(size), count))
    }

    /// Returns the designs of the front, each with a text that is shown when the mouse is over it. Instances are designs of the
    /// front in their order.
    pub fn front_points(&self, front: &[FrontPoint]) -> Points2D {
        let text = |member: &FrontPoint| {
            let values = self.words(&member.objectives);
            format!("#{} {}: {values}", member.id, member.architecture)
        };
        Points2D::new(front.iter().map(|m| self.position(&m.at()).unwrap_or_default()))
            .with_colors(front.iter().map(|m| {
                let [r, g, b] = kinefront_scene::palette::architecture(m.architecture);
                if m.passes_filter {
                    [r, g, b]
                } else {
                    [r / 4, g / 4, b / 4]
                }
            }))
            .with_radii(std::iter::repeat_n(Radius::new_ui_points(4.0), front.len()))
            .with_labels(front.iter().map(text))
            .with_show_labels(false)
            .with_draw_order(40.0)
    }

    /// Returns the mark of the selected design, which the other views show.
    pub fn selected(&self, point: &PlotPoint) -> Points2D {
        Points2D::new(self.position(point))
            .with_colors([colors::rgb(colors::LIMIT)])
            .with_radii([Radius::new_ui_points(7.0)])
            .with_draw_order(38.0)
    }
}

/// Axes of a plot, in its coordinates.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PlotGrid {
    /// Ends of both axes.
    pub x: [f32; 2],
    pub y: [f32; 2],
    /// Ticks with their labels; the vertical axis has none at its lower end.
    pub x_ticks: Vec<(f32, String)>,
    pub y_ticks: Vec<(f32, String)>,
    pub titles: [String; 2],
}

impl PlotGrid {
    fn at(&self, along: f32, up: f32) -> [f32; 2] {
        let [left, right] = self.x;
        let [bottom, top] = self.y;
        [left + along * (right - left), bottom + up * (top - bottom)]
    }

    /// Returns the axes and the grid lines at the ticks.
    pub fn lines(&self) -> LineStrips2D {
        let ([left, right], [bottom, top]) = (self.x, self.y);
        let mut strips = vec![vec![[left, top], [left, bottom], [right, bottom]]];
        strips.extend(self.x_ticks.iter().map(|(x, _)| vec![[*x, bottom], [*x, top]]));
        strips.extend(self.y_ticks.iter().map(|(y, _)| vec![[left, *y], [right, *y]]));
        let count = strips.len();
        let faint = |k: usize| if k == 0 { AXIS_COLOR } else { [52, 55, 62] };
        LineStrips2D::new(strips)
            .with_colors((0..count).map(faint))
            .with_radii((0..count).map(|k| Radius::new_ui_points(if k == 0 { 0.8 } else { 0.4 })))
            .with_draw_order(5.0)
    }

    /// Returns the legend of the colours, in the upper left corner.
    pub fn legend(&self, architectures: &[Architecture]) -> Points2D {
        let entries: Vec<(String, Color)> = architectures
            .iter()
            .map(|&architecture| (architecture.to_string(), colors::architecture(architecture)))
            .chain([("infeasible".to_owned(), colors::rgb(INFEASIBLE_COLOR))])
            .collect();
        Points2D::new((0..entries.len()).map(|k| self.at(0.08, 0.96 - 0.085 * k as f32)))
            .with_radii(std::iter::repeat_n(Radius::new_ui_points(5.0), entries.len()))
            .with_colors(entries.iter().map(|(_, color)| *color))
            .with_labels(entries.into_iter().map(|(name, _)| name))
            .with_show_labels(true)
            .with_draw_order(7.0)
    }

    /// Returns the tick labels and the titles of the axes.
    pub fn labels(&self) -> Points2D {
        let [below, left_of] = [self.at(0.0, -0.03)[1], self.at(-0.03, 0.0)[0]];
        let x = self.x_ticks.iter().map(|(x, label)| ([*x, below], label.clone()));
        let y = self.y_ticks.iter().map(|(y, label)| ([left_of, *y], label.clone()));
        let [horizontal, vertical] = self.titles.clone();
        let titles = [(self.at(0.5, -0.1), horizontal), (self.at(0.2, 1.05), vertical)];
        let (positions, labels): (Vec<_>, Vec<_>) = x.chain(y).chain(titles).unzip();
        let count = labels.len();
        Points2D::new(positions)
            .with_labels(labels)
            .with_show_labels(true)
            .with_colors(std::iter::repeat_n(AXIS_COLOR, count))
            .with_radii(std::iter::repeat_n(Radius::new_ui_points(0.0), count))
            .with_draw_order(6.0)
    }
}
