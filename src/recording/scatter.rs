//! The scatter plot of `R_w` over mass, drawn in a 2-D view.
//!
//! Rerun's 2-D view has no axes, and its y axis points downwards. The plot is therefore given in true coordinates,
//! `log₁₀(mass/kg)` and `R_w` in metres, under a transform that turns y upwards and gives both axes similar lengths,
//! and it draws its own axes.

use rerun::datatypes::{Range1D, Range2D};
use rerun::{Color, LineStrips2D, Points2D, Radius, Transform3D};

use super::colors;
use crate::study::{Row, Study, TableRow};
use kinefront_model::evaluation::Evaluation;
use kinefront_model::mechanism::Architecture;

/// Height of the `R_w` axis in the view, as a multiple of the width of one decade of mass.
const HEIGHT: f32 = 2.5;

pub(super) const AXIS_COLOR: [u8; 3] = [150, 155, 165];
pub(super) const INFEASIBLE_COLOR: [u8; 3] = [95, 98, 108];
pub(super) const FRONT_COLOR: [u8; 3] = [250, 250, 250];

/// Returns the position of a design in the plot.
pub(super) fn position(mass: f64, radius: f64) -> [f32; 2] {
    // The mass of a massless design (both bar radii 0) has no logarithm and is replaced by 0.1 g.
    [libm::log10(mass.max(1e-4)) as f32, radius as f32]
}

/// Returns the points of designs in one colour and size.
pub(super) fn points(designs: &[&Row], color: Color, size: f32) -> Points2D {
    Points2D::new(designs.iter().map(|row| position(row.mass, row.radius)))
        .with_colors(std::iter::repeat_n(color, designs.len()))
        .with_radii(std::iter::repeat_n(Radius::new_ui_points(size), designs.len()))
}

/// A design of the front as drawn in the scatter plot.
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
    /// Whether the design passes the filter; otherwise it is dimmed.
    pub passes_filter: bool,
}

impl From<&TableRow> for FrontPoint {
    fn from(entry: &TableRow) -> Self {
        Self {
            id: entry.id,
            architecture: entry.row.design.architecture,
            mass: entry.row.mass,
            radius: entry.row.radius,
            passes_filter: true,
        }
    }
}

/// Returns the designs of the front, each with a text that is shown when the mouse is over it.
pub(super) fn front_points(front: &[FrontPoint]) -> Points2D {
    Points2D::new(front.iter().map(|m| position(m.mass, m.radius)))
        .with_colors(front.iter().map(|m| {
            let [r, g, b] = crate::palette::architecture(m.architecture);
            if m.passes_filter {
                [r, g, b]
            } else {
                [r / 4, g / 4, b / 4]
            }
        }))
        .with_radii(std::iter::repeat_n(Radius::new_ui_points(4.0), front.len()))
        .with_labels(
            front
                .iter()
                .map(|m| format!("#{} {}: {:.2} kg, R_w {:.4} m", m.id, m.architecture, m.mass, m.radius)),
        )
        .with_show_labels(false)
        .with_draw_order(40.0)
}

/// Returns the mark of the selected design, which the other views show.
pub(super) fn selected(evaluation: &Evaluation) -> Points2D {
    Points2D::new([position(evaluation.mass, evaluation.workspace_radius)])
        .with_colors([colors::rgb(colors::LIMIT)])
        .with_radii([Radius::new_ui_points(7.0)])
        .with_draw_order(38.0)
}

/// Returns the boundary of the region that the front dominates, from its lightest design to the right end of the plot.
pub(super) fn staircase(front: &[FrontPoint], frame: &PlotRange) -> LineStrips2D {
    let mut strip: Vec<[f32; 2]> = Vec::new();
    for member in front {
        let [x, y] = position(member.mass, member.radius);
        strip.push([x, strip.last().map_or(0.0, |last| last[1])]);
        strip.push([x, y]);
    }
    if let Some(&[_, y]) = strip.last() {
        strip.push([frame.decades.1 as f32, y]);
    }
    LineStrips2D::new([strip])
        .with_colors([FRONT_COLOR])
        .with_radii([Radius::new_ui_points(1.0)])
        .with_draw_order(35.0)
}

/// Range of the plot: decades of mass and metres of `R_w`. It never shrinks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PlotRange {
    decades: (i32, i32),
    /// Number of ticks above 0 on the `R_w` axis.
    ticks: u32,
    tick: f64,
}

impl PlotRange {
    /// Creates the range for a study: four decades of mass up to the decade of the hypervolume's reference mass, and
    /// `R_w` up to 65 % of the largest base radius.
    pub(super) fn new(study: &Study) -> Self {
        let top = libm::log10(study.hypervolume.reference_mass_kg).ceil() as i32;
        let largest = 0.65 * study.bounds.R_m[1];
        let decade = libm::pow(10.0, libm::floor(libm::log10(largest)));
        let tick = [0.1, 0.2, 0.5]
            .into_iter()
            .map(|fraction| fraction * decade)
            .find(|tick| largest / tick <= 14.0)
            .unwrap_or(decade);
        Self {
            decades: (top - 4, top),
            ticks: (largest / tick).ceil() as u32,
            tick,
        }
    }

    /// Extends the range to contain a design; returns whether the range changed.
    pub(super) fn include(&mut self, mass: f64, radius: f64) -> bool {
        let before = *self;
        let [x, y] = position(mass, radius);
        if radius > 0.0 {
            self.decades.0 = self.decades.0.min(x.floor() as i32);
            self.decades.1 = self.decades.1.max(x.ceil() as i32);
        }
        self.ticks = self.ticks.max((f64::from(y) / self.tick).ceil() as u32);
        *self != before
    }

    /// Returns whether the mass of a design lies within the range; infeasible designs outside it are not drawn.
    pub(super) fn holds(&self, row: &Row) -> bool {
        let [x, _] = position(row.mass, row.radius);
        (self.decades.0 as f32..=self.decades.1 as f32).contains(&x)
    }

    /// Returns the transform from plot coordinates to those of the view: y points upwards, and the `R_w` axis is as
    /// high as [`HEIGHT`] decades of mass are wide.
    pub(super) fn transform(&self) -> Transform3D {
        let height = self.tick as f32 * self.ticks as f32;
        Transform3D::from_scale([1.0, -HEIGHT / height, 1.0])
    }

    /// Returns the visible range of the view, in its own coordinates: the plot, with space for its tick labels.
    pub(super) fn bounds(&self) -> Range2D {
        let (left, right) = (f64::from(self.decades.0), f64::from(self.decades.1));
        let (width, height) = (right - left, f64::from(HEIGHT));
        Range2D {
            x_range: Range1D([left - 0.13 * width, right + 0.07 * width]),
            y_range: Range1D([-1.16 * height, 0.2 * height]),
        }
    }

    /// Returns the axes and the grid lines at the ticks.
    pub(super) fn lines(&self) -> LineStrips2D {
        let (left, right) = (self.decades.0 as f32, self.decades.1 as f32);
        let top = (self.tick * f64::from(self.ticks)) as f32;
        let mut strips = vec![vec![[left, top], [left, 0.0], [right, 0.0]]];
        for decade in self.decades.0..=self.decades.1 {
            strips.push(vec![[decade as f32, 0.0], [decade as f32, top]]);
        }
        for k in 1..=self.ticks {
            let y = (self.tick * f64::from(k)) as f32;
            strips.push(vec![[left, y], [right, y]]);
        }
        let count = strips.len();
        let faint = |k: usize| if k == 0 { AXIS_COLOR } else { [52, 55, 62] };
        LineStrips2D::new(strips)
            .with_colors((0..count).map(faint))
            .with_radii((0..count).map(|k| Radius::new_ui_points(if k == 0 { 0.8 } else { 0.4 })))
            .with_draw_order(5.0)
    }

    /// Returns the legend of the colours, in the upper left corner, where no design can be.
    pub(super) fn legend(&self, architectures: &[Architecture]) -> Points2D {
        let (left, right) = (self.decades.0 as f32, self.decades.1 as f32);
        let top = (self.tick * f64::from(self.ticks)) as f32;
        let [r, g, b] = INFEASIBLE_COLOR;
        let entries: Vec<(String, Color)> = architectures
            .iter()
            .map(|&architecture| (architecture.to_string(), colors::architecture(architecture)))
            .chain([("infeasible".to_owned(), Color::from_rgb(r, g, b))])
            .collect();
        let x = left + 0.08 * (right - left);
        Points2D::new((0..entries.len()).map(|k| [x, (0.96 - 0.085 * k as f32) * top]))
            .with_radii(std::iter::repeat_n(Radius::new_ui_points(5.0), entries.len()))
            .with_colors(entries.iter().map(|(_, color)| *color))
            .with_labels(entries.into_iter().map(|(name, _)| name))
            .with_show_labels(true)
            .with_draw_order(7.0)
    }

    /// Returns the tick labels and the titles of the axes.
    pub(super) fn labels(&self) -> Points2D {
        let (left, right) = (self.decades.0 as f32, self.decades.1 as f32);
        let top = (self.tick * f64::from(self.ticks)) as f32;
        let mut positions = Vec::new();
        let mut labels = Vec::new();
        for decade in self.decades.0..=self.decades.1 {
            positions.push([decade as f32, -0.03 * top]);
            labels.push(match decade {
                0..=4 => format!("{}", 10u32.pow(decade.unsigned_abs())),
                _ => format!("1e{decade}"),
            });
        }
        for k in 1..=self.ticks {
            positions.push([left - 0.03 * (right - left), (self.tick * f64::from(k)) as f32]);
            labels.push(format!("{}", (self.tick * f64::from(k) * 1e6).round() / 1e6));
        }
        positions.push([0.5 * (left + right), -0.1 * top]);
        labels.push("mass in motion [kg], lighter is better".to_owned());
        positions.push([left + 0.2 * (right - left), 1.05 * top]);
        labels.push("regular workspace radius R_w [m], larger is better".to_owned());
        let count = positions.len();
        Points2D::new(positions)
            .with_labels(labels)
            .with_show_labels(true)
            .with_colors(std::iter::repeat_n(AXIS_COLOR, count))
            .with_radii(std::iter::repeat_n(Radius::new_ui_points(0.0), count))
            .with_draw_order(6.0)
    }
}
