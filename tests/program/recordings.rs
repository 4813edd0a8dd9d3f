//! Tests of recordings, which are read back with the Rerun package for Python.

use std::path::Path;

use predicates::str::contains;

use super::support::{DESIGN, folder, kinefront, optimize, python, script, small_study};

/// Checks that the recording of a run folder passes `rerun rrd verify` and contains the rows of the tables.
pub fn agrees_with_its_tables(run: &Path) {
    if let Some(python) = python(&["rerun", "pyarrow", "numpy"]) {
        println!("{}", script(python, "check_recording.py", &[run]));
    }
}

/// Checks that the recordings of two run folders have the same rows.
pub fn are_alike(run: &Path, other: &Path) {
    if let Some(python) = python(&["rerun", "pyarrow", "numpy"]) {
        let paths = [run, other].map(|run| run.join("recording.rrd"));
        println!("{}", script(python, "compare_recordings.py", &[&paths[0], &paths[1]]));
    }
}

#[test]
fn a_recording_holds_what_the_tables_hold() {
    let folder = folder();
    let out = folder.path().join("run");
    optimize(&small_study(folder.path()), &out, &[]);
    agrees_with_its_tables(&out);
}

/// The plot of a recording shows what the study seeks.
#[test]
fn recordings_follow_the_question_of_the_study() {
    let folder = folder();
    for (name, question) in [
        ("one", "objectives = [{ minimize = \"mass_kg\" }]\n"),
        (
            "two",
            "objectives = [{ minimize = \"mass_kg\" }, { maximize = \"k_xy_n_per_m\" }]\n",
        ),
    ] {
        let study = small_study(folder.path());
        let mut text = std::fs::read_to_string(&study).expect("a study");
        text.insert_str(0, "workspace.region = { kind = \"disc\", radius_m = 0.5 }\n");
        text.insert_str(0, question);
        std::fs::write(&study, text).expect("a study");
        let run = folder.path().join(name);
        optimize(&study, &run, &["--evaluations", "240"]);
        agrees_with_its_tables(&run);
    }
}

fn check_design(path: &Path) -> Option<serde_json::Value> {
    let python = python(&["rerun", "pyarrow", "numpy"])?;
    Some(serde_json::from_str(&script(python, "check_design.py", &[path])).expect("JSON"))
}

#[test]
fn a_design_is_recorded_with_its_overlays_and_its_tour() {
    let folder = folder();
    // Design, and number of bars in its legs.
    let designs = [
        (DESIGN, 3),
        ("3-RPR R=2.2462 r=1.2453 Lb=3.5382 rj=0.0224 rp=0.083", 6),
        ("3-RRR R=3.3658 r=0.2537 Lb=1.9157 rj=0.0787 rp=0.0891", 6),
    ];
    for (index, (design, bars)) in designs.into_iter().enumerate() {
        let path = folder.path().join(format!("{index}.rrd"));
        kinefront()
            .args(["show", "--design", design, "--record"])
            .arg(&path)
            .assert()
            .success();
        if let Some(found) = check_design(&path) {
            assert_eq!(found["poses"], 235);
            assert_eq!(found["leg_bars"], bars);
            assert_eq!(
                found["views"],
                serde_json::json!({"2D": 17, "3D": 20, "TextDocument": 1})
            );
            assert!(found["vertices"].as_u64().expect("a count") > 5000);
            let card = found["card"].as_str().expect("a card");
            assert!(
                card.contains("**active**")
                    && card.contains("forward kinematics")
                    && card.contains("smallest clearance between members"),
                "{card}"
            );
        }
    }
}

/// A row of a table of a run is shown under the study of that run.
#[test]
fn a_design_of_a_front_is_shown_by_its_id() {
    let folder = folder();
    let out = folder.path().join("run");
    optimize(&small_study(folder.path()), &out, &[]);
    let table = out.join("front.csv");
    let mut reader = csv::Reader::from_path(&table).expect("a table");
    let row = reader.records().last().expect("a row").expect("a row");
    let path = folder.path().join("one.rrd");
    let show = |id: &str, path: &Path| {
        let mut command = kinefront();
        command
            .arg("show")
            .arg(format!("{}#{id}", table.display()))
            .arg("--record")
            .arg(path);
        command.assert()
    };
    show(&row[0], &path).success();
    if let Some(found) = check_design(&path) {
        let card = found["card"].as_str().expect("a card");
        let radius: f64 = row[10].parse().expect("a number");
        assert!(card.contains(&format!("R_w = {radius:.4} m")), "{card}");
    }
    // No file is overwritten, and an id that does not exist is reported with ids that do.
    show(&row[0], &path).code(2).stderr(contains("already exists"));
    show("999999", &folder.path().join("two.rrd"))
        .code(2)
        .stderr(contains("has no design #999999"));
    assert!(!folder.path().join("two.rrd").exists());
}

#[test]
fn an_infeasible_design_can_be_looked_at() {
    let folder = folder();
    let path = folder.path().join("one.rrd");
    let design = "3-PRR R=3.3778 r=1.6043 Lb=1.6523 rj=0.094 rp=0.0329";
    kinefront()
        .args(["show", "--design", design, "--field", "k_z", "--record"])
        .arg(&path)
        .assert()
        .success();
    assert!(path.metadata().expect("the file").len() > 10_000);
    let wrong = folder.path().join("two.rrd");
    kinefront()
        .args(["show", "--design", design, "--field", "heat", "--record"])
        .arg(&wrong)
        .assert()
        .code(2)
        .stderr(contains("worst_margin"));
}

/// The recording of a design of a study with a motion has its curves and poses over the time of the cycle, as the table of the motion
/// has them.
#[test]
fn a_recording_of_a_design_has_the_motion_of_the_study() {
    let folder = folder();
    let study = folder.path().join("study.toml");
    let text = "[task]\nshape = \"waypoints\"\nwaypoints = [[-0.3, 0, 35], [0.3, 0.1, 45]]\ncycle_time_s = 2.5\ndwell_s = 0.25\n[payload]\nmass_kg = 3\n";
    std::fs::write(&study, text).expect("a study");
    let recording = folder.path().join("design.rrd");
    let of = |command: &str| {
        let mut command_line = kinefront();
        command_line.args([command, "--design", DESIGN, "--study"]).arg(&study);
        command_line
    };
    of("show").arg("--record").arg(&recording).assert().success();
    let told = of("task").args(["--csv", "--grid", "fine"]).assert().success();
    let table = folder.path().join("motion.csv");
    std::fs::write(&table, &told.get_output().stdout).expect("a table");
    let Some(python) = python(&["rerun", "pyarrow", "numpy"]) else {
        return;
    };
    let found: serde_json::Value =
        serde_json::from_str(&script(python, "check_motion.py", &[&recording, &table])).expect("JSON");
    assert_eq!(found["rows"], 402);
    assert!(found["poses"].as_u64().expect("a count") > 100, "{found}");
    assert!(found["off"].as_f64().expect("a number") < 1e-6, "{found}");
    assert_eq!(found["has_path"], true);
}
