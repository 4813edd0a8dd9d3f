//! The motion panel: the selected design follows the motion of the study being edited. Curves tell what that asks of the drives, and the
//! motion can be played.

use std::sync::Arc;

use egui::{Align, ComboBox, Layout, RichText, ScrollArea, Slider, Stroke, Ui, WidgetInfo, WidgetType};
use egui_plot::{Line, Plot, PlotPoints, VLine};
use kinefront_model::certify::MotionVerdict;
use kinefront_model::evaluation::{Bound, Quantity, TaskFigures, TaskSample, largest_of_legs};
use kinefront_model::mechanism::JointKind;
use kinefront_scene::{MotionCurve, PathColor, drawn_samples, text};
use kinefront_study::{TaskSection, TaskShapeChoice};

use super::{button, fields, play_button};
use crate::threads::{FollowedMotion, MotionAnswer};
use crate::{Session, theme};

/// Width of the fields \[points\].
const FORM: f32 = 330.0;

/// Least height of the curves \[points\].
const LEAST_PLOT: f32 = 110.0;

/// Rates of playback.
const RATES: [f64; 4] = [1.0, 0.5, 0.2, 0.05];

/// The paths that a motion can have.
const SHAPES: [(&str, TaskShapeChoice); 4] = [
    ("Pick and place", TaskShapeChoice::PickAndPlace),
    ("Circle", TaskShapeChoice::Circle),
    ("Star", TaskShapeChoice::Star),
    ("Waypoints", TaskShapeChoice::Waypoints),
];

/// The motion panel.
pub struct MotionPanel {
    curve: MotionCurve,
    /// Time of the cursor \[s\].
    at: f64,
    /// Whether the motion is being played.
    is_playing: bool,
    /// Seconds of the motion per second of playback.
    rate: f64,
    drawn: Option<Drawn>,
}

impl Default for MotionPanel {
    fn default() -> Self {
        Self {
            curve: MotionCurve::Force,
            at: 0.0,
            is_playing: false,
            rate: RATES[0],
            drawn: None,
        }
    }
}

/// The curves of a motion: they are the same from frame to frame.
struct Drawn {
    answer: Arc<MotionAnswer>,
    curve: MotionCurve,
    /// The curve over time, one for each leg.
    over_time: [Vec<[f64; 2]>; 3],
    /// Force over speed, one for each leg.
    over_speed: [Vec<[f64; 2]>; 3],
}

impl Drawn {
    fn new(answer: &Arc<MotionAnswer>, followed: &FollowedMotion, curve: MotionCurve) -> Self {
        let samples = drawn_samples(&followed.samples);
        let of_legs = |point: &dyn Fn(&TaskSample, usize) -> [f64; 2]| {
            [0, 1, 2].map(|leg| samples.iter().map(|sample| point(sample, leg)).collect())
        };
        Self {
            answer: Arc::clone(answer),
            curve,
            over_time: of_legs(&|sample, leg| [sample.instant.time, curve.values(sample)[leg]]),
            over_speed: of_legs(&|sample, leg| [sample.response.speeds[leg], sample.response.forces[leg]]),
        }
    }

    fn is_of(&self, answer: &Arc<MotionAnswer>, curve: MotionCurve) -> bool {
        Arc::ptr_eq(&self.answer, answer) && self.curve == curve
    }
}

impl MotionPanel {
    /// Draws the panel.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        let Some(known) = session.known() else {
            ui.weak("Click a design in the scatter to see it follow the motion of the study here.");
            return;
        };
        let actuator = known.evaluation.design.architecture().actuator();
        if session.editor().study().task.shape.is_none() {
            self.is_playing = false;
            self.offer(ui, session);
            return;
        }
        let (width, height) = (FORM.min(0.45 * ui.available_width()), ui.available_height());
        if ui.available_width() < 2.0 * FORM {
            // There is no room side by side.
            ScrollArea::vertical().show(ui, |ui| {
                self.followed(ui, session, actuator, height);
                ui.separator();
                form(ui, session);
            });
            return;
        }
        ui.horizontal_top(|ui| {
            ui.allocate_ui_with_layout(egui::vec2(width, height), Layout::top_down(Align::Min), |ui| {
                ScrollArea::vertical()
                    .id_salt("motion fields")
                    .show(ui, |ui| form(ui, session));
            });
            ui.separator();
            ui.vertical(|ui| self.followed(ui, session, actuator, height));
        });
    }

    /// Offers paths where the study asks for no motion.
    fn offer(&mut self, ui: &mut Ui, session: &mut Session) {
        ui.label("The study has no motion. Choose a path for the platform:");
        ui.horizontal_wrapped(|ui| {
            for (name, shape) in SHAPES {
                if ui.button(name).clicked() {
                    change(session, |task| task.go(shape));
                }
            }
        });
        ui.weak("The motion becomes part of the study for the next run.");
    }

    /// Shows what came of the motion, in a panel of a height.
    fn followed(&mut self, ui: &mut Ui, session: &mut Session, actuator: JointKind, height: f32) {
        let top = ui.cursor().top();
        let Some(answer) = session.motion() else {
            ui.weak("Following the motion…");
            return;
        };
        let followed = match answer.as_ref() {
            Ok(Some(followed)) => followed,
            Ok(None) => return,
            Err(message) => {
                ui.colored_label(theme::bad(ui), message);
                return;
            }
        };
        let Some((figures, cycle)) = figures(followed) else {
            self.is_playing = false;
            let reason = text::motion_fault(&followed.outcome).unwrap_or_default();
            ui.colored_label(theme::bad(ui), reason);
            return;
        };
        let known = self.drawn.take().filter(|drawn| drawn.is_of(&answer, self.curve));
        let drawn = known.unwrap_or_else(|| Drawn::new(&answer, followed, self.curve));
        self.play(ui, session, &answer, cycle);
        self.choose(ui, session, actuator, followed);
        summary(ui, figures, cycle, actuator);
        if let Some(proof) = &followed.proof {
            let color = match proof.verdict {
                MotionVerdict::Proved(_) => theme::good(ui),
                MotionVerdict::Refuted(_) | MotionVerdict::Open(_) => theme::bad(ui),
            };
            ui.colored_label(color, text::motion_proof(proof, actuator));
        }
        if let Some(words) = text::selected_drive(&followed.catalogue, &followed.outcome) {
            let carries = followed.outcome.drive.is_some_and(|drive| drive.carries());
            let color = if carries { theme::good(ui) } else { theme::bad(ui) };
            ui.colored_label(color, format!("drives: {words}"));
        }
        let height = (height - (ui.cursor().top() - top) - 4.0).max(LEAST_PLOT);
        self.plots(ui, session, &answer, (&drawn, followed, figures, actuator), height);
        self.drawn = Some(drawn);
    }

    /// Shows the buttons and the slider of the playback, and moves the platform while it is played.
    fn play(&mut self, ui: &mut Ui, session: &mut Session, answer: &MotionAnswer, cycle: f64) {
        ui.horizontal(|ui| {
            play_button(ui, &mut self.is_playing);
            let rate = ui.label("rate").id;
            ComboBox::from_id_salt("rate of playback")
                .width(56.0)
                .selected_text(format!("{}×", self.rate))
                .show_ui(ui, |ui| {
                    for rate in RATES {
                        ui.selectable_value(&mut self.rate, rate, format!("{rate}×"));
                    }
                })
                .response
                .labelled_by(rate);
            if self.is_playing {
                self.at = (self.at + self.rate * f64::from(ui.input(|input| input.stable_dt))) % cycle;
                session.move_to_time(answer, self.at);
                ui.ctx().request_repaint();
            }
            let label = ui.label("time").id;
            ui.spacing_mut().slider_width = (ui.available_width() - 80.0).clamp(60.0, 400.0);
            self.at = self.at.min(cycle);
            // A slider with fewer decimals would round the time, and so end the playback.
            let slider = Slider::new(&mut self.at, 0.0..=cycle).custom_formatter(|time, _| format!("{time:.3} s"));
            let slider = slider.custom_parser(|text| text.trim().trim_end_matches('s').trim().parse().ok());
            if ui.add(slider).labelled_by(label).changed() {
                self.is_playing = false;
                session.move_to_time(answer, self.at);
            }
        });
    }

    /// Shows the choice of the curve and of the colours of the path.
    fn choose(&mut self, ui: &mut Ui, session: &mut Session, actuator: JointKind, followed: &FollowedMotion) {
        ui.horizontal_wrapped(|ui| {
            for curve in MotionCurve::ALL {
                theme::choice(ui, &mut self.curve, curve, curve.name(actuator));
            }
        });
        ui.horizontal(|ui| {
            for leg in 0..3 {
                let color = theme::legible(theme::series(leg), ui);
                ui.label(RichText::new(format!("■\u{a0}leg\u{a0}{}", leg + 1)).color(color));
            }
            ui.separator();
            let label = ui.label("path in 3-D").id;
            let fields = session.fields();
            let path = &mut session.view_mut().layers.path;
            let shown = path.map_or("hidden".into(), |path| path.title(actuator));
            let choice = ComboBox::from_id_salt("colours of the path")
                .selected_text(shown)
                .show_ui(ui, |ui| {
                    ui.selectable_value(path, None, "hidden");
                    let curves = MotionCurve::ALL.into_iter().map(PathColor::Curve);
                    for choice in curves.chain(fields.into_iter().map(PathColor::Field)) {
                        ui.selectable_value(path, Some(choice), choice.title(actuator));
                    }
                })
                .response
                .labelled_by(label);
            if let Some([low, high]) = followed.path.as_ref().map(|path| path.range) {
                let words = format!("dark {} to bright {}", theme::number(low), theme::number(high));
                choice.on_hover_text(words);
            }
        });
    }

    /// Draws the curve over time and the force over the speed.
    fn plots(
        &mut self,
        ui: &mut Ui,
        session: &mut Session,
        answer: &MotionAnswer,
        (drawn, followed, figures, actuator): (&Drawn, &FollowedMotion, &TaskFigures, JointKind),
        height: f32,
    ) {
        ui.columns(2, |columns| {
            let [time, speed] = columns else { return };
            let title = self.curve.title(actuator);
            let shown = plot(&title, "time [s]", &title, height).show(time, |plot| {
                for (leg, points) in drawn.over_time.iter().enumerate() {
                    plot.line(line(leg, points));
                }
                plot.vline(VLine::new("", self.at).color(theme::SELECTED).allow_hover(false));
            });
            let response = shown.response;
            response.widget_info(|| WidgetInfo::labeled(WidgetType::Image, true, format!("{title} over time")));
            if (response.clicked() || response.dragged())
                && let Some(pointer) = response.interact_pointer_pos()
            {
                self.at = shown.transform.value_from_position(pointer).x.max(0.0);
                self.is_playing = false;
                session.move_to_time(answer, self.at);
            }
            let [along, across] = [MotionCurve::Speed, MotionCurve::Force].map(|curve| curve.title(actuator));
            let name = format!("{across} over {along}");
            let selected = followed.outcome.drive;
            let drive = selected.and_then(|selected| followed.catalogue.get(selected.place));
            let (limits, words) = match drive {
                Some(drive) => ([drive.speed, drive.peak], drive.name.as_str()),
                None => drive_box(session, figures, actuator),
            };
            let response = plot(&name, &along, &across, height)
                .show(speed, |plot| {
                    for (leg, points) in drawn.over_speed.iter().enumerate() {
                        plot.line(line(leg, points));
                    }
                    let [v, f] = limits;
                    let corners = vec![[-v, -f], [v, -f], [v, f], [-v, f], [-v, -f]];
                    let stroke = Stroke::new(1.4, theme::SELECTED);
                    plot.line(Line::new(words, PlotPoints::from(corners)).stroke(stroke));
                })
                .response;
            response.widget_info(|| WidgetInfo::labeled(WidgetType::Image, true, name.clone()));
            response.on_hover_text(words);
        });
    }
}

/// Shows the fields of the motion and of what moves.
fn form(ui: &mut Ui, session: &mut Session) {
    ui.horizontal_wrapped(|ui| {
        let shape = session.editor().study().task.shape;
        let label = ui.label("path").id;
        let shown = SHAPES.iter().find(|(_, choice)| Some(*choice) == shape);
        ComboBox::from_id_salt("path of the motion")
            .width(96.0)
            .selected_text(shown.map_or("", |(name, _)| name))
            .show_ui(ui, |ui| {
                for (name, choice) in SHAPES {
                    if ui.selectable_label(Some(choice) == shape, name).clicked() {
                        change(session, |task| task.go(choice));
                    }
                }
            })
            .response
            .labelled_by(label);
        let hint = "adds the current pose of the platform to the waypoints";
        if button(ui, "Add the pose", hint)
            && let Some(pose) = session.pose()
        {
            session.add_waypoint(pose);
        }
        let drawing = session.view().drawing_path;
        let draw = ui.add(theme::toggle(drawing, "Draw"));
        let hint = "clicks in the plan view of the panel Pose add waypoints";
        if draw.on_hover_text(hint).clicked() {
            session.view_mut().drawing_path = !drawing;
        }
        if ui.button("No motion").clicked() {
            session.view_mut().drawing_path = false;
            change(session, |task| *task = TaskSection::default());
        }
    });
    fields::of_sections(ui, session, &["task", "payload", "drives", "loads"]);
}

/// Changes the motion of the study being edited, as a step that can be undone.
fn change(session: &mut Session, change: impl FnOnce(&mut TaskSection)) {
    session.editor_mut().change(|study| change(&mut study.task));
    session.editor_mut().end_gesture();
}

/// Returns the figures of a motion that is followed to its end, with the time of its cycle \[s\].
fn figures(followed: &FollowedMotion) -> Option<(&TaskFigures, f64)> {
    let figures = followed.outcome.result.as_ref()?.as_ref().ok()?;
    Some((figures, followed.outcome.motion.as_ref()?.cycle_time()))
}

/// Tells the figures of a motion in a line.
fn summary(ui: &mut Ui, figures: &TaskFigures, cycle: f64, actuator: JointKind) {
    let most = |values: [f64; 3]| theme::number(largest_of_legs(values));
    let unit = |curve: MotionCurve| curve.unit(actuator);
    ui.horizontal_wrapped(|ui| {
        ui.label(format!(
            "cycle {} s · speed {} {} · {} {} {} (RMS {}) · power {} W · energy {} J",
            theme::number(cycle),
            most(figures.peak_speed),
            unit(MotionCurve::Speed),
            MotionCurve::Force.name(actuator),
            most(figures.peak_force),
            unit(MotionCurve::Force),
            most(figures.rms_force),
            most(figures.peak_power),
            theme::number(figures.energy_shared),
        ))
        .on_hover_text("largest value of the three actuators; energy per cycle if the drives share recovered energy");
        if !figures.inside_workspace {
            ui.colored_label(theme::active(ui), "leaves the regular workspace");
        }
    });
}

/// Returns half the sides of a box in speed and force that holds the motion, and what it is: the limits of the study, or the largest
/// values where it states none.
fn drive_box(session: &Session, figures: &TaskFigures, actuator: JointKind) -> ([f64; 2], &'static str) {
    let quantities = match actuator {
        JointKind::Prismatic => [Quantity::PathSpeed, Quantity::PathForce],
        JointKind::Revolute => [Quantity::PathRate, Quantity::PathTorque],
    };
    let limit = |quantity| {
        let limits = session.model().settings().limits.iter();
        limits
            .filter(|limit| limit.quantity == quantity)
            .find_map(|limit| match limit.bound {
                Bound::AtMost(most) => Some(most),
                _ => None,
            })
    };
    if let [Some(speed), Some(force)] = quantities.map(limit) {
        return ([speed, force], "limits of the study");
    }
    let least = [figures.peak_speed, figures.peak_force].map(largest_of_legs);
    (least, "the smallest sufficient drive, one type for all legs")
}

fn line<'a>(leg: usize, points: &[[f64; 2]]) -> Line<'a> {
    let name = format!("leg {}", leg + 1);
    Line::new(name, PlotPoints::from(points.to_vec()))
        .color(theme::series(leg))
        .width(1.6)
}

fn plot<'a>(id: &str, x: &str, y: &str, height: f32) -> Plot<'a> {
    Plot::new(id.to_owned())
        .height(height)
        .x_axis_label(x.to_owned())
        .y_axis_label(y.to_owned())
        .allow_scroll(false)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_boxed_zoom(false)
}
