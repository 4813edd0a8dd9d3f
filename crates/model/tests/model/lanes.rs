//! Compares the evaluation of several poses at once with that of one pose at a time.

use glam::DVec2;
use kinefront_model::evaluation::{GridChoice, Model, PoseScalar};
use kinefront_model::kinematics::{CharacteristicLength, Jacobian};
use kinefront_model::lanes::InstructionSet;
use kinefront_model::mechanism::{AnyLeg, BarLength, Design, Manipulator};
use kinefront_model::spatial::{Pose, Rotation};
use kinefront_model::stiffness::StiffnessDefinition;
use proptest::prelude::*;

use super::strategies::{design, model, pose, rails};

fn compare(model: &Model, design: &Design, pose: &Pose) -> Result<(), TestCaseError> {
    let evaluator = model.pose_evaluator(design);
    let arms = evaluator.arms(&Rotation::new(pose.phi));
    let found = evaluator.evaluate_position(&arms, pose.position);
    let (found, values) = match (found, evaluator.evaluate_plainly(&arms, pose.position)) {
        (Err(found), Err(margin)) => {
            // Where a guide is nearly parallel to its rail, their intersection is far away, and digits of its place are lost.
            let scale = 1.0 + margin * margin;
            prop_assert!((found - margin).abs() < 1e-13 * scale);
            return Ok(());
        }
        (Ok(found), Ok(values)) => (found, values),
        (found, values) => return Err(TestCaseError::fail(format!("{found:?} instead of {values:?}"))),
    };
    prop_assert!((found[PoseScalar::Reach] - values[PoseScalar::Reach]).abs() < 1e-13);
    // Digits are lost where a leg is nearly stretched out or the lines of the legs nearly meet, and in the
    // stiffness that remains when other motions are free.
    let distance = values[PoseScalar::Reach].min(1.0) * values[PoseScalar::Determinant].abs().min(1.0);
    let tolerance = 1e-12 / (distance * distance);
    if tolerance < 1e-6 {
        let posture = Manipulator::<AnyLeg>::new(design, &model.settings().legs).posture_at(pose.position, &arms);
        let posture = posture.expect("reachable");
        let stiffness = model
            .stiffness(design)
            .expect("stiff")
            .stiffness(&posture, &Jacobian::new(&posture));
        let held = stiffness.stiffness_values(StiffnessDefinition::Stiffness);
        let in_plane = stiffness.in_plane[0] + stiffness.in_plane[3];
        // If motion in the plane is free, its block is inverted, which loses digits in proportion to the
        // condition number of the block.
        let free = match model.settings().stiffness_definition {
            StiffnessDefinition::Stiffness => 1.0,
            StiffnessDefinition::Compliance => in_plane / held.k_xy,
        };
        for (scalar, scale) in [
            (PoseScalar::Determinant, values[PoseScalar::Determinant]),
            (PoseScalar::Dexterity, values[PoseScalar::Dexterity]),
            (PoseScalar::StiffnessXy, in_plane),
            (PoseScalar::StiffnessZ, held.k_z),
            (PoseScalar::StiffnessPhiZ, free * held.k_phi_z),
        ] {
            let (found, wanted) = (found[scalar], values[scalar]);
            prop_assert!(
                (found - wanted).abs() <= tolerance * scale.abs(),
                "{scalar:?}: {found:e} instead of {wanted:e}"
            );
        }
    }
    Ok(())
}

/// Returns all values of an evaluation as a text that differs if any bit differs.
fn bits(model: &Model, design: &Design, instructions: InstructionSet) -> String {
    // The shortest decimal that reads back as a number distinguishes it from every other.
    format!("{:?}", model.evaluate_with(design, GridChoice::Reference, instructions))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn every_instruction_set_gives_the_same_bits(
        design in design(0.0), compliance: bool, x in -0.1..0.1, isotropic: bool, rails in rails(),
    ) {
        let model = model(|settings| {
            settings.rails = rails;
            if compliance {
                settings.stiffness_definition = StiffnessDefinition::Compliance;
            }
            if isotropic {
                settings.characteristic_length = CharacteristicLength::Isotropic;
            } else {
                settings.workspace.centre = DVec2::new(x, 0.5 * x);
            }
        });
        let best = bits(&model, &design, InstructionSet::best());
        for instructions in InstructionSet::available() {
            prop_assert_eq!(&bits(&model, &design, instructions), &best, "{}", instructions.name());
        }
    }
}

/// A random seed gives the same run on every processor: the baseline, which every machine has, is among the sets
/// compared.
#[test]
fn the_sets_compared_are_those_of_the_machine() {
    let sets: Vec<&str> = InstructionSet::available().iter().map(|set| set.name()).collect();
    println!("compared: {sets:?}");
    assert!(sets.contains(&"baseline") && sets.contains(&InstructionSet::best().name()));
    #[cfg(target_arch = "x86_64")]
    {
        assert_eq!(
            sets.contains(&"AVX2"),
            is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")
        );
        let wide = is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512dq");
        assert_eq!(sets.contains(&"AVX-512"), wide && is_x86_feature_detected!("avx512vl"));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn the_reduced_form_gives_the_values_of_the_plain_one(
        design in design(1e-3), pose in pose(), compliance: bool, longest: bool, shortest in 0.0..0.6,
        rails in rails(),
    ) {
        let model = model(|settings| {
            settings.rails = rails;
            settings.legs.telescopic_shortest = if shortest < 0.1 { 0.0 } else { shortest };
            if longest {
                settings.legs.telescopic_bar = BarLength::Longest;
            }
            if compliance {
                settings.stiffness_definition = StiffnessDefinition::Compliance;
            }
        });
        compare(&model, &design, &pose)?;
    }
}
