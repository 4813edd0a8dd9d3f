//! The ring around the widget that has the keyboard.

use egui::{Context, Event, Id, Key, LayerId, Order, Rect, Stroke, StrokeKind};

/// Width of the ring, and its distance from the widget \[points\].
const WIDTH: f32 = 2.0;
const AWAY: f32 = 2.0;

/// Shows which widget the keyboard acts on while the focus is moved by keys. After a click the pointer tells it.
#[derive(Default)]
pub(super) struct FocusRing {
    moved_by_key: bool,
    drawn: Option<Rect>,
}

impl FocusRing {
    /// Draws the ring; must be called after all widgets.
    pub fn ui(&mut self, ctx: &Context) {
        ctx.input(|input| {
            for event in &input.events {
                match event {
                    Event::Key {
                        key: Key::Tab,
                        pressed: true,
                        ..
                    } => self.moved_by_key = true,
                    Event::PointerButton { pressed: true, .. } => self.moved_by_key = false,
                    _ => {}
                }
            }
        });
        let focused = ctx.memory(|memory| memory.focused()).filter(|_| self.moved_by_key);
        let rect = focused.and_then(|id| Some(ctx.read_response(id)?.interact_rect));
        self.drawn = rect.filter(|rect| rect.is_positive());
        if let Some(rect) = self.drawn {
            let painter = ctx.layer_painter(LayerId::new(Order::Foreground, Id::new("focus ring")));
            let color = ctx.global_style().visuals.selection.bg_fill;
            painter.rect_stroke(rect.expand(AWAY), 3.0, Stroke::new(WIDTH, color), StrokeKind::Outside);
        }
    }

    /// Returns the widget around which the last frame drew the ring.
    pub fn drawn(&self) -> Option<Rect> {
        self.drawn
    }
}
