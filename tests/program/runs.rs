//! Tests of complete runs: files, determinism, interruption.

use std::f64::consts::TAU;
use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::Stdio;

use kinefront_model::evaluation::PoseScalar;
use kinefront_testkit::numbers;
use serde_json::Value;

#[cfg(unix)]
use super::support::signal;
use super::support::{
    check, design_of, folder, json, list, number, optimize, program, read_rows, said, small_run, small_study, value,
    wait_for,
};

#[test]
fn a_run_leaves_its_files() {
    let out = small_run();
    let printed = fs::read(out.with_file_name("printed.json")).expect("what was printed");
    let report: Value = serde_json::from_slice(&printed).expect("JSON");
    for file in ["study.toml", "designs.csv", "front.csv", "run.json", "recording.rrd"] {
        assert!(out.join(file).metadata().expect(file).len() > 0);
    }
    assert_eq!(fs::read_dir(&out).expect("a folder").count(), 5);
    let header = fs::read_to_string(out.join("designs.csv")).expect("the table");
    assert!(header.starts_with(
        "id,generation,architecture,working_mode,R,r,Lb,rj,rp,mass_kg,workspace_radius_m,phi_deg,feasible,"
    ));
    let designs = read_rows(&out.join("designs.csv"));
    assert_eq!(designs.len(), 600);
    assert!(designs.iter().enumerate().all(|(id, row)| row["id"] == id.to_string()));
    assert_eq!(report["evaluations"], 600);
    assert_eq!(report["outcome"], "completed");
    assert_eq!(list(&report["history"]).len(), 20);
    let feasible = designs.iter().filter(|row| row["feasible"] == "true").count();
    assert_eq!(report["feasible"], feasible);
    let saved: Value = serde_json::from_slice(&fs::read(out.join("run.json")).expect("the report")).expect("JSON");
    assert_eq!(saved, report);
}

/// The front is feasible, sorted and non-dominated, and agrees with `evaluate` on the fine grid.
#[test]
fn a_front_is_what_other_commands_say_of_its_designs() {
    let out = small_run();
    let front = read_rows(&out.join("front.csv"));
    let report: Value = serde_json::from_slice(&fs::read(out.join("run.json")).expect("the report")).expect("JSON");
    assert_eq!(report["front_size"], front.len());
    assert!(front.len() > 3);
    for pair in front.windows(2) {
        for column in ["mass_kg", "workspace_radius_m"] {
            assert!(value(&pair[0], column) < value(&pair[1], column), "{pair:?}");
        }
    }
    let row = &front[front.len() / 2];
    let ask = |command: &str| {
        let (study, design) = (out.join("study.toml"), design_of(row));
        json(&format!(
            "{command} --json --study '{}' --design '{design}'",
            study.display()
        ))
    };
    let (evaluated, certified) = (ask("evaluate --grid fine"), ask("certify"));
    assert_eq!(row["certificate"], "proved");
    for (found, key, column) in [
        (&evaluated, "mass_kg", "mass_kg"),
        (&certified, "lower_m", "workspace_radius_m"),
        (&certified, "lower_m", "certified_lower_m"),
        (&certified, "upper_m", "certified_upper_m"),
    ] {
        // Reading JSON may change the last bit.
        let (found, wanted) = (number(&found[key]), value(row, column));
        let is_same = (found - wanted).abs() <= 4.0 * f64::EPSILON * wanted;
        assert!(is_same, "{key}: {found} instead of {wanted}");
    }
    // The ends and the knee are marked.
    let marks: Vec<&str> = front.iter().map(|row| row["mark"].as_str()).collect();
    assert_eq!(marks[0], "lightest");
    assert_eq!(marks[marks.len() - 1], "largest");
    assert_eq!(marks.iter().filter(|mark| **mark == "knee").count(), 1);
}

/// The front of the 3-RRR has pockets that the fine grid misses: they are proved away by thicker bars, or the radius is reduced. No
/// random pose of a reported disc is infeasible.
#[test]
fn a_front_with_pockets_is_proved() {
    use kinefront_study::{RunFolder, Study};
    let folder = folder();
    let out = folder.join("run");
    let line =
        "optimize paper --architectures 3-RRR --evaluations 1500 --seed 7 --front 100 --quiet --no-recording --out run";
    folder.run(line).success();
    let run = RunFolder::open(&out).expect("a run");
    let report = run.report().expect("a report");
    let proofs = report.proofs.as_ref().expect("proofs");
    let front = run.front().expect("a table").expect("a front").rows;
    println!("{proofs}");
    assert_eq!((proofs.proved + proofs.open, proofs.open), (front.len(), 0));
    let thickened = proofs.refuted.iter().filter_map(|refuted| refuted.thickened.as_ref());
    let ids: Vec<usize> = thickened.clone().map(|thickened| thickened.id).collect();
    // Designs that are reported instead of refuted or improved ones are no designs of the search.
    assert!(ids.len() > 5 && ids.iter().all(|id| *id >= 1500), "{ids:?}");
    let improved = front.iter().filter(|entry| entry.id >= 1500).count();
    assert!(
        2 * improved > front.len(),
        "{improved} of {} were improved",
        front.len()
    );
    for refuted in &proofs.refuted {
        assert!(
            refuted.infeasible_at_m < refuted.fine_radius_m && refuted.margin < 0.0,
            "{refuted:?}"
        );
    }
    let model = Study::default().model().expect("a model");
    for entry in &front {
        let certified = entry.certified.expect("a certificate");
        assert!(certified.is_proved && certified.lower == entry.row.workspace_radius());
        let phi = entry.row.phi.expect("a home").to_radians();
        let mut next = numbers(entry.id as u64);
        for _ in 0..2000 {
            let (radius, theta) = (entry.row.workspace_radius() * next().sqrt(), TAU * next());
            let turn = 10f64.to_radians() * (2.0 * next() - 1.0);
            let pose = kinefront_model::spatial::Pose::new(radius * theta.cos(), radius * theta.sin(), phi + turn);
            let found = model.pose(&entry.row.design, &pose).expect("a reachable pose");
            let limits = [
                (PoseScalar::Dexterity, 0.1),
                (PoseScalar::StiffnessXy, 1e6),
                (PoseScalar::StiffnessZ, 1e5),
                (PoseScalar::StiffnessPhiZ, 10.0 / 1f64.to_radians()),
            ];
            let keeps = |(scalar, limit): (PoseScalar, f64)| found.values[scalar] >= (1.0 - 1e-9) * limit;
            assert!(limits.into_iter().all(keeps), "#{} at {pose:?}", entry.id);
        }
    }
}

/// Without proofs, the radii are those of the fine grid, and the columns of proofs are empty.
#[test]
fn a_front_can_be_left_unproved() {
    let folder = folder();
    let text = "architectures = [\"3-RRR\"]\n[workspace]\ncertify = false\n";
    let (study, out) = (folder.write("unproved.toml", text), folder.join("unproved"));
    optimize(
        &study,
        &out,
        &["--evaluations", "200", "--front", "12", "--no-recording"],
    );
    let mut table = csv::Reader::from_path(out.join("front.csv")).expect("a table");
    let rows: Vec<csv::StringRecord> = table.records().map(|row| row.expect("a row")).collect();
    assert!(!rows.is_empty() && rows.iter().all(|row| row.iter().skip(33).all(str::is_empty)));
    check(&out).success();
}

/// A run stops by each of the rules that a study may state besides its budget, and a front may be thinned.
#[test]
fn a_run_stops_by_the_rules_of_its_study() {
    let folder = folder();
    let sections = [
        (
            "stagnated",
            "evaluations = 2000\n[optimizer.stagnation]\nevaluations = 200\ngain = 0.2",
        ),
        ("time_up", "evaluations = 100000000\ntime_limit_s = 0.5"),
        ("completed", "evaluations = 400"),
    ];
    for (outcome, section) in sections {
        let text =
            format!("name = \"{outcome}\"\narchitectures = [\"3-PRR\"]\n[optimizer]\nfront_designs = 7\n{section}\n");
        let study = folder.write("study.toml", text);
        let report = optimize(&study, &folder.join(outcome), &["--no-recording"]);
        assert_eq!(report["outcome"], outcome);
        let done = report["evaluations"].as_u64().expect("a number");
        match outcome {
            "completed" => assert_eq!(done, 400),
            "stagnated" => assert!(done < 2000, "{done} evaluations"),
            _ => assert!(done < 100_000_000, "{done} evaluations"),
        }
        if outcome == "completed" {
            let verified = report["front_verified"].as_u64().expect("a number");
            assert!(verified >= 7 && report["front_size"] == 7, "7 of {verified}");
        }
    }
}

/// A random seed gives one result to the bit, for any number of threads and also from the study that a run writes.
#[test]
fn runs_repeat_to_the_bit() {
    let folder = folder();
    let study = small_study(folder.path());
    for algorithm in ["front-de", "moga2", "nsga2"] {
        let run = |name: &str, study: &Path, more: &[&str]| {
            let out = folder.join(format!("{algorithm}-{name}"));
            let settings = ["--algorithm", algorithm, "--evaluations", "300", "--no-recording"];
            optimize(study, &out, &[&settings[..], more].concat());
            ["designs.csv", "front.csv"].map(|file| fs::read(out.join(file)).expect("a table"))
        };
        let one = run("one", &study, &["--threads", "1"]);
        let three = run("three", &study, &["--threads", "3"]);
        assert!(one == three, "{algorithm} depends on the number of threads");
        let left = folder.join(format!("{algorithm}-one/study.toml"));
        let again = run("again", &left, &[]);
        assert!(one == again, "{algorithm} does not repeat from the study it leaves");
        let other = run("other", &study, &["--seed", "6"]);
        assert!(one != other, "{algorithm} ignores its seed");
    }
}

#[test]
fn one_architecture_alone() {
    let folder = folder();
    let out = folder.join("run");
    let more = ["--architectures", "3-RPR", "--evaluations", "100", "--no-recording"];
    let report = optimize(&small_study(folder.path()), &out, &more);
    assert_eq!(report["evaluations"], 100);
    let designs = read_rows(&out.join("designs.csv"));
    assert_eq!(designs.len(), 100);
    assert!(designs.iter().all(|row| row["architecture"] == "3-RPR"));
}

#[test]
fn piped_progress_is_plain_lines_and_quiet_is_quiet() {
    let folder = folder();
    small_study(folder.path());
    let loud = said(&folder.run("optimize small.toml --out loud").success());
    assert!(
        loud.contains("generation 20: 600/600 evaluations") && !loud.contains('\u{1b}'),
        "{loud}"
    );
    // The designs that are reported are verified first, then proved.
    let told = |words: &str| loud.lines().position(|line| line.starts_with(words));
    assert!(
        told("verifying ").is_some_and(|verifying| told("proving ").is_some_and(|proving| verifying < proving)),
        "{loud}"
    );
    assert!(!loud.contains(" 0 designs"), "{loud}");
    let line = "optimize small.toml --evaluations 60 --out quiet --quiet";
    folder.run(line).success().stderr("");
}

/// After Ctrl-C, the tables and the recording contain all designs that were evaluated, and the exit code is 130.
#[cfg(unix)]
#[test]
fn an_interrupted_run_keeps_what_it_has() {
    let folder = folder();
    let study = small_study(folder.path());
    let out = folder.join("run");
    let mut child = program()
        .arg("optimize")
        .arg(&study)
        .args(["--evaluations", "1000000", "--json", "--out"])
        .arg(&out)
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    wait_for(&out, 200);
    signal(&child, "-INT");
    let mut printed = String::new();
    let mut pipe = child.stdout.take().expect("a pipe");
    pipe.read_to_string(&mut printed).expect("UTF-8");
    assert_eq!(child.wait().expect("an end").code(), Some(130));
    let report: Value = serde_json::from_str(&printed).expect("JSON");
    assert_eq!(report["outcome"], "interrupted");
    let designs = read_rows(&out.join("designs.csv"));
    assert_eq!(report["evaluations"], designs.len());
    assert!(designs.len() < 1_000_000 && !out.join("front.csv").exists());
    super::recordings::agrees_with_its_tables(&out);
}
