//! Payload, motion, frequencies and accuracy, as a user of the program meets them.

use std::fs;

use predicates::prelude::*;
use predicates::str::contains;
use serde_json::Value;

use super::exports::{DESIGNS, OTHERS};
use super::support::{DESIGN, design_of, folder, json, kinefront, optimize, python, sample, says, script};

/// The settings of the first independent case of the model's fixture `task_cases.json`.
const STUDY: &str = r#"
    name = "moving"
    [payload]
    mass_kg = 20.0
    inertia_kg_m2 = 0.6
    centre_m = [0.1, -0.05]
    [drives]
    slider_mass_kg = 5.0
    prismatic_inertia_kg = 10.0
    [anywhere]
    v_m_per_s = 1.0
    omega_rad_per_s = 1.0
    a_m_per_s2 = 10.0
    alpha_rad_per_s2 = 10.0
    force_n = 100.0
    moment_nm = 10.0
    [tolerances]
    encoder_m = 1e-5
    base_m = 5e-5
    platform_m = 5e-5
    link_m = 5e-5
    play_m = 1e-5
    [task]
    shape = "star"
    cycle_time_s = 5.0
"#;

fn near(found: &Value, wanted: f64) {
    let found = found.as_f64().expect("a number");
    assert!(
        (found - wanted).abs() < 1e-6 * wanted.abs(),
        "{found} instead of {wanted}"
    );
}

/// `pose`, `evaluate` and `task` give what an independent program found for the same design.
#[test]
fn commands_give_independent_values() {
    let folder = folder();
    let study = folder.path().join("moving.toml");
    fs::write(&study, STUDY).expect("a study");
    let study = study.to_str().expect("a path");
    let of = |command: &str, more: &[&str]| {
        let plain = [command, "--design", DESIGN, "--study", study, "--json"];
        json(plain.iter().chain(more).copied())
    };
    let pose = of(
        "pose",
        &[
            "--pose",
            "x=-0.059 y=-0.0521 phi_deg=39.68",
            "--twist",
            "vx=0.113 vy=-1.22 omega=0.305",
            "--acceleration",
            "ax=4.758 ay=0.712 alpha=-5.472",
        ],
    );
    near(&pose["frequencies_hz"][0], 15.614158288064678);
    near(&pose["frequencies_hz"][3], 8.475001866114397);
    near(&pose["actuator_forces"][2], -1854.8122470604092);
    near(&pose["pose_error"]["worst_xy_m"], 0.00024555959650917643);
    let evaluated = of("evaluate", &[]);
    near(&evaluated["over_workspace"]["f1"]["value"], 8.181517922480754);
    near(&evaluated["quantities"]["natural_frequency_hz"], 8.181517922480754);
    near(&evaluated["over_workspace"]["footprint_m2"], 19.88929035526777);
    near(&evaluated["quantities"]["motion_force_max_n"], 6864.787152288396);
    near(&evaluated["task"]["corner_power_w"], 15797.342239571883);
    let task = of("task", &[]);
    assert_eq!(task["ok"], true);
    near(&task["energy_shared_j"], 14085.007102823249);
    let samples = task["samples"].as_array().expect("samples");
    assert_eq!(samples.len(), 5 * 201);
    near(&samples[70]["tau1"], -1995.0279436305827);
    // The table of the curves holds the same samples.
    let table = kinefront()
        .args(["task", "--design", DESIGN, "--study", study, "--csv"])
        .assert()
        .success();
    let text = String::from_utf8(table.get_output().stdout.clone()).expect("text");
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    assert_eq!(reader.headers().expect("a header").len(), 26);
    let rows: Vec<csv::StringRecord> = reader.records().map(|row| row.expect("a row")).collect();
    assert_eq!(rows.len(), samples.len());
    assert_eq!(rows[70][20].parse::<f64>().ok(), samples[70]["tau1"].as_f64());
}

/// A motion is proved with bounds near its samples, and what the samples miss refutes it.
#[test]
fn a_motion_is_proved_between_its_samples() {
    let folder = folder();
    let study = folder.path().join("moving.toml");
    let of = |more: &str| {
        fs::write(&study, format!("{STUDY}{more}")).expect("a study");
        let path = study.to_str().expect("a path");
        let found = json(["task", "--design", DESIGN, "--study", path, "--json"]);
        let figure = |key: &str| {
            let values = found[key].as_array().expect("three numbers").iter();
            values
                .map(|value| value.as_f64().expect("a number"))
                .fold(0.0, f64::max)
        };
        (found["proof"].clone(), figure("peak_speed"), figure("peak_force"))
    };
    let (proof, speed, force) = of("");
    assert_eq!(proof["verdict"], "proved");
    for (key, peak) in [("speed_at_most", speed), ("force_at_most", force)] {
        let bound = proof[key].as_f64().expect("a bound");
        assert!((peak..1.002 * peak).contains(&bound), "{key}: {bound} for {peak}");
    }
    // Six samples of a piece miss its largest speed by more than a hundredth.
    let limited = |samples: &str| {
        of(&format!(
            "{samples}\n[constraints.path_speed_max_m_per_s]\nat_most = {}\n",
            0.995 * speed
        ))
    };
    let (proof, rough, _) = limited("samples = 5");
    assert!(rough < 0.99 * speed, "{rough} of {speed}");
    assert_eq!(proof["verdict"], "refuted", "{proof}");
    assert_eq!(proof["claim"], "path_speed_max_m_per_s");
    assert!(proof["speed_at_most"].is_null());
    assert!(proof["time_s"].as_f64().is_some_and(|time| (0.0..5.0).contains(&time)));
}

/// What cannot be moved, or makes no sense, is said with its place and its remedy.
#[test]
fn motions_that_are_impossible_are_told() {
    let folder = folder();
    let study = folder.path().join("study.toml");
    let path = study.to_str().expect("a path");
    let run = |text: &str, more: &[&str]| {
        fs::write(&study, text).expect("a study");
        let plain = ["task", "--design", DESIGN, "--study", path];
        kinefront().args(plain.iter().chain(more)).assert()
    };
    let task = |keys: &str| format!("[task]\n{keys}\n");
    for (text, words) in [
        (String::new(), "defines no motion"),
        (
            task("cycle_time_s = 1"),
            "is missing; without it, nothing else in [task] has an effect",
        ),
        (task("shape = \"star\""), "is missing; set it, or limits"),
        (task("shape = \"star\"\ncycle_time_s = 0"), "must be above 0"),
        (
            task("shape = \"star\"\ncycle_time_s = 1\ndwell_s = 0.2"),
            "the rests after 5 pieces take 1 s of it",
        ),
        (
            task("shape = \"waypoints\"\ncycle_time_s = 1"),
            "needs at least two different points",
        ),
        (
            task("shape = \"waypoints\"\nwaypoints = [[0, 0, 0], [0, 0, 9]]\nv_max_m_per_s = 1"),
            "nothing else limits how fast",
        ),
        (
            task("shape = \"star\"\ncycle_time_s = 1\nsamples = 100001"),
            "must be 2 to 100000",
        ),
        (
            format!(
                "[task]\nshape = \"waypoints\"\ncycle_time_s = 1\nsamples = 100000\nwaypoints = [{}]\n",
                "[0, 0, 0], [0.01, 0, 0], ".repeat(10)
            ),
            "a motion has at most 1000000 samples",
        ),
        (
            format!(
                "[task]\nshape = \"waypoints\"\ncycle_time_s = 1e5\nwaypoints = [{}]\n",
                "[0, 0, 0], [0.01, 0, 0], ".repeat(50_000)
            ),
            "it has more than 262144",
        ),
        (
            "[constraints]\nenergy_j = { at_most = 5 }".to_owned(),
            "has no value without a motion; state it in [task]",
        ),
        (
            "[constraints]\nposition_error_m = { at_most = 1e-3 }".to_owned(),
            "is 0 without tolerances; state them in [tolerances]",
        ),
        ("[payload]\nmass_kg = -1".to_owned(), "mass_kg"),
    ] {
        run(&text, &[]).code(2).stderr(says(words));
    }
    // A motion that leaves the reach is a result: where, when and why, and no other figure.
    let far = task("shape = \"waypoints\"\nwaypoints = [[0, 0, 30], [9, 0, 30]]\ncycle_time_s = 2");
    run(&far, &[])
        .success()
        .stdout(contains("not possible").and(contains("the motion ends in piece 1 at")));
    run(&far, &["--csv"])
        .success()
        .stdout("")
        .stderr(contains("the motion ends in piece 1"));
    let text = run(&far, &["--json"]).success();
    let found: Value = serde_json::from_slice(&text.get_output().stdout).expect("JSON");
    assert_eq!(found["ok"], false);
    assert_eq!(found["piece"], 1);
    assert!(found["time_s"].is_number() && found["reason"].is_string());
    assert!(found["cycle_time_s"].is_null() && found["peak_force"].is_null() && found["energy_net_j"].is_null());
    // A payload beyond all machines gives numbers.
    let heavy = format!(
        "[payload]\nmass_kg = 1e9\n{}",
        task("shape = \"circle\"\ncycle_time_s = 2")
    );
    let text = run(&heavy, &["--json"]).success();
    let found: Value = serde_json::from_slice(&text.get_output().stdout).expect("JSON");
    assert!(found["peak_force"][0].as_f64().expect("a number") > 1e8);
}

/// Exports a design for a study in a format.
fn export_to(file: &std::path::Path, design: &str, study: &std::path::Path, format: &str) {
    kinefront()
        .args(["export", "--design", design, "--format", format, "--study"])
        .arg(study)
        .arg("--out")
        .arg(file)
        .assert()
        .success();
}

/// MuJoCo needs the same forces of the actuators for the same motion of the exported mechanisms, with joints, motors and gravity in the
/// plane: it knows their bodies alone.
#[test]
fn mujoco_needs_the_same_forces() {
    let Some(interpreter) = python(&["mujoco", "numpy"]) else {
        return;
    };
    let folder = folder();
    let study = folder.path().join("study.toml");
    let text = "[joints]\nrevolute_kg = 0.5\ncarriage_kg = 1.5\nmotor_kg = 2.5\n\
                [payload]\nmass_kg = 4.0\ninertia_kg_m2 = 0.2\ncentre_m = [0.11, -0.07]\n\
                [drives]\nslider_mass_kg = 1.2\nprismatic_inertia_kg = 0.7\nrevolute_inertia_kg_m2 = 0.3\n\
                [loads]\ngravity_m_per_s2 = [1.5, -4.0, -9.81]\n";
    fs::write(&study, text).expect("a study");
    let motion = folder.path().join("motion.json");
    let text = r#"{"twist": [0.3, -0.4, 0.5], "acceleration": [2.0, 3.0, -4.0], "gravity": [1.5, -4.0, -9.81]}"#;
    fs::write(&motion, text).expect("a motion");
    // The file for MuJoCo gives the carriage of this one half of the mass of its guide, because a driven body needs inertia.
    let others = OTHERS.into_iter().filter(|design| !design.starts_with("3-P_PR"));
    let designs: Vec<&str> = DESIGNS.iter().map(|(design, _)| *design).chain(others).collect();
    let files = designs.iter().enumerate().map(|(index, design)| {
        let file = folder.path().join(format!("{index}.xml"));
        export_to(&file, design, &study, "mjcf");
        file
    });
    let files: Vec<std::path::PathBuf> = std::iter::once(motion.clone()).chain(files).collect();
    let arguments: Vec<&std::path::Path> = files.iter().map(|file| file.as_path()).collect();
    let found: Value = serde_json::from_str(&script(interpreter, "mujoco_forces.py", &arguments)).expect("JSON");
    assert_eq!(found.as_array().expect("designs").len(), 17);
    for (design, found) in designs.iter().zip(found.as_array().expect("designs")) {
        let number = |value: &Value| value.as_f64().expect("a number");
        let pose = &found["pose"];
        let at = format!(
            "x={} y={} phi_deg={}",
            number(&pose[0]),
            number(&pose[1]),
            number(&pose[2]).to_degrees()
        );
        let ours = json([
            "pose",
            "--design",
            design,
            "--pose",
            &at,
            "--study",
            study.to_str().expect("a path"),
            "--twist",
            "vx=0.3 vy=-0.4 omega=0.5",
            "--acceleration",
            "ax=2 ay=3 alpha=-4",
            "--json",
        ]);
        for (key, of_mujoco, tolerance) in [("actuator_speeds", "speeds", 1e-9), ("actuator_forces", "forces", 1e-6)] {
            let largest = (0..3).fold(0.0f64, |most, leg| most.max(number(&ours[key][leg]).abs()));
            for leg in 0..3 {
                let off = (number(&ours[key][leg]) - number(&found[of_mujoco][leg])).abs();
                assert!(off < tolerance * largest, "{design}: {key} {} and {found}", ours[key]);
            }
        }
        assert!(
            number(&found["off"]) < 1e-9,
            "{design}: the loops are not closed: {found}"
        );
    }
}

/// A controller that takes the reference trajectory moves the exported mechanism along its path in MuJoCo, with the payload and the rotors,
/// and the keyframes are the poses at which it rests.
#[test]
fn mujoco_follows_the_reference_trajectory() {
    let Some(_) = python(&["mujoco", "numpy"]) else { return };
    let folder = folder();
    let study = folder.path().join("study.toml");
    let text = "[joints]\nrevolute_kg = 0.5\ncarriage_kg = 1.5\nmotor_kg = 2.5\n\
                [payload]\nmass_kg = 4.0\ninertia_kg_m2 = 0.2\ncentre_m = [0.11, -0.07]\n\
                [drives]\nslider_mass_kg = 1.2\nprismatic_inertia_kg = 2.0\nrevolute_inertia_kg_m2 = 2.0\n\
                [loads]\ngravity_m_per_s2 = [0.0, -9.81, 0.0]\n\
                [task]\nshape = \"star\"\nshare = 0.5\ncycle_time_s = 3.0\ndwell_s = 0.05\n";
    fs::write(&study, text).expect("a study");
    let designs: Vec<&str> = DESIGNS.iter().map(|(design, _)| *design).chain(OTHERS).collect();
    sample(designs.into_iter(), 4).for_each(|design| {
        let name = design.split(' ').next().expect("a name");
        let [model, trajectory] = [("mjcf", "xml"), ("csv-trajectory", "csv")].map(|(format, extension)| {
            let file = folder.path().join(format!("{name}.{extension}"));
            export_to(&file, design, &study, format);
            file
        });
        let python = python(&["mujoco", "numpy"]).expect("Python, which was found before");
        let found: Value =
            serde_json::from_str(&script(python, "mujoco_motion.py", &[&model, &trajectory])).expect("JSON");
        let number = |key: &str| found[key].as_f64().expect("a number");
        assert!(number("farthest_m") < 1e-3, "{design}: {found}");
        assert!(number("turned_rad") < 1e-3, "{design}: {found}");
        assert!(
            number("open_m") < 1e-9,
            "{design}: the keyframes do not close the loops: {found}"
        );
        assert!(number("off_rest_m") < 1e-9, "{design}: {found}");
        assert!(number("travelled_m") > 0.1, "{design}: {found}");
        assert_eq!(found["rests"], 6, "{design}");
        assert_eq!(found["rows"], 3001, "{design}");
    });
    // Without a motion, and with one that leaves the reach, there is no trajectory.
    let export = |study: &std::path::Path| {
        let mut command = kinefront();
        command.args([
            "export",
            "--design",
            DESIGN,
            "--format",
            "csv-trajectory",
            "--out",
            "-",
            "--study",
        ]);
        command.arg(study).assert()
    };
    fs::write(&study, "name = \"still\"\n").expect("a study");
    export(&study)
        .code(2)
        .stdout("")
        .stderr(contains("the study `still` defines no motion in [task]"));
    fs::write(
        &study,
        "[task]\nshape = \"waypoints\"\nwaypoints = [[0, 0, 30], [9, 0, 30]]\ncycle_time_s = 2\n",
    )
    .expect("a study");
    export(&study)
        .code(2)
        .stdout("")
        .stderr(contains("the motion ends in piece 1 at"));
}

/// Whether a motion lies in a prescribed rectangle is asked of the rectangle, not of the disc within it.
#[test]
fn a_motion_within_a_prescribed_rectangle_is_inside() {
    let folder = folder();
    let study = folder.path().join("stroke.toml");
    let inside = |half_stroke: f64| {
        let text = format!(
            "name = \"stroke\"\nobjectives = [{{ minimize = \"mass_kg\" }}]\n[task]\nshape = \"waypoints\"\nwaypoints = [[-{half_stroke}, 0.0, 35.0], [{half_stroke}, 0.0, 35.0]]\n\
             cycle_time_s = 2.0\n[workspace]\nhome_phi_deg = 35.0\n[workspace.region]\nkind = \"rectangle\"\nwidth_m = 0.6\nheight_m = 0.3\n"
        );
        fs::write(&study, text).expect("a study");
        let study = study.to_str().expect("a path");
        json(["task", "--design", DESIGN, "--study", study, "--json"])["inside_workspace"].clone()
    };
    assert_eq!(inside(0.3), true, "up to the side of the rectangle");
    assert_eq!(inside(0.301), false, "beyond it");
}

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
    let study = folder.path().join("study.toml");
    fs::write(
        &study,
        format!("{SELECTING}\n[drives]\ncatalogue = \"generic-drives\"\n"),
    )
    .expect("a study");
    let run = folder.path().join("run");
    optimize(&study, &run, &[]);
    let mut table = csv::Reader::from_path(run.join("front.csv")).expect("a table");
    let header = table.headers().expect("a header").clone();
    assert_eq!(header.iter().next_back(), Some("drive"));
    let rows: Vec<csv::StringRecord> = table.records().map(|row| row.expect("a row")).collect();
    assert!(!rows.is_empty());
    let of = |row: &csv::StringRecord, name: &str| {
        let place = header.iter().position(|title| title == name).expect("a column");
        row[place].to_owned()
    };
    let row = rows
        .iter()
        .find(|row| of(row, "architecture") == "3-R_RR")
        .unwrap_or(&rows[0]);
    let drive = of(row, "drive");
    assert!(!drive.is_empty());
    assert!(
        rows.iter()
            .all(|row| of(row, "drive_utilization").parse::<f64>().expect("a number") <= 1.0)
    );
    // Evaluated anew, it is the same design with the same drive.
    let design = design_of(|name| of(row, name));
    let path = study.to_str().expect("a path");
    let found = json([
        "evaluate", "--design", &design, "--study", path, "--grid", "fine", "--json",
    ]);
    assert_eq!(
        found["mass_kg"].as_f64().expect("a mass").to_string(),
        of(row, "mass_kg")
    );
    assert_eq!(found["task"]["drive"], drive);
    assert_eq!(
        found["quantities"]["drive_mass_kg"].to_string().parse::<f64>(),
        of(row, "drive_mass_kg").parse()
    );
    kinefront()
        .args(["task", "--design", &design, "--study", path, "--grid", "fine"])
        .assert()
        .success()
        .stdout(
            contains(&*drive)
                .and(contains(", utilization "))
                .and(contains("s, set by the limit of the utilization of the drives")),
        );
    let entry = format!("{}#{}", run.join("front.csv").display(), of(row, "id"));
    kinefront()
        .args(["export", &entry, "--format", "csv-parts", "--out", "-"])
        .assert()
        .success()
        .stdout(contains(&*drive));
    // A file for other programs states the same of the poses.
    let told = kinefront()
        .args(["export", &entry, "--format", "json", "--out", "-"])
        .assert()
        .success();
    let exported: Value = serde_json::from_slice(&told.get_output().stdout).expect("JSON");
    assert_eq!(exported["evaluation"]["over_workspace"], found["over_workspace"]);
    assert_eq!(exported["evaluation"]["task"], found["task"]);
    kinefront().arg("check").arg(&run).assert().success();
    // A table that names a drive that the catalogue does not have is not that of the run.
    let text = fs::read_to_string(run.join("front.csv")).expect("a table");
    fs::write(run.join("front.csv"), text.replace(&drive, "perpetual motion")).expect("a table");
    kinefront()
        .args(["export", &entry, "--format", "csv-parts", "--out", "-"])
        .assert()
        .code(2);
}

/// A catalogue beside the study is read with its comments, and what is wrong in it is told with its line.
#[test]
fn catalogues_of_drives_are_checked() {
    let folder = folder();
    let (study, catalogue) = (folder.path().join("study.toml"), folder.path().join("motors.csv"));
    fs::write(&study, format!("{SELECTING}\n[drives]\ncatalogue = \"motors.csv\"\n")).expect("a study");
    let header = "# Source: a maker\nname,kind,rated,peak,speed,inertia,mass_kg\n";
    let check = |rows: &str| {
        fs::write(&catalogue, format!("{header}{rows}")).expect("a catalogue");
        let mut command = kinefront();
        command.args(["study", "check"]).arg(&study).assert()
    };
    let slide = "axis,prismatic,100,300,2,1,4\n";
    check(&format!("{slide}joint, revolute, 100, 300, 20, 0.1, 4\n")).success();
    for (rows, words) in [
        (
            slide.to_owned(),
            "has no drive of the kind revolute, but the actuators of 3-R_RR turn",
        ),
        (
            format!("{slide}joint,rotary,1,2,3,0,1\n"),
            "line 4 of motors.csv is not an entry of a catalogue; its columns, separated by commas, are name, kind",
        ),
        (
            format!("{slide}joint,revolute,9,2,3,0,1\n"),
            "`joint` is not a valid drive",
        ),
        (
            format!("{slide}joint,revolute,1,2,NaN,0,1\n"),
            "`joint` is not a valid drive",
        ),
        (
            format!("{slide}axis,revolute,1,2,3,0,1\n"),
            "`axis` is the name of two drives",
        ),
        (String::new(), "it has no entry"),
    ] {
        check(&rows).code(2).stderr(contains(words).and(contains("catalogue")));
    }
    fs::write(&catalogue, format!("{header}{slide}")).expect("a catalogue");
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
        fs::write(&study, format!("architectures = [\"3-PRR\"]\n{text}")).expect("a study");
        let mut command = kinefront();
        command
            .args(["study", "check"])
            .arg(&study)
            .assert()
            .code(2)
            .stderr(contains(words));
    }
    // No drive is strong enough: the design is infeasible, and the program says by how much.
    fs::write(&catalogue, format!("{header}axis,prismatic,0.1,0.2,2,1,4\n")).expect("a catalogue");
    let text = SELECTING.replace(", \"3-R_RR\"", "");
    fs::write(&study, format!("{text}\n[drives]\ncatalogue = \"motors.csv\"\n")).expect("a study");
    let design = "3-PRR R=1.0 r=0.3 Lb=0.7 rj=0.03 rp=0.04";
    let path = study.to_str().expect("a path");
    kinefront()
        .args(["task", "--design", design, "--study", path])
        .assert()
        .success()
        .stdout(contains(
            "no drive of the catalogue can perform the motion; axis comes closest",
        ));
    let found = json(["evaluate", "--design", design, "--study", path, "--json"]);
    assert_eq!(found["feasible"], false);
    assert!(found["task"]["drive"].is_null());
    assert!(found["task"]["drive_utilization"].as_f64().expect("a number") > 1.0);
}
