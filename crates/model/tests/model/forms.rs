//! Compares the closed form of the stiffness with the general 6×6 form.

use kinefront_model::kinematics::Jacobian;
use kinefront_model::mechanism::{AnyLeg, CrossSections, Design, LegPosture, LegSettings, Manipulator};
use kinefront_model::spatial::Pose;
use kinefront_model::stiffness::{
    ActuatorStiffness, Material, PlanarStiffness, RailSettings, StiffnessDefinition, StiffnessModel, joint_model,
};
use nalgebra::{Matrix2, Matrix6};
use proptest::prelude::*;

use super::reference::difference;
use super::strategies::{applicable_cases, design, leg_settings, pose, rails};

const ACTUATORS: ActuatorStiffness = ActuatorStiffness {
    prismatic: 1e7,
    revolute: 1e7,
};

/// Returns the stiffness in both forms at a pose, if the pose is reachable and not at the end of reach.
fn forms(
    design: &Design,
    settings: &LegSettings,
    rails: Option<&RailSettings>,
    pose: &Pose,
) -> Option<(PlanarStiffness, Matrix6<f64>)> {
    let manipulator = Manipulator::<AnyLeg>::new(design, settings);
    let posture = manipulator.posture(pose).ok()?;
    // Where a bar is nearly without length, the general form loses digits.
    let is_short = |leg: &LegPosture| {
        let proximal = leg.chain.proximal.map_or(1.0, |bar| bar.offset.abs());
        leg.chain.beam.min(proximal) < 0.01
    };
    if posture.legs.iter().any(is_short) {
        return None;
    }
    let sections = CrossSections::default();
    let model = StiffnessModel::new(
        design,
        &settings.geometry,
        &Material::STEEL,
        &sections,
        &ACTUATORS,
        rails,
    )?;
    let closed = model.stiffness(&posture, &Jacobian::new(&posture));
    Some((closed, joint_model::stiffness(&model, design.architecture(), &posture)?))
}

proptest! {
    #![proptest_config(applicable_cases(500))]

    #[test]
    fn closed_form_equals_the_general_one(
        design in design(0.005), pose in pose(), settings in leg_settings(), rails in rails(),
    ) {
        let (closed, general) = forms(&design, &settings, rails.as_ref(), &pose).ok_or_else(|| TestCaseError::reject("out of reach"))?;
        let off = difference(&closed.matrix(), &general);
        prop_assert!(off < 1e-10, "{design} at {pose:?}: {off:e}");
    }

    #[test]
    fn rigidities_are_what_their_definition_says(design in design(0.01), pose in pose()) {
        let (closed, general) = forms(&design, &LegSettings::default(), None, &pose)
            .ok_or_else(|| TestCaseError::reject("out of reach"))?;
        let values = closed.stiffness_values(StiffnessDefinition::Stiffness);
        let block = Matrix2::new(general[(0, 0)], general[(0, 1)], general[(1, 0)], general[(1, 1)]);
        let smallest = block.symmetric_eigenvalues().min();
        prop_assert!((values.k_xy - smallest).abs() <= 1e-8 * block.norm());
        prop_assert!((values.k_z / general[(2, 2)] - 1.0).abs() < 1e-8);
        prop_assert!((values.k_phi_z - general[(5, 5)]).abs() <= 1e-8 * general[(5, 5)]);

        // Near a singularity the inverse has no digits left to compare.
        if let Some(inverse) = closed.matrix().try_inverse()
            && closed.matrix().norm() * inverse.norm() < 1e9
        {
            let free = closed.stiffness_values(StiffnessDefinition::Compliance);
            let block = Matrix2::new(inverse[(0, 0)], inverse[(0, 1)], inverse[(1, 0)], inverse[(1, 1)]);
            let softest = 1.0 / block.symmetric_eigenvalues().max();
            prop_assert!((free.k_xy / softest - 1.0).abs() < 1e-5, "{} {softest}", free.k_xy);
            prop_assert!((free.k_z * inverse[(2, 2)] - 1.0).abs() < 1e-5);
            prop_assert!((free.k_phi_z * inverse[(5, 5)] - 1.0).abs() < 1e-5);
            prop_assert!(free.k_xy <= values.k_xy * (1.0 + 1e-9));
            prop_assert!(free.k_z <= values.k_z * (1.0 + 1e-9));
            prop_assert!(free.k_phi_z <= values.k_phi_z * (1.0 + 1e-9));
        }
    }
}
