//! Tests of designs exported for other programs, read by those programs.

use std::path::{Path, PathBuf};

use predicates::str::contains;
use serde_json::Value;

use super::support::{
    DESIGN, Folder, folder, json, list, node, number, parsed, python, read_rows, run, sample, says, script_json,
    small_run,
};

/// A design of each of the paper's architectures, with the stiffness of its actuators.
pub const DESIGNS: [(&str, f64); 3] = [
    (DESIGN, 1e7),
    ("3-RPR R=2.0 r=0.5 Lb=3.0 rj=0.03 rp=0.03", 1e7),
    ("3-RRR R=2.0 r=0.6 Lb=1.6 rj=0.05 rp=0.04", 1e7),
];

/// A design of each other architecture.
pub const OTHERS: [&str; 15] = [
    "3-R_RR R=2.25 r=0.74 Lb=1.52 rj=0.040 rp=0.060",
    "3-_RRP R=1.03 r=0.87 Lb=1.59 rj=0.048 rp=0.069",
    "3-R_RP R=1.35 r=0.87 Lb=1.50 rj=0.054 rp=0.068",
    "3-RR_P R=2.21 r=0.86 Lb=3.37 rj=0.056 rp=0.041",
    "3-_RPR R=1.03 r=0.84 Lb=2.30 rj=0.052 rp=0.051",
    "3-P_RR R=1.17 r=0.62 Lb=1.68 rj=0.055 rp=0.044",
    "3-R_PP R=1.13 r=0.86 Lb=3.12 rj=0.046 rp=0.047",
    "3-RP_P R=1.68 r=0.82 Lb=1.68 rj=0.054 rp=0.061",
    "3-_PRP R=2.37 r=0.82 Lb=1.52 rj=0.055 rp=0.041",
    "3-PR_P R=2.08 r=0.81 Lb=0.94 rj=0.057 rp=0.045",
    "3-_PPR R=2.12 r=0.85 Lb=0.90 rj=0.047 rp=0.058",
    "3-P_PR R=2.22 r=0.79 Lb=1.17 rj=0.041 rp=0.042",
    "3-RR_R R=1.64 r=0.77 Lb=1.42 rj=0.051 rp=0.058",
    "3-RP_R R=1.00 r=0.84 Lb=1.63 rj=0.053 rp=0.052",
    "3-PR_R R=1.09 r=0.78 Lb=1.61 rj=0.058 rp=0.051",
];

/// Exports a design to a file in `folder`; the format follows from the extension.
fn export(design: &str, folder: &Folder, name: &str) -> PathBuf {
    let told = folder
        .run(&format!("export --design '{design}' --out {name}"))
        .success();
    told.stdout(contains("wrote"));
    folder.join(name)
}

fn read_json(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).expect("a file")).expect("JSON")
}

/// Checks that MuJoCo moves the exported mechanism of a design along its tour with the loops closed, and returns what it found with the
/// exported JSON.
fn moves_along_its_tour(folder: &Folder, design: &str, most_added_kg: f64) -> (Value, Value) {
    let name = design.split(' ').next().expect("a name");
    let file = |extension: &str| export(design, folder, &format!("{name}.{extension}"));
    let (model, json, urdf) = (file("xml"), file("json"), file("urdf"));
    let python = python(&["mujoco", "numpy"]).expect("Python, which was found before");
    let found = script_json(python, "mujoco_tour.py", &[&model, &json, &urdf]);
    let exported = read_json(&json);
    let evaluation = &exported["evaluation"];
    assert!(number(&found["farthest_m"]) < 1e-4, "{design}: {found}");
    assert!(number(&found["turned_rad"]) < 1e-4, "{design}: {found}");
    // With the controls of 0 that MuJoCo begins with, it stays where it was exported.
    assert!(number(&found["drift"]) < 1e-5, "{design}: {found}");
    // The platform did travel to the rim.
    let radius = number(&evaluation["workspace_radius_m"]);
    assert!(number(&found["travelled_m"]) > 0.9 * radius, "{design}: {found}");
    let counts = [&found["closures"], &found["actuators"], &found["warnings"]];
    assert_eq!(counts, [3, 3, 0], "{design}");
    for key in ["mass_kg", "urdf_mass_kg"] {
        let more = number(&found[key]) - number(&evaluation["mass_kg"]);
        assert!((-1e-6..most_added_kg).contains(&more), "{design}: {more} kg too much");
    }
    (found, exported)
}

#[test]
fn mujoco_follows_the_tour_with_the_loops_closed() {
    let Some(_) = python(&["mujoco", "numpy"]) else { return };
    let folder = folder();
    std::thread::scope(|scope| {
        for (design, stiffness) in DESIGNS {
            let folder = &folder;
            scope.spawn(move || {
                // Each slider has a mass of one gram.
                let (found, _) = moves_along_its_tour(folder, design, 0.003_001);
                assert_eq!(found["stiffness"], serde_json::json!([stiffness, stiffness, stiffness]));
                // There are two joints per leg, and the one platform joint that is not cut.
                assert_eq!(found["urdf_joints"], 7);
            });
        }
    });
}

/// Every architecture is a mechanism that MuJoCo moves along the tour: passive and actuated joints, guides and motors at the platform
/// are where the design has them.
#[test]
fn mujoco_moves_every_other_architecture() {
    let Some(_) = python(&["mujoco", "numpy"]) else { return };
    let folder = folder();
    for design in sample(OTHERS.iter(), 2) {
        // Each slider and each carriage without mass has one gram.
        let (found, exported) = moves_along_its_tour(&folder, design, 0.006_001);
        // One joint per body but the platform, and that at C_1 unless the platform is fixed there.
        let bodies = list(&exported["bodies"]).len() as u64 - 1;
        let is_fixed = exported["closures"][0]["rigid"].as_bool().expect("a flag");
        assert_eq!(found["urdf_joints"], bodies + u64::from(!is_fixed), "{design}");
    }
}

#[test]
fn gltf_passes_the_validator() {
    let folder = folder();
    let designs: Vec<&str> = DESIGNS.iter().map(|(design, _)| *design).chain(OTHERS).collect();
    let files: Vec<PathBuf> = designs
        .into_iter()
        .enumerate()
        .map(|(index, design)| export(design, &folder, &format!("{index}.glb")))
        .collect();
    let Some(mut node) = node("gltf-validator") else { return };
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/node/validate_gltf.js");
    let output = node.arg(script).args(&files).output().expect("Node runs");
    let found: Vec<Value> = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(found.len(), files.len());
    for file in &found {
        let faults = [&file["errors"], &file["warnings"], &file["hints"]];
        assert_eq!(faults, [0, 0, 0], "{file}");
        assert_eq!(file["info"]["animationCount"], 1);
        // The meshes are those of three legs, a platform and the base.
        assert!(file["info"]["totalTriangleCount"].as_u64().expect("a count") > 1000);
    }
}

#[test]
fn plan_view_and_front_are_read_back() {
    let folder = folder();
    let run = small_run();
    let [parquet, csv] = ["parquet", "csv"].map(|extension| {
        let name = format!("front.{extension}");
        folder
            .run(&format!("export '{}' --out {name}", run.display()))
            .success();
        folder.join(name)
    });
    let [exported, written] = [&csv, &run.join("front.csv")].map(|table| std::fs::read(table).expect("a table"));
    assert_eq!(exported, written);
    let [drawing, glb, json] =
        ["dxf", "glb", "json"].map(|extension| export(DESIGN, &folder, &format!("design.{extension}")));
    let Some(python) = python(&["ezdxf", "pyarrow"]) else {
        return;
    };
    let found = script_json(python, "read_exports.py", &[&drawing, &parquet, &csv, &glb, &json]);
    // The tolerance is that of single precision over a few metres; no joint opens at any step of the animation.
    let animation = &found["animation"];
    assert_eq!([&animation["bodies"], &animation["steps"]], [7, 235]);
    for key in ["from_tour_m", "gap_m"] {
        assert!(number(&animation[key]) < 2e-6, "{animation}");
    }
    shows_design_ii(&found);
    assert_eq!(found["differing"], serde_json::json!([]));
    assert!(found["rows"].as_u64().expect("a count") > 5);
    let types = ["id", "architecture", "mass_kg", "feasible"].map(|column| &found["types"][column]);
    assert_eq!(types, ["int64", "string", "double", "bool"]);
}

/// Checks what was found in the plan view of design II.
fn shows_design_ii(found: &Value) {
    assert_eq!(found["faults"], 0);
    assert_eq!(found["release"], "R12");
    let notes = list(&found["notes"]);
    for note in ["lengths in mm, scale 1:1", "round 72.0", "platform bar"] {
        assert!(notes.iter().any(|found| found == note), "{note}: {notes:?}");
    }
    // The base, the position of the slider, the link and the platform bar of design II; each dimension shows itself.
    let dimensions = list(&found["dimensions"]);
    let shown = serde_json::json!(["LINE", "LINE", "LINE", "SOLID", "SOLID", "TEXT"]);
    for dimension in dimensions {
        let measured = number(&dimension["measured"]);
        assert_eq!(dimension["text"], format!("{measured:.1}"), "{dimension}");
        assert_eq!(dimension["override"], "", "{dimension}");
        assert_eq!(dimension["shown"], shown);
        assert_eq!(dimension["style"], true);
    }
    let texts: Vec<&str> = dimensions.iter().filter_map(|found| found["text"].as_str()).collect();
    assert_eq!(
        [texts[0], texts[2], texts[3]],
        ["5310.5", "1896.0", "1283.0"],
        "{texts:?}"
    );
    // The outlines are three links with L_b and 2 r_j of design II, and its three sliders.
    let links = list(&found["legs_mm"]);
    let near = |value: &Value, wanted: f64| (number(value) - wanted).abs() < 1e-9;
    let bars = links.iter().filter(|bar| near(&bar[0], 72.0) && near(&bar[1], 1896.0));
    assert_eq!((bars.count(), links.len()), (3, 6));
    assert!((number(&found["workspace_mm"][0]) - 1221.1).abs() < 0.1);
    assert_eq!(
        found["labels"],
        serde_json::json!(["A1", "A2", "A3", "B1", "B2", "B3", "C1", "C2", "C3", "O", "P"])
    );
}

/// A prescribed polygon is exported as it is, not as the disc within it.
#[test]
fn a_prescribed_rectangle_is_exported_with_its_corners() {
    let folder = folder();
    let text = "objectives = [{ minimize = \"mass_kg\" }]\n\
                workspace.region = { kind = \"rectangle\", width_m = 0.6, height_m = 0.4 }\n";
    folder.write("table.toml", text);
    let written = |name: &str| {
        let design = "3-PRR R=1.6 r=0.35 Lb=1.2 rj=0.04 rp=0.05";
        let line = format!("export --design '{design}' --study table.toml --out {name}");
        folder.run(&line).success();
        std::fs::read(folder.join(name)).expect("a file")
    };
    let drawing = String::from_utf8(written("table.dxf")).expect("text");
    let lines: Vec<&str> = drawing.lines().map(str::trim).collect();
    let in_workspace: Vec<&[&str]> = lines.windows(2).filter(|pair| pair == &["8", "WORKSPACE"]).collect();
    assert!(!in_workspace.is_empty() && drawing.contains("prescribed region"));
    for pair in [["10", "-300.0"], ["10", "300.0"], ["20", "-200.0"], ["20", "200.0"]] {
        assert!(lines.windows(2).any(|found| found == pair), "no corner with {pair:?}");
    }
    let scene = String::from_utf8(written("table.xml")).expect("text");
    for side in 1..=4 {
        assert!(scene.contains(&format!("regular_workspace_{side}")), "side {side}");
    }
    let glb = written("table.glb");
    let text = String::from_utf8_lossy(&glb);
    assert!(text.contains("regular_workspace"));
}

/// A small mechanism with thin bars is exported, and a working mode with two consecutive minus signs, which would end
/// an XML comment.
#[test]
fn small_mechanisms_and_other_working_modes_are_exported() {
    let folder = folder();
    let small = "3-RRR R=0.02 r=0.006 Lb=0.016 rj=0.00005 rp=0.00005 mode=---";
    let text = std::fs::read_to_string(export(small, &folder, "small.xml")).expect("a model");
    let title = text
        .split("<!-- ")
        .nth(1)
        .and_then(|rest| rest.lines().next())
        .expect("a title");
    let same = kinefront_model::mechanism::Design::parse(title, kinefront_model::mechanism::WorkingMode::ALL_PLUS);
    assert_eq!(same, small.parse());
    for inertia in text.split("fullinertia=\"").skip(1) {
        let moments: Vec<f64> = inertia[..inertia.find('"').expect("an end")]
            .split(' ')
            .map(|number| number.parse().expect("a number"))
            .collect();
        assert!(moments[..3].iter().all(|moment| *moment > 0.0), "{moments:?}");
    }
}

/// The JSON file contains the results of `evaluate` and `pose`, and the position of every body.
#[test]
fn json_holds_the_design() {
    let folder = folder();
    let file = read_json(&export(DESIGN, &folder, "design.json"));
    let evaluation = json(&format!("evaluate --design '{DESIGN}' --grid fine --json"));
    assert_eq!(file["evaluation"], evaluation);
    let pose = &file["tour"][40];
    let text = format!("x={} y={} phi_deg={}", pose["x_m"], pose["y_m"], pose["phi_deg"]);
    let there = json(&format!("pose --design '{DESIGN}' --pose '{text}' --json"));
    for leg in 0..3 {
        let difference = number(&there["actuators"][leg]) - number(&pose["actuators"][leg]);
        assert!(difference.abs() < 1e-12);
    }
    let bodies = list(&file["bodies"]);
    let names: Vec<&str> = bodies
        .iter()
        .map(|body| body["name"].as_str().expect("a name"))
        .collect();
    assert_eq!(names[..2], ["leg1_slider", "leg1_link"]);
    assert_eq!(names[6..], ["platform"]);
    let mass: f64 = bodies.iter().map(|body| number(&body["mass_kg"])).sum();
    assert!((mass - number(&evaluation["mass_kg"])).abs() < 1e-9);
}

/// Errors say what is wrong; a failed export leaves no file and overwrites none.
#[test]
fn exports_say_what_is_wrong() {
    let folder = folder();
    let own = format!("--design '{DESIGN}'");
    let without_bars = own.replace("rj=0.036", "rj=0");
    for (subject, more, words) in [
        (&*own, "--pose 'x=9 y=0 phi_deg=0'", "leg 1: prismatic joint"),
        (&without_bars, "", "radius 0"),
        (
            &own,
            "--format iges",
            "expected one of gltf, mjcf, sdf, urdf, dxf, json, csv-parts, step, csv-trajectory, csv, parquet",
        ),
        (&own, "--format parquet", "specify the run folder"),
        ("run/front.csv#1", "--format csv", "specify the run folder"),
        ("run", "--format csv --pose 'x=0 y=0 phi_deg=0'", "do not apply"),
        ("nowhere", "--format csv", "nowhere: cannot read the table"),
    ] {
        let told = folder.run(&format!("export {subject} {more} --out design.sdf")).code(2);
        told.stderr(says(words));
        assert!(!folder.join("design.sdf").exists(), "{words}");
    }
    folder.write("design.sdf", "mine");
    for (more, words) in [
        ("--format gltf --out design.gltf", ".glb"),
        ("--out design", "give --format"),
        ("--out design.sdf", "already exists"),
    ] {
        folder.run(&format!("export {own} {more}")).code(2).stderr(says(words));
    }
    assert_eq!(folder.read("design.sdf"), "mine");
}

/// What a format cannot represent is stated in the file and on standard error.
#[test]
fn exports_say_what_they_lack() {
    let folder = folder();
    let line = format!("export --design '{DESIGN}' --pose 'x=0.1 y=0 phi_deg=25' --format urdf --out design.urdf");
    folder.run(&line).success().stderr(says("the closed loops"));
    assert!(
        folder
            .read("design.urdf")
            .contains("Not in this file: the closed loops")
    );
    let told = run(&format!("export --design '{DESIGN}' --format json --out -")).success();
    told.stdout(contains("\"leg1_slider\""));
}

/// A table made by another program, and a table under another study than its own.
#[test]
fn a_design_of_any_table_is_read() {
    let folder = folder();
    let text = "id,architecture,working_mode,R,r,Lb,rj,rp\n7,3-PRR,+++,3.066,1.283,1.896,0.036,0.056\n";
    folder.write("mine.csv", text);
    let evaluation = |row: &str| {
        let told = folder.run(&format!("export {row} --format json --out -")).success();
        parsed(&told)["evaluation"].clone()
    };
    let design = json(&format!("evaluate --json --design '{DESIGN}'"));
    assert_eq!(evaluation("mine.csv#7")["design"], design["design"]);

    // The table of the run has no column for the clearance, which the other study requires.
    let front = small_run().join("front.csv");
    let row = format!("'{}#{}'", front.display(), read_rows(&front)[0]["id"]);
    let own = evaluation(&row);
    let other = evaluation(&format!("{row} --study paper-without-collisions"));
    assert_eq!(own["design"], other["design"]);
    let has_clearance = |evaluation: &Value| {
        let constraints = list(&evaluation["constraints"]);
        constraints.iter().any(|constraint| constraint["id"] == "g7")
    };
    assert!(!has_clearance(&own) && has_clearance(&other));
}
