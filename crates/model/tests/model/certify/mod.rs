//! Certificates: published intervals, enclosures against doubles, and proofs that must fail.

mod boxes;
mod definitions;
mod tight;

use std::sync::LazyLock;

use glam::DVec2;
use kinefront_model::certify::{Certificate, CertifyError, CertifyOptions, Verdict};
use kinefront_model::clearance::{Obstacle, ObstacleShape};
use kinefront_model::enclosure::{Interval, PoseEnclosure};
use kinefront_model::evaluation::{GridChoice, Model, ModelSettings, PoseScalar};
use kinefront_model::mechanism::{CrossSection, Design, Wall, WorkingMode};
use kinefront_model::polygon::Polygon;
use kinefront_model::spatial::Pose;
use kinefront_testkit::repetitions;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;

use super::strategies::{PAPER_LIMITS, model, parsed};
use definitions::other_models;

fn certify(design: &Design, phi_deg: f64, claimed_radius: f64, tolerance: f64) -> Certificate {
    let options = CertifyOptions {
        phi_deg,
        claimed_radius,
        tolerance,
        ..CertifyOptions::default()
    };
    Model::default().certify(design, &options).expect("a certificate")
}

/// Returns what is proved about a radius that is claimed at a home orientation, in so many boxes at most.
fn claimed(model: &Model, design: &Design, claimed_radius: f64, phi_deg: f64, max_boxes: usize) -> Certificate {
    let options = CertifyOptions {
        phi_deg,
        claimed_radius,
        max_boxes,
        ..CertifyOptions::default()
    };
    model.certify(design, &options).expect("a certificate")
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
    let file: serde_json::Value = serde_json::from_str(include_str!("../../fixtures/certificates.json")).expect("JSON");
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
    let count = repetitions(5000, 100_000);
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

/// A layer that keeps exactly the required clearance, above an obstacle or well above it, refutes no pose over the obstacle; one that
/// keeps less does.
#[test]
fn a_member_may_pass_over_an_obstacle() {
    let design = parsed("3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.05");
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
        claimed(&model, &design, 0.2, 29.5, 300).verdict
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
        settings.workspace.centre = DVec2::new(0.1, -0.05);
    });
    let design = cases()[1]
        .design
        .with_working_mode(WorkingMode::new([true, true, false]));
    for model in [&shifted, &Model::default()] {
        let evaluation = model.evaluate(&design, GridChoice::Fine);
        let (radius, home) = (evaluation.workspace_radius(), evaluation.home_phi_deg.expect("a home"));
        let found = claimed(model, &design, radius, home, CertifyOptions::MAX_BOXES);
        let upper = found.upper.expect("an infeasible pose");
        println!("{radius} claimed, [{}, {upper}]", found.lower);
        assert!((upper / radius - 1.0).abs() < 0.01);
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
    let poses = repetitions(500, 20_000);
    let designs = cases();
    let tasks: Vec<_> = other_models()
        .flat_map(|(name, model)| designs.iter().map(move |case| (name, model.clone(), case.design)))
        .collect();
    let closed: Vec<bool> = tasks
        .into_par_iter()
        .map(|(name, model, design)| {
            let evaluation = model.evaluate(&design, GridChoice::Fine);
            let Some(phi_deg) = evaluation.home_phi_deg.filter(|_| evaluation.workspace_radius() > 0.0) else {
                return false;
            };
            let found = claimed(&model, &design, evaluation.workspace_radius(), phi_deg, 50_000);
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
                phi_deg,
                claimed_radius: evaluation.workspace_radius(),
                max_boxes: 3000,
                blind_radius: Some(1.3 * upper),
                ..CertifyOptions::default()
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

/// Sets the paper's limits to 0.
fn require_nothing(settings: &mut ModelSettings) {
    for scalar in PAPER_LIMITS {
        settings.thresholds.set(scalar, Some(0.0));
    }
}

/// The bound over all home orientations is above the lower bound at the best one, and not far from the radius of the fine grid.
#[test]
fn the_bound_of_all_homes_encloses_the_radius() {
    let paper = Model::default();
    let bounds: Vec<f64> = cases()
        .par_iter()
        .map(|case| {
            let evaluation = paper.evaluate(&case.design, GridChoice::Fine);
            let claim = paper.claim(&evaluation).expect("a workspace");
            let found = paper.certify(&case.design, &claim).expect("a certificate");
            let bound = paper
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
                let other = claimed(&paper, &case.design, 0.0, f64::from(phi_deg), 2000);
                assert!(other.lower <= bound, "{} at {phi_deg}°: {}", case.name, other.lower);
            }
            bound / claim.claimed_radius
        })
        .collect();
    let close = bounds.iter().filter(|&&ratio| ratio < 1.02).count();
    assert!(2 * close > bounds.len(), "{bounds:?}");

    // Without thresholds, det A may have another sign at each home: the bound is above the radius of the best one.
    let free = model(require_nothing);
    let design = parsed("3-RRR R=1 r=0.4 Lb=1.2 rj=0.03 rp=0.03");
    let best = free.evaluate(&design, GridChoice::Fine);
    let proved = |phi_deg: f64| claimed(&free, &design, 0.0, phi_deg, CertifyOptions::MAX_BOXES).lower;
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
    let certify = |change: fn(&mut ModelSettings), phi_deg: f64| claimed(&model(change), &design, 0.0, phi_deg, 20_000);
    let narrow = certify(|settings| settings.workspace.rotation_range_deg = 0.0, 29.5);
    assert!(narrow.upper.is_none() && narrow.lower > 1.2, "{narrow:?}");
    let paper = certify(|_| {}, 29.5);
    let turned = certify(|_| {}, 29.5 - 360.0);
    assert!((paper.lower - turned.lower).abs() < 2e-4 * paper.lower);
    let wide = certify(|settings| settings.workspace.rotation_range_deg = 40.0, 29.5);
    assert!(wide.upper.expect("an infeasible pose") < paper.lower);
    let free = certify(require_nothing, 29.5);
    // Reach and the sign of det A alone allow a larger disc, and end it.
    assert!(free.lower > paper.lower && free.is_closed(1e-4), "{free:?}");
    let violation = free.violation.expect("a pose");
    assert!(matches!(violation.scalar, PoseScalar::Reach | PoseScalar::Determinant));
}
