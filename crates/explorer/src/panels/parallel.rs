//! Parallel coordinates of variables, objectives and margins, with a brush on every axis.

use kinefront_model::evaluation::Better;
use kinefront_study::{Column, Study};
use std::sync::Arc;

use egui::{
    Align2, Color32, FontId, Mesh, Painter, Pos2, Rect, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo, WidgetType,
};

use super::{range, say_empty};
use crate::{Session, theme};
use kinefront_model::evaluation::{Constraint, Model};
use kinefront_model::mechanism::DESIGN_VARIABLES;

/// Largest number of designs drawn besides the front, sampled evenly: more lines could not be told apart.
const SAMPLE: usize = 800;

/// The panel with parallel coordinates.
#[derive(Default)]
pub struct ParallelPanel {
    /// Index of the axis being brushed, and the value at which the brush began.
    brushing: Option<(usize, f64)>,
    /// The lines that were drawn last, and the state that they show.
    drawn: Option<(Drawn, Arc<Mesh>)>,
    ranges: Vec<[f64; 2]>,
}

/// State that the lines depend on.
#[derive(PartialEq)]
struct Drawn {
    rect: Rect,
    era: u64,
    /// Number of designs, rounded down to a power of two: during a run, the lines are rebuilt only when it doubles.
    count: usize,
    front: Vec<usize>,
    filter: String,
    dark: bool,
}

fn axes(study: &Study, model: &Model) -> Vec<Column> {
    let mut axes: Vec<Column> = DESIGN_VARIABLES.map(Column::Dimension).to_vec();
    axes.extend(study.bounds.further_variables().map(Column::Dimension));
    axes.extend(study.shown_quantities().into_iter().map(Column::Quantity));
    axes.extend(
        Constraint::required(&model.settings().thresholds)
            .filter(|&constraint| constraint != Constraint::DeterminantSign)
            .map(Column::Margin),
    );
    axes
}

impl ParallelPanel {
    /// Draws the panel.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        ui.horizontal_wrapped(|ui| {
            ui.weak("drag along an axis to set its range, click the axis to clear it");
            if ui.button("Clear all ranges").clicked() {
                session.edit(|document| document.filter.ranges.clear());
            }
            if ui.button("Copy filter").clicked() {
                ui.ctx().copy_text(session.document().filter.to_text());
            }
        });
        let axes = axes(session.study(), session.model());
        let (rect, response) = ui.allocate_exact_size(
            ui.available_size().max(Vec2::new(300.0, 120.0)),
            Sense::click_and_drag(),
        );
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Image, true, "Parallel coordinates"));
        let plot = Rect::from_min_max(rect.min + Vec2::new(34.0, 40.0), rect.max - Vec2::new(34.0, 18.0));
        self.lines(ui, session, &axes, plot);
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 4.0, theme::ground(ui.visuals().dark_mode));
        if let Some((_, mesh)) = &self.drawn {
            painter.add(Shape::Mesh(Arc::clone(mesh)));
        }
        if session.store().is_empty() {
            let words = "The designs of a run appear here, each as a line: start a run in the panel Run, or open one.";
            say_empty(ui, &painter, plot.center(), words);
        }
        self.selected_line(&painter, session, &axes, plot);
        for index in 0..axes.len() {
            self.axis(ui, &painter, session, &axes, index, plot);
        }
        self.brush(&response, session, &axes, plot);
    }

    /// Draws the line of the selected design.
    fn selected_line(&self, painter: &Painter, session: &Session, axes: &[Column], plot: Rect) {
        let Some(known) = session.known() else { return };
        let row = crate::Row::new(0, &known.evaluation);
        let point = |(index, axis): (usize, &Column)| {
            let value = row.number(*axis).unwrap_or(f64::NAN);
            Pos2::new(left_of(index, axes, plot), self.height(index, *axis, value, plot))
        };
        let color = if session.is_modified() {
            theme::modified(painter.ctx().theme() == egui::Theme::Dark)
        } else {
            theme::SELECTED
        };
        painter.line(axes.iter().enumerate().map(point).collect(), Stroke::new(2.2, color));
    }

    /// Draws an axis with its title, its ends, and the range of the filter.
    fn axis(&self, ui: &Ui, painter: &Painter, session: &Session, axes: &[Column], index: usize, plot: Rect) {
        let (axis, x) = (axes[index], left_of(index, axes, plot));
        let (ink, weak) = (theme::ink(ui), ui.visuals().weak_text_color());
        painter.vline(x, plot.y_range(), Stroke::new(1.0, ink.gamma_multiply(0.7)));
        let better = match axis.better() {
            Some(Better::Higher) => " ▲",
            Some(Better::Lower) => " ▼",
            None => "",
        };
        let text = |y: f32, align: Align2, text: String, size: f32, color: Color32| {
            painter.text(Pos2::new(x, y), align, text, FontId::proportional(size), color);
        };
        let title = format!("{}{better}", axis.short());
        text(plot.top() - 36.0, Align2::CENTER_TOP, title, 12.0, ink);
        let [low, high] = self.range_of(index);
        text(plot.top() - 3.0, Align2::CENTER_BOTTOM, theme::number(high), 12.0, weak);
        text(plot.bottom() + 3.0, Align2::CENTER_TOP, theme::number(low), 12.0, weak);
        if let Some([from, to]) = session.document().filter.range(axis) {
            let (top, bottom) = (self.height(index, axis, to, plot), self.height(index, axis, from, plot));
            let brush = Rect::from_min_max(Pos2::new(x - 6.0, top), Pos2::new(x + 6.0, bottom));
            painter.rect_filled(brush, 2.0, theme::active(ui).gamma_multiply(0.45));
            painter.rect_stroke(
                brush,
                2.0,
                Stroke::new(1.0, theme::active(ui)),
                egui::StrokeKind::Middle,
            );
        }
    }

    /// Returns the range that an axis shows.
    fn range_of(&self, index: usize) -> [f64; 2] {
        self.ranges.get(index).copied().unwrap_or([0.0, 1.0])
    }

    /// Returns the vertical screen coordinate of a value on an axis.
    fn height(&self, index: usize, axis: Column, value: f64, plot: Rect) -> f32 {
        let [low, high] = self.range_of(index);
        let scale = |value: f64| {
            if axis.is_logarithmic() {
                value.max(1e-9).log10()
            } else {
                value
            }
        };
        let fraction = (scale(value) - scale(low)) / (scale(high) - scale(low)).max(1e-12);
        plot.bottom() - plot.height() * fraction.clamp(-0.02, 1.02) as f32
    }

    /// Returns the value at a vertical screen coordinate of an axis.
    fn value(&self, index: usize, axis: Column, y: f32, plot: Rect) -> f64 {
        let [low, high] = self.range_of(index);
        let fraction = f64::from(((plot.bottom() - y) / plot.height()).clamp(0.0, 1.0));
        if axis.is_logarithmic() {
            let (low, high) = (low.max(1e-9).log10(), high.max(1e-9).log10());
            10f64.powf(low + fraction * (high - low))
        } else {
            low + fraction * (high - low)
        }
    }

    fn brush(&mut self, response: &egui::Response, session: &mut Session, axes: &[Column], plot: Rect) {
        let Some(pointer) = response.interact_pointer_pos() else {
            self.brushing = None;
            return;
        };
        let spacing = plot.width() / (axes.len() - 1) as f32;
        let nearest = ((pointer.x - plot.left()) / spacing)
            .round()
            .clamp(0.0, (axes.len() - 1) as f32) as usize;
        if response.clicked() {
            session.edit(|document| document.filter.set_range(axes[nearest], None));
        }
        if response.drag_started() {
            let origin = response
                .ctx
                .input(|input| input.pointer.press_origin())
                .unwrap_or(pointer);
            self.brushing = Some((nearest, self.value(nearest, axes[nearest], origin.y, plot)));
        }
        if let (true, Some((index, from))) = (response.dragged(), self.brushing) {
            let to = self.value(index, axes[index], pointer.y, plot);
            session.drag("brush", |document| {
                document.filter.set_range(axes[index], Some([from, to]))
            });
        }
    }

    fn lines(&mut self, ui: &Ui, session: &Session, axes: &[Column], plot: Rect) {
        let store = session.store();
        let dark = ui.visuals().dark_mode;
        // The sample changes only when the number of designs has doubled.
        let drawn = Drawn {
            rect: plot,
            era: session.era(),
            count: store.len().checked_ilog2().map_or(0, |bits| 1 << bits),
            front: session.front().iter().map(|entry| entry.id).collect(),
            filter: session.document().filter.to_text(),
            dark,
        };
        if self.drawn.as_ref().is_some_and(|(before, _)| *before == drawn) {
            return;
        }
        let every = drawn.count.div_ceil(SAMPLE).max(1);
        let sample: Vec<usize> = (0..drawn.count)
            .step_by(every)
            .filter(|&id| store.is_feasible(id))
            .collect();
        self.ranges = axes.iter().map(|axis| range_on(*axis, session, &sample)).collect();
        let mesh = self.mesh(session, axes, &sample, plot, dark);
        self.drawn = Some((drawn, Arc::new(mesh)));
    }

    /// Draws a line for each sampled design and for each design of the front.
    fn mesh(&self, session: &Session, axes: &[Column], sample: &[usize], plot: Rect, dark: bool) -> Mesh {
        let store = session.store();
        let prepared = session.document().filter.prepare(store);
        let ground = theme::ground(dark);
        let mut mesh = Mesh::default();
        let mut line = |values: &dyn Fn(Column) -> f64, color: Color32, width: f32| {
            let mut before: Option<Pos2> = None;
            for (index, axis) in axes.iter().enumerate() {
                let height = self.height(index, *axis, values(*axis), plot);
                let at = Pos2::new(left_of(index, axes, plot), height);
                if let Some(from) = before {
                    segment(&mut mesh, from, at, width, color);
                }
                before = Some(at);
            }
        };
        // Dimmed designs are drawn first and the front last, so that it is on top.
        for passes in [false, true] {
            for &id in sample.iter().filter(|&&id| prepared.passes(id) == passes) {
                let color = theme::architecture(store.architecture(id), dark);
                let fraction = if passes { 0.3 } else { 0.07 };
                line(&|axis| store.column(axis)[id], theme::mix(color, ground, fraction), 0.7);
            }
        }
        for passes in [false, true] {
            let front = session.front().iter();
            for entry in front.filter(|entry| prepared.passes_entry(entry) == passes) {
                let color = theme::architecture(entry.row.design.architecture(), dark);
                let fraction = if passes { 0.7 } else { 0.15 };
                let value = |axis| entry.row.number(axis).unwrap_or(f64::NAN);
                line(&value, theme::mix(color, ground, fraction), 1.3);
            }
        }
        mesh
    }
}

/// Horizontal screen coordinate of an axis.
fn left_of(index: usize, axes: &[Column], plot: Rect) -> f32 {
    plot.left() + plot.width() * index as f32 / (axes.len() - 1) as f32
}

/// Range of an axis: that of the sampled designs and the front, or the bounds of a variable.
fn range_on(axis: Column, session: &Session, sample: &[usize]) -> [f64; 2] {
    let column = session.store().column(axis);
    let front = session.front().iter().filter_map(|entry| entry.row.number(axis));
    let values = sample.iter().map(|&id| column[id]).chain(front);
    let found = range(values.filter(|value| value.is_finite()));
    let [low, high] = match axis {
        Column::Dimension(variable) => session.study().range(variable),
        // Margins have no upper bound, and those near 0 matter most.
        Column::Margin(_) => [found[0].min(0.0), found[1].clamp(0.1, 10.0)],
        _ => found,
    };
    if low < high {
        [low, high]
    } else {
        [low.min(0.0), low.max(0.0) + 1.0]
    }
}

/// Adds a line to a mesh: one mesh holds thousands of lines, which are built once and not in every frame.
fn segment(mesh: &mut Mesh, from: Pos2, to: Pos2, width: f32, color: Color32) {
    let along = (to - from).normalized();
    let across = Vec2::new(-along.y, along.x) * (0.5 * width);
    let first = mesh.vertices.len() as u32;
    for corner in [from - across, from + across, to + across, to - across] {
        mesh.colored_vertex(corner, color);
    }
    mesh.add_triangle(first, first + 1, first + 2);
    mesh.add_triangle(first, first + 2, first + 3);
}
