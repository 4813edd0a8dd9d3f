//! The scatter: a plot of any two quantities of the designs, by default the first two objectives.

mod axis;
mod cloud;
mod coloring;
mod controls;
mod enclosing;
mod marks;
mod pointer;

use kinefront_model::evaluation::Better;
use kinefront_model::mechanism::DesignVariable;
use kinefront_study::Column;
use std::sync::Arc;
use std::time::Duration;

use egui::{Align2, Color32, Pos2, Rect, Stroke, Ui, Vec2, WidgetInfo, WidgetType};
use egui_plot::{Plot, PlotBounds, PlotImage, PlotPoint, PlotTransform};

use self::axis::{Extent, decades, tick};
pub use self::axis::{ScatterAxis, axes};
use self::cloud::{Cloud, Style, View};
pub use self::coloring::Coloring;
use self::coloring::{ColorLegend, ColorRange, ColorScale};
pub use self::enclosing::DragTool;
use self::enclosing::Enclosing;
use super::say_empty;
use crate::{MarkedCounts, Row, Session, theme};

/// Time that a frame may spend on drawing the cloud.
const BUDGET: Duration = Duration::from_millis(4);

/// Half the width of the label of a tick \[points\]: so far it reaches over the right end of the axis.
const HALF_A_TICK: f32 = 14.0;

/// The scatter with its axes and view.
pub struct Scatter {
    axes: [ScatterAxis; 2],
    cloud: Cloud,
    extent: Extent,
    /// Whether the view is fitted to the designs in every frame.
    fitted: bool,
    transform: Option<PlotTransform>,
    coloring: Coloring,
    color_range: ColorRange,
    /// Colours of the quantity that the colour tells, if it tells one.
    scale: Option<ColorScale>,
    tool: DragTool,
    enclosing: Enclosing,
    /// The marked designs that were counted last, with their counts.
    counted: Option<(Arc<Vec<usize>>, u64, MarkedCounts)>,
    /// Columns of the objectives that the axes last followed.
    followed: Vec<Column>,
}

impl Default for Scatter {
    fn default() -> Self {
        Self::new(axes_of(&[]), Vec::new())
    }
}

impl Scatter {
    /// Creates a scatter with the given axes, which were chosen for these objectives; it keeps them until the study has others.
    pub fn new(axes: [ScatterAxis; 2], followed: Vec<Column>) -> Self {
        Self {
            axes,
            cloud: Cloud::default(),
            extent: Extent::default(),
            fitted: true,
            transform: None,
            coloring: Coloring::default(),
            color_range: ColorRange::default(),
            scale: None,
            tool: DragTool::default(),
            enclosing: Enclosing::default(),
            counted: None,
            followed,
        }
    }

    /// Sets what dragging does.
    pub fn set_tool(&mut self, tool: DragTool) {
        self.tool = tool;
    }

    /// Sets what the colours tell.
    pub fn set_coloring(&mut self, coloring: Coloring) {
        self.coloring = coloring;
    }

    /// Returns the columns of the objectives for which the axes were chosen.
    pub fn followed(&self) -> &[Column] {
        &self.followed
    }

    /// Returns the axes.
    pub fn axes(&self) -> [ScatterAxis; 2] {
        self.axes
    }

    /// Returns the position of a design on screen in the last frame.
    pub fn screen_position(&self, row: &Row) -> Option<Pos2> {
        Some(self.transform?.position_from_point(&self.place(row).into()))
    }

    fn place(&self, row: &Row) -> [f64; 2] {
        self.axes
            .map(|axis| axis.place(row.number(axis.quantity).unwrap_or(f64::NAN)))
    }

    /// Draws the panel.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        self.follow_objectives(session);
        self.controls(ui, session);
        self.scale = match self.coloring {
            Coloring::Quantity(column) => Some(self.color_range.update(column, session.era(), session.store())),
            _ => None,
        };
        let bounds = self.bounds(session);
        let dark = ui.visuals().dark_mode;
        let (lines, marks) = self.front(session, dark);
        let (fitted, cloud) = (self.fitted, &self.cloud);
        let shown = self.plot().width(ui.available_width() - HALF_A_TICK).show(ui, |plot| {
            if fitted {
                plot.set_plot_bounds(bounds);
            }
            if let Some((texture, low, high)) = cloud.picture() {
                let size = Vec2::new((high[0] - low[0]) as f32, (high[1] - low[1]) as f32);
                let centre = PlotPoint::new(0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]));
                plot.image(PlotImage::new("", texture.id(), centre, size).allow_hover(false));
            }
            for line in lines {
                plot.line(line);
            }
            for (points, text) in marks {
                plot.points(points);
                if let Some(text) = text {
                    plot.text(text);
                }
            }
            if plot.response().hovered() {
                let turned = plot.ctx().input(|input| input.smooth_scroll_delta().y);
                if turned != 0.0 {
                    plot.zoom_bounds_around_hovered(Vec2::splat((turned * 0.005).exp()));
                }
            }
        });
        self.transform = Some(shown.transform);
        self.follow_pointer(ui, &shown.response);
        self.enclosing
            .follow(ui, &shown.response, self.tool, self.axes, &shown.transform, session);
        shown
            .response
            .widget_info(|| WidgetInfo::labeled(WidgetType::Image, true, "Scatter of designs"));
        self.pointed(&shown.response, session);
        self.draw_cloud(ui, session, &shown.transform, dark);
        let frame = *shown.transform.frame();
        self.arrows(ui, frame);
        if session.store().is_empty() {
            let words = "Designs appear here as they are evaluated:\nstart a run in the panel Run, or open one.";
            say_empty(ui, &ui.painter_at(frame), frame.center(), words);
        }
        self.legend(ui, frame, dark);
    }

    /// Shows the objectives of the study when they are other ones than before.
    fn follow_objectives(&mut self, session: &Session) {
        let columns = objective_columns(session);
        if self.followed == columns {
            return;
        }
        self.axes = axes_of(&columns);
        self.fitted = true;
        self.coloring = columns
            .get(2)
            .copied()
            .map_or(Coloring::Architecture, Coloring::Quantity);
        self.followed = columns;
    }

    /// Tells what the colours mean, unless they are those of the architectures.
    fn legend(&self, ui: &Ui, frame: Rect, dark: bool) {
        let legend = match (self.scale, self.cloud.most()) {
            (Some(scale), _) => ColorLegend::of_scale(&scale),
            (None, Some(most)) => ColorLegend::of_density(most, dark),
            (None, None) => return,
        };
        legend.paint(ui, frame);
    }

    /// Bounds that hold every feasible design and every reference design.
    fn bounds(&mut self, session: &Session) -> PlotBounds {
        self.extent.update(self.axes, session.era(), session.store());
        let mut bounds = self.extent.bounds();
        for reference in session.references().iter().filter(|_| self.fitted) {
            let at = self.place(&Row::new(0, &reference.evaluation));
            if at.iter().all(|part| part.is_finite()) {
                bounds.extend_with(&at.into());
            }
        }
        bounds
    }

    /// An empty plot with the axes.
    fn plot<'a>(&self) -> Plot<'a> {
        let [x_axis, y_axis] = self.axes;
        let mut plot = Plot::new("scatter")
            .x_axis_label(x_axis.title())
            .y_axis_label(y_axis.title())
            .allow_scroll(false)
            .allow_drag(self.tool == DragTool::Pan)
            .allow_double_click_reset(false)
            .show_crosshair(false)
            .cursor_color(Color32::TRANSPARENT)
            .x_axis_formatter(move |mark, _| tick(x_axis, mark))
            .y_axis_formatter(move |mark, _| tick(y_axis, mark));
        if x_axis.log {
            plot = plot.x_grid_spacer(decades);
        }
        if y_axis.log {
            plot = plot.y_grid_spacer(decades);
        }
        plot
    }

    fn draw_cloud(&mut self, ui: &Ui, session: &Session, transform: &PlotTransform, dark: bool) {
        let (frame, bounds) = (transform.frame(), transform.bounds());
        let pixels = ui.pixels_per_point().min(2.0);
        let view = View {
            size: [frame.width(), frame.height()].map(|points| (points * pixels).round().clamp(16.0, 2048.0) as usize),
            low: bounds.min(),
            high: bounds.max(),
            scale: self.scale,
            style: Style {
                axes: self.axes,
                coloring: self.coloring,
                era: session.era(),
                filter: session.document().filter.to_text(),
                dark,
            },
        };
        let prepared = session.document().filter.prepare(session.store());
        if !self.cloud.advance(ui.ctx(), session.store(), &prepared, &view, BUDGET) {
            ui.ctx().request_repaint();
        }
    }

    /// Draws an arrow in the direction in which both quantities improve.
    fn arrows(&self, ui: &Ui, frame: Rect) {
        let way = |quantity: Column| match quantity.better() {
            Some(Better::Lower) => -1.0,
            Some(Better::Higher) => 1.0,
            None => 0.0,
        };
        let vector = Vec2::new(way(self.axes[0].quantity), -way(self.axes[1].quantity));
        if vector == Vec2::ZERO {
            return;
        }
        let centre = frame.left_top() + Vec2::new(34.0, 34.0);
        let painter = ui.painter_at(frame);
        let stroke = Stroke::new(2.0, theme::good(ui));
        painter.arrow(centre - 12.0 * vector.normalized(), 24.0 * vector.normalized(), stroke);
        painter.text(
            centre + Vec2::new(20.0, 0.0),
            Align2::LEFT_CENTER,
            "better",
            egui::FontId::proportional(12.0),
            theme::good(ui),
        );
    }
}

/// Returns the columns of the objectives of the study.
pub fn objective_columns(session: &Session) -> Vec<Column> {
    let objectives = session.study().objectives().into_iter();
    objectives
        .map(|objective| Column::Quantity(objective.quantity))
        .collect()
}

/// Returns the axes that show objectives: the first two, and the base radius where there are fewer.
fn axes_of(objectives: &[Column]) -> [ScatterAxis; 2] {
    [0, 1].map(|place| {
        let base = Column::Dimension(DesignVariable::BaseRadius);
        ScatterAxis::usual(objectives.get(place).copied().unwrap_or(base))
    })
}
