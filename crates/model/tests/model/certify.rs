//! Certificates: published intervals, enclosures against doubles, and proofs that must fail.

use std::sync::LazyLock;

use glam::DVec2;
use kinefront_model::certify::{Certificate, CertifyError, CertifyOptions, Verdict};
use kinefront_model::clearance::{Layers, Obstacle, ObstacleShape, Stacking, Surroundings};
use kinefront_model::dynamics::{DriveInertia, Payload, Tolerances};
use kinefront_model::enclosure::{Interval, PoseEnclosure, TaylorModel};
use kinefront_model::evaluation::{GridChoice, Model, ModelSettings, PoseScalar};
use kinefront_model::kinematics::CharacteristicLength;
use kinefront_model::mechanism::{CrossSection, CylinderSize, Design, JointSizes, Wall, WorkingMode};
use kinefront_model::polygon::Polygon;
use kinefront_model::spatial::Pose;
use kinefront_model::stiffness::{RailSettings, RailSupports, StiffnessDefinition};
use kinefront_model::strength::{LoadShape, Loads};
use kinefront_testkit::repetitions;
use proptest::prelude::*;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;

use super::strategies::{applicable_cases, design, limit_motion, model};

fn certify(design: &Design, phi_deg: f64, claimed_radius: f64, tolerance: f64) -> Certificate {
    let options = CertifyOptions {
        phi_deg,
        claimed_radius,
        tolerance,
        ..CertifyOptions::default()
    };
    Model::default().certify(design, &options).expect("a certificate")
}

/// A case of an independent prototype, whose poses were checked with 50 digits.
struct Case {
    name: String,
    design: Design,
    phi_deg: f64,
    fine_radius: f64,
    lower: f64,
    upper: f64,
    violation: Pose,
    violated: String,
}

fn cases() -> Vec<Case> {
    let file: serde_json::Value = serde_json::from_str(include_str!("../fixtures/certificates.json")).expect("JSON");
    let cases = file["cases"].as_array().expect("cases").iter().map(|case| {
        let number = |key: &str| case[key].as_f64().expect("a number");
        let violation = &case["violation"];
        let part = |key: &str| violation[key].as_f64().expect("a number");
        Case {
            name: case["name"].as_str().expect("a name").to_owned(),
            design: case["design"].as_str().expect("a text").parse().expect("a design"),
            phi_deg: number("phi_deg"),
            fine_radius: case["fine_grid_radius_m"].as_f64().unwrap_or(0.0),
            lower: number("lower_m"),
            upper: number("upper_m"),
            violation: Pose::new(part("x_m"), part("y_m"), part("phi_rad")),
            violated: violation["constraints"][0].as_str().expect("an id").to_owned(),
        }
    });
    cases.collect()
}

/// The pose as a box without width.
fn point(pose: &Pose) -> PoseEnclosure {
    PoseEnclosure::point(
        pose.position.to_array().map(Interval::exactly),
        Interval::exactly(pose.phi),
    )
}

/// Random poses of a disc about O, over the window about a home orientation.
fn random_poses(model: &Model, radius: f64, phi_deg: f64, count: usize) -> impl Iterator<Item = Pose> {
    let half = 0.5 * model.settings().workspace.rotation_range_deg.to_radians();
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let mut between =
        move |low: f64, high: f64| low + (high - low) * f64::from(random.next_u32()) / f64::from(u32::MAX);
    (0..count).map(move |_| {
        let (radius, angle) = (radius * between(0.0, 1.0).sqrt(), between(0.0, std::f64::consts::TAU));
        let phi = phi_deg.to_radians() + between(-half, half);
        Pose::new(radius * angle.cos(), radius * angle.sin(), phi)
    })
}

#[test]
fn certificates_agree_with_published_intervals() {
    for case in cases() {
        for tolerance in [1e-4, 1e-6] {
            let found = certify(&case.design, case.phi_deg, case.fine_radius, tolerance);
            let upper = found.upper.expect("an infeasible pose");
            println!(
                "{}: [{}, {upper}] and [{}, {}], {} boxes, {:?}",
                case.name, found.lower, case.lower, case.upper, found.boxes, found.verdict
            );
            assert!(found.lower <= case.upper && upper >= case.lower, "{}", case.name);
            assert!(found.is_closed(tolerance), "{}", case.name);
            let claim = (1.0 - tolerance) * case.fine_radius;
            let expected = if case.lower >= claim {
                Verdict::Proved
            } else {
                Verdict::Refuted
            };
            assert_eq!(found.verdict, expected, "{}", case.name);
        }
    }
}

/// The poses that the prototype proved infeasible, some by less than 1e-8 of the threshold, are proved infeasible here.
#[test]
fn poses_that_miss_a_threshold_by_little_are_proved_infeasible() {
    let model = Model::default();
    for case in cases() {
        let values = model.enclose(&case.design, &point(&case.violation)).expect("values");
        let violated = values
            .iter()
            .any(|(constraint, value)| constraint.limit_id() == case.violated && value.range()[1] < 0.0);
        assert!(violated, "{}: {}", case.name, case.violated);
        // The enclosure of a pose is narrow: its width is rounding alone.
        for (constraint, value) in &values {
            let [lower, upper] = value.range();
            assert!(
                upper - lower < 1e-9 * (1.0 + value.constant.abs()),
                "{}: {}",
                case.name,
                constraint.limit_id()
            );
        }
    }
}

/// A proof that looks for no infeasible pose must stop before the one that is known. A constraint that were dropped, a sector or
/// window too small, or a box cut too far would let it pass.
#[test]
fn a_blind_proof_stops_before_the_known_pose() {
    cases().par_iter().for_each(|case| {
        let options = CertifyOptions {
            phi_deg: case.phi_deg,
            max_boxes: 30_000,
            blind_radius: Some(1.3 * case.upper),
            ..CertifyOptions::default()
        };
        let found = Model::default().certify(&case.design, &options).expect("a certificate");
        assert!(
            found.lower <= case.upper,
            "{}: {} beyond {}",
            case.name,
            found.lower,
            case.upper
        );
        assert!(found.lower > 0.9 * case.lower, "{}: {}", case.name, found.lower);
        assert_eq!(found.upper, None);
    });
}

/// Random poses of proved discs are feasible, by the model's own formulas.
#[test]
fn no_pose_of_a_proved_disc_is_infeasible() {
    let count = repetitions(20_000, 100_000);
    let model = Model::default();
    let infeasible: usize = cases()
        .par_iter()
        .map(|case| {
            let proved = certify(&case.design, case.phi_deg, case.fine_radius, 1e-4).lower;
            let poses = random_poses(&model, proved, case.phi_deg, count);
            poses.filter(|pose| !holds(&model, &case.design, pose, -1e-9)).count()
        })
        .sum();
    assert_eq!(infeasible, 0);
}

/// Whether all constraints that are required have at least a margin at a pose.
fn holds(model: &Model, design: &Design, pose: &Pose, margin: f64) -> bool {
    model.pose(design, pose).is_ok()
        && AT_POSES
            .iter()
            .filter(|scalar| is_required(model, **scalar) && model.has(design, **scalar))
            .all(|&scalar| model.margin_at(design, pose, scalar) >= margin)
}

/// Whether a scalar is limited: the clearance, and what only some studies need, where the model states a threshold.
fn is_required(model: &Model, scalar: PoseScalar) -> bool {
    let is_optional = scalar == PoseScalar::Clearance || !PoseScalar::ALWAYS.contains(&scalar);
    !is_optional || model.settings().thresholds.get(scalar).is_some()
}

/// The scalars that a certificate encloses.
static AT_POSES: LazyLock<Vec<PoseScalar>> = LazyLock::new(|| {
    let all = PoseScalar::ALL.iter().copied();
    all.filter(|scalar| scalar.entry().is_enclosed).collect()
});

/// The model whose characteristic length depends on which orientations are reached.
const ISOTROPIC: &str = "the isotropic characteristic length";

/// Models with other definitions than the paper's, and with a required clearance.
fn other_models() -> Vec<(&'static str, Model)> {
    vec![
        ("the paper's definitions", Model::default()),
        (
            "stiffness as the reciprocal of a compliance",
            model(|settings| settings.stiffness_definition = StiffnessDefinition::Compliance),
        ),
        (
            ISOTROPIC,
            model(|settings| settings.characteristic_length = CharacteristicLength::Isotropic),
        ),
        (
            "a clearance in the layers by default",
            model(|settings| settings.thresholds.set(PoseScalar::Clearance, Some(0.005))),
        ),
        (
            "a clearance in one plane",
            model(|settings| {
                settings.thresholds.set(PoseScalar::Clearance, Some(0.005));
                settings.bodies.layers = Layers::ONE_PLANE;
            }),
        ),
        (
            "a limit of the transmission",
            model(|settings| settings.thresholds.set(PoseScalar::Transmission, Some(0.3))),
        ),
        (
            "a limit of the displacement, on rails that are pinned at their ends",
            model(|settings| {
                settings.thresholds.set(PoseScalar::Displacement, Some(2e-4));
                settings.rails = on_rails(RailSupports::Pinned).settings().rails.clone();
            }),
        ),
        (
            "rails in three clamped spans",
            on_rails(RailSupports::Clamped { spans: 3 }),
        ),
        (
            "stiffness as the reciprocal of a compliance, on rails that are pinned at their ends",
            model(|settings| {
                settings.stiffness_definition = StiffnessDefinition::Compliance;
                settings.rails = on_rails(RailSupports::Pinned).settings().rails.clone();
            }),
        ),
        (
            "limits of the strength under a cylinder of wrenches",
            model(limit_strength),
        ),
        (
            "limits of the strength of square tubes in an upright plane, under an ellipsoid of wrenches",
            model(|settings| {
                limit_strength(settings);
                settings.sections.legs = CrossSection::SquareTube(Wall::Ratio(0.2));
                settings.loads = Loads {
                    wrench: [20.0, -30.0, 10.0, 2.0, -3.0, 4.0],
                    range: [80.0, 60.0, 100.0, 5.0, 4.0, 10.0],
                    shape: LoadShape::Ellipsoid,
                    gravity: [1.0, -9.0, 3.0],
                };
            }),
        ),
        (
            "a clearance beside obstacles in a room",
            model(|settings| {
                settings.thresholds.set(PoseScalar::Clearance, Some(0.005));
                let corners = |half: [f64; 2], at: [f64; 2]| {
                    let [x, y] = half;
                    let rectangle = Polygon::rectangle(2.0 * x, 2.0 * y).expect("a rectangle");
                    rectangle.mapped(|corner| corner + DVec2::from_array(at))
                };
                settings.surroundings = Surroundings {
                    obstacles: vec![
                        Obstacle {
                            name: "post".into(),
                            shape: ObstacleShape::Disc {
                                centre: DVec2::new(1.0, 0.7),
                                radius: 0.08,
                            },
                            heights: [f64::NEG_INFINITY, f64::INFINITY],
                        },
                        Obstacle {
                            name: "beam".into(),
                            shape: ObstacleShape::Polygon(corners([0.05, 0.4], [-1.1, 0.6])),
                            heights: [0.03, 1.0],
                        },
                    ],
                    room: Some(corners([3.6, 3.8], [0.0, 0.0])),
                };
            }),
        ),
        (
            "limits of a motion with a payload beside P, in an inclined plane",
            model(limit_motion),
        ),
        (
            "a clearance of joints with a size in layers that are chosen",
            model(|settings| {
                settings.thresholds.set(PoseScalar::Clearance, Some(0.005));
                settings.bodies.stacking = Stacking::Chosen;
                settings.joint_sizes = JointSizes {
                    revolute: CylinderSize {
                        radius: 0.06,
                        height: 0.1,
                    },
                    motor: CylinderSize {
                        radius: 0.09,
                        height: 0.2,
                    },
                };
            }),
        ),
    ]
}

/// Limits everything that depends on loads that both kinds of drives have.
fn limit_strength(settings: &mut ModelSettings) {
    settings.material.yield_strength = Some(2.35e8);
    for (scalar, limit) in [
        (PoseScalar::Stress, 1e8),
        (PoseScalar::SafetyFactor, 2.0),
        (PoseScalar::BucklingFactor, 3.0),
        (PoseScalar::JointForce, 1500.0),
        (PoseScalar::JointMoment, 800.0),
    ] {
        settings.thresholds.set(scalar, Some(limit));
    }
}

/// The paper's model with rails that bend.
fn on_rails(supports: RailSupports) -> Model {
    model(|settings| {
        settings.rails = Some(RailSettings {
            section: CrossSection::Round,
            radius: 0.06,
            supports,
        });
    })
}

/// A box of poses about a point `(r/R, θ, φ)`, and its half widths.
fn polar_box(design: &Design, (part, theta, phi): (f64, f64, f64), width: f64) -> (PoseEnclosure, [f64; 3]) {
    let radius = part * design.base_radius();
    let widths = [width * radius, width, 0.5 * width];
    let (sine, cosine) = TaylorModel::sine_and_cosine(1, theta, widths[1]);
    let (phi_sine, phi_cosine) = TaylorModel::sine_and_cosine(2, phi, widths[2]);
    let distance = TaylorModel::variable(0, radius, widths[0]);
    let pose = PoseEnclosure {
        position: [distance * cosine, distance * sine],
        cosine: phi_cosine,
        sine: phi_sine,
    };
    (pose, widths)
}

proptest! {
    #![proptest_config(applicable_cases(400))]

    /// At a pose, the forms have the signs of the margins of the model, whose formulas are others.
    #[test]
    fn forms_have_the_signs_of_the_margins(
        design in design(0.005),
        x in -1.0..1.0f64,
        y in -1.0..1.0f64,
        phi in -3.0..3.0f64,
        place in prop::sample::select(vec![0, 1, 2, 3, 4, 5, 6, 9, 10, 11, 12, 12, 13]),
    ) {
        let (name, model) = other_models().swap_remove(place);
        let scale = 0.4 * design.base_radius();
        let pose = Pose::new(scale * x, scale * y, phi);
        let values = model.enclose(&design, &point(&pose)).expect("values");
        let is_reached = model.pose(&design, &pose).is_ok();
        // The forms of a clearance are those that are not proved.
        let least = |wanted: PoseScalar| {
            let of = values.iter().filter(|(scalar, _)| *scalar == wanted);
            of.map(|(_, value)| value.constant).fold(f64::INFINITY, f64::min)
        };
        let reach = least(PoseScalar::Reach);
        // At a joint limit, rounding tells.
        prop_assert!(reach.abs() < 1e-12 || (reach > 0.0) == is_reached, "{} {:?}", design, pose);
        if !is_reached || reach <= 0.0 {
            return Err(TestCaseError::reject("the legs do not reach"));
        }
        for &scalar in AT_POSES.iter() {
            let margin = model.margin_at(&design, &pose, scalar);
            if margin.abs() > 1e-6 && is_required(&model, scalar) && model.has(&design, scalar) {
                let of = values.iter().filter(|(found, _)| *found == scalar);
                let ranges: Vec<[f64; 2]> = of.map(|(_, value)| value.range()).collect();
                let is_proved = ranges.iter().all(|[lower, _]| *lower > 0.0);
                let is_refuted = ranges.iter().any(|[_, upper]| *upper < 0.0);
                // The isotropic length is not known where an orientation is at a joint limit or nearly singular: nothing is
                // claimed then.
                let is_open = !is_proved && !is_refuted && name == ISOTROPIC;
                prop_assert!(
                    is_open || is_proved == (margin > 0.0),
                    "{}: {} {:?} {}: {}", name, design, pose, scalar.limit_id(), margin
                );
            }
        }
    }

    /// Where the forms of a box are positive, the clearance is kept at each of its poses.
    #[test]
    fn a_box_without_open_forms_keeps_the_clearance(
        design in design(0.005),
        middle in (0.0..0.3f64, -3.0..3.0f64, -3.0..3.0f64),
        width in 0.001..0.1f64,
        places in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64), 20),
        place in prop::sample::select(vec![3, 4, 11, 13]),
    ) {
        let (_, model) = other_models().swap_remove(place);
        let (pose, widths) = polar_box(&design, middle, width);
        let enclosed = model.enclose(&design, &pose).expect("values");
        let is_open = |(scalar, value): &(PoseScalar, TaylorModel)| {
            // A comparison with NaN is false: nothing is proved then.
            let is_proved = value.range()[0] > 0.0;
            *scalar == PoseScalar::Clearance && !is_proved
        };
        let may_be_unreached = enclosed.iter().all(|(scalar, _)| *scalar == PoseScalar::Reach);
        if may_be_unreached || enclosed.iter().any(is_open) {
            return Err(TestCaseError::reject("the clearance is not proved"));
        }
        for (a, b, c) in places {
            let at = middle.0 * design.base_radius() + a * widths[0];
            let (theta, phi) = (middle.1 + b * widths[1], middle.2 + c * widths[2]);
            let pose = Pose::new(at * theta.cos(), at * theta.sin(), phi);
            let margin = model.margin_at(&design, &pose, PoseScalar::Clearance);
            prop_assert!(margin >= -1e-12, "{} {:?}: {}", design, pose, margin);
        }
    }

    /// Where no form of the stiffness in the plane is open on a box, it is above its threshold at each of its poses. The middle of the box is
    /// near the centre, where both eigenvalues of a symmetric manipulator are equal, and the threshold is near its stiffness there.
    #[test]
    fn a_box_without_open_forms_keeps_the_stiffness_in_the_plane(
        design in design(0.005),
        middle in (0.0..0.01f64, -3.0..3.0f64, -3.0..3.0f64),
        exponent in 1.0..5.0f64,
        below in 1.0..6.0f64,
        is_compliance: bool,
        places in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64), 20),
    ) {
        let definition = match is_compliance {
            true => StiffnessDefinition::Compliance,
            false => StiffnessDefinition::Stiffness,
        };
        let limited = |threshold: Option<f64>| model(|settings| {
            settings.stiffness_definition = definition;
            settings.thresholds.set(PoseScalar::StiffnessXy, threshold);
        });
        let Ok(at_centre) = limited(Some(1e6)).pose(&design, &Pose::new(0.0, 0.0, middle.2)) else {
            return Err(TestCaseError::reject("the legs do not reach"));
        };
        let threshold = at_centre.values[PoseScalar::StiffnessXy] * (1.0 - 10.0_f64.powf(-below));
        let model = limited(Some(threshold));
        let (pose, widths) = polar_box(&design, middle, 10.0_f64.powf(-exponent));
        let enclosed = model.enclose(&design, &pose).expect("values");
        let is_open = |(scalar, value): &(PoseScalar, TaylorModel)| {
            // A comparison with NaN is false: nothing is proved then.
            let is_proved = value.range()[0] > 0.0;
            *scalar == PoseScalar::StiffnessXy && !is_proved
        };
        let is_incomplete = enclosed.iter().all(|(scalar, _)| *scalar == PoseScalar::Reach)
            || enclosed.iter().any(|(_, value)| value.range()[0].is_nan());
        if is_incomplete || enclosed.iter().any(is_open) {
            return Err(TestCaseError::reject("the stiffness is not proved"));
        }
        for (a, b, c) in places {
            let at = middle.0 * design.base_radius() + a * widths[0];
            let (theta, phi) = (middle.1 + b * widths[1], middle.2 + c * widths[2]);
            let pose = Pose::new(at * theta.cos(), at * theta.sin(), phi);
            let margin = model.margin_at(&design, &pose, PoseScalar::StiffnessXy);
            prop_assert!(margin >= -1e-9, "{} {:?}: {}", design, pose, margin);
        }
    }

    /// Where the forms of a box are positive, the limits of a motion are kept at each of its poses.
    #[test]
    fn a_box_without_open_forms_keeps_the_limits_of_a_motion(
        design in design(0.005),
        middle in (0.0..0.3f64, -3.0..3.0f64, -3.0..3.0f64),
        width in 0.0005..0.02f64,
        places in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64), 10),
    ) {
        let (_, model) = other_models().swap_remove(12);
        let (pose, widths) = polar_box(&design, middle, width);
        let enclosed = model.enclose(&design, &pose).expect("values");
        let proved: Vec<PoseScalar> = AT_POSES
            .iter()
            .copied()
            .filter(|scalar| PoseScalar::OF_MOTION.contains(scalar))
            .filter(|scalar| {
                let mut forms = enclosed.iter().filter(|(found, _)| found == scalar).peekable();
                forms.peek().is_some() && forms.all(|(_, value)| value.range()[0] > 0.0)
            })
            .collect();
        if proved.is_empty() {
            return Err(TestCaseError::reject("nothing is proved"));
        }
        for (a, b, c) in places {
            let at = middle.0 * design.base_radius() + a * widths[0];
            let (theta, phi) = (middle.1 + b * widths[1], middle.2 + c * widths[2]);
            let pose = Pose::new(at * theta.cos(), at * theta.sin(), phi);
            for scalar in &proved {
                let margin = model.margin_at(&design, &pose, *scalar);
                prop_assert!(margin >= -1e-9, "{} {:?} {}: {}", design, pose, scalar.limit_id(), margin);
            }
        }
    }

    /// The enclosure of a box contains the values at its poses.
    #[test]
    fn enclosures_contain_the_values_of_their_boxes(
        design in design(0.005),
        middle in (0.0..0.3f64, -3.0..3.0f64, -3.0..3.0f64),
        width in 0.001..0.2f64,
        places in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64), 20),
        place in prop::sample::select(vec![0, 1, 2, 5, 6, 9, 10, 12]),
    ) {
        let (_, model) = other_models().swap_remove(place);
        let radius = middle.0 * design.base_radius();
        let (pose, widths) = polar_box(&design, middle, width);
        let enclosed = model.enclose(&design, &pose).expect("values");
        if enclosed.len() < 12 || enclosed.iter().any(|(_, value)| value.range()[0].is_nan()) {
            return Err(TestCaseError::reject("the legs may not reach the whole box"));
        }
        for (a, b, c) in places {
            let at = radius + a * widths[0];
            let (theta, phi) = (middle.1 + b * widths[1], middle.2 + c * widths[2]);
            let values = model
                .enclose(&design, &point(&Pose::new(at * theta.cos(), at * theta.sin(), phi)))
                .expect("values");
            // Only g5 is left out, where one leg alone is stiff enough.
            prop_assert!(values.len() + 1 >= enclosed.len());
            let of_box = |place: usize| {
                let (scalar, _) = values[place];
                let before = values[..place].iter().filter(|(other, _)| *other == scalar).count();
                enclosed.iter().filter(|(other, _)| *other == scalar).nth(before)
            };
            for (place, (constraint, value)) in values.iter().enumerate() {
                let Some((_, whole)) = of_box(place) else { continue };
                // Its forms are scaled by the middle of the box.
                if *constraint == PoseScalar::NaturalFrequency {
                    continue;
                }
                let [lower, upper] = value.range();
                // Within the remainder of the polynomial, not only within its range.
                let polynomial = whole.value([a, b, c]);
                let slack = whole.remainder + value.remainder + 1e-13 * (1.0 + polynomial.abs());
                prop_assert!((value.constant - polynomial).abs() <= slack, "{}: {} is not {} ± {}", constraint.limit_id(), value.constant, polynomial, slack);
                let [low, high] = whole.range();
                prop_assert!(lower <= high && upper >= low, "{}: [{}, {}] in [{}, {}]", constraint.limit_id(), lower, upper, low, high);
            }
        }
    }
}

/// A layer that keeps exactly the required clearance, above an obstacle or well above it, refutes no pose over the obstacle; one that
/// keeps less does.
#[test]
fn a_member_may_pass_over_an_obstacle() {
    let design: Design = "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.05"
        .parse()
        .expect("a design");
    let verdict = |top: f64, is_square: bool| {
        let model = model(|settings| {
            settings.thresholds.set(PoseScalar::Clearance, Some(0.0));
            if is_square {
                settings.sections.platform = CrossSection::SquareTube(Wall::Ratio(0.5));
                settings.sections.legs = CrossSection::SquareTube(Wall::Ratio(0.5));
            }
            settings.surroundings.obstacles = vec![Obstacle {
                name: "table".into(),
                shape: ObstacleShape::Polygon(Polygon::rectangle(12.0, 12.0).expect("a rectangle")),
                heights: [-1.0, top],
            }];
        });
        let options = CertifyOptions {
            phi_deg: 29.5,
            claimed_radius: 0.2,
            max_boxes: 300,
            ..CertifyOptions::default()
        };
        model.certify(&design, &options).expect("a certificate").verdict
    };
    for is_square in [false, true] {
        assert_eq!(verdict(-0.2, is_square), Verdict::Proved);
        assert_ne!(verdict(-0.05, is_square), Verdict::Refuted);
        assert_eq!(verdict(-0.04, is_square), Verdict::Refuted);
    }
}

/// A limit for which there is no form is refused: a proof that left it out would prove too much.
#[test]
fn a_limit_without_a_form_is_refused() {
    let model = model(|settings| settings.thresholds.set(PoseScalar::Footprint, Some(1.0)));
    let found = model.certify(&cases()[0].design, &CertifyOptions::default());
    assert_eq!(found, Err(CertifyError::Uncovered(PoseScalar::Footprint)));
}

/// Mixed working modes and a centre away from O are certified.
#[test]
fn other_studies_are_certified() {
    let shifted = model(|settings| {
        settings.workspace.centre = glam::DVec2::new(0.1, -0.05);
    });
    let design = cases()[1]
        .design
        .with_working_mode(WorkingMode::new([true, true, false]));
    for model in [&shifted, &Model::default()] {
        let evaluation = model.evaluate(&design, GridChoice::Fine);
        let options = CertifyOptions {
            phi_deg: evaluation.home_phi_deg.expect("a home"),
            claimed_radius: evaluation.workspace_radius(),
            ..CertifyOptions::default()
        };
        let found = model.certify(&design, &options).expect("a certificate");
        let upper = found.upper.expect("an infeasible pose");
        println!("{} claimed, [{}, {upper}]", evaluation.workspace_radius(), found.lower);
        assert!((upper / evaluation.workspace_radius() - 1.0).abs() < 0.01);
        assert!(found.is_closed(1e-4));
    }
    let far = CertifyOptions {
        tolerance: 2.0,
        ..CertifyOptions::default()
    };
    let error = Model::default().certify(&design, &far).expect_err("an option");
    assert!(error.to_string().contains("tolerance"));
}

/// Each definition of a study has its proof: the certificate agrees with the fine grid, no random pose of the proved disc is
/// infeasible, and a proof that looks for no infeasible pose stops before the one that is known.
#[test]
fn other_definitions_are_certified() {
    let poses = repetitions(2000, 20_000);
    let designs = cases();
    let tasks: Vec<_> = other_models()
        .into_iter()
        .flat_map(|(name, model)| designs.iter().map(move |case| (name, model.clone(), case.design)))
        .collect();
    let closed: Vec<bool> = tasks
        .into_par_iter()
        .map(|(name, model, design)| {
            let evaluation = model.evaluate(&design, GridChoice::Fine);
            let Some(phi_deg) = evaluation.home_phi_deg.filter(|_| evaluation.workspace_radius() > 0.0) else {
                return false;
            };
            let options = CertifyOptions {
                phi_deg,
                claimed_radius: evaluation.workspace_radius(),
                max_boxes: 50_000,
                ..CertifyOptions::default()
            };
            let found = model.certify(&design, &options).expect("a certificate");
            let upper = found.upper.expect("an infeasible pose");
            let violation = found.violation.expect("an infeasible pose");
            println!(
                "{name}, {design}: {} claimed, [{}, {upper}] by {}, {} boxes, {:?}",
                evaluation.workspace_radius(),
                found.lower,
                violation.scalar.limit_id(),
                found.boxes,
                found.verdict
            );
            assert!(model.margin_at(&design, &violation.pose, violation.scalar) < 1e-12);
            assert!(upper < 1.01 * evaluation.workspace_radius());
            for pose in random_poses(&model, found.lower, phi_deg, poses) {
                assert!(holds(&model, &design, &pose, -1e-9), "{name}, {design}: {pose:?}");
            }
            let blind = CertifyOptions {
                max_boxes: 3000,
                blind_radius: Some(1.3 * upper),
                ..options
            };
            let blind = model.certify(&design, &blind).expect("a certificate");
            assert!(blind.lower <= upper, "{name}, {design}: {} beyond {upper}", blind.lower);
            found.is_closed(1e-4)
        })
        .collect();
    let count = closed.iter().filter(|&&closed| closed).count();
    println!("{count} of {} closed", closed.len());
    assert!(10 * count > 8 * closed.len());
}

/// The error of the position has its largest value in one of many directions, which are nearly equal: a proof bounds each by itself, and
/// needs no more boxes than for a stiffness.
#[test]
fn errors_of_the_position_are_proved_in_few_boxes() {
    let design: Design =
        "3-RPR R=2.6286599157038495 r=0.1 Lb=3.3818585221458024 rj=0.03566504854894458 rp=0.036285122897956976"
            .parse()
            .expect("a design");
    let model = model(|settings| {
        settings.dynamics.tolerances = Tolerances {
            encoder_prismatic: 1e-5,
            link: 5e-5,
            base: 5e-5,
            platform: 5e-5,
            play: 1e-5,
            ..Tolerances::default()
        };
        settings.thresholds.set(PoseScalar::PositionError, Some(5e-4));
    });
    let options = CertifyOptions {
        phi_deg: 20.0,
        claimed_radius: 0.8393,
        max_boxes: 4000,
        ..CertifyOptions::default()
    };
    let found = model.certify(&design, &options).expect("a certificate");
    assert_eq!(found.verdict, Verdict::Proved, "{found:?}");
    // The other constraints decide where the disc ends; a tighter limit of the error does.
    let tighter = self::model(|settings| {
        settings.dynamics.tolerances = model.settings().dynamics.tolerances;
        settings.thresholds.set(PoseScalar::PositionError, Some(3.5e-4));
    });
    let smaller = tighter.certify(&design, &options).expect("a certificate");
    assert_eq!(smaller.verdict, Verdict::Refuted, "{smaller:?}");
    let violation = smaller.violation.expect("a pose");
    assert_eq!(violation.scalar, PoseScalar::PositionError);
    let posed = tighter.posed(&design);
    let dynamics = posed.dynamics_at(&violation.pose).expect("reached").expect("stiff");
    assert!(dynamics.report().expect("regular").accuracy.worst_position > 3.5e-4);
}

/// The stiffness in the plane of this optimum is least in the centre, where the manipulator is symmetric and both its eigenvalues exceed the
/// threshold by 2e-7 of it.
#[test]
fn a_stiffness_that_is_least_where_its_eigenvalues_are_equal_is_proved() {
    let text = "3-P_RR R=4 r=0.14935859666382795 Lb=1.5514089061513892 rj=0.049725304654801086 rp=0.022790058118897446 alpha_deg=30";
    let design: Design = text.parse().expect("a design");
    let options = CertifyOptions {
        claimed_radius: 1.5,
        max_boxes: 150_000,
        ..CertifyOptions::default()
    };
    let found = Model::default().certify(&design, &options).expect("a certificate");
    assert_eq!(found.verdict, Verdict::Proved, "{found:?}");
    // A threshold that the centre misses by as little is refuted.
    let missed = model(|settings| {
        let threshold = settings.thresholds.get(PoseScalar::StiffnessXy).expect("a threshold");
        settings
            .thresholds
            .set(PoseScalar::StiffnessXy, Some(threshold * (1.0 + 1e-6)));
    });
    let found = missed.certify(&design, &options).expect("a certificate");
    assert_eq!(found.verdict, Verdict::Refuted, "{found:?}");
    assert_eq!(found.violation.expect("a pose").scalar, PoseScalar::StiffnessXy);
}

/// A slider and a joint of the platform pass each other along a surface of poses, where their clearance exceeds the required one by little. The
/// direction between the two joints, which are near each other, turns fast, and the clearance is nearly constant where several coordinates
/// change together.
#[test]
fn joints_that_pass_each_other_are_proved_apart() {
    let text = "3-PRR R=4 r=1.565331380727554 Lb=2.657635302229482 rj=0.023993594255565978 rp=0.06409684361856031";
    let design: Design = text.parse().expect("a design");
    let certified = |clearance: f64| {
        let model = model(|settings| settings.thresholds.set(PoseScalar::Clearance, Some(clearance)));
        let options = CertifyOptions {
            phi_deg: 18.0,
            claimed_radius: 1.6122,
            max_boxes: 40_000,
            ..CertifyOptions::default()
        };
        model.certify(&design, &options).expect("a certificate")
    };
    let found = certified(0.005);
    assert_eq!(found.verdict, Verdict::Proved, "{found:?}");
    let missed = certified(0.0055);
    assert_eq!(missed.verdict, Verdict::Refuted, "{missed:?}");
    assert_eq!(missed.violation.expect("a pose").scalar, PoseScalar::Clearance);
}

/// The stiffness out of the plane is nearly the threshold in a large part of this workspace, and its enclosure on rails that bend was too
/// wide at a point far from where force and moment are decoupled.
#[test]
fn a_large_workspace_on_rails_that_bend_is_proved() {
    let text = "3-PRR R=3.9758809925987957 r=2.1371163761287293 Lb=4 rj=0.035259241235426106 rp=0.07991042300038287 alpha_deg=90";
    let design: Design = text.parse().expect("a design");
    let model = model(|settings| {
        settings.rails = Some(RailSettings {
            section: CrossSection::Round,
            radius: 0.03,
            supports: RailSupports::Clamped { spans: 4 },
        });
    });
    let options = CertifyOptions {
        phi_deg: 5.0,
        claimed_radius: 1.9915,
        max_boxes: 60_000,
        ..CertifyOptions::default()
    };
    let found = model.certify(&design, &options).expect("a certificate");
    assert_eq!(found.verdict, Verdict::Proved, "{found:?}");
}

/// The natural frequency is the limit in a large part of this workspace, where the manipulator is far stiffer in one direction than in
/// another: forms in the coordinates of the platform left it open after 200 000 boxes.
#[test]
fn a_natural_frequency_is_proved_where_the_stiffness_is_uneven() {
    let text = "3-PRR R=4 r=1.1303600371987672 Lb=2.5288918081201395 rj=0.05749941235277213 rp=0.05682624636662326";
    let design: Design = text.parse().expect("a design");
    let model = |limit: f64| {
        model(|settings| {
            settings.dynamics.payload = Payload {
                mass: 20.0,
                inertia: 0.6,
                centre: [0.0; 2],
            };
            settings.dynamics.drives = DriveInertia {
                slider_mass: 5.0,
                prismatic: 10.0,
                revolute: 4.0,
            };
            settings.thresholds.set(PoseScalar::NaturalFrequency, Some(limit));
        })
    };
    let options = CertifyOptions {
        phi_deg: 37.5,
        claimed_radius: 1.28666015625,
        max_boxes: 20_000,
        ..CertifyOptions::default()
    };
    let found = model(10.0).certify(&design, &options).expect("a certificate");
    assert_eq!(found.verdict, Verdict::Proved, "{found:?}");
    let missed = model(10.01).certify(&design, &options).expect("a certificate");
    assert_eq!(missed.verdict, Verdict::Refuted, "{missed:?}");
    assert_eq!(missed.violation.expect("a pose").scalar, PoseScalar::NaturalFrequency);
}

/// The bound over all home orientations is above the lower bound at the best one, and not far from the radius of the fine grid.
#[test]
fn the_bound_of_all_homes_encloses_the_radius() {
    let models = other_models();
    let bounds: Vec<f64> = cases()
        .par_iter()
        .map(|case| {
            let (_, model) = &models[0];
            let evaluation = model.evaluate(&case.design, GridChoice::Fine);
            let claim = model.claim(&evaluation).expect("a workspace");
            let found = model.certify(&case.design, &claim).expect("a certificate");
            let bound = model
                .bound_of_homes(&case.design, found.lower)
                .expect("forms")
                .expect("a bound");
            println!(
                "{}: [{}, {bound}], fine grid {}",
                case.name, found.lower, claim.claimed_radius
            );
            assert!(bound > found.lower);
            // Each home of the fine grid has an infeasible pose within the bound.
            for phi_deg in (0..360).step_by(24) {
                let options = CertifyOptions {
                    phi_deg: f64::from(phi_deg),
                    max_boxes: 2000,
                    ..CertifyOptions::default()
                };
                let other = model.certify(&case.design, &options).expect("a certificate");
                assert!(other.lower <= bound, "{} at {phi_deg}°: {}", case.name, other.lower);
            }
            bound / claim.claimed_radius
        })
        .collect();
    let close = bounds.iter().filter(|&&ratio| ratio < 1.02).count();
    assert!(2 * close > bounds.len(), "{bounds:?}");

    // Without thresholds, det A may have another sign at each home: the bound is above the radius of the best one.
    let free = model(|settings| {
        settings.thresholds.set(PoseScalar::Dexterity, Some(0.0));
        settings.thresholds.set(PoseScalar::StiffnessXy, Some(0.0));
        settings.thresholds.set(PoseScalar::StiffnessZ, Some(0.0));
        settings.thresholds.set(PoseScalar::StiffnessPhiZ, Some(0.0));
    });
    let design: Design = "3-RRR R=1 r=0.4 Lb=1.2 rj=0.03 rp=0.03".parse().expect("a design");
    let best = free.evaluate(&design, GridChoice::Fine);
    let proved = |phi_deg: f64| {
        let options = CertifyOptions {
            phi_deg,
            ..CertifyOptions::default()
        };
        free.certify(&design, &options).expect("a certificate").lower
    };
    let best = proved(best.home_phi_deg.expect("a home"));
    for phi_deg in [0.0, 65.0, 140.0] {
        let bound = free.bound_of_homes(&design, proved(phi_deg)).expect("forms");
        assert!(
            bound.is_none_or(|bound| bound >= best),
            "{phi_deg}°: {bound:?} below {best}"
        );
    }
}

/// A window without width has no upper bound, since no double lies in it; a wide one, thresholds of 0 and a negative home
/// orientation are certified.
#[test]
fn extreme_settings_are_certified() {
    let design = cases()[1].design;
    let certify = |change: fn(&mut kinefront_model::evaluation::ModelSettings), phi_deg: f64| {
        let options = CertifyOptions {
            phi_deg,
            max_boxes: 20_000,
            ..CertifyOptions::default()
        };
        model(change).certify(&design, &options).expect("a certificate")
    };
    let narrow = certify(|settings| settings.workspace.rotation_range_deg = 0.0, 29.5);
    assert!(narrow.upper.is_none() && narrow.lower > 1.2, "{narrow:?}");
    let paper = certify(|_| {}, 29.5);
    let turned = certify(|_| {}, 29.5 - 360.0);
    assert!((paper.lower - turned.lower).abs() < 2e-4 * paper.lower);
    let wide = certify(|settings| settings.workspace.rotation_range_deg = 40.0, 29.5);
    assert!(wide.upper.expect("an infeasible pose") < paper.lower);
    let free = certify(
        |settings| {
            settings.thresholds.set(PoseScalar::Dexterity, Some(0.0));
            settings.thresholds.set(PoseScalar::StiffnessXy, Some(0.0));
            settings.thresholds.set(PoseScalar::StiffnessZ, Some(0.0));
            settings.thresholds.set(PoseScalar::StiffnessPhiZ, Some(0.0));
        },
        29.5,
    );
    // Reach and the sign of det A alone allow a larger disc, and end it.
    assert!(free.lower > paper.lower && free.is_closed(1e-4), "{free:?}");
    let violation = free.violation.expect("a pose");
    assert!(matches!(violation.scalar, PoseScalar::Reach | PoseScalar::Determinant));
}
