//! Tests of `kinefront merge`, and of the evaluator for MATLAB and Octave.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use super::support::{DESIGN, Folder, check, folder, json, list, number, optimize, parsed, repair, says, small_study};

/// Lines of a table without its first columns, which number its rows.
fn designs(run: &Path) -> Vec<String> {
    let text = fs::read_to_string(run.join("designs.csv")).expect("a table");
    let lines = text
        .lines()
        .skip(1)
        .map(|line| line.splitn(3, ',').nth(2).unwrap_or_default().to_owned());
    lines.collect()
}

/// What a search and the end of its run have found.
fn hypervolumes(report: &Value) -> [f64; 2] {
    ["hypervolume_kg_m", "verified_hypervolume_kg_m"].map(|key| number(&report[key]))
}

fn read_report(run: &Path) -> Value {
    serde_json::from_slice(&fs::read(run.join("run.json")).expect("run.json")).expect("JSON")
}

#[test]
fn runs_of_several_seeds_become_one_whose_front_is_no_worse() {
    let folder = folder();
    let study = small_study(folder.path());
    let more = ["--evaluations", "300", "--front", "40", "--no-recording", "--seed"];
    let reports = ["1", "2", "3"].map(|seed| {
        let run = folder.join(format!("run {seed}"));
        optimize(&study, &run, &[&more[..], &[seed]].concat())
    });
    let told = folder.run("merge 'run 1' 'run 2' 'run 3' --out merged --json");
    let merged = parsed(&told.success());
    assert_eq!(merged["evaluations"], 900);
    assert_eq!(merged["outcome"], "completed");
    let [of_the_search, verified] = hypervolumes(&merged);
    for report in reports.iter().map(hypervolumes) {
        assert!(of_the_search >= report[0]);
        // Of few designs, it matters where the last one before the reference point happens to lie.
        assert!(verified >= 0.995 * report[1]);
    }
    let sources = list(&merged["merged"]).iter();
    let sources: Vec<_> = sources.map(|run| (run["run"].as_str(), run["seed"].as_u64())).collect();
    let names = ["run 1", "run 2", "run 3"];
    assert_eq!(
        sources,
        [1, 2, 3].map(|seed| (Some(names[seed - 1]), Some(seed as u64)))
    );

    // Every design is there, and `origins.csv` leads back to its run.
    let out = folder.join("merged");
    let runs = names.map(|run| designs(&folder.join(run)));
    let all = designs(&out);
    assert_eq!(all.len(), 900);
    let mut reader = csv::Reader::from_path(out.join("origins.csv")).expect("the origins");
    for (id, record) in reader.records().enumerate() {
        let record = record.expect("a row");
        assert_eq!(record[0], id.to_string());
        let run = names.iter().position(|name| *name == &record[1]).expect("a run");
        assert_eq!(all[id], runs[run][record[2].parse::<usize>().expect("an id")]);
    }
    is_a_run_like_others(&folder, &merged);

    // The order of the runs changes ids alone.
    let line = "merge 'run 3' 'run 1' 'run 2' --out other --quiet --no-recording";
    folder.run(line).success();
    let sorted = |run: &str| {
        let mut lines = designs(&folder.join(run));
        lines.sort();
        lines
    };
    assert_eq!(sorted("merged"), sorted("other"));
    // A thinned one keeps the front.
    let line = "merge 'run 1' 'run 2' 'run 3' --out thin --quiet --keep-every 20";
    folder.run(line).success();
    let thin = read_report(&folder.join("thin"));
    assert!(thin["evaluations"].as_u64().expect("a number") < 300);
    // All designs of the front are kept, but not all of those from which optima are sought that the search has missed.
    let lost = 1.0 - hypervolumes(&thin)[1] / verified;
    assert!(lost.abs() < 1e-3, "{lost}");
    check(&folder.join("thin")).code(0);
}

/// Other commands read, check, repair and report on a merged folder.
fn is_a_run_like_others(folder: &Folder, merged: &Value) {
    let out = folder.join("merged");
    check(&out).code(0);
    fs::remove_file(out.join("front.csv")).expect("a front");
    check(&out).code(2);
    repair(&out).code(0);
    check(&out).code(0);
    assert_eq!(read_report(&out)["merged"], merged["merged"]);
    let line = "report merged --out report --sensitivity 0 --picture-width 160";
    folder.run(line).success();
    assert!(folder.join("report/index.html").exists());
}

#[test]
fn runs_that_cannot_be_joined_are_refused_with_the_difference() {
    let folder = folder();
    small_study(folder.path());
    for (run, more) in [
        ("a", "--evaluations 60"),
        ("longer", "--evaluations 90"),
        ("b", "--evaluations 60 --seed 9"),
        ("other", "--evaluations 60 --architectures 3-RPR"),
    ] {
        let line = format!("optimize small.toml --out {run} {more} --no-recording --quiet");
        folder.run(&line).success();
    }
    for (line, words) in [
        ("a other --out x", "`architectures` differs"),
        ("a longer --out x", "hold the same designs"),
        ("a missing --out x", "missing"),
        ("a b --out a", "already holds a run"),
    ] {
        folder.run(&format!("merge {line}")).code(2).stderr(says(words));
    }
    assert!(
        !folder.join("x").exists(),
        "nothing is left of a merge that was refused"
    );

    // A merged folder can be neither continued nor extended.
    folder.run("merge a b --out m --quiet").success();
    let told = folder.run("optimize --evaluations 500 --resume m").code(2);
    told.stderr(says("designs of several runs"));
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
    let known = json(&format!("evaluate --json --design '{DESIGN}'"));
    let mut lines = text.lines();
    let numbers: Vec<f64> = lines
        .next()
        .expect("a line")
        .split(' ')
        .map(|number| number.parse().expect("a number"))
        .collect();
    assert_eq!(
        numbers,
        ["mass_kg", "workspace_radius_m"].map(|key| number(&known[key]))
    );
    assert!(lines.next().is_some_and(|line| line.contains("4-PRR")), "{text}");
}
