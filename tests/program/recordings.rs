//! Tests of recordings, which are read back with the Rerun package for Python.

use std::path::Path;

use super::support::{
    DESIGN, folder, number, optimize, python, read_rows, says, script, script_json, small_run, value,
};

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
    agrees_with_its_tables(&small_run());
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
        let region = "workspace.region = { kind = \"disc\", radius_m = 0.5 }\n";
        let text = question.to_owned() + region + &kinefront_testkit::small_study(240);
        let study = folder.write("small.toml", text);
        let run = folder.join(name);
        optimize(&study, &run, &[]);
        agrees_with_its_tables(&run);
    }
}

fn check_design(path: &Path) -> Option<serde_json::Value> {
    let python = python(&["rerun", "pyarrow", "numpy"])?;
    Some(script_json(python, "check_design.py", &[path]))
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
        let line = format!("show --design '{design}' --record {index}.rrd");
        folder.run(&line).success();
        if let Some(found) = check_design(&folder.join(format!("{index}.rrd"))) {
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
    let table = small_run().join("front.csv");
    let rows = read_rows(&table);
    let row = rows.last().expect("a row");
    let show = |id: &str, name: &str| folder.run(&format!("show '{}#{id}' --record {name}", table.display()));
    show(&row["id"], "one.rrd").success();
    if let Some(found) = check_design(&folder.join("one.rrd")) {
        let card = found["card"].as_str().expect("a card");
        let radius = value(row, "workspace_radius_m");
        assert!(card.contains(&format!("R_w = {radius:.4} m")), "{card}");
    }
    // No file is overwritten, and an id that does not exist is reported with ids that do.
    let told = show(&row["id"], "one.rrd").code(2);
    told.stderr(says("already exists"));
    let told = show("999999", "two.rrd").code(2);
    told.stderr(says("has no design #999999"));
    assert!(!folder.join("two.rrd").exists());
}

#[test]
fn an_infeasible_design_can_be_looked_at() {
    let folder = folder();
    let design = "3-PRR R=3.3778 r=1.6043 Lb=1.6523 rj=0.094 rp=0.0329";
    let show = |more: &str| folder.run(&format!("show --design '{design}' {more}"));
    show("--field k_z --record one.rrd").success();
    let size = folder.join("one.rrd").metadata().expect("the file").len();
    assert!(size > 10_000, "{size} bytes");
    let told = show("--field heat --record two.rrd").code(2);
    told.stderr(says("worst_margin"));
}

/// The recording of a design of a study with a motion has its curves and poses over the time of the cycle, as the table of the motion
/// has them.
#[test]
fn a_recording_of_a_design_has_the_motion_of_the_study() {
    let folder = folder();
    let text = "[task]\nshape = \"waypoints\"\nwaypoints = [[-0.3, 0, 35], [0.3, 0.1, 45]]\ncycle_time_s = 2.5\ndwell_s = 0.25\n[payload]\nmass_kg = 3\n";
    folder.write("study.toml", text);
    let of = |command: &str| {
        folder
            .run(&format!("{command} --design '{DESIGN}' --study study.toml"))
            .success()
    };
    of("show --record design.rrd");
    let told = of("task --csv --grid fine");
    let table = folder.write("motion.csv", &told.get_output().stdout);
    let Some(python) = python(&["rerun", "pyarrow", "numpy"]) else {
        return;
    };
    let found = script_json(python, "check_motion.py", &[&folder.join("design.rrd"), &table]);
    assert_eq!(found["rows"], 402);
    assert!(found["poses"].as_u64().expect("a count") > 100, "{found}");
    assert!(number(&found["off"]) < 1e-6, "{found}");
    assert_eq!(found["has_path"], true);
}
