//! Checks that joints close, that Jacobians are derivatives, and that forward kinematics is the inverse of inverse
//! kinematics.

use kinefront_model::evaluation::{Model, PoseScalar};
use kinefront_model::kinematics::{Jacobian, forward};
use kinefront_model::mechanism::{AnyLeg, Design, JointKind, Leg, LegSettings, Manipulator};
use kinefront_model::spatial::Pose;
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;

use super::strategies::{applicable_cases, design, leg_settings, pose};

type Check = Result<(), TestCaseError>;

fn not_applicable() -> TestCaseError {
    TestCaseError::reject("the property does not apply")
}

/// The values of the actuated joints at a pose.
pub fn actuators(design: &Design, manipulator: &Manipulator<AnyLeg>, pose: &Pose) -> Option<[f64; 3]> {
    let posture = manipulator.posture(pose).ok()?;
    let driven = design.architecture().driven();
    Some([0, 1, 2].map(|i| manipulator.legs[i].joint_values(&posture.legs[i])[driven]))
}

fn joints_close(design: &Design, settings: &LegSettings, pose: &Pose) -> Check {
    let manipulator = Manipulator::<AnyLeg>::new(design, settings);
    let posture = manipulator.posture(pose).map_err(|_| not_applicable())?;
    let tolerance = 1e-12 * (design.base_radius() + design.link_length() + design.platform_radius());
    for (i, leg) in posture.legs.iter().enumerate() {
        let c = pose.position + posture.arms[i];
        let frame = manipulator.legs[i].frame();
        let chain = &leg.chain;
        // Where guides are nearly parallel, B is far away.
        let tolerance = tolerance * (1.0 + chain.b.length() / design.base_radius());
        prop_assert!((chain.c - c).length() < tolerance);
        prop_assert!((chain.b + chain.distal.direction * chain.distal.offset - c).length() < tolerance);
        prop_assert!((chain.distal.direction.length() - 1.0).abs() < 1e-12);
        prop_assert!((leg.u.length() - 1.0).abs() < 1e-12);
        prop_assert!((posture.arms[i].length() - frame.arm_length).abs() < tolerance);
        match chain.proximal {
            Some(bar) => prop_assert!((frame.anchor + bar.direction * bar.offset - chain.b).length() < tolerance),
            None => prop_assert!((chain.b - frame.anchor).perp_dot(frame.rail).abs() < tolerance),
        }
        for (value, limits) in manipulator.legs[i]
            .joint_values(leg)
            .into_iter()
            .zip(manipulator.legs[i].joint_limits())
        {
            let within = limits.is_none_or(|[lower, upper]| (lower - tolerance..=upper + tolerance).contains(&value));
            prop_assert!(within, "{value} in {limits:?}");
        }
        prop_assert!(chain.limit_margin >= 0.0);
    }
    Ok(())
}

/// Compares `A t = B q̇` with central differences of the inverse kinematics.
fn jacobian_is_the_derivative(design: &Design, settings: &LegSettings, pose: &Pose) -> Check {
    let manipulator = Manipulator::<AnyLeg>::new(design, settings);
    let posture = manipulator.posture(pose).map_err(|_| not_applicable())?;
    let jacobian = Jacobian::new(&posture);
    // Finite differences are meaningless where a leg is nearly stretched out.
    let is_stretched = |transmission: &f64| transmission.abs() < 0.05;
    if posture.limit_margin < 0.02 || jacobian.transmission.iter().any(is_stretched) {
        return Err(not_applicable());
    }
    let step = 1e-6;
    for (axis, row) in [(0, jacobian.ux), (1, jacobian.uy), (2, jacobian.moment)] {
        let moved = |sign: f64| {
            let mut moved = *pose;
            match axis {
                0 => moved.position.x += sign * step,
                1 => moved.position.y += sign * step,
                _ => moved.phi += sign * step,
            }
            actuators(design, &manipulator, &moved)
        };
        let (Some(after), Some(before)) = (moved(1.0), moved(-1.0)) else {
            return Err(not_applicable());
        };
        for leg in 0..3 {
            let mut change = after[leg] - before[leg];
            if design.architecture().actuator() == JointKind::Revolute {
                change = libm::remainder(change, 2.0 * std::f64::consts::PI);
            }
            let rate = change / (2.0 * step);
            let wanted = row[leg] / jacobian.transmission[leg];
            prop_assert!(
                (rate - wanted).abs() < 1e-5 * (1.0 + wanted.abs()),
                "{rate} instead of {wanted}"
            );
        }
    }
    Ok(())
}

fn forward_undoes_inverse(design: &Design, settings: &LegSettings, pose: &Pose) -> Check {
    let manipulator = Manipulator::<AnyLeg>::new(design, settings);
    let posture = manipulator.posture(pose).map_err(|_| not_applicable())?;
    if Jacobian::new(&posture).inverse_condition(design.platform_radius()) < 0.1 || posture.limit_margin < 0.05 {
        return Err(not_applicable());
    }
    // Where `C_i` is near `A_i`, a pose on the other side of `A_i` has the same values and is as near to the start.
    if posture
        .legs
        .iter()
        .any(|leg| (leg.chain.c - leg.chain.a).length() < 0.05)
    {
        return Err(not_applicable());
    }
    let target = actuators(design, &manipulator, pose).expect("reachable");
    let start = Pose::new(pose.position.x + 1e-3, pose.position.y - 1e-3, pose.phi + 1e-3);
    let found = forward(design.architecture(), &manipulator, target, start, 1e-12);
    prop_assert!(found.is_ok(), "{found:?}");
    if let Ok(found) = found {
        prop_assert!(
            (found.position - pose.position).length() < 1e-9 && (found.phi - pose.phi).abs() < 1e-9,
            "{found:?}"
        );
    }
    Ok(())
}

/// Compares `κ_F⁻¹` with its definition, computed with matrices and an inverse.
fn condition_is_its_definition(design: &Design, pose: &Pose, length: f64) -> Check {
    let manipulator = Manipulator::<AnyLeg>::new(design, &LegSettings::default());
    let posture = manipulator.posture(pose).map_err(|_| not_applicable())?;
    let jacobian = Jacobian::new(&posture);
    let value = jacobian.inverse_condition(length);
    prop_assert!((0.0..=1.0).contains(&value));
    if value < 1e-6 {
        return Err(not_applicable());
    }
    let scale = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, length));
    let inverse = jacobian.direct().try_inverse();
    prop_assert!(inverse.is_some());
    if let Some(inverse) = inverse {
        let normal = scale * inverse * Matrix3::from_diagonal(&Vector3::from(jacobian.transmission));
        // tr(JᵀJ)·tr((JᵀJ)⁻¹) = ‖J‖²·‖J⁻¹‖²; squaring the matrix first would cost half the digits.
        let condition = normal.norm() * normal.try_inverse().expect("not singular").norm() / 3.0;
        prop_assert!((value * condition - 1.0).abs() < 1e-6, "{value} {condition}");
    }
    Ok(())
}

proptest! {
    #![proptest_config(applicable_cases(500))]

    #[test]
    fn every_bar_has_its_length(design in design(0.0), settings in leg_settings(), pose in pose()) {
        joints_close(&design, &settings, &pose)?;
    }

    #[test]
    fn jacobian_against_finite_differences(design in design(0.0), settings in leg_settings(), pose in pose()) {
        jacobian_is_the_derivative(&design, &settings, &pose)?;
    }

    #[test]
    fn forward_against_inverse(design in design(0.0), settings in leg_settings(), pose in pose()) {
        forward_undoes_inverse(&design, &settings, &pose)?;
    }

    #[test]
    fn condition_number_against_its_definition(design in design(0.0), pose in pose(), length in 0.1..3.0) {
        condition_is_its_definition(&design, &pose, length)?;
    }

    /// The model never returns a non-finite number, even for bars of radius zero.
    #[test]
    fn everything_reported_is_finite(design in design(0.0), pose in pose(), zero in any::<[bool; 2]>()) {
        let mut values = design.values();
        for (value, zero) in values[3..].iter_mut().zip(zero) {
            if zero {
                *value = 0.0;
            }
        }
        let design = Design::new(design.architecture(), design.working_mode(), values).expect("a valid design");
        let report = Model::default()
            .pose(&design, &pose)
            .map_err(|unreachable| TestCaseError::reject(unreachable.to_string()))?;
        prop_assert!(report.stiffness.iter().all(|entry| entry.is_finite()));
        // Without bars, at a singularity and for some designs, loads have no value.
        for &scalar in PoseScalar::ALL {
            let value = report.values.get(scalar);
            let may_be_missing = scalar.is_of_loads() || PoseScalar::OF_MOTION.contains(&scalar);
            prop_assert!(value.is_some_and(f64::is_finite) || value.is_none() && may_be_missing);
        }
        if zero[0] || zero[1] {
            for scalar in [PoseScalar::StiffnessXy, PoseScalar::StiffnessZ, PoseScalar::StiffnessPhiZ] {
                prop_assert_eq!(report.values[scalar], 0.0);
            }
        }
    }
}
