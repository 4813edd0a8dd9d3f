//! All assembly modes, compared with published ones and with an independent search (tests/fixtures/README.md).

use glam::DVec2;
use kinefront_model::kinematics::{AssemblyMode, assembly_modes, poses_of};
use kinefront_model::mechanism::{AnyLeg, Design, Leg, LegSettings, LockedKind, LockedLeg, Manipulator};
use kinefront_model::spatial::Pose;
use proptest::prelude::*;

use super::joints::actuators;
use super::legs::{cases, settings};
use super::reference::{design as case_design, numbers, pose as case_pose, pose_at};
use super::strategies::{applicable_cases, design, leg_settings, pose};

fn is_same(a: &Pose, b: &Pose, tolerance: f64) -> bool {
    let turn = libm::remainder(a.phi - b.phi, std::f64::consts::TAU);
    a.position.distance(b.position) < tolerance && turn.abs() < tolerance
}

#[test]
fn modes_agree_with_an_independent_search() {
    for case in cases("poses") {
        let design = case_design(&case);
        let found = assembly_modes(&design, &settings(&case), numbers(&case["actuators"]));
        let wanted = case["assembly_modes"].as_array().expect("modes").iter();
        let wanted: Vec<Pose> = wanted.map(pose_at).collect();
        assert_eq!(found.len(), wanted.len(), "{design}: {found:?}");
        for pose in &wanted {
            let is_found = found.iter().any(|mode| is_same(&mode.pose, pose, 1e-8));
            assert!(is_found, "{design}: {pose:?} is not among {found:?}");
        }
        let own = |mode: &&AssemblyMode| is_same(&mode.pose, &case_pose(&case), 1e-8);
        let own = found.iter().find(own).expect("the pose of the case");
        assert!(
            own.is_of_design && own.working_mode == Some(design.working_mode()),
            "{design}: {own:?}"
        );
    }
}

/// Three telescopic legs between points of a base and of a platform whose first point is the reference point.
fn telescopes(base: [[f64; 2]; 3], platform: [[f64; 2]; 3], lengths: [f64; 3]) -> Vec<Pose> {
    let legs = [0, 1, 2].map(|i| LockedLeg {
        platform: DVec2::from_array(platform[i]),
        base: DVec2::from_array(base[i]),
        kind: LockedKind::Circle(lengths[i]),
    });
    poses_of(&legs, 20.0)
}

fn agree(found: &[Pose], wanted: &[[f64; 3]]) {
    assert_eq!(found.len(), wanted.len(), "{found:?}");
    for &[x, y, phi] in wanted {
        let wanted = Pose::new(x, y, phi);
        assert!(
            found.iter().any(|pose| is_same(pose, &wanted, 1e-8)),
            "{wanted:?} is not among {found:?}"
        );
    }
}

/// Example of the manual of the library ALIAS; the last digits that it prints are off by up to 4e-9.
#[test]
fn a_manipulator_with_two_modes() {
    let lengths = [50.0, 26.0, 25.0].map(f64::sqrt);
    let found = telescopes(
        [[0.0, 0.0], [10.0, 0.0], [3.0, 10.0]],
        [[0.0, 0.0], [4.0, 0.0], [2.0, 2.0]],
        lengths,
    );
    agree(&found, &[[5.0, 5.0, 0.0], [3.369707131, 6.216516215, -0.806783438]]);
}

/// The published example with six real modes.
#[test]
fn a_manipulator_with_six_modes() {
    let (c12, c23, c31) = (17.04f64, 16.54f64, 20.84f64);
    let x = (c12 * c12 + c31 * c31 - c23 * c23) / (2.0 * c12);
    let found = telescopes(
        [[0.0, 0.0], [15.91, 0.0], [0.0, 10.0]],
        [[0.0, 0.0], [c12, 0.0], [x, (c31 * c31 - x * x).sqrt()]],
        [14.98, 15.38, 12.0],
    );
    agree(
        &found,
        &[
            [-8.726595332, 12.175669752, -0.986974238],
            [-5.495660815, -13.935498276, -0.047331369],
            [-14.896128100, 1.582961662, 0.245309531],
            [-13.419939014, -6.656247957, 0.585672783],
            [14.920133247, -1.337917743, 1.002038540],
            [14.673943656, -3.012603125, 2.132904365],
        ],
    );
}

fn values(design: &Design, settings: &LegSettings, pose: &Pose) -> Option<[f64; 3]> {
    actuators(design, &Manipulator::<AnyLeg>::new(design, settings), pose)
}

proptest! {
    #![proptest_config(applicable_cases(3000))]

    /// The pose whose joint values are given is among the modes, of this design, and every mode has these joint values.
    #[test]
    fn the_pose_of_the_values_is_a_mode(design in design(0.0), settings in leg_settings(), pose in pose()) {
        let wanted = values(&design, &settings, &pose).ok_or_else(|| TestCaseError::reject("out of reach"))?;
        let manipulator = Manipulator::<AnyLeg>::new(&design, &settings);
        let posture = manipulator.posture(&pose).expect("reachable");
        let jacobian = kinefront_model::kinematics::Jacobian::new(&posture);
        if jacobian.inverse_condition(design.platform_radius()) < 1e-3 || posture.limit_margin < 1e-6 {
            return Err(TestCaseError::reject("near a singularity"));
        }
        let modes = assembly_modes(&design, &settings, wanted);
        let own = modes.iter().find(|mode| is_same(&mode.pose, &pose, 1e-7));
        prop_assert!(own.is_some_and(|mode| mode.is_of_design), "{design} at {pose:?}: {modes:?}");
        for mode in modes.iter().filter(|mode| mode.is_within_limits) {
            let of_mode = design.with_working_mode(mode.working_mode.expect("a mode"));
            // Rounding may tell at a limit.
            if let Some(found) = values(&of_mode, &settings, &mode.pose) {
                for (found, wanted) in found.into_iter().zip(wanted) {
                    let off = libm::remainder(found - wanted, std::f64::consts::TAU);
                    prop_assert!(off.abs() < 1e-6 || (found - wanted).abs() < 1e-6, "{design}: {found} {wanted}");
                }
            }
        }
        let most = match manipulator.legs[0].locked(wanted[0]).kind {
            LockedKind::Circle(_) => 6,
            _ => 2,
        };
        prop_assert!(modes.len() <= most, "{design}: {modes:?}");
    }
}

proptest! {
    #![proptest_config(applicable_cases(60))]

    /// No further mode is found by Newton's method from many starts.
    #[test]
    fn no_mode_is_missed(design in design(0.0), settings in leg_settings(), pose in pose(), seed in any::<u64>()) {
        let wanted = values(&design, &settings, &pose).ok_or_else(|| TestCaseError::reject("out of reach"))?;
        let legs = [0, 1, 2].map(|i| AnyLeg::new(&design, &settings, i).locked(wanted[i]));
        let scale = design.base_radius() + design.platform_radius() + design.link_length();
        let modes = assembly_modes(&design, &settings, wanted);
        let mut state = seed | 1;
        let mut random = || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        for _ in 0..300 {
            let start = Pose::new(4.0 * scale * random(), 4.0 * scale * random(), 6.3 * random());
            let Some(found) = newton(&legs, start, scale) else { continue };
            // Far away, the equations of nearly parallel lines have no digits left.
            if found.position.length() > 20.0 * scale {
                continue;
            }
            let is_known = modes.iter().any(|mode| is_same(&mode.pose, &found, 1e-5 * (1.0 + scale)));
            prop_assert!(is_known, "{design}: {found:?} is not among {modes:?}");
        }
    }
}

/// Newton's method on the constraints; only regular solutions count.
fn newton(legs: &[LockedLeg; 3], mut pose: Pose, scale: f64) -> Option<Pose> {
    for _ in 0..60 {
        let turn = kinefront_model::spatial::Rotation::new(pose.phi);
        let found = legs.each_ref().map(|leg| leg.constraint(&pose, &turn, scale));
        let error = nalgebra::Vector3::from_fn(|i, _| found[i].0);
        let matrix = nalgebra::Matrix3::from_fn(|i, k| found[i].1[k]);
        if error.amax() < 1e-13 {
            return (matrix.determinant().abs() > 1e-4).then_some(pose);
        }
        let step = matrix.try_inverse()? * error;
        pose.position -= DVec2::new(step[0], step[1]) * scale;
        pose.phi -= step[2];
    }
    None
}
