//! Compares results with values from independent programs (tests/fixtures/README.md) and with the designs of the paper.

use kinefront_model::evaluation::{GridChoice, Model, PoseScalar};
use kinefront_model::mechanism::{Design, WorkingMode};
use kinefront_model::spatial::Pose;
use kinefront_model::stiffness::StiffnessDefinition;
use nalgebra::Matrix6;
use serde_json::Value;

use super::search::plain_search;
use super::strategies::{self, parsed};

pub fn fixture(name: &str) -> Value {
    let path = format!("{}/tests/fixtures/{name}", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_str(&std::fs::read_to_string(path).expect("the fixture")).expect("JSON")
}

pub fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

pub fn design(case: &Value) -> Design {
    let plus = case["working_mode"].as_i64().unwrap_or(1) > 0;
    let values = ["R", "r", "Lb", "rj", "rp"].map(|key| number(&case["design"][key]));
    let architecture = case["architecture"]
        .as_str()
        .expect("a name")
        .parse()
        .expect("an architecture");
    Design::new(architecture, WorkingMode::new([plus; 3]), values).expect("a valid design")
}

pub fn pose(case: &Value) -> Pose {
    let pose = &case["pose"];
    Pose::new(
        number(&pose["x"]),
        number(&pose["y"]),
        number(&pose["phi_deg"]).to_radians(),
    )
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

#[test]
fn poses_agree_with_the_finite_element_solver() {
    let cases = fixture("cases.json");
    let cases = cases["poses"].as_array().expect("poses");
    assert_eq!(cases.len(), 12);
    let compliance = strategies::model(|settings| settings.stiffness_definition = StiffnessDefinition::Compliance);
    for case in cases {
        let (design, pose) = (design(case), pose(case));
        let report = Model::default().pose(&design, &pose).expect("reachable");
        for leg in 0..3 {
            close(report.actuators[leg], number(&case["actuators"][leg]), 1e-9, "actuator");
            for axis in 0..2 {
                close(report.b[leg][axis], number(&case["B"][leg][axis]), 1e-9, "B");
                close(report.c[leg][axis], number(&case["C"][leg][axis]), 1e-9, "C");
            }
        }
        close(
            report.values[PoseScalar::Dexterity],
            number(&case["inverse_condition"]),
            1e-9,
            "inverse condition",
        );
        let off = difference(&report.stiffness, &matrix(&case["stiffness_matrix"]));
        assert!(off < 1e-7, "{design} at {pose:?}: stiffness off by {off:e}");
        let soft = compliance.pose(&design, &pose).expect("reachable").values;
        for (value, key) in [
            (report.values[PoseScalar::StiffnessXy], "k_xy"),
            (report.values[PoseScalar::StiffnessZ], "k_z"),
            (report.values[PoseScalar::StiffnessPhiZ], "k_phi_z"),
            (soft[PoseScalar::StiffnessXy], "k_xy_compliance"),
            (soft[PoseScalar::StiffnessZ], "k_z_compliance"),
            (soft[PoseScalar::StiffnessPhiZ], "k_phi_z_compliance"),
        ] {
            let wanted = number(&case[key]);
            assert!(
                (value / wanted - 1.0).abs() < 1e-6,
                "{design}: {key} {value} instead of {wanted}"
            );
        }
    }
}

#[test]
fn designs_agree_on_both_grids_and_both_definitions() {
    let cases = fixture("cases.json");
    let cases = cases["designs"].as_array().expect("designs");
    assert_eq!(cases.len(), 13);
    let model = Model::default();
    let compliance = strategies::model(|settings| {
        settings.stiffness_definition = StiffnessDefinition::Compliance;
    });
    for case in cases {
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
    let cases = fixture("cases.json");
    let model = Model::default();
    let mut agreeing = 0;
    for case in cases["designs"].as_array().expect("designs") {
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
    let cases = fixture("thin_bars.json");
    assert_eq!(cases["poses"].as_array().map(Vec::len), Some(36));
    for case in cases["poses"].as_array().expect("poses") {
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
