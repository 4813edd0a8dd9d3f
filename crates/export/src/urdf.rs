//! URDF: the tree that remains when the loops are cut at `C_2` and `C_3`.

use glam::DVec2;

use super::format::{AnyError, Contents, Format};
use super::prepared::{Prepared, inertia_elements, inertial, joint_axis, joint_name, kind_name, place, rgba, text};
use super::xml::{Element, numbers};
use kinefront_model::mechanism::JointKind;
use kinefront_scene::{Body, Joint, Linkage, Solid, SolidShape};

pub(super) const FORMAT: Format = Format {
    key: "urdf",
    file: "design.urdf",
    name: "URDF",
    title: "URDF, for ROS",
    lost: Some(
        "the closed loops (URDF describes trees, so the platform is attached to leg 1, and legs 2 and 3 end free at C2 and C3); the \
         stiffness of the actuators and the inertia of their rotors, and which joints are actuated; the effort and velocity limits are placeholders",
    ),
    contents: Contents::Simulator { joints_from_zero: true },
    write,
};

/// Limits of force or torque and of speed for all joints: the format requires them and the study does not define them.
const EFFORT: f64 = 1e4;
const SPEED: f64 = 10.0;

fn write(subject: &Prepared) -> Result<Vec<u8>, AnyError> {
    let linkage = &subject.linkage;
    let mut robot = Element::new("robot").with("name", subject.identifier()).child(
        Element::new("link")
            .with("name", "base")
            .children(subject.base.iter().map(visual)),
    );
    for body in &linkage.bodies {
        // URDF places the origin of a link at its parent joint, which for the platform is C_1.
        let shift = match body.joint {
            Some(_) => DVec2::ZERO,
            None => linkage.closures[0].on_platform,
        };
        robot.push(link(body, shift));
    }
    let jointed = linkage.bodies.iter().filter_map(|body| Some((body, body.joint?)));
    robot = robot.children(jointed.map(|(body, joint)| leg_joint(linkage, body, &joint)));
    robot.push(platform_joint(linkage));
    for (name, parent, at) in frames(linkage) {
        robot.push(Element::new("link").with("name", name.clone()));
        let joint = format!("{name}_fixed");
        robot.push(joint_element(&joint, "fixed", &parent, &name, at, 0.0));
    }
    robot.document(&FORMAT.preamble(subject))
}

/// The joint of a body of a leg to its parent; its value is 0 at the exported pose.
fn leg_joint(linkage: &Linkage, body: &Body, joint: &Joint) -> Element {
    let parent = body
        .parent
        .map_or("base", |parent| linkage.bodies[parent].name.as_str());
    let frame = linkage.local_frame(body);
    let kind = match joint.kind {
        JointKind::Revolute if joint.limits.is_none() => "continuous",
        kind => kind_name(kind),
    };
    let mut limit = Element::new("limit");
    if let Some(limits) = joint.limits {
        let [lower, upper] = limits.map(|value| value - joint.value);
        limit = limit.with_numbers("lower", &[lower]).with_numbers("upper", &[upper]);
    }
    limit = limit
        .with_numbers("effort", &[EFFORT])
        .with_numbers("velocity", &[SPEED]);
    joint_element(&joint_name(body), kind, parent, &body.name, frame.origin, frame.angle)
        .child(Element::new("axis").with("xyz", joint_axis(joint.kind)))
        .child(limit)
}

/// The connection at `C_1`, on which the platform hangs in the tree.
fn platform_joint(linkage: &Linkage) -> Element {
    let platform = &linkage.bodies[linkage.platform()];
    let closure = linkage.closures[0];
    let leg = &linkage.bodies[closure.leg];
    let angle = platform.frame.angle - leg.frame.angle;
    let joint = |kind| joint_element("C1", kind, &leg.name, &platform.name, closure.on_leg, angle);
    match closure.is_rigid {
        true => joint("fixed"),
        false => joint("continuous").child(Element::new("axis").with("xyz", joint_axis(JointKind::Revolute))),
    }
}

/// Frames at `P` and at the cut joints (`C_i` on the leg and on the platform), so that a program can close the loops again:
/// name, parent link, and position in its frame.
fn frames(linkage: &Linkage) -> Vec<(String, String, DVec2)> {
    let platform = &linkage.bodies[linkage.platform()].name;
    let origin = linkage.closures[0].on_platform;
    let mut frames = vec![("P".to_owned(), platform.clone(), -origin)];
    for (leg, cut) in linkage.closures.iter().enumerate().skip(1) {
        let name = |side: &str| format!("C{}_{side}", leg + 1);
        frames.push((name("leg"), linkage.bodies[cut.leg].name.clone(), cut.on_leg));
        frames.push((name("platform"), platform.clone(), cut.on_platform - origin));
    }
    frames
}

fn joint_element(name: &str, kind: &str, parent: &str, child: &str, at: DVec2, angle: f64) -> Element {
    Element::new("joint")
        .with("name", name)
        .with("type", kind)
        .child(Element::new("parent").with("link", parent))
        .child(Element::new("child").with("link", child))
        .child(origin([at.x, at.y, 0.0, 0.0, 0.0, angle]))
}

fn origin([x, y, z, roll, pitch, yaw]: [f64; 6]) -> Element {
    Element::new("origin")
        .with("xyz", numbers(&[x, y, z]))
        .with("rpy", numbers(&[roll, pitch, yaw]))
}

fn link(body: &Body, shift: DVec2) -> Element {
    let (mass, centre, inertia) = inertial(body);
    let inertia = inertia_elements(inertia).fold(Element::new("inertia"), |element, (key, value)| {
        element.with(key, value)
    });
    let middle = [centre.x - shift.x, centre.y - shift.y, centre.z, 0.0, 0.0, 0.0];
    let solids = body.solids.iter().filter(|solid| solid.shape.has_volume());
    Element::new("link")
        .with("name", body.name.clone())
        .child(
            Element::new("inertial")
                .child(origin(middle))
                .child(Element::new("mass").with("value", mass.to_string()))
                .child(inertia),
        )
        .children(solids.map(|solid| visual(&solid.seen_from(shift, 0.0))))
}

fn visual(solid: &Solid) -> Element {
    let shape = match solid.shape {
        SolidShape::Bar { from, to, radius, .. } => Element::new("cylinder")
            .with("radius", text(radius))
            .with("length", text(from.distance(to))),
        SolidShape::Block { half_size, .. } => Element::new("box").with_numbers("size", &(half_size * 2.0).to_array()),
    };
    let color = Element::new("color").with_numbers("rgba", &rgba(solid.part));
    Element::new("visual")
        .child(origin(place(&solid.shape)))
        .child(Element::new("geometry").child(shape))
        .child(
            Element::new("material")
                .with("name", format!("{:?}", solid.part).to_lowercase())
                .child(color),
        )
}
