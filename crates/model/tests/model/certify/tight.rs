//! Optima whose proofs are difficult: each holds by little, and a limit that it misses by little is refuted.

use kinefront_model::certify::{Certificate, Verdict};
use kinefront_model::dynamics::{DriveInertia, Payload, Tolerances};
use kinefront_model::evaluation::{Model, PoseScalar};
use kinefront_model::stiffness::RailSupports;

use super::claimed;
use crate::strategies::{model, parsed, round_rails};

#[track_caller]
fn assert_proved(found: &Certificate) {
    assert_eq!(found.verdict, Verdict::Proved, "{found:?}");
}

#[track_caller]
fn assert_refuted_by(scalar: PoseScalar, found: &Certificate) {
    assert_eq!(found.verdict, Verdict::Refuted, "{found:?}");
    assert_eq!(found.violation.expect("a pose").scalar, scalar);
}

/// The error of the position has its largest value in one of many directions, which are nearly equal: a proof bounds each by itself, and
/// needs no more boxes than for a stiffness.
#[test]
fn errors_of_the_position_are_proved_in_few_boxes() {
    let text = "3-RPR R=2.6286599157038495 r=0.1 Lb=3.3818585221458024 rj=0.03566504854894458 rp=0.036285122897956976";
    let design = parsed(text);
    let limited = |limit: f64| {
        model(|settings| {
            settings.dynamics.tolerances = Tolerances {
                encoder_prismatic: 1e-5,
                link: 5e-5,
                base: 5e-5,
                platform: 5e-5,
                play: 1e-5,
                ..Tolerances::default()
            };
            settings.thresholds.set(PoseScalar::PositionError, Some(limit));
        })
    };
    assert_proved(&claimed(&limited(5e-4), &design, 0.8393, 20.0, 4000));
    // The other constraints decide where the disc ends; a tighter limit of the error does.
    let tighter = limited(3.5e-4);
    let smaller = claimed(&tighter, &design, 0.8393, 20.0, 4000);
    assert_refuted_by(PoseScalar::PositionError, &smaller);
    let posed = tighter.posed(&design);
    let pose = smaller.violation.expect("a pose").pose;
    let dynamics = posed.dynamics_at(&pose).expect("reached").expect("stiff");
    assert!(dynamics.report().expect("regular").accuracy.worst_position > 3.5e-4);
}

/// The stiffness in the plane of this optimum is least in the centre, where the manipulator is symmetric and both its eigenvalues exceed the
/// threshold by 2e-7 of it.
#[test]
fn a_stiffness_that_is_least_where_its_eigenvalues_are_equal_is_proved() {
    let text = "3-P_RR R=4 r=0.14935859666382795 Lb=1.5514089061513892 rj=0.049725304654801086 rp=0.022790058118897446 alpha_deg=30";
    let design = parsed(text);
    assert_proved(&claimed(&Model::default(), &design, 1.5, 0.0, 150_000));
    // A threshold that the centre misses by as little is refuted.
    let missed = model(|settings| {
        let threshold = settings.thresholds.get(PoseScalar::StiffnessXy).expect("a threshold");
        let limit = threshold * (1.0 + 1e-6);
        settings.thresholds.set(PoseScalar::StiffnessXy, Some(limit));
    });
    assert_refuted_by(PoseScalar::StiffnessXy, &claimed(&missed, &design, 1.5, 0.0, 150_000));
}

/// A slider and a joint of the platform pass each other along a surface of poses, where their clearance exceeds the required one by little. The
/// direction between the two joints, which are near each other, turns fast, and the clearance is nearly constant where several coordinates
/// change together.
#[test]
fn joints_that_pass_each_other_are_proved_apart() {
    let text = "3-PRR R=4 r=1.565331380727554 Lb=2.657635302229482 rj=0.023993594255565978 rp=0.06409684361856031";
    let design = parsed(text);
    let certified = |clearance: f64| {
        let model = model(|settings| settings.thresholds.set(PoseScalar::Clearance, Some(clearance)));
        claimed(&model, &design, 1.6122, 18.0, 40_000)
    };
    assert_proved(&certified(0.005));
    assert_refuted_by(PoseScalar::Clearance, &certified(0.0055));
}

/// The stiffness out of the plane is nearly the threshold in a large part of this workspace, and its enclosure on rails that bend was too
/// wide at a point far from where force and moment are decoupled.
#[test]
fn a_large_workspace_on_rails_that_bend_is_proved() {
    let text = "3-PRR R=3.9758809925987957 r=2.1371163761287293 Lb=4 rj=0.035259241235426106 rp=0.07991042300038287 alpha_deg=90";
    let model = model(|settings| settings.rails = round_rails(0.03, RailSupports::Clamped { spans: 4 }));
    assert_proved(&claimed(&model, &parsed(text), 1.9915, 5.0, 60_000));
}

/// The natural frequency is the limit in a large part of this workspace, where the manipulator is far stiffer in one direction than in
/// another: forms in the coordinates of the platform left it open after 200 000 boxes.
#[test]
fn a_natural_frequency_is_proved_where_the_stiffness_is_uneven() {
    let text = "3-PRR R=4 r=1.1303600371987672 Lb=2.5288918081201395 rj=0.05749941235277213 rp=0.05682624636662326";
    let design = parsed(text);
    let certified = |limit: f64| {
        let model = model(|settings| {
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
        });
        claimed(&model, &design, 1.28666015625, 37.5, 20_000)
    };
    assert_proved(&certified(10.0));
    assert_refuted_by(PoseScalar::NaturalFrequency, &certified(10.01));
}
