//! The manipulator seen from above: conversion to screen coordinates, drawing, and the member under the pointer.

use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Response, Shape, Stroke, Ui, Vec2};
use glam::{DVec2, DVec3};

use crate::pointing::describe_member;
use crate::theme;
use kinefront_model::evaluation::{Evaluation, MemberReport, Model};
use kinefront_model::mechanism::Design;
use kinefront_model::spatial::nearest_on_segment;
use kinefront_scene::{Part, Scene, Solid, SolidShape, region_corners, regular_workspace};

/// Largest distance of the pointer from the axis of a thin member at which the member is still under the pointer \[points\].
const CATCH: f32 = 4.0;

/// Share of a rectangle that points fill that are fitted into it.
const FILLED: f64 = 0.9;

/// Conversion between metres and screen coordinates.
pub(super) struct Plan {
    centre: Pos2,
    /// Screen points per metre.
    pub scale: f64,
}

impl Plan {
    pub fn new(rect: Rect, design: &Design) -> Self {
        let reach = 1.25
            * design
                .base_radius()
                .max(0.5 * (design.platform_radius() + design.link_length()));
        Self {
            centre: rect.center(),
            scale: 0.5 * f64::from(rect.width().min(rect.height())) / reach,
        }
    }

    /// Fits all points into a rectangle, with a margin about them.
    pub fn around(rect: Rect, points: impl Iterator<Item = DVec2>) -> Self {
        let [low, high] = points.fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[low, high], point| {
            [low.min(point), high.max(point)]
        });
        let (middle, size) = (0.5 * (low + high), (high - low).max(DVec2::splat(1e-9)));
        let scale = (f64::from(rect.width()) / size.x).min(f64::from(rect.height()) / size.y) * FILLED;
        let offset = Vec2::new((middle.x * scale) as f32, -(middle.y * scale) as f32);
        Self {
            centre: rect.center() - offset,
            scale,
        }
    }

    pub fn screen(&self, at: DVec2) -> Pos2 {
        self.centre + Vec2::new((at.x * self.scale) as f32, -(at.y * self.scale) as f32)
    }

    pub fn world(&self, at: Pos2) -> DVec2 {
        let offset = at - self.centre;
        DVec2::new(f64::from(offset.x), -f64::from(offset.y)) / self.scale
    }

    /// Returns where the mouse was pressed for the drag that a response is of: a drag starts only some points away from there.
    pub fn pressed(&self, response: &Response) -> DVec2 {
        let pressed = response.ctx.input(|input| input.pointer.press_origin());
        self.world(pressed.or(response.interact_pointer_pos()).unwrap_or(self.centre))
    }

    /// Returns the member under the pointer, the topmost if there are several. The pointer may be slightly beside a
    /// thin member.
    pub fn pointed_at<'a>(&self, members: &'a [MemberReport], pointer: Pos2) -> Option<&'a MemberReport> {
        let at = self.world(pointer);
        let beside = f64::from(CATCH) / self.scale;
        members
            .iter()
            .filter(|member| distance(at, member) <= member.radius.max(beside))
            .max_by(|a, b| {
                // Among members of one layer, the one with the nearer axis is returned.
                let nearer = || distance(at, b).total_cmp(&distance(at, a));
                a.from.z.total_cmp(&b.from.z).then_with(nearer)
            })
    }

    /// Draws the outline of a member.
    pub fn outline(&self, painter: &Painter, member: &MemberReport, color: Color32) {
        let ends = [member.from, member.to].map(|end| self.screen(end.truncate()));
        let side = (ends[1] - ends[0]).normalized().rot90() * ((member.radius * self.scale) as f32).max(2.0);
        let corners = vec![ends[0] + side, ends[1] + side, ends[1] - side, ends[0] - side];
        painter.add(Shape::closed_line(corners, Stroke::new(1.5, color)));
    }
}

/// Draws the region in which a design has its workspace.
pub(super) fn paint_workspace(ui: &Ui, painter: &Painter, plan: &Plan, model: &Model, evaluation: &Evaluation) {
    let rotation_range_deg = model.settings().workspace.rotation_range_deg;
    let Some(cylinder) = regular_workspace(evaluation, rotation_range_deg) else {
        return;
    };
    let good = theme::good(ui);
    if let Some(corners) = region_corners(model) {
        // The outline may be concave, so that it is not filled.
        let outline: Vec<_> = corners.into_iter().map(|corner| plan.screen(corner)).collect();
        painter.add(Shape::closed_line(outline, Stroke::new(1.2, good)));
    } else {
        let (centre, radius) = (plan.screen(cylinder.centre), (cylinder.radius * plan.scale) as f32);
        painter.circle(centre, radius, good.gamma_multiply(0.12), Stroke::new(1.2, good));
    }
}

/// Draws a scene as seen from above.
pub(super) fn paint(ui: &Ui, painter: &egui::Painter, plan: &Plan, scene: &Scene) {
    let place = |at: DVec3| plan.screen(at.truncate());
    let dark = ui.visuals().dark_mode;
    for line in &scene.lines {
        let color = theme::part(line.part, dark);
        let points: Vec<Pos2> = line.points.iter().map(|&at| place(at)).collect();
        painter.line(points, Stroke::new(1.2, color));
    }
    let mut solids: Vec<&Solid> = scene.solids.iter().collect();
    solids.sort_by(|a, b| top(&a.shape).total_cmp(&top(&b.shape)));
    for solid in solids {
        let color = theme::part(solid.part, dark);
        match solid.shape {
            // A pin is vertical: it appears as a disc from above.
            SolidShape::Bar { from, radius, .. } if matches!(solid.part, Part::ActuatedJoint | Part::PassiveJoint) => {
                painter.circle_filled(place(from), ((radius * plan.scale) as f32).max(2.5), color);
            }
            SolidShape::Bar { from, to, radius, .. } => {
                let width = ((2.0 * radius * plan.scale) as f32).max(2.0);
                painter.line_segment([place(from), place(to)], Stroke::new(width, color));
            }
            SolidShape::Block {
                centre,
                half_size,
                angle,
                ..
            } => {
                let axis = DVec2::from_angle(angle);
                let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)].map(|(a, b): (f64, f64)| {
                    plan.screen(centre.truncate() + axis * (a * half_size.x) + axis.perp() * (b * half_size.y))
                });
                painter.add(egui::Shape::convex_polygon(corners.to_vec(), color, Stroke::NONE));
            }
        }
    }
    if let Some(nearest) = &scene.nearest {
        let color = theme::nearest(nearest.too_near, dark);
        let [from, to] = nearest.line.map(place);
        painter.line_segment([from, to], Stroke::new(2.5, color));
        painter.circle_stroke(from.lerp(to, 0.5), 7.0, Stroke::new(1.5, color));
        let at = from.lerp(to, 0.5) + Vec2::new(9.0, 9.0);
        painter.text(at, Align2::LEFT_TOP, &nearest.text, FontId::proportional(12.0), color);
    }
    for label in &scene.labels {
        painter.text(
            place(label.at) + Vec2::new(6.0, -6.0),
            Align2::LEFT_BOTTOM,
            &label.text,
            FontId::proportional(11.0),
            theme::ink(ui),
        );
    }
}

/// Returns the height of a solid's top \[m\].
fn top(shape: &SolidShape) -> f64 {
    match *shape {
        SolidShape::Bar { from, to, radius, .. } if from.z == to.z => from.z + radius,
        SolidShape::Bar { from, to, .. } => from.z.max(to.z),
        SolidShape::Block { centre, half_size, .. } => centre.z + half_size.z,
    }
}

/// Returns the distance of a point from a member's axis in the plane \[m\].
fn distance(at: DVec2, member: &MemberReport) -> f64 {
    let (from, to) = (member.from.truncate(), member.to.truncate());
    at.distance(from.lerp(to, nearest_on_segment(at, from, to)))
}

/// Shows the data of a member.
pub(super) fn card(ui: &mut Ui, report: &MemberReport) {
    let description = describe_member(report);
    ui.strong(description.title);
    for line in description.lines {
        ui.label(line);
    }
    if report.mass == 0.0 {
        ui.weak("no mass in this model");
    }
}
