//! The accuracy panel: the errors of the pose that the tolerances of the study cause, and how much of them each source has.

use egui::{ScrollArea, Sense, Stroke, Ui, Vec2, WidgetInfo, WidgetType, vec2};
use kinefront_model::dynamics::{Accuracy, ErrorBudget};
use kinefront_scene::text::number;

use super::{fields, share_bar};
use crate::{Session, theme};

/// Height of the picture of the error.
const PICTURE: f32 = 130.0;

/// Number of corners of an ellipse.
const CORNERS: u32 = 72;

/// The accuracy panel.
#[derive(Default)]
pub struct AccuracyPanel;

impl AccuracyPanel {
    /// Draws the panel.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        if session.known().is_none() {
            ui.weak("Click a design in the scatter to see its pose errors here.");
            return;
        }
        let report = session.pose_dynamics().and_then(|known| known.report);
        ScrollArea::vertical().show(ui, |ui| {
            match report.map(|report| report.accuracy) {
                Some(accuracy) if accuracy.worst_orientation > 0.0 => found(ui, &accuracy),
                Some(_) => {
                    ui.label("Set tolerances to compute the pose errors:");
                }
                None => {
                    ui.colored_label(theme::bad(ui), "At a singular pose the errors are unlimited.");
                }
            }
            ui.separator();
            fields::of_sections(ui, session, &["tolerances"]);
        });
    }
}

/// Shows the errors at the pose.
fn found(ui: &mut Ui, accuracy: &Accuracy) {
    let position = |error: f64| format!("{} mm", number(1e3 * error));
    let orientation = |error: f64| format!("{}°", number(error.to_degrees()));
    ui.strong(format!(
        "position ±{}, RMS {}",
        position(accuracy.worst_position),
        position(accuracy.rms_position)
    ));
    ui.label(format!(
        "orientation ±{}, RMS {}",
        orientation(accuracy.worst_orientation),
        orientation(accuracy.rms_orientation)
    ));
    if accuracy.nonlinearity > 0.3 {
        ui.colored_label(
            theme::bad(ui),
            "This close to a singularity, these errors are not reliable: the platform may flip to another assembly mode.",
        );
    } else if accuracy.nonlinearity > 0.1 {
        ui.colored_label(
            theme::active(ui),
            "Near a singularity: the errors may be off by more than a tenth.",
        );
    }
    picture(ui, accuracy);
    budget(ui, "position", &accuracy.budget_position, &position);
    budget(ui, "orientation", &accuracy.budget_orientation, &orientation);
}

/// Draws the ellipse of the root mean square of the error of the position within the circle of the largest one.
fn picture(ui: &mut Ui, accuracy: &Accuracy) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), PICTURE), Sense::hover());
    let [xx, yy, xy] = accuracy.covariance;
    let angle = 0.5 * libm::atan2(2.0 * xy, xx - yy);
    let words = format!("Error ellipse, its long axis at {:.0}° from x", angle.to_degrees());
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Image, true, words.as_str()));
    let painter = ui.painter_at(rect);
    let scale = 0.46 * f64::from(PICTURE) / accuracy.worst_position.max(f64::MIN_POSITIVE);
    let centre = rect.center();
    painter.circle_stroke(
        centre,
        (scale * accuracy.worst_position) as f32,
        Stroke::new(1.0, theme::ink(ui).gamma_multiply(0.5)),
    );
    let half = 0.5 * (xx + yy);
    let apart = (0.25 * (xx - yy) * (xx - yy) + xy * xy).sqrt();
    let [long, short] = [half + apart, half - apart].map(|variance| scale * variance.max(0.0).sqrt());
    let (sine, cosine) = libm::sincos(angle);
    let corner = |k: u32| {
        let (along, across) = libm::sincos(2.0 * std::f64::consts::PI * f64::from(k) / f64::from(CORNERS));
        let (along, across) = (long * along, short * across);
        // The vertical axis of the screen points down.
        centre
            + vec2(
                (cosine * along - sine * across) as f32,
                -(sine * along + cosine * across) as f32,
            )
    };
    let outline = (0..CORNERS).map(corner).collect();
    painter.add(egui::Shape::convex_polygon(
        outline,
        theme::good(ui).gamma_multiply(0.25),
        Stroke::new(1.5, theme::good(ui)),
    ));
    for axis in [Vec2::X, Vec2::Y] {
        let arm = axis * (0.5 * PICTURE);
        painter.line_segment(
            [centre - arm, centre + arm],
            Stroke::new(0.5, theme::ink(ui).gamma_multiply(0.4)),
        );
    }
    response.on_hover_text("green: RMS position error in x and y; circle: largest position error");
}

/// Shows the parts of an error as bars.
fn budget(ui: &mut Ui, what: &str, budget: &ErrorBudget, words: &dyn Fn(f64) -> String) {
    let parts = budget.parts();
    let all: f64 = parts.iter().map(|(_, part)| part).sum();
    if all <= 0.0 {
        return;
    }
    ui.add_space(4.0);
    ui.label(format!("largest {what} error, by source"));
    for (name, part) in parts.into_iter().filter(|(_, part)| *part > 0.0) {
        let share = (part / all) as f32;
        let text = format!("{name}: {}, {:.0} %", words(part), 100.0 * share);
        share_bar(ui, share, &text, theme::active(ui));
    }
}
