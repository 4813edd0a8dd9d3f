//! Helpers: the program, temporary folders, and Python and Node.js, which read the files of the program.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use assert_cmd::cargo::cargo_bin_cmd;
use kinefront_study::{RunFolder, TableRow};
use predicates::Predicate;
use serde_json::Value;
use tempfile::TempDir;

pub use kinefront_testkit::{DESIGN, is_thorough, python, repetitions, sample};

/// Returns the program without any setting of the caller's environment that Rerun would use.
pub fn kinefront() -> assert_cmd::Command {
    let mut command = cargo_bin_cmd!("kinefront");
    command.env_remove("RERUN").env("NO_COLOR", "1");
    command
}

pub fn folder() -> TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

/// Holds for a message that contains `words`, wherever its lines are broken to fit a terminal.
pub fn says(words: &str) -> impl Predicate<str> + use<> {
    let words = words.to_owned();
    predicates::function::function(move |message: &str| {
        // A word that has a hyphen is broken behind it.
        let told = message.replace("-\n", "-").replace('│', " ");
        let told = told.split_whitespace().collect::<Vec<_>>().join(" ");
        told.replace("- ", "-").contains(&words.replace("- ", "-"))
    })
}

/// Writes a small study, which runs quickly and has all three architectures, and returns its path.
pub fn small_study(folder: &Path) -> PathBuf {
    let path = folder.join("small.toml");
    std::fs::write(&path, kinefront_testkit::small_study(600)).expect("a study file");
    path
}

/// Writes a small study of one architecture and returns its path, for tests of files, in which the designs do not matter.
pub fn short_study(folder: &Path) -> PathBuf {
    let path = folder.join("small.toml");
    let text = kinefront_testkit::small_study(600);
    let text = text.replace("[grid.reference]", "architectures = [\"3-RPR\"]\n[grid.reference]");
    std::fs::write(&path, text).expect("a study file");
    path
}

/// Runs a command that must succeed and returns the JSON that it prints.
pub fn json<S: AsRef<OsStr>>(arguments: impl IntoIterator<Item = S>) -> Value {
    let told = kinefront().args(arguments).assert().success();
    serde_json::from_slice(&told.get_output().stdout).expect("one JSON object")
}

/// Returns the path of a question of `benches/comparison`.
pub fn question(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/comparison/questions");
    folder.join(format!("{name}.toml"))
}

/// Returns the front that a run reports.
pub fn front(out: &Path) -> Vec<TableRow> {
    let run = RunFolder::open(out).expect("a run");
    run.front().expect("a table").expect("a front").rows
}

/// Runs a study into `out` and returns `run.json`.
pub fn optimize(study: &Path, out: &Path, more: &[&str]) -> Value {
    let files = [
        OsStr::new("optimize"),
        study.as_os_str(),
        OsStr::new("--out"),
        out.as_os_str(),
    ];
    let more = more.iter().map(OsStr::new);
    json(
        files
            .into_iter()
            .chain(["--json", "--quiet"].map(OsStr::new))
            .chain(more),
    )
}

/// Runs a script of `tests/python` and returns what it prints.
pub fn script(mut python: Command, name: &str, arguments: &[&Path]) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python").join(name);
    let output = python.arg(path).args(arguments).output().expect("Python runs");
    assert!(
        output.status.success(),
        "{name} failed:\n{}\n{}",
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// Returns Node.js if it finds `package`, or prints a message on what is missing and returns `None`.
///
/// `KINEFRONT_NODE_PATH` is the folder of the packages; if `KINEFRONT_REQUIRE_NODE` is set, a missing one is a failure.
pub fn node(package: &str) -> Option<Command> {
    let make = || {
        let mut node = Command::new("node");
        if let Some(path) = std::env::var_os("KINEFRONT_NODE_PATH") {
            node.env("NODE_PATH", path);
        }
        node
    };
    let found = make()
        .args(["-e", &format!("require('{package}')")])
        .output()
        .is_ok_and(|output| output.status.success());
    if found {
        return Some(make());
    }
    let message = format!("skipped: Node.js with {package} was not found (see CONTRIBUTING.md)");
    assert!(std::env::var_os("KINEFRONT_REQUIRE_NODE").is_none(), "{message}");
    eprintln!("{message}");
    None
}

/// Files whose bytes a resumed run must reproduce.
pub const TABLES: [&str; 3] = ["study.toml", "designs.csv", "front.csv"];

pub fn tables(run: &Path) -> [Vec<u8>; 3] {
    TABLES.map(|file| fs::read(run.join(file)).unwrap_or_else(|error| panic!("{file}: {error}")))
}

pub fn program() -> Command {
    let path = env!("CARGO_BIN_EXE_kinefront");
    let mut command = if cfg!(target_os = "linux") {
        // Signals that the tests themselves ignore, as in the background of a shell, would be ignored by the program, too.
        let mut command = Command::new("env");
        command.arg("--default-signal").arg(path);
        command
    } else {
        Command::new(path)
    };
    command.env_remove("RERUN").env("NO_COLOR", "1");
    command
}

/// A run of `study` with more arguments, whose output is dropped.
pub fn start(study: &Path, run: &Path, more: &[&str]) -> Child {
    program()
        .arg("optimize")
        .arg(study)
        .arg("--out")
        .arg(run)
        .args(more)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts")
}

pub fn resume(run: &Path, more: &[&str]) -> assert_cmd::assert::Assert {
    kinefront()
        .args(["optimize", "--quiet", "--resume"])
        .arg(run)
        .args(more)
        .assert()
}

pub fn check(run: &Path) -> assert_cmd::assert::Assert {
    kinefront().arg("check").arg(run).assert()
}

/// Waits until the table of a run has more than `lines` lines.
pub fn wait_for(run: &Path, lines: usize) {
    let since = Instant::now();
    let count = || File::open(run.join("designs.csv")).map_or(0, |file| BufReader::new(file).lines().count());
    while count() <= lines {
        assert!(since.elapsed() < Duration::from_secs(60), "no designs after a minute");
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[cfg(unix)]
pub fn signal(child: &Child, name: &str) {
    let status = Command::new("kill").args([name, &child.id().to_string()]).status();
    assert!(status.expect("kill runs").success());
}

/// `run.json` without what may differ between two runs of a study.
pub fn report(run: &Path) -> serde_json::Value {
    let text = fs::read(run.join("run.json")).expect("run.json");
    let mut report: serde_json::Value = serde_json::from_slice(&text).expect("JSON");
    let object = report.as_object_mut().expect("an object");
    assert!(object.remove("times").is_some() && object.remove("threads").is_some());
    report
}

/// Returns the design of a row of a table as text, by a function that gives the value of a column.
pub fn design_of(value: impl Fn(&str) -> String) -> String {
    let dimensions = ["R", "r", "Lb", "rj", "rp"].map(|name| format!(" {name}={}", value(name)));
    value("architecture") + &dimensions.concat()
}
