//! Tests of `evaluate`, `pose` and `study`, and of invalid input.

use predicates::prelude::*;
use predicates::str::contains;
use serde_json::Value;

use super::support::{DESIGN, folder, json, kinefront, list, number, parsed, run, said, says, small_study};

#[test]
fn evaluate_has_the_keys_others_rely_on() {
    let found = json(&format!("evaluate --design '{DESIGN}' --json"));
    let promised = "architecture design working_mode mass_kg workspace_radius_m home feasible constraints";
    for key in promised.split(' ') {
        assert!(found.get(key).is_some(), "{key} is missing");
    }
    let mut design = keys(&found["design"]);
    design.sort_unstable();
    assert_eq!(design, ["Lb", "R", "r", "rj", "rp"]);
    assert_eq!(found["architecture"], "3-PRR");
    assert_eq!(found["working_mode"], serde_json::json!([1, 1, 1]));
    assert_eq!(found["feasible"], true);
    assert!((number(&found["workspace_radius_m"]) - 1.220097).abs() < 1e-5);
    assert_eq!(
        found["home"],
        serde_json::json!({"x_m": 0.0, "y_m": 0.0, "phi_deg": 30.0})
    );
    let constraints = list(&found["constraints"]);
    let ids: Vec<&str> = constraints.iter().map(|c| c["id"].as_str().expect("an id")).collect();
    assert_eq!(ids, ["g1", "g2", "g3", "g4", "g5", "g6", "det_sign"]);
    for constraint in constraints {
        for key in ["id", "name", "value", "threshold", "margin", "active", "pose"] {
            assert!(constraint.get(key).is_some(), "{key} is missing");
        }
    }
}

fn keys(value: &Value) -> Vec<&str> {
    let object = value.as_object().expect("an object");
    object.keys().map(String::as_str).collect()
}

#[test]
fn evaluate_on_the_fine_grid_and_under_another_study() {
    let fine = json(&format!("evaluate --design '{DESIGN}' --grid fine --json"));
    assert!((number(&fine["workspace_radius_m"]) - 1.221138).abs() < 1e-5);
    let light = json(&format!(
        "evaluate --design '{DESIGN}' --study aluminium-pick-and-place --json"
    ));
    let ratio = number(&light["mass_kg"]) / number(&fine["mass_kg"]);
    assert!((ratio - 2700.0 / 7850.0).abs() < 1e-12);
}

#[test]
fn an_infeasible_design_is_data() {
    let found = json("evaluate --design '3-RRR R=4 r=0.1 Lb=0.5 rj=0 rp=0' --json");
    assert_eq!(found["feasible"], false);
    assert_eq!(found["home"], Value::Null);
    assert_eq!(found["workspace_radius_m"], 0.0);
    assert!(number(&found["violation"]) > 0.0);
}

/// What a command answers to the lines of a stream.
fn answers(command: &str, input: impl Into<Vec<u8>>) -> Vec<Value> {
    let told = kinefront()
        .args([command, "--stdin"])
        .write_stdin(input)
        .assert()
        .success();
    let output = String::from_utf8(told.get_output().stdout.clone()).expect("UTF-8");
    let answer = |line| serde_json::from_str(line).expect("one JSON object per line");
    output.lines().map(answer).collect()
}

#[test]
fn a_stream_answers_line_by_line_and_survives_bad_lines() {
    let input = format!("{DESIGN}\nnonsense\n\n3-RPR R=1 r=1 Lb=1 rj=nan rp=1\n\u{fffd}\n{DESIGN} mode=---\n");
    let mut bytes = input.into_bytes();
    bytes.extend(b"\xff\xfe\n");
    let lines = answers("evaluate", bytes);
    assert_eq!(lines.len(), 7);
    for (index, line) in lines.iter().enumerate() {
        let is_answered = [0, 5].contains(&index);
        assert_eq!(line.get("error").is_none(), is_answered, "line {index}: {line}");
    }
    assert!(lines[3]["error"].as_str().expect("a message").contains("rj is NaN"));
    assert_eq!(lines[5]["working_mode"], serde_json::json!([-1, -1, -1]));
}

#[test]
fn pose_lists_all_assembly_modes() {
    let of = |more: &str| {
        run(&format!(
            "pose --design '3-RPR R=1 r=0.4 Lb=1.4 rj=0.02 rp=0.02' {more}"
        ))
    };
    let found = parsed(&of("--actuators 'q1=0.9 q2=1.0 q3=1.1' --json").success());
    let modes = list(&found["modes"]);
    assert_eq!(modes.len(), 2);
    for mode in modes {
        let [x, y, phi] = ["x_m", "y_m", "phi_deg"].map(|key| number(&mode["pose"][key]));
        let told = of(&format!("--pose 'x={x} y={y} phi_deg={phi}' --json")).success();
        let report = parsed(&told);
        for (leg, wanted) in [0.9, 1.0, 1.1].into_iter().enumerate() {
            assert!((number(&report["actuators"][leg]) - wanted).abs() < 1e-9, "{report}");
        }
        assert_eq!(mode["of_this_design"], true);
        assert_eq!(mode["working_mode"], serde_json::json!([1, 1, 1]));
    }
    for (values, words) in [
        ("q1=0.9 q2=1.0", "`q3` is missing"),
        ("q1=0.9 q2=1.0 rho=1", "expected q1, q2 and q3"),
    ] {
        of(&format!("--actuators '{values}' --json"))
            .code(2)
            .stderr(says(words));
    }
}

#[test]
fn pose_tells_joints_and_stiffness() {
    let at = |design: &str, pose: &str| json(&format!("pose --design '{design}' --pose '{pose}' --json"));
    let found = at(DESIGN, "x=0.1 y=0.2 phi_deg=30");
    assert_eq!(found["reachable"], true);
    assert_eq!(found["reason"], Value::Null);
    for (key, count) in [("actuators", 3), ("B", 3), ("stiffness", 6)] {
        assert_eq!(list(&found[key]).len(), count, "{key}");
    }
    let k = |i: usize, j: usize| number(&found["stiffness"][i][j]);
    // The values and the matrix come from two forms, whose last digits may differ.
    for (place, key) in [(2, "k_z"), (5, "k_phi_z")] {
        assert!((k(place, place) / number(&found[key]) - 1.0).abs() < 1e-14, "{key}");
    }
    assert_eq!(k(0, 5), k(5, 0));
    assert_eq!(k(0, 2), 0.0);

    let far = at(DESIGN, "x=0 y=9 phi_deg=0");
    assert_eq!(far["reachable"], false);
    assert!(far["reason"].as_str().expect("a reason").contains("out of reach"));
    for key in "actuators B C inverse_condition k_xy k_z k_phi_z stiffness".split(' ') {
        assert_eq!(far.get(key), Some(&Value::Null), "{key}");
    }

    // B of a 3-RPR is A, and a violated stroke limit is reported.
    let telescopic = "3-RPR R=1.5 r=0.3 Lb=2 rj=0.03 rp=0.03";
    let near = at(telescopic, "x=0 y=0 phi_deg=0");
    assert!((number(&near["B"][2][1]) - 1.5).abs() < 1e-12);
    let beyond = at(telescopic, "x=0 y=0.5 phi_deg=0");
    let reason = beyond["reason"].as_str().expect("a reason");
    assert!(reason.contains("leg 3: prismatic joint"), "{reason}");
}

#[test]
fn people_get_tables() {
    let told = run(&format!("evaluate --design '{DESIGN}'")).success();
    let mass = contains("479.472 kg");
    told.stdout(contains("R_w = 1.22010 m").and(contains("dexterity")).and(mass));
    let told = run(&format!("pose --design '{DESIGN}' --pose 'x=0 y=0 phi_deg=30'")).success();
    told.stdout(contains("inverse condition").and(contains("φz")));
}

/// Invalid input gives exit code 2 and a message that says what is wrong and what would be right.
#[test]
fn wrong_input_is_refused_in_words() {
    let evaluate = |more: &str| format!("evaluate --design '{DESIGN}' {more}");
    let pose = |pose: &str| format!("pose --design '{DESIGN}' --pose '{pose}'");
    let cases: [(&str, &str); 16] = [
        ("evaluate --design '3-PPP R=1'", "expected one of 3-PRR, 3-RPR, 3-RRR"),
        ("evaluate --design '3-PRR R=1 r=1 Lb=1 rj=0.1'", "`rp` is missing"),
        ("evaluate --design '3-PRR R=-1 r=1 Lb=1 rj=0.1 rp=0.1'", "above 0 m"),
        ("evaluate", "--design"),
        (&evaluate("--grid coarse"), "reference"),
        (&evaluate("--study nowhere.toml"), "paper-bounds-as-printed"),
        (&pose("x=0 y=0"), "`phi_deg` is missing"),
        (&pose("x=0 y=inf phi_deg=0"), "must be finite"),
        ("optimize --threads 0", "a whole number from 1 to 1024"),
        ("optimize --evaluations 0", "from 1 to 100000000"),
        ("optimize --evaluations -5", "from 1 to 100000000"),
        ("optimize --evaluations 1e5", "did you mean `100000`?"),
        ("report --picture-width 90000", "a whole number from 160 to 8000"),
        ("optimize --architectures 3-PRR,4-RRR", "unknown architecture"),
        ("optimize --architectures 3-PRR,3-PRR", "contains \"3-PRR\" twice"),
        ("study show none", "paper"),
    ];
    for (line, words) in cases {
        run(line).code(2).stderr(says(words));
    }
}

#[test]
fn a_wrong_study_shows_file_line_and_key() {
    let folder = folder();
    folder.write("wrong.toml", "name = \"wrong\"\n\n[bounds]\nR_m = [4, 1]\n");
    for command in ["study check", "optimize"] {
        let told = folder.run(&format!("{command} wrong.toml")).code(2);
        told.stderr(says("wrong.toml:4").and(says("bounds.R_m")));
    }
    let files = std::fs::read_dir(folder.path()).expect("a folder").count();
    assert_eq!(files, 1, "a rejected study leaves no files behind");
}

#[test]
fn study_new_writes_a_commented_study_and_overwrites_nothing() {
    let folder = folder();
    folder.run("study new mine.toml").code(0);
    assert!(folder.read("mine.toml").contains("# g4: a force in the plane"));
    folder.run("study check mine.toml").success();
    folder.write("mine.toml", "mine");
    folder.run("study new mine.toml").code(2);
    assert_eq!(folder.read("mine.toml"), "mine");
    run("study list").success().stdout(contains("aluminium-pick-and-place"));
}

#[test]
fn an_occupied_run_folder_is_left_alone() {
    let folder = folder();
    small_study(folder.path());
    let out = folder.join("run");
    std::fs::create_dir(&out).expect("a folder");
    folder.write("run/front.csv", "precious");
    let told = folder.run("optimize small.toml --out run").code(2);
    told.stderr(says("already holds a run"));
    assert_eq!(folder.read("run/front.csv"), "precious");
    assert_eq!(std::fs::read_dir(&out).expect("a folder").count(), 1);
}

/// The clearance is reported whether or not g7 is required; g7 is required only by a study that states a clearance.
#[test]
fn evaluate_and_pose_tell_the_nearest_bodies() {
    let free = json(&format!("evaluate --design '{DESIGN}' --json"));
    let required = json(&format!(
        "evaluate --design '{DESIGN}' --json --study paper-without-collisions"
    ));
    for found in [&free, &required] {
        let clearance = number(&found["clearance_m"]);
        let pair = list(&found["clearance_pair"]);
        assert_eq!(pair.len(), 2);
        assert!(pair[0].as_str().expect("a name").starts_with("leg"), "{pair:?}");
        assert_eq!(clearance < 0.0, std::ptr::eq(found, &free), "{clearance}");
    }
    let g7 = list(&required["constraints"]).last().expect("g7");
    assert_eq!(g7["id"], "g7");
    assert_eq!(g7["threshold"], 0.005);
    assert_eq!(g7["value"], required["clearance_m"]);
    assert!(number(&g7["margin"]) >= 0.0);
    assert!(g7["pose"]["phi_deg"].is_number());
    assert!(required["workspace_radius_m"].as_f64() < free["workspace_radius_m"].as_f64());

    // At the pose with the smallest clearance, `pose` reports the same clearance.
    let at = |pose: &str| json(&format!("pose --design '{DESIGN}' --pose '{pose}' --json"));
    let [x, y, phi] = ["x_m", "y_m", "phi_deg"].map(|key| &g7["pose"][key]);
    let there = at(&format!("x={x} y={y} phi_deg={phi}"));
    assert_eq!(there["clearance_pair"], required["clearance_pair"]);
    let difference = number(&there["clearance_m"]) - number(&g7["value"]);
    assert!(difference.abs() < 1e-9, "{difference}");
    let nowhere = at("x=9 y=0 phi_deg=0");
    assert_eq!(nowhere["clearance_m"], Value::Null);
    assert_eq!(nowhere["clearance_pair"], Value::Null);
}

#[test]
fn bodies_that_cannot_be_are_told_with_their_keys() {
    let text = "[requirements]\nclearance_min_m = -0.1\n[bodies]\nslider_length = 1.0\n[bodies.layers]\ncrank = inf\n";
    let folder = folder();
    folder.write("study.toml", text);
    let words = said(&folder.run("study check study.toml").code(2));
    let keys = [
        "requirements.clearance_min_m",
        "bodies.slider_length",
        "bodies.layers.crank",
    ];
    for part in keys.into_iter().chain(["study.toml:2"]) {
        assert!(words.contains(part), "{part} is not in {words}");
    }
}

/// Certificates have the keys that others rely on; a claim is proved, refuted or left open.
#[test]
fn certificates_answer_a_claim() {
    let certify = |more: &str| run(&format!("certify --design '{DESIGN}' {more}"));
    let claimed = |more: &str| json(&format!("certify --design '{DESIGN}' {more} --json"));
    let found = claimed("");
    let of_claim =
        "architecture boxes claim claimed_radius_m closed design home lower_m relative_gap seconds tolerance upper_m";
    let of_proof = "verdict violation why working_mode";
    assert_eq!(keys(&found).join(" "), format!("{of_claim} {of_proof}"));
    let of_violation = ["id", "margin", "phi_deg", "phi_rad", "x_m", "y_m"];
    assert_eq!(keys(&found["violation"]), of_violation);
    let lower = number(&found["lower_m"]);
    assert!(lower <= 1.221_104_6 && number(&found["upper_m"]) >= 1.221_103_3);
    assert_eq!(found["verdict"], "proved");
    assert!(number(&found["violation"]["margin"]) < 0.0);

    // A radius that is claimed too large is refuted; without boxes nothing is proved.
    assert_eq!(claimed("--radius 1.3 --phi-deg 29.5")["verdict"], "refuted");
    let few = claimed("--max-boxes 3");
    assert_eq!((&few["verdict"], &few["why"]), (&"open".into(), &"budget".into()));
    assert!(number(&few["lower_m"]) < 1.22);
    let bound = number(&claimed("--all-homes")["upper_all_homes_m"]);
    assert!(bound > lower && bound < 1.225, "{bound}");

    let told = certify("--study paper-without-collisions").success();
    told.stdout(contains("claimed R_w").and(contains("is proved infeasible")));
    certify("--tolerance -1").code(2).stderr(says("tolerance"));
}

/// A stream of certificates answers in order, on all cores.
#[test]
fn certificates_answer_a_stream() {
    // The pocket of a design of a front: the grid claims 0.7147 m, of which 0.6423 m are there.
    let pocket = "3-RRR R=1.0094566953033497 r=0.13093847935116149 Lb=0.7999739586075939 rj=0.03839109236004963 rp=0.02315007385818249";
    let lines = format!("{DESIGN}\nnonsense\n{pocket}\n3-PRR R=9 r=0.5 Lb=1 rj=0.03 rp=0.03\n");
    let answers = answers("certify", lines.repeat(5));
    assert_eq!(answers.len(), 20);
    for four in answers.chunks(4) {
        assert_eq!(four[0]["verdict"], "proved");
        let error = four[1]["error"].as_str().unwrap_or_default();
        assert!(error.contains("nonsense"), "{}", four[1]);
        assert_eq!(four[2]["verdict"], "refuted");
        assert!(number(&four[2]["upper_m"]) < 0.643);
        // A design that cannot be assembled has no disc.
        assert_eq!(["lower_m", "upper_m"].map(|key| number(&four[3][key])), [0.0, 0.0]);
    }
}

/// A reader that goes away ends the stream, though designs keep coming.
#[cfg(unix)]
#[test]
fn a_stream_of_certificates_ends_with_its_reader() {
    let script = format!(
        "yes '{DESIGN}' | '{}' certify --stdin | head -2 | wc -l",
        env!("CARGO_BIN_EXE_kinefront")
    );
    let told = std::process::Command::new("sh").args(["-c", &script]).output();
    let printed = told.expect("a shell").stdout;
    assert_eq!(String::from_utf8_lossy(&printed).trim(), "2");
}
