//! The manipulator at a pose: its members, joints, labels, and the surfaces of its solids.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use kinefront_model::clearance::Stacking;
use kinefront_model::evaluation::{GridChoice, Model, ModelSettings, PoseScalar};
use kinefront_model::mechanism::{CylinderSize, Design, JointKind, JointSizes, MemberKind};
use kinefront_model::spatial::Pose;
use kinefront_scene::{Part, Scene, Solid, SolidShape, linkage, manipulator, regular_workspace, tour};

use super::{design, each, model_of, report};

fn ends(solid: &Solid) -> (DVec3, DVec3) {
    match solid.shape {
        SolidShape::Bar { from, to, .. } => (from, to),
        SolidShape::Block { .. } => panic!("{solid:?} is not a bar"),
    }
}

/// Joints and motors are drawn with the size that the study gives them.
#[test]
fn joints_are_drawn_with_their_size() {
    let [joint, motor] = [[0.11, 0.4], [0.17, 0.3]].map(|[radius, height]| CylinderSize { radius, height });
    let sized = model_of(ModelSettings {
        joint_sizes: JointSizes { revolute: joint, motor },
        ..ModelSettings::default()
    });
    for text in [
        "3-RRR R=3.3658 r=0.2537 Lb=1.9157 rj=0.0787 rp=0.0891",
        "3-RPR R=2.2462 r=1.2453 Lb=3.5382 rj=0.0224 rp=0.083",
        "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056",
    ] {
        let design = design(text);
        let plain = Model::default();
        let home = plain.evaluate(&design, GridChoice::Reference).home.expect("a home");
        let radii = |model: &Model| -> Vec<f64> {
            let scene = manipulator(model, &design, &home).expect("reachable");
            let cylinders = scene.solids.iter().filter_map(|solid| match (solid.part, solid.shape) {
                (Part::ActuatedJoint | Part::PassiveJoint, SolidShape::Bar { from, to, radius, .. }) => {
                    Some((to.z - from.z, radius))
                }
                _ => None,
            });
            let tall = |(height, radius)| {
                let is_tall = radius < joint.radius || height >= joint.height.min(motor.height);
                assert!(is_tall, "{text}");
                radius
            };
            cylinders.map(tall).collect()
        };
        let with_radius = |radii: &[f64], radius: f64| radii.iter().filter(|found| **found == radius).count();
        let (points, bodies) = (radii(&plain), radii(&sized));
        assert_eq!(
            with_radius(&points, joint.radius) + with_radius(&points, motor.radius),
            0
        );
        let chain = design.architecture().chain();
        let revolute = chain.joints.iter().filter(|kind| **kind == JointKind::Revolute).count();
        assert_eq!(with_radius(&bodies, joint.radius), 3 * revolute, "{text}");
        let is_turned = chain.joints[design.architecture().driven()] == JointKind::Revolute;
        let motors = if is_turned { 3 } else { 0 };
        assert_eq!(with_radius(&bodies, motor.radius), motors, "{text}");
    }
}

/// Legs in layers of their own are drawn at the heights of these, and their bodies have them.
#[test]
fn legs_are_drawn_in_their_layers() {
    // The legs of this design cross each other.
    let design = design("3-RPR R=0.99 r=0.67 Lb=2.21 rj=0.019 rp=0.018");
    let mut settings = ModelSettings::default();
    settings.thresholds.set(PoseScalar::Clearance, Some(0.004));
    settings.bodies.stacking = Stacking::Chosen;
    let model = model_of(settings);
    let home = model.evaluate(&design, GridChoice::Reference).home.expect("a home");
    let scene = manipulator(&model, &design, &home).expect("reachable");
    let rods = scene.solids.iter().filter(|solid| solid.part == Part::Rod);
    let mut heights: Vec<f64> = rods.map(|rod| ends(rod).0.z).collect();
    heights.sort_by(f64::total_cmp);
    heights.dedup();
    assert_eq!(heights.len(), 3, "{heights:?}");
    let of_bodies = linkage(&model, &design, &home).expect("reachable").bodies;
    let rods = of_bodies.iter().filter(|body| body.name.ends_with("rod"));
    let mut of_bodies: Vec<f64> = rods.map(|body| body.height).collect();
    of_bodies.sort_by(f64::total_cmp);
    assert_eq!(of_bodies, heights);
}

#[test]
fn joints_close_along_every_tour() {
    each(GridChoice::Fine, |model, evaluation| {
        let design = &evaluation.design;
        let cylinder =
            regular_workspace(evaluation, model.settings().workspace.rotation_range_deg).expect("a workspace");
        let tour = tour(model, design, &cylinder, 72).expect("a tour");
        assert!(
            tour.radius <= cylinder.radius && tour.radius > 0.98 * cylinder.radius,
            "{design}: {}",
            tour.radius
        );
        assert!(
            tour.forward_error < 1e-9,
            "{design}: forward kinematics is off by {:e}",
            tour.forward_error
        );
        assert_eq!(tour.poses.first(), tour.poses.last());
        // The tour visits both ends of Δφ and the rim.
        let turned = |sign: f64| {
            tour.poses
                .iter()
                .any(|pose| (pose.phi - cylinder.phi - sign * 0.5 * cylinder.phi_range).abs() < 1e-12)
        };
        assert!(turned(1.0) && turned(-1.0));
        for pose in &tour.poses {
            assert!((pose.position - cylinder.centre).length() <= cylinder.radius * (1.0 + 1e-12));
            let scene = manipulator(model, design, pose).expect("reachable");
            let actuators = report(model, design, pose.position, pose.phi).actuators;
            for leg in 0..3 {
                check_leg(design, &scene, leg, actuators[leg], pose.position);
            }
        }
    });
}

/// Checks that the members of a leg and its bar of the platform have their lengths and meet at the joints.
fn check_leg(design: &Design, scene: &Scene, leg: usize, actuator: f64, centre: DVec2) {
    let part = |part: Part| scene.solids_of(part).find(|solid| solid.leg == Some(leg)).map(ends);
    let length = |bar: Option<(DVec3, DVec3)>| bar.map(|(from, to)| from.distance(to));
    let near = |value: f64, wanted: f64, what: &str| {
        assert!(
            (value - wanted).abs() < 1e-12 * design.link_length().max(design.base_radius()) * 4.0,
            "{design}: {what} is {value}, not {wanted}"
        );
    };
    // Pins join members in different layers, so only distances in the plane are compared.
    let apart = |a: DVec3, b: DVec3| a.truncate().distance(b.truncate());
    let platform = part(Part::PlatformBar).expect("a platform bar");
    near(
        platform.0.distance(platform.1),
        design.platform_radius(),
        "platform bar",
    );
    near(apart(platform.1, centre.extend(0.0)), 0.0, "gap at P");
    let last = match (part(Part::Link), part(Part::Tube), part(Part::Rod)) {
        (Some(link), None, None) => {
            near(length(Some(link)).expect("a link"), design.link_length(), "link");
            let crank = part(Part::Crank);
            let has_crank = design.architecture().actuator() == JointKind::Revolute;
            assert_eq!(crank.is_some(), has_crank, "{design}: a crank");
            if let Some(crank) = crank {
                near(length(Some(crank)).expect("a crank"), design.link_length(), "crank");
                near(apart(crank.1, link.0), 0.0, "gap at B");
            }
            link
        }
        (None, Some(tube), Some(rod)) => {
            near(tube.0.distance(rod.1), actuator, "telescopic leg");
            let (tube_length, rod_length) = (tube.0.distance(tube.1), rod.0.distance(rod.1));
            near(tube_length + rod_length, design.link_length(), "tube and rod");
            // The inner end of the rod is inside the tube.
            near(
                rod.0.distance(tube.0) + rod.0.distance(tube.1),
                tube_length,
                "length along the tube",
            );
            rod
        }
        other => panic!("{design}: unexpected parts in a leg: {other:?}"),
    };
    near(apart(last.1, platform.0), 0.0, "gap at C");
}

/// The manipulator has the true bar radii, every joint of its architecture, and the paper's labels.
#[test]
fn the_manipulator_is_complete_and_to_scale() {
    // Numbers of links, cranks, tubes and rods; of platform bars; of actuated joints; of passive joints; and of labels
    // (A, B, C, O, P; B of a 3-RPR is A).
    let wanted = [
        ("3-PRR", [3, 3, 3, 6, 11]),
        ("3-RPR", [6, 3, 3, 6, 8]),
        ("3-RRR", [6, 3, 3, 6, 11]),
    ];
    each(GridChoice::Reference, |model, evaluation| {
        let design = &evaluation.design;
        let scene = manipulator(model, design, &evaluation.home.expect("a home")).expect("reachable");
        let count = |parts: &[Part]| scene.solids.iter().filter(|solid| parts.contains(&solid.part)).count();
        let found = [
            count(&[Part::Link, Part::Crank, Part::Tube, Part::Rod]),
            count(&[Part::PlatformBar]),
            count(&[Part::ActuatedJoint, Part::Slider]),
            count(&[Part::PassiveJoint]),
            // One label names points that coincide.
            scene.labels.iter().map(|label| label.text.split(' ').count()).sum(),
        ];
        let (_, wanted) = wanted
            .iter()
            .find(|(name, _)| *name == design.architecture().name())
            .expect("known");
        assert_eq!(found, *wanted, "{design}");
        for solid in &scene.solids {
            if let SolidShape::Bar { radius, .. } = solid.shape {
                match solid.part {
                    Part::Link | Part::Crank | Part::Tube => assert_eq!(radius, design.leg_bar_radius()),
                    Part::PlatformBar => assert_eq!(radius, design.platform_bar_radius()),
                    _ => assert!(radius > 0.0),
                }
            }
        }
    });
}

/// Labels that would cover each other are one label.
#[test]
fn labels_of_coincident_points_are_joined() {
    let model = Model::default();
    let texts = |text: &str| -> Vec<String> {
        let scene = manipulator(&model, &design(text), &Pose::new(0.0, 0.0, 0.4)).expect("reachable");
        scene.labels.into_iter().map(|label| label.text).collect()
    };
    let small = texts("3-RPR R=2 r=0.01 Lb=3 rj=0.02 rp=0.02");
    assert!(small.contains(&"C1 C2 C3".to_owned()), "{small:?}");
    let large = texts("3-RPR R=2 r=0.5 Lb=3 rj=0.02 rp=0.02");
    assert!(large.iter().all(|text| !text.contains(' ')), "{large:?}");
}

/// Members are drawn as they are modelled for the clearance: each in its layer, with its radius. The line between the
/// nearest pair is as long as their clearance.
#[test]
fn bodies_are_drawn_where_they_are_looked_for() {
    each(GridChoice::Fine, |model, evaluation| {
        let design = &evaluation.design;
        let home = evaluation.home.expect("a home");
        let scene = manipulator(model, design, &home).expect("reachable");
        let members = model.members(design, &home).expect("reachable");
        assert_eq!(
            members.len(),
            3 * (design.architecture().bars_per_leg() + 1) + scene.solids_of(Part::Slider).count()
        );
        for report in &members {
            let near = |a: DVec3, b: DVec3| a.distance(b) < 1e-12;
            let drawn = scene.solids.iter().filter(|solid| solid.leg == Some(report.member.leg));
            let same = |solid: &Solid| match (report.member.kind, solid.part, solid.shape) {
                (MemberKind::Slider, Part::Slider, SolidShape::Block { centre, half_size, .. }) => {
                    near(centre, 0.5 * (report.from + report.to))
                        && (half_size.x - 0.5 * report.length).abs() < 1e-12
                        && half_size.y == report.radius
                }
                (MemberKind::TelescopicLeg, Part::Tube, SolidShape::Bar { from, radius, .. }) => {
                    near(from, report.from) && radius == report.radius
                }
                (MemberKind::Link, Part::Link, SolidShape::Bar { from, to, radius, .. })
                | (MemberKind::Crank, Part::Crank, SolidShape::Bar { from, to, radius, .. })
                | (MemberKind::PlatformBar, Part::PlatformBar, SolidShape::Bar { from, to, radius, .. }) => {
                    near(from, report.from) && near(to, report.to) && radius == report.radius
                }
                _ => false,
            };
            assert_eq!(drawn.filter(|solid| same(solid)).count(), 1, "{design}: {report:?}");
        }
        let mass: f64 = members.iter().map(|report| report.mass).sum();
        assert!((mass - evaluation.mass()).abs() < 1e-9 * mass);
        let shares = members
            .iter()
            .flat_map(|report| [report.contribution, report.actuator])
            .flatten();
        let sum = shares.fold([0.0; 3], |sum: [f64; 3], fraction| {
            [
                sum[0] + fraction.in_plane,
                sum[1] + fraction.vertical,
                sum[2] + fraction.rotation,
            ]
        });
        assert!(sum.iter().all(|sum| (sum - 1.0).abs() < 1e-9), "{design}: {sum:?}");

        let clearance = report(model, design, home.position, home.phi).nearest;
        let nearest = scene.nearest.expect("the nearest pair is always drawn");
        assert_eq!(nearest.too_near, clearance.distance < 0.0);
        if clearance.distance > 0.0 {
            let length = nearest.line[0].distance(nearest.line[1]);
            assert!(
                (length - clearance.distance).abs() < 1e-9,
                "{design}: a line of length {length} for {clearance:?}"
            );
        }
    });
}

/// The surface of every solid is closed, faces outwards, and encloses the volume of its shape.
#[test]
fn meshes_are_closed_and_as_large_as_their_solids() {
    each(GridChoice::Reference, |model, evaluation| {
        let scene = manipulator(model, &evaluation.design, &evaluation.home.expect("a home")).expect("reachable");
        for solid in &scene.solids {
            let mesh = solid.shape.mesh();
            let mut volume = 0.0;
            // Each edge is traversed once in either direction. Points on edges occur several times and are identified
            // by their position.
            let key = |point: DVec3| (point * 1e9).round().to_array().map(|value| value as i64);
            let mut edges: BTreeMap<_, i32> = BTreeMap::new();
            for corners in &mesh.triangles {
                let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
                volume += a.dot(b.cross(c)) / 6.0;
                for (from, to) in [(a, b), (b, c), (c, a)] {
                    *edges.entry((key(from), key(to))).or_default() += 1;
                    *edges.entry((key(to), key(from))).or_default() -= 1;
                }
                let outward = (b - a).cross(c - a);
                for &corner in corners {
                    assert!(mesh.normals[corner as usize].dot(outward) > 0.0, "{solid:?}");
                }
            }
            assert!(edges.values().all(|&count| count == 0), "{solid:?} is open");
            let wanted = match solid.shape {
                SolidShape::Bar { from, to, radius, .. } => {
                    let turn = 2.0 * std::f64::consts::PI / 32.0;
                    16.0 * turn.sin() * radius * radius * from.distance(to)
                }
                SolidShape::Block { half_size, .. } => 8.0 * half_size.element_product(),
            };
            assert!(
                (volume - wanted).abs() < 1e-6 * wanted,
                "{solid:?}: the volume is {volume}, not {wanted}"
            );
        }
    });
}
