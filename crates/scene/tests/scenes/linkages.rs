//! The manipulator as rigid bodies.

use glam::{DVec2, DVec3};
use kinefront_model::evaluation::{GridChoice, Model, ModelSettings};
use kinefront_model::mechanism::{Architecture, CylinderSize, Design, JointKind, JointMasses, JointSizes, WorkingMode};
use kinefront_model::spatial::Pose;
use kinefront_scene::{Body, Linkage, Solid, SolidShape, linkage, manipulator, regular_workspace, tour};

use super::{DESIGNS, design, each, model_of};

/// Returns a design of an architecture with its bodies at the first of some poses that it reaches.
fn in_reach(model: &Model, architecture: Architecture) -> (Design, Pose, Linkage) {
    let values = [1.0, 0.3, 1.1, 0.02, 0.02];
    let design = Design::new(architecture, WorkingMode::ALL_PLUS, values).expect("a design");
    let mut poses = (0..72).map(|k| Pose::new(0.02, 0.01, (5.0 * f64::from(k)).to_radians()));
    let found = poses.find_map(|pose| Some((design, pose, linkage(model, &design, &pose).ok()?)));
    found.expect("a pose in reach")
}

/// Joints and motors move with the bodies that carry them, of every architecture.
#[test]
fn the_linkage_has_the_masses_of_joints_and_motors() {
    let model = model_of(ModelSettings {
        joints: JointMasses {
            revolute: 0.5,
            carriage: 1.5,
            motor: 4.0,
        },
        ..ModelSettings::default()
    });
    for &architecture in Architecture::ALL {
        let (design, _, found) = in_reach(&model, architecture);
        let mass: f64 = found.bodies.iter().map(Body::mass).sum();
        assert!(
            (mass - model.mass(&design)).abs() < 1e-9 * mass,
            "{architecture}: {mass}"
        );
        let moving: f64 = found
            .bodies
            .iter()
            .flat_map(|body| &body.joints)
            .map(|(_, mass)| mass)
            .sum();
        assert!(moving > 0.0 && moving + 1e-9 < mass, "{architecture}: {moving}");
        let [xx, yy, zz, _] = found.bodies[0].inertia();
        assert!(xx >= 0.0 && yy >= 0.0 && zz >= 0.0, "{architecture}");
    }
}

/// A motor with a size stands on the base, or moves with the body before its joint: it is where the manipulator shows it at every pose.
#[test]
fn the_linkage_has_the_motors_that_have_a_size() {
    let motor = CylinderSize {
        radius: 0.0413,
        height: 0.1,
    };
    let model = model_of(ModelSettings {
        joint_sizes: JointSizes {
            motor,
            ..JointSizes::default()
        },
        ..ModelSettings::default()
    });
    let motors = |solids: &mut dyn Iterator<Item = Solid>| -> Vec<[DVec3; 2]> {
        let ends = solids.filter_map(|solid| match solid.shape {
            SolidShape::Bar { from, to, radius, .. } if radius == motor.radius => Some([from, to]),
            _ => None,
        });
        ends.collect()
    };
    for &architecture in Architecture::ALL {
        let (design, pose, found) = in_reach(&model, architecture);
        let scene = manipulator(&model, &design, &pose).expect("reachable");
        let shown = motors(&mut scene.solids.into_iter());
        let of_bodies = found.bodies.iter().flat_map(|body| {
            // Back from the frame of the body to the base frame.
            let origin = DVec2::from_angle(-body.frame.angle).rotate(-body.frame.origin);
            body.solids
                .iter()
                .map(move |solid| solid.seen_from(origin, -body.frame.angle))
        });
        let built = motors(&mut of_bodies.chain(found.base_motors.clone()));
        let chain = architecture.chain();
        let is_turned = chain.joints[architecture.driven()] == JointKind::Revolute;
        let wanted = if is_turned { 3 } else { 0 };
        assert_eq!([shown.len(), built.len()], [wanted; 2], "{architecture}");
        let on_base = if architecture.driven() == 0 { wanted } else { 0 };
        assert_eq!(found.base_motors.len(), on_base);
        for ends in &shown {
            let is_there = |other: &&[DVec3; 2]| (0..2).all(|end| other[end].distance(ends[end]) < 1e-12);
            assert!(built.iter().any(|other| is_there(&other)), "{architecture}: {ends:?}");
        }
    }
}

/// The linkage has the mass given by the model, its loops close, and its bodies look like the manipulator.
#[test]
fn the_linkage_is_the_manipulator_in_bodies() {
    each(GridChoice::Reference, |model, evaluation| {
        let design = &evaluation.design;
        let home = evaluation.home.expect("a home");
        let cylinder = regular_workspace(evaluation, 20.0).expect("a workspace");
        let poses = tour(model, design, &cylinder, 8).expect("a tour").poses;
        for pose in poses.iter().chain([&home]) {
            let found = linkage(model, design, pose).expect("reachable");
            let mass: f64 = found.bodies.iter().map(Body::mass).sum();
            assert!((mass - evaluation.mass()).abs() < 1e-9 * mass, "{design}: {mass}");
            let place = |body: usize, at: DVec2| {
                let frame = found.bodies[body].frame;
                frame.origin + DVec2::from_angle(frame.angle).rotate(at)
            };
            assert_eq!(found.closures.len(), 3);
            for (leg, closure) in found.closures.iter().enumerate() {
                let on_leg = place(closure.leg, closure.on_leg);
                let on_platform = place(found.platform(), closure.on_platform);
                assert!(on_leg.distance(on_platform) < 1e-12, "{design}: C{} is open", leg + 1);
            }
            let report = model.pose(design, pose).expect("reachable");
            let driven = found
                .bodies
                .iter()
                .filter_map(|body| body.joint.filter(|joint| joint.actuated));
            for (joint, actuator) in driven.zip(report.actuators) {
                assert!((joint.value - actuator).abs() < 1e-12);
                if let Some([low, high]) = joint.limits {
                    assert!((low..=high).contains(&joint.value));
                }
            }
            // In the frame of the base, the solids of the bodies are those of the scene.
            let scene = manipulator(model, design, pose).expect("reachable");
            let ends = |shape: &SolidShape| match *shape {
                SolidShape::Bar { from, to, .. } => [from, to],
                SolidShape::Block { centre, half_size, .. } => [centre, half_size],
            };
            for body in &found.bodies {
                for solid in &body.solids {
                    // Position of the base frame as seen from the body.
                    let back = -DVec2::from_angle(-body.frame.angle).rotate(body.frame.origin);
                    let seen = ends(&solid.seen_from(back, -body.frame.angle).shape);
                    let same = scene
                        .solids
                        .iter()
                        .filter(|other| other.part == solid.part)
                        .any(|other| {
                            let other = ends(&other.shape);
                            seen[0].distance(other[0]) < 1e-9 && seen[1].distance(other[1]) < 1e-9
                        });
                    assert!(same, "{design}: {} has {solid:?}, which is not in the scene", body.name);
                }
            }
        }
    });
}

/// A star of three bars has the moments of inertia given by textbook formulas for cylinders.
#[test]
fn moments_of_inertia_are_those_of_cylinders() {
    let model = Model::default();
    let design = design(DESIGNS[0]);
    let home = model.home(&model.evaluate(&design, GridChoice::Reference));
    let found = linkage(&model, &design, &home).expect("reachable");
    let platform = &found.bodies[found.platform()];
    let (mass, length, radius) = (
        platform.mass() / 3.0,
        design.platform_radius(),
        design.platform_bar_radius(),
    );
    let across = mass * (3.0 * radius * radius + length * length) / 12.0 + mass * length * length / 4.0;
    let along = 0.5 * mass * radius * radius;
    let [xx, yy, zz, xy] = platform.inertia();
    for (found, wanted) in [
        (zz, 3.0 * across),
        (xx, 1.5 * (across + along)),
        (yy, 1.5 * (across + along)),
    ] {
        assert!((found - wanted).abs() < 1e-9 * wanted, "{found}, not {wanted}");
    }
    assert!(xy.abs() < 1e-9 * zz && platform.centre_of_mass().length() < 1e-12);
}
