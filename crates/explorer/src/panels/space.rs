//! The space panel: the designs in three quantities at once, by default the objectives, as points that can be turned and clicked.

use egui::{FontId, Pos2, Rect, Response, Sense, Stroke, Ui, Vec2, WidgetInfo, WidgetType};

use super::scatter::{ScatterAxis, objective_columns};
use super::{range, say_empty};
use crate::{Session, theme};
use kinefront_model::mechanism::DESIGN_VARIABLES;
use kinefront_study::{Column, Row};

/// Largest number of evaluated designs that are drawn behind the front.
const MOST_POINTS: usize = 4000;

/// Distance at which the pointer reaches a design \[points\].
const REACH: f32 = 9.0;

/// The panel with the three axes.
pub struct SpacePanel {
    /// Turn about the upright axis, and tilt towards the viewer \[rad\].
    view: [f32; 2],
}

impl Default for SpacePanel {
    fn default() -> Self {
        Self { view: [-0.6, 0.45] }
    }
}

/// An axis with the range of the front on it.
struct SpaceAxis {
    column: Column,
    low: f64,
    high: f64,
}

impl SpaceAxis {
    /// Place of a value on the axis, in \[−1, 1\] over the range.
    fn place(&self, value: f64) -> f64 {
        let [low, high, value] = [self.low, self.high, value].map(|value| ScatterAxis::usual(self.column).place(value));
        if high > low {
            2.0 * (value - low) / (high - low) - 1.0
        } else {
            0.0
        }
    }
}

/// The view onto the cube that the axes span.
struct Projection {
    centre: Pos2,
    scale: f32,
    view: [f32; 2],
}

impl Projection {
    fn screen(&self, [x, y, z]: [f64; 3]) -> Pos2 {
        let [x, y, z] = [x, y, z].map(|part| part as f32);
        let ((turn_sin, turn_cos), (tilt_sin, tilt_cos)) = (self.view[0].sin_cos(), self.view[1].sin_cos());
        let (right, away) = (turn_cos * x - turn_sin * y, turn_sin * x + turn_cos * y);
        self.centre + self.scale * Vec2::new(right, -(tilt_cos * z + tilt_sin * away))
    }
}

/// Returns the columns of the axes: the objectives, and dimensions where there are fewer than three.
fn columns(session: &Session) -> [Column; 3] {
    let objectives = objective_columns(session).into_iter();
    let mut columns = objectives.chain(DESIGN_VARIABLES.map(Column::Dimension));
    [(); 3].map(|()| columns.next().unwrap_or(Column::HomePhi))
}

impl SpacePanel {
    /// Draws the panel.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Image, true, "Designs in three quantities"));
        let drag = response.drag_delta();
        self.view[0] += 0.01 * drag.x;
        self.view[1] = (self.view[1] + 0.01 * drag.y).clamp(-1.5, 1.5);
        let painter = ui.painter_at(rect);
        if session.front().is_empty() {
            let words =
                "The designs of the front appear here once a run has found some. Drag to turn, click to select.";
            say_empty(ui, &painter, rect.center(), words);
            return;
        }
        let axes = columns(session).map(|column| axis(session, column));
        let projection = Projection {
            centre: rect.center(),
            scale: 0.27 * rect.size().min_elem(),
            view: self.view,
        };
        frame(ui, &painter, &projection);
        cloud(ui, &painter, &projection, &axes, session);
        let nearest = front(ui, &painter, &projection, &axes, session, &response, rect);
        titles(ui, &painter, &projection, &axes);
        if let Some(id) = nearest.filter(|_| response.clicked()) {
            session.select(id);
        }
    }
}

/// The axis of a column over the range of the front.
fn axis(session: &Session, column: Column) -> SpaceAxis {
    let values = session.front().iter().filter_map(|entry| entry.row.number(column));
    let [low, high] = range(values);
    SpaceAxis { column, low, high }
}

fn place(axes: &[SpaceAxis; 3], row: &Row) -> Option<[f64; 3]> {
    let at = |k: usize| row.number(axes[k].column).map(|value| axes[k].place(value));
    Some([at(0)?, at(1)?, at(2)?])
}

/// Draws the edges of the cube that meet at its first corner, and those of the faces that they span.
fn frame(ui: &Ui, painter: &egui::Painter, projection: &Projection) {
    let ink = ui.visuals().text_color();
    let weak = Stroke::new(1.0, ui.visuals().weak_text_color().gamma_multiply(0.5));
    let corner = |k: usize, end: f64| {
        let mut at = [-1.0; 3];
        at[k] = end;
        at
    };
    for k in 0..3 {
        let ends = [corner(k, -1.0), corner(k, 1.0)].map(|at| projection.screen(at));
        painter.line_segment(ends, Stroke::new(1.2, ink));
        // The opposite edges of both faces at the first corner.
        for other in (0..3).filter(|other| *other != k) {
            let mut from = corner(other, 1.0);
            let mut to = from;
            (from[k], to[k]) = (-1.0, 1.0);
            painter.line_segment([projection.screen(from), projection.screen(to)], weak);
        }
    }
}

/// Writes the titles of the axes with their ranges, over the points.
fn titles(ui: &Ui, painter: &egui::Painter, projection: &Projection, axes: &[SpaceAxis; 3]) {
    let ink = ui.visuals().strong_text_color();
    for (k, axis) in axes.iter().enumerate() {
        let range = format!("{} … {}", theme::number(axis.low), theme::number(axis.high));
        let log = if axis.column.is_logarithmic() { ", log" } else { "" };
        let text = format!("{}\n{range}{log}", axis.column.title());
        let mut beyond = [-1.0; 3];
        beyond[k] = 1.2;
        let galley = painter.layout_no_wrap(text, FontId::proportional(12.0), ink);
        let corner = projection.screen(beyond) - 0.5 * galley.size();
        let behind = Rect::from_min_size(corner, galley.size()).expand(2.0);
        painter.rect_filled(behind, 2.0, ui.visuals().panel_fill.gamma_multiply(0.7));
        painter.galley(corner, galley, ink);
    }
}

/// Draws feasible designs of the run as small points, of many a share.
fn cloud(ui: &Ui, painter: &egui::Painter, projection: &Projection, axes: &[SpaceAxis; 3], session: &Session) {
    let store = session.store();
    let color = theme::infeasible(ui.visuals().dark_mode);
    let step = store.len().div_ceil(MOST_POINTS).max(1);
    let columns = axes.each_ref().map(|axis| store.column(axis.column));
    for id in (0..store.len()).step_by(step).filter(|&id| store.is_feasible(id)) {
        let at: Option<Vec<f64>> = columns.iter().map(|column| column.get(id).copied()).collect();
        let Some([x, y, z]) = at.as_deref() else { continue };
        let at = [axes[0].place(*x), axes[1].place(*y), axes[2].place(*z)];
        // Designs far beyond the front are left out.
        if at.iter().all(|part| part.abs() < 1.6) {
            painter.circle_filled(projection.screen(at), 1.2, color);
        }
    }
}

/// Draws the designs of the front; returns the one that the pointer reaches, whose values are shown.
fn front(
    ui: &Ui,
    painter: &egui::Painter,
    projection: &Projection,
    axes: &[SpaceAxis; 3],
    session: &Session,
    response: &Response,
    rect: Rect,
) -> Option<usize> {
    let dark = ui.visuals().dark_mode;
    let pointer = response.hover_pos().filter(|pointer| rect.contains(*pointer));
    let filter = session.document().filter.prepare(session.store());
    let mut reached: Option<(f32, usize)> = None;
    for (place_on_front, entry) in session.front().iter().enumerate() {
        let Some(at) = place(axes, &entry.row).map(|at| projection.screen(at)) else {
            continue;
        };
        let color = theme::architecture(entry.row.design.architecture(), dark);
        let color = if filter.passes_entry(entry) {
            color
        } else {
            color.gamma_multiply(0.3)
        };
        painter.circle_filled(at, 3.5, color);
        let distance = pointer.map_or(f32::INFINITY, |pointer| pointer.distance(at));
        if distance < REACH && reached.is_none_or(|(nearest, _)| distance < nearest) {
            reached = Some((distance, place_on_front));
        }
    }
    if let Some(known) = session.known()
        && let Some(at) = place(axes, &Row::new(0, &known.evaluation))
    {
        painter.circle_stroke(projection.screen(at), 8.0, Stroke::new(2.0, theme::SELECTED));
    }
    let (_, place_on_front) = reached?;
    let entry = &session.front()[place_on_front];
    let values = axes.iter().filter_map(|axis| {
        let value = entry.row.number(axis.column)?;
        Some(format!("{}: {}", axis.column.title(), theme::number(value)))
    });
    let lines: Vec<String> = values.collect();
    let text = format!(
        "#{} {}\n{}",
        entry.id,
        entry.row.design.architecture(),
        lines.join("\n")
    );
    response.clone().on_hover_text_at_pointer(text);
    Some(entry.id)
}
