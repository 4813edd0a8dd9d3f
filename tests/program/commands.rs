//! Tests of `evaluate`, `pose` and `study`, and of invalid input.

use predicates::prelude::*;
use predicates::str::contains;
use serde_json::Value;

use super::support::{DESIGN, folder, json, kinefront, small_study};

fn keys(value: &Value) -> Vec<&str> {
    value
        .as_object()
        .expect("an object")
        .keys()
        .map(String::as_str)
        .collect()
}

#[test]
fn evaluate_has_the_keys_others_rely_on() {
    let found = json(["evaluate", "--design", DESIGN, "--json"]);
    for key in [
        "architecture",
        "design",
        "working_mode",
        "mass_kg",
        "workspace_radius_m",
        "home",
        "feasible",
        "constraints",
    ] {
        assert!(found.get(key).is_some(), "{key} is missing");
    }
    let mut design = keys(&found["design"]);
    design.sort_unstable();
    assert_eq!(design, ["Lb", "R", "r", "rj", "rp"]);
    assert_eq!(found["architecture"], "3-PRR");
    assert_eq!(found["working_mode"], serde_json::json!([1, 1, 1]));
    assert_eq!(found["feasible"], true);
    assert!((found["workspace_radius_m"].as_f64().expect("a number") - 1.220097).abs() < 1e-5);
    assert_eq!(
        found["home"],
        serde_json::json!({"x_m": 0.0, "y_m": 0.0, "phi_deg": 30.0})
    );
    let constraints = found["constraints"].as_array().expect("a list");
    let ids: Vec<&str> = constraints.iter().map(|c| c["id"].as_str().expect("an id")).collect();
    assert_eq!(ids, ["g1", "g2", "g3", "g4", "g5", "g6", "det_sign"]);
    for constraint in constraints {
        for key in ["id", "name", "value", "threshold", "margin", "active", "pose"] {
            assert!(constraint.get(key).is_some(), "{key} is missing");
        }
    }
}

#[test]
fn evaluate_on_the_fine_grid_and_under_another_study() {
    let fine = json(["evaluate", "--design", DESIGN, "--grid", "fine", "--json"]);
    assert!((fine["workspace_radius_m"].as_f64().expect("a number") - 1.221138).abs() < 1e-5);
    let light = json([
        "evaluate",
        "--design",
        DESIGN,
        "--study",
        "aluminium-pick-and-place",
        "--json",
    ]);
    let ratio = light["mass_kg"].as_f64().expect("a number") / fine["mass_kg"].as_f64().expect("a number");
    assert!((ratio - 2700.0 / 7850.0).abs() < 1e-12);
}

#[test]
fn an_infeasible_design_is_data() {
    let found = json(["evaluate", "--design", "3-RRR R=4 r=0.1 Lb=0.5 rj=0 rp=0", "--json"]);
    assert_eq!(found["feasible"], false);
    assert_eq!(found["home"], Value::Null);
    assert_eq!(found["workspace_radius_m"], 0.0);
    assert!(found["violation"].as_f64().expect("a number") > 0.0);
}

#[test]
fn a_stream_answers_line_by_line_and_survives_bad_lines() {
    let input = format!("{DESIGN}\nnonsense\n\n3-RPR R=1 r=1 Lb=1 rj=nan rp=1\n\u{fffd}\n{DESIGN} mode=---\n");
    let mut bytes = input.into_bytes();
    bytes.extend(b"\xff\xfe\n");
    let output = kinefront()
        .args(["evaluate", "--stdin"])
        .write_stdin(bytes)
        .assert()
        .success()
        .get_output()
        .stdout
        .clone();
    let lines: Vec<Value> = String::from_utf8(output)
        .expect("UTF-8")
        .lines()
        .map(|line| serde_json::from_str(line).expect("one JSON object per line"))
        .collect();
    assert_eq!(lines.len(), 7);
    for (index, line) in lines.iter().enumerate() {
        assert_eq!(
            line.get("error").is_none(),
            [0, 5].contains(&index),
            "line {index}: {line}"
        );
    }
    assert!(lines[3]["error"].as_str().expect("a message").contains("rj is NaN"));
    assert_eq!(lines[5]["working_mode"], serde_json::json!([-1, -1, -1]));
}

#[test]
fn pose_lists_all_assembly_modes() {
    let design = "3-RPR R=1 r=0.4 Lb=1.4 rj=0.02 rp=0.02";
    let run = |actuators: &str| {
        let mut command = kinefront();
        command.args(["pose", "--design", design, "--actuators", actuators, "--json"]);
        command
    };
    let output = run("q1=0.9 q2=1.0 q3=1.1")
        .assert()
        .success()
        .get_output()
        .stdout
        .clone();
    let found: Value = serde_json::from_slice(&output).expect("JSON");
    let modes = found["modes"].as_array().expect("modes");
    assert_eq!(modes.len(), 2);
    for mode in modes {
        let (pose, number) = (&mode["pose"], |value: &Value| value.as_f64().expect("a number"));
        let text = format!(
            "x={} y={} phi_deg={}",
            number(&pose["x_m"]),
            number(&pose["y_m"]),
            number(&pose["phi_deg"])
        );
        let output = kinefront()
            .args(["pose", "--design", design, "--pose", &text, "--json"])
            .assert()
            .success()
            .get_output()
            .stdout
            .clone();
        let report: Value = serde_json::from_slice(&output).expect("JSON");
        for (leg, wanted) in [0.9, 1.0, 1.1].into_iter().enumerate() {
            assert!((number(&report["actuators"][leg]) - wanted).abs() < 1e-9, "{report}");
        }
        assert_eq!(mode["of_this_design"], true);
        assert_eq!(mode["working_mode"], serde_json::json!([1, 1, 1]));
    }
    run("q1=0.9 q2=1.0")
        .assert()
        .code(2)
        .stderr(contains("`q3` is missing"));
    run("q1=0.9 q2=1.0 rho=1")
        .assert()
        .code(2)
        .stderr(contains("expected q1, q2 and q3"));
}

#[test]
fn pose_tells_joints_and_stiffness() {
    let found = json(["pose", "--design", DESIGN, "--pose", "x=0.1 y=0.2 phi_deg=30", "--json"]);
    assert_eq!(found["reachable"], true);
    assert_eq!(found["reason"], Value::Null);
    assert_eq!(found["actuators"].as_array().expect("a list").len(), 3);
    assert_eq!(found["B"].as_array().expect("a list").len(), 3);
    assert_eq!(found["stiffness"].as_array().expect("a list").len(), 6);
    let k = |i: usize, j: usize| found["stiffness"][i][j].as_f64().expect("a number");
    // The values and the matrix come from two forms, whose last digits may differ.
    for (place, key) in [(2, "k_z"), (5, "k_phi_z")] {
        let value = found[key].as_f64().expect("a number");
        assert!((k(place, place) / value - 1.0).abs() < 1e-14, "{key}");
    }
    assert_eq!(k(0, 5), k(5, 0));
    assert_eq!(k(0, 2), 0.0);

    let far = json(["pose", "--design", DESIGN, "--pose", "x=0 y=9 phi_deg=0", "--json"]);
    assert_eq!(far["reachable"], false);
    assert!(far["reason"].as_str().expect("a reason").contains("out of reach"));
    for key in [
        "actuators",
        "B",
        "C",
        "inverse_condition",
        "k_xy",
        "k_z",
        "k_phi_z",
        "stiffness",
    ] {
        assert_eq!(far.get(key), Some(&Value::Null), "{key}");
    }

    // B of a 3-RPR is A, and a violated stroke limit is reported.
    let telescopic = "3-RPR R=1.5 r=0.3 Lb=2 rj=0.03 rp=0.03";
    let near = json(["pose", "--design", telescopic, "--pose", "x=0 y=0 phi_deg=0", "--json"]);
    assert!((near["B"][2][1].as_f64().expect("a number") - 1.5).abs() < 1e-12);
    let beyond = json([
        "pose",
        "--design",
        telescopic,
        "--pose",
        "x=0 y=0.5 phi_deg=0",
        "--json",
    ]);
    assert!(
        beyond["reason"]
            .as_str()
            .expect("a reason")
            .contains("leg 3: prismatic joint")
    );
}

#[test]
fn people_get_tables() {
    kinefront()
        .args(["evaluate", "--design", DESIGN])
        .assert()
        .success()
        .stdout(
            contains("R_w = 1.22010 m")
                .and(contains("dexterity"))
                .and(contains("479.472 kg")),
        );
    kinefront()
        .args(["pose", "--design", DESIGN, "--pose", "x=0 y=0 phi_deg=30"])
        .assert()
        .success()
        .stdout(contains("inverse condition").and(contains("φz")));
}

/// Invalid input gives exit code 2 and a message that says what is wrong and what would be right.
#[test]
fn wrong_input_is_refused_in_words() {
    let cases: [(&[&str], &str); 16] = [
        (
            &["evaluate", "--design", "3-PPP R=1"],
            "expected one of 3-PRR, 3-RPR, 3-RRR",
        ),
        (
            &["evaluate", "--design", "3-PRR R=1 r=1 Lb=1 rj=0.1"],
            "`rp` is missing",
        ),
        (
            &["evaluate", "--design", "3-PRR R=-1 r=1 Lb=1 rj=0.1 rp=0.1"],
            "above 0 m",
        ),
        (&["evaluate"], "--design"),
        (&["evaluate", "--design", DESIGN, "--grid", "coarse"], "reference"),
        (
            &["evaluate", "--design", DESIGN, "--study", "nowhere.toml"],
            "paper-bounds-as-printed",
        ),
        (
            &["pose", "--design", DESIGN, "--pose", "x=0 y=0"],
            "`phi_deg` is missing",
        ),
        (
            &["pose", "--design", DESIGN, "--pose", "x=0 y=inf phi_deg=0"],
            "must be finite",
        ),
        (&["optimize", "--threads", "0"], "a whole number from 1 to 1024"),
        (&["optimize", "--evaluations", "0"], "from 1 to 100000000"),
        (&["optimize", "--evaluations", "-5"], "from 1 to 100000000"),
        (&["optimize", "--evaluations", "1e5"], "did you mean `100000`?"),
        (
            &["report", "--picture-width", "90000"],
            "a whole number from 160 to 8000",
        ),
        (&["optimize", "--architectures", "3-PRR,4-RRR"], "unknown architecture"),
        (
            &["optimize", "--architectures", "3-PRR,3-PRR"],
            "contains \"3-PRR\" twice",
        ),
        (&["study", "show", "none"], "paper"),
    ];
    for (arguments, words) in cases {
        kinefront().args(arguments).assert().code(2).stderr(contains(words));
    }
}

#[test]
fn a_wrong_study_shows_file_line_and_key() {
    let folder = folder();
    let file = folder.path().join("wrong.toml");
    std::fs::write(&file, "name = \"wrong\"\n\n[bounds]\nR_m = [4, 1]\n").expect("a file");
    for command in [vec!["study", "check"], vec!["optimize"]] {
        kinefront()
            .current_dir(folder.path())
            .args(command)
            .arg("wrong.toml")
            .assert()
            .code(2)
            .stderr(contains("wrong.toml:4").and(contains("bounds.R_m")));
    }
    assert_eq!(
        std::fs::read_dir(folder.path()).expect("a folder").count(),
        1,
        "a rejected study leaves no files behind"
    );
}

#[test]
fn study_new_writes_a_commented_study_and_overwrites_nothing() {
    let folder = folder();
    let new = |expected: i32| {
        kinefront()
            .current_dir(folder.path())
            .args(["study", "new", "mine.toml"])
            .assert()
            .code(expected);
    };
    new(0);
    let text = std::fs::read_to_string(folder.path().join("mine.toml")).expect("the file");
    assert!(text.contains("# g4: a force in the plane"));
    kinefront()
        .current_dir(folder.path())
        .args(["study", "check", "mine.toml"])
        .assert()
        .success();
    std::fs::write(folder.path().join("mine.toml"), "mine").expect("a file");
    new(2);
    assert_eq!(
        std::fs::read_to_string(folder.path().join("mine.toml")).expect("the file"),
        "mine"
    );
    kinefront()
        .args(["study", "list"])
        .assert()
        .success()
        .stdout(contains("aluminium-pick-and-place"));
}

#[test]
fn an_occupied_run_folder_is_left_alone() {
    let folder = folder();
    let study = small_study(folder.path());
    let out = folder.path().join("run");
    std::fs::create_dir(&out).expect("a folder");
    std::fs::write(out.join("front.csv"), "precious").expect("a file");
    kinefront()
        .arg("optimize")
        .arg(&study)
        .arg("--out")
        .arg(&out)
        .assert()
        .code(2)
        .stderr(contains("already holds a run"));
    assert_eq!(
        std::fs::read_to_string(out.join("front.csv")).expect("the file"),
        "precious"
    );
    assert_eq!(std::fs::read_dir(&out).expect("a folder").count(), 1);
}

/// The clearance is reported whether or not g7 is required; g7 is required only by a study that states a clearance.
#[test]
fn evaluate_and_pose_tell_the_nearest_bodies() {
    let free = json(["evaluate", "--design", DESIGN, "--json"]);
    let study = ["--study", "paper-without-collisions"];
    let required = json([&["evaluate", "--design", DESIGN, "--json"][..], &study].concat());
    for found in [&free, &required] {
        let clearance = found["clearance_m"].as_f64().expect("a number");
        let pair = found["clearance_pair"].as_array().expect("a pair");
        assert_eq!(pair.len(), 2);
        assert!(pair[0].as_str().expect("a name").starts_with("leg"), "{pair:?}");
        assert_eq!(clearance < 0.0, std::ptr::eq(found, &free), "{clearance}");
    }
    let g7 = required["constraints"].as_array().expect("a list").last().expect("g7");
    assert_eq!(g7["id"], "g7");
    assert_eq!(g7["threshold"], 0.005);
    assert_eq!(g7["value"], required["clearance_m"]);
    assert!(g7["margin"].as_f64().expect("a number") >= 0.0);
    assert!(g7["pose"]["phi_deg"].is_number());
    assert!(required["workspace_radius_m"].as_f64() < free["workspace_radius_m"].as_f64());

    // At the pose with the smallest clearance, `pose` reports the same clearance.
    let pose = &g7["pose"];
    let text = format!("x={} y={} phi_deg={}", pose["x_m"], pose["y_m"], pose["phi_deg"]);
    let at = json(["pose", "--design", DESIGN, "--pose", &text, "--json"]);
    assert_eq!(at["clearance_pair"], required["clearance_pair"]);
    let difference = at["clearance_m"].as_f64().expect("a number") - g7["value"].as_f64().expect("a number");
    assert!(difference.abs() < 1e-9, "{difference}");
    let nowhere = json(["pose", "--design", DESIGN, "--pose", "x=9 y=0 phi_deg=0", "--json"]);
    assert_eq!(nowhere["clearance_m"], Value::Null);
    assert_eq!(nowhere["clearance_pair"], Value::Null);
}

#[test]
fn bodies_that_cannot_be_are_told_with_their_keys() {
    let text = "[requirements]\nclearance_min_m = -0.1\n[bodies]\nslider_length = 1.0\n[bodies.layers]\ncrank = inf\n";
    let folder = folder();
    let path = folder.path().join("study.toml");
    std::fs::write(&path, text).expect("a file");
    let failed = kinefront().args(["study", "check"]).arg(&path).assert().code(2);
    let words = String::from_utf8_lossy(&failed.get_output().stderr).into_owned();
    for part in [
        "requirements.clearance_min_m",
        "bodies.slider_length",
        "bodies.layers.crank",
        "study.toml:2",
    ] {
        assert!(words.contains(part), "{part} is not in {words}");
    }
}

/// Certificates have the keys that others rely on; a stream answers in order, on all cores.
#[test]
fn certificates_answer_one_design_or_a_stream() {
    let found = json(["certify", "--design", DESIGN, "--json"]);
    assert_eq!(
        keys(&found),
        [
            "architecture",
            "boxes",
            "claim",
            "claimed_radius_m",
            "closed",
            "design",
            "home",
            "lower_m",
            "relative_gap",
            "seconds",
            "tolerance",
            "upper_m",
            "verdict",
            "violation",
            "why",
            "working_mode"
        ]
    );
    assert_eq!(
        keys(&found["violation"]),
        ["id", "margin", "phi_deg", "phi_rad", "x_m", "y_m"]
    );
    let number = |key: &str| found[key].as_f64().expect("a number");
    assert!(number("lower_m") <= 1.221_104_6 && number("upper_m") >= 1.221_103_3);
    assert_eq!(found["verdict"], "proved");
    assert!(found["violation"]["margin"].as_f64().expect("a number") < 0.0);

    // A radius that is claimed too large is refuted; without boxes nothing is proved.
    let claim = json([
        "certify",
        "--design",
        DESIGN,
        "--radius",
        "1.3",
        "--phi-deg",
        "29.5",
        "--json",
    ]);
    assert_eq!(claim["verdict"], "refuted");
    let few = json(["certify", "--design", DESIGN, "--max-boxes", "3", "--json"]);
    assert_eq!(
        (few["verdict"].as_str(), few["why"].as_str()),
        (Some("open"), Some("budget"))
    );
    assert!(few["lower_m"].as_f64().expect("a number") < 1.22);
    let homes = json(["certify", "--design", DESIGN, "--all-homes", "--json"]);
    let bound = homes["upper_all_homes_m"].as_f64().expect("a number");
    assert!(bound > number("lower_m") && bound < 1.225, "{bound}");

    // The pocket of a design of a front: the grid claims 0.7147 m, of which 0.6423 m are there.
    let pocket = "3-RRR R=1.0094566953033497 r=0.13093847935116149 Lb=0.7999739586075939 rj=0.03839109236004963 rp=0.02315007385818249";
    let lines = format!("{DESIGN}\nnonsense\n{pocket}\n3-PRR R=9 r=0.5 Lb=1 rj=0.03 rp=0.03\n");
    let told = kinefront()
        .args(["certify", "--stdin"])
        .write_stdin(lines.repeat(5))
        .assert()
        .success();
    let answers = String::from_utf8_lossy(&told.get_output().stdout).into_owned();
    let answers: Vec<Value> = answers
        .lines()
        .map(|line| serde_json::from_str(line).expect("JSON"))
        .collect();
    assert_eq!(answers.len(), 20);
    for four in answers.chunks(4) {
        assert_eq!(four[0]["verdict"], "proved");
        assert!(
            four[1]["error"]
                .as_str()
                .is_some_and(|words| words.contains("nonsense")),
            "{}",
            four[1]
        );
        assert_eq!(four[2]["verdict"], "refuted");
        assert!(four[2]["upper_m"].as_f64().expect("a number") < 0.643);
        // A design that cannot be assembled has no disc.
        assert_eq!(
            (four[3]["lower_m"].as_f64(), four[3]["upper_m"].as_f64()),
            (Some(0.0), Some(0.0))
        );
    }

    kinefront()
        .args(["certify", "--design", DESIGN, "--study", "paper-without-collisions"])
        .assert()
        .success()
        .stdout(contains("claimed R_w").and(contains("is proved infeasible")));
    kinefront()
        .args(["certify", "--design", DESIGN, "--tolerance", "-1"])
        .assert()
        .code(2)
        .stderr(contains("tolerance"));
}

/// A reader that goes away ends the stream, though designs keep coming.
#[cfg(unix)]
#[test]
fn a_stream_of_certificates_ends_with_its_reader() {
    let script = format!(
        "yes '{DESIGN}' | '{}' certify --stdin | head -2 | wc -l",
        env!("CARGO_BIN_EXE_kinefront")
    );
    let told = std::process::Command::new("sh")
        .args(["-c", &script])
        .output()
        .expect("a shell");
    assert_eq!(String::from_utf8_lossy(&told.stdout).trim(), "2");
}
