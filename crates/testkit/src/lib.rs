//! What the tests of several packages share.

pub mod oracle;
mod random;

pub use random::{numbers, poses_of_region};

use std::path::{Path, PathBuf};
use std::process::Command;

/// The paper's design II.
pub const DESIGN: &str = "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056";

/// Returns the text of a small study, which runs quickly and has all three architectures of the paper.
pub fn small_study(evaluations: usize) -> String {
    format!(
        "name = \"small\"\n[grid.reference]\nphi_step_deg = 5\ndirections = 12\nray_steps = 20\nhalvings = 6\n\
         [grid.fine]\nphi_step_deg = 2.5\ndirections = 24\nray_steps = 40\nhalvings = 8\n\
         [optimizer]\nevaluations = {evaluations}\nseed = 5\nfront_designs = 8\n"
    )
}

/// Whether tests repeat all of what they otherwise repeat a few times: where `KINEFRONT_THOROUGH` is set, as every night.
pub fn is_thorough() -> bool {
    std::env::var_os("KINEFRONT_THOROUGH").is_some_and(|set| !set.is_empty())
}

/// Returns the number of repetitions of a test: `all` where tests are thorough, otherwise `few`.
pub fn repetitions(few: usize, all: usize) -> usize {
    if is_thorough() { all } else { few }
}

/// Returns the cases of a repeated test: all of them where tests are thorough, otherwise `count` of them, evenly spread.
pub fn sample<Cases: ExactSizeIterator>(cases: Cases, count: usize) -> impl Iterator<Item = Cases::Item> {
    let step = cases.len().div_ceil(repetitions(count, cases.len()));
    cases.step_by(step)
}

/// Returns the folder of a run of a small study that an earlier version wrote.
pub fn run_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/run")
}

/// Returns a Python interpreter that has `modules`, or prints a message on what is missing and returns `None`.
///
/// `KINEFRONT_PYTHON` names the interpreter; if `KINEFRONT_REQUIRE_PYTHON` is set, a missing one is a failure.
pub fn python(modules: &[&str]) -> Option<Command> {
    let interpreter = std::env::var("KINEFRONT_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let imports: Vec<String> = modules.iter().map(|module| format!("import {module}")).collect();
    let found = Command::new(&interpreter)
        .args(["-c", &imports.join("\n")])
        .output()
        .is_ok_and(|output| output.status.success());
    if found {
        return Some(Command::new(interpreter));
    }
    let message = format!(
        "skipped: {interpreter} with {} was not found (see CONTRIBUTING.md)",
        modules.join(", ")
    );
    assert!(std::env::var_os("KINEFRONT_REQUIRE_PYTHON").is_none(), "{message}");
    eprintln!("{message}");
    None
}
