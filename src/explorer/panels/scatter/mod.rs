//! The scatter: a plot of any two quantities of the designs, by default `R_w` over mass.

mod axis;
mod cloud;
mod marks;

use crate::study::Column;
use crate::text;
use kinefront_model::evaluation::Better;
use kinefront_model::mechanism::DesignVariable;
use std::time::Duration;

use egui::{Align2, Color32, ComboBox, Pos2, Response, Stroke, Ui, Vec2, WidgetInfo, WidgetType};
use egui_plot::{Plot, PlotBounds, PlotImage, PlotPoint, PlotTransform};

use self::axis::{Extent, decades, tick};
pub use self::axis::{ScatterAxis, axes};
use self::cloud::{Cloud, Style, View};
use crate::explorer::{Row, Session, theme};

/// Time that a frame may spend on drawing the cloud.
const BUDGET: Duration = Duration::from_millis(4);

/// The scatter with its axes and view.
pub struct Scatter {
    axes: [ScatterAxis; 2],
    cloud: Cloud,
    extent: Extent,
    /// Whether the view is fitted to the designs in every frame.
    fitted: bool,
    transform: Option<PlotTransform>,
    /// Columns of the objectives that the axes last followed.
    followed: Option<Vec<Column>>,
}

impl Default for Scatter {
    fn default() -> Self {
        Self::new([
            ScatterAxis {
                quantity: Column::Mass,
                log: true,
            },
            ScatterAxis {
                quantity: Column::WorkspaceRadius,
                log: false,
            },
        ])
    }
}

impl Scatter {
    /// Creates a scatter with the given axes.
    pub fn new(axes: [ScatterAxis; 2]) -> Self {
        Self {
            axes,
            cloud: Cloud::default(),
            extent: Extent::default(),
            fitted: true,
            transform: None,
            followed: None,
        }
    }

    /// Returns the axes.
    pub fn axes(&self) -> [ScatterAxis; 2] {
        self.axes
    }

    /// Returns the position of a design on screen in the last frame.
    pub fn screen_position(&self, row: &Row) -> Option<Pos2> {
        let [x, y] = self.place(row);
        Some(self.transform?.position_from_point(&PlotPoint::new(x, y)))
    }

    fn place(&self, row: &Row) -> [f64; 2] {
        self.axes
            .map(|axis| axis.place(row.number(axis.quantity).unwrap_or(f64::NAN)))
    }

    /// Draws the panel.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        self.follow_objectives(session);
        self.controls(ui, session);
        let bounds = self.bounds(session);
        let dark = ui.visuals().dark_mode;
        let (lines, marks) = self.front(session, dark);
        let (fitted, cloud) = (self.fitted, &self.cloud);
        let shown = self.plot().show(ui, |plot| {
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
        shown
            .response
            .widget_info(|| WidgetInfo::labeled(WidgetType::Image, true, "Scatter of designs"));
        self.pointed(&shown.response, session);
        self.draw_cloud(ui, session, dark);
        self.arrows(ui);
    }

    /// Shows the objectives of the study when they are other ones than before.
    fn follow_objectives(&mut self, session: &Session) {
        let objectives = session.study().objectives().into_iter();
        let columns: Vec<Column> = objectives
            .map(|objective| Column::of_quantity(objective.quantity))
            .collect();
        let before = self.followed.replace(columns.clone());
        let is_paper = columns == [Column::Mass, Column::WorkspaceRadius];
        if before.as_ref() == Some(&columns) || (before.is_none() && is_paper) {
            return;
        }
        let base = Column::Dimension(DesignVariable::BaseRadius);
        let [x, y] = [0, 1].map(|k| columns.get(k).copied().unwrap_or(base));
        self.axes = [x, y].map(|quantity| ScatterAxis {
            quantity,
            log: quantity.is_logarithmic(),
        });
        self.fitted = true;
    }

    /// Bounds that hold every feasible design and every reference design.
    fn bounds(&mut self, session: &Session) -> PlotBounds {
        self.extent.update(self.axes, session.era(), session.store());
        let mut bounds = self.extent.bounds();
        for reference in session.references().iter().filter(|_| self.fitted) {
            let [x, y] = self.place(&Row::new(0, &reference.evaluation));
            if x.is_finite() && y.is_finite() {
                bounds.extend_with(&PlotPoint::new(x, y));
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
        if response.dragged() || response.drag_stopped() || scrolled {
            self.fitted = false;
        }
        if response.double_clicked() {
            self.fitted = true;
        }
    }

    fn controls(&mut self, ui: &mut Ui, session: &mut Session) {
        ui.horizontal_wrapped(|ui| {
            for (k, name) in ["x", "y"].into_iter().enumerate() {
                let axis = &mut self.axes[k];
                let before = *axis;
                ui.label(name);
                ComboBox::from_id_salt(("axis", k))
                    .selected_text(axis.quantity.title())
                    .width(130.0)
                    .show_ui(ui, |ui| {
                        for quantity in Column::quantities(session.study().named_quantities()) {
                            if ui
                                .selectable_label(axis.quantity == quantity, quantity.title())
                                .clicked()
                            {
                                *axis = ScatterAxis {
                                    quantity,
                                    log: quantity.is_logarithmic(),
                                };
                            }
                        }
                    });
                let log = ui.checkbox(&mut axis.log, "log");
                log.widget_info(|| {
                    WidgetInfo::selected(WidgetType::Checkbox, true, axis.log, format!("{name} logarithmic"))
                });
                if before != *axis {
                    self.fitted = true;
                }
            }
            if ui
                .button("Fit")
                .on_hover_text("fit the view to the feasible designs (or double-click)")
                .clicked()
            {
                self.fitted = true;
            }
            if let Some(third) = Self::third_objective(session) {
                ui.weak(format!("colour: {}, dark is small", third.title()));
            }
            ui.separator();
            let dark = ui.visuals().dark_mode;
            for &architecture in &session.study().architectures.clone() {
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
                    session.history.edit(|document| {
                        let hidden = &mut document.filter.hidden;
                        match hidden.iter().position(|&other| other == architecture) {
                            Some(place) => drop(hidden.remove(place)),
                            None => hidden.push(architecture),
                        }
                    });
                }
            }
        });
    }

    /// Shows the values of the design under the pointer, and selects the design when it is clicked.
    fn pointed(&self, response: &Response, session: &mut Session) {
        let Some((pointer, transform)) = response.hover_pos().zip(self.transform) else {
            return;
        };
        let near = |row: &Row| {
            let [x, y] = self.place(row);
            transform.position_from_point(&PlotPoint::new(x, y)).distance(pointer)
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
            let text = format!(
                "{}\nmodel: {} kg, R_w {} m{}",
                reference.name,
                theme::number(reference.evaluation.mass),
                theme::number(reference.evaluation.workspace_radius),
                reference.stated.map_or(String::new(), |[mass, radius]| format!(
                    "\nstated: {mass} kg, R_w {radius} m"
                )),
            );
            response.clone().on_hover_text_at_pointer(text);
            if response.clicked() {
                session.select_design(crate::explorer::Selected {
                    design,
                    origin: crate::explorer::Origin::Reference(index),
                });
            }
            return;
        }
        let place = transform.value_from_position(pointer);
        let Some(id) = on_front.or_else(|| self.cloud.at([place.x, place.y], 6)) else {
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
            style: Style {
                axes: self.axes.map(|axis| (axis.quantity, axis.log)),
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

/// Shows the values of a design.
pub fn hover(ui: &mut Ui, id: usize, row: &Row, session: &Session) {
    let verified = session
        .place_on_front(id)
        .is_some_and(|place| session.front()[place].verified);
    let grid = if verified { "fine grid" } else { "reference grid" };
    ui.strong(format!("#{id}  {}", row.design.architecture));
    ui.label(format!(
        "{} kg, R_w {} m ({grid})",
        theme::number(row.mass),
        theme::number(row.radius)
    ));
    let [base, platform, link, leg, bar] = row.design.values();
    ui.label(format!("R {base:.3}  r {platform:.3}  L_b {link:.3} m"));
    ui.label(format!("r_j {:.1}  r_p {:.1} mm", 1e3 * leg, 1e3 * bar));
    if row.radius == 0.0 {
        ui.colored_label(theme::bad(ui), "infeasible");
    }
    if let Some(note) = session.document().notes.get(&id) {
        ui.label(egui::RichText::new(note).italics());
    }
}
