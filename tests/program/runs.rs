//! Tests of complete runs: files, determinism, interruption.

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Command, Stdio};

use kinefront_model::evaluation::PoseScalar;
use kinefront_testkit::numbers;

use super::support::{check, folder, kinefront, optimize, program, small_study};

fn rows(path: &Path) -> Vec<csv::StringRecord> {
    let mut reader = csv::Reader::from_path(path).expect("a table");
    reader.records().map(|record| record.expect("a row")).collect()
}

#[test]
fn a_run_leaves_its_files() {
    let folder = folder();
    let out = folder.path().join("run");
    let report = optimize(&small_study(folder.path()), &out, &[]);
    for file in ["study.toml", "designs.csv", "front.csv", "run.json", "recording.rrd"] {
        assert!(out.join(file).metadata().expect(file).len() > 0);
    }
    assert_eq!(fs::read_dir(&out).expect("a folder").count(), 5);
    let header = fs::read_to_string(out.join("designs.csv")).expect("the table");
    assert!(header.starts_with(
        "id,generation,architecture,working_mode,R,r,Lb,rj,rp,mass_kg,workspace_radius_m,phi_deg,feasible,"
    ));
    let designs = rows(&out.join("designs.csv"));
    assert_eq!(designs.len(), 600);
    assert!(designs.iter().enumerate().all(|(id, row)| row[0] == id.to_string()));
    assert_eq!(report["evaluations"], 600);
    assert_eq!(report["outcome"], "completed");
    assert_eq!(report["history"].as_array().expect("a list").len(), 20);
    let feasible = designs.iter().filter(|row| &row[12] == "true").count();
    assert_eq!(report["feasible"], feasible);
    let saved: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(out.join("run.json")).expect("the report")).expect("JSON");
    assert_eq!(saved, report);

    // The front is feasible, sorted and non-dominated, and agrees with `evaluate` on the fine grid.
    let front = rows(&out.join("front.csv"));
    assert_eq!(report["front_size"], front.len());
    assert!(front.len() > 3);
    let number = |row: &csv::StringRecord, column: usize| row[column].parse::<f64>().expect("a number");
    for pair in front.windows(2) {
        assert!(number(&pair[0], 9) < number(&pair[1], 9) && number(&pair[0], 10) < number(&pair[1], 10));
    }
    let row = &front[front.len() / 2];
    let keys = ["R", "r", "Lb", "rj", "rp"];
    let design: Vec<String> = keys
        .iter()
        .enumerate()
        .map(|(k, key)| format!("{key}={}", &row[4 + k]))
        .collect();
    let ask = |command: &[&str]| -> serde_json::Value {
        let output = kinefront()
            .args(command)
            .args(["--json", "--study"])
            .arg(out.join("study.toml"))
            .args(["--design", &format!("{} {}", &row[2], design.join(" "))])
            .assert()
            .success()
            .get_output()
            .stdout
            .clone();
        serde_json::from_slice(&output).expect("JSON")
    };
    let (evaluated, certified) = (ask(&["evaluate", "--grid", "fine"]), ask(&["certify"]));
    assert_eq!(&row[35], "proved");
    for (found, key, column) in [
        (&evaluated, "mass_kg", 9),
        (&certified, "lower_m", 10),
        (&certified, "lower_m", 33),
        (&certified, "upper_m", 34),
    ] {
        // Reading JSON may change the last bit.
        let (found, wanted) = (found[key].as_f64().expect("a number"), number(row, column));
        assert!(
            (found - wanted).abs() <= 4.0 * f64::EPSILON * wanted,
            "{key}: {found} instead of {wanted}"
        );
    }
    // The ends and the knee are marked.
    let marks: Vec<&str> = front.iter().map(|row| &row[32]).collect();
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
    let out = folder.path().join("run");
    kinefront()
        .args([
            "optimize",
            "paper",
            "--architectures",
            "3-RRR",
            "--evaluations",
            "1500",
            "--seed",
            "7",
        ])
        .args(["--front", "100", "--quiet", "--no-recording", "--out"])
        .arg(&out)
        .assert()
        .success();
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
            let (radius, theta) = (
                entry.row.workspace_radius() * next().sqrt(),
                std::f64::consts::TAU * next(),
            );
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
    // Without proofs, the radii are those of the fine grid, and the last columns are empty.
    let study = folder.path().join("unproved.toml");
    fs::write(&study, "architectures = [\"3-RRR\"]\n[workspace]\ncertify = false\n").expect("a study");
    let out = folder.path().join("unproved");
    optimize(&study, &out, &["--evaluations", "200", "--no-recording"]);
    let rows = rows(&out.join("front.csv"));
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
        ("completed", "evaluations = 900\nfront_designs = 7"),
    ];
    for (outcome, section) in sections {
        let study = folder.path().join(format!("{outcome}.toml"));
        let text = format!("name = \"{outcome}\"\narchitectures = [\"3-PRR\"]\n[optimizer]\n{section}\n");
        fs::write(&study, text).expect("a study");
        let out = folder.path().join(outcome);
        let report = optimize(&study, &out, &[]);
        assert_eq!(report["outcome"], outcome);
        let done = report["evaluations"].as_u64().expect("a number");
        match outcome {
            "completed" => assert_eq!(done, 900),
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
            let out = folder.path().join(format!("{algorithm}-{name}"));
            optimize(study, &out, &[&["--algorithm", algorithm], more].concat());
            ["designs.csv", "front.csv"].map(|file| fs::read(out.join(file)).expect("a table"))
        };
        let one = run("one", &study, &["--threads", "1"]);
        assert!(
            one == run("three", &study, &["--threads", "3"]),
            "{algorithm} depends on the number of threads"
        );
        let left = folder.path().join(format!("{algorithm}-one/study.toml"));
        assert!(
            one == run("again", &left, &[]),
            "{algorithm} does not repeat from the study it leaves"
        );
        assert!(
            one != run("other", &study, &["--seed", "6"]),
            "{algorithm} ignores its seed"
        );
    }
}

#[test]
fn one_architecture_alone() {
    let folder = folder();
    let out = folder.path().join("run");
    let more = ["--architectures", "3-RPR", "--evaluations", "100"];
    let report = optimize(&small_study(folder.path()), &out, &more);
    assert_eq!(report["evaluations"], 100);
    let designs = rows(&out.join("designs.csv"));
    assert_eq!(designs.len(), 100);
    assert!(designs.iter().all(|row| &row[2] == "3-RPR"));
}

#[test]
fn piped_progress_is_plain_lines_and_quiet_is_quiet() {
    let folder = folder();
    let study = small_study(folder.path());
    let output = |out: &str, more: &[&str]| {
        let mut command = kinefront();
        command
            .arg("optimize")
            .arg(&study)
            .arg("--out")
            .arg(folder.path().join(out))
            .args(more);
        command.assert().success().get_output().clone()
    };
    let loud = String::from_utf8(output("loud", &[]).stderr).expect("UTF-8");
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
    assert!(output("quiet", &["--quiet"]).stderr.is_empty());
}

/// After Ctrl-C, the tables and the recording contain all designs that were evaluated, and the exit code is 130.
#[cfg(unix)]
#[test]
fn an_interrupted_run_keeps_what_it_has() {
    let folder = folder();
    let study = small_study(folder.path());
    let out = folder.path().join("run");
    let mut child = program()
        .arg("optimize")
        .arg(&study)
        .args(["--evaluations", "1000000", "--json", "--out"])
        .arg(&out)
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    // Wait until some rows are written.
    let begun = std::time::Instant::now();
    loop {
        let written = fs::File::open(out.join("designs.csv")).map_or(0, |file| BufReader::new(file).lines().count());
        if written > 200 {
            break;
        }
        assert!(begun.elapsed().as_secs() < 60, "no designs after a minute");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let killed = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .expect("kill runs");
    assert!(killed.success());
    let mut printed = String::new();
    child
        .stdout
        .take()
        .expect("a pipe")
        .read_to_string(&mut printed)
        .expect("UTF-8");
    assert_eq!(child.wait().expect("an end").code(), Some(130));
    let report: serde_json::Value = serde_json::from_str(&printed).expect("JSON");
    assert_eq!(report["outcome"], "interrupted");
    let designs = rows(&out.join("designs.csv"));
    assert_eq!(report["evaluations"], designs.len());
    assert!(designs.len() < 1_000_000 && !out.join("front.csv").exists());
    super::recordings::agrees_with_its_tables(&out);
}
