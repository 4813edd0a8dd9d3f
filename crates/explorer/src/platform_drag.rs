//! Dragging the platform in the 3-D view.
//!
//! The viewer turns its camera with every drag that it sees. A press on a bar of the platform is therefore taken from the
//! input before the viewer sees it; it is given back as a click if the pointer is released where it was pressed.

use egui::{CursorIcon, Event, Painter, PointerButton, Pos2, RawInput, Stroke, Ui};
use glam::DVec2;

use crate::eye::SceneView;
use crate::grip::Grip;
use crate::{Session, theme};
use kinefront_model::evaluation::MemberReport;
use kinefront_model::mechanism::MemberKind;
use kinefront_model::spatial::nearest_on_segment;

/// Largest distance of the pointer from the axis of a thin bar at which the bar is still under the pointer \[points\].
const CATCH: f64 = 6.0;

/// Distance \[points\] that the pointer moves before a press becomes a drag.
const SLACK: f32 = 4.0;

/// A press on the platform, and the drag that it may become.
#[derive(Debug, Clone, Copy)]
struct Held {
    grip: Grip,
    view: SceneView,
    height: f64,
    pressed: Pos2,
    moved: bool,
}

/// The platform as the pointer finds it in the 3-D view.
#[derive(Debug, Default)]
pub struct PlatformDrag {
    held: Option<Held>,
}

impl PlatformDrag {
    /// Takes presses on the platform and what follows from them out of the input, and moves the platform. `view` is the view
    /// of the selected design under the pointer, if there is one.
    pub fn take_events(&mut self, input: &mut RawInput, session: &mut Session, view: Option<SceneView>) {
        if self.held.is_none() && view.is_none() {
            return;
        }
        let mut rest = Vec::with_capacity(input.events.len());
        for event in input.events.drain(..) {
            match (&event, self.held) {
                (
                    Event::PointerButton {
                        pos,
                        button: PointerButton::Primary,
                        pressed: true,
                        modifiers,
                    },
                    None,
                ) => {
                    self.held = view.and_then(|view| hold(session, view, *pos, modifiers.shift));
                    if self.held.is_none() {
                        rest.push(event);
                    }
                }
                (
                    &Event::PointerButton {
                        pos,
                        button: button @ PointerButton::Primary,
                        pressed: false,
                        modifiers,
                    },
                    Some(held),
                ) => {
                    self.held = None;
                    session.end_drag();
                    // The viewer selects what was clicked.
                    if !held.moved {
                        rest.extend([true, false].map(|pressed| Event::PointerButton {
                            pos,
                            button,
                            pressed,
                            modifiers,
                        }));
                    }
                }
                (&Event::PointerMoved(pointer), Some(held)) => {
                    let moved = held.moved || pointer.distance(held.pressed) > SLACK;
                    self.held = Some(Held { moved, ..held });
                    if moved
                        && let Some(pose) = session.pose()
                        && let Some(point) = held.view.on_plane(pointer, held.height)
                    {
                        session.drag_platform(held.grip.target(point, &pose));
                    }
                    rest.push(event);
                }
                (Event::WindowFocused(false), _) => {
                    self.held = None;
                    rest.push(event);
                }
                _ => rest.push(event),
            }
        }
        input.events = rest;
    }

    /// Returns whether the platform is being moved or turned.
    pub fn is_dragging(&self) -> bool {
        self.held.is_some_and(|held| held.moved)
    }

    /// Highlights the platform under the pointer.
    pub fn ui(&self, ui: &Ui, session: &Session, view: Option<SceneView>) {
        let pointer = ui.input(|input| input.pointer.latest_pos());
        let (Some(view), Some(pointer)) = (self.held.map(|held| held.view).or(view), pointer) else {
            return;
        };
        let bars = platform_bars(session);
        if self.held.is_none() && touched(&bars, view, pointer).is_none() {
            return;
        }
        let dragging = self.held.is_some();
        ui.ctx().set_cursor_icon(if dragging {
            CursorIcon::Grabbing
        } else {
            CursorIcon::Grab
        });
        outline(&ui.painter_at(view.rect), &bars, view, theme::active(ui));
    }
}

/// Takes hold of the platform if the pointer is over one of its bars.
fn hold(session: &Session, view: SceneView, pointer: Pos2, keeps_angle: bool) -> Option<Held> {
    if !view.rect.contains(pointer) {
        return None;
    }
    let bars = platform_bars(session);
    let height = touched(&bars, view, pointer)?.from.z;
    let radius = session.known()?.evaluation.design.platform_radius();
    let point = view.on_plane(pointer, height)?;
    Some(Held {
        grip: Grip::new(point, &session.pose()?, radius, keeps_angle),
        view,
        height,
        pressed: pointer,
        moved: false,
    })
}

/// Returns the bars of the platform at the pose that is shown.
fn platform_bars(session: &Session) -> Vec<MemberReport> {
    let members = session.known().zip(session.pose()).and_then(|(known, pose)| {
        let members = session.model().members(&known.evaluation.design, &pose);
        members.ok()
    });
    let mut members = members.unwrap_or_default();
    members.retain(|member| member.member.kind == MemberKind::PlatformBar);
    members
}

/// Returns the bar under the pointer.
fn touched(bars: &[MemberReport], view: SceneView, pointer: Pos2) -> Option<&MemberReport> {
    bars.iter().find(|bar| {
        let Some(((from, _), (to, scale))) = view.screen(bar.from).zip(view.screen(bar.to)) else {
            return false;
        };
        let [at, from, to] = [pointer, from, to].map(|place| DVec2::new(f64::from(place.x), f64::from(place.y)));
        at.distance(from.lerp(to, nearest_on_segment(at, from, to))) <= (bar.radius * scale).max(CATCH)
    })
}

/// Draws lines along the bars.
fn outline(painter: &Painter, bars: &[MemberReport], view: SceneView, color: egui::Color32) {
    for bar in bars {
        if let Some(((from, _), (to, scale))) = view.screen(bar.from).zip(view.screen(bar.to)) {
            let width = ((2.0 * bar.radius * scale) as f32).max(3.0);
            painter.line_segment([from, to], Stroke::new(width, color.gamma_multiply(0.55)));
        }
    }
}
