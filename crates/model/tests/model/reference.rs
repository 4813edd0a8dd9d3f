//! Compares results with values from independent programs (tests/fixtures/README.md) and with the designs of the paper.

use kinefront_model::evaluation::{GridChoice, Model, PoseScalar, PoseValues};
use kinefront_model::mechanism::{Architecture, Design, FURTHER_VARIABLES, WorkingMode};
use kinefront_model::spatial::Pose;
use kinefront_model::stiffness::StiffnessDefinition;
use nalgebra::Matrix6;
use serde_json::Value;

use super::search::plain_search;
use super::strategies::{self, parsed};

/// The cases of a kind in a fixture.
pub fn cases_of(name: &str, kind: &str) -> Vec<Value> {
    let path = format!("{}/tests/fixtures/{name}", env!("CARGO_MANIFEST_DIR"));
    let fixture: Value = serde_json::from_str(&std::fs::read_to_string(path).expect("the fixture")).expect("JSON");
    fixture[kind].as_array().expect("cases").clone()
}

pub fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

pub fn numbers<const N: usize>(value: &Value) -> [f64; N] {
    std::array::from_fn(|k| number(&value[k]))
}

/// The design of a case, which states one sign for its working mode, one for each leg, or none.
pub fn design(case: &Value) -> Design {
    let plus = match &case["working_mode"] {
        signs @ Value::Array(_) => numbers(signs).map(|sign: f64| sign > 0.0),
        mode => [mode.as_i64().unwrap_or(1) > 0; 3],
    };
    let values = ["R", "r", "Lb", "rj", "rp"].map(|key| number(&case["design"][key]));
    let name = case["architecture"].as_str().expect("a name");
    let architecture: Architecture = name.parse().expect("an architecture");
    let design = Design::new(architecture, WorkingMode::new(plus), values).expect("a valid design");
    FURTHER_VARIABLES.into_iter().fold(design, |design, variable| {
        match case["design"][variable.key()].as_f64() {
            Some(value) if architecture.has(variable) => design.with(variable, value).expect("a valid value"),
            _ => design,
        }
    })
}

pub fn pose(case: &Value) -> Pose {
    pose_at(&case["pose"])
}

pub fn pose_at(value: &Value) -> Pose {
    let [x, y, phi_deg] = ["x", "y", "phi_deg"].map(|key| number(&value[key]));
    Pose::new(x, y, phi_deg.to_radians())
}

pub fn matrix(value: &Value) -> Matrix6<f64> {
    Matrix6::from_fn(|i, j| number(&value[i][j]))
}

/// Returns `max |ΔK_ij| / √(K_ii K_jj)`, the difference of two stiffness matrices (docs/model.md, section 4.2).
pub fn difference(a: &Matrix6<f64>, b: &Matrix6<f64>) -> f64 {
    let mut largest = 0.0f64;
    for i in 0..6 {
        for j in 0..6 {
            let scale = (b[(i, i)] * b[(j, j)]).sqrt();
            largest = largest.max((a[(i, j)] - b[(i, j)]).abs() / scale);
        }
    }
    largest
}

pub fn close(value: f64, wanted: f64, tolerance: f64, what: &str) {
    let scale = wanted.abs().max(1.0);
    assert!(
        (value - wanted).abs() <= tolerance * scale,
        "{what}: {value} instead of {wanted}"
    );
}

/// Asserts that the values of the stiffness agree with those of a case, in both definitions.
pub fn stiffness_values_agree(held: &PoseValues, free: &PoseValues, case: &Value, tolerance: f64, design: &Design) {
    for (value, key) in [
        (held[PoseScalar::StiffnessXy], "k_xy"),
        (held[PoseScalar::StiffnessZ], "k_z"),
        (held[PoseScalar::StiffnessPhiZ], "k_phi_z"),
        (free[PoseScalar::StiffnessXy], "k_xy_compliance"),
        (free[PoseScalar::StiffnessZ], "k_z_compliance"),
        (free[PoseScalar::StiffnessPhiZ], "k_phi_z_compliance"),
    ] {
        let wanted = number(&case[key]);
        assert!(
            (value / wanted - 1.0).abs() < tolerance,
            "{design}: {key} {value} instead of {wanted}"
        );
    }
}

#[test]
fn poses_agree_with_the_finite_element_solver() {
    let cases = cases_of("cases.json", "poses");
    assert_eq!(cases.len(), 12);
    let compliance = strategies::model(|settings| settings.stiffness_definition = StiffnessDefinition::Compliance);
    for case in &cases {
        let (design, pose) = (design(case), pose(case));
        let report = Model::default().pose(&design, &pose).expect("reachable");
        for leg in 0..3 {
            close(report.actuators[leg], number(&case["actuators"][leg]), 1e-9, "actuator");
            for axis in 0..2 {
                close(report.b[leg][axis], number(&case["B"][leg][axis]), 1e-9, "B");
                close(report.c[leg][axis], number(&case["C"][leg][axis]), 1e-9, "C");
            }
        }
        let condition = report.values[PoseScalar::Dexterity];
        close(condition, number(&case["inverse_condition"]), 1e-9, "inverse condition");
        let off = difference(&report.stiffness, &matrix(&case["stiffness_matrix"]));
        assert!(off < 1e-7, "{design} at {pose:?}: stiffness off by {off:e}");
        let soft = compliance.pose(&design, &pose).expect("reachable").values;
        stiffness_values_agree(&report.values, &soft, case, 1e-6, &design);
    }
}

#[test]
fn designs_agree_on_both_grids_and_both_definitions() {
    let cases = cases_of("cases.json", "designs");
    assert_eq!(cases.len(), 13);
    let model = Model::default();
    let compliance = strategies::model(|settings| {
        settings.stiffness_definition = StiffnessDefinition::Compliance;
    });
    for case in &cases {
        let design = design(case);
        let tolerance = 1e-5 * design.base_radius();
        let evaluate = |model: &Model, grid| model.evaluate(&design, grid);
        let reference = evaluate(&model, GridChoice::Reference);
        let plain = |model: &Model| plain_search(model, &design).radius;
        close(reference.mass(), number(&case["mass"]), 1e-12, "mass");
        for (radius, key) in [
            (reference.workspace_radius(), "workspace_radius_reference_grid"),
            (
                evaluate(&model, GridChoice::Fine).workspace_radius(),
                "workspace_radius_fine_grid",
            ),
            (
                evaluate(&compliance, GridChoice::Reference).workspace_radius(),
                "workspace_radius_compliance_definition",
            ),
            // The plain search must agree with the same values.
            (plain(&model), "workspace_radius_reference_grid"),
            (plain(&compliance), "workspace_radius_compliance_definition"),
        ] {
            let wanted = number(&case[key]);
            assert!(
                (radius - wanted).abs() <= tolerance,
                "{design}: {key} {radius} instead of {wanted}"
            );
        }
        if reference.is_feasible() {
            let home = reference.home_phi_deg.expect("a home");
            // By mirror symmetry, a 3-RPR has the same radius at two home orientations; either is correct.
            let wanted = number(&case["home_orientation_deg"]);
            let mirrored = (360.0 - wanted) % 360.0;
            assert!(
                home == wanted || home == mirrored,
                "{design}: home {home} instead of {wanted}"
            );
        } else {
            assert_eq!(number(&case["workspace_radius_reference_grid"]), 0.0);
        }
    }
}

/// A certificate encloses the radius of the reference up to the error of its grid, unless it finds a pose that the grid missed.
#[test]
fn certificates_agree_with_the_fine_grid_of_the_reference() {
    let model = Model::default();
    let mut agreeing = 0;
    for case in &cases_of("cases.json", "designs") {
        let (design, wanted) = (design(case), number(&case["workspace_radius_fine_grid"]));
        let Some(claim) = model.claim(&model.evaluate(&design, GridChoice::Fine)) else {
            assert_eq!(wanted, 0.0, "{design}");
            continue;
        };
        let found = model.certify(&design, &claim).expect("a certificate");
        let upper = found.upper.expect("an infeasible pose");
        println!("{design}: {wanted} in [{}, {upper}]", found.lower);
        assert!(found.is_closed(claim.tolerance) && upper < 1.001 * wanted, "{design}");
        if upper > 0.999 * wanted {
            agreeing += 1;
        } else {
            let violation = found.violation.expect("an infeasible pose");
            let margin = model.margin_at(&design, &violation.pose, violation.scalar);
            assert!(margin < 0.0, "{design}: {margin}");
        }
    }
    assert_eq!(agreeing, 12);
}

#[test]
fn thin_bars_agree_with_sixty_digits() {
    let cases = cases_of("thin_bars.json", "poses");
    assert_eq!(cases.len(), 36);
    for case in &cases {
        let (design, pose) = (design(case), pose(case));
        let report = Model::default().pose(&design, &pose).expect("reachable");
        let off = difference(&report.stiffness, &matrix(&case["stiffness_matrix"]));
        assert!(off < 1e-10, "{design} at {pose:?}: stiffness off by {off:e}");
    }
}

/// Compares the paper's three designs as printed with their values under this model (docs/model.md, section 12).
#[test]
fn the_table_of_the_paper() {
    struct Row {
        name: &'static str,
        design: &'static str,
        paper: (f64, f64),
        model: (f64, f64, f64),
    }
    let rows = [
        Row {
            name: "ID-I",
            design: "3-PRR R=1.412 r=0.319 Lb=0.620 rj=0.026 rp=0.023",
            paper: (44.5, 0.110),
            model: (43.49, 0.2267, 0.2268),
        },
        Row {
            name: "ID-II",
            design: "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056",
            paper: (484.8, 1.207),
            model: (479.47, 1.2201, 1.2211),
        },
        Row {
            name: "ID-III",
            design: "3-PRR R=3.872 r=1.947 Lb=1.977 rj=0.039 rp=0.096",
            paper: (1545.6, 1.609),
            model: (1550.02, 1.5956, 1.5954),
        },
    ];
    println!("design  mass paper/model [kg]   R_w paper / reference / fine grid [m]");
    for row in rows {
        let design = parsed(row.design);
        let model = Model::default();
        let reference = model.evaluate(&design, GridChoice::Reference);
        let fine = model.evaluate(&design, GridChoice::Fine);
        println!(
            "{:6}  {:7.1} / {:7.2}      {:.3} / {:.4} / {:.4}",
            row.name,
            row.paper.0,
            reference.mass(),
            row.paper.1,
            reference.workspace_radius(),
            fine.workspace_radius()
        );
        assert!((reference.mass() - row.model.0).abs() < 0.005);
        assert!((reference.workspace_radius() - row.model.1).abs() < 5e-5);
        assert!((fine.workspace_radius() - row.model.2).abs() < 5e-5);
        // The masses agree within the effect of half a millimetre, the rounding of a printed bar radius.
        assert!((reference.mass() / row.paper.0 - 1.0).abs() < 0.025);
        if row.name == "ID-I" {
            // The workspace radius is twice the printed one. It is limited by dexterity, which does not depend on the
            // stiffness of the actuators.
            assert!(reference.workspace_radius() / row.paper.1 > 2.0);
            let active: Vec<&str> = fine.active().map(|constraint| constraint.id()).collect();
            assert_eq!(active, ["g3"]);
        } else {
            assert!((reference.workspace_radius() / row.paper.1 - 1.0).abs() < 0.013);
        }
    }
}
