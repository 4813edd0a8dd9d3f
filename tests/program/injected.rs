//! Every call to the operating system fails once, as it does on a disk that is full or broken: nothing that was on the disk is lost,
//! and what remains can be resumed to the run that was never disturbed.
#![cfg(target_os = "linux")]

use std::collections::BTreeMap;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use super::support::{
    Folder, check, copy, folder, is_thorough, kinefront, optimize, prepared, repetitions, resume, sample, short_study,
    tables, words,
};

/// Calls that ask for memory.
const MEMORY: &str = "mmap";

/// Calls of which a command makes dozens; of the others it makes a few.
const FREQUENT: [&str; 2] = ["openat", "write"];

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
    /// Its command line; `run` is the copy, `other` another run, and `new` does not exist.
    line: &'static str,
    /// Whether the command works in the run folder, which then has to be resumed or repaired.
    changes_run: bool,
}

const SCENARIOS: [Scenario; 6] = [
    Scenario {
        name: "optimize",
        line: "optimize --evaluations 90 --no-recording --quiet small.toml --out new",
        changes_run: false,
    },
    Scenario {
        name: "resume",
        line: "optimize --evaluations 120 --no-recording --quiet --resume run",
        changes_run: true,
    },
    Scenario {
        name: "repair",
        line: "check --repair run",
        changes_run: true,
    },
    Scenario {
        name: "merge",
        line: "merge --no-recording --quiet --out new run other",
        changes_run: false,
    },
    Scenario {
        name: "report",
        line: "report --quiet --picture-width 160 --scale 0.25 --out new run",
        changes_run: false,
    },
    Scenario {
        name: "export",
        line: "export run --out new.csv",
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
fn disturb(folder: &Folder, arguments: &[String], calls: &str, error: &str, when: usize) -> (Output, bool) {
    let log = tempfile::NamedTempFile::new().expect("a file");
    let output = Command::new("strace")
        .args(["-f", "-qq", "--seccomp-bpf", "-o"])
        .arg(log.path())
        .args(["-e", &format!("trace={calls}")])
        .args(["-e", &format!("inject={calls}:error={error}:when={when}")])
        .arg(env!("CARGO_BIN_EXE_kinefront"))
        .args(arguments)
        .current_dir(folder.path())
        .env_remove("RERUN")
        .env("NO_COLOR", "1")
        .output()
        .expect("strace runs");
    let fired = fs::read_to_string(log.path()).expect("a log").contains("(INJECTED)");
    (output, fired)
}

/// Runs that commands are disturbed on.
struct Ground {
    folder: Folder,
    study: PathBuf,
    /// Tables of the run that copies are made of, and of the same run with more evaluations.
    kept: [Vec<u8>; 3],
    extended: [Vec<u8>; 3],
}

impl Ground {
    fn new() -> Self {
        let folder = folder();
        let study = study_of_few(folder.path());
        let text = folder.read("small.toml");
        let make = |name: &str, more: &[&str]| {
            let run = prepared(&text, &[more, &["--no-recording"][..]].concat());
            tables(&copy(&run, &folder.join(name)))
        };
        let kept = make("whole", &["--evaluations", "90"]);
        let extended = make("longer", &["--evaluations", "120"]);
        make("other", &["--evaluations", "90", "--seed", "9"]);
        Self {
            study,
            kept,
            extended,
            folder,
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// Copies the run, removes what an earlier command made, and returns the arguments of a command.
    fn prepare(&self, scenario: &Scenario) -> Vec<String> {
        let run = self.path("run");
        for path in [&self.path("new"), &run] {
            let _ = fs::remove_dir_all(path);
        }
        let _ = fs::remove_file(self.path("new.csv"));
        copy(&self.path("whole"), &run);
        if scenario.name == "repair" {
            let front = self.folder.read("run/front.csv");
            self.folder.write("run/front.csv", &front[..front.len() / 2]);
        }
        words(scenario.line)
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

/// What is disturbed does its work when it is not.
#[test]
fn undisturbed_commands_succeed() {
    let ground = Ground::new();
    for scenario in &SCENARIOS {
        let mut command = kinefront();
        command.current_dir(ground.folder.path());
        command.args(ground.prepare(scenario)).assert().success();
    }
}

/// Returns which of the calls fail in turn: where tests are thorough, all until there are no more. By day, one of each kind of call that
/// is rare, and of each second kind that is frequent, another for each command.
fn calls_to_fail(scenario: usize, kind: usize) -> Range<usize> {
    let place = CALLS.len() * scenario + kind;
    let is_frequent = FREQUENT.contains(&CALLS[kind].0);
    let one = if is_frequent { 4 + place % 17 } else { 1 + place % 3 };
    // A report takes seconds.
    let is_slow = SCENARIOS[scenario].name == "report" && !place.is_multiple_of(3);
    let is_of_night = is_slow || is_frequent && (scenario + kind / 2) % 2 == 1;
    match is_thorough() {
        true => 1..10_000,
        false if is_of_night => 0..0,
        false => one..one + 1,
    }
}

#[test]
fn every_call_fails_once() {
    if Command::new("strace").arg("-V").output().is_err() {
        eprintln!("skipped: there is no strace");
        return;
    }
    let ground = Ground::new();
    let (mut injected, mut table) = (0, BTreeMap::new());
    let places = (0..SCENARIOS.len()).flat_map(|scenario| (0..CALLS.len()).map(move |kind| (scenario, kind)));
    for (place, kind) in places {
        let (scenario, (calls, errors)) = (&SCENARIOS[place], CALLS[kind]);
        let times = calls_to_fail(place, kind);
        // A loader without memory ends by a signal.
        let start = match calls == MEMORY && !times.is_empty() {
            true => calls_of_start(calls),
            false => 0,
        };
        for when in times.map(|when| start + when) {
            let error = errors[when % errors.len()];
            let arguments = ground.prepare(scenario);
            let (output, fired) = disturb(&ground.folder, &arguments, calls, error, when);
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
fn limited(space: usize, folder: &Folder, arguments: &[String]) -> Output {
    let mut command = Command::new("sh");
    command
        .current_dir(folder.path())
        .args(["-c", &format!("ulimit -v {space} && exec \"$0\" \"$@\"")])
        .arg(env!("CARGO_BIN_EXE_kinefront"))
        .args(arguments)
        .env_remove("RERUN")
        .env("NO_COLOR", "1")
        .env("MALLOC_ARENA_MAX", "1");
    command.output().expect("a shell")
}

/// Returns the least address space with which the program starts \[KiB\]; below, its loader ends by a signal.
fn space_of_start(folder: &Folder) -> usize {
    let (mut low, mut high) = (10_000, 4_000_000);
    while high - low > 500 {
        let middle = usize::midpoint(low, high);
        if limited(middle, folder, &["--version".to_owned()]).status.success() {
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
    let least = space_of_start(&ground.folder);
    let mut codes = BTreeMap::new();
    // A report takes seconds.
    let scenarios = SCENARIOS
        .iter()
        .filter(|scenario| scenario.name != "report" || is_thorough());
    for scenario in scenarios {
        for step in sample(0..repetitions(24, 60), 5) {
            let mut arguments = ground.prepare(scenario);
            // Recordings need most of the memory.
            arguments.retain(|argument| argument != "--no-recording");
            let output = limited(least + 2000 * step, &ground.folder, &arguments);
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
        optimize(study, run, &["--evaluations", "90", "--no-recording"]);
    }
}
