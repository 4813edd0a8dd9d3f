//! Designs are marked by drawing a box or a lasso around them.

use std::sync::Arc;

use egui::{Pos2, Response, Shape, Stroke, Ui};
use egui_plot::PlotTransform;

use super::super::range;
use super::axis::ScatterAxis;
use crate::{Session, theme};

/// Distance that the pointer moves between two corners of a lasso \[points\].
const STEP: f32 = 4.0;

/// What dragging in the scatter does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DragTool {
    /// It moves the view.
    #[default]
    Pan,
    /// It marks the designs in a box.
    Box,
    /// It marks the designs within a line drawn around them.
    Lasso,
}

impl DragTool {
    /// Returns the tool of a name: `pan`, `box` or `lasso`.
    pub fn find(name: &str) -> Option<Self> {
        let mut all = [("pan", Self::Pan), ("box", Self::Box), ("lasso", Self::Lasso)].into_iter();
        all.find(|(of, _)| *of == name).map(|(_, tool)| tool)
    }

    /// Shows a button for each tool.
    pub(super) fn ui(&mut self, ui: &mut Ui) {
        for (tool, name, hint) in [
            (Self::Pan, "Pan", "dragging moves the view"),
            (Self::Box, "Box", "dragging marks the designs in a box"),
            (
                Self::Lasso,
                "Lasso",
                "dragging marks the designs within a line drawn around them",
            ),
        ] {
            theme::choice(ui, self, tool, name).on_hover_text(hint);
        }
    }
}

/// A region of the scatter, in the coordinates of its axes.
struct MarkedRegion {
    axes: [ScatterAxis; 2],
    corners: Vec<[f64; 2]>,
    /// The designs in it, by which one knows whether they are still the marked ones.
    ids: Arc<Vec<usize>>,
}

/// The region that is being drawn, and the one that was drawn last.
#[derive(Default)]
pub(super) struct Enclosing {
    path: Vec<Pos2>,
    region: Option<MarkedRegion>,
}

impl Enclosing {
    /// Follows the pointer; when it is released, the designs within its path are marked.
    pub(super) fn follow(
        &mut self,
        ui: &Ui,
        response: &Response,
        tool: DragTool,
        axes: [ScatterAxis; 2],
        transform: &PlotTransform,
        session: &mut Session,
    ) {
        let pointer = response.interact_pointer_pos();
        let is_drawing = response.dragged_by(egui::PointerButton::Primary);
        if tool == DragTool::Pan {
            self.path.clear();
        } else if let Some(at) = pointer.filter(|_| is_drawing) {
            if self.path.is_empty() {
                let origin = ui.input(|input| input.pointer.press_origin());
                self.path.push(origin.unwrap_or(at));
            }
            self.extend(tool, at);
        } else if response.drag_stopped() && self.path.len() > 2 {
            let place = |at: &Pos2| {
                let place = transform.value_from_position(*at);
                [place.x, place.y]
            };
            let corners: Vec<[f64; 2]> = self.path.drain(..).map(|at| place(&at)).collect();
            let ids = Arc::new(enclosed(&corners, axes, session));
            session.mark(Arc::clone(&ids));
            self.region = Some(MarkedRegion { axes, corners, ids });
        } else if !is_drawing {
            self.path.clear();
        }
        self.paint(ui, axes, transform, session);
    }

    fn extend(&mut self, tool: DragTool, at: Pos2) {
        let start = self.path[0];
        if tool == DragTool::Box {
            self.path.truncate(1);
            self.path
                .extend([Pos2::new(at.x, start.y), at, Pos2::new(start.x, at.y)]);
        } else if self.path.last().is_some_and(|last| last.distance(at) >= STEP) {
            self.path.push(at);
        }
    }

    /// Draws the region while its designs are the marked ones.
    fn paint(&self, ui: &Ui, axes: [ScatterAxis; 2], transform: &PlotTransform, session: &Session) {
        let painter = ui.painter_at(*transform.frame());
        let stroke = Stroke::new(1.5, theme::ink(ui));
        if self.path.len() > 1 {
            painter.add(Shape::closed_line(self.path.clone(), stroke));
        }
        if let Some(region) = &self.region
            && region.axes == axes
            && Arc::ptr_eq(&region.ids, &session.document().marked)
        {
            let screen = |corner: &[f64; 2]| transform.position_from_point(&(*corner).into());
            let corners: Vec<Pos2> = region.corners.iter().map(screen).collect();
            let closed: Vec<Pos2> = corners.iter().chain(corners.first()).copied().collect();
            painter.extend(Shape::dashed_line(&closed, stroke, 5.0, 3.0));
        }
    }
}

/// Returns the ids of the designs that pass the filter and lie within a polygon, in order. A design of the front lies where its
/// verified values are.
fn enclosed(corners: &[[f64; 2]], axes: [ScatterAxis; 2], session: &Session) -> Vec<usize> {
    let store = session.store();
    let filter = session.document().filter.prepare(store);
    let columns = axes.map(|axis| store.column(axis.quantity));
    let bounds = bounds(corners);
    let is_within =
        |at: [f64; 2]| (0..2).all(|k| (bounds[k][0]..=bounds[k][1]).contains(&at[k])) && contains(corners, at);
    let of_search = (0..store.len()).filter(|&id| {
        session.place_on_front(id).is_none()
            && is_within([0, 1].map(|k| axes[k].place(columns[k][id])))
            && filter.passes(id)
    });
    let of_front = session.front().iter().filter(|entry| {
        let value = |k: usize| axes[k].place(entry.row.number(axes[k].quantity).unwrap_or(f64::NAN));
        filter.passes_entry(entry) && is_within([0, 1].map(value))
    });
    let mut ids: Vec<usize> = of_search.chain(of_front.map(|entry| entry.id)).collect();
    ids.sort_unstable();
    ids
}

/// Returns the range of the corners on each axis.
fn bounds(corners: &[[f64; 2]]) -> [[f64; 2]; 2] {
    [0, 1].map(|k| range(corners.iter().map(|corner| corner[k])))
}

/// Returns whether a point lies within a polygon, which may cross itself, by the even-odd rule.
fn contains(corners: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let mut is_within = false;
    let mut before = corners.len() - 1;
    for corner in 0..corners.len() {
        let ([x0, y0], [x1, y1]) = (corners[before], corners[corner]);
        if (y0 > y) != (y1 > y) && x < x0 + (y - y0) / (y1 - y0) * (x1 - x0) {
            is_within = !is_within;
        }
        before = corner;
    }
    is_within
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lasso_may_be_concave() {
        let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 1.0], [0.0, 4.0]];
        assert!(contains(&corners, [0.5, 2.0]) && contains(&corners, [3.5, 2.0]));
        assert!(!contains(&corners, [2.0, 2.0]), "within the notch");
        assert!(!contains(&corners, [5.0, 1.0]) && !contains(&corners, [-1.0, 0.0]));
        assert_eq!(bounds(&corners), [[0.0, 4.0], [0.0, 4.0]]);
    }
}
