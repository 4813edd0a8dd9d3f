//! SDF: a link for every body and a joint for every joint, including the joints that close the loops.

use super::format::{AnyError, Contents, Format};
use super::prepared::{Prepared, inertia_elements, inertial, joint_axis, joint_name, kind_name, place, rgba, text};
use super::xml::{Element, numbers};
use kinefront_model::mechanism::JointKind;
use kinefront_scene::{Body, Frame, Joint, Solid, SolidShape};

pub(super) const FORMAT: Format = Format {
    key: "sdf",
    file: "design.sdf",
    name: "SDF",
    title: "SDF, for Gazebo",
    lost: Some(
        "the stiffness of the actuators and the inertia of their rotors, and which joints are actuated; Gazebo's default physics engine does not close loops, that \
         of Gazebo Classic does",
    ),
    contents: Contents::Simulator { joints_from_zero: true },
    write,
};

/// Value that means "no limit" where the format requires a number.
const UNLIMITED: f64 = 1e16;

fn write(subject: &Prepared) -> Result<Vec<u8>, AnyError> {
    let linkage = &subject.linkage;
    let mut model = Element::new("model").with("name", subject.identifier()).child(
        Element::new("link")
            .with("name", "base")
            // The base carries the legs and is fixed to the world, so its mass has no effect.
            .child(Element::new("inertial").leaf("mass", "1"))
            .children(subject.base.iter().enumerate().map(visual)),
    );
    model.push(fixed_joint("base_to_world", "world", "base"));
    model = model.children(linkage.bodies.iter().map(link));
    for body in &linkage.bodies {
        // The platform has no parent joint; only the closures connect it to the legs.
        if let Some(joint) = body.joint {
            let parent = body
                .parent
                .map_or("base", |parent| linkage.bodies[parent].name.as_str());
            model.push(joint_element(&joint_name(body), parent, &body.name, joint, None));
        }
    }
    let platform = &linkage.bodies[linkage.platform()];
    for (leg, closure) in linkage.closures.iter().enumerate() {
        let passive = Joint {
            kind: JointKind::Revolute,
            actuated: false,
            value: 0.0,
            limits: None,
        };
        let parent = &linkage.bodies[closure.leg].name;
        let name = format!("C{}", leg + 1);
        model.push(if closure.is_rigid {
            fixed_joint(&name, parent, &platform.name)
        } else {
            let at = Some(closure.on_platform.to_array());
            joint_element(&name, parent, &platform.name, passive, at)
        });
    }
    Element::new("sdf")
        // The newest version that Gazebo Classic reads, and Gazebo Classic closes loops.
        .with("version", "1.7")
        .child(model)
        .document(&FORMAT.preamble(subject))
}

fn pose(x: f64, y: f64, angle: f64) -> String {
    numbers(&[x, y, 0.0, 0.0, 0.0, angle])
}

fn link(body: &Body) -> Element {
    let Frame { origin, angle } = body.frame;
    let (mass, centre, inertia) = inertial(body);
    let inertia = inertia_elements(inertia).fold(Element::new("inertia"), |element, (key, value)| {
        element.leaf(key, value)
    });
    let solids = body.solids.iter().filter(|solid| solid.shape.has_volume());
    Element::new("link")
        .with("name", body.name.clone())
        .leaf("pose", pose(origin.x, origin.y, angle))
        .child(
            Element::new("inertial")
                .leaf("pose", numbers(&[centre.x, centre.y, centre.z, 0.0, 0.0, 0.0]))
                .leaf("mass", mass.to_string())
                .child(inertia),
        )
        .children(solids.enumerate().map(visual))
}

fn visual((index, solid): (usize, &Solid)) -> Element {
    let shape = match solid.shape {
        SolidShape::Bar { from, to, radius, .. } => Element::new("cylinder")
            .leaf("radius", text(radius))
            .leaf("length", text(from.distance(to))),
        SolidShape::Block { half_size, .. } => Element::new("box").leaf("size", numbers(&(half_size * 2.0).to_array())),
    };
    let color = numbers(&rgba(solid.part));
    Element::new("visual")
        .with("name", format!("part{index}"))
        .leaf("pose", numbers(&place(&solid.shape)))
        .child(Element::new("geometry").child(shape))
        .child(
            Element::new("material")
                .leaf("ambient", color.clone())
                .leaf("diffuse", color),
        )
}

fn fixed_joint(name: &str, parent: &str, child: &str) -> Element {
    let joint = Element::new("joint").with("name", name).with("type", "fixed");
    joint.leaf("parent", parent).leaf("child", child)
}

/// Returns a joint at the origin of the child's frame, or at the point `at` of it.
fn joint_element(name: &str, parent: &str, child: &str, joint: Joint, at: Option<[f64; 2]>) -> Element {
    let [lower, upper] = joint.limits.map_or([-UNLIMITED, UNLIMITED], |limits| {
        limits.map(|limit| limit - joint.value)
    });
    let mut element = Element::new("joint")
        .with("name", name)
        .with("type", kind_name(joint.kind));
    if let Some([x, y]) = at {
        element = element.leaf("pose", pose(x, y, 0.0));
    }
    element.leaf("parent", parent).leaf("child", child).child(
        Element::new("axis").leaf("xyz", joint_axis(joint.kind)).child(
            Element::new("limit")
                .leaf("lower", text(lower))
                .leaf("upper", text(upper)),
        ),
    )
}
