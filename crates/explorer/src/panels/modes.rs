//! The assembly modes in the pose panel: a button and a ghost for each, and their number over a slice of the joint space.

use egui::{Color32, Painter, Pos2, Rect, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo, WidgetType};

use super::plan::Plan;
use crate::{Session, theme};
use kinefront_model::mechanism::Design;
use kinefront_model::spatial::{Pose, Rotation};
use kinefront_scene::{AssemblyMode, ModeMap, Modes, modes_at};

/// Largest distance of the pointer from the centre of a ghost that is clicked \[points\].
const CATCH: f32 = 12.0;

/// Number of cells along each side of the map.
const CELLS: usize = 32;

/// The assembly modes of the selected design.
#[derive(Default)]
pub(super) struct ModesView {
    of: Option<(Design, Pose)>,
    modes: Option<Modes>,
    map: Option<(Design, f64, ModeMap)>,
}

impl ModesView {
    /// Draws the buttons and the map, and moves the platform to the mode that is clicked.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session, design: &Design, pose: Pose) {
        if self.of != Some((*design, pose)) {
            self.of = Some((*design, pose));
            self.modes = modes_at(session.model(), design, &pose);
        }
        let Some(modes) = self.modes.clone() else {
            return;
        };
        ui.separator();
        ui.label("modes")
            .on_hover_text("all poses at which the actuated joints have their current values: the assembly modes");
        for (place, mode) in modes.modes.iter().enumerate() {
            if button(ui, place + 1, mode, pose) {
                session.jump_to(mode);
            }
        }
        ui.menu_button("map", |ui| self.map(ui, session, design, &modes))
            .response
            .on_hover_text("number of assembly modes over the values of the first two actuated joints");
    }

    fn map(&mut self, ui: &mut Ui, session: &Session, design: &Design, modes: &Modes) {
        let kept = modes.values[2];
        let is_known = self
            .map
            .as_ref()
            .is_some_and(|(of, value, map)| of == design && *value == kept && contains(map, modes));
        if !is_known {
            self.map = Some((
                *design,
                kept,
                ModeMap::new(session.model(), design, modes.values, CELLS),
            ));
        }
        let Some((_, _, map)) = &self.map else { return };
        let unit = design.architecture().actuator().unit();
        let side = 240.0;
        ui.set_width(side);
        let (rect, response) = ui.allocate_exact_size(Vec2::splat(side), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Image, true, "Number of assembly modes"));
        let painter = ui.painter_at(rect);
        let cell = side / map.cells as f32;
        for (place, &count) in map.counts.iter().enumerate() {
            let (column, row) = (place % map.cells, map.cells - 1 - place / map.cells);
            let corner = rect.min + Vec2::new(column as f32, row as f32) * cell;
            painter.rect_filled(Rect::from_min_size(corner, Vec2::splat(cell + 0.5)), 0.0, shade(count));
        }
        let at = |joint: usize| {
            let [low, high] = map.ranges[joint];
            ((modes.values[joint] - low) / (high - low)) as f32
        };
        let here = rect.min + Vec2::new(at(0), 1.0 - at(1)) * side;
        painter.circle_stroke(here, 4.0, Stroke::new(2.0, theme::ink(ui)));
        let text = |joint: usize| {
            let [low, high] = map.ranges[joint].map(theme::number);
            format!("q{} {low} to {high} {unit}", joint + 1)
        };
        ui.weak(format!(
            "across {}, up {}; q3 = {} {unit}",
            text(0),
            text(1),
            theme::number(kept)
        ));
        ui.horizontal(|ui| {
            for count in [0, 1, 2, 4, 6] {
                let (swatch, _) = ui.allocate_exact_size(Vec2::splat(12.0), Sense::hover());
                ui.painter().rect_filled(swatch, 2.0, shade(count));
                ui.weak(count.to_string());
            }
        });
    }

    /// Returns the mode whose ghost is under the pointer, near its centre, if the platform can be moved there.
    pub fn pointed_at(&self, plan: &Plan, pointer: Pos2) -> Option<AssemblyMode> {
        let (modes, (_, pose)) = self.modes.as_ref().zip(self.of)?;
        let mut others = modes
            .modes
            .iter()
            .filter(|mode| can_be_shown(mode) && !is_at(&mode.pose, &pose));
        others
            .find(|mode| plan.screen(mode.pose.position).distance(pointer) < CATCH)
            .copied()
    }

    /// Draws the platform at every mode but that of the present pose.
    pub fn ghosts(&self, painter: &Painter, plan: &Plan, session: &Session, design: &Design, color: Color32) {
        let Some((modes, (_, pose))) = self.modes.as_ref().zip(self.of) else {
            return;
        };
        let geometry = &session.model().settings().legs.geometry;
        for mode in modes.modes.iter().filter(|mode| !is_at(&mode.pose, &pose)) {
            let turn = Rotation::new(mode.pose.phi);
            let corners = [0, 1, 2].map(|leg| {
                let joint = geometry.platform_joint(leg, design.platform_radius());
                plan.screen(mode.pose.position + turn.apply(joint))
            });
            let shown = if mode.is_of_design { 0.75 } else { 0.35 };
            let stroke = Stroke::new(1.2, color.gamma_multiply(shown));
            let middle = plan.screen(mode.pose.position);
            painter.circle_stroke(middle, 3.5, stroke);
            for corner in corners {
                painter.extend(Shape::dashed_line(&[middle, corner], stroke, 4.0, 3.0));
            }
            painter.add(Shape::closed_line(corners.to_vec(), stroke));
        }
    }
}

/// Whether the joint values lie within a map that was computed for others.
fn contains(map: &ModeMap, modes: &Modes) -> bool {
    let within = |joint: usize| {
        let [low, high] = map.ranges[joint];
        (low..=high).contains(&modes.values[joint])
    };
    within(0) && within(1)
}

/// Whether the legs reach a mode within their limits.
fn can_be_shown(mode: &AssemblyMode) -> bool {
    mode.working_mode.is_some() && mode.is_within_limits
}

fn is_at(a: &Pose, b: &Pose) -> bool {
    let turn = libm::remainder(a.phi - b.phi, std::f64::consts::TAU);
    a.position.distance(b.position) < 1e-6 && turn.abs() < 1e-6
}

/// Draws the button of a mode; returns whether it was clicked.
fn button(ui: &mut Ui, number: usize, mode: &AssemblyMode, pose: Pose) -> bool {
    let is_here = is_at(&mode.pose, &pose);
    let button = ui.add_enabled(can_be_shown(mode), theme::toggle(is_here, number.to_string()));
    button.widget_info(|| {
        WidgetInfo::selected(
            WidgetType::SelectableLabel,
            can_be_shown(mode),
            is_here,
            format!("mode {number}"),
        )
    });
    let response = button
        .on_hover_text(description(mode))
        .on_disabled_hover_text(description(mode));
    response.clicked() && !is_here
}

fn description(mode: &AssemblyMode) -> String {
    let Pose { position, phi } = mode.pose;
    let at = format!(
        "x {} m, y {} m, φ {:.2}°",
        theme::number(position.x),
        theme::number(position.y),
        phi.to_degrees()
    );
    let why = match mode.working_mode {
        None => "a leg would have to reach backwards".to_owned(),
        Some(_) if !mode.is_within_limits => "a joint is beyond its limits".to_owned(),
        Some(_) if mode.is_of_design => "click to move there".to_owned(),
        Some(needed) => format!("needs the working mode {needed}; click to switch to it"),
    };
    format!("{at}\n{why}")
}

/// Colour of a number of modes.
fn shade(count: u8) -> Color32 {
    match count {
        0 => Color32::from_rgb(40, 44, 52),
        1 => Color32::from_rgb(70, 92, 130),
        2 => Color32::from_rgb(64, 130, 170),
        3 | 4 => Color32::from_rgb(110, 180, 130),
        _ => Color32::from_rgb(230, 190, 70),
    }
}
