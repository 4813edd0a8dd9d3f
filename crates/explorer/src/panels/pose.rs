//! The pose panel: the manipulator from above, its platform moved and turned by the mouse, and the values at the pose.

use egui::{Align2, Color32, FontId, Grid, ScrollArea, Sense, Slider, Stroke, Ui, Vec2, WidgetInfo, WidgetType};
use glam::DVec2;
use kinefront_scene::text;

use super::add_named;
use super::modes::ModesView;
use super::obstacles::ObstacleDrag;
use super::plan::{Plan, card, paint, paint_workspace};
use crate::grip::Grip;
use crate::{Session, theme};
use kinefront_model::evaluation::PoseScalar;
use kinefront_model::mechanism::Design;
use kinefront_model::spatial::Pose;
use kinefront_scene::{Tour, drawn_samples, manipulator, regular_workspace, tour};

/// Number of poses around each rim of the tour.
const TOUR_STEPS: usize = 90;
/// Number of poses of the tour shown per second.
const TOUR_RATE: f64 = 30.0;

/// Share of the panel that the plan view has, and its least height \[points\].
const VIEW_SHARE: f32 = 0.55;
const LEAST_VIEW: f32 = 170.0;

/// A tour of the regular workspace that is being played.
struct Playing {
    design: Design,
    tour: Tour,
    at: f64,
    /// The pose that was shown last. Whoever moves the platform elsewhere ends the tour.
    shown: Option<Pose>,
}

/// The pose panel.
#[derive(Default)]
pub struct PosePanel {
    grip: Option<Grip>,
    playing: Option<Playing>,
    obstacles: ObstacleDrag,
    modes: ModesView,
}

impl PosePanel {
    /// Draws the panel.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        let (Some(known), Some(pose), Some(home)) = (session.known().cloned(), session.pose(), session.home()) else {
            ui.weak("Click a design in the scatter to move its platform and see the values at the pose here.");
            return;
        };
        let evaluation = &known.evaluation;
        ui.horizontal_wrapped(|ui| {
            self.tour(ui, session, &known);
            self.modes.ui(ui, session, &evaluation.design, pose);
        });
        self.top_view(ui, session, &evaluation.design, pose);
        match session.stopped() {
            Some(reason) => ui.colored_label(theme::bad(ui), format!("stopped: {reason}")),
            None => ui.weak(
                "drag the platform to move it, its rim to turn it (Shift keeps the angle); point at a member to see its data",
            ),
        };
        ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
            self.sliders(ui, session, pose, home, evaluation.design.base_radius());
            let pose = session.pose().unwrap_or(pose);
            numbers(ui, session, &evaluation.design, &pose);
        });
    }

    fn tour(&mut self, ui: &mut Ui, session: &mut Session, known: &crate::Known) {
        let design = known.evaluation.design;
        let shown = session.view().pose;
        let is_left = |playing: &Playing| playing.design != design || playing.shown != shown;
        if self.playing.as_ref().is_some_and(is_left) {
            self.playing = None;
        }
        ui.horizontal(|ui| {
            if ui.button("Home").clicked() {
                session.view_mut().pose = None;
                self.playing = None;
            }
            let cylinder = regular_workspace(
                &known.evaluation,
                session.model().settings().workspace.rotation_range_deg,
            );
            let playing = self.playing.is_some();
            let button = theme::toggle(playing, if playing { "⏹ Tour" } else { "▶ Tour" });
            if ui
                .add_enabled(cylinder.is_some(), button)
                .on_hover_text("moves the platform around the rim of the regular workspace")
                .clicked()
            {
                self.playing = match (playing, cylinder) {
                    (false, Some(cylinder)) => {
                        tour(session.model(), &design, &cylinder, TOUR_STEPS).map(|tour| Playing {
                            design,
                            tour,
                            at: 0.0,
                            shown,
                        })
                    }
                    _ => None,
                };
            }
            if let Some(playing) = &mut self.playing {
                let poses = &playing.tour.poses;
                playing.at =
                    (playing.at + f64::from(ui.input(|input| input.stable_dt)) * TOUR_RATE) % poses.len() as f64;
                playing.shown = poses.get(playing.at as usize).copied();
                session.view_mut().pose = playing.shown;
                ui.weak(format!("pose {} of {}", playing.at as usize + 1, poses.len()));
                ui.ctx().request_repaint();
            }
        });
    }

    fn sliders(&mut self, ui: &mut Ui, session: &mut Session, pose: Pose, home: Pose, reach: f64) {
        let mut target = pose;
        let turn = std::f64::consts::PI;
        // Whole turns are removed from the orientation: the slider covers one turn, centred on the home orientation.
        let whole_turns = pose.phi - (home.phi - turn + (pose.phi - home.phi + turn).rem_euclid(2.0 * turn));
        target.phi -= whole_turns;
        let axes: [(&str, &mut f64, std::ops::RangeInclusive<f64>, bool); 3] = [
            ("x", &mut target.position.x, -reach..=reach, false),
            ("y", &mut target.position.y, -reach..=reach, false),
            ("φ", &mut target.phi, home.phi - turn..=home.phi + turn, true),
        ];
        let mut changed = false;
        for (name, value, range, angle) in axes {
            ui.horizontal(|ui| {
                ui.add_sized([14.0, 18.0], egui::Label::new(name));
                ui.spacing_mut().slider_width = (ui.available_width() - 90.0).max(60.0);
                let slider = Slider::new(value, range)
                    .custom_formatter(move |value, _| {
                        if angle {
                            format!("{:.2}°", value.to_degrees())
                        } else {
                            format!("{value:.4} m")
                        }
                    })
                    .custom_parser(move |text| {
                        let number = text.trim().trim_end_matches(['°', 'm']).trim().parse::<f64>().ok()?;
                        Some(if angle { number.to_radians() } else { number })
                    });
                changed |= add_named(ui, slider, &format!("pose {name}")).changed();
            });
        }
        if changed {
            target.phi += whole_turns;
            session.drag_platform(target);
        }
    }

    fn top_view(&mut self, ui: &mut Ui, session: &mut Session, design: &Design, pose: Pose) {
        // The sliders and numbers below can be scrolled; the view is what the panel is for.
        let height = (VIEW_SHARE * ui.available_height())
            .max(LEAST_VIEW)
            .min(ui.available_width());
        let (rect, response) = ui.allocate_exact_size(Vec2::new(ui.available_width(), height), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Image, true, "Top view"));
        let plan = Plan::new(rect, design);
        let Ok(scene) = manipulator(session.model(), design, &pose) else {
            ui.painter_at(rect).text(
                rect.center(),
                Align2::CENTER_CENTER,
                "the manipulator cannot reach this pose",
                FontId::proportional(14.0),
                theme::bad(ui),
            );
            return;
        };
        if !self.obstacles.follow(&response, session, &plan) {
            self.drag(&response, session, &plan, design, pose);
        }
        if response.clicked()
            && let Some(pointer) = response.interact_pointer_pos()
        {
            if session.view().drawing_path {
                let position = plan.world(pointer);
                session.add_waypoint(Pose { position, ..pose });
            } else if let Some(mode) = self.modes.pointed_at(&plan, pointer) {
                session.jump_to(&mode);
            }
        }
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 4.0, theme::ground(ui.visuals().dark_mode));
        if let Some(known) = session.known() {
            paint_workspace(ui, &painter, &plan, session.model(), &known.evaluation);
        }
        draw_path(ui, &painter, &plan, session);
        self.modes.ghosts(&painter, &plan, session, design, theme::ink(ui));
        paint(ui, &painter, &plan, &scene);
        let rim = (design.platform_radius() * plan.scale) as f32;
        painter.circle_stroke(
            plan.screen(pose.position),
            rim,
            Stroke::new(1.0, Color32::from_rgb(90, 150, 235).gamma_multiply(0.6)),
        );
        self.obstacles.paint(ui, &response, &painter, &plan, session);
        let Some(pointer) = response.hover_pos().filter(|_| self.grip.is_none()) else {
            return;
        };
        let members = session.model().members(design, &pose).unwrap_or_default();
        if let Some(member) = plan.pointed_at(&members, pointer) {
            plan.outline(&painter, member, theme::ink(ui));
            response.on_hover_ui_at_pointer(|ui| card(ui, member));
        }
    }

    fn drag(&mut self, response: &egui::Response, session: &mut Session, plan: &Plan, design: &Design, pose: Pose) {
        let Some(pointer) = response.interact_pointer_pos() else {
            self.grip = None;
            return;
        };
        let at = plan.world(pointer);
        if response.drag_started() {
            let keeps_angle = response.ctx.input(|input| input.modifiers.shift);
            let pressed = plan.pressed(response);
            self.grip = Some(Grip::new(pressed, &pose, design.platform_radius(), keeps_angle));
        }
        if response.drag_stopped() {
            session.end_drag();
        }
        if response.dragged()
            && let Some(grip) = self.grip
        {
            session.drag_platform(grip.target(at, &pose));
        }
    }
}

/// Draws the path of the motion of the study being edited, and its waypoints.
fn draw_path(ui: &Ui, painter: &egui::Painter, plan: &Plan, session: &mut Session) {
    let task = &session.editor().study().task;
    if task.shape.is_none() {
        return;
    }
    let waypoints = task.waypoints.clone().unwrap_or_default();
    let color = theme::active(ui);
    if let Some(motion) = session.motion()
        && let Ok(Some(followed)) = motion.as_ref()
    {
        let samples = drawn_samples(&followed.samples).into_iter();
        let points = samples.map(|sample| plan.screen(sample.instant.pose.position));
        painter.line(points.collect(), Stroke::new(1.5, color));
    }
    for [x, y, _] in waypoints {
        painter.circle_stroke(plan.screen(DVec2::new(x, y)), 3.5, Stroke::new(1.2, color));
    }
}

fn numbers(ui: &mut Ui, session: &Session, design: &Design, pose: &Pose) {
    let Ok(report) = session.model().pose(design, pose) else {
        return;
    };
    let thresholds = &session.model().settings().thresholds;
    let color = |ui: &Ui, scalar: PoseScalar, value: f64| {
        let margin = scalar.margin(value, thresholds.get(scalar).unwrap_or(0.0), design);
        if margin < 0.0 { theme::bad(ui) } else { theme::good(ui) }
    };
    // The clearance has a line of its own, with the members between which it is.
    let limited = thresholds.iter().filter(|(scalar, _)| *scalar != PoseScalar::Clearance);
    let values = limited.filter_map(|(scalar, _)| Some((scalar, report.values.get(scalar)?)));
    Grid::new("pose numbers")
        .num_columns(4)
        .spacing([10.0, 2.0])
        .show(ui, |ui| {
            for (index, (scalar, value)) in values.enumerate() {
                let entry = scalar.entry();
                ui.label(entry.quantity.short).on_hover_text(entry.label);
                let words = format!("{} {}", theme::number(value), entry.quantity.unit);
                ui.colored_label(color(ui, scalar, value), words);
                if index % 2 == 1 {
                    ui.end_row();
                }
            }
        });
    let nearest = &report.nearest;
    let color = color(ui, PoseScalar::Clearance, nearest.distance);
    ui.colored_label(color, format!("clearance: {}", text::clearance(nearest)));
    let unit = design.architecture().actuator().unit();
    let actuators = report.actuators.map(theme::number).join(", ");
    ui.weak(format!(
        "actuators {actuators} {unit}; limit margin {} m",
        theme::number(report.values[PoseScalar::Reach])
    ));
}
