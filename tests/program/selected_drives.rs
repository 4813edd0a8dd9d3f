//! Drives that are selected from a catalogue, as a user of the program meets them.

use predicates::prelude::*;
use predicates::str::contains;

use super::support::{check, design_of, folder, number, parsed, read_rows, says, value};

/// A study whose drives are selected from a catalogue, for machines whose motors stand and whose motors move.
const SELECTING: &str = r#"
    name = "selecting"
    architectures = ["3-PRR", "3-R_RR"]
    objectives = [{ minimize = "mass_kg" }, { minimize = "drive_mass_kg" }]
    [payload]
    mass_kg = 5.0
    [task]
    shape = "waypoints"
    waypoints = [[-0.15, 0.0, 0.0], [0.15, 0.0, 0.0]]
    cycle_time_s = 1.0
    [workspace]
    home_phi_deg = 0.0
    [workspace.region]
    kind = "rectangle"
    width_m = 0.4
    height_m = 0.2
    [bounds]
    R_m = [0.3, 1.5]
    r_m = [0.05, 0.6]
    Lb_m = [0.2, 1.5]
    [optimizer]
    evaluations = 300
"#;

/// A run selects drives, its table and its parts name them, and readers of the table know them again.
#[test]
fn a_run_selects_drives_from_a_catalogue() {
    let folder = folder();
    let catalogue = "[drives]\ncatalogue = \"generic-drives\"\n";
    folder.write("study.toml", format!("{SELECTING}\n{catalogue}"));
    folder.run("optimize study.toml --out run --quiet").success();
    let front = folder.read("run/front.csv");
    assert!(
        front.lines().next().is_some_and(|header| header.ends_with(",drive")),
        "{front}"
    );
    let rows = read_rows(&folder.join("run/front.csv"));
    let row = &rows[0];
    let drive = row["drive"].as_str();
    assert!(!drive.is_empty());
    assert!(rows.iter().all(|row| value(row, "drive_utilization") <= 1.0));
    // Evaluated anew, it is the same design with the same drive.
    let design = design_of(row);
    let line = |command: &str| format!("{command} --design '{design}' --study study.toml --grid fine");
    let found = folder.json(&(line("evaluate") + " --json"));
    assert_eq!(number(&found["mass_kg"]).to_string(), row["mass_kg"]);
    assert_eq!(found["task"]["drive"], drive);
    let mass = found["quantities"]["drive_mass_kg"].to_string().parse::<f64>();
    assert_eq!(mass, row["drive_mass_kg"].parse());
    folder.run(&line("task")).success().stdout(
        contains(drive)
            .and(contains(", utilization "))
            .and(contains("s, set by the limit of the utilization of the drives")),
    );
    let export = |format: &str| folder.run(&format!("export run/front.csv#{} --format {format} --out -", row["id"]));
    export("csv-parts").success().stdout(contains(drive));
    // A file for other programs states the same.
    let exported = parsed(&export("json").success());
    assert_eq!(exported["evaluation"]["quantities"], found["quantities"]);
    assert_eq!(exported["evaluation"]["task"], found["task"]);
    check(&folder.join("run")).success();
    // A table that names a drive that the catalogue does not have is not that of the run.
    folder.write("run/front.csv", front.replace(drive, "perpetual motion"));
    export("csv-parts").code(2);
}

/// A catalogue beside the study is read with its comments, and what is wrong in it is told with its line.
#[test]
fn catalogues_of_drives_are_checked() {
    let folder = folder();
    folder.write(
        "study.toml",
        format!("{SELECTING}\n[drives]\ncatalogue = \"motors.csv\"\n"),
    );
    let check = |rows: &str| {
        let header = "# Source: a maker\nname,kind,rated,peak,speed,inertia,mass_kg\n";
        folder.write("motors.csv", format!("{header}{rows}"));
        folder.run("study check study.toml")
    };
    let slide = "axis,prismatic,100,300,2,1,4\n";
    check(&format!("{slide}joint, revolute, 100, 300, 20, 0.1, 4\n")).success();
    for (more, words) in [
        (
            "",
            "has no drive of the kind revolute, but the actuators of 3-R_RR turn",
        ),
        (
            "joint,rotary,1,2,3,0,1\n",
            "line 4 of motors.csv is not an entry of a catalogue; its columns, separated by commas, are name, kind",
        ),
        ("joint,revolute,9,2,3,0,1\n", "`joint` is not a valid drive"),
        ("joint,revolute,1,2,NaN,0,1\n", "`joint` is not a valid drive"),
        ("axis,revolute,1,2,3,0,1\n", "`axis` is the name of two drives"),
    ] {
        let told = check(&format!("{slide}{more}")).code(2);
        told.stderr(says(words).and(says("catalogue")));
    }
    check("").code(2).stderr(says("it has no entry").and(says("catalogue")));
    // No drive is strong enough: the design is infeasible, and the program says by how much.
    let weak = "axis,prismatic,0.1,0.2,2,1,4\n";
    let text = SELECTING.replace(", \"3-R_RR\"", "");
    folder.write("study.toml", format!("{text}\n[drives]\ncatalogue = \"motors.csv\"\n"));
    check(weak).success();
    let line =
        |command: &str| format!("{command} --design '3-PRR R=1.0 r=0.3 Lb=0.7 rj=0.03 rp=0.04' --study study.toml");
    folder.run(&line("task")).success().stdout(contains(
        "no drive of the catalogue can perform the motion; axis comes closest",
    ));
    let found = folder.json(&(line("evaluate") + " --json"));
    assert_eq!(found["feasible"], false);
    assert!(found["task"]["drive"].is_null());
    assert!(number(&found["task"]["drive_utilization"]) > 1.0);
}

/// A catalogue has an effect where there is a motion, and quantities of drives a value where there is a catalogue.
#[test]
fn catalogues_of_drives_need_a_motion() {
    let folder = folder();
    folder.write(
        "motors.csv",
        "name,kind,rated,peak,speed,inertia,mass_kg\naxis,prismatic,100,300,2,1,4\n",
    );
    for (text, words) in [
        (
            "[drives]\ncatalogue = \"motors.csv\"\n",
            "has no effect without a motion",
        ),
        (
            "[drives]\ncatalogue = \"engines.csv\"\n",
            "give the path of a CSV file beside the study, or \"generic-drives\"",
        ),
        (
            "[constraints]\ndrive_mass_kg = { at_most = 3 }\n[task]\nshape = \"circle\"\ncycle_time_s = 2\n",
            "has no value without a catalogue of drives",
        ),
    ] {
        folder.write("study.toml", format!("architectures = [\"3-PRR\"]\n{text}"));
        folder.run("study check study.toml").code(2).stderr(says(words));
    }
}
