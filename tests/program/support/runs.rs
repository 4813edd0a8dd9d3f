//! Runs: small studies, runs that several tests share, and what a run has left.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, LazyLock, Mutex, OnceLock};
use std::time::{Duration, Instant};

use assert_cmd::assert::Assert;
use kinefront_study::{RunFolder, TableRow};
use serde_json::Value;

use super::{kinefront, parsed, program};

/// Writes a small study, which runs quickly and has all three architectures, and returns its path.
pub fn small_study(folder: &Path) -> PathBuf {
    let path = folder.join("small.toml");
    fs::write(&path, kinefront_testkit::small_study(600)).expect("a study file");
    path
}

/// Returns a small study of one architecture, for tests of files, in which the designs do not matter.
fn short_text() -> String {
    let text = kinefront_testkit::small_study(600);
    text.replace("[grid.reference]", "architectures = [\"3-RPR\"]\n[grid.reference]")
}

/// Writes a small study of one architecture and returns its path.
pub fn short_study(folder: &Path) -> PathBuf {
    let path = folder.join("small.toml");
    fs::write(&path, short_text()).expect("a study file");
    path
}

/// Returns the path of a question of `benches/comparison`.
pub fn question(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/comparison/questions");
    folder.join(format!("{name}.toml"))
}

/// Runs a study into `out` and returns `run.json`.
pub fn optimize(study: &Path, out: &Path, more: &[&str]) -> Value {
    parsed(&search(study, out, more))
}

fn search(study: &Path, out: &Path, more: &[&str]) -> Assert {
    let mut command = kinefront();
    command
        .args(["optimize", "--json", "--quiet", "--out"])
        .arg(out)
        .arg(study);
    command.args(more).assert().success()
}

/// The folder of the runs that tests share. They are those of the program that is tested: what earlier ones have left is removed after a
/// day.
static PREPARED: LazyLock<PathBuf> = LazyLock::new(|| {
    let program = fs::metadata(env!("CARGO_BIN_EXE_kinefront")).expect("the program");
    let built = program.modified().expect("the time when it was built");
    let mut hasher = DefaultHasher::new();
    (env!("CARGO_BIN_EXE_kinefront"), program.len(), built).hash(&mut hasher);
    let all = Path::new(env!("CARGO_TARGET_TMPDIR")).join("prepared-runs");
    // Tests of another build may run at this moment.
    let is_old = |entry: &fs::DirEntry| {
        let age = entry.metadata().ok()?.modified().ok()?.elapsed().ok()?;
        Some(age > Duration::from_hours(24))
    };
    for entry in fs::read_dir(&all).into_iter().flatten().flatten() {
        if is_old(&entry) == Some(true) {
            let _ = fs::remove_dir_all(entry.path());
        }
    }
    let own = all.join(hasher.finish().to_string());
    fs::create_dir_all(&own).expect("a folder");
    own
});

/// Returns the folder of a run that several tests read. The first one that asks for the study with these arguments makes it. A test
/// that changes files of a run works on a [`copy`]. What the run has printed is beside it, in `printed.json`.
pub fn prepared(study: &str, more: &[&str]) -> PathBuf {
    static MADE: Mutex<BTreeMap<u64, Arc<OnceLock<()>>>> = Mutex::new(BTreeMap::new());
    let mut hasher = DefaultHasher::new();
    (study, more).hash(&mut hasher);
    let key = hasher.finish();
    let place = PREPARED.join(key.to_string());
    let made = Arc::clone(MADE.lock().expect("no test panics here").entry(key).or_default());
    made.get_or_init(|| {
        if place.exists() {
            return;
        }
        let new = tempfile::tempdir_in(&*PREPARED).expect("a folder");
        let file = new.path().join("small.toml");
        fs::write(&file, study).expect("a study file");
        let told = search(&file, &new.path().join("run"), more);
        fs::write(new.path().join("printed.json"), &told.get_output().stdout).expect("what was printed");
        // Another process may have made it meanwhile.
        let moved = fs::rename(new.path(), &place);
        assert!(moved.is_ok() || place.exists(), "{moved:?}");
    });
    place.join("run")
}

/// Returns the run of [`small_study`], which no test changes.
pub fn small_run() -> PathBuf {
    prepared(&kinefront_testkit::small_study(600), &[])
}

/// Returns a run of [`short_study`], which no test changes.
pub fn short_run(more: &[&str]) -> PathBuf {
    prepared(&short_text(), more)
}

/// Copies a folder without folders in it and returns where the copy is.
pub fn copy(run: &Path, to: &Path) -> PathBuf {
    fs::create_dir(to).expect("a folder");
    for entry in fs::read_dir(run).expect("a folder") {
        let entry = entry.expect("an entry");
        fs::copy(entry.path(), to.join(entry.file_name())).expect("a copy");
    }
    to.to_owned()
}

/// A run of `study` with more arguments, whose output is dropped.
pub fn start(study: &Path, run: &Path, more: &[&str]) -> Child {
    let mut command = program();
    command.arg("optimize").arg(study).arg("--out").arg(run).args(more);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().expect("the program starts")
}

pub fn resume(run: &Path, more: &[&str]) -> Assert {
    let mut command = kinefront();
    command.args(["optimize", "--quiet", "--resume"]).arg(run);
    command.args(more).assert()
}

pub fn check(run: &Path) -> Assert {
    kinefront().arg("check").arg(run).assert()
}

pub fn repair(run: &Path) -> Assert {
    kinefront().args(["check", "--repair"]).arg(run).assert()
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

/// Files whose bytes a resumed run must reproduce.
pub const TABLES: [&str; 3] = ["study.toml", "designs.csv", "front.csv"];

pub fn tables(run: &Path) -> [Vec<u8>; 3] {
    TABLES.map(|file| fs::read(run.join(file)).unwrap_or_else(|error| panic!("{file}: {error}")))
}

/// `run.json` without what may differ between two runs of a study.
pub fn report(run: &Path) -> Value {
    let text = fs::read(run.join("run.json")).expect("run.json");
    let mut report: Value = serde_json::from_slice(&text).expect("JSON");
    let object = report.as_object_mut().expect("an object");
    assert!(object.remove("times").is_some() && object.remove("threads").is_some());
    report
}

/// Returns the front that a run reports.
pub fn front(out: &Path) -> Vec<TableRow> {
    let run = RunFolder::open(out).expect("a run");
    run.front().expect("a table").expect("a front").rows
}

/// A row of a table: its cells by the names of their columns.
pub type Row = BTreeMap<String, String>;

pub fn read_rows(table: &Path) -> Vec<Row> {
    rows_of(&fs::read(table).unwrap_or_else(|error| panic!("{}: {error}", table.display())))
}

/// Returns the rows of the text of a table.
pub fn rows_of(text: &[u8]) -> Vec<Row> {
    let rows = csv::Reader::from_reader(text).into_deserialize();
    rows.map(|row| row.expect("a row")).collect()
}

/// Returns the number in a cell.
pub fn value(row: &Row, column: &str) -> f64 {
    let cell = &row[column];
    cell.parse()
        .unwrap_or_else(|_| panic!("{column} is not a number: `{cell}`"))
}

/// Returns the design of a row of a table as text.
pub fn design_of(row: &Row) -> String {
    let dimensions = ["R", "r", "Lb", "rj", "rp"].map(|name| format!(" {name}={}", row[name]));
    row["architecture"].clone() + &dimensions.concat()
}
