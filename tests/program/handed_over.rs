//! What others hand over: run folders of other versions, without their statements, with links and pipes; catalogues and names.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use assert_cmd::assert::Assert;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use serde_json::Value;

use super::support::{DESIGN, check, folder, kinefront, optimize, python, resume, sample, says, short_study, tables};

/// Longest time of a command on a folder from elsewhere. Alone, the longest one takes 3 s (a report, which optimizes designs of the front
/// again); beside other tests on two cores it has taken more than 10 s. A command that hangs never ends.
const PATIENCE: Duration = Duration::from_secs(40);

/// A run of 90 designs without a recording.
fn run_of(folder: &Path, name: &str, more: &[&str]) -> PathBuf {
    let run = folder.join(name);
    let arguments = ["--evaluations", "90", "--no-recording"];
    let arguments: Vec<&str> = arguments.iter().chain(more).copied().collect();
    optimize(&short_study(folder), &run, &arguments);
    run
}

fn copy(run: &Path, to: &Path) -> PathBuf {
    fs::create_dir(to).expect("a folder");
    for entry in fs::read_dir(run).expect("a folder") {
        let entry = entry.expect("an entry");
        fs::copy(entry.path(), to.join(entry.file_name())).expect("a copy");
    }
    to.to_owned()
}

fn edit_report(run: &Path, edit: impl FnOnce(&mut serde_json::Map<String, Value>)) {
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

fn merge(runs: &[&Path], out: &Path) -> Assert {
    let mut command = kinefront();
    command.arg("merge").args(runs).arg("--out").arg(out);
    command.args(["--no-recording", "--quiet"]).timeout(PATIENCE).assert()
}

fn export_front(run: &Path, out: &Path) -> Assert {
    kinefront()
        .arg("export")
        .arg(run)
        .arg("--out")
        .arg(out)
        .timeout(PATIENCE)
        .assert()
}

#[test]
fn another_version_is_refused_by_name() {
    let folder = folder();
    let run = run_of(folder.path(), "run", &[]);
    edit_report(&run, |report| {
        report["kinefront_version"] = "9.9.9".into();
        report.remove("seed");
    });
    cut_rows(&run.join("designs.csv"), 60);
    let before = tables(&run);
    check(&run).code(2).stderr(contains("9.9.9"));
    resume(&run, &["--evaluations", "120"])
        .code(2)
        .stderr(contains("9.9.9"));
    resume(&run, &["--accept-unverified"]).code(2).stderr(contains("9.9.9"));
    let other = run_of(folder.path(), "other", &["--seed", "9"]);
    merge(&[&run, &other], &folder.path().join("merged"))
        .code(2)
        .stderr(contains("9.9.9"));
    assert!(tables(&run) == before);
    // A report that this version can read is that of another version all the same.
    let run = run_of(folder.path(), "readable", &[]);
    edit_report(&run, |report| report["kinefront_version"] = "9.9.9".into());
    check(&run).code(2).stderr(contains("9.9.9"));
}

#[test]
fn a_folder_that_states_nothing_is_not_sound() {
    let folder = folder();
    let whole = run_of(folder.path(), "run", &[]);
    for (name, spoil) in [
        (
            "nothing",
            (|run: &Path| fs::remove_file(run.join("run.json")).expect("a file")) as fn(&Path),
        ),
        ("no_sums", |run: &Path| {
            edit_report(run, |report| drop(report.remove("files")))
        }),
    ] {
        let run = copy(&whole, &folder.path().join(name));
        spoil(&run);
        check(&run).code(1).stderr(contains("cannot be verified"));
        resume(&run, &["--evaluations", "120"])
            .code(2)
            .stderr(says("--accept-unverified"));
        merge(
            &[
                &run,
                &run_of(folder.path(), &format!("beside_{name}"), &["--seed", "9"]),
            ],
            &folder.path().join("merged"),
        )
        .code(2)
        .stderr(contains("--accept-unverified"));
        export_front(&run, &folder.path().join(format!("{name}.csv")))
            .code(2)
            .stderr(contains("cannot be verified"));
        // A new run has nothing to accept.
        kinefront()
            .args(["optimize", "paper", "--accept-unverified"])
            .assert()
            .code(2)
            .stderr(contains("--accept-unverified"));
        // The user may take what is there: the rows that are missing are evaluated again.
        cut_rows(&run.join("designs.csv"), 60);
        resume(&run, &["--accept-unverified"]).success();
        assert!(tables(&run) == tables(&whole), "{name}");
        check(&run).success();
    }
}

#[test]
fn a_report_that_cannot_be_true_is_not_sound() {
    let folder = folder();
    let whole = run_of(folder.path(), "run", &[]);
    let spoiled = |name: &str, edit: fn(&mut serde_json::Map<String, Value>)| {
        let run = copy(&whole, &folder.path().join(name));
        edit_report(&run, edit);
        check(&run).code(2)
    };
    spoiled("time", |report| report["outcome"] = "time_up".into()).stdout(contains("outcome"));
    spoiled("stagnated", |report| report["outcome"] = "stagnated".into()).stdout(contains("outcome"));
    spoiled("merged", |report| {
        report.insert(
            "merged".to_owned(),
            serde_json::json!([{ "run": "a", "seed": 1, "evaluations": 50, "kept": 50, "designs": null }]),
        );
    })
    .stdout(contains("merged").and(contains("origins.csv")));
    // The table was shortened, and its statement with it.
    let run = copy(&whole, &folder.path().join("shortened"));
    cut_rows(&run.join("designs.csv"), 60);
    let table = fs::read(run.join("designs.csv")).expect("a table");
    edit_report(&run, |report| {
        report["files"]["designs.csv"] =
            serde_json::json!({ "rows": 60, "bytes": table.len(), "crc32": crc32(&table) });
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
    let whole = run_of(folder.path(), "run", &[]);
    let front = fs::read_to_string(whole.join("front.csv")).expect("a front");
    let mass = front
        .lines()
        .nth(1)
        .expect("a row")
        .split(',')
        .nth(8)
        .expect("a field")
        .to_owned();
    let spoiled = [
        (
            "short",
            front
                .lines()
                .take(3)
                .map(|line| format!("{line}\n"))
                .collect::<String>(),
        ),
        ("changed", front.replacen(&mass, "0.001", 1)),
        ("cut", front[..front.len() - 20].to_owned()),
    ];
    for (name, text) in spoiled {
        let run = copy(&whole, &folder.path().join(name));
        fs::write(run.join("front.csv"), text).expect("a front");
        for extension in ["csv", "parquet"] {
            let out = folder.path().join(format!("{name}.{extension}"));
            export_front(&run, &out).code(2).stderr(contains("front.csv"));
            assert!(!out.exists());
        }
    }
    // A table apart from its run has nothing but its rows.
    let apart = folder.path().join("apart.csv");
    fs::write(&apart, &front[..front.len() - 20]).expect("a table");
    export_front(&apart, &folder.path().join("apart.parquet"))
        .code(2)
        .stderr(contains("incomplete"));
    fs::write(&apart, &front).expect("a table");
    export_front(&apart, &folder.path().join("apart.parquet")).success();
}

#[test]
fn a_run_counts_once_also_within_a_merged_one() {
    let folder = folder();
    let runs = [1, 2].map(|seed: u32| run_of(folder.path(), &format!("a{seed}"), &["--seed", &seed.to_string()]));
    let merged = folder.path().join("merged");
    merge(&[&runs[0], &runs[1]], &merged).success();
    for run in &runs {
        for both in [[&merged, run], [run, &merged]] {
            let out = folder.path().join("again");
            merge(&both.map(PathBuf::as_path), &out)
                .code(2)
                .stderr(says("list each run once"));
            assert!(!out.exists());
        }
    }
}

/// A link in a run folder is replaced; what it leads to is neither read as a table of the run nor written to.
#[cfg(unix)]
#[test]
fn nothing_outside_the_folder_is_written_through_a_link() {
    use std::os::unix::fs::symlink;

    let folder = folder();
    let victim = folder.path().join("victim");
    let untouched = || assert_eq!(fs::read(&victim).expect("the victim"), b"precious");
    fs::write(&victim, "precious").expect("a victim");
    let study = short_study(folder.path());
    // A name that a temporary file once had, before the run.
    let run = folder.path().join("run");
    fs::create_dir(&run).expect("a folder");
    for name in ["run.json", "study.toml", "front.csv", "progress.json"] {
        symlink(&victim, run.join(format!(".{name}.partial"))).expect("a link");
    }
    optimize(&study, &run, &["--evaluations", "90"]);
    untouched();
    // Files of the run are links: they are replaced, not written through.
    let whole = tables(&run);
    for name in ["front.csv", "recording.rrd", "progress.json"] {
        let _ = fs::remove_file(run.join(name));
        symlink(&victim, run.join(name)).expect("a link");
    }
    fs::remove_file(run.join("progress.json")).expect("a link");
    kinefront().args(["check", "--repair"]).arg(&run).assert().success();
    untouched();
    assert!(tables(&run) == whole);
    assert!(
        !fs::symlink_metadata(run.join("recording.rrd"))
            .expect("a recording")
            .is_symlink()
    );
    // The table of the designs is the lock of the folder: a link in its place is refused.
    let linked = folder.path().join("linked");
    fs::create_dir(&linked).expect("a folder");
    symlink(&victim, linked.join("designs.csv")).expect("a link");
    kinefront()
        .arg("optimize")
        .arg(&study)
        .arg("--out")
        .arg(&linked)
        .assert()
        .code(2)
        .stderr(contains("regular file"));
    untouched();
    let table = run.join("designs.csv");
    fs::rename(&table, folder.path().join("designs.csv")).expect("a move");
    symlink(folder.path().join("designs.csv"), &table).expect("a link");
    resume(&run, &["--evaluations", "120"])
        .code(2)
        .stderr(contains("regular file"));
}

/// Files that have no end, or that nobody writes, are refused at once.
#[cfg(unix)]
#[test]
fn pipes_and_devices_are_refused() {
    use std::os::unix::fs::symlink;
    use std::process::Command;

    let folder = folder();
    let whole = run_of(folder.path(), "run", &[]);
    let pipe = |path: &Path| {
        assert!(
            Command::new("mkfifo")
                .arg(path)
                .status()
                .expect("mkfifo runs")
                .success()
        )
    };
    let zero = |path: &Path| symlink("/dev/zero", path).expect("a link");
    let sparse = |path: &Path| {
        let file = fs::File::create(path).expect("a file");
        file.set_len(1 << 40).expect("a sparse file");
    };
    type Make<'a> = &'a dyn Fn(&Path);
    let kinds: [(&str, Make<'_>); 3] = [("pipe", &pipe), ("zero", &zero), ("sparse", &sparse)];
    let files = ["study.toml", "designs.csv", "front.csv", "run.json", "progress.json"];
    let cases: Vec<_> = kinds.iter().flat_map(|kind| files.map(|file| (kind, file))).collect();
    for ((name, make), file) in sample(cases.into_iter(), 8) {
        let run = copy(&whole, &folder.path().join(format!("{name}-{file}")));
        let _ = fs::remove_file(run.join(file));
        make(&run.join(file));
        for arguments in [
            &["check"][..],
            &["optimize", "--resume"],
            &["export", "--out", "/dev/null/front.csv"],
        ] {
            let told = kinefront().args(arguments).arg(&run).timeout(PATIENCE).assert();
            let code = told.get_output().status.code();
            // A run that is complete needs no other file to say so.
            let least = if arguments[0] == "optimize" { 0 } else { 1 };
            assert!(
                code.is_some_and(|code| (least..=3).contains(&code)),
                "{name} {file} {arguments:?}: {code:?}"
            );
        }
    }
    let study = folder.path().join("tubes.toml");
    for (name, make) in kinds {
        let catalogue = folder.path().join(name);
        make(&catalogue);
        let text = format!("[sections]\nlegs = {{ kind = \"tube\", catalogue = \"{name}\" }}\n");
        fs::write(&study, text).expect("a study");
        kinefront()
            .args(["study", "check"])
            .arg(&study)
            .timeout(PATIENCE)
            .assert()
            .code(2)
            .stderr(contains("catalogue"));
    }
}

#[test]
fn a_study_names_no_files_outside_its_folder() {
    let folder = folder();
    let inside = folder.path().join("inside");
    fs::create_dir(&inside).expect("a folder");
    let secret = folder.path().join("secret.csv");
    fs::write(&secret, "root:secret,of,others\nanother:secret\n").expect("a file");
    let good = folder.path().join("tubes.csv");
    fs::write(&good, "name,outer_mm,wall_mm\na,30,2\nb,40,3\n").expect("a catalogue");
    let study = |catalogue: &str| {
        let path = inside.join("study.toml");
        let text = format!("[sections]\nlegs = {{ kind = \"tube\", catalogue = '{catalogue}' }}\n");
        fs::write(&path, text).expect("a study");
        path
    };
    let checked = |path: &Path, more: &[&str]| kinefront().args(["study", "check"]).arg(path).args(more).assert();
    for outside in [
        "../tubes.csv".to_owned(),
        good.display().to_string(),
        "../secret.csv".to_owned(),
    ] {
        checked(&study(&outside), &[])
            .code(2)
            .stderr(contains("--outside-files"));
    }
    checked(&study("../tubes.csv"), &["--outside-files"]).success();
    // What is in a file that is not a catalogue is not told.
    checked(&study("../secret.csv"), &["--outside-files"]).code(2).stderr(
        contains("must name the columns")
            .and(contains("secret,of").not())
            .and(contains("another").not()),
    );
    fs::copy(&good, inside.join("tubes.csv")).expect("a catalogue");
    checked(&study("tubes.csv"), &[]).success();
    checked(&study("../inside/tubes.csv"), &[]).success();
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(&secret, inside.join("link.csv")).expect("a link");
        checked(&study("link.csv"), &[])
            .code(2)
            .stderr(contains("--outside-files"));
    }
}

#[test]
fn names_reach_neither_terminals_nor_spreadsheets_as_commands() {
    let folder = folder();
    let path = folder.path().join("study.toml");
    let named = |name: &str| {
        fs::write(&path, format!("name = {name}\n")).expect("a study");
        kinefront().args(["study", "check"]).arg(&path).assert()
    };
    for (name, told) in [
        ("\"a\\u001b]0;title\\u0007\"", "\\u{1b}"),
        ("\"a\\u202eb\"", "\\u{202e}"),
        ("\"a\\nb\"", "\\u{a}"),
        ("\"a\\u0000b\"", "\\u{0}"),
        (&format!("\"{}\"", "n".repeat(101)), "101 characters"),
        (&format!("\"{}\"", "n".repeat(300)), "300 characters"),
    ] {
        named(name).code(2).stderr(contains(told).and(contains("name")));
    }
    named(&format!("\"{}\"", "n".repeat(100))).success();
    // A message that quotes a file does not pass its characters on.
    fs::write(&path, "nam\u{1b}[2Je = 1\n").expect("a study");
    let told = kinefront().args(["study", "check"]).arg(&path).assert().code(2);
    assert!(!told.get_output().stderr.contains(&0x1b));
    let told = kinefront()
        .args(["check", "missing\u{1b}]0;title\u{7}\u{202e}"])
        .assert()
        .code(2);
    let told = String::from_utf8(told.get_output().stderr.clone()).expect("UTF-8");
    assert!(
        told.contains("\\u{1b}") && !told.contains(['\u{1b}', '\u{7}', '\u{202e}']),
        "{told}"
    );
    // A reference design is a mark in the front, and a folder a name in the origins.
    fs::write(
        &path,
        format!(
            "{}[[references]]\nname = \"=1+1\"\ndesign = \"{DESIGN}\"\n",
            kinefront_testkit::small_study(90)
        ),
    )
    .expect("a study");
    let runs = ["-1+1", "@a"].map(|name| folder.path().join(name));
    for (seed, run) in runs.iter().enumerate() {
        optimize(&path, run, &["--no-recording", "--seed", &seed.to_string()]);
        let front = fs::read_to_string(run.join("front.csv")).expect("a front");
        assert!(!front.contains(",=") && !front.contains(",@"), "{front}");
    }
    let merged = folder.path().join("merged");
    merge(&[&runs[0], &runs[1]], &merged).success();
    let origins = fs::read_to_string(merged.join("origins.csv")).expect("origins");
    let mut names: Vec<&str> = origins
        .lines()
        .skip(1)
        .filter_map(|line| line.split('"').nth(1))
        .collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names, ["'-1+1", "'@a"]);
    check(&merged).success();
}

/// A write beyond the limit of the size of a file fails like any other.
#[cfg(target_os = "linux")]
#[test]
fn a_limit_of_the_size_of_files_is_told() {
    let folder = folder();
    let run = folder.path().join("run");
    let script = format!(
        "ulimit -f 16; exec {} optimize {} --evaluations 600 --out {} --no-recording --quiet",
        env!("CARGO_BIN_EXE_kinefront"),
        short_study(folder.path()).display(),
        run.display()
    );
    let ended = std::process::Command::new("sh")
        .args(["-c", &script])
        .output()
        .expect("sh runs");
    let told = String::from_utf8_lossy(&ended.stderr);
    assert_eq!(ended.status.code(), Some(3), "{told}");
    assert!(told.contains("designs.csv") && told.contains("too large"), "{told}");
    resume(&run, &[]).success();
    check(&run).success();
}

/// Whatever a folder from elsewhere holds: no command panics, hangs, or writes outside the folder and `--out`.
#[cfg(unix)]
#[test]
fn hostile_folders_are_survived() {
    let Some(mut python) = python(&["json"]) else { return };
    let folder = folder();
    let run = run_of(folder.path(), "run", &[]);
    let (out, count) = (folder.path().join("hostile"), 200);
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/tools/hostile.py");
    let made = python
        .arg(script)
        .arg(&run)
        .arg(&out)
        .args([&count.to_string(), "1"])
        .status();
    assert!(made.expect("Python runs").success());
    let other = run_of(folder.path(), "other", &["--seed", "9"]);
    let results = folder.path().join("results");
    fs::create_dir(&results).expect("a folder");
    let victim = out.join("victim");
    for number in sample(0..count, 8) {
        let hostile = out.join(format!("run{number}"));
        let result = |name: &str| results.join(format!("{name}{number}"));
        let commands: [(&str, Vec<PathBuf>); 7] = [
            ("check", vec![hostile.clone()]),
            ("export", vec![hostile.clone(), "--out".into(), result("front.csv")]),
            (
                "show",
                vec![hostile.join("front.csv#0"), "--record".into(), result("design.rrd")],
            ),
            (
                "report",
                vec![
                    hostile.clone(),
                    "--out".into(),
                    result("report"),
                    "--picture-width".into(),
                    "160".into(),
                ],
            ),
            (
                "merge",
                vec![
                    hostile.clone(),
                    other.clone(),
                    "--out".into(),
                    result("merged"),
                    "--no-recording".into(),
                ],
            ),
            ("check", vec!["--repair".into(), hostile.clone()]),
            (
                "optimize",
                vec![
                    "--resume".into(),
                    hostile.clone(),
                    "--no-recording".into(),
                    "--quiet".into(),
                ],
            ),
        ];
        for (command, arguments) in commands {
            let told = kinefront().arg(command).args(&arguments).timeout(PATIENCE).assert();
            let output = told.get_output();
            let said = String::from_utf8_lossy(&output.stderr);
            assert!(
                matches!(output.status.code(), Some(0..=3)),
                "{number} {command}: {:?} {said}",
                output.status
            );
            assert!(!said.contains("panicked"), "{number} {command}: {said}");
            assert!(!said.contains(['\u{7}', '\0']), "{number} {command}: {said}");
        }
        assert_eq!(fs::read(&victim).expect("the victim"), b"precious", "{number}");
    }
    let mut left: Vec<_> = fs::read_dir(&out)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").file_name())
        .collect();
    left.retain(|name| !name.to_string_lossy().starts_with("run"));
    assert_eq!(left, ["victim"]);
}
