//! The obstacles of the study being edited in the plan view: their outlines, and the mouse that moves them.

use egui::{CursorIcon, Painter, Response, Shape, Stroke, Ui};
use glam::DVec2;

use super::plan::Plan;
use crate::{Session, theme};
use kinefront_model::clearance::ObstacleShape;

/// Places are rounded to millimetres.
const PER_METRE: f64 = 1e3;

/// The obstacle that the mouse holds.
#[derive(Debug, Default)]
pub(super) struct ObstacleDrag {
    /// Its place in the study, and the offset of its centre from the pointer \[m\].
    held: Option<(usize, DVec2)>,
}

impl ObstacleDrag {
    /// Moves an obstacle that the mouse holds; returns whether it holds one.
    pub fn follow(&mut self, response: &Response, session: &mut Session, plan: &Plan) -> bool {
        let Some(pointer) = response.interact_pointer_pos() else {
            self.held = None;
            return false;
        };
        let at = plan.world(pointer);
        if response.drag_started() {
            let pressed = plan.pressed(response);
            self.held = under(session, pressed).map(|place| {
                let centre = DVec2::from_array(session.editor().study().obstacles[place].centre_m);
                (place, centre - pressed)
            });
        }
        let Some((place, offset)) = self.held else { return false };
        if response.dragged() {
            let centre = (at + offset)
                .to_array()
                .map(|part| (PER_METRE * part).round() / PER_METRE);
            session.editor_mut().change(|study| {
                if let Some(obstacle) = study.obstacles.get_mut(place) {
                    obstacle.centre_m = centre;
                }
            });
        }
        true
    }

    /// Draws the outlines over the plan, and says what the mouse can do with the one under it.
    pub fn paint(&self, ui: &Ui, response: &Response, painter: &Painter, plan: &Plan, session: &Session) {
        let stroke = Stroke::new(1.4, theme::active(ui));
        for (_, shape) in shapes(session) {
            match shape {
                ObstacleShape::Disc { centre, radius } => {
                    painter.circle_stroke(plan.screen(centre), (radius * plan.scale) as f32, stroke);
                }
                ObstacleShape::Polygon(polygon) => {
                    let corners = polygon.corners().iter().map(|corner| plan.screen(*corner));
                    painter.add(Shape::closed_line(corners.collect(), stroke));
                }
            }
        }
        let hovered = response
            .hover_pos()
            .and_then(|pointer| under(session, plan.world(pointer)));
        if self.held.is_some() {
            ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
        } else if let Some(place) = hovered {
            ui.ctx().set_cursor_icon(CursorIcon::Grab);
            let name = &session.editor().study().obstacles[place].name;
            let words = format!("{name}: drag to move it in the study; the next run keeps clear of it there");
            response.clone().on_hover_text_at_pointer(words);
        }
    }
}

/// Returns the obstacles that are stated well, with their places in the study.
fn shapes(session: &Session) -> impl Iterator<Item = (usize, ObstacleShape)> {
    let obstacles = session.editor().study().obstacles.iter().enumerate();
    obstacles.filter_map(|(place, section)| Some((place, section.obstacle().ok()?.shape)))
}

/// Returns the place of the obstacle under a point.
fn under(session: &Session, at: DVec2) -> Option<usize> {
    let holds = |shape: &ObstacleShape| match shape {
        ObstacleShape::Disc { centre, radius } => centre.distance(at) <= *radius,
        ObstacleShape::Polygon(polygon) => polygon.contains(at),
    };
    shapes(session).find(|(_, shape)| holds(shape)).map(|(place, _)| place)
}
