//! The manipulator at a pose, to scale.

use glam::{DVec2, DVec3};

use super::{Label, Line, Part, Scene, Solid, SolidShape};
use crate::evaluation::{Model, Unreachable};
use crate::mechanism::{Design, Leg, LegPart, Manipulator, with_leg};
use crate::spatial::{ANCHOR_DIRECTIONS, Pose, unit};

/// Radius of a pin as a multiple of the thickest bar's.
const PIN_RADIUS: f64 = 1.3;
/// Height of a pin beyond its bars, as a multiple of the thickest bar's radius.
const PIN_HEIGHT: f64 = 1.7;
/// Half length and half width of a slider block as multiples of a pin's radius.
const SLIDER: (f64, f64) = (2.0, 1.25);
/// Least size of joints and frames as a share of `R`, so that a thin-barred design can be read.
const LEAST: f64 = 0.008;

/// Shapes of `design` at `pose`.
///
/// # Errors
/// The leg that does not get there.
pub fn manipulator(model: &Model, design: &Design, pose: &Pose) -> Result<Scene, Unreachable> {
    with_leg!(design.architecture, L => draw::<L>(model, design, pose))
}

fn flat(point: DVec2) -> DVec3 {
    point.extend(0.0)
}

fn draw<L: Leg>(model: &Model, design: &Design, pose: &Pose) -> Result<Scene, Unreachable> {
    let manipulator = Manipulator::<L>::new(design, &model.legs);
    let posture = manipulator
        .posture(pose)
        .map_err(|(leg, shortfall)| Unreachable { leg, shortfall })?;
    let mut scene = Scene::default();
    let thickest = design.leg_bar_radius.max(design.platform_bar_radius);
    let pin = (PIN_RADIUS * thickest).max(LEAST * design.base_radius);
    let height = (PIN_HEIGHT * thickest).max(1.4 * LEAST * design.base_radius);

    let anchors = ANCHOR_DIRECTIONS.map(|direction| flat(direction * design.base_radius));
    scene.lines.push(Line {
        part: Part::Base,
        points: vec![anchors[0], anchors[1], anchors[2], anchors[0]],
    });
    frame(&mut scene, DVec2::ZERO, 0.0, 0.12 * design.base_radius, "O");
    frame(&mut scene, pose.position, pose.phi, 0.12 * design.base_radius, "P");

    for (index, (leg, state)) in manipulator.legs.iter().zip(&posture.legs).enumerate() {
        let c = pose.position + posture.arms[index];
        let number = index + 1;
        let bar = |from: DVec2, to: DVec2, radius: f64| SolidShape::Bar {
            from: flat(from),
            to: flat(to),
            radius,
        };
        let joint = |at: DVec2| SolidShape::Bar {
            from: at.extend(-height),
            to: at.extend(height),
            radius: pin,
        };
        let line = |part: Part, from: DVec2, to: DVec2| Line {
            part,
            points: vec![flat(from), flat(to)],
        };
        let solid = |part: Part, shape: SolidShape| Solid {
            part,
            leg: Some(index),
            shape,
        };
        for part in leg.parts(state) {
            match part {
                LegPart::Rail { from, to } => scene.lines.push(line(Part::Rail, from, to)),
                LegPart::Stroke { from, to } => scene.lines.push(line(Part::Stroke, from, to)),
                LegPart::Slider { at, axis } => {
                    let shape = SolidShape::Block {
                        centre: flat(at),
                        half_size: DVec3::new(SLIDER.0 * pin, SLIDER.1 * pin, 0.7 * height),
                        angle: libm::atan2(axis.y, axis.x),
                    };
                    scene.solids.push(solid(Part::Slider, shape));
                }
                LegPart::Tube { from, to } => {
                    // The tube holds the rod: it is drawn a third wider than the bar of radius r_j.
                    let shape = bar(from, to, 4.0 / 3.0 * design.leg_bar_radius);
                    scene.solids.push(solid(Part::Tube, shape));
                }
                LegPart::Rod { from, to } => {
                    scene
                        .solids
                        .push(solid(Part::Rod, bar(from, to, design.leg_bar_radius)));
                }
                LegPart::Crank { from, to } => {
                    scene
                        .solids
                        .push(solid(Part::Crank, bar(from, to, design.leg_bar_radius)));
                }
                LegPart::Link { from, to } => {
                    scene
                        .solids
                        .push(solid(Part::Link, bar(from, to, design.leg_bar_radius)));
                }
                LegPart::Joint { at, actuated } => {
                    let part = if actuated {
                        Part::ActuatedJoint
                    } else {
                        Part::PassiveJoint
                    };
                    scene.solids.push(solid(part, joint(at)));
                }
            }
        }
        scene.solids.push(solid(
            Part::PlatformBar,
            bar(c, pose.position, design.platform_bar_radius),
        ));
        let lift = 2.0 * height;
        let mut label = |at: DVec2, text: String| {
            scene.labels.push(Label {
                at: at.extend(lift),
                text,
            })
        };
        label(leg.anchor(), format!("A{number}"));
        if state.b != leg.anchor() {
            label(state.b, format!("B{number}"));
        }
        label(c, format!("C{number}"));
    }
    Ok(scene)
}

fn frame(scene: &mut Scene, origin: DVec2, angle: f64, length: f64, name: &str) {
    for (part, angle) in [(Part::AxisX, angle), (Part::AxisY, angle + std::f64::consts::FRAC_PI_2)] {
        scene.lines.push(Line {
            part,
            points: vec![flat(origin), flat(origin + unit(angle) * length)],
        });
    }
    // Beside the origin, where no bar of the platform runs at home.
    scene.labels.push(Label {
        at: flat(origin + unit(angle - std::f64::consts::FRAC_PI_4) * (0.35 * length)),
        text: name.to_owned(),
    });
}
