//! The examples panel: the built-in studies, each with a design that answers its question.

use egui::{
    Color32, CornerRadius, FontId, Rect, ScrollArea, Sense, Stroke, StrokeKind, Ui, Vec2, WidgetInfo, WidgetType,
};
use glam::DVec2;

use super::plan::{Plan, paint, paint_workspace};
use crate::{Session, Subject, theme};
use kinefront_model::evaluation::{Evaluation, GridChoice};
use kinefront_model::mechanism::Design;
use kinefront_scene::{Scene, manipulator};
use kinefront_study::{BUILTIN, Builtin, PreparedStudy};

/// Size of a picture, and the distance between it, the text and the edge of the card \[points\].
const PICTURE: Vec2 = Vec2::new(150.0, 112.0);
const GAP: f32 = 8.0;

/// The examples panel.
#[derive(Default)]
pub struct ExamplesPanel {
    examples: Vec<Example>,
}

/// A built-in study as it is listed.
struct Example {
    builtin: Builtin,
    description: String,
    picture: Option<Picture>,
}

/// A design of a study at its home pose, with all that the study states of its surroundings.
struct Picture {
    study: PreparedStudy,
    evaluation: Evaluation,
    scene: Scene,
}

impl ExamplesPanel {
    /// Draws the panel.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        // A picture takes an evaluation, so that one is made in a frame.
        if let Some(&builtin) = BUILTIN.get(self.examples.len()) {
            self.examples.push(Example::new(builtin));
            ui.ctx().request_repaint();
        }
        ui.weak("Click a study to edit it, then start it. Each picture shows a design that answers it.");
        let edited = session.editor().study().name.clone();
        let mut picked = None;
        ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
            for example in &self.examples {
                if example.ui(ui, edited == example.builtin.name) {
                    picked = Some(example.builtin);
                }
            }
        });
        if let Some(builtin) = picked {
            session.edit_builtin(&builtin);
            session.turn_to(Subject::Study);
        }
    }
}

impl Example {
    fn new(builtin: Builtin) -> Self {
        let study = builtin.study().ok();
        Self {
            builtin,
            description: study
                .as_ref()
                .map(|study| study.description.clone())
                .unwrap_or_default(),
            picture: study.and_then(|study| Picture::new(PreparedStudy::new(study).ok()?, builtin.design)),
        }
    }

    /// Draws the card of the study; returns whether it was clicked.
    fn ui(&self, ui: &mut Ui, is_edited: bool) -> bool {
        let ink = theme::ink(ui);
        let width = ui.available_width();
        let of_text = (width - PICTURE.x - 3.0 * GAP).max(80.0);
        let lay_out = |text: &str, size: f32, color: Color32| {
            let font = FontId::proportional(size);
            ui.painter().layout(text.to_owned(), font, color, of_text)
        };
        let name = lay_out(self.builtin.name, 15.0, ink);
        let description = lay_out(&self.description, 12.5, ui.visuals().text_color());
        let height = (name.size().y + 4.0 + description.size().y).max(PICTURE.y) + 2.0 * GAP;
        let (rect, response) = ui.allocate_exact_size(Vec2::new(width, height), Sense::click());
        let words = format!("Edit the study {}: {}", self.builtin.name, self.description);
        response.widget_info(|| WidgetInfo::selected(WidgetType::Button, true, is_edited, &words));
        if !ui.is_rect_visible(rect) {
            return response.clicked();
        }
        let painter = ui.painter_at(rect);
        let ground = theme::ground(ui.visuals().dark_mode);
        painter.rect_filled(rect.shrink(2.0), CornerRadius::same(6), ground);
        let corner = rect.min + Vec2::splat(GAP);
        if let Some(picture) = &self.picture {
            picture.paint(ui, Rect::from_min_size(corner, PICTURE));
        }
        let text = corner + Vec2::new(PICTURE.x + GAP, 0.0);
        let below = text + Vec2::new(0.0, name.size().y + 4.0);
        painter.galley(text, name, ink);
        painter.galley(below, description, ink);
        let outline = match (is_edited, response.hovered()) {
            (true, _) => Stroke::new(2.0, theme::active(ui)),
            (false, true) => Stroke::new(1.0, ui.visuals().weak_text_color()),
            (false, false) => Stroke::NONE,
        };
        painter.rect_stroke(rect.shrink(2.0), CornerRadius::same(6), outline, StrokeKind::Inside);
        response.clicked()
    }
}

impl Picture {
    /// Evaluates and draws a design; `None` if it is not feasible.
    fn new(study: PreparedStudy, design: &str) -> Option<Self> {
        let design = Design::parse(design, study.study().working_mode).ok()?;
        let evaluation = study.model().evaluate(&design, GridChoice::Reference);
        let mut scene = manipulator(study.model(), &design, &evaluation.home?).ok()?;
        scene.nearest = None;
        scene.labels.clear();
        Some(Self {
            study,
            evaluation,
            scene,
        })
    }

    fn paint(&self, ui: &Ui, rect: Rect) {
        let painter = ui.painter_at(rect);
        let lines = self.scene.lines.iter().flat_map(|line| &line.points);
        let plan = Plan::around(rect, lines.map(|point| point.truncate()));
        paint_workspace(ui, &painter, &plan, self.study.model(), &self.evaluation);
        paint(ui, &painter, &plan, &self.scene);
        let waypoints = self.study.study().task.waypoints.iter().flatten();
        for [x, y, _] in waypoints {
            let stroke = Stroke::new(1.2, theme::active(ui));
            painter.circle_stroke(plan.screen(DVec2::new(*x, *y)), 3.0, stroke);
        }
    }
}
