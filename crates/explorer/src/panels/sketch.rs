//! A sketch of an architecture that shows what its lengths are.

use egui::{Align2, FontId, Pos2, Rect, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo, WidgetType};
use glam::DVec2;

use super::plan::{Plan, paint};
use crate::theme;
use kinefront_model::evaluation::Model;
use kinefront_model::mechanism::{Architecture, Design, DesignVariable};
use kinefront_scene::{Scene, dimension_lines, example, manipulator};

/// An architecture seen from above, with its members and without labels.
pub(super) struct Sketch {
    pub architecture: Architecture,
    design: Design,
    scene: Scene,
    lengths: Vec<(DesignVariable, [DVec2; 2])>,
}

impl Sketch {
    /// Makes the sketch of an architecture; `None` if none of the usual lengths lets its legs reach the platform.
    pub fn new(architecture: Architecture) -> Option<Self> {
        let model = Model::default();
        let (design, pose) = example(&model, architecture)?;
        let mut scene = manipulator(&model, &design, &pose).ok()?;
        scene.nearest = None;
        scene.labels.clear();
        Some(Self {
            architecture,
            lengths: dimension_lines(&model, &design, &pose),
            design,
            scene,
        })
    }

    /// Draws the members into `picture`.
    pub fn paint(&self, ui: &Ui, picture: Rect) {
        paint(
            ui,
            &ui.painter_at(picture),
            &Plan::new(picture, &self.design),
            &self.scene,
        );
    }

    /// Shows the sketch with its lengths and their symbols.
    pub fn ui(&self, ui: &mut Ui) {
        let size = Vec2::new(ui.available_width().min(260.0), 190.0);
        let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
        let symbols: Vec<&str> = self.lengths.iter().map(|(variable, _)| variable.symbol()).collect();
        let name = format!("Lengths {} of the {}", symbols.join(", "), self.architecture.name());
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Image, true, &name));
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 4.0, theme::ground(ui.visuals().dark_mode));
        self.paint(ui, rect);
        let plan = Plan::new(rect, &self.design);
        let color = theme::ink(ui);
        for (variable, ends) in &self.lengths {
            let [from, to] = ends.map(|end| plan.screen(end));
            // Members are beside their lengths, and the radii of base and platform lie where there is no member.
            let is_radius = matches!(variable, DesignVariable::BaseRadius);
            let aside = (to - from).normalized().rot90() * if is_radius { 0.0 } else { 9.0 };
            dimension(&painter, [from + aside, to + aside], Stroke::new(1.2, color));
            let middle = from.lerp(to, 0.6) + (to - from).normalized().rot90() * 17.0;
            painter.text(
                middle,
                Align2::CENTER_CENTER,
                variable.symbol(),
                FontId::proportional(13.0),
                color,
            );
        }
        ui.weak("r_j is the radius of the bars of the legs, r_p of those of the platform");
    }
}

/// Draws a line with an arrowhead at each end.
fn dimension(painter: &egui::Painter, [from, to]: [Pos2; 2], stroke: Stroke) {
    painter.line_segment([from, to], stroke);
    let along = (to - from).normalized();
    for (tip, back) in [(from, along), (to, -along)] {
        let side = along.rot90() * 2.5;
        let corners = vec![tip, tip + back * 7.0 + side, tip + back * 7.0 - side];
        painter.add(Shape::convex_polygon(corners, stroke.color, Stroke::NONE));
    }
}
