//! The plot of a run, drawn in a 2-D view: `R_w` over mass, or what else the study seeks.
//!
//! Rerun's 2-D view has no axes, and its y axis points downwards. The plot is therefore given in true coordinates or in decades,
//! under a transform that turns y upwards and gives both axes similar lengths, and it draws its own axes.

use rerun::datatypes::Range2D;
use rerun::{Color, LineStrips2D, Points2D, Radius, Transform3D};

use super::colors;
use super::objective_plot::ObjectivePlot;
use super::scatter::PlotRange;
use crate::study::{Row, Study, TableRow};
use kinefront_model::evaluation::Evaluation;
use kinefront_model::mechanism::Architecture;
use kinefront_optimize::Objectives;

/// Height of the vertical axis in the view, as a multiple of the width of one decade of mass.
pub(super) const HEIGHT: f32 = 2.5;

pub(super) const AXIS_COLOR: [u8; 3] = [150, 155, 165];
pub(super) const INFEASIBLE_COLOR: [u8; 3] = [95, 98, 108];
pub(super) const FRONT_COLOR: [u8; 3] = [250, 250, 250];

/// A design as a plot places it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PlotPoint {
    /// Id of the evaluation, if it has one.
    pub id: Option<usize>,
    /// Mass in motion \[kg\].
    pub mass: f64,
    /// `R_w` \[m\].
    pub radius: f64,
    /// The objectives, as they are minimised.
    pub objectives: Objectives,
    pub is_feasible: bool,
}

impl PlotPoint {
    pub fn of_row(id: usize, row: &Row) -> Self {
        Self {
            id: Some(id),
            mass: row.mass,
            radius: row.radius,
            objectives: row.objectives,
            is_feasible: row.is_feasible(),
        }
    }

    pub fn of_evaluation(id: Option<usize>, evaluation: &Evaluation) -> Self {
        Self {
            id,
            mass: evaluation.mass,
            radius: evaluation.workspace_radius,
            objectives: Objectives::new(evaluation.objectives.iter().copied()),
            is_feasible: evaluation.is_feasible(),
        }
    }
}

/// A design of the front as drawn in the plot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrontPoint {
    /// Id of the evaluation.
    pub id: usize,
    /// Architecture.
    pub architecture: Architecture,
    /// Mass in motion \[kg\].
    pub mass: f64,
    /// `R_w` \[m\].
    pub radius: f64,
    /// The objectives, as they are minimised.
    pub objectives: Objectives,
    /// Whether the design passes the filter; otherwise it is dimmed.
    pub passes_filter: bool,
}

impl FrontPoint {
    pub(super) fn at(&self) -> PlotPoint {
        PlotPoint {
            id: Some(self.id),
            mass: self.mass,
            radius: self.radius,
            objectives: self.objectives,
            is_feasible: true,
        }
    }
}

impl From<&TableRow> for FrontPoint {
    fn from(entry: &TableRow) -> Self {
        Self {
            id: entry.id,
            architecture: entry.row.design.architecture,
            mass: entry.row.mass,
            radius: entry.row.radius,
            objectives: entry.row.objectives,
            passes_filter: true,
        }
    }
}

/// What a plot shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Plot {
    /// `R_w` over mass.
    Workspaces(PlotRange),
    /// The first two objectives, or the only one over the evaluations.
    Objectives(ObjectivePlot),
}

impl Plot {
    pub fn new(study: &Study) -> Self {
        if study.asks_as_the_paper() {
            Plot::Workspaces(PlotRange::new(study))
        } else {
            Plot::Objectives(ObjectivePlot::new(&study.objectives()))
        }
    }

    /// Extends the range to contain a design; returns whether the axes changed.
    pub fn include(&mut self, point: &PlotPoint) -> bool {
        match self {
            Plot::Workspaces(plot) => plot.include(point.mass, point.radius),
            Plot::Objectives(plot) => plot.include(point),
        }
    }

    /// Returns whether an infeasible design is drawn: it lies within the range.
    pub fn holds(&self, point: &PlotPoint) -> bool {
        match self {
            Plot::Workspaces(plot) => plot.holds(point.mass, point.radius),
            Plot::Objectives(plot) => plot.holds(point),
        }
    }

    /// Returns the position of a design in the plot; `None` if it has none.
    pub fn position(&self, point: &PlotPoint) -> Option<[f32; 2]> {
        match self {
            Plot::Workspaces(_) => Some(super::scatter::position(point.mass, point.radius)),
            Plot::Objectives(plot) => plot.position(point),
        }
    }

    /// Returns the transform from plot coordinates to those of the view.
    pub fn transform(&self) -> Transform3D {
        match self {
            Plot::Workspaces(plot) => plot.transform(),
            Plot::Objectives(plot) => plot.transform(),
        }
    }

    /// Returns the visible range of the view, in its own coordinates: the plot, with space for its tick labels.
    pub fn bounds(&self) -> Range2D {
        match self {
            Plot::Workspaces(plot) => plot.bounds(),
            Plot::Objectives(_) => ObjectivePlot::bounds(),
        }
    }

    /// Returns the axes and their ticks.
    pub fn grid(&self) -> PlotGrid {
        match self {
            Plot::Workspaces(plot) => plot.grid(),
            Plot::Objectives(plot) => plot.grid(),
        }
    }

    /// Returns the boundary of the region that the front dominates, which only the plot of workspaces has.
    pub fn staircase(&self, front: &[FrontPoint]) -> LineStrips2D {
        let strips = match self {
            Plot::Workspaces(plot) => vec![plot.staircase(front)],
            Plot::Objectives(_) => Vec::new(),
        };
        LineStrips2D::new(strips)
            .with_colors([FRONT_COLOR])
            .with_radii([Radius::new_ui_points(1.0)])
            .with_draw_order(35.0)
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
            let values = match self {
                Plot::Workspaces(_) => format!("{:.2} kg, R_w {:.4} m", member.mass, member.radius),
                Plot::Objectives(plot) => plot.words(&member.objectives),
            };
            format!("#{} {}: {values}", member.id, member.architecture)
        };
        Points2D::new(front.iter().map(|m| self.position(&m.at()).unwrap_or_default()))
            .with_colors(front.iter().map(|m| {
                let [r, g, b] = crate::palette::architecture(m.architecture);
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

/// Returns the label of a decade on a logarithmic axis.
pub(super) fn decade_label(decade: i32) -> String {
    match decade {
        0..=4 => format!("{}", 10u32.pow(decade.unsigned_abs())),
        _ => format!("1e{decade}"),
    }
}

/// Returns the label of a value on an axis that is not logarithmic, without the rounding errors of multiples of a step.
pub(super) fn tick_label(value: f64) -> String {
    format!("{}", (value * 1e6).round() / 1e6)
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
        let [r, g, b] = INFEASIBLE_COLOR;
        let entries: Vec<(String, Color)> = architectures
            .iter()
            .map(|&architecture| (architecture.to_string(), colors::architecture(architecture)))
            .chain([("infeasible".to_owned(), Color::from_rgb(r, g, b))])
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
