//! Strength, materials, joints and parts, as a user of the program meets them.

use std::fs;
use std::path::Path;

use predicates::prelude::*;
use predicates::str::contains;
use serde_json::Value;

use super::support::{DESIGN, check, design_of, folder, json, kinefront, optimize};

const POSE: &str = "x=0.1 y=0.2 phi_deg=30";

/// `pose` reports every member, joint and drive, as JSON and as a table, under the loads of the study and under a wrench of its own.
#[test]
fn a_pose_is_reported_with_its_strength() {
    let of = |more: &[&str]| {
        let plain = ["pose", "--design", DESIGN, "--pose", POSE, "--json"];
        json(plain.iter().chain(more).copied())["strength"].clone()
    };
    let number = |value: &Value| value.as_f64().expect("a number");
    let set = of(&[]);
    assert_eq!(set["members"].as_array().expect("members").len(), 6);
    assert_eq!(set["joints"].as_array().expect("joints").len(), 9);
    assert_eq!(set["members"][0]["name"], "leg1_link");
    assert_eq!(set["joints"][0]["name"], "leg1_joint1");
    assert!(set["safety_factor_min"].is_null() && set["actuator_torque_max_nm"].is_null());
    let stresses = set["members"]
        .as_array()
        .expect("members")
        .iter()
        .map(|member| number(&member["stress_pa"]));
    assert_eq!(stresses.fold(0.0, f64::max), number(&set["stress_max_pa"]));
    // One wrench of the set is no worse than the set.
    let pulled = of(&["--wrench", "fx=100"]);
    assert!(number(&pulled["stress_max_pa"]) < number(&set["stress_max_pa"]));
    assert!(number(&pulled["buckling_factor_min"]) > number(&set["buckling_factor_min"]));
    // The table says the same.
    let table = kinefront()
        .args(["pose", "--design", DESIGN, "--pose", POSE])
        .assert()
        .success();
    table.stdout(
        contains("largest stress")
            .and(contains("leg3_joint3"))
            .and(contains("actuators of legs 1, 2, 3")),
    );
    for (wrench, words) in [
        ("fx=a", "`a` is not a number (key fx)"),
        ("f=1", "unknown key `f`"),
        ("fx=1 fx=2", "`fx` is given twice"),
        ("mz=inf", "mz is inf; it must be finite"),
    ] {
        let arguments = ["pose", "--design", DESIGN, "--pose", POSE, "--wrench", wrench];
        kinefront().args(arguments).assert().code(2).stderr(contains(words));
    }
}

/// The question of a builder: tubes that can be ordered, joints with mass, a column and limits of the strength. Every design of the
/// front is proved, and keeps what it promises at poses that no grid holds.
#[test]
fn the_cell_of_a_builder_is_proved() {
    let folder = folder();
    let run = folder.path().join("run");
    optimize(
        Path::new("builders-cell"),
        &run,
        &["--evaluations", "600", "--front", "10", "--no-recording"],
    );
    let front = fs::read_to_string(run.join("front.csv")).expect("a front");
    let mut rows = front.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let header = rows.next().expect("a header");
    let rows: Vec<Vec<&str>> = rows.collect();
    assert!(rows.len() > 5, "{front}");
    let of = |row: &[&str], name: &str| {
        let place = header.iter().position(|found| *found == name).expect(name);
        row[place].to_owned()
    };
    let number = |row: &[&str], name: &str| of(row, name).parse::<f64>().expect(name);
    for row in &rows {
        assert_eq!(of(row, "certificate"), "proved", "{row:?}");
        assert!(number(row, "safety_factor_min") >= 2.0 && number(row, "buckling_factor_min") >= 3.0);
        assert!(number(row, "value_g7") >= 0.005, "{row:?}");
    }
    // The column is what a design without it would touch: its clearance is told with its name.
    let study = fs::read_to_string(run.join("study.toml")).expect("a study");
    let nearer = folder.path().join("nearer.toml");
    let moved = study.replace("centre_m = [0.5, 0.4]", "centre_m = [0.36, 0.27]");
    assert_ne!(moved, study);
    fs::write(&nearer, moved).expect("written");
    let row = &rows[0];
    let design = design_of(|name| of(row, name));
    let nearer = nearer.to_str().expect("a path");
    let found = json(["evaluate", "--design", &design, "--study", nearer, "--json"]);
    assert_eq!(found["feasible"], false);
    assert_eq!(found["clearance_pair"][1], "column", "{found}");
}

/// A question whose members hold and do not buckle: the front keeps the limits, names the tubes, and sums up to its parts.
#[test]
fn a_machine_that_holds_is_found_and_can_be_ordered() {
    let folder = folder();
    let study = folder.path().join("cell.toml");
    let text = r#"
name = "cell"
architectures = ["3-RPR", "3-PRR"]
objectives = [{ minimize = "mass_kg" }, { maximize = "workspace_radius_m" }]
[workspace]
certify = false
[constraints]
safety_factor_min = { at_least = 2.0 }
buckling_factor_min = { at_least = 3.0 }
[material]
name = "S235"
[joints]
revolute_kg = 0.4
carriage_kg = 1.2
motor_kg = 3.0
[strength]
force_range_n = [300.0, 300.0, 200.0]
[sections]
legs = { kind = "tube", catalogue = "en-10255-medium" }
platform = { kind = "tube", catalogue = "en-10255-medium" }
"#;
    fs::write(&study, text).expect("a study file");
    let out = folder.path().join("run");
    let report = optimize(
        &study,
        &out,
        &["--evaluations", "200", "--front", "10", "--no-recording"],
    );
    assert!(report["front_size"].as_u64().is_some_and(|size| size > 5), "{report}");
    let front = fs::read_to_string(out.join("front.csv")).expect("a front");
    let mut rows = front.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let header = rows.next().expect("a header");
    assert_eq!(header[header.len() - 2..], ["leg_section", "platform_section"]);
    let column = |name: &str| header.iter().position(|found| *found == name).expect(name);
    let mut lightest = None;
    for row in rows {
        let number = |name: &str| row[column(name)].parse::<f64>().expect(name);
        assert!(
            number("safety_factor_min") >= 2.0 && number("buckling_factor_min") >= 3.0,
            "{row:?}"
        );
        assert!(row[column("leg_section")].starts_with("DN"), "{row:?}");
        lightest.get_or_insert((row[column("id")].to_owned(), number("mass_kg")));
    }
    let (id, mass) = lightest.expect("a design");
    let row = format!("{}#{id}", out.join("front.csv").display());
    let parts = folder.path().join("parts.csv");
    kinefront()
        .args(["export", &row, "--out"])
        .arg(&parts)
        .assert()
        .success();
    let parts = fs::read_to_string(parts).expect("the parts");
    let counted = parts.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>());
    let total: f64 = counted
        .filter(|row| row[9] == "true")
        .map(|row| row[8].parse::<f64>().expect("a mass"))
        .sum();
    assert!((total - mass).abs() < 1e-9 * mass, "{total} kg of {mass} kg:\n{parts}");
    assert!(
        parts.contains("carriage,") && parts.contains("platform bar,DN"),
        "{parts}"
    );
    let evaluated = json([
        "evaluate",
        "--study",
        study.to_str().expect("a path"),
        "--design",
        DESIGN,
        "--json",
    ]);
    let limits = evaluated["limits"].as_array().expect("limits");
    assert_eq!(limits[0]["quantity"], "safety_factor_min");
    assert_eq!(limits[1]["quantity"], "buckling_factor_min");
    check(&out).success();
}

#[test]
fn a_study_says_what_it_leaves_open_and_what_cannot_be_computed() {
    let folder = folder();
    let path = folder.path().join("mine.toml");
    let checked = |text: &str| {
        fs::write(&path, text).expect("a study file");
        kinefront().args(["study", "check"]).arg(&path).assert()
    };
    checked("").success().stdout(
        contains("valid")
            .and(contains("members may collide"))
            .and(contains("buckling")),
    );
    for (text, words) in [
        (
            "[constraints]\nsafety_factor_min = { at_least = 2.0 }",
            "has no value without a yield strength",
        ),
        ("[material]\nname = \"S999\"", "S235"),
        ("[material]\nyield_strength_pa = -1.0", "above 0"),
        ("[strength]\nforce_range_n = [1.0, -1.0, 0.0]", "strength.force_range_n"),
        ("[strength]\nshape = \"ball\"", "unknown variant `ball`"),
        ("[joints]\nmotor_kg = -3.0", "joints.motor_kg"),
        (
            "architectures = [\"3-RRR\"]\n[constraints]\nactuator_force_max_n = { at_most = 100.0 }",
            "all actuators turn",
        ),
    ] {
        checked(text).code(2).stderr(contains(words));
    }
    // A question that is asked anew requires a clearance; the paper's does not.
    let new = folder.path().join("new.toml");
    kinefront().args(["study", "new"]).arg(&new).assert().success();
    let text = fs::read_to_string(&new).expect("a study");
    for line in ["\nclearance_min_m = 0.005", "\nstacking = \"chosen\""] {
        assert!(text.contains(line), "{text}");
    }
    let copy = folder.path().join("copy.toml");
    kinefront()
        .args(["study", "new", "--from", "paper"])
        .arg(&copy)
        .assert()
        .success();
    assert!(
        fs::read_to_string(&copy)
            .expect("a study")
            .contains("\n# clearance_min_m = 0.005")
    );
}
