//! The strength panel: the stress of every bar at the pose, and which of them buckles first, under the loads of the study or under a wrench
//! that is turned by hand.

use egui::{DragValue, Grid, ScrollArea, Slider, Ui};
use kinefront_model::mechanism::JointKind;
use kinefront_model::strength::{LARGEST_FACTOR, MemberStrength, StrengthReport};
use kinefront_scene::text::{self, number};

use super::{share_bar, typed};
use crate::{Session, theme};

/// The strength panel.
pub struct StrengthPanel {
    wrench: PlatformWrench,
}

impl Default for StrengthPanel {
    fn default() -> Self {
        Self {
            wrench: PlatformWrench {
                in_plane: 100.0,
                direction: 0.0,
                along_z: 0.0,
                moment: 0.0,
            },
        }
    }
}

/// A wrench on the platform at `P`, by what is set of it.
struct PlatformWrench {
    /// Force in the plane \[N\], and the angle from x at which it acts \[deg\].
    in_plane: f64,
    direction: f64,
    /// Force along z \[N\].
    along_z: f64,
    /// Moment about z \[N·m\].
    moment: f64,
}

impl PlatformWrench {
    /// Returns the forces \[N\] and the moments \[N·m\].
    fn components(&self) -> [f64; 6] {
        let (sine, cosine) = libm::sincos(self.direction.to_radians());
        let (x, y) = (self.in_plane * cosine, self.in_plane * sine);
        [x, y, self.along_z, 0.0, 0.0, self.moment]
    }

    fn ui(&mut self, ui: &mut Ui) {
        Grid::new("wrench").num_columns(2).spacing([10.0, 4.0]).show(ui, |ui| {
            for (name, value, unit) in [
                ("force in the plane", &mut self.in_plane, " N"),
                ("force along z", &mut self.along_z, " N"),
                ("moment about z", &mut self.moment, " N·m"),
            ] {
                let label = ui.label(name).id;
                let field = DragValue::new(value).speed(1.0).range(-1e9..=1e9).suffix(unit);
                ui.add(typed(ui, field)).labelled_by(label);
                ui.end_row();
            }
            let label = ui.label("direction").id;
            ui.add(Slider::new(&mut self.direction, -180.0..=180.0).suffix("°"))
                .labelled_by(label);
            ui.end_row();
        });
    }
}

impl StrengthPanel {
    /// Draws the panel.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        let Some((known, pose)) = session.known().zip(session.pose()) else {
            ui.weak("Click a design in the scatter to see the stresses of its bars here.");
            return;
        };
        let design = known.evaluation.design;
        ScrollArea::vertical().show(ui, |ui| {
            let layers = &mut session.view_mut().layers;
            let mut is_single = layers.wrench.is_some();
            ui.radio_value(
                &mut is_single,
                false,
                "under the loads of the study, in their worst directions",
            );
            ui.radio_value(&mut is_single, true, "under one wrench, drawn as arrows at P");
            if is_single {
                self.wrench.ui(ui);
            }
            layers.wrench = is_single.then(|| self.wrench.components());
            ui.checkbox(&mut layers.stresses, "Bars coloured by stress");
            let wrench = layers.wrench;
            ui.separator();
            let model = session.model();
            let yield_strength = model.settings().material.yield_strength;
            match model.posed(&design).strength_at(&pose, wrench) {
                Ok(Some(report)) => found(ui, &report, yield_strength, design.architecture().actuator()),
                _ => {
                    ui.colored_label(theme::bad(ui), "At a singular pose the stresses are unlimited.");
                }
            }
        });
    }
}

/// Shows the strength at a pose.
fn found(ui: &mut Ui, report: &StrengthReport, yield_strength: Option<f64>, actuator: JointKind) {
    if let Some(factor) = report.safety_factor {
        ui.strong(format!("safety factor against yielding {}", at_most(factor)));
    }
    if let Some(factor) = report.buckling_factor {
        ui.strong(format!("buckling factor at least {}", at_most(factor)));
        ui.label(buckling_words(&report.members));
    }
    let efforts = report.actuators.map(number).join(", ");
    ui.label(format!("actuators {efforts} {}", actuator.effort_unit()));
    ui.label(format!(
        "largest force of a joint {} N, moment {} N·m",
        number(report.joint_force),
        number(report.joint_moment)
    ));
    ui.add_space(4.0);
    ui.label(match yield_strength {
        Some(_) => "largest stress of each bar, and its part of the yield strength",
        None => "largest stress of each bar",
    });
    let whole = yield_strength.unwrap_or(report.stress).max(f64::MIN_POSITIVE);
    for member in &report.members {
        let share = member.stress / whole;
        let of_yield = yield_strength.map_or(String::new(), |_| format!(", {} %", number(100.0 * share)));
        let words = format!(
            "{}: {} MPa{of_yield}",
            text::member(&member.member),
            number(1e-6 * member.stress)
        );
        let color = if yield_strength.is_some() && share > 1.0 {
            theme::bad(ui)
        } else {
            theme::active(ui)
        };
        share_bar(ui, share as f32, &words, color).on_hover_text(member_words(member));
    }
}

/// Returns a factor as text; those beyond the largest one are not told apart.
fn at_most(factor: f64) -> String {
    if factor < LARGEST_FACTOR {
        number(factor)
    } else {
        format!("above {}", number(LARGEST_FACTOR))
    }
}

/// Says which bar buckles first.
fn buckling_words(members: &[MemberStrength]) -> String {
    let factors = members
        .iter()
        .filter_map(|member| Some((member.member, member.buckling_factor?)));
    match factors.min_by(|a, b| a.1.total_cmp(&b.1)) {
        Some((member, factor)) if factor < LARGEST_FACTOR => format!(
            "The {} is nearest to buckling: alone, at {} times these loads.",
            text::member(&member),
            number(factor)
        ),
        _ => "No bar is compressed.".to_owned(),
    }
}

/// Says what a bar carries.
fn member_words(member: &MemberStrength) -> String {
    let [least, most] = member.axial;
    let buckling = match member.buckling_factor {
        Some(factor) if factor < LARGEST_FACTOR => format!("\nbuckles alone at {} times these loads", number(factor)),
        _ => String::new(),
    };
    format!(
        "largest at {:.0} % of its length, from the base\naxial force {} to {} N (tension is positive)\nbending {} N·m in the plane, {} N·m out of \
         it, torsion {} N·m{buckling}",
        100.0 * member.share,
        number(least),
        number(most),
        number(member.moment_in_plane),
        number(member.moment_out_of_plane),
        number(member.torsion),
    )
}
