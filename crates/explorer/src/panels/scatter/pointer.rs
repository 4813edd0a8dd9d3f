//! What the pointer does in the scatter: it moves the view, and shows and selects what it is over.

use egui::{Response, Ui};

use super::Scatter;
use super::enclosing::DragTool;
use crate::{DesignOrigin, Row, Selected, Session, theme};
use kinefront_model::evaluation::Evaluation;
use kinefront_scene::text;
use kinefront_study::Column;

/// Distance at which the pointer reaches a design \[points\].
const REACH: f32 = 9.0;

impl Scatter {
    /// Keeps the bounds where the user moves them; a double click fits them to the designs again.
    pub(super) fn follow_pointer(&mut self, ui: &Ui, response: &Response) {
        let scrolled = ui.input(|input| input.smooth_scroll_delta().y != 0.0) && response.hovered();
        let is_moved = response.dragged() || response.drag_stopped();
        if (is_moved && self.tool == DragTool::Pan) || scrolled {
            self.fitted = false;
        }
        if response.double_clicked() {
            self.fitted = true;
        }
    }

    /// Shows the values of the design under the pointer, and selects the design when it is clicked.
    pub(super) fn pointed(&self, response: &Response, session: &mut Session) {
        let Some((pointer, transform)) = response.hover_pos().zip(self.transform) else {
            return;
        };
        if response.dragged() {
            return;
        }
        let distance = |row: &Row| {
            let at = transform.position_from_point(&self.place(row).into());
            at.distance(pointer)
        };
        let is_near = |evaluation: &Evaluation| distance(&Row::new(0, evaluation)) < REACH;
        let on_front = session
            .front()
            .iter()
            .map(|entry| (distance(&entry.row), entry.id))
            .filter(|(distance, _)| *distance < REACH)
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, id)| id);
        let mut references = session.references().iter();
        let reference = references.position(|reference| is_near(&reference.evaluation));
        if let (Some(index), None) = (reference, on_front) {
            point_at_reference(response, session, index);
            return;
        }
        let place = transform.value_from_position(pointer);
        let mut wished = session.document().wished.iter();
        let wished = wished.position(|wished| is_near(&wished.evaluation));
        if let Some(index) = wished.filter(|_| response.clicked()) {
            session.select_wished(index);
            return;
        }
        let Some(id) = on_front.or_else(|| self.cloud.at([place.x, place.y], 6)) else {
            if response.clicked() {
                self.ask_why([place.x, place.y], session);
            }
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

    /// Asks why there is no design at a place, if the axes are objectives.
    fn ask_why(&self, place: [f64; 2], session: &mut Session) {
        let values = self
            .axes
            .iter()
            .zip(place)
            .filter_map(|(axis, place)| match axis.quantity {
                Column::Quantity(quantity) => Some((quantity, axis.value(place))),
                _ => None,
            });
        let values: Vec<_> = values.collect();
        session.ask_why(&values);
    }
}

/// Shows the values of a reference design, by the model and as they are stated, and selects it when it is clicked.
fn point_at_reference(response: &Response, session: &mut Session, index: usize) {
    let reference = &session.references()[index];
    let design = reference.evaluation.design;
    let values = text::quantities(session.study().shown_quantities(), &reference.evaluation.quantities);
    let stated = reference.stated.iter();
    let stated: Vec<String> = stated
        .map(|&(quantity, value)| text::quantity(quantity, value))
        .collect();
    let stated = match stated.as_slice() {
        [] => String::new(),
        stated => format!("\nstated: {}", stated.join(", ")),
    };
    let words = format!("{}\nmodel: {values}{stated}", reference.name);
    response.clone().on_hover_text_at_pointer(words);
    if response.clicked() {
        let origin = DesignOrigin::Reference(index);
        session.select_design(Selected { design, origin });
    }
}

/// Shows the values of a design.
fn hover(ui: &mut Ui, id: usize, row: &Row, session: &Session) {
    let verified = session
        .place_on_front(id)
        .is_some_and(|place| session.front()[place].verified);
    let grid = if verified { "fine grid" } else { "reference grid" };
    ui.strong(format!("#{id}  {}", row.design.architecture()));
    let values = text::quantities(session.study().shown_quantities(), &row.quantities);
    ui.label(format!("{values} ({grid})"));
    let [base, platform, link, leg, bar] = row.design.values();
    ui.label(format!("R {base:.3}  r {platform:.3}  L_b {link:.3} m"));
    ui.label(format!("r_j {:.1}  r_p {:.1} mm", 1e3 * leg, 1e3 * bar));
    if !row.is_feasible() {
        ui.colored_label(theme::bad(ui), "infeasible");
    }
    if let Some(note) = session.document().notes.get(&id) {
        ui.label(egui::RichText::new(note).italics());
    }
}
