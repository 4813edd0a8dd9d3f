//! Checks that scenes show what the model computes.

use glam::{DVec2, DVec3};
use kinefront_model::clearance::Stacking;
use kinefront_model::dynamics::{MotionLaw, Task, TaskShape, TaskTiming};
use kinefront_model::evaluation::{Evaluation, GridChoice, Model, ModelSettings, PoseEvaluation, PoseScalar};
use kinefront_model::mechanism::{
    Architecture, CylinderSize, Design, JointKind, JointMasses, JointSizes, MemberKind, WorkingMode,
};
use kinefront_model::spatial::Pose;
use kinefront_model::stiffness::StiffnessDefinition;
use kinefront_scene::{
    Body, EllipsoidKind, Field, Heatmap, HeatmapSettings, MotionPath, Part, PathColor, Solid, SolidShape, Vibrations,
    ellipsoids, linkage, manipulator, pose_at, regular_workspace, tour,
};
use nalgebra::{Matrix3, Vector3};

/// The paper's designs, and feasible designs of the other architectures, one of them in another working mode.
const DESIGNS: [&str; 8] = [
    "3-PRR R=1.412 r=0.319 Lb=0.620 rj=0.026 rp=0.023",
    "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056",
    "3-PRR R=3.872 r=1.947 Lb=1.977 rj=0.039 rp=0.096",
    "3-RPR R=2.2462 r=1.2453 Lb=3.5382 rj=0.0224 rp=0.083",
    "3-RRR R=3.3658 r=0.2537 Lb=1.9157 rj=0.0787 rp=0.0891",
    "3-RRR R=1.2777 r=1.5205 Lb=3.8009 rj=0.0528 rp=0.0821 mode=---",
    // From Pareto fronts; the platform is so small that another assembly mode is near.
    "3-RPR R=1.3439 r=0.1172 Lb=1.9493 rj=0.01577 rp=0.01891",
    "3-RRR R=0.6373 r=0.1184 Lb=0.6471 rj=0.03206 rp=0.02846",
];

fn each(check: impl Fn(&Model, &Evaluation)) {
    let model = Model::default();
    for text in DESIGNS {
        let design: Design = text.parse().expect("a design");
        let evaluation = model.evaluate(&design, GridChoice::Fine);
        assert!(evaluation.is_feasible(), "{text}");
        check(&model, &evaluation);
    }
}

fn ends(solid: &Solid) -> (DVec3, DVec3) {
    match solid.shape {
        SolidShape::Bar { from, to, .. } => (from, to),
        SolidShape::Block { .. } => panic!("{solid:?} is not a bar"),
    }
}

fn report(model: &Model, design: &Design, position: DVec2, phi: f64) -> PoseEvaluation {
    let pose = Pose { position, phi };
    model.pose(design, &pose).expect("reachable")
}

/// Joints and motors are drawn with the size that the study gives them, and legs in layers of their own at their heights.
#[test]
fn joints_are_drawn_with_their_size() {
    let (joint, motor) = (
        CylinderSize {
            radius: 0.11,
            height: 0.4,
        },
        CylinderSize {
            radius: 0.17,
            height: 0.3,
        },
    );
    let sizes = JointSizes { revolute: joint, motor };
    for text in [
        "3-RRR R=3.3658 r=0.2537 Lb=1.9157 rj=0.0787 rp=0.0891",
        "3-RPR R=2.2462 r=1.2453 Lb=3.5382 rj=0.0224 rp=0.083",
        "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056",
    ] {
        let design: Design = text.parse().expect("a design");
        let model = |joint_sizes: JointSizes| {
            let settings = ModelSettings {
                joint_sizes,
                ..ModelSettings::default()
            };
            Model::new(settings).expect("the grids fit")
        };
        let home = Model::default()
            .evaluate(&design, GridChoice::Reference)
            .home
            .expect("a home");
        let thickness = |model: &Model| -> Vec<f64> {
            let scene = manipulator(model, &design, &home).expect("reachable");
            let joints = scene.solids.into_iter();
            let joints = joints.filter(|solid| matches!(solid.part, Part::ActuatedJoint | Part::PassiveJoint));
            let cylinders = joints.filter_map(|solid| match solid.shape {
                SolidShape::Bar { from, to, radius, .. } => Some((from.z - to.z, radius)),
                SolidShape::Block { .. } => None,
            });
            cylinders
                .map(|(height, radius)| {
                    assert!(
                        radius < joint.radius || -height >= joint.height.min(motor.height),
                        "{text}"
                    );
                    radius
                })
                .collect()
        };
        let with_radius = |radii: &[f64], radius: f64| radii.iter().filter(|found| **found == radius).count();
        let (points, bodies) = (thickness(&model(JointSizes::default())), thickness(&model(sizes)));
        assert_eq!(
            with_radius(&points, joint.radius) + with_radius(&points, motor.radius),
            0
        );
        let chain = design.architecture().chain();
        let revolute = chain.joints.iter().filter(|kind| **kind == JointKind::Revolute).count();
        assert_eq!(with_radius(&bodies, joint.radius), 3 * revolute, "{text}");
        let is_turned = chain.joints[design.architecture().driven()] == JointKind::Revolute;
        assert_eq!(
            with_radius(&bodies, motor.radius),
            if is_turned { 3 } else { 0 },
            "{text}"
        );
    }
    // The legs of this design cross each other.
    let design: Design = "3-RPR R=0.99 r=0.67 Lb=2.21 rj=0.019 rp=0.018"
        .parse()
        .expect("a design");
    let mut settings = ModelSettings::default();
    settings.thresholds.set(PoseScalar::Clearance, Some(0.004));
    settings.bodies.stacking = Stacking::Chosen;
    let model = Model::new(settings).expect("the grids fit");
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
    each(|model, evaluation| {
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
                near(apart(platform.1, pose.position.extend(0.0)), 0.0, "gap at P");
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
                        near(tube.0.distance(rod.1), actuators[leg], "telescopic leg");
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
        }
    });
}

/// The manipulator has the true bar radii, every joint of its architecture, and the paper's labels.
#[test]
fn the_manipulator_is_complete_and_to_scale() {
    let model = Model::default();
    // Numbers of links, cranks, tubes and rods; of platform bars; of actuated joints; of passive joints; and of labels
    // (A, B, C, O, P; B of a 3-RPR is A).
    let wanted = [
        ("3-PRR", [3, 3, 3, 6, 11]),
        ("3-RPR", [6, 3, 3, 6, 8]),
        ("3-RRR", [6, 3, 3, 6, 11]),
    ];
    for text in DESIGNS {
        let design: Design = text.parse().expect("a design");
        let evaluation = model.evaluate(&design, GridChoice::Reference);
        let scene = manipulator(&model, &design, &evaluation.home.expect("a home")).expect("reachable");
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
        assert_eq!(found, *wanted, "{text}");
        for solid in &scene.solids {
            if let SolidShape::Bar { radius, .. } = solid.shape {
                match solid.part {
                    Part::Link | Part::Crank | Part::Tube => assert_eq!(radius, design.leg_bar_radius()),
                    Part::PlatformBar => assert_eq!(radius, design.platform_bar_radius()),
                    _ => assert!(radius > 0.0),
                }
            }
        }
    }
}

/// Labels that would cover each other are one label.
#[test]
fn labels_of_coincident_points_are_joined() {
    let model = Model::default();
    let texts = |design: &str| -> Vec<String> {
        let design: Design = design.parse().expect("a design");
        let pose = Pose::new(0.0, 0.0, 0.4);
        let scene = manipulator(&model, &design, &pose).expect("reachable");
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
    each(|model, evaluation| {
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

/// Returns the value of a field, computed from the report of a pose.
fn field_value(model: &Model, design: &Design, field: Field, report: &PoseEvaluation) -> f64 {
    match field {
        Field::Scalar(PoseScalar::Displacement) => {
            let inverse = report.stiffness.try_inverse().expect("a stiffness");
            let block = nalgebra::Matrix2::new(inverse[(0, 0)], inverse[(0, 1)], inverse[(1, 0)], inverse[(1, 1)]);
            model.settings().in_plane_force * block.symmetric_eigenvalues().max()
        }
        Field::WorstMargin => {
            let excess = |scalar: PoseScalar| {
                report.values[scalar] / model.settings().thresholds.get(scalar).expect("a limit") - 1.0
            };
            [
                report.values[PoseScalar::Reach] / design.base_radius(),
                excess(PoseScalar::Dexterity),
                excess(PoseScalar::StiffnessXy),
                excess(PoseScalar::StiffnessZ),
                excess(PoseScalar::StiffnessPhiZ),
            ]
            .into_iter()
            .fold(f64::INFINITY, f64::min)
        }
        Field::Scalar(scalar) => report.values[scalar],
    }
}

#[test]
fn heatmaps_hold_the_values_of_their_poses_and_contours_lie_on_the_threshold() {
    each(|model, evaluation| {
        let design = &evaluation.design;
        let phi = evaluation.home.expect("a home").phi;
        for field in Field::of(model, design) {
            let heatmap = Heatmap::new(model, design, field, phi, HeatmapSettings { cells: 60 });
            assert!(heatmap.triangles.len() > 200, "{design} {field:?}");
            let on_edge = |position| heatmap.edges.iter().any(|edge| edge.points.contains(&position));
            let value_at = |position: DVec2| field_value(model, design, field, &report(model, design, position, phi));
            for (&position, &value) in heatmap.vertices.iter().zip(&heatmap.values).step_by(7) {
                let stiff = report(model, design, position, phi).values[PoseScalar::Dexterity] > 1e-3;
                // Near a singularity, the inverse that the displacement is compared with has no correct digits.
                if field != Field::Scalar(PoseScalar::Displacement) || stiff {
                    let wanted = value_at(position);
                    let off = (value - wanted).abs();
                    // At the end of reach, the dexterity is the square root of a difference that is a rounding error.
                    let root = matches!(field, Field::DEXTERITY | Field::WorstMargin);
                    let least = if root && on_edge(position) { 1e-6 } else { 1e-12 };
                    assert!(
                        off <= 1e-6 * wanted.abs() + least,
                        "{design} {field:?}: {value} instead of {wanted}"
                    );
                }
            }
            let threshold = field.threshold(model);
            let scale = threshold.abs().max(1e-3);
            for &position in heatmap.threshold.iter().flatten() {
                let off = (value_at(position) - threshold).abs();
                assert!(
                    off < 1e-6 * scale,
                    "{design} {field:?}: a contour is off its threshold by {off:e}"
                );
            }
            for &position in heatmap.singular.iter().flatten() {
                let off = report(model, design, position, phi).values[PoseScalar::Determinant].abs();
                assert!(off < 1e-9, "{design}: a singularity curve has det A/ℓ = {off:e}");
            }
            assert!(!heatmap.edges.is_empty(), "{design}: the reach has no edge");
            for edge in &heatmap.edges {
                assert!(edge.points.len() > 1, "{design}: an edge is a point");
                for &position in &edge.points {
                    let limit_margin = report(model, design, position, phi).values[PoseScalar::Reach];
                    assert!(
                        (0.0..1e-9).contains(&limit_margin),
                        "{design}: the limit margin at an edge is {limit_margin:e} m"
                    );
                }
            }
            for triangle in &heatmap.triangles {
                let [a, b, c] = triangle.map(|vertex| heatmap.vertices[vertex as usize]);
                assert!((b - a).perp_dot(c - a) > -1e-12, "{design}: a triangle is inverted");
            }
        }
    });
}

/// The triangles cover the reachable area, no more and no less.
#[test]
fn heatmaps_cover_the_reachable_workspace() {
    each(|model, evaluation| {
        let design = &evaluation.design;
        let phi = evaluation.home.expect("a home").phi;
        let settings = HeatmapSettings { cells: 80 };
        let heatmap = Heatmap::new(model, design, Field::DEXTERITY, phi, settings);
        let area: f64 = heatmap
            .triangles
            .iter()
            .map(|triangle| {
                let [a, b, c] = triangle.map(|vertex| heatmap.vertices[vertex as usize]);
                0.5 * (b - a).perp_dot(c - a)
            })
            .sum();
        let reach = 2.0 * design.link_length() + design.base_radius() + design.platform_radius();
        let steps = 1200;
        let step = 2.0 * reach / f64::from(steps);
        let mut reached = 0.0;
        for i in 0..steps {
            for j in 0..steps {
                let position = DVec2::new(f64::from(i) + 0.5, f64::from(j) + 0.5) * step - reach;
                let pose = Pose { position, phi };
                reached += f64::from(u8::from(model.pose(design, &pose).is_ok()));
            }
        }
        let wanted = reached * step * step;
        assert!(
            (area / wanted - 1.0).abs() < 0.01,
            "{design}: {area} m² drawn, {wanted} m² reachable"
        );
    });
}

#[test]
fn ellipsoid_axes_are_the_eigenvectors_of_their_block() {
    each(|model, evaluation| {
        for kind in [EllipsoidKind::Stiffness, EllipsoidKind::Displacement] {
            let set = ellipsoids(model, evaluation, kind).expect("a set");
            assert_eq!(set.ellipsoids.len(), 19);
            let mut largest = 0.0f64;
            for ellipsoid in &set.ellipsoids {
                let k = report(model, &evaluation.design, ellipsoid.pose.position, ellipsoid.pose.phi).stiffness;
                let block: Matrix3<f64> = match kind {
                    EllipsoidKind::Stiffness => k.fixed_view::<3, 3>(0, 0).into_owned(),
                    EllipsoidKind::Displacement => k
                        .try_inverse()
                        .expect("a stiffness")
                        .fixed_view::<3, 3>(0, 0)
                        .into_owned(),
                };
                let (sin, cos) = ellipsoid.angle.sin_cos();
                let axes = [Vector3::new(cos, sin, 0.0), Vector3::new(-sin, cos, 0.0), Vector3::z()];
                for (axis, value) in axes.into_iter().zip(ellipsoid.values.to_array()) {
                    let off = (block * axis - axis * value).norm();
                    assert!(
                        off < 1e-6 * block.norm(),
                        "{}: {kind:?} axis is off by {off:e}",
                        evaluation.design
                    );
                }
                largest = largest.max(ellipsoid.values.max_element());
            }
            // All ellipsoids have one scale, at which neighbours do not overlap.
            assert!(largest * set.scale <= 0.25 * evaluation.workspace_radius());
            assert!(set.scale_text().contains("0.1 m ="));
        }
    });
}

#[test]
fn a_displacement_matches_the_definition_by_compliance() {
    let design: Design = DESIGNS[1].parse().expect("a design");
    let settings = ModelSettings {
        stiffness_definition: StiffnessDefinition::Compliance,
        ..ModelSettings::default()
    };
    let model = Model::new(settings).expect("the grids fit");
    let heatmap = Heatmap::new(
        &model,
        &design,
        Field::Scalar(PoseScalar::Displacement),
        0.5,
        HeatmapSettings { cells: 40 },
    );
    let mut compared = 0;
    for (&position, &value) in heatmap.vertices.iter().zip(&heatmap.values).step_by(11) {
        let k_xy = report(&model, &design, position, 0.5).values[PoseScalar::StiffnessXy];
        if k_xy > 1.0 {
            assert!((value * k_xy / model.settings().in_plane_force - 1.0).abs() < 1e-6);
            compared += 1;
        }
    }
    assert!(compared > 20, "only {compared} values compared");
}

/// The surface of every solid is closed, faces outwards, and encloses the volume of its shape.
#[test]
fn meshes_are_closed_and_as_large_as_their_solids() {
    use std::collections::BTreeMap;

    let model = Model::default();
    for text in DESIGNS {
        let design: Design = text.parse().expect("a design");
        let evaluation = model.evaluate(&design, GridChoice::Reference);
        let scene = manipulator(&model, &design, &evaluation.home.expect("a home")).expect("reachable");
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
    }
}

/// Joints and motors move with the bodies that carry them, of every architecture.
#[test]
fn the_linkage_has_the_masses_of_joints_and_motors() {
    let settings = ModelSettings {
        joints: JointMasses {
            revolute: 0.5,
            carriage: 1.5,
            motor: 4.0,
        },
        ..ModelSettings::default()
    };
    let model = Model::new(settings).expect("the grids fit");
    for &architecture in Architecture::ALL {
        let values = [1.0, 0.3, 1.1, 0.02, 0.02];
        let design = Design::new(architecture, WorkingMode::ALL_PLUS, values).expect("a design");
        let mut poses = (0..72).map(|k| Pose::new(0.02, 0.01, (5.0 * f64::from(k)).to_radians()));
        let found = poses
            .find_map(|pose| linkage(&model, &design, &pose).ok())
            .expect("a pose in reach");
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
    let settings = ModelSettings {
        joint_sizes: JointSizes {
            motor,
            ..JointSizes::default()
        },
        ..ModelSettings::default()
    };
    let model = Model::new(settings).expect("the grids fit");
    let motors = |solids: &mut dyn Iterator<Item = Solid>| -> Vec<[DVec3; 2]> {
        let ends = solids.filter_map(|solid| match solid.shape {
            SolidShape::Bar { from, to, radius, .. } if radius == motor.radius => Some([from, to]),
            _ => None,
        });
        ends.collect()
    };
    for &architecture in Architecture::ALL {
        let design = Design::new(architecture, WorkingMode::ALL_PLUS, [1.0, 0.3, 1.1, 0.02, 0.02]).expect("a design");
        let poses = (0..72).map(|k| Pose::new(0.02, 0.01, (5.0 * f64::from(k)).to_radians()));
        let mut reached = poses.filter_map(|pose| Some((pose, linkage(&model, &design, &pose).ok()?)));
        let (pose, found) = reached.next().expect("a pose in reach");
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
        assert_eq!(
            (shown.len(), built.len()),
            if is_turned { (3, 3) } else { (0, 0) },
            "{architecture}"
        );
        assert_eq!(
            found.base_motors.len(),
            if is_turned && architecture.driven() == 0 { 3 } else { 0 }
        );
        for ends in &shown {
            let is_there = |other: &&[DVec3; 2]| (0..2).all(|end| other[end].distance(ends[end]) < 1e-12);
            assert!(built.iter().any(|other| is_there(&other)), "{architecture}: {ends:?}");
        }
    }
}

/// The linkage has the mass given by the model, its loops close, and its bodies look like the manipulator.
#[test]
fn the_linkage_is_the_manipulator_in_bodies() {
    let model = Model::default();
    for text in DESIGNS {
        let design: Design = text.parse().expect("a design");
        let evaluation = model.evaluate(&design, GridChoice::Reference);
        let home = evaluation.home.expect("a home");
        let cylinder = regular_workspace(&evaluation, 20.0).expect("a workspace");
        let poses = tour(&model, &design, &cylinder, 8).expect("a tour").poses;
        for pose in poses.iter().chain([&home]) {
            let found = linkage(&model, &design, pose).expect("reachable");
            let mass: f64 = found.bodies.iter().map(Body::mass).sum();
            assert!((mass - evaluation.mass()).abs() < 1e-9 * mass, "{text}: {mass}");
            let place = |body: usize, at: DVec2| {
                let frame = found.bodies[body].frame;
                frame.origin + DVec2::from_angle(frame.angle).rotate(at)
            };
            assert_eq!(found.closures.len(), 3);
            for (leg, closure) in found.closures.iter().enumerate() {
                let on_leg = place(closure.leg, closure.on_leg);
                let on_platform = place(found.platform(), closure.on_platform);
                assert!(on_leg.distance(on_platform) < 1e-12, "{text}: C{} is open", leg + 1);
            }
            let report = model.pose(&design, pose).expect("reachable");
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
            let scene = manipulator(&model, &design, pose).expect("reachable");
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
                    assert!(same, "{text}: {} has {solid:?}, which is not in the scene", body.name);
                }
            }
        }
    }
}

/// A star of three bars has the moments of inertia given by textbook formulas for cylinders.
#[test]
fn moments_of_inertia_are_those_of_cylinders() {
    let model = Model::default();
    let design: Design = DESIGNS[0].parse().expect("a design");
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

/// The path of a motion has the colours of what its actuators do, and its poses in time.
#[test]
fn the_path_of_a_motion_has_its_poses_and_values() {
    let task = Task {
        shape: TaskShape::Star,
        share: 0.8,
        angle: 0.0,
        closed: true,
        law: MotionLaw::Quintic,
        dwell: 0.1,
        samples: 200,
        timing: TaskTiming::Cycle(4.0),
    };
    let model = Model::default();
    let design: Design = DESIGNS[1].parse().expect("a design");
    let evaluation = model.evaluate(&design, GridChoice::Reference);
    let (outcome, samples) = model.follow(&evaluation, &task);
    let figures = outcome.result.expect("a motion").expect("followed to its end");
    let path = |color| MotionPath::new(&model, &design, &samples, color).expect("a path");
    let forces = path(PathColor::FORCE);
    let largest = figures.peak_force.iter().fold(0.0f64, |most, force| most.max(*force));
    assert!((forces.range[1] - largest).abs() < 1e-12 * largest);
    assert_eq!(forces.poses.len(), forces.colors.len());
    let kappa = path(PathColor::Field(Field::DEXTERITY));
    let own = |pose: &Pose| model.pose(&design, pose).expect("reached").values[PoseScalar::Dexterity];
    let least = kappa.poses.iter().map(own).fold(f64::INFINITY, f64::min);
    assert!(
        (kappa.range[0] - least).abs() < 1e-9,
        "{} instead of {least}",
        kappa.range[0]
    );

    // Between two samples the platform is on a straight line, and before and after the motion at its ends.
    let [first, second] = [samples[40], samples[41]].map(|sample| sample.instant);
    let between = pose_at(&samples, 0.5 * (first.time + second.time)).expect("a pose");
    assert!(
        between
            .position
            .distance(first.pose.position.midpoint(second.pose.position))
            < 1e-12
    );
    assert_eq!(pose_at(&samples, -1.0), Some(samples[0].instant.pose));
    assert_eq!(pose_at(&samples, 1e3), samples.last().map(|sample| sample.instant.pose));
    assert_eq!(pose_at(&[], 0.0), None);
}

/// Bars that vibrate bend about where they are, and the point that moves most moves by the amplitude.
#[test]
fn vibrations_bend_the_bars_by_their_amplitude() {
    let model = Model::default();
    for text in [
        "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056",
        "3-RPR R=2.0 r=0.5 Lb=3.0 rj=0.03 rp=0.03",
        "3-RRR R=2.0 r=0.6 Lb=1.6 rj=0.05 rp=0.04",
    ] {
        let design: Design = text.parse().expect("a design");
        let evaluation = model.evaluate(&design, GridChoice::Reference);
        let posed = model.posed(&design);
        let dynamics = posed
            .dynamics_at(&model.home(&evaluation))
            .expect("reached")
            .expect("regular");
        let report = dynamics.report().expect("regular");
        let vibrations = Vibrations::new(&model, &design, &dynamics, &report).expect("vibrations");
        let lowest = report.lowest_frequency().expect("known");
        assert!((vibrations.modes[0].frequency - lowest).abs() <= 1e-12 * lowest);
        assert_eq!(vibrations.modes.iter().filter(|mode| mode.is_in_plane).count(), 3);
        let rest = vibrations.bent(0, 0.0);
        for mode in 0..6 {
            let (bent, back) = (vibrations.bent(mode, 0.1), vibrations.bent(mode, -0.1));
            let mut most = 0.0f64;
            for ((bent, back), rest) in bent.iter().zip(&back).zip(&rest) {
                for ((bent, back), rest) in bent.points.iter().zip(&back.points).zip(&rest.points) {
                    most = most.max(bent.distance(*rest));
                    assert!((*bent + *back - 2.0 * *rest).length() < 1e-12, "{text}");
                    let moves_up = (bent.z - rest.z).abs() > 1e-12;
                    assert!(!moves_up || !vibrations.modes[mode].is_in_plane, "{text}");
                }
            }
            assert!((most - 0.1).abs() < 1e-12, "{text}: mode {mode} moves by {most}");
        }
    }
}
