//! Every call to the operating system fails once, as it does on a disk that is full or broken: nothing that was on the disk is lost,
//! and what remains can be resumed to the run that was never disturbed.
#![cfg(target_os = "linux")]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use super::support::{
    check, folder, is_thorough, kinefront, optimize, repetitions, resume, sample, short_study, tables,
};

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

/// Writes a short study with few designs on its front, which make each of the many runs short.
fn study_of_few(folder: &Path) -> PathBuf {
    let study = short_study(folder);
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
        .args(["-f", "-qq", "--seccomp-bpf", "-o"])
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

/// Runs that commands are disturbed on.
struct Ground {
    folder: tempfile::TempDir,
    study: PathBuf,
    /// Tables of the run that copies are made of, and of the same run with more evaluations.
    kept: [Vec<u8>; 3],
    extended: [Vec<u8>; 3],
}

impl Ground {
    fn new() -> Self {
        let folder = folder();
        let study = study_of_few(folder.path());
        let make = |name: &str, more: &[&str]| {
            let out = folder.path().join(name);
            optimize(&study, &out, &[more, &["--no-recording"]].concat());
            tables(&out)
        };
        let kept = make("whole", &["--evaluations", "90"]);
        let extended = make("longer", &["--evaluations", "120"]);
        make("other", &["--evaluations", "90", "--seed", "9"]);
        let ground = Self {
            study,
            kept,
            extended,
            folder,
        };
        // What is disturbed does its work when it is not.
        for scenario in &SCENARIOS {
            kinefront().args(ground.prepare(scenario)).assert().success();
        }
        ground
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Copies the run, removes what an earlier command made, and returns the arguments of a command.
    fn prepare(&self, scenario: &Scenario) -> Vec<PathBuf> {
        let run = self.path("run");
        for path in [&self.path("new"), &run] {
            let _ = fs::remove_dir_all(path);
        }
        let _ = fs::remove_file(self.path("new.csv"));
        fs::create_dir(&run).expect("a folder");
        for name in ["study.toml", "designs.csv", "front.csv", "run.json"] {
            fs::copy(self.path("whole").join(name), run.join(name)).expect("a copy");
        }
        (scenario.arguments)(self.folder.path(), &run)
    }

    /// Checks what a disturbed command has said and left: it has not panicked, no design is lost, and what it changed can be completed to
    /// what it would have been.
    fn examine(&self, scenario: &Scenario, output: &Output, what: &str) {
        let said = String::from_utf8_lossy(&output.stderr);
        let what = format!("{}: {what}: {:?} {said}", scenario.name, output.status);
        assert!(!said.contains("panicked"), "{what}");
        assert!(matches!(output.status.code(), Some(0..=3)), "{what}");
        // The other runs are as they were, whatever failed.
        assert!(tables(&self.path("whole")) == self.kept, "{what}");
        assert!(tables(&self.path("longer")) == self.extended, "{what}");
        let run = self.path("run");
        if scenario.changes_run {
            let rows = fs::read(run.join("designs.csv")).expect("designs");
            assert!(
                rows.starts_with(&self.kept[1]) || self.kept[1].starts_with(&rows),
                "{what}"
            );
            resume(&run, &["--evaluations", "120", "--no-recording"]).success();
            assert!(tables(&run) == self.extended, "{what}");
            check(&run).success();
        } else if scenario.name == "optimize" {
            complete(&self.study, &self.path("new"));
            assert!(tables(&self.path("new")) == self.kept, "{what}");
        } else {
            assert!(tables(&run) == self.kept, "{what}");
        }
    }
}

#[test]
fn every_call_fails_once() {
    if Command::new("strace").arg("-V").output().is_err() {
        eprintln!("skipped: there is no strace");
        return;
    }
    let ground = Ground::new();
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
        for when in times.map(|when| start + when) {
            let error = errors[when % errors.len()];
            let arguments = ground.prepare(scenario);
            let (output, fired) = disturb(&arguments, calls, error, when);
            if !fired {
                break;
            }
            injected += 1;
            *table.entry((scenario.name, calls)).or_insert(0) += 1;
            // The loader of the program is not the program.
            let is_of_loader = String::from_utf8_lossy(&output.stderr).contains("error while loading shared libraries");
            if !is_of_loader {
                ground.examine(scenario, &output, &format!("{calls} {when} {error}"));
            }
        }
    }
    for ((scenario, calls), count) in table {
        println!("| {scenario} | {calls} | {count} |");
    }
    assert!(injected > 15, "only {injected} calls failed");
}

/// Runs the program with a limit of its address space \[KiB\]. With one heap for all threads, an allocation fails where the memory ends.
fn limited(space: usize, arguments: &[PathBuf]) -> Output {
    let mut command = Command::new("sh");
    command
        .args(["-c", &format!("ulimit -v {space} && exec \"$0\" \"$@\"")])
        .arg(env!("CARGO_BIN_EXE_kinefront"))
        .args(arguments)
        .env_remove("RERUN")
        .env("NO_COLOR", "1")
        .env("MALLOC_ARENA_MAX", "1");
    command.output().expect("a shell")
}

/// Returns the least address space with which the program starts \[KiB\]; below, its loader ends by a signal.
fn space_of_start() -> usize {
    let (mut low, mut high) = (10_000, 4_000_000);
    while high - low > 500 {
        let middle = usize::midpoint(low, high);
        if limited(middle, &["--version".into()]).status.success() {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

/// A command that runs out of memory says so and ends with a documented code. What it leaves is what a command that is killed leaves.
#[test]
fn little_memory_ends_a_command_in_good_order() {
    let ground = Ground::new();
    let least = space_of_start();
    let mut codes = BTreeMap::new();
    // A report takes seconds.
    let scenarios = SCENARIOS
        .iter()
        .filter(|scenario| scenario.name != "report" || is_thorough());
    for scenario in scenarios {
        for step in sample(0..repetitions(24, 60), 5) {
            let mut arguments = ground.prepare(scenario);
            // Recordings need most of the memory.
            arguments.retain(|argument| argument != Path::new("--no-recording"));
            let output = limited(least + 2000 * step, &arguments);
            *codes.entry(output.status.code()).or_insert(0) += 1;
            ground.examine(scenario, &output, &format!("{} MB more than to start", 2 * step));
        }
    }
    println!("{codes:?}");
    let ended_with = |code: i32| codes.get(&Some(code)).copied().unwrap_or(0);
    assert!(ended_with(3) > 0 && ended_with(0) > 5, "{codes:?}");
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
