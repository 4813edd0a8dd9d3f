//! Payload, motion, frequencies and accuracy, as a user of the program meets them.

use std::path::{Path, PathBuf};

use predicates::prelude::*;
use predicates::str::contains;
use serde_json::Value;

use super::exports::{DESIGNS, OTHERS};
use super::support::{DESIGN, Folder, folder, list, number, parsed, python, rows_of, sample, says, script_json, value};

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
    let found = number(found);
    let is_near = (found - wanted).abs() < 1e-6 * wanted.abs();
    assert!(is_near, "{found} instead of {wanted}");
}

/// `pose`, `evaluate` and `task` give what an independent program found for the same design.
#[test]
fn commands_give_independent_values() {
    let folder = folder();
    folder.write("moving.toml", STUDY);
    let line = |command: &str, more: &str| format!("{command} --design '{DESIGN}' --study moving.toml {more}");
    let of = |command: &str, more: &str| folder.json(&line(command, &format!("{more} --json")));
    let pose = of(
        "pose",
        "--pose 'x=-0.059 y=-0.0521 phi_deg=39.68' --twist 'vx=0.113 vy=-1.22 omega=0.305' \
         --acceleration 'ax=4.758 ay=0.712 alpha=-5.472'",
    );
    near(&pose["frequencies_hz"][0], 15.614158288064678);
    near(&pose["frequencies_hz"][3], 8.475001866114397);
    near(&pose["actuator_forces"][2], -1854.8122470604092);
    near(&pose["pose_error"]["worst_xy_m"], 0.00024555959650917643);
    let evaluated = of("evaluate", "");
    near(&evaluated["over_workspace"]["f1"]["value"], 8.181517922480754);
    near(&evaluated["quantities"]["natural_frequency_hz"], 8.181517922480754);
    near(&evaluated["over_workspace"]["footprint_m2"], 19.88929035526777);
    near(&evaluated["quantities"]["motion_force_max_n"], 6864.787152288396);
    near(&evaluated["task"]["corner_power_w"], 15797.342239571883);
    let task = of("task", "");
    assert_eq!(task["ok"], true);
    near(&task["energy_shared_j"], 14085.007102823249);
    let samples = list(&task["samples"]);
    assert_eq!(samples.len(), 5 * 201);
    near(&samples[70]["tau1"], -1995.0279436305827);
    // The table of the curves holds the same samples.
    let table = folder.run(&line("task", "--csv")).success();
    let rows = rows_of(&table.get_output().stdout);
    assert_eq!((rows.len(), rows[0].len()), (samples.len(), 26));
    assert_eq!(Some(value(&rows[70], "tau1")), samples[70]["tau1"].as_f64());
}

/// A motion is proved with bounds near its samples, and what the samples miss refutes it.
#[test]
fn a_motion_is_proved_between_its_samples() {
    let folder = folder();
    let of = |more: &str| {
        folder.write("moving.toml", format!("{STUDY}{more}"));
        let found = folder.json(&format!("task --design '{DESIGN}' --study moving.toml --json"));
        let figure = |key: &str| list(&found[key]).iter().map(number).fold(0.0, f64::max);
        (found["proof"].clone(), figure("peak_speed"), figure("peak_force"))
    };
    let (proof, speed, force) = of("");
    assert_eq!(proof["verdict"], "proved");
    for (key, peak) in [("speed_at_most", speed), ("force_at_most", force)] {
        let bound = number(&proof[key]);
        assert!((peak..1.002 * peak).contains(&bound), "{key}: {bound} for {peak}");
    }
    // Six samples of a piece miss its largest speed by more than a hundredth.
    let limit = 0.995 * speed;
    let (proof, rough, _) = of(&format!(
        "samples = 5\n[constraints.path_speed_max_m_per_s]\nat_most = {limit}\n"
    ));
    assert!(rough < 0.99 * speed, "{rough} of {speed}");
    assert_eq!(proof["verdict"], "refuted", "{proof}");
    assert_eq!(proof["claim"], "path_speed_max_m_per_s");
    assert!(proof["speed_at_most"].is_null());
    assert!((0.0..5.0).contains(&number(&proof["time_s"])));
}

/// Follows the motion of a study with these settings.
fn follow(folder: &Folder, settings: &str, more: &str) -> assert_cmd::assert::Assert {
    folder.write("study.toml", settings);
    folder.run(&format!("task --design '{DESIGN}' --study study.toml {more}"))
}

/// What makes no sense is said with its place and its remedy.
#[test]
fn motions_that_make_no_sense_are_refused() {
    let folder = folder();
    let waypoints =
        |keys: &str, points: String| format!("[task]\nshape = \"waypoints\"\n{keys}\nwaypoints = [{points}]\n");
    let many = |pairs: usize| "[0, 0, 0], [0.01, 0, 0], ".repeat(pairs);
    for (text, words) in [
        ("", "defines no motion"),
        (
            "[task]\ncycle_time_s = 1",
            "is missing; without it, nothing else in [task] has an effect",
        ),
        ("[task]\nshape = \"star\"", "is missing; set it, or limits"),
        ("[task]\nshape = \"star\"\ncycle_time_s = 0", "must be above 0"),
        (
            "[task]\nshape = \"star\"\ncycle_time_s = 1\ndwell_s = 0.2",
            "the rests after 5 pieces take 1 s of it",
        ),
        (
            "[task]\nshape = \"waypoints\"\ncycle_time_s = 1",
            "needs at least two different points",
        ),
        (
            &waypoints("v_max_m_per_s = 1", "[0, 0, 0], [0, 0, 9]".to_owned()),
            "nothing else limits how fast",
        ),
        (
            "[task]\nshape = \"star\"\ncycle_time_s = 1\nsamples = 100001",
            "must be 2 to 100000",
        ),
        (
            &waypoints("cycle_time_s = 1\nsamples = 100000", many(10)),
            "a motion has at most 1000000 samples",
        ),
        (
            &waypoints("cycle_time_s = 1e5", many(50_000)),
            "it has more than 262144",
        ),
        (
            "[constraints]\nenergy_j = { at_most = 5 }",
            "has no value without a motion; state it in [task]",
        ),
        (
            "[constraints]\nposition_error_m = { at_most = 1e-3 }",
            "is 0 without tolerances; state them in [tolerances]",
        ),
        ("[payload]\nmass_kg = -1", "mass_kg"),
    ] {
        follow(&folder, text, "").code(2).stderr(says(words));
    }
}

/// A motion that leaves the reach.
const TOO_FAR: &str = "[task]\nshape = \"waypoints\"\nwaypoints = [[0, 0, 30], [9, 0, 30]]\ncycle_time_s = 2\n";

/// A motion that leaves the reach is a result: where, when and why, and no other figure.
#[test]
fn motions_that_are_impossible_are_told() {
    let folder = folder();
    let ends = || contains("the motion ends in piece 1");
    let told = follow(&folder, TOO_FAR, "").success();
    told.stdout(contains("not possible").and(contains("the motion ends in piece 1 at")));
    follow(&folder, TOO_FAR, "--csv").success().stdout("").stderr(ends());
    let found = parsed(&follow(&folder, TOO_FAR, "--json").success());
    assert_eq!(found["ok"], false);
    assert_eq!(found["piece"], 1);
    assert!(found["time_s"].is_number() && found["reason"].is_string());
    assert!(found["cycle_time_s"].is_null() && found["peak_force"].is_null() && found["energy_net_j"].is_null());
    // A payload beyond all machines gives numbers.
    let heavy = "[payload]\nmass_kg = 1e9\n[task]\nshape = \"circle\"\ncycle_time_s = 2\n";
    let found = parsed(&follow(&folder, heavy, "--json").success());
    assert!(number(&found["peak_force"][0]) > 1e8);
}

/// Exports a design for `study.toml` in a format.
fn export_to(folder: &Folder, name: &str, design: &str, format: &str) -> PathBuf {
    let line = format!("export --design '{design}' --format {format} --study study.toml --out {name}");
    folder.run(&line).success();
    folder.join(name)
}

/// MuJoCo needs the same forces of the actuators for the same motion of the exported mechanisms, with joints, motors and gravity in the
/// plane: it knows their bodies alone.
#[test]
fn mujoco_needs_the_same_forces() {
    let Some(interpreter) = python(&["mujoco", "numpy"]) else {
        return;
    };
    let folder = folder();
    let text = "[joints]\nrevolute_kg = 0.5\ncarriage_kg = 1.5\nmotor_kg = 2.5\n\
                [payload]\nmass_kg = 4.0\ninertia_kg_m2 = 0.2\ncentre_m = [0.11, -0.07]\n\
                [drives]\nslider_mass_kg = 1.2\nprismatic_inertia_kg = 0.7\nrevolute_inertia_kg_m2 = 0.3\n\
                [loads]\ngravity_m_per_s2 = [1.5, -4.0, -9.81]\n";
    folder.write("study.toml", text);
    let text = r#"{"twist": [0.3, -0.4, 0.5], "acceleration": [2.0, 3.0, -4.0], "gravity": [1.5, -4.0, -9.81]}"#;
    let motion = folder.write("motion.json", text);
    // The file for MuJoCo gives the carriage of this one half of the mass of its guide, because a driven body needs inertia.
    let others = OTHERS.into_iter().filter(|design| !design.starts_with("3-P_PR"));
    let designs: Vec<&str> = DESIGNS.iter().map(|(design, _)| *design).chain(others).collect();
    assert_eq!(designs.len(), 17);
    let exported = designs.iter().enumerate();
    let exported = exported.map(|(index, design)| export_to(&folder, &format!("{index}.xml"), design, "mjcf"));
    let files: Vec<PathBuf> = std::iter::once(motion).chain(exported).collect();
    let arguments: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
    let found = script_json(interpreter, "mujoco_forces.py", &arguments);
    assert_eq!(list(&found).len(), designs.len());
    for (design, found) in designs.iter().zip(list(&found)) {
        let [x, y, phi] = [0, 1, 2].map(|place| number(&found["pose"][place]));
        let ours = folder.json(&format!(
            "pose --design '{design}' --pose 'x={x} y={y} phi_deg={}' --study study.toml --twist 'vx=0.3 vy=-0.4 omega=0.5' \
             --acceleration 'ax=2 ay=3 alpha=-4' --json",
            phi.to_degrees()
        ));
        for (key, of_mujoco, tolerance) in [("actuator_speeds", "speeds", 1e-9), ("actuator_forces", "forces", 1e-6)] {
            let largest = (0..3).fold(0.0f64, |most, leg| most.max(number(&ours[key][leg]).abs()));
            for leg in 0..3 {
                let off = (number(&ours[key][leg]) - number(&found[of_mujoco][leg])).abs();
                assert!(off < tolerance * largest, "{design}: {key} {} and {found}", ours[key]);
            }
        }
        let off = number(&found["off"]);
        assert!(off < 1e-9, "{design}: the loops are not closed: {found}");
    }
}

/// A machine with a payload, motors and drives that follows a star and rests at its corners.
const STAR: &str = "[joints]\nrevolute_kg = 0.5\ncarriage_kg = 1.5\nmotor_kg = 2.5\n\
    [payload]\nmass_kg = 4.0\ninertia_kg_m2 = 0.2\ncentre_m = [0.11, -0.07]\n\
    [drives]\nslider_mass_kg = 1.2\nprismatic_inertia_kg = 2.0\nrevolute_inertia_kg_m2 = 2.0\n\
    [loads]\ngravity_m_per_s2 = [0.0, -9.81, 0.0]\n\
    [task]\nshape = \"star\"\nshare = 0.5\ncycle_time_s = 3.0\ndwell_s = 0.05\n";

/// A trajectory has a row each millisecond, also where the durations of its pieces add up to the cycle but for rounding.
#[test]
fn a_trajectory_has_a_row_each_millisecond() {
    let folder = folder();
    folder.write("study.toml", STAR);
    for design in DESIGNS.iter().map(|(design, _)| *design).chain(OTHERS) {
        let line = format!("export --design '{design}' --format csv-trajectory --out - --study study.toml");
        let told = folder.run(&line).success();
        let rows = rows_of(&told.get_output().stdout);
        assert_eq!(rows.len(), 3001, "{design}");
        assert!((value(&rows[3000], "t_s") - 3.0).abs() < 1e-12, "{design}");
    }
}

/// A controller that takes the reference trajectory moves the exported mechanism along its path in MuJoCo, with the payload and the rotors,
/// and the keyframes are the poses at which it rests.
#[test]
fn mujoco_follows_the_reference_trajectory() {
    let Some(_) = python(&["mujoco", "numpy"]) else { return };
    let folder = folder();
    folder.write("study.toml", STAR);
    let designs: Vec<&str> = DESIGNS.iter().map(|(design, _)| *design).chain(OTHERS).collect();
    for design in sample(designs.into_iter(), 4) {
        let name = design.split(' ').next().expect("a name");
        let model = export_to(&folder, &format!("{name}.xml"), design, "mjcf");
        let trajectory = export_to(&folder, &format!("{name}.csv"), design, "csv-trajectory");
        let python = python(&["mujoco", "numpy"]).expect("Python, which was found before");
        let found = script_json(python, "mujoco_motion.py", &[&model, &trajectory]);
        let is_below = |key: &str, limit: f64| assert!(number(&found[key]) < limit, "{design}: {key}: {found}");
        is_below("farthest_m", 1e-3);
        is_below("turned_rad", 1e-3);
        // The keyframes close the loops.
        is_below("open_m", 1e-9);
        is_below("off_rest_m", 1e-9);
        assert!(number(&found["travelled_m"]) > 0.1, "{design}: {found}");
        assert_eq!(found["rests"], 6, "{design}");
        assert_eq!(found["rows"], 3001, "{design}");
    }
}

/// Without a motion, and with one that leaves the reach, there is no trajectory.
#[test]
fn a_trajectory_needs_a_motion() {
    let folder = folder();
    for (study, words) in [
        ("name = \"still\"\n", "the study `still` defines no motion in [task]"),
        (TOO_FAR, "the motion ends in piece 1 at"),
    ] {
        folder.write("study.toml", study);
        let line = format!("export --design '{DESIGN}' --format csv-trajectory --out - --study study.toml");
        folder.run(&line).code(2).stdout("").stderr(says(words));
    }
}

/// Whether a motion lies in a prescribed rectangle is asked of the rectangle, not of the disc within it.
#[test]
fn a_motion_within_a_prescribed_rectangle_is_inside() {
    let folder = folder();
    let inside = |half_stroke: f64| {
        let text = format!(
            "name = \"stroke\"\nobjectives = [{{ minimize = \"mass_kg\" }}]\n[task]\nshape = \"waypoints\"\nwaypoints = [[-{half_stroke}, 0.0, 35.0], [{half_stroke}, 0.0, 35.0]]\n\
             cycle_time_s = 2.0\n[workspace]\nhome_phi_deg = 35.0\n[workspace.region]\nkind = \"rectangle\"\nwidth_m = 0.6\nheight_m = 0.3\n"
        );
        parsed(&follow(&folder, &text, "--json").success())["inside_workspace"].clone()
    };
    assert_eq!(inside(0.3), true, "up to the side of the rectangle");
    assert_eq!(inside(0.301), false, "beyond it");
}
