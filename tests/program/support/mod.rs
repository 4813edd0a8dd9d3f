//! Helpers: the program, temporary folders, and Python and Node.js, which read the files of the program.

mod runs;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use assert_cmd::assert::Assert;
use assert_cmd::cargo::cargo_bin_cmd;
use predicates::Predicate;
use serde_json::Value;
use tempfile::TempDir;

pub use kinefront_testkit::{DESIGN, is_thorough, python, repetitions, sample};
pub use runs::*;

/// Returns the program without any setting of the caller's environment that Rerun would use.
pub fn kinefront() -> assert_cmd::Command {
    let mut command = cargo_bin_cmd!("kinefront");
    command.env_remove("RERUN").env("NO_COLOR", "1");
    command
}

/// Runs a command line of the program, without its name.
pub fn run(line: &str) -> Assert {
    kinefront().args(words(line)).assert()
}

/// Runs a command line that must succeed and returns the JSON that it prints.
pub fn json(line: &str) -> Value {
    parsed(&run(line).success())
}

/// Returns the JSON that a command has printed.
pub fn parsed(told: &Assert) -> Value {
    serde_json::from_slice(&told.get_output().stdout).expect("one JSON object")
}

/// Returns what a command has printed to the standard error.
pub fn said(told: &Assert) -> String {
    String::from_utf8_lossy(&told.get_output().stderr).into_owned()
}

/// Splits a command line at its spaces; quotation marks hold words together.
pub fn words(line: &str) -> Vec<String> {
    let mut words = Vec::new();
    let (mut word, mut quoted) = (String::new(), None);
    for letter in line.chars() {
        match letter {
            '"' | '\'' if quoted == Some(letter) => quoted = None,
            '"' | '\'' if quoted.is_none() => quoted = Some(letter),
            ' ' if quoted.is_none() => words.extend((!word.is_empty()).then(|| std::mem::take(&mut word))),
            other => word.push(other),
        }
    }
    words.extend((!word.is_empty()).then_some(word));
    words
}

pub fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is not a number"))
}

pub fn list(value: &Value) -> &[Value] {
    value.as_array().unwrap_or_else(|| panic!("{value} is not a list"))
}

/// Returns the entry of a list of which a key has a value.
pub fn entry<'a>(entries: &'a Value, key: &str, value: &str) -> &'a Value {
    let found = list(entries).iter().find(|entry| entry[key] == value);
    found.unwrap_or_else(|| panic!("no entry has the {key} {value}: {entries}"))
}

/// A temporary folder, in which the program is run.
pub struct Folder(TempDir);

pub fn folder() -> Folder {
    Folder(tempfile::tempdir().expect("a temporary folder"))
}

impl Folder {
    pub fn path(&self) -> &Path {
        self.0.path()
    }

    pub fn join(&self, name: impl AsRef<Path>) -> PathBuf {
        self.path().join(name)
    }

    /// Writes a file and returns its path.
    pub fn write(&self, name: &str, contents: impl AsRef<[u8]>) -> PathBuf {
        let path = self.join(name);
        fs::write(&path, contents).unwrap_or_else(|error| panic!("{name}: {error}"));
        path
    }

    pub fn read(&self, name: &str) -> String {
        fs::read_to_string(self.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// Runs a command line of the program, whose paths begin in this folder.
    pub fn run(&self, line: &str) -> Assert {
        kinefront().current_dir(self.path()).args(words(line)).assert()
    }

    /// Runs a command line that must succeed and returns the JSON that it prints.
    pub fn json(&self, line: &str) -> Value {
        parsed(&self.run(line).success())
    }
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

/// Runs a script of `tests/python` that prints JSON.
pub fn script_json(python: Command, name: &str, arguments: &[&Path]) -> Value {
    serde_json::from_str(&script(python, name, arguments)).expect("JSON")
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

/// The program as a process that a test can signal or trace.
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
