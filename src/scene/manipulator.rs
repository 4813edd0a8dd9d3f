//! The manipulator at a pose, to scale.

use glam::{DVec2, DVec3};

use super::{Label, Line, Part, Scene, Solid, SolidShape};
use crate::evaluation::{Model, Unreachable};
use crate::mechanism::{Design, Guide, Leg, LegPart, Manipulator, with_leg};
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

/// Sizes of what the design does not state: joints and sliders, after its thickest bar \[m\].
#[derive(Debug, Clone, Copy)]
pub(super) struct Sizes {
    leg_bar: f64,
    platform_bar: f64,
    pin: f64,
    height: f64,
}

impl Sizes {
    pub(super) fn new(design: &Design) -> Self {
        let thickest = design.leg_bar_radius.max(design.platform_bar_radius);
        Self {
            leg_bar: design.leg_bar_radius,
            platform_bar: design.platform_bar_radius,
            pin: (PIN_RADIUS * thickest).max(LEAST * design.base_radius),
            height: (PIN_HEIGHT * thickest).max(1.4 * LEAST * design.base_radius),
        }
    }

    /// A member of a leg as a solid.
    pub(super) fn solid(&self, leg: usize, part: &LegPart) -> Solid {
        let bar = |from: DVec2, to: DVec2, radius: f64| SolidShape::Bar {
            from: flat(from),
            to: flat(to),
            radius,
        };
        let (part, shape) = match *part {
            LegPart::Slider { at, axis } => {
                let shape = SolidShape::Block {
                    centre: flat(at),
                    half_size: DVec3::new(SLIDER.0 * self.pin, SLIDER.1 * self.pin, 0.7 * self.height),
                    angle: libm::atan2(axis.y, axis.x),
                };
                (Part::Slider, shape)
            }
            // The tube holds the rod: it is drawn a third wider than the bar of radius r_j.
            LegPart::Tube { from, to } => (Part::Tube, bar(from, to, 4.0 / 3.0 * self.leg_bar)),
            LegPart::Rod { from, to } => (Part::Rod, bar(from, to, self.leg_bar)),
            LegPart::Crank { from, to } => (Part::Crank, bar(from, to, self.leg_bar)),
            LegPart::Link { from, to } => (Part::Link, bar(from, to, self.leg_bar)),
            LegPart::Joint { at, actuated } => {
                let shape = SolidShape::Bar {
                    from: at.extend(-self.height),
                    to: at.extend(self.height),
                    radius: self.pin,
                };
                let part = if actuated {
                    Part::ActuatedJoint
                } else {
                    Part::PassiveJoint
                };
                (part, shape)
            }
        };
        Solid {
            part,
            leg: Some(leg),
            shape,
        }
    }

    /// The platform's bar to the end of a leg.
    pub(super) fn platform_bar(&self, leg: usize, c: DVec2, p: DVec2) -> Solid {
        Solid {
            part: Part::PlatformBar,
            leg: Some(leg),
            shape: SolidShape::Bar {
                from: flat(c),
                to: flat(p),
                radius: self.platform_bar,
            },
        }
    }
}

fn draw<L: Leg>(model: &Model, design: &Design, pose: &Pose) -> Result<Scene, Unreachable> {
    let manipulator = Manipulator::<L>::new(design, &model.legs);
    let posture = manipulator
        .posture(pose)
        .map_err(|(leg, shortfall)| Unreachable { leg, shortfall })?;
    let mut scene = Scene::default();
    let sizes = Sizes::new(design);

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
        if let Some(guide) = leg.guide(state) {
            let (part, from, to) = match guide {
                Guide::Rail { from, to } => (Part::Rail, from, to),
                Guide::Stroke { from, to } => (Part::Stroke, from, to),
            };
            scene.lines.push(Line {
                part,
                points: vec![flat(from), flat(to)],
            });
        }
        for body in leg.bodies(state) {
            let solids = body.parts.iter().map(|part| sizes.solid(index, part));
            scene.solids.extend(solids);
        }
        scene.solids.push(sizes.platform_bar(index, c, pose.position));
        let lift = 2.0 * sizes.height;
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
