//! Quantities of designs, each against a direct computation from joints, matrices and poses, one pose at a time.

use kinefront_model::evaluation::{
    Bound, Constraint, Evaluation, GridChoice, Model, PoseScalar, Quantity, QuantityLimit, QuantitySet,
};
use kinefront_model::mechanism::{Architecture, Design, JointKind, MemberKind};
use kinefront_model::spatial::{Pose, unit};
use kinefront_model::workspace::Region;
use nalgebra::Matrix2;

use super::strategies::{self, parsed};

const DESIGNS: [&str; 4] = [
    "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056",
    "3-RPR R=1.5636 r=0.4006 Lb=2.2135 rj=0.027 rp=0.031",
    "3-RRR R=1.2 r=0.5 Lb=1.0 rj=0.04 rp=0.05",
    "3-RRR R=1.2 r=0.5 Lb=1.0 rj=0.04 rp=0.05 mode=++-",
];

fn model() -> Model {
    strategies::model(|settings| settings.quantities = QuantitySet::all())
}

/// The poses over which quantities are taken: 24 rings at most, in the directions and orientations of the reference grid.
fn poses(evaluation: &Evaluation) -> Vec<Pose> {
    let (radius, home) = (evaluation.workspace_radius(), evaluation.home_phi_deg.expect("a home"));
    let rings = (50.0 * radius / evaluation.design.base_radius())
        .ceil()
        .clamp(1.0, 24.0) as u32;
    let mut poses = Vec::new();
    for k in -4..=4 {
        let phi = (home + 2.5 * f64::from(k)).to_radians();
        poses.push(Pose::new(0.0, 0.0, phi));
        for direction in 0..36 {
            let way = unit((10.0 * f64::from(direction)).to_radians());
            for ring in 1..=rings {
                let position = way * (radius * f64::from(ring) / f64::from(rings));
                poses.push(Pose::new(position.x, position.y, phi));
            }
        }
    }
    poses
}

/// Compares a quantity of all designs with a direct computation.
fn check(quantity: Quantity, tolerance: f64, direct: impl Fn(&Model, &Evaluation) -> f64) {
    let model = model();
    for text in DESIGNS {
        let design = parsed(text);
        let evaluation = model.evaluate(&design, GridChoice::Reference);
        let (found, wanted) = (value_of(quantity, &evaluation), direct(&model, &evaluation));
        assert!(
            (found - wanted).abs() <= tolerance * wanted.abs().max(1e-9),
            "{text}: {} is {found} instead of {wanted}",
            quantity.entry().key
        );
    }
}

/// The value of a quantity that was asked for.
fn value_of(quantity: Quantity, evaluation: &Evaluation) -> f64 {
    evaluation.quantities.get(quantity).expect("a value")
}

fn least(model: &Model, evaluation: &Evaluation, value: impl Fn(&Model, &Design, &Pose) -> f64) -> f64 {
    let values = poses(evaluation)
        .into_iter()
        .map(|pose| value(model, &evaluation.design, &pose));
    values.fold(f64::INFINITY, f64::min)
}

#[test]
fn masses_and_height_follow_from_the_bars() {
    let mass = |radius: f64, length: f64, count: f64| count * 7850.0 * std::f64::consts::PI * radius * radius * length;
    let legs = |design: &Design| {
        let has_cranks = design.architecture() == Architecture::ALL[2];
        let count = 3.0 * if has_cranks { 2.0 } else { 1.0 };
        mass(design.leg_bar_radius(), design.link_length(), count)
    };
    let platform = |design: &Design| mass(design.platform_bar_radius(), design.platform_radius(), 3.0);
    check(Quantity::LegsMass, 1e-12, |_, found| legs(&found.design));
    check(Quantity::PlatformMass, 1e-12, |_, found| platform(&found.design));
    check(Quantity::Mass, 1e-12, |_, found| {
        legs(&found.design) + platform(&found.design)
    });
    check(Quantity::Height, 1e-12, |model, found| {
        let home = found.home.expect("a home");
        let members = model.members(&found.design, &home).expect("reachable");
        let tops = members.iter().map(|member| member.from.z + member.radius);
        let bottoms = members.iter().map(|member| member.from.z - member.radius);
        tops.fold(f64::MIN, f64::max) - bottoms.fold(f64::MAX, f64::min)
    });
}

#[test]
fn least_values_are_those_of_single_poses() {
    for (scalar, tolerance) in [
        (PoseScalar::Dexterity, 1e-9),
        (PoseScalar::StiffnessXy, 1e-9),
        (PoseScalar::StiffnessZ, 1e-9),
        (PoseScalar::StiffnessPhiZ, 1e-9),
        (PoseScalar::Clearance, 1e-9),
        (PoseScalar::Reach, 1e-6),
        (PoseScalar::Determinant, 1e-9),
    ] {
        let at_pose = |model: &Model, design: &Design, pose: &Pose| {
            let found = model.pose(design, pose).expect("reachable");
            match scalar {
                PoseScalar::Clearance => found.nearest.distance,
                PoseScalar::Determinant => found.values[scalar].abs(),
                _ => found.values[scalar],
            }
        };
        check(Quantity::Worst(scalar), tolerance, |model, evaluation| {
            least(model, evaluation, at_pose)
        });
    }
    check(Quantity::WorkspaceRadius, 0.0, |_, found| found.workspace_radius());
}

/// The displacement under a force in the most compliant direction, from the inverse of the whole stiffness matrix.
#[test]
fn the_displacement_is_that_of_the_inverse_stiffness() {
    check(Quantity::Worst(PoseScalar::Displacement), 1e-8, |model, evaluation| {
        let of_pose = |model: &Model, design: &Design, pose: &Pose| {
            let stiffness = model.pose(design, pose).expect("reachable").stiffness;
            let compliance = stiffness.try_inverse().expect("regular");
            let block: Matrix2<f64> = compliance.fixed_view::<2, 2>(0, 0).into_owned();
            -100.0 * block.symmetric_eigenvalues().max()
        };
        -least(model, evaluation, of_pose)
    });
}

/// The transmission of a leg, from the joints: the component along the last link of the way that the driven point takes.
#[test]
fn the_transmission_is_that_of_the_joints() {
    check(Quantity::Worst(PoseScalar::Transmission), 1e-9, |model, evaluation| {
        least(model, evaluation, |model, design, pose| {
            let found = model.pose(design, pose).expect("reachable");
            let anchor = |leg: usize| {
                let angle = [210f64, 330.0, 90.0][leg % 3].to_radians();
                [design.base_radius() * angle.cos(), design.base_radius() * angle.sin()]
            };
            (0..3)
                .map(|leg| {
                    let (a, b, c) = (anchor(leg), found.b[leg], found.c[leg]);
                    let [link, crank] = [[c, b], [b, a]].map(|[to, from]| [to[0] - from[0], to[1] - from[1]]);
                    let unit = |[x, y]: [f64; 2]| [x / x.hypot(y), y / x.hypot(y)];
                    let u = unit(link);
                    let next = anchor(leg + 1);
                    let way = match (
                        design.architecture().actuator(),
                        design.architecture() == Architecture::ALL[0],
                    ) {
                        (JointKind::Revolute, _) => {
                            let [x, y] = unit(crank);
                            [-y, x]
                        }
                        (_, true) => unit([next[0] - a[0], next[1] - a[1]]),
                        _ => u,
                    };
                    (u[0] * way[0] + u[1] * way[1]).abs()
                })
                .fold(f64::INFINITY, f64::min)
        })
    });
}

#[test]
fn the_footprint_holds_the_base_and_all_members() {
    check(Quantity::Worst(PoseScalar::Footprint), 1e-9, |model, evaluation| {
        let farthest = poses(evaluation).into_iter().flat_map(|pose| {
            let members = model.members(&evaluation.design, &pose).expect("reachable");
            members.into_iter().map(|member| {
                // The capsule of a slider ends in half spheres within the block.
                let axis_end = |end: glam::DVec3, other: glam::DVec3| match member.member.kind {
                    MemberKind::Slider => end + (other - end).normalize() * member.radius,
                    _ => end,
                };
                let ends = [axis_end(member.from, member.to), axis_end(member.to, member.from)];
                ends.map(|end| end.truncate().length()).into_iter().fold(0.0, f64::max) + member.radius
            })
        });
        farthest.fold(evaluation.design.base_radius(), f64::max)
    });
}

/// The mean dexterity over a disc, by a fine quadrature in polar coordinates, pose by pose.
#[test]
fn the_mean_dexterity_is_the_integral_over_the_region() {
    check(Quantity::DexterityMean, 2e-3, |model, evaluation| {
        let (design, radius) = (&evaluation.design, evaluation.workspace_radius());
        let home = evaluation.home_phi_deg.expect("a home");
        let (rings, directions, turns) = (40, 72, 16);
        let (mut sum, mut total) = (0.0, 0.0);
        for turn in 0..turns {
            let phi = home - 10.0 + 20.0 * (f64::from(turn) + 0.5) / f64::from(turns);
            for ring in 0..rings {
                let distance = radius * (f64::from(ring) + 0.5) / f64::from(rings);
                for direction in 0..directions {
                    let at = unit((360.0 * f64::from(direction) / f64::from(directions)).to_radians()) * distance;
                    let found = model.pose(design, &Pose::new(at.x, at.y, phi.to_radians()));
                    sum += distance * found.expect("reachable").values[PoseScalar::Dexterity];
                    total += distance;
                }
            }
        }
        sum / total
    });
}

/// Quantities that are not asked for cost nothing and have no value; asking changes nothing else.
#[test]
fn asking_for_quantities_changes_no_other_value() {
    for text in DESIGNS {
        let design = parsed(text);
        let asked = model().evaluate(&design, GridChoice::Reference);
        let plain = Model::default().evaluate(&design, GridChoice::Reference);
        for quantity in Quantity::all() {
            let (a, b) = (asked.quantities.get(quantity), plain.quantities.get(quantity));
            let exists = match quantity {
                Quantity::Worst(scalar) => Model::default().has(&design, scalar),
                // The paper's model has no motion.
                other => !Quantity::OF_TASK.contains(&other),
            };
            assert_eq!(a.is_some(), exists, "{}", quantity.entry().key);
            assert_eq!(b.is_some(), quantity.is_always_known());
            assert!(b.is_none() || a == b);
        }
        let quantities = plain.quantities;
        assert_eq!(Evaluation { quantities, ..asked }, plain);
    }
}

/// A limit of a pose bounds the largest disc: beyond it the value is missed, within it the value is kept.
#[test]
fn limits_of_poses_bound_the_workspace() {
    let design = parsed(DESIGNS[0]);
    let free = model().evaluate(&design, GridChoice::Reference);
    let bounded = |scalar: PoseScalar, limit: f64| {
        strategies::model(|settings| {
            settings.quantities = QuantitySet::all();
            settings.thresholds.set(scalar, Some(limit));
        })
        .evaluate(&design, GridChoice::Reference)
    };
    let stiff = bounded(PoseScalar::Displacement, 6e-5);
    assert!(value_of(Quantity::Worst(PoseScalar::Displacement), &stiff) <= 6e-5);
    let driven = bounded(PoseScalar::Transmission, 0.5);
    assert!(value_of(Quantity::Worst(PoseScalar::Transmission), &driven) >= 0.5);
    for bounded in [&stiff, &driven] {
        assert!(bounded.workspace_radius() > 0.0 && bounded.workspace_radius() < free.workspace_radius());
    }
    let inside = bounded(PoseScalar::Reach, 0.3);
    assert!(inside.constraint(Constraint::Reach).value.expect("a value") >= 0.3);
    // The proof counts the limits: one that left them out would prove too much.
    for (scalar, limit, evaluation) in [
        (PoseScalar::Transmission, 0.5, &driven),
        (PoseScalar::Reach, 0.3, &inside),
    ] {
        let model = strategies::model(|settings| {
            settings.thresholds.set(scalar, Some(limit));
        });
        let claim = model.claim(evaluation).expect("a workspace");
        let found = model.certify(&design, &claim).expect("a certificate");
        let upper = found.upper.expect("an infeasible pose");
        assert!(
            found.is_closed(1e-4) && (upper / evaluation.workspace_radius() - 1.0).abs() < 0.01,
            "{found:?}"
        );
        assert!(
            found.violation.is_some_and(|violation| violation.scalar == scalar),
            "{found:?}"
        );
    }
    // The same limits of a prescribed disc.
    let radius = driven.workspace_radius();
    for (share, holds) in [(0.999, true), (1.001, false)] {
        let model = strategies::model(|settings| {
            settings.thresholds.set(PoseScalar::Transmission, Some(0.5));
            settings.workspace.region = Region::Disc(share * radius);
        });
        assert_eq!(
            model.evaluate(&design, GridChoice::Reference).is_feasible(),
            holds,
            "{share}"
        );
    }
}

#[test]
fn limits_of_designs_make_them_infeasible_by_their_relative_shortfall() {
    let design = parsed(DESIGNS[0]);
    let with = |quantity, bound| {
        strategies::model(|settings| {
            settings.quantities = QuantitySet::all();
            settings.limits = vec![QuantityLimit { quantity, bound }];
        })
        .evaluate(&design, GridChoice::Reference)
    };
    let mass = Model::default().mass(&design);
    assert!(with(Quantity::Mass, Bound::AtMost(mass)).is_feasible());
    let heavy = with(Quantity::Mass, Bound::AtMost(0.8 * mass));
    assert!((heavy.violation - 0.25).abs() < 1e-12 && heavy.workspace_radius() > 0.0);
    let wide = with(Quantity::Worst(PoseScalar::Footprint), Bound::AtMost(1.0));
    let footprint = value_of(Quantity::Worst(PoseScalar::Footprint), &wide);
    assert!((wide.violation - (footprint - 1.0)).abs() < 1e-12);
    assert!(with(Quantity::DexterityMean, Bound::AtLeast(0.1)).is_feasible());
}

#[test]
fn the_frame_frequency_is_that_of_the_pose_with_the_lowest_one() {
    let lowest = |pair: [f64; 2]| pair[0].min(pair[1]);
    check(Quantity::FrameFrequency, 1e-10, |model, evaluation| {
        let posed = model.posed(&evaluation.design);
        let mut found = (f64::INFINITY, 0.0);
        for pose in poses(evaluation) {
            let Ok(Some(dynamics)) = posed.dynamics_at(&pose) else {
                continue;
            };
            let condensed = dynamics.report().expect("regular").lowest_frequency();
            let condensed = condensed.expect("rigid rails");
            // Poses that symmetry makes equal differ by rounding.
            if condensed < found.0 * (1.0 - 1e-9) {
                found = (condensed, lowest(dynamics.frame_frequencies().expect("regular")));
            }
        }
        found.1
    });
}
