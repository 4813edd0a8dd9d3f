//! Every chain and actuated joint, compared with values from an independent program (tests/fixtures/README.md).

use kinefront_model::evaluation::{GridChoice, Model, ModelSettings};
use kinefront_model::kinematics::Jacobian;
use kinefront_model::mechanism::{AnyLeg, Architecture, Arrangement, LegSettings, Manipulator};
use kinefront_model::stiffness::StiffnessDefinition;
use serde_json::Value;

use super::reference::{cases_of, close, design, difference, matrix, number, numbers, pose, stiffness_values_agree};
use super::strategies;

pub fn settings(case: &Value) -> LegSettings {
    let geometry = &case["geometry"];
    LegSettings {
        geometry: Arrangement {
            base_angles_deg: numbers(&geometry["base_angles_deg"]),
            base_radii: numbers(&geometry["base_radii"]),
            platform_angles_deg: numbers(&geometry["platform_angles_deg"]),
            platform_radii: numbers(&geometry["platform_radii"]),
            rail_turn_deg: numbers(&geometry["rail_turn_deg"]),
            rail: numbers(&geometry["rail"]),
            ..Arrangement::PAPER
        }
        .into(),
        ..LegSettings::default()
    }
}

pub fn model(case: &Value, change: impl FnOnce(&mut ModelSettings)) -> Model {
    strategies::model(|model| {
        model.legs = settings(case);
        change(model);
    })
}

pub fn cases(kind: &str) -> Vec<Value> {
    let cases = cases_of("legs_cases.json", kind);
    assert_eq!(cases.len(), 36);
    for &architecture in Architecture::ALL {
        let of_one = cases.iter().filter(|case| case["architecture"] == architecture.name());
        assert_eq!(of_one.count(), 2, "{architecture}");
    }
    cases
}

#[test]
fn kinematics_agree() {
    for case in cases("poses") {
        let (design, pose) = (design(&case), pose(&case));
        let manipulator = Manipulator::<AnyLeg>::new(&design, &settings(&case));
        let posture = manipulator.posture(&pose).expect("reachable");
        let agree = |value: f64, wanted: &Value, text: &str| {
            close(value, number(wanted), 1e-9, &format!("{design}: {text}"));
        };
        for (index, leg) in posture.legs.iter().enumerate() {
            let values = manipulator.legs[index].joint_values(leg);
            for (joint, value) in values.into_iter().enumerate() {
                agree(value, &case["joints"][index][joint], "joint");
            }
            let driven = values[design.architecture().driven()];
            agree(driven, &case["actuators"][index], "actuator");
            for (point, key) in [(leg.chain.b, "B"), (leg.chain.c, "C")] {
                agree(point.x, &case[key][index][0], key);
                agree(point.y, &case[key][index][1], key);
            }
            let row = [leg.u.x, leg.u.y, leg.moment];
            for (column, value) in row.into_iter().enumerate() {
                agree(value, &case["A_rows"][index][column], "row of A");
            }
            agree(leg.transmission, &case["B_ii"][index], "B");
        }
        agree(posture.limit_margin, &case["slack"], "limit margin");
        let condition = Jacobian::new(&posture).inverse_condition(design.platform_radius());
        agree(condition, &case["inverse_condition"], "inverse condition");
    }
}

#[test]
fn stiffness_agrees() {
    for case in cases("poses") {
        let (design, pose) = (design(&case), pose(&case));
        let report = model(&case, |_| {}).pose(&design, &pose).expect("reachable");
        let off = difference(&report.stiffness, &matrix(&case["stiffness_matrix"]));
        assert!(off < 1e-9, "{design} at {pose:?}: stiffness off by {off:e}");
        let compliant = model(&case, |model| {
            model.stiffness_definition = StiffnessDefinition::Compliance
        });
        let free = compliant.pose(&design, &pose).expect("reachable").values;
        stiffness_values_agree(&report.values, &free, &case, 1e-8, &design);
    }
}

#[test]
fn masses_and_workspaces_agree() {
    for case in cases("designs") {
        let design = design(&case);
        let model = model(&case, |_| {});
        let tolerance = 1e-5 * design.base_radius();
        for (grid, key) in [
            (GridChoice::Reference, "workspace_radius_reference_grid"),
            (GridChoice::Fine, "workspace_radius_fine_grid"),
        ] {
            let found = model.evaluate(&design, grid);
            close(found.mass(), number(&case["mass"]), 1e-12, "mass");
            // The second design of an architecture is known on the reference grid alone.
            let Some(wanted) = case[key].as_f64() else {
                assert_eq!(grid, GridChoice::Fine);
                continue;
            };
            assert!(
                (found.workspace_radius() - wanted).abs() <= tolerance,
                "{design}: {key} {} instead of {wanted}",
                found.workspace_radius()
            );
        }
    }
}
