//! The mechanisms panel: a sketch of each architecture with its actuated joints marked, and which of them the study searches.

use egui::{Align2, Color32, FontId, Rect, ScrollArea, Sense, Stroke, StrokeKind, Ui, Vec2, WidgetInfo, WidgetType};

use super::sketch::Sketch;
use crate::{Session, theme};
use kinefront_model::mechanism::Architecture;

/// Size of a card \[points\].
const CARD: Vec2 = Vec2::new(168.0, 176.0);

/// The mechanisms panel.
#[derive(Default)]
pub struct MechanismsPanel {
    sketches: Vec<Sketch>,
}

impl MechanismsPanel {
    /// Draws the panel.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        if self.sketches.is_empty() {
            self.sketches = Architecture::ALL
                .iter()
                .filter_map(|&found| Sketch::new(found))
                .collect();
        }
        ui.weak("orange: actuated joints, whose letters are underlined; click to include an architecture in the search or to exclude it");
        let mut chosen = session.editor().study().architectures.clone();
        let before = chosen.clone();
        ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
            ui.horizontal_wrapped(|ui| {
                for sketch in &self.sketches {
                    let place = chosen.iter().position(|&found| found == sketch.architecture);
                    if card(ui, sketch, place.is_some()) {
                        match place {
                            Some(place) => drop(chosen.remove(place)),
                            None => chosen.push(sketch.architecture),
                        }
                    }
                }
            });
        });
        if chosen != before {
            session.editor_mut().change(|study| study.architectures = chosen);
        }
    }
}

/// Draws a card; returns whether it was clicked.
fn card(ui: &mut Ui, sketch: &Sketch, is_chosen: bool) -> bool {
    let name = sketch.architecture.name();
    let (rect, response) = ui.allocate_exact_size(CARD, Sense::click());
    response.widget_info(|| WidgetInfo::selected(WidgetType::Checkbox, true, is_chosen, name));
    let dark = ui.visuals().dark_mode;
    let painter = ui.painter_at(rect);
    let inner = rect.shrink(3.0);
    painter.rect_filled(inner, 6.0, theme::ground(dark));
    let picture = Rect::from_min_max(inner.min, inner.max - Vec2::new(0.0, 26.0));
    sketch.paint(ui, picture);
    let color = if is_chosen {
        theme::ink(ui)
    } else {
        ui.visuals().weak_text_color()
    };
    painter.text(
        inner.center_bottom() - Vec2::new(0.0, 6.0),
        Align2::CENTER_BOTTOM,
        sketch.architecture.underlined_name(),
        FontId::proportional(15.0),
        color,
    );
    let outline = if is_chosen {
        Stroke::new(2.0, theme::architecture(sketch.architecture, dark))
    } else if response.hovered() {
        Stroke::new(1.0, ui.visuals().weak_text_color())
    } else {
        Stroke::new(1.0, Color32::TRANSPARENT)
    };
    painter.rect_stroke(inner, 6.0, outline, StrokeKind::Inside);
    if !is_chosen {
        painter.rect_filled(inner, 6.0, theme::ground(dark).gamma_multiply(0.3));
    }
    response
        .on_hover_ui(|ui| {
            let chain = sketch.architecture.chain();
            ui.strong(name);
            let variables = sketch.architecture.further_variables();
            let variables: Vec<&str> = variables.iter().map(|variable| variable.symbol()).collect();
            ui.label(format!(
                "chain {}, actuated joint {}",
                chain.name,
                sketch.architecture.driven() + 1
            ));
            if !variables.is_empty() {
                ui.label(format!(
                    "variables beyond the five dimensions: {}",
                    variables.join(", ")
                ));
            }
        })
        .clicked()
}
