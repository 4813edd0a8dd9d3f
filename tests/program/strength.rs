//! Strength, materials, joints and parts, as a user of the program meets them.

use std::path::Path;

use predicates::prelude::*;
use predicates::str::contains;

use super::support::{
    DESIGN, check, design_of, folder, json, list, number, optimize, read_rows, rows_of, run, says, value,
};

const POSE: &str = "x=0.1 y=0.2 phi_deg=30";

/// `pose` reports every member, joint and drive, as JSON and as a table, under the loads of the study and under a wrench of its own.
#[test]
fn a_pose_is_reported_with_its_strength() {
    let line = |more: &str| format!("pose --design '{DESIGN}' --pose '{POSE}' {more}");
    let of = |more: &str| json(&line(&format!("{more} --json")))["strength"].clone();
    let set = of("");
    let members = list(&set["members"]);
    assert_eq!((members.len(), list(&set["joints"]).len()), (6, 9));
    assert_eq!(members[0]["name"], "leg1_link");
    assert_eq!(set["joints"][0]["name"], "leg1_joint1");
    assert!(set["safety_factor_min"].is_null() && set["actuator_torque_max_nm"].is_null());
    let stresses = members.iter().map(|member| number(&member["stress_pa"]));
    assert_eq!(stresses.fold(0.0, f64::max), number(&set["stress_max_pa"]));
    // One wrench of the set is no worse than the set.
    let pulled = of("--wrench fx=100");
    assert!(number(&pulled["stress_max_pa"]) < number(&set["stress_max_pa"]));
    assert!(number(&pulled["buckling_factor_min"]) > number(&set["buckling_factor_min"]));
    // The table says the same.
    let table = run(&line("")).success();
    let drives = contains("actuators of legs 1, 2, 3");
    table.stdout(contains("largest stress").and(contains("leg3_joint3")).and(drives));
    for (wrench, words) in [
        ("fx=a", "`a` is not a number (key fx)"),
        ("f=1", "unknown key `f`"),
        ("fx=1 fx=2", "`fx` is given twice"),
        ("mz=inf", "mz is inf; it must be finite"),
    ] {
        let told = run(&line(&format!("--wrench '{wrench}'"))).code(2);
        told.stderr(says(words));
    }
}

/// The question of a builder: tubes that can be ordered, joints with mass, a column and limits of the strength. Every design of the
/// front is proved, and keeps what it promises at poses that no grid holds.
#[test]
fn the_cell_of_a_builder_is_proved() {
    let folder = folder();
    let run = folder.join("run");
    optimize(
        Path::new("builders-cell"),
        &run,
        &["--evaluations", "600", "--front", "10", "--no-recording"],
    );
    let rows = read_rows(&run.join("front.csv"));
    assert!(rows.len() > 5, "{rows:?}");
    for row in &rows {
        assert_eq!(row["certificate"], "proved", "{row:?}");
        assert!(value(row, "safety_factor_min") >= 2.0 && value(row, "buckling_factor_min") >= 3.0);
        assert!(value(row, "value_g7") >= 0.005, "{row:?}");
    }
    // The column is what a design without it would touch: its clearance is told with its name.
    let study = folder.read("run/study.toml");
    let moved = study.replace("centre_m = [0.5, 0.4]", "centre_m = [0.36, 0.27]");
    assert_ne!(moved, study);
    folder.write("nearer.toml", moved);
    let design = design_of(&rows[0]);
    let found = folder.json(&format!("evaluate --design '{design}' --study nearer.toml --json"));
    assert_eq!(found["feasible"], false);
    assert_eq!(found["clearance_pair"][1], "column", "{found}");
}

/// A question whose members hold and do not buckle: the front keeps the limits, names the tubes, and sums up to its parts.
#[test]
fn a_machine_that_holds_is_found_and_can_be_ordered() {
    let folder = folder();
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
    let (study, out) = (folder.write("cell.toml", text), folder.join("run"));
    let report = optimize(
        &study,
        &out,
        &["--evaluations", "200", "--front", "10", "--no-recording"],
    );
    assert!(report["front_size"].as_u64().is_some_and(|size| size > 5), "{report}");
    let front = folder.read("run/front.csv");
    let header = front.lines().next().expect("a header");
    assert!(header.ends_with(",leg_section,platform_section"), "{header}");
    let rows = rows_of(front.as_bytes());
    for row in &rows {
        let factors = ["safety_factor_min", "buckling_factor_min"].map(|name| value(row, name));
        assert!(factors[0] >= 2.0 && factors[1] >= 3.0, "{row:?}");
        assert!(row["leg_section"].starts_with("DN"), "{row:?}");
    }
    // The parts of the lightest design have its mass.
    let (id, mass) = (&rows[0]["id"], value(&rows[0], "mass_kg"));
    folder
        .run(&format!("export run/front.csv#{id} --out parts.csv"))
        .success();
    let parts = folder.read("parts.csv");
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
    let evaluated = folder.json(&format!("evaluate --study cell.toml --design '{DESIGN}' --json"));
    let limits = [0, 1].map(|place: usize| &evaluated["limits"][place]["quantity"]);
    assert_eq!(limits, ["safety_factor_min", "buckling_factor_min"]);
    check(&out).success();
}

#[test]
fn a_study_says_what_it_leaves_open_and_what_cannot_be_computed() {
    let folder = folder();
    let checked = |text: &str| {
        folder.write("mine.toml", text);
        folder.run("study check mine.toml")
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
        checked(text).code(2).stderr(says(words));
    }
    // A question that is asked anew requires a clearance; the paper's does not.
    folder.run("study new new.toml").success();
    let text = folder.read("new.toml");
    for line in ["\nclearance_min_m = 0.005", "\nstacking = \"chosen\""] {
        assert!(text.contains(line), "{text}");
    }
    folder.run("study new --from paper copy.toml").success();
    assert!(folder.read("copy.toml").contains("\n# clearance_min_m = 0.005"));
}
