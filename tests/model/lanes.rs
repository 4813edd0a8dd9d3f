//! Several poses at once against one at a time.

use glam::DVec2;
use kinefront::evaluation::Model;
use kinefront::lanes::Planar;
use kinefront::mechanism::{Architecture, Design, Leg, PrrLeg, RprLeg, RrrLeg};
use kinefront::spatial::{Pose, Rotation};
use kinefront::stiffness::StiffnessDefinition;
use kinefront::workspace::PoseChecker;
use proptest::prelude::*;

use super::strategies::{design, pose};

fn close(what: &str, found: f64, wanted: f64, tolerance: f64) -> Result<(), TestCaseError> {
    prop_assert!(
        (found - wanted).abs() <= tolerance * wanted.abs(),
        "{what}: {found:e} instead of {wanted:e}"
    );
    Ok(())
}

fn compare<L: Leg>(model: &Model, design: &Design, pose: &Pose) -> Result<(), TestCaseError> {
    let checker: PoseChecker<L> = model.checker(design).expect("a whole grid");
    let arms = checker.manipulator.arms(&Rotation::new(pose.phi));
    let found = checker.lanes::<f64>(pose.position.into(), &arms.map(|arm: DVec2| Planar::from(arm)));
    match checker.values(pose.position, &arms) {
        Err((_, shortfall)) => {
            prop_assert!(!found.reachable);
            prop_assert!((found.slack - shortfall.slack).abs() < 1e-13);
        }
        Ok(values) => {
            prop_assert!(found.reachable);
            prop_assert!((found.slack - values.slack).abs() < 1e-13);
            // Digits go where a leg is nearly stretched or the legs' lines nearly meet.
            let distance = values.slack.min(1.0) * values.determinant.abs().min(1.0);
            let tolerance = 1e-12 / (distance * distance);
            if tolerance < 1e-6 {
                close("det", found.determinant, values.determinant, tolerance)?;
                close(
                    "condition",
                    found.inverse_condition,
                    values.inverse_condition,
                    tolerance,
                )?;
                close("k_xy", found.k_xy, values.rigidity.k_xy, tolerance)?;
                close("k_z", found.k_z, values.rigidity.k_z, tolerance)?;
                close("k_phi_z", found.k_phi_z, values.rigidity.k_phi_z, tolerance)?;
            }
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn the_reduced_form_gives_the_values_of_the_plain_one(design in design(1e-3), pose in pose(), compliance: bool) {
        let mut model = Model::default();
        if compliance {
            model.stiffness_definition = StiffnessDefinition::Compliance;
        }
        match design.architecture {
            Architecture::Prr => compare::<PrrLeg>(&model, &design, &pose)?,
            Architecture::Rpr => compare::<RprLeg>(&model, &design, &pose)?,
            Architecture::Rrr => compare::<RrrLeg>(&model, &design, &pose)?,
        }
    }
}
