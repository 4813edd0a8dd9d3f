//! The scatter: a plot of any two quantities of the designs, by default the first two objectives.

mod axis;
mod cloud;
mod coloring;
mod enclosing;
mod marks;

use kinefront_model::evaluation::Better;
use kinefront_model::mechanism::{Architecture, DesignVariable};
use kinefront_scene::text;
use kinefront_study::Column;
use std::sync::Arc;
use std::time::Duration;

use egui::{Align2, Color32, ComboBox, Pos2, Rect, Response, Stroke, Ui, Vec2, WidgetInfo, WidgetType};
use egui_plot::{Plot, PlotBounds, PlotImage, PlotPoint, PlotTransform};

use self::axis::{Extent, decades, tick};
pub use self::axis::{ScatterAxis, axes};
use self::cloud::{Cloud, Style, View};
pub use self::coloring::Coloring;
use self::coloring::{ColorLegend, ColorRange, ColorScale};
pub use self::enclosing::DragTool;
use self::enclosing::Enclosing;
use super::{button, named, range, say_empty};
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
        chips(ui, session);
        self.marked(ui, session);
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
        self.draw_cloud(ui, session, dark);
        self.arrows(ui);
        let frame = *shown.transform.frame();
        if session.store().is_empty() {
            let words = "Designs appear here as they are evaluated:\nstart a run in the panel Run, or open one.";
            say_empty(ui, &ui.painter_at(frame), frame.center(), words);
        }
        self.legend(ui, frame, dark);
    }

    /// Tells how many designs are marked, and what can be done with them.
    fn marked(&mut self, ui: &mut Ui, session: &mut Session) {
        let marked = Arc::clone(&session.document().marked);
        if marked.is_empty() {
            return;
        }
        let front = session.front_number();
        let is_counted =
            |counted: &(Arc<Vec<usize>>, u64, MarkedCounts)| Arc::ptr_eq(&counted.0, &marked) && counted.1 == front;
        if !self.counted.as_ref().is_some_and(is_counted) {
            self.counted = Some((Arc::clone(&marked), front, session.count_marked()));
        }
        let Some((_, _, counts)) = &self.counted else { return };
        ui.horizontal_wrapped(|ui| {
            ui.strong(format!("{} marked", counts.all));
            let of = counts.of.iter().filter(|(_, count)| *count > 0);
            let of: Vec<String> = of
                .map(|(found, count)| format!("{} {count}", text::architecture(*found)))
                .collect();
            ui.label(format!(
                "{} feasible, {} on the front; {}",
                counts.feasible,
                counts.on_front,
                of.join(", ")
            ));
            let hint = "filters to the ranges of the marked designs on both axes";
            if button(ui, "Filter", hint) {
                self.filter_to_marked(session);
            }
            if button(ui, "Unmark", "clears all marks") {
                session.mark(Arc::default());
            }
        });
    }

    /// Sets the filter to the ranges of the marked designs on both axes.
    fn filter_to_marked(&self, session: &mut Session) {
        let of_axis = |axis: &ScatterAxis| {
            let ids = session.document().marked.iter();
            let values = ids.filter_map(|&id| session.number(id, axis.quantity));
            (axis.quantity, range(values))
        };
        let ranges = self.axes.each_ref().map(of_axis);
        session.edit(|document| {
            for (quantity, [low, high]) in ranges.into_iter().filter(|(_, [low, high])| low <= high) {
                document.filter.set_range(quantity, Some([low, high]));
            }
        });
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

    /// Keeps the bounds where the user moves them; a double click fits them to the designs again.
    fn follow_pointer(&mut self, ui: &Ui, response: &egui::Response) {
        let scrolled = ui.input(|input| input.smooth_scroll_delta().y != 0.0) && response.hovered();
        let is_moved = response.dragged() || response.drag_stopped();
        if (is_moved && self.tool == DragTool::Pan) || scrolled {
            self.fitted = false;
        }
        if response.double_clicked() {
            self.fitted = true;
        }
    }

    fn controls(&mut self, ui: &mut Ui, session: &mut Session) {
        // A row that is wider than the panel would widen the plot as well.
        let width = ui.available_width();
        ui.horizontal_wrapped(|ui| {
            self.axis_field(ui, session, 0, "x");
            if width < 465.0 {
                ui.end_row();
            }
            self.axis_field(ui, session, 1, "y");
            if button(ui, "Fit", "fits the view to the feasible designs (or double-click)") {
                self.fitted = true;
            }
        });
        ui.horizontal_wrapped(|ui| {
            self.coloring.ui(ui, session.study().named_quantities());
            if width < 350.0 {
                ui.end_row();
            } else {
                ui.separator();
            }
            self.tool.ui(ui);
        });
        ui.horizontal_wrapped(|ui| {
            for architecture in session.study().architectures.clone() {
                include(ui, session, architecture);
            }
        });
    }

    /// Shows the fields of an axis.
    fn axis_field(&mut self, ui: &mut Ui, session: &Session, k: usize, name: &str) {
        let axis = &mut self.axes[k];
        let before = *axis;
        let label = ui.label(name);
        ComboBox::from_id_salt(("axis", k))
            .selected_text(axis.quantity.title())
            .width(130.0)
            .show_ui(ui, |ui| {
                for quantity in Column::quantities(session.study().named_quantities()) {
                    if ui
                        .selectable_label(axis.quantity == quantity, quantity.title())
                        .clicked()
                    {
                        *axis = ScatterAxis::usual(quantity);
                    }
                }
            })
            .response
            .labelled_by(label.id);
        let log = ui.checkbox(&mut axis.log, "log");
        log.widget_info(|| WidgetInfo::selected(WidgetType::Checkbox, true, axis.log, format!("{name} logarithmic")));
        if before != *axis {
            self.fitted = true;
        }
    }

    /// Shows the values of the design under the pointer, and selects the design when it is clicked.
    fn pointed(&self, response: &Response, session: &mut Session) {
        let Some((pointer, transform)) = response.hover_pos().zip(self.transform) else {
            return;
        };
        if response.dragged() {
            return;
        }
        let near = |row: &Row| {
            let at = transform.position_from_point(&self.place(row).into());
            at.distance(pointer)
        };
        const REACH: f32 = 9.0;
        let reference = session
            .references()
            .iter()
            .position(|reference| near(&Row::new(0, &reference.evaluation)) < REACH);
        let on_front = session
            .front()
            .iter()
            .map(|entry| (near(&entry.row), entry.id))
            .filter(|(distance, _)| *distance < REACH)
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, id)| id);
        if let (Some(index), None) = (reference, on_front) {
            let reference = &session.references()[index];
            let design = reference.evaluation.design;
            let values = text::quantities(session.study().shown_quantities(), &reference.evaluation.quantities);
            let stated = reference
                .stated
                .iter()
                .map(|&(quantity, value)| text::quantity(quantity, value));
            let stated = stated.collect::<Vec<_>>().join(", ");
            let stated = if stated.is_empty() {
                stated
            } else {
                format!("\nstated: {stated}")
            };
            let words = format!("{}\nmodel: {values}{stated}", reference.name);
            response.clone().on_hover_text_at_pointer(words);
            if response.clicked() {
                session.select_design(crate::Selected {
                    design,
                    origin: crate::DesignOrigin::Reference(index),
                });
            }
            return;
        }
        let place = transform.value_from_position(pointer);
        let wished = session.document().wished.iter();
        let wished = wished
            .map(|wished| Row::new(0, &wished.evaluation))
            .position(|row| near(&row) < REACH);
        if let Some(index) = wished.filter(|_| response.clicked()) {
            session.select_wished(index);
            return;
        }
        let Some(id) = on_front.or_else(|| self.cloud.at([place.x, place.y], 6)) else {
            if response.clicked() {
                self.ask_why([place.x, place.y], session);
            }
            return;
        };
        if let Some(row) = session.row(id) {
            response
                .clone()
                .on_hover_ui_at_pointer(|ui| hover(ui, id, &row, session));
        }
        if response.clicked() {
            session.select(id);
        }
    }

    /// Asks why there is no design at a place, if the axes are objectives.
    fn ask_why(&self, place: [f64; 2], session: &mut Session) {
        let values = self
            .axes
            .iter()
            .zip(place)
            .filter_map(|(axis, place)| match axis.quantity {
                Column::Quantity(quantity) => Some((quantity, axis.value(place))),
                _ => None,
            });
        let values: Vec<_> = values.collect();
        session.ask_why(&values);
    }

    fn draw_cloud(&mut self, ui: &Ui, session: &Session, dark: bool) {
        let Some(transform) = self.transform else {
            return;
        };
        let frame = transform.frame();
        let pixels = ui.pixels_per_point().min(2.0);
        let bounds = transform.bounds();
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
    fn arrows(&self, ui: &Ui) {
        let Some(transform) = self.transform else {
            return;
        };
        let way = |quantity: Column| match quantity.better() {
            Some(Better::Lower) => -1.0,
            Some(Better::Higher) => 1.0,
            None => 0.0,
        };
        let vector = Vec2::new(way(self.axes[0].quantity), -way(self.axes[1].quantity));
        if vector == Vec2::ZERO {
            return;
        }
        let frame = transform.frame();
        let centre = frame.left_top() + Vec2::new(34.0, 34.0);
        let painter = ui.painter_at(*frame);
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

/// Shows an architecture, with which the user excludes its designs or includes them again.
fn include(ui: &mut Ui, session: &mut Session, architecture: Architecture) {
    let dark = ui.visuals().dark_mode;
    let hidden = session.document().filter.hidden.contains(&architecture);
    let color = if hidden {
        theme::infeasible(dark)
    } else {
        theme::architecture(architecture, dark)
    };
    let mark = ["●", "■", "▲", "◆"][theme::index(architecture) % 4];
    let text = egui::RichText::new(format!("{mark} {}", text::architecture(architecture))).color(color);
    let text = if hidden { text.strikethrough() } else { text };
    let hover = "click to exclude this architecture (dimmed in all panels) or to include it again";
    let button = ui.add(egui::Button::new(text).frame(false)).on_hover_text(hover);
    let label = format!("include {architecture}");
    button.widget_info(|| WidgetInfo::selected(WidgetType::Checkbox, true, !hidden, label.clone()));
    if button.clicked() {
        session.edit(|document| {
            let hidden = &mut document.filter.hidden;
            match hidden.iter().position(|&other| other == architecture) {
                Some(place) => drop(hidden.remove(place)),
                None => hidden.push(architecture),
            }
        });
    }
}

/// Tells how many designs of the front pass the filter, with a button that removes each criterion.
fn chips(ui: &mut Ui, session: &mut Session) {
    let filter = session.document().filter.clone();
    if filter.is_empty() {
        return;
    }
    let mut kept = filter.clone();
    ui.horizontal_wrapped(|ui| {
        ui.strong(format!("{} of {} pass", session.passing().len(), session.front().len()));
        let chip = |ui: &mut Ui, words: &str, name: &str| {
            let button = ui.button(format!("{words}  ×"));
            named(button, &format!("Remove the filter: {name}")).clicked()
        };
        if filter.feasible_only && chip(ui, "feasible", "feasible only") {
            kept.feasible_only = false;
        }
        for (key, [low, high]) in &filter.ranges {
            let title = Column::find_quantity(key).map_or_else(|| key.clone(), |column| column.title());
            let words = format!("{title} {} … {}", theme::number(*low), theme::number(*high));
            if chip(ui, &words, &title) {
                kept.ranges.remove(key);
            }
        }
        if !filter.hidden.is_empty() {
            let names: Vec<String> = filter.hidden.iter().map(|hidden| text::architecture(*hidden)).collect();
            if chip(ui, &format!("without {}", names.join(", ")), "architectures") {
                kept.hidden.clear();
            }
        }
    });
    if kept != filter {
        session.edit(|document| document.filter = kept);
    }
}

/// Shows the values of a design.
pub fn hover(ui: &mut Ui, id: usize, row: &Row, session: &Session) {
    let verified = session
        .place_on_front(id)
        .is_some_and(|place| session.front()[place].verified);
    let grid = if verified { "fine grid" } else { "reference grid" };
    ui.strong(format!("#{id}  {}", row.design.architecture()));
    let values = text::quantities(session.study().shown_quantities(), &row.quantities);
    ui.label(format!("{values} ({grid})"));
    let [base, platform, link, leg, bar] = row.design.values();
    ui.label(format!("R {base:.3}  r {platform:.3}  L_b {link:.3} m"));
    ui.label(format!("r_j {:.1}  r_p {:.1} mm", 1e3 * leg, 1e3 * bar));
    if !row.is_feasible() {
        ui.colored_label(theme::bad(ui), "infeasible");
    }
    if let Some(note) = session.document().notes.get(&id) {
        ui.label(egui::RichText::new(note).italics());
    }
}
