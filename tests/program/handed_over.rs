//! What others hand over: run folders of other versions, without their statements, with links and pipes; catalogues and names.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use assert_cmd::assert::Assert;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use serde_json::{Map, Value, json};

use super::support::{
    Folder, check, copy, folder, kinefront, python, resume, run, sample, says, short_run, tables, words,
};

/// Longest time of a command on a folder from elsewhere. Alone, the longest one takes 3 s (a report, which optimizes designs of the front
/// again); beside other tests on two cores it has taken more than 10 s. A command that hangs never ends.
pub const PATIENCE: Duration = Duration::from_secs(40);

/// A run of 90 designs without a recording, which a test may change.
pub fn run_of(folder: &Folder, name: &str, more: &[&str]) -> PathBuf {
    let arguments = [&["--evaluations", "90", "--no-recording"][..], more].concat();
    copy(&short_run(&arguments), &folder.join(name))
}

fn edit_report(run: &Path, edit: impl FnOnce(&mut Map<String, Value>)) {
    let path = run.join("run.json");
    let mut report: Value = serde_json::from_slice(&fs::read(&path).expect("run.json")).expect("JSON");
    edit(report.as_object_mut().expect("an object"));
    fs::write(&path, serde_json::to_vec_pretty(&report).expect("JSON")).expect("run.json");
}

fn cut_rows(table: &Path, keep: usize) {
    let text = fs::read_to_string(table).expect("a table");
    let kept: Vec<&str> = text.lines().take(keep + 1).collect();
    fs::write(table, kept.join("\n") + "\n").expect("a table");
}

pub fn merge(runs: &[&Path], out: &Path) -> Assert {
    let mut command = kinefront();
    command.arg("merge").args(runs).arg("--out").arg(out);
    command.args(["--no-recording", "--quiet"]).timeout(PATIENCE).assert()
}

fn export_front(run: &Path, out: &Path) -> Assert {
    let mut command = kinefront();
    command.arg("export").arg(run).arg("--out").arg(out);
    command.timeout(PATIENCE).assert()
}

#[test]
fn another_version_is_refused_by_name() {
    let folder = folder();
    let run = run_of(&folder, "run", &[]);
    edit_report(&run, |report| {
        report["kinefront_version"] = "9.9.9".into();
        report.remove("seed");
    });
    cut_rows(&run.join("designs.csv"), 60);
    let before = tables(&run);
    check(&run).code(2).stderr(says("9.9.9"));
    for more in [&["--evaluations", "120"][..], &["--accept-unverified"]] {
        resume(&run, more).code(2).stderr(says("9.9.9"));
    }
    let other = run_of(&folder, "other", &["--seed", "9"]);
    merge(&[&run, &other], &folder.join("merged"))
        .code(2)
        .stderr(says("9.9.9"));
    assert!(tables(&run) == before);
    // A report that this version can read is that of another version all the same.
    let run = run_of(&folder, "readable", &[]);
    edit_report(&run, |report| report["kinefront_version"] = "9.9.9".into());
    check(&run).code(2).stderr(says("9.9.9"));
}

#[test]
fn a_folder_that_states_nothing_is_not_sound() {
    let folder = folder();
    let whole = run_of(&folder, "run", &[]);
    let other = run_of(&folder, "other", &["--seed", "9"]);
    type Spoil = fn(&Path);
    let spoils: [(&str, Spoil); 2] = [
        ("nothing", |run| fs::remove_file(run.join("run.json")).expect("a file")),
        ("no_sums", |run| edit_report(run, |report| drop(report.remove("files")))),
    ];
    for (name, spoil) in spoils {
        let run = copy(&whole, &folder.join(name));
        spoil(&run);
        check(&run).code(1).stderr(says("cannot be verified"));
        let told = resume(&run, &["--evaluations", "120"]).code(2);
        told.stderr(says("--accept-unverified"));
        let told = merge(&[&run, &other], &folder.join("merged")).code(2);
        told.stderr(says("--accept-unverified"));
        let told = export_front(&run, &folder.join(format!("{name}.csv"))).code(2);
        told.stderr(says("cannot be verified"));
        // The user may take what is there: the rows that are missing are evaluated again.
        cut_rows(&run.join("designs.csv"), 60);
        resume(&run, &["--accept-unverified"]).success();
        assert!(tables(&run) == tables(&whole), "{name}");
        check(&run).success();
    }
    // A new run has nothing to accept.
    let told = run("optimize paper --accept-unverified").code(2);
    told.stderr(says("--accept-unverified"));
}

#[test]
fn a_report_that_cannot_be_true_is_not_sound() {
    let folder = folder();
    let whole = run_of(&folder, "run", &[]);
    let spoiled = |name: &str, edit: fn(&mut Map<String, Value>)| {
        let run = copy(&whole, &folder.join(name));
        edit_report(&run, edit);
        check(&run).code(2)
    };
    spoiled("time", |report| report["outcome"] = "time_up".into()).stdout(contains("outcome"));
    spoiled("stagnated", |report| report["outcome"] = "stagnated".into()).stdout(contains("outcome"));
    let told = spoiled("merged", |report| {
        let run = json!({ "run": "a", "seed": 1, "evaluations": 50, "kept": 50, "designs": null });
        report.insert("merged".to_owned(), json!([run]));
    });
    told.stdout(contains("merged").and(contains("origins.csv")));
    // The table was shortened, and its statement with it.
    let run = copy(&whole, &folder.join("shortened"));
    cut_rows(&run.join("designs.csv"), 60);
    let table = fs::read(run.join("designs.csv")).expect("a table");
    edit_report(&run, |report| {
        report["files"]["designs.csv"] = json!({ "rows": 60, "bytes": table.len(), "crc32": crc32(&table) });
    });
    check(&run).code(2).stdout(contains("90 designs of the study"));
}

/// CRC-32 of IEEE 802.3, bit by bit.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |sum, &byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| {
            (sum >> 1) ^ (0xedb8_8320 & (sum & 1).wrapping_neg())
        })
    })
}

#[test]
fn a_front_that_the_run_did_not_write_is_not_exported() {
    let folder = folder();
    let whole = run_of(&folder, "run", &[]);
    let front = fs::read_to_string(whole.join("front.csv")).expect("a front");
    let row = front.lines().nth(1).expect("a row");
    let mass = row.split(',').nth(8).expect("a field");
    let short: Vec<&str> = front.lines().take(3).collect();
    let spoiled = [
        ("short", short.join("\n") + "\n"),
        ("changed", front.replacen(mass, "0.001", 1)),
        ("cut", front[..front.len() - 20].to_owned()),
    ];
    for (name, text) in spoiled {
        let run = copy(&whole, &folder.join(name));
        fs::write(run.join("front.csv"), text).expect("a front");
        for extension in ["csv", "parquet"] {
            let out = folder.join(format!("{name}.{extension}"));
            export_front(&run, &out).code(2).stderr(says("front.csv"));
            assert!(!out.exists());
        }
    }
    // A table apart from its run has nothing but its rows.
    let apart = folder.write("apart.csv", &front[..front.len() - 20]);
    let told = export_front(&apart, &folder.join("apart.parquet")).code(2);
    told.stderr(says("incomplete"));
    folder.write("apart.csv", &front);
    export_front(&apart, &folder.join("apart.parquet")).success();
}

#[test]
fn a_run_counts_once_also_within_a_merged_one() {
    let folder = folder();
    let runs = [1, 2].map(|seed: u32| run_of(&folder, &format!("a{seed}"), &["--seed", &seed.to_string()]));
    let merged = folder.join("merged");
    merge(&[&runs[0], &runs[1]], &merged).success();
    for run in &runs {
        for both in [[&merged, run], [run, &merged]] {
            let out = folder.join("again");
            let told = merge(&both.map(PathBuf::as_path), &out).code(2);
            told.stderr(says("list each run once"));
            assert!(!out.exists());
        }
    }
}

/// Whatever a folder from elsewhere holds: no command panics, hangs, or writes outside the folder and `--out`.
#[cfg(unix)]
#[test]
fn hostile_folders_are_survived() {
    let Some(mut python) = python(&["json"]) else { return };
    let folder = folder();
    let run = run_of(&folder, "run", &[]);
    run_of(&folder, "other", &["--seed", "9"]);
    let (out, count) = (folder.join("hostile"), 200);
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/tools/hostile.py");
    let made = python.arg(script).arg(&run).arg(&out);
    let made = made.args([&count.to_string(), "1"]).status();
    assert!(made.expect("Python runs").success());
    fs::create_dir(folder.join("results")).expect("a folder");
    for number in sample(0..count, 5) {
        let hostile = format!("hostile/run{number}");
        let to = |name: &str| format!("results/{number}-{name}");
        let commands = [
            format!("check {hostile}"),
            format!("export {hostile} --out {}", to("front.csv")),
            format!("show {hostile}/front.csv#0 --record {}", to("design.rrd")),
            format!("report {hostile} --out {} --picture-width 160", to("report")),
            format!("merge {hostile} other --out {} --no-recording", to("merged")),
            format!("check --repair {hostile}"),
            format!("optimize --resume {hostile} --no-recording --quiet"),
        ];
        for line in commands {
            let mut command = kinefront();
            command.current_dir(folder.path()).args(words(&line));
            let told = command.timeout(PATIENCE).assert();
            let output = told.get_output();
            let said = String::from_utf8_lossy(&output.stderr);
            let is_told = matches!(output.status.code(), Some(0..=3));
            assert!(is_told, "{line}: {:?} {said}", output.status);
            assert!(!said.contains("panicked"), "{line}: {said}");
            assert!(!said.contains(['\u{7}', '\0']), "{line}: {said}");
        }
        assert_eq!(folder.read("hostile/victim"), "precious", "{number}");
    }
    let left = fs::read_dir(&out).expect("a folder");
    let mut left: Vec<_> = left.map(|entry| entry.expect("an entry").file_name()).collect();
    left.retain(|name| !name.to_string_lossy().starts_with("run"));
    assert_eq!(left, ["victim"]);
}
