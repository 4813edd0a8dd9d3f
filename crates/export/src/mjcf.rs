//! MJCF for MuJoCo: legs as trees, the platform free in the plane, the connections at `C_1` to `C_3` as equality constraints, and
//! actuators as position servos whose gain is the study's actuator stiffness. The control of a servo counts from the exported pose, because
//! MuJoCo begins with controls of 0. The payload is part of the platform, the inertia of the rotors is that of the joints, and where the
//! study states a motion, a keyframe has each pose at which it rests.

use super::format::{AnyError, Contents, Format};
use super::prepared::{Prepared, inertial, joint_axis, joint_name, rgba};
use super::xml::Element;
use glam::DVec2;
use kinefront_model::dynamics::TaskInstant;
use kinefront_model::mechanism::JointKind;
use kinefront_scene::{Body, Frame, Joint, Linkage, Solid, SolidShape, linkage};

pub(super) const FORMAT: Format = Format {
    key: "mjcf",
    file: "design.xml",
    name: "MJCF",
    title: "MJCF, for MuJoCo",
    lost: Some("compliance of the bars, friction of the joints, and limits of the drives"),
    contents: Contents::Simulator {
        joints_from_zero: false,
    },
    write,
};

fn write(subject: &Prepared) -> Result<Vec<u8>, AnyError> {
    let root = Element::new("mujoco")
        .with("model", subject.identifier())
        .children(settings(subject))
        .child(world(subject))
        .child(Element::new("equality").children(closures(subject)))
        .child(Element::new("actuator").children(servos(subject)))
        .child(Element::new("sensor").children(["x", "y", "phi"].map(|axis| {
            Element::new("jointpos")
                .with("name", format!("platform_{axis}_value"))
                .with("joint", format!("platform_{axis}"))
        })))
        .child(Element::new("keyframe").child(start(subject)).children(rests(subject)));
    root.document(&FORMAT.preamble(subject))
}

/// Units, integrator, gravity, no contacts, and the stiffness of the closures.
fn settings(subject: &Prepared) -> [Element; 3] {
    [
        Element::new("compiler")
            .with("angle", "radian")
            .with("autolimits", "true"),
        // The servos have the stiffness K_act, which requires a short time step.
        Element::new("option")
            .with("timestep", "0.0001")
            .with("integrator", "implicitfast")
            .with_numbers("gravity", &subject.model.settings().dynamics.gravity),
        Element::new("default")
            .child(Element::new("geom").with("contype", "0").with("conaffinity", "0"))
            .child(
                Element::new("equality")
                    .with("solref", "0.0002 1")
                    .with("solimp", "0.9999 0.9999 0.001 0.5 2"),
            ),
    ]
}

/// Light, base, regular workspace, and the trees of bodies.
fn world(subject: &Prepared) -> Element {
    let mut world = Element::new("worldbody").child(
        Element::new("light")
            .with("directional", "true")
            .with("pos", "0 0 10")
            .with("dir", "0.3 0.4 -1"),
    );
    world = world.children(subject.base.iter().map(geom));
    world.children(workspace(subject)).children(trees(subject))
}

/// The workspace, of which a prescribed polygon is shown by its sides. A site is only displayed and does not take part in the
/// simulation.
fn workspace(subject: &Prepared) -> Vec<Element> {
    let site = |name: &str, kind: &str, color: &str| {
        Element::new("site")
            .with("name", name)
            .with("type", kind)
            .with("rgba", color)
    };
    match (&subject.corners, subject.cylinder) {
        (Some(corners), _) => {
            let sides = corners.iter().zip(corners.iter().cycle().skip(1)).enumerate();
            let side = |(place, (from, to)): (usize, (&DVec2, &DVec2))| {
                site(
                    &format!("regular_workspace_{}", place + 1),
                    "capsule",
                    "0.35 0.7 0.43 0.8",
                )
                .with_numbers("fromto", &[from.x, from.y, 0.0, to.x, to.y, 0.0])
                .with_numbers("size", &[2e-3 * subject.evaluation.design.base_radius()])
            };
            sides.map(side).collect()
        }
        (None, Some(cylinder)) => {
            let [x, y] = cylinder.centre.to_array();
            let disc = site("regular_workspace", "cylinder", "0.35 0.7 0.43 0.25")
                .with_numbers("pos", &[x, y, 0.0])
                .with_numbers("size", &[cylinder.radius, 1e-3]);
            vec![disc]
        }
        (None, None) => Vec::new(),
    }
}

/// The bodies, nested in their parents; each tree begins with a body that hangs on the base.
fn trees(subject: &Prepared) -> Vec<Element> {
    let bodies = &subject.linkage.bodies;
    // Children are created before their parents.
    let mut inside: Vec<Vec<Element>> = vec![Vec::new(); bodies.len()];
    for (place, body) in bodies.iter().enumerate().rev() {
        // The children were pushed from the last to the first.
        let nested: Vec<Element> = inside[place].drain(..).rev().collect();
        let element = element(subject, body).children(nested);
        inside[body.parent.unwrap_or(place)].push(element);
    }
    let roots = (0..bodies.len()).filter(|&place| bodies[place].parent.is_none());
    roots.flat_map(|place| inside[place].clone()).collect()
}

/// The connections at `C_1` to `C_3`, which close the loops.
fn closures(subject: &Prepared<'_>) -> impl Iterator<Item = Element> {
    let linkage = &subject.linkage;
    let platform = &linkage.bodies[linkage.platform()];
    linkage.closures.iter().enumerate().map(move |(leg, closure)| {
        // A weld keeps the relative pose of both bodies in the model as it is written. Its point is one of the second body, that of a
        // connection one of the first.
        let (kind, at) = match closure.is_rigid {
            true => ("weld", closure.on_platform),
            false => ("connect", closure.on_leg),
        };
        let [x, y] = at.to_array();
        Element::new(kind)
            .with("name", format!("C{}", leg + 1))
            .with("body1", linkage.bodies[closure.leg].name.clone())
            .with("body2", platform.name.clone())
            .with_numbers("anchor", &[x, y, 0.0])
    })
}

/// The bodies with an actuated joint, and these joints.
fn actuated<'a>(subject: &'a Prepared<'_>) -> impl Iterator<Item = (&'a Body, Joint)> {
    let bodies = subject.linkage.bodies.iter();
    bodies.filter_map(|body| Some((body, body.joint.filter(|joint| joint.actuated)?)))
}

/// Position servos whose gain is the study's actuator stiffness and whose control is the change of the joint value since the exported pose:
/// with controls of 0, as MuJoCo begins, they hold it. A positive damping ratio in place of a damping is one that MuJoCo computes.
fn servos(subject: &Prepared<'_>) -> impl Iterator<Item = Element> {
    actuated(subject).map(|(body, joint)| {
        let stiffness = subject.model.settings().actuators.of(joint.kind);
        let servo = Element::new("general")
            .with("name", format!("{}_servo", body.name))
            .with("joint", joint_name(body))
            .with_numbers("gainprm", &[stiffness])
            .with("biastype", "affine")
            .with_numbers("biasprm", &[stiffness * joint.value, -stiffness, 1.0]);
        match joint.limits {
            Some(limits) => servo.with_numbers("ctrlrange", &limits.map(|limit| limit - joint.value)),
            None => servo,
        }
    })
}

/// The exported pose, at which all controls are 0.
fn start(subject: &Prepared) -> Element {
    let controls: Vec<f64> = actuated(subject).map(|_| 0.0).collect();
    Element::new("key")
        .with("name", "start")
        .with_numbers("ctrl", &controls)
}

/// Largest number of poses of a motion that have a keyframe.
const MOST_RESTS: usize = 100;

/// The poses at which the motion of the study rests, as far as the design reaches them, with the values of all joints.
fn rests(subject: &Prepared) -> Vec<Element> {
    let Ok(motion) = subject.motion() else {
        return Vec::new();
    };
    let rests = motion.rests().take(MOST_RESTS).enumerate();
    let key = |(place, rest): (usize, TaskInstant)| {
        let there = linkage(&subject.driven, &subject.evaluation.design, &rest.pose).ok()?;
        let [positions, controls] = values(&subject.linkage, &there);
        let key = Element::new("key")
            .with("name", format!("rest_{place}"))
            .with_numbers("time", &[rest.time])
            .with_numbers("qpos", &positions)
            .with_numbers("ctrl", &controls);
        Some(key)
    };
    rests.filter_map(key).collect()
}

/// Returns the values of all joints, and the change of the actuated ones since the exported pose, at the pose of a linkage, in the order of
/// the document. Angles are those nearest to the exported pose.
fn values(exported: &Linkage, there: &Linkage) -> [Vec<f64>; 2] {
    let (mut positions, mut controls) = (Vec::new(), Vec::new());
    for (before, body) in exported.bodies.iter().zip(&there.bodies) {
        let (Some(reference), Some(joint)) = (before.joint, body.joint) else {
            let Frame { origin, angle } = body.frame;
            positions.extend([origin.x, origin.y, angle]);
            continue;
        };
        let turned = there.local_frame(body).angle - exported.local_frame(before).angle;
        let value = match joint.kind {
            JointKind::Prismatic => joint.value,
            JointKind::Revolute => reference.value + libm::remainder(turned, 2.0 * std::f64::consts::PI),
        };
        positions.push(value);
        controls.extend(joint.actuated.then_some(value - reference.value));
    }
    [positions, controls]
}

fn element(subject: &Prepared, body: &Body) -> Element {
    let frame = subject.linkage.local_frame(body);
    let mut element = Element::new("body")
        .with("name", body.name.clone())
        .with_numbers("pos", &[frame.origin.x, frame.origin.y, 0.0])
        .with_numbers("euler", &[0.0, 0.0, frame.angle]);
    match body.joint {
        Some(joint) => {
            let mut hinge = Element::new("joint").with("name", joint_name(body));
            let kind = match joint.kind {
                JointKind::Prismatic => "slide",
                JointKind::Revolute => "hinge",
            };
            hinge = hinge.with("type", kind).with("axis", joint_axis(joint.kind));
            hinge = hinge.with_numbers("ref", &[joint.value]);
            if let Some(limits) = joint.limits {
                hinge = hinge.with_numbers("range", &limits);
            }
            let rotor = subject.driven.settings().dynamics.drives.of(joint.kind);
            if joint.actuated && rotor > 0.0 {
                hinge = hinge.with_numbers("armature", &[rotor]);
            }
            element.push(hinge);
        }
        // The platform is free in the plane; its joint values are the pose in the base frame.
        None => {
            let (sin, cos) = libm::sincos(frame.angle);
            for (axis, kind, direction, value) in [
                ("x", "slide", [cos, -sin, 0.0], frame.origin.x),
                ("y", "slide", [sin, cos, 0.0], frame.origin.y),
                ("phi", "hinge", [0.0, 0.0, 1.0], frame.angle),
            ] {
                element.push(
                    Element::new("joint")
                        .with("name", format!("{}_{axis}", body.name))
                        .with("type", kind)
                        .with_numbers("axis", &direction)
                        .with_numbers("ref", &[value]),
                );
            }
        }
    }
    let (mass, centre, [xx, yy, zz, xy]) = inertial(body);
    element.push(
        Element::new("inertial")
            .with_numbers("pos", &centre.to_array())
            .with("mass", mass.to_string())
            .with("fullinertia", format!("{xx} {yy} {zz} {xy} 0 0")),
    );
    let solids = body.solids.iter().filter(|solid| solid.shape.has_volume());
    element.children(solids.map(geom)).child(
        Element::new("site")
            .with("name", format!("{}_frame", body.name))
            .with("group", "3"),
    )
}

fn geom(solid: &Solid) -> Element {
    let geom = match solid.shape {
        SolidShape::Bar { from, to, radius, .. } => Element::new("geom")
            .with("type", "cylinder")
            .with_numbers("fromto", &[from.x, from.y, from.z, to.x, to.y, to.z])
            .with_numbers("size", &[radius]),
        SolidShape::Block {
            centre,
            half_size,
            angle,
            ..
        } => Element::new("geom")
            .with("type", "box")
            .with_numbers("pos", &centre.to_array())
            .with_numbers("size", &half_size.to_array())
            .with_numbers("euler", &[0.0, 0.0, angle]),
    };
    geom.with_numbers("rgba", &rgba(solid.part))
}
