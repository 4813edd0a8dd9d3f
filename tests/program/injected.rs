//! Every call to the operating system fails once, as it does on a disk that is full or broken: nothing that was on the disk is lost,
//! and what remains can be resumed to the run that was never disturbed.
#![cfg(target_os = "linux")]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use super::support::{check, folder, is_thorough, kinefront, optimize, resume, sample, small_study, tables};

/// Calls that ask for memory.
const MEMORY: &str = "mmap";

/// Calls that a run makes to its files and for its memory and threads, with the error that each fails with in turn.
const CALLS: [(&str, &[&str]); 10] = [
    ("openat", &["EACCES", "EMFILE", "ENOSPC"]),
    ("write", &["ENOSPC", "EIO", "EINTR"]),
    ("fsync,fdatasync", &["EIO", "ENOSPC"]),
    ("rename,renameat,renameat2", &["EIO", "EACCES"]),
    ("unlink,unlinkat", &["EACCES", "EIO"]),
    ("mkdir,mkdirat", &["ENOSPC", "EACCES"]),
    ("flock", &["EIO", "EINTR"]),
    ("ftruncate", &["EIO"]),
    ("clone,clone3", &["EAGAIN"]),
    (MEMORY, &["ENOMEM"]),
];

/// A command to disturb, on a copy of a run in the folder.
struct Scenario {
    name: &'static str,
    arguments: fn(&Path, &Path) -> Vec<PathBuf>,
    /// Whether the command works in the run folder, which then has to be resumed or repaired.
    changes_run: bool,
}

fn paths<const N: usize>(arguments: [&str; N]) -> Vec<PathBuf> {
    arguments.map(PathBuf::from).to_vec()
}

const SCENARIOS: [Scenario; 6] = [
    Scenario {
        name: "optimize",
        arguments: |folder, _| {
            let mut all = paths(["optimize", "--evaluations", "90", "--no-recording", "--quiet"]);
            all.extend([folder.join("small.toml"), "--out".into(), folder.join("new")]);
            all
        },
        changes_run: false,
    },
    Scenario {
        name: "resume",
        arguments: |_, run| {
            let mut all = paths(["optimize", "--evaluations", "120", "--no-recording", "--quiet"]);
            all.extend(["--resume".into(), run.to_owned()]);
            all
        },
        changes_run: true,
    },
    Scenario {
        name: "repair",
        arguments: |_, run| {
            let front = run.join("front.csv");
            let text = fs::read(&front).expect("a front");
            fs::write(&front, &text[..text.len() / 2]).expect("a front");
            vec!["check".into(), "--repair".into(), run.to_owned()]
        },
        changes_run: true,
    },
    Scenario {
        name: "merge",
        arguments: |folder, run| {
            let mut all = paths(["merge", "--no-recording", "--quiet", "--out"]);
            all.extend([folder.join("new"), run.to_owned(), folder.join("other")]);
            all
        },
        changes_run: false,
    },
    Scenario {
        name: "report",
        arguments: |folder, run| {
            let mut all = paths([
                "report",
                "--quiet",
                "--picture-width",
                "160",
                "--scale",
                "0.25",
                "--out",
            ]);
            all.extend([folder.join("new"), run.to_owned()]);
            all
        },
        changes_run: false,
    },
    Scenario {
        name: "export",
        arguments: |folder, run| vec!["export".into(), run.to_owned(), "--out".into(), folder.join("new.csv")],
        changes_run: false,
    },
];

/// Writes a small study with few designs on its front, which make each of the many runs short.
fn short_study(folder: &Path) -> PathBuf {
    let study = small_study(folder);
    let text = fs::read_to_string(&study).expect("a study");
    fs::write(&study, text.replace("front_designs = 8", "front_designs = 3")).expect("a study");
    study
}

/// Returns the number of calls that the loader of the program and its start make, which are not those of a command.
fn calls_of_start(calls: &str) -> usize {
    let log = tempfile::NamedTempFile::new().expect("a file");
    let status = Command::new("strace")
        .args(["-f", "-qq", "-e", &format!("trace={calls}"), "-o"])
        .arg(log.path())
        .arg(env!("CARGO_BIN_EXE_kinefront"))
        .arg("--version")
        .output();
    assert!(status.expect("strace runs").status.success());
    fs::read_to_string(log.path()).expect("a log").lines().count()
}

/// Runs the program with the `when`-th of the calls failing.
fn disturb(arguments: &[PathBuf], calls: &str, error: &str, when: usize) -> (Output, bool) {
    let log = tempfile::NamedTempFile::new().expect("a file");
    let output = Command::new("strace")
        .args(["-f", "-qq", "-o"])
        .arg(log.path())
        .args(["-e", &format!("trace={calls}")])
        .args(["-e", &format!("inject={calls}:error={error}:when={when}")])
        .arg(env!("CARGO_BIN_EXE_kinefront"))
        .args(arguments)
        .env_remove("RERUN")
        .env("NO_COLOR", "1")
        .output()
        .expect("strace runs");
    let fired = fs::read_to_string(log.path()).expect("a log").contains("(INJECTED)");
    (output, fired)
}

#[test]
fn every_call_fails_once() {
    if Command::new("strace").arg("-V").output().is_err() {
        eprintln!("skipped: there is no strace");
        return;
    }
    let folder = folder();
    let study = short_study(folder.path());
    let (whole, longer, other) = (
        folder.path().join("whole"),
        folder.path().join("longer"),
        folder.path().join("other"),
    );
    let arguments = |count: &'static str| ["--evaluations", count, "--no-recording"];
    optimize(&study, &whole, &arguments("90"));
    optimize(&study, &longer, &arguments("120"));
    optimize(
        &study,
        &other,
        &["--evaluations", "90", "--no-recording", "--seed", "9"],
    );
    let [kept, extended] = [tables(&whole), tables(&longer)];
    let prepare = || {
        let _ = fs::remove_dir_all(folder.path().join("new"));
        let _ = fs::remove_file(folder.path().join("new.csv"));
        let run = folder.path().join("run");
        let _ = fs::remove_dir_all(&run);
        fs::create_dir(&run).expect("a folder");
        for name in ["study.toml", "designs.csv", "front.csv", "run.json"] {
            fs::copy(whole.join(name), run.join(name)).expect("a copy");
        }
        run
    };
    // What is disturbed does its work when it is not.
    for scenario in &SCENARIOS {
        let arguments = (scenario.arguments)(folder.path(), &prepare());
        kinefront().args(arguments).assert().success();
    }
    let cases: Vec<_> = SCENARIOS
        .iter()
        .flat_map(|scenario| CALLS.iter().map(move |(calls, errors)| (scenario, *calls, *errors)))
        .collect();
    let (mut injected, mut table) = (0, BTreeMap::new());
    for (place, (scenario, calls, errors)) in cases.into_iter().enumerate() {
        // All calls until there are no more, or one of them, another for each kind of call. A report takes seconds.
        let one = if place % 2 == 0 { 1 + place % 3 } else { 4 + place % 17 };
        // A loader without memory ends by a signal.
        let start = match calls == MEMORY {
            true => calls_of_start(calls),
            false => 0,
        };
        let times = match is_thorough() {
            true => 1..10_000,
            false if scenario.name == "report" && place % 3 != 0 => continue,
            false => one..one + 1,
        };
        let times = start + times.start..start + times.end;
        for when in times {
            let error = errors[when % errors.len()];
            let run = prepare();
            let arguments = (scenario.arguments)(folder.path(), &run);
            let (output, fired) = disturb(&arguments, calls, error, when);
            if !fired {
                break;
            }
            injected += 1;
            *table.entry((scenario.name, calls)).or_insert(0) += 1;
            let said = String::from_utf8_lossy(&output.stderr);
            // The loader of the program is not the program.
            if said.contains("error while loading shared libraries") {
                continue;
            }
            let what = format!("{}: {calls} {when} {error}: {:?} {said}", scenario.name, output.status);
            assert!(!said.contains("panicked"), "{what}");
            assert!(matches!(output.status.code(), Some(0..=3)), "{what}");
            // The other runs are as they were, whatever failed.
            assert!(tables(&whole) == kept && tables(&longer) == extended, "{what}");
            if scenario.changes_run {
                // No design is lost, and the run can be completed to what it would have been.
                let rows = fs::read(run.join("designs.csv")).expect("designs");
                assert!(rows.starts_with(&kept[1]) || kept[1].starts_with(&rows), "{what}");
                resume(&run, &["--evaluations", "120", "--no-recording"]).success();
                assert!(tables(&run) == extended, "{what}");
                check(&run).success();
            } else if scenario.name == "optimize" {
                complete(&study, &folder.path().join("new"));
                assert!(tables(&folder.path().join("new")) == kept, "{what}");
            } else {
                assert!(tables(&run) == kept, "{what}");
            }
        }
    }
    for ((scenario, calls), count) in table {
        println!("| {scenario} | {calls} | {count} |");
    }
    assert!(injected > 15, "only {injected} calls failed");
}

/// A command that runs out of memory says so and ends with a documented code. What it leaves is what a command that is killed leaves.
#[test]
fn little_memory_ends_a_command_in_good_order() {
    let folder = folder();
    let study = short_study(folder.path());
    let [whole, longer] = ["whole", "longer"].map(|name| folder.path().join(name));
    optimize(&study, &whole, &["--evaluations", "90"]);
    optimize(&study, &longer, &["--evaluations", "120"]);
    let [kept, extended] = [tables(&whole), tables(&longer)];
    // The shell limits the address space, in KiB. With one heap for all threads, an allocation fails where the memory ends.
    let limited = |space: usize, arguments: &[PathBuf]| {
        let mut command = Command::new("sh");
        command
            .args(["-c", &format!("ulimit -v {space} && exec \"$0\" \"$@\"")])
            .arg(env!("CARGO_BIN_EXE_kinefront"))
            .args(arguments)
            .env_remove("RERUN")
            .env("NO_COLOR", "1")
            .env("MALLOC_ARENA_MAX", "1");
        command.output().expect("a shell")
    };
    // Below, the loader of the program has no space for the program itself.
    let is_loaded = |space: usize| limited(space, &["--version".into()]).status.success();
    let (mut low, mut high) = (10_000, 4_000_000);
    while high - low > 500 {
        let middle = usize::midpoint(low, high);
        if is_loaded(middle) { high = middle } else { low = middle }
    }
    let run = folder.path().join("run");
    let (mut lacking, mut enough) = (BTreeMap::new(), 0);
    for scenario in ["optimize", "resume", "repair", "export", "report"] {
        if scenario == "report" && !is_thorough() {
            continue;
        }
        for step in sample(0..60_usize, 10) {
            let out = folder.path().join("new");
            for path in [&run, &out] {
                let _ = fs::remove_dir_all(path);
            }
            let _ = fs::remove_file(folder.path().join("new.csv"));
            copy_folder(&whole, &run);
            let mut arguments = match scenario {
                "optimize" => paths(["optimize", "--evaluations", "90", "--quiet", "--out"]),
                "resume" => paths(["optimize", "--evaluations", "120", "--quiet", "--resume"]),
                "repair" => paths(["check", "--repair"]),
                "export" => paths(["export", "--out"]),
                _ => paths([
                    "report",
                    "--quiet",
                    "--picture-width",
                    "160",
                    "--scale",
                    "0.25",
                    "--out",
                ]),
            };
            arguments.extend(match scenario {
                "optimize" => vec![out.clone(), study.clone()],
                "resume" => vec![run.clone()],
                "repair" => {
                    fs::remove_file(run.join("recording.rrd")).expect("a recording");
                    vec![run.clone()]
                }
                "export" => vec![folder.path().join("new.csv"), run.clone()],
                _ => vec![out.clone(), run.clone()],
            });
            let output = limited(high + 2000 * step, &arguments);
            let said = String::from_utf8_lossy(&output.stderr);
            let what = format!("{scenario} with {step}: {:?} {said}", output.status);
            // Code 2 is that of `check` where a file cannot be judged.
            match output.status.code() {
                Some(0) => enough += 1,
                Some(code @ 1..=3) => *lacking.entry((scenario, code)).or_insert(0) += 1,
                _ => panic!("{what}"),
            }
            assert!(!said.contains("panicked"), "{what}");
            assert!(tables(&whole) == kept && tables(&longer) == extended, "{what}");
            if scenario == "optimize" {
                complete(&study, &out);
                assert!(tables(&out) == kept, "{what}");
            } else if scenario == "resume" {
                resume(&run, &["--evaluations", "120"]).success();
                assert!(tables(&run) == extended, "{what}");
            } else {
                assert!(tables(&run) == kept, "{what}");
            }
        }
    }
    for ((scenario, code), count) in &lacking {
        println!("| {scenario} | {code} | {count} |");
    }
    let is_out_of_memory = lacking.keys().any(|(_, code)| *code == 3);
    assert!(
        is_out_of_memory && enough > 5,
        "{lacking:?}, {enough} ended as without a limit"
    );
}

fn copy_folder(from: &Path, to: &Path) {
    fs::create_dir(to).expect("a folder");
    for entry in fs::read_dir(from).expect("a folder") {
        let path = entry.expect("an entry").path();
        fs::copy(&path, to.join(path.file_name().expect("a name"))).expect("a file");
    }
}

/// Brings a run that was disturbed to its end: resumes it, or starts it again where it has not begun.
fn complete(study: &Path, run: &Path) {
    if run.join("study.toml").exists() {
        resume(run, &["--no-recording"]).success();
    } else {
        kinefront()
            .args(["optimize", "--evaluations", "90", "--no-recording", "--quiet"])
            .arg(study)
            .arg("--out")
            .arg(run)
            .assert()
            .success();
    }
}
