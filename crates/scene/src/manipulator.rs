//! The manipulator at a pose, to scale.

use glam::{DVec2, DVec3};

use super::{Label, Nearest, Part, Scene, Solid, SolidShape, surroundings};
use crate::text::number;
use kinefront_model::clearance::{Bodies, Clearance, Neighbour, Stack, UprightBody};
use kinefront_model::evaluation::{Model, ModelSettings, PoseScalar, Unreachable};
use kinefront_model::mechanism::{
    AnyLeg, Design, JointKind, JointPoint, Leg, LegPart, Manipulator, MemberKind, Posture, TravelKind,
};
use kinefront_model::spatial::{LEGS, Pose, unit};

/// Distance from a member's axis to the end of a pin, as a multiple of the member's radius.
const PIN: f64 = 1.2;
/// Radius of a telescopic leg's rod as a fraction of its tube's radius.
const ROD: f64 = 0.75;
/// Smallest size of drawn details such as joints, as a fraction of `R`, so that a design with thin bars remains
/// legible.
const LEAST: f64 = 0.008;

/// Builds the shapes of `design` at `pose`.
///
/// # Errors
/// [`Unreachable`], which names the leg that does not reach the pose.
pub fn manipulator(model: &Model, design: &Design, pose: &Pose) -> Result<Scene, Unreachable> {
    let (manipulator, posture) = posed(model, design, pose)?;
    let bodies = model.bodies_of(design);
    let clearance = bodies.nearest(&manipulator, pose.position, &posture);
    let mut scene = Scene {
        nearest: Some(nearest(model, design, &bodies, &clearance)),
        ..Scene::default()
    };
    let sizes = Sizes::new(model, design, *bodies.stack());

    // The base triangle lies at the height of the members that are attached to it.
    let base = sizes.stack.base_height(design);
    let anchors = manipulator.legs.each_ref().map(|leg| leg.frame().anchor.extend(base));
    scene.add_line(Part::Base, [anchors[0], anchors[1], anchors[2], anchors[0]]);
    frame(&mut scene, DVec2::ZERO, 0.0, 0.12 * design.base_radius(), "O");
    frame(&mut scene, pose.position, pose.phi, 0.12 * design.base_radius(), "P");

    let lift = label_height(design, &sizes);
    surroundings::add(&mut scene, &model.settings().surroundings, [-lift, lift]);
    let joints = bodies.joints(&manipulator, pose.position, &posture);
    let motors = joints.iter().filter(|joint| joint.member.kind == MemberKind::Motor);
    scene.solids.extend(motors.map(motor));
    for (index, (leg, state)) in manipulator.legs.iter().zip(&posture.legs).enumerate() {
        let c = pose.position + posture.arms[index];
        let number = index + 1;
        for travel in leg.travels(state) {
            let (part, kind) = match travel.kind {
                TravelKind::Rail => (Part::Rail, MemberKind::Slider),
                TravelKind::Stroke => (Part::Stroke, MemberKind::TelescopicLeg),
            };
            let height = sizes.height(kind, index);
            scene.add_line(part, [travel.from, travel.to].map(|end| end.extend(height)));
        }
        for body in leg.bodies(state) {
            let solids = body.parts.iter().map(|part| sizes.solid(index, part));
            scene.solids.extend(solids);
        }
        scene.solids.push(sizes.platform_bar(index, c, pose.position));
        let mut label = |at: DVec2, text: String| scene.add_label(at.extend(lift), text);
        let (anchor, b) = (leg.frame().anchor, state.chain.b);
        label(anchor, format!("A{number}"));
        if b != anchor {
            label(b, format!("B{number}"));
        }
        label(c, format!("C{number}"));
    }
    join_labels(&mut scene.labels, 0.015 * design.base_radius());
    Ok(scene)
}

/// Returns the manipulator with its posture at a pose, or the leg that does not reach it.
pub(super) fn posed(
    model: &Model,
    design: &Design,
    pose: &Pose,
) -> Result<(Manipulator<AnyLeg>, Posture), Unreachable> {
    let manipulator = Manipulator::<AnyLeg>::new(design, &model.settings().legs);
    let posture = manipulator.posture(pose);
    let posture = posture.map_err(|(leg, shortfall)| Unreachable { leg, shortfall })?;
    Ok((manipulator, posture))
}

/// Returns the height of the labels, above all members \[m\].
fn label_height(design: &Design, sizes: &Sizes<'_>) -> f64 {
    let chain = design.architecture().chain();
    let kinds = [chain.proximal, Some(chain.distal), Some(MemberKind::PlatformBar)];
    let members = kinds
        .into_iter()
        .flatten()
        .flat_map(|kind| (0..LEGS).map(move |leg| (kind, leg)));
    let top = members.fold(0.0, |top: f64, (kind, leg)| sizes.height(kind, leg).max(top));
    let thickest = design.leg_bar_radius().max(design.platform_bar_radius());
    top + 3.4 * thickest.max(LEAST * design.base_radius())
}

/// Joins labels that are nearer to each other than `distance` \[m\], because they would cover each other: "C1 C2 C3".
fn join_labels(labels: &mut Vec<Label>, distance: f64) {
    let mut joined: Vec<Label> = Vec::with_capacity(labels.len());
    for label in labels.drain(..) {
        match joined.iter_mut().find(|other| other.at.distance(label.at) < distance) {
            Some(other) => other.text = format!("{} {}", other.text, label.text),
            None => joined.push(label),
        }
    }
    *labels = joined;
}

fn flat(point: DVec2) -> DVec3 {
    point.extend(0.0)
}

/// Sizes and layer heights of the members of a design \[m\].
#[derive(Debug, Clone, Copy)]
pub(super) struct Sizes<'a> {
    settings: &'a ModelSettings,
    design: &'a Design,
    stack: Stack,
}

impl<'a> Sizes<'a> {
    /// Returns the sizes with the layers of the design, which a caller may know already: choosing them takes longer than all else.
    pub(super) fn new(model: &'a Model, design: &'a Design, stack: Stack) -> Self {
        Self {
            settings: model.settings(),
            design,
            stack,
        }
    }

    /// Returns the height of the layer of a kind of member of a leg.
    pub(super) fn height(&self, kind: MemberKind, leg: usize) -> f64 {
        self.stack.height(kind, leg, self.design)
    }

    /// Returns the radius of the bars of a kind of member.
    pub(super) fn radius(&self, kind: MemberKind) -> f64 {
        self.settings.bodies.radius(kind, self.design)
    }

    fn bar(&self, leg: usize, kind: MemberKind, from: DVec2, to: DVec2, fraction: f64) -> SolidShape {
        let (z, outer) = (self.height(kind, leg), self.radius(kind));
        let section = match kind {
            MemberKind::PlatformBar => &self.settings.sections.platform,
            _ => &self.settings.sections.legs,
        };
        let [radius, inner] = [outer, section.inner_radius(outer)].map(|size| fraction * size);
        if section.is_square() {
            let way = to - from;
            return SolidShape::Block {
                centre: (0.5 * (from + to)).extend(z),
                half_size: DVec3::new(0.5 * way.length(), radius, radius),
                angle: libm::atan2(way.y, way.x),
                inner,
            };
        }
        SolidShape::Bar {
            from: from.extend(z),
            to: to.extend(z),
            radius,
            inner,
        }
    }

    /// Returns half the length of a carriage on a guide that moves.
    pub(super) fn carriage_half_length(&self) -> f64 {
        let half_width = self.radius(MemberKind::Slider);
        (self.slider_half_length() / 3.0).max(half_width)
    }

    fn slider_half_length(&self) -> f64 {
        self.settings.bodies.slider_half_length(self.design)
    }

    /// Returns a joint: its pin passes through the members it joins and is as thick as the thinner one, or thicker if it would otherwise be
    /// too thin to see; a joint that is a body has its own size if that is larger.
    fn pin(&self, leg: usize, at: DVec2, joins: [MemberKind; 2], kind: JointKind) -> SolidShape {
        let least = LEAST * self.design.base_radius();
        let ends = joins.map(|kind| {
            let out = (PIN * self.radius(kind)).max(1.4 * least);
            [self.height(kind, leg) - out, self.height(kind, leg) + out]
        });
        let bars = joins.into_iter().filter(|&kind| kind != MemberKind::Slider);
        let radius = bars.fold(f64::INFINITY, |least, kind| least.min(self.radius(kind)));
        let point = match joins {
            [_, MemberKind::PlatformBar] | [MemberKind::PlatformBar, _] => JointPoint::C,
            [first, second] if first == second => JointPoint::A,
            _ => JointPoint::B,
        };
        let is_revolute = kind == JointKind::Revolute;
        let body = is_revolute
            .then(|| self.stack.joint(leg, point, &self.settings.joint_sizes, self.design))
            .flatten();
        let [low, high, thick] = body.unwrap_or([f64::INFINITY, f64::NEG_INFINITY, 0.0]);
        SolidShape::Bar {
            from: at.extend(ends[0][0].min(ends[1][0]).min(low)),
            to: at.extend(ends[0][1].max(ends[1][1]).max(high)),
            radius: radius.max(least).max(thick),
            inner: 0.0,
        }
    }

    /// Returns a part of a leg as a solid.
    pub(super) fn solid(&self, leg: usize, part: &LegPart) -> Solid {
        let (part, shape) = match *part {
            LegPart::Slider { at, axis, actuated } => {
                let centre = at.extend(self.height(MemberKind::Slider, leg));
                self.carriage(centre, axis, self.slider_half_length(), actuated)
            }
            LegPart::Tube { from, to } => (Part::Tube, self.bar(leg, MemberKind::TelescopicLeg, from, to, 1.0)),
            // The rod slides inside the tube, so it is drawn thinner.
            LegPart::Rod { from, to } => (Part::Rod, self.bar(leg, MemberKind::TelescopicLeg, from, to, ROD)),
            // As wide as a slider, and shorter, so that carriages on crossing guides stay apart to the eye.
            LegPart::Carriage { at, axis, on, actuated } => self.carriage(
                at.extend(self.height(on, leg)),
                axis,
                self.carriage_half_length(),
                actuated,
            ),
            LegPart::GuideBar { from, to, kind } => (Part::Guide, self.bar(leg, kind, from, to, 1.0)),
            LegPart::Crank { from, to } => (Part::Crank, self.bar(leg, MemberKind::Crank, from, to, 1.0)),
            LegPart::Link { from, to } => (Part::Link, self.bar(leg, MemberKind::Link, from, to, 1.0)),
            LegPart::Joint {
                at,
                actuated,
                joins,
                kind,
            } => {
                let part = if actuated {
                    Part::ActuatedJoint
                } else {
                    Part::PassiveJoint
                };
                (part, self.pin(leg, at, joins, kind))
            }
        };
        Solid::new(part, Some(leg), shape)
    }

    /// Returns a slider or carriage along `axis` with the part that it is.
    fn carriage(&self, centre: DVec3, axis: DVec2, half_length: f64, actuated: bool) -> (Part, SolidShape) {
        let half_width = self.radius(MemberKind::Slider);
        let shape = SolidShape::Block {
            centre,
            half_size: DVec3::new(half_length, half_width, half_width),
            angle: libm::atan2(axis.y, axis.x),
            inner: 0.0,
        };
        (if actuated { Part::Slider } else { Part::Carriage }, shape)
    }

    /// Returns the platform bar that ends at a leg's `C_i`.
    pub(super) fn platform_bar(&self, leg: usize, c: DVec2, p: DVec2) -> Solid {
        let shape = self.bar(leg, MemberKind::PlatformBar, c, p, 1.0);
        Solid::new(Part::PlatformBar, Some(leg), shape)
    }
}

/// Returns the motor of a revolute joint.
pub(super) fn motor(body: &UprightBody) -> Solid {
    let [from, to] = body.heights.map(|height| body.at.extend(height));
    let shape = SolidShape::Bar {
        from,
        to,
        radius: body.radius,
        inner: 0.0,
    };
    Solid::new(Part::ActuatedJoint, Some(body.member.leg), shape)
}

/// Returns the pair of members with the smallest clearance as a line from surface to surface.
fn nearest(model: &Model, design: &Design, bodies: &Bodies, clearance: &Clearance) -> Nearest {
    let thickest = design.leg_bar_radius().max(design.platform_bar_radius());
    let [from, to] = clearance.between;
    let way = to - from;
    let member = bodies.radius_of(&clearance.member);
    let line = match &clearance.neighbour {
        _ if clearance.distance <= 0.0 || way == DVec3::ZERO => {
            let out = DVec3::Z * (4.0 * thickest).max(5.0 * LEAST * design.base_radius());
            let middle = 0.5 * (from + to);
            [middle - out, middle + out]
        }
        Neighbour::Member(other) => {
            let along = way.normalize_or_zero();
            [from + along * member, to - along * bodies.radius_of(other)]
        }
        Neighbour::Obstacle(_) | Neighbour::Room => [from + way.normalize_or_zero() * member, to],
        Neighbour::RailEnd { .. } => [from, to],
    };
    Nearest {
        line,
        text: format!("{} mm", number(1e3 * clearance.distance)),
        too_near: clearance.distance < model.settings().thresholds.get(PoseScalar::Clearance).unwrap_or(0.0),
    }
}

fn frame(scene: &mut Scene, origin: DVec2, angle: f64, length: f64, name: &str) {
    for (part, angle) in [(Part::AxisX, angle), (Part::AxisY, angle + std::f64::consts::FRAC_PI_2)] {
        scene.add_line(part, [flat(origin), flat(origin + unit(angle) * length)]);
    }
    // Beside the origin, in a direction in which no platform bar lies at the home orientation.
    let beside = unit(angle - std::f64::consts::FRAC_PI_4) * (0.35 * length);
    scene.add_label(flat(origin + beside), name);
}
