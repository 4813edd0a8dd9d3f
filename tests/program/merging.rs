//! Tests of `kinefront merge`, and of the evaluator for MATLAB and Octave.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::support::{DESIGN, check, folder, kinefront, optimize, small_study};

/// Lines of a table without its first columns, which number its rows.
fn designs(run: &Path) -> Vec<String> {
    let text = fs::read_to_string(run.join("designs.csv")).expect("a table");
    let lines = text
        .lines()
        .skip(1)
        .map(|line| line.splitn(3, ',').nth(2).unwrap_or_default().to_owned());
    lines.collect()
}

#[test]
fn runs_of_several_seeds_become_one_whose_front_is_no_worse() {
    let folder = folder();
    let study = small_study(folder.path());
    let place = |name: &str| folder.path().join(name);
    let reports = [1, 2, 3].map(|seed| {
        let seed = seed.to_string();
        optimize(
            &study,
            &place(&format!("run {seed}")),
            &[
                "--seed",
                &seed,
                "--evaluations",
                "300",
                "--front",
                "40",
                "--no-recording",
            ],
        )
    });
    let out = place("merged");
    let merge = |runs: &[&str], out: &Path, more: &[&str]| {
        let mut command = kinefront();
        command
            .arg("merge")
            .args(runs.iter().map(|run| place(run)))
            .arg("--out")
            .arg(out)
            .args(more);
        command
    };
    let told = merge(&["run 1", "run 2", "run 3"], &out, &["--json"])
        .assert()
        .success();
    let merged: serde_json::Value = serde_json::from_slice(&told.get_output().stdout).expect("run.json");
    assert_eq!(merged["evaluations"], 900);
    assert_eq!(merged["outcome"], "completed");
    let hypervolume = |report: &serde_json::Value| report["verified_hypervolume_kg_m"].as_f64().expect("a number");
    let of_the_search = |report: &serde_json::Value| report["hypervolume_kg_m"].as_f64().expect("a number");
    for report in &reports {
        assert!(of_the_search(&merged) >= of_the_search(report));
        // Of few designs, it matters where the last one before the reference point happens to lie.
        assert!(hypervolume(&merged) >= 0.995 * hypervolume(report));
    }
    let sources: Vec<(&str, u64)> = merged["merged"]
        .as_array()
        .expect("the runs")
        .iter()
        .map(|run| {
            (
                run["run"].as_str().expect("a name"),
                run["seed"].as_u64().expect("a seed"),
            )
        })
        .collect();
    assert_eq!(sources, [("run 1", 1), ("run 2", 2), ("run 3", 3)]);

    // Every design is there, and `origins.csv` leads back to its run.
    let runs = ["run 1", "run 2", "run 3"].map(|run| designs(&place(run)));
    let all = designs(&out);
    assert_eq!(all.len(), 900);
    let mut reader = csv::Reader::from_path(out.join("origins.csv")).expect("the origins");
    for (id, record) in reader.records().enumerate() {
        let record = record.expect("a row");
        assert_eq!(record[0], id.to_string());
        let run = sources.iter().position(|(name, _)| *name == &record[1]).expect("a run");
        assert_eq!(all[id], runs[run][record[2].parse::<usize>().expect("an id")]);
    }

    // The folder is one that other commands read, check, repair and report on.
    check(&out).code(0);
    fs::remove_file(out.join("front.csv")).expect("a front");
    check(&out).code(2);
    kinefront().arg("check").arg(&out).arg("--repair").assert().code(0);
    check(&out).code(0);
    let again: serde_json::Value =
        serde_json::from_slice(&fs::read(out.join("run.json")).expect("run.json")).expect("JSON");
    assert_eq!(again["merged"], merged["merged"]);
    kinefront()
        .arg("report")
        .arg(&out)
        .arg("--out")
        .arg(place("report"))
        .args(["--sensitivity", "0", "--picture-width", "160"])
        .assert()
        .success();
    assert!(place("report").join("index.html").exists());

    // The order of the runs changes ids alone; a thinned one keeps the front.
    merge(
        &["run 3", "run 1", "run 2"],
        &place("other order"),
        &["--quiet", "--no-recording"],
    )
    .assert()
    .success();
    let sorted = |run: &Path| {
        let mut lines = designs(run);
        lines.sort();
        lines
    };
    assert_eq!(sorted(&out), sorted(&place("other order")));
    merge(
        &["run 1", "run 2", "run 3"],
        &place("thin"),
        &["--quiet", "--keep-every", "20"],
    )
    .assert()
    .success();
    let thin: serde_json::Value =
        serde_json::from_slice(&fs::read(place("thin").join("run.json")).expect("run.json")).expect("JSON");
    assert!(thin["evaluations"].as_u64().expect("a number") < 300);
    // All designs of the front are kept, but not all of those from which optima are sought that the search has missed.
    let hypervolume = |run: &serde_json::Value| run["verified_hypervolume_kg_m"].as_f64().expect("a number");
    let lost = 1.0 - hypervolume(&thin) / hypervolume(&merged);
    assert!(lost.abs() < 1e-3, "{lost}");
    check(&place("thin")).code(0);
}

#[test]
fn runs_that_cannot_be_joined_are_refused_with_the_difference() {
    let folder = folder();
    let study = small_study(folder.path());
    let place = |name: &str| folder.path().join(name);
    optimize(&study, &place("a"), &["--evaluations", "60", "--no-recording"]);
    optimize(&study, &place("longer"), &["--evaluations", "90", "--no-recording"]);
    optimize(
        &study,
        &place("b"),
        &["--evaluations", "60", "--seed", "9", "--no-recording"],
    );
    optimize(
        &study,
        &place("other"),
        &["--evaluations", "60", "--architectures", "3-RPR", "--no-recording"],
    );
    let refused = |runs: [&str; 2], out: &str, words: &str| {
        let mut command = kinefront();
        command.arg("merge").args(runs.map(place)).arg("--out").arg(place(out));
        let told = command.assert().code(2);
        let text = String::from_utf8_lossy(&told.get_output().stderr).replace("\n  │", "");
        assert!(text.contains(words), "{text}");
    };
    refused(["a", "other"], "x", "`architectures` differs");
    refused(["a", "longer"], "x", "hold the same designs");
    refused(["a", "missing"], "x", "missing");
    refused(["a", "b"], "a", "already holds a run");
    assert!(!place("x").exists(), "nothing is left of a merge that was refused");

    // A merged folder can be neither continued nor extended.
    kinefront()
        .arg("merge")
        .args(["a", "b"].map(place))
        .arg("--out")
        .arg(place("m"))
        .arg("--quiet")
        .assert()
        .success();
    let mut command = kinefront();
    command
        .args(["optimize", "--evaluations", "500", "--resume"])
        .arg(place("m"));
    let told = command.assert().code(2);
    let text = String::from_utf8_lossy(&told.get_output().stderr).replace("\n  │", "");
    assert!(text.contains("designs of several runs"), "{text}");
}

#[test]
fn octave_evaluates_designs() {
    if !Command::new("octave-cli")
        .arg("--version")
        .output()
        .is_ok_and(|found| found.status.success())
    {
        eprintln!("skipped: octave-cli was not found");
        return;
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/matlab");
    let code = format!(
        "addpath ('{}'); r = kinefront ({{'{DESIGN}', '4-PRR R=1'}}); printf ('%.17g %.17g\\n%s\\n', r{{1}}.mass_kg, \
         r{{1}}.workspace_radius_m, r{{2}}.error);",
        folder.display()
    );
    let output = Command::new("octave-cli")
        .args(["--no-gui", "--no-init-file", "--eval", &code])
        .env("KINEFRONT", env!("CARGO_BIN_EXE_kinefront"))
        .output()
        .expect("octave");
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(
        output.status.success(),
        "{text}{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let known = super::support::json(["evaluate", "--json", "--design", DESIGN]);
    let mut lines = text.lines();
    let numbers: Vec<f64> = lines
        .next()
        .expect("a line")
        .split(' ')
        .map(|number| number.parse().expect("a number"))
        .collect();
    assert_eq!(
        numbers,
        [&known["mass_kg"], &known["workspace_radius_m"]].map(|value| value.as_f64().expect("a number"))
    );
    assert!(lines.next().is_some_and(|line| line.contains("4-PRR")), "{text}");
}
