//! Every chain and actuated joint, compared with values from an independent program (tests/fixtures/README.md).

use kinefront_model::evaluation::{GridChoice, Model, ModelSettings, PoseScalar};
use kinefront_model::kinematics::Jacobian;
use kinefront_model::mechanism::{
    AnyLeg, Architecture, Arrangement, Design, FURTHER_VARIABLES, LegSettings, Manipulator, WorkingMode,
};
use kinefront_model::stiffness::StiffnessDefinition;
use serde_json::Value;

use super::reference::{close, difference, fixture, matrix, number, pose};
use super::strategies;

fn three(value: &Value) -> [f64; 3] {
    [0, 1, 2].map(|k| number(&value[k]))
}

pub fn design(case: &Value) -> Design {
    let values = ["R", "r", "Lb", "rj", "rp"].map(|key| number(&case["design"][key]));
    let architecture: Architecture = case["architecture"]
        .as_str()
        .expect("a name")
        .parse()
        .expect("an architecture");
    let mode = WorkingMode::new(three(&case["working_mode"]).map(|sign| sign > 0.0));
    let design = Design::new(architecture, mode, values).expect("a valid design");
    FURTHER_VARIABLES.into_iter().fold(design, |design, variable| {
        match case["design"][variable.key()].as_f64() {
            Some(value) if architecture.has(variable) => design.with(variable, value).expect("a valid value"),
            _ => design,
        }
    })
}

pub fn settings(case: &Value) -> LegSettings {
    let geometry = &case["geometry"];
    let pair = |value: &Value| [number(&value[0]), number(&value[1])];
    LegSettings {
        geometry: Arrangement {
            base_angles_deg: three(&geometry["base_angles_deg"]),
            base_radii: three(&geometry["base_radii"]),
            platform_angles_deg: three(&geometry["platform_angles_deg"]),
            platform_radii: three(&geometry["platform_radii"]),
            rail_turn_deg: three(&geometry["rail_turn_deg"]),
            rail: pair(&geometry["rail"]),
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
    let cases = fixture("legs_cases.json");
    let cases = cases[kind].as_array().expect("cases").clone();
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
        let what = |text: &str| format!("{design}: {text}");
        for (index, leg) in posture.legs.iter().enumerate() {
            let values = manipulator.legs[index].joint_values(leg);
            for (joint, value) in values.into_iter().enumerate() {
                close(value, number(&case["joints"][index][joint]), 1e-9, &what("joint"));
            }
            let driven = values[design.architecture().driven()];
            close(driven, number(&case["actuators"][index]), 1e-9, &what("actuator"));
            for (point, key) in [(leg.chain.b, "B"), (leg.chain.c, "C")] {
                close(point.x, number(&case[key][index][0]), 1e-9, &what(key));
                close(point.y, number(&case[key][index][1]), 1e-9, &what(key));
            }
            let row = [leg.u.x, leg.u.y, leg.moment];
            for (column, value) in row.into_iter().enumerate() {
                close(value, number(&case["A_rows"][index][column]), 1e-9, &what("row of A"));
            }
            close(leg.transmission, number(&case["B_ii"][index]), 1e-9, &what("B"));
        }
        close(
            posture.limit_margin,
            number(&case["slack"]),
            1e-9,
            &what("limit margin"),
        );
        let condition = Jacobian::new(&posture).inverse_condition(design.platform_radius());
        close(
            condition,
            number(&case["inverse_condition"]),
            1e-9,
            &what("inverse condition"),
        );
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
        for (value, key) in [
            (report.values[PoseScalar::StiffnessXy], "k_xy"),
            (report.values[PoseScalar::StiffnessZ], "k_z"),
            (report.values[PoseScalar::StiffnessPhiZ], "k_phi_z"),
            (free[PoseScalar::StiffnessXy], "k_xy_compliance"),
            (free[PoseScalar::StiffnessZ], "k_z_compliance"),
            (free[PoseScalar::StiffnessPhiZ], "k_phi_z_compliance"),
        ] {
            let wanted = number(&case[key]);
            assert!(
                (value / wanted - 1.0).abs() < 1e-8,
                "{design}: {key} {value} instead of {wanted}"
            );
        }
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
