//! Runs that are killed, interrupted, starved and damaged: what is on the disk stays, and a resumed run is the run that was
//! never stopped.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::support::{DESIGN, folder, kinefront, optimize, small_study};

/// Files whose bytes a resumed run must reproduce.
const TABLES: [&str; 3] = ["study.toml", "designs.csv", "front.csv"];

/// Number of runs that are killed; `KINEFRONT_KILLS` asks for more.
fn kills() -> u64 {
    std::env::var("KINEFRONT_KILLS").map_or(24, |count| count.parse().expect("a number"))
}

fn tables(run: &Path) -> [Vec<u8>; 3] {
    TABLES.map(|file| fs::read(run.join(file)).unwrap_or_else(|error| panic!("{file}: {error}")))
}

fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_kinefront"));
    command.env_remove("RERUN").env("NO_COLOR", "1");
    command
}

/// A run of `study` with more arguments, whose output is dropped.
fn start(study: &Path, run: &Path, more: &[&str]) -> Child {
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

fn resume(run: &Path, more: &[&str]) -> assert_cmd::assert::Assert {
    kinefront()
        .args(["optimize", "--quiet", "--resume"])
        .arg(run)
        .args(more)
        .assert()
}

fn check(run: &Path) -> assert_cmd::assert::Assert {
    kinefront().arg("check").arg(run).assert()
}

/// Waits until the table of a run has more than `lines` lines.
fn wait_for(run: &Path, lines: usize) {
    let since = Instant::now();
    let count = || File::open(run.join("designs.csv")).map_or(0, |file| BufReader::new(file).lines().count());
    while count() <= lines {
        assert!(since.elapsed() < Duration::from_secs(60), "no designs after a minute");
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[cfg(unix)]
fn signal(child: &Child, name: &str) {
    let status = Command::new("kill").args([name, &child.id().to_string()]).status();
    assert!(status.expect("kill runs").success());
}

/// `run.json` without what may differ between two runs of a study.
fn report(run: &Path) -> serde_json::Value {
    let text = fs::read(run.join("run.json")).expect("run.json");
    let mut report: serde_json::Value = serde_json::from_slice(&text).expect("JSON");
    let object = report.as_object_mut().expect("an object");
    assert!(object.remove("times").is_some() && object.remove("threads").is_some());
    report
}

/// Killed at any moment of its start, search, verification or end, and resumed on any number of threads, a run leaves the
/// files of a run that was never stopped.
#[test]
fn a_run_that_is_killed_and_resumed_is_the_run_that_was_not() {
    let folder = folder();
    let study = small_study(folder.path());
    for (algorithm, seed) in [("front-de", 1), ("moga2", 2), ("nsga2", 3)] {
        let arguments = ["--algorithm", algorithm, "--threads", "2"];
        let whole = folder.path().join(format!("{algorithm}-whole"));
        let since = Instant::now();
        optimize(&study, &whole, &arguments);
        let duration = since.elapsed();
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        for kill in 0..kills().div_ceil(3) {
            let run = folder.path().join(format!("{algorithm}-{kill}"));
            let mut child = start(&study, &run, &arguments);
            std::thread::sleep(duration.mul_f64(random.next_u32() as f64 / f64::from(u32::MAX)));
            child.kill().expect("a signal");
            child.wait().expect("an end");
            if run.join("study.toml").exists() {
                let threads = (1 + random.next_u32() % 3).to_string();
                resume(&run, &["--threads", &threads]).success();
            } else {
                // Killed before the study was written: the folder does not block the next start.
                optimize(&study, &run, &arguments);
            }
            assert!(
                tables(&run) == tables(&whole),
                "{algorithm}: kill {kill} changed the result"
            );
            assert_eq!(report(&run), report(&whole));
            assert_eq!(fs::read_dir(&run).expect("a folder").count(), 5);
            if kill == 0 {
                super::recordings::agrees_with_its_tables(&run);
                super::recordings::are_alike(&run, &whole);
            }
            fs::remove_dir_all(&run).expect("a folder");
        }
    }
}

/// A finished run can be extended as if the larger budget had been asked at once, though the smaller one cut its last
/// generation short.
#[test]
fn a_finished_run_can_be_extended() {
    let folder = folder();
    let study = small_study(folder.path());
    let (whole, run) = (folder.path().join("whole"), folder.path().join("run"));
    optimize(&study, &whole, &["--evaluations", "500"]);
    optimize(&study, &run, &["--evaluations", "310"]);
    resume(&run, &["--evaluations", "300"])
        .code(2)
        .stderr(contains("310 evaluations already"));
    kinefront()
        .args(["optimize", "--resume"])
        .arg(&run)
        .assert()
        .success()
        .stdout(contains("is complete: 310 evaluations"));
    resume(&run, &["--evaluations", "500"]).success();
    assert!(tables(&run) == tables(&whole));
    assert_eq!(report(&run), report(&whole));
    check(&run).success().stdout(contains("is sound: 500 designs"));
}

/// Every signal that asks a program to end leaves whole tables and a report that says so; the run then resumes.
#[cfg(unix)]
#[test]
fn signals_end_a_run_in_good_order() {
    let folder = folder();
    let study = small_study(folder.path());
    let whole = folder.path().join("whole");
    optimize(&study, &whole, &["--evaluations", "4000"]);
    for name in ["-INT", "-TERM", "-HUP"] {
        let run = folder.path().join(format!("run{name}"));
        let mut child = start(&study, &run, &["--evaluations", "4000"]);
        wait_for(&run, 200);
        signal(&child, name);
        assert_eq!(child.wait().expect("an end").code(), Some(130), "{name}");
        assert_eq!(report(&run)["outcome"], "interrupted");
        check(&run).success();
        resume(&run, &[]).success();
        assert!(tables(&run) == tables(&whole), "{name}");
    }
    // Before the first design, and during the verification.
    for wait in [0, 15] {
        let run = folder.path().join(format!("early{wait}"));
        let mut child = start(&study, &run, &["--evaluations", "4000"]);
        std::thread::sleep(Duration::from_millis(wait));
        signal(&child, "-TERM");
        child.wait().expect("an end");
        if run.join("study.toml").exists() {
            resume(&run, &[]).success();
        } else {
            optimize(&study, &run, &["--evaluations", "4000"]);
        }
        assert!(tables(&run) == tables(&whole), "after {wait} ms");
    }
}

/// What a run says never stops it: a reader that goes away, and a full device, are no reason to end.
#[cfg(target_os = "linux")]
#[test]
fn telling_never_stops_work() {
    let folder = folder();
    let study = small_study(folder.path());
    let run = folder.path().join("run");
    let mut child = program()
        .arg("optimize")
        .arg(&study)
        .arg("--out")
        .arg(&run)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let mut first = [0; 1];
    let mut pipe = child.stderr.take().expect("a pipe");
    pipe.read_exact(&mut first).expect("a first word");
    drop(pipe);
    assert!(child.wait().expect("an end").success());
    assert_eq!(report(&run)["outcome"], "completed");

    let full = || File::options().write(true).open("/dev/full").expect("a full device");
    let run = folder.path().join("full");
    let mut child = program()
        .arg("optimize")
        .arg(&study)
        .args(["--evaluations", "1000000", "--out"])
        .arg(&run)
        .stdout(Stdio::null())
        .stderr(full())
        .spawn()
        .expect("the program starts");
    wait_for(&run, 100);
    signal(&child, "-INT");
    assert_eq!(child.wait().expect("an end").code(), Some(130));
    assert_eq!(report(&run)["outcome"], "interrupted");

    // What was asked for, however, must arrive.
    let run = folder.path().join("answer");
    let out = run.as_os_str();
    let lost: [&[&OsStr]; 4] = [
        &["--help".as_ref()],
        &["study".as_ref(), "show".as_ref()],
        &[
            "evaluate".as_ref(),
            "--design".as_ref(),
            DESIGN.as_ref(),
            "--json".as_ref(),
        ],
        &[
            "optimize".as_ref(),
            study.as_os_str(),
            "--quiet".as_ref(),
            "--json".as_ref(),
            "--out".as_ref(),
            out,
        ],
    ];
    for arguments in lost {
        let status = program()
            .args(arguments)
            .stdout(full())
            .stderr(Stdio::null())
            .status()
            .expect("the program runs");
        assert_eq!(status.code(), Some(1), "{arguments:?}");
    }
}

/// The line that ends a table decides: only a last row without its end of line is forgiven, and that is said.
#[test]
fn damage_is_never_read_as_less_data() {
    let folder = folder();
    let study = small_study(folder.path());
    let run = folder.path().join("run");
    optimize(&study, &run, &["--evaluations", "120"]);
    let table = run.join("designs.csv");
    let text = fs::read_to_string(&table).expect("a table");
    let lines: Vec<&str> = text.lines().collect();
    let joined = |lines: &[&str]| lines.join("\n") + "\n";
    let with = |line: usize, new: &str| {
        let mut lines = lines.clone();
        lines[line] = new;
        joined(&lines)
    };
    let mass = lines[31].split(',').nth(9).expect("a mass");
    let other_digit = lines[31].replace(mass, &format!("{mass}1"));
    let swapped = [&lines[..30], &[lines[31], lines[30]], &lines[32..]].concat();
    let cases = [
        ("a comma", with(31, &lines[31].replacen(',', "", 1)), "line 32"),
        ("a number", with(31, &lines[31].replacen(mass, "NaN", 1)), "line 32"),
        ("an empty field", with(31, &lines[31].replacen(mass, "", 1)), "line 32"),
        ("no row", joined(&[&lines[..31], &lines[32..]].concat()), "line 32"),
        ("a row twice", joined(&[&lines[..32], &lines[31..]].concat()), "line 33"),
        ("two rows in another order", joined(&swapped), "line 31"),
        ("a digit more", with(31, &other_digit), "designs.csv"),
        ("fewer rows", joined(&lines[..61]), "(120 rows)"),
        (
            "no end of the last row",
            text[..text.len() - 1].to_owned(),
            "(120 rows)",
        ),
        (
            "an open quotation mark",
            with(31, &format!("\"{}", lines[31])),
            "line 32",
        ),
        (
            "an open quotation mark, and no end",
            with(31, &format!("\"{}", lines[31])).trim_end().to_owned(),
            "line 32",
        ),
    ];
    for (damage, damaged, place) in cases {
        println!("{damage}");
        fs::write(&table, damaged).expect("a table");
        let page = folder.path().join("page");
        kinefront()
            .arg("report")
            .arg(&run)
            .arg("--out")
            .arg(&page)
            .args(["--quiet", "--sensitivity", "0"])
            .assert()
            .code(2)
            .stderr(contains(place));
        check(&run).code(2).stdout(contains("designs.csv"));
    }
    fs::write(&table, &text).expect("a table");
    check(&run).success();

    // Cut at any line, the study of the run is not taken for another study.
    let (study, front) = (run.join("study.toml"), run.join("front.csv"));
    let text = fs::read_to_string(&study).expect("a study");
    let id = fs::read_to_string(&front)
        .expect("a front")
        .lines()
        .nth(1)
        .expect("a design")
        .split(',')
        .next()
        .expect("an id")
        .to_owned();
    for cut in 0..text.lines().count() {
        let part: Vec<&str> = text.lines().take(cut).collect();
        fs::write(&study, part.join("\n")).expect("a study");
        kinefront()
            .arg("export")
            .arg(format!("{}#{id}", front.display()))
            .args(["--format", "json", "--out", "-"])
            .assert()
            .code(2)
            .stderr(contains("study.toml").and(contains("not the file of the run")));
    }
    fs::write(&study, &text).expect("a study");
}

/// The table of a small run, cut at every byte: the run resumes or is refused, and is never another one.
#[test]
fn a_table_cut_at_every_byte_resumes() {
    use kinefront::study::Resumption;
    let folder = folder();
    let study = folder.path().join("tiny.toml");
    let text = "name = \"tiny\"\narchitectures = [\"3-PRR\"]\n\
                [grid.reference]\nphi_step_deg = 10\ndirections = 3\nray_steps = 4\nhalvings = 1\n\
                [grid.fine]\nphi_step_deg = 10\ndirections = 6\nray_steps = 4\nhalvings = 1\n\
                [optimizer]\nevaluations = 12\nthreads = 1\nalgorithm = \"nsga2\"\n[optimizer.nsga2]\npopulation = 4\n";
    fs::write(&study, text).expect("a study");
    let (whole, run) = (folder.path().join("whole"), folder.path().join("run"));
    optimize(&study, &whole, &["--no-recording"]);
    let table = fs::read(whole.join("designs.csv")).expect("a table");
    fs::create_dir(&run).expect("a folder");
    fs::copy(whole.join("study.toml"), run.join("study.toml")).expect("a study");
    for length in 0..table.len() {
        // What a run leaves that was killed at once: no checkpoint and no report state what should be there.
        fs::write(run.join("designs.csv"), &table[..length]).expect("a table");
        let resumption = Resumption::open(&run, None, None).unwrap_or_else(|error| panic!("{length} bytes: {error}"));
        let complete = table[..length]
            .iter()
            .filter(|&&byte| byte == b'\n')
            .count()
            .saturating_sub(1);
        assert_eq!(resumption.search().replayed(), complete / 4 * 4, "{length} bytes");
        drop(resumption);
        if length.is_multiple_of(97) {
            resume(&run, &["--no-recording"]).success();
            assert!(tables(&run) == tables(&whole), "{length} bytes");
            fs::remove_file(run.join("run.json")).expect("a report");
        }
    }
}

/// Rows that were changed, and a study that was, are named.
#[test]
fn a_resumed_run_names_what_was_changed() {
    let folder = folder();
    let study = small_study(folder.path());
    let run = folder.path().join("run");
    optimize(&study, &run, &["--evaluations", "300"]);
    // Without the report, checksums are unknown, and only the rows themselves can tell.
    let report = fs::read_to_string(run.join("run.json")).expect("a report");
    let unknown = || fs::remove_file(run.join("run.json")).expect("a report");
    let change = |file: &str, from: &str, to: &str| {
        let path = run.join(file);
        let text = fs::read_to_string(&path).expect("a file");
        assert!(text.contains(from), "{from}");
        fs::write(&path, text.replacen(from, to, 1)).expect("a file");
    };
    let more = ["--evaluations", "400"];
    change("study.toml", "seed = 5", "seed = 6");
    resume(&run, &more)
        .code(2)
        .stderr(contains("study.toml").and(contains("checksum")));
    unknown();
    resume(&run, &more)
        .code(2)
        .stderr(contains("design #0 does not follow"));
    change("study.toml", "seed = 6", "seed = 5");
    change("study.toml", "density_kg_per_m3 = 7850.0", "density_kg_per_m3 = 2700.0");
    resume(&run, &more).code(2).stderr(contains("mass_kg"));
    change("study.toml", "density_kg_per_m3 = 2700.0", "density_kg_per_m3 = 7850.0");
    fs::write(
        run.join("run.json"),
        report.replace("\"kinefront_version\": \"", "\"kinefront_version\": \"9"),
    )
    .expect("a report");
    resume(&run, &more).code(2).stderr(contains("written by Kinefront 9"));
    fs::write(run.join("run.json"), &report[..report.len() / 2]).expect("a report");
    resume(&run, &more)
        .code(2)
        .stderr(contains("run.json").and(contains("damaged")));
    fs::write(run.join("run.json"), &report).expect("a report");
    resume(&run, &more).success();
}

/// Of two runs in one folder one is refused, whichever is first; runs without a folder each find their own.
#[test]
fn a_folder_is_taken_once() {
    let folder = folder();
    let study = small_study(folder.path());
    for round in 0..10 {
        let run = folder.path().join(format!("run{round}"));
        let seeds = ["1", "2"];
        let children =
            seeds.map(|seed| start(&study, &run, &["--seed", seed, "--evaluations", "60", "--no-recording"]));
        let codes = children.map(|mut child| child.wait().expect("an end").code());
        let winner = match codes {
            [Some(0), Some(2)] => 0,
            [Some(2), Some(0)] => 1,
            _ => panic!("round {round}: {codes:?}"),
        };
        assert_eq!(report(&run)["seed"].to_string(), seeds[winner]);
        assert!(
            fs::read_to_string(run.join("study.toml"))
                .expect("a study")
                .contains(&format!("seed = {}", seeds[winner]))
        );
        check(&run).success();
    }
    let children: Vec<Child> = (0..3)
        .map(|_| {
            program()
                .arg("optimize")
                .arg(&study)
                .args(["--evaluations", "60", "--quiet", "--no-recording"])
                .current_dir(folder.path())
                .spawn()
                .expect("the program starts")
        })
        .collect();
    assert!(
        children
            .into_iter()
            .all(|mut child| child.wait().expect("an end").success())
    );
    for name in ["small-seed5", "small-seed5-2", "small-seed5-3"] {
        check(&folder.path().join("runs").join(name)).success();
    }

    // A run that is being written is neither resumed nor overwritten, and can be read.
    let run = folder.path().join("long");
    let mut child = start(&study, &run, &["--evaluations", "1000000", "--no-recording"]);
    wait_for(&run, 100);
    resume(&run, &[]).code(2).stderr(contains("in use"));
    kinefront()
        .arg("optimize")
        .arg(&study)
        .arg("--out")
        .arg(&run)
        .assert()
        .code(2)
        .stderr(contains("already holds a run"));
    assert!(child.try_wait().expect("a state").is_none());
    child.kill().expect("a signal");
    child.wait().expect("an end");
    check(&run)
        .success()
        .stdout(contains("has not ended and can be resumed"));
}

/// A run whose folder is removed, moved or truncated ends and says so, and leaves no gap in its table.
#[cfg(unix)]
#[test]
fn a_run_notices_that_its_folder_is_gone() {
    let folder = folder();
    let study = small_study(folder.path());
    type Happening = fn(&Path);
    let faults: [(&str, Happening); 3] = [
        ("removed", |run| fs::remove_dir_all(run).expect("a folder")),
        ("moved", |run| {
            fs::rename(run, run.with_extension("elsewhere")).expect("a folder")
        }),
        ("truncated", |run| {
            let table = File::options()
                .write(true)
                .open(run.join("designs.csv"))
                .expect("a table");
            table.set_len(3000).expect("a shorter table");
        }),
    ];
    for (name, fault) in faults {
        let run = folder.path().join(name);
        let child = program()
            .arg("optimize")
            .arg(&study)
            .args(["--evaluations", "100000000", "--quiet", "--no-recording", "--out"])
            .arg(&run)
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        wait_for(&run, 200);
        fault(&run);
        let ended = child.wait_with_output().expect("an end");
        let said = String::from_utf8_lossy(&ended.stderr);
        assert_eq!(ended.status.code(), Some(3), "{name}: {said}");
        assert!(
            said.contains("designs.csv") || said.contains("progress.json"),
            "{name}: {said}"
        );
        if name == "truncated" {
            let text = fs::read(run.join("designs.csv")).expect("a table");
            assert!(!text.contains(&0), "a gap in the table");
        }
    }
}

/// A full disk costs the recording first, then ends the run, which prints its front, loses no row, and resumes when there
/// is space.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_costs_no_design() {
    let inside = |script: &str| {
        Command::new("unshare")
            .args(["-rm", "sh", "-ec", script])
            .env("KINEFRONT", env!("CARGO_BIN_EXE_kinefront"))
            .env_remove("RERUN")
            .env("NO_COLOR", "1")
            .output()
            .expect("unshare runs")
    };
    if !inside("mount -t tmpfs none /mnt").status.success() {
        eprintln!("skipped: a small file system cannot be mounted here");
        return;
    }
    let folder = folder();
    let study = small_study(folder.path());
    let whole = folder.path().join("whole");
    optimize(&study, &whole, &["--evaluations", "900"]);
    for kib in [8, 16, 40, 120, 200, 300, 400, 440, 480, 600, 2000, 6000] {
        let kept = folder.path().join(format!("kept{kib}"));
        // Whether it fails or not, the run ends in good order; then there is space, and it is resumed.
        let script = format!(
            "mount -t tmpfs -o size={kib}k none /mnt; mkdir /mnt/other; code=0; \
             \"$KINEFRONT\" optimize {study} --evaluations 900 --out /mnt/run --json >{out} 2>{err} || code=$?; \
             echo \"code $code\"; ls -la /mnt/run; \
             mount -o remount,size=100m /mnt; \
             if test -e /mnt/run/study.toml; then cp -r /mnt/run {kept}.before; \
             \"$KINEFRONT\" optimize --resume /mnt/run --quiet; \
             else \"$KINEFRONT\" optimize {study} --evaluations 900 --out /mnt/run --quiet; fi; \
             \"$KINEFRONT\" check /mnt/run; cp -r /mnt/run {kept}",
            study = study.display(),
            out = folder.path().join("out").display(),
            err = folder.path().join("err").display(),
            kept = kept.display(),
        );
        let output = inside(&script);
        let said = format!(
            "{}{}",
            String::from_utf8_lossy(&output.stdout),
            String::from_utf8_lossy(&output.stderr)
        );
        assert!(output.status.success(), "{kib} KiB: {said}");
        let code: i32 = said
            .lines()
            .find_map(|line| line.strip_prefix("code "))
            .expect("a code")
            .parse()
            .expect("a number");
        let told = fs::read_to_string(folder.path().join("err")).expect("what was said");
        let answer = fs::read_to_string(folder.path().join("out")).expect("an answer");
        let before = kept.with_extension("before");
        if before.exists() {
            // Its name has no extension of its own, so that the first copy stands beside it.
            assert!(matches!(code, 1 | 3), "{kib} KiB: code {code}: {told}");
        }
        if code == 3 {
            assert!(
                told.contains("No space left") || told.contains("disk is full"),
                "{kib} KiB: {told}"
            );
            assert!(
                told.contains("designs.csv")
                    || told.contains("recording")
                    || told.contains(".json")
                    || told.contains("front.csv"),
                "{kib} KiB: {told}"
            );
            let front: serde_json::Value = serde_json::from_str(&answer).expect("the answer arrives");
            assert!(front["front_size"].as_u64().expect("a number") > 0, "{kib} KiB");
        }
        assert!(tables(&kept) == tables(&whole), "{kib} KiB: {said}");
    }
}

/// The recording can be left out or thinned; the tables do not change.
#[test]
fn a_recording_can_be_thinned_or_left_out() {
    let folder = folder();
    let study = small_study(folder.path());
    let [all, tenth, none] = ["all", "tenth", "none"].map(|name| folder.path().join(name));
    optimize(&study, &all, &[]);
    optimize(&study, &tenth, &["--record-every", "10"]);
    optimize(&study, &none, &["--no-recording"]);
    assert!(tables(&all) == tables(&tenth) && tables(&all) == tables(&none));
    assert!(!none.join("recording.rrd").exists());
    for run in [&all, &tenth, &none] {
        check(run).success();
    }
    let recorded = |run: &Path| {
        kinefront::recording::read_apart(&run.join("recording.rrd"))
            .expect("a recording")
            .1
            .len()
    };
    assert_eq!([recorded(&all), recorded(&tenth)], [600, 60]);
    // A resumed run records as it did.
    resume(&tenth, &["--evaluations", "900"]).success();
    assert_eq!(recorded(&tenth), 90);
    check(&tenth).success();
    resume(&none, &["--evaluations", "900"]).success();
    assert!(!none.join("recording.rrd").exists());
}

/// What follows from the designs is repaired; what was guessed would be is not.
#[test]
fn a_folder_is_repaired_where_nothing_is_guessed() {
    let folder = folder();
    let study = small_study(folder.path());
    let [whole, run] = ["whole", "run"].map(|name| folder.path().join(name));
    optimize(&study, &whole, &[]);
    let copy = |to: &Path| {
        let _ = fs::remove_dir_all(to);
        fs::create_dir(to).expect("a folder");
        for entry in fs::read_dir(&whole).expect("a folder") {
            let path = entry.expect("an entry").path();
            fs::copy(&path, to.join(path.file_name().expect("a name"))).expect("a file");
        }
    };
    let flip = |path: PathBuf, place: f64| {
        let mut file = File::options().read(true).write(true).open(&path).expect("a file");
        let at = (place * file.metadata().expect("a size").len() as f64) as u64;
        let mut byte = [0];
        file.seek(SeekFrom::Start(at)).expect("a place");
        file.read_exact(&mut byte).expect("a byte");
        file.seek(SeekFrom::Start(at)).expect("a place");
        file.write_all(&[byte[0] ^ 1]).expect("a byte");
    };
    let damages: [(&str, &dyn Fn()); 6] = [
        ("front.csv", &|| flip(run.join("front.csv"), 0.5)),
        ("front.csv", &|| {
            fs::remove_file(run.join("front.csv")).expect("a front")
        }),
        ("recording.rrd", &|| {
            fs::remove_file(run.join("recording.rrd")).expect("a recording")
        }),
        ("recording.rrd", &|| {
            let file = File::options()
                .write(true)
                .open(run.join("recording.rrd"))
                .expect("a recording");
            file.set_len(2000).expect("a shorter recording");
        }),
        ("run.json", &|| {
            let text = fs::read_to_string(run.join("run.json")).expect("a report");
            fs::write(run.join("run.json"), text.replace("\"feasible\": ", "\"feasible\": 1")).expect("a report");
        }),
        ("run.json", &|| {
            let text = fs::read_to_string(run.join("run.json")).expect("a report");
            fs::write(
                run.join("run.json"),
                text.replace("\"front_verified\": ", "\"front_verified\": 9"),
            )
            .expect("a report");
        }),
    ];
    for (file, damage) in damages {
        copy(&run);
        damage();
        check(&run)
            .code(2)
            .stdout(contains(file).and(contains("can be repaired")));
        kinefront()
            .arg("check")
            .arg(&run)
            .arg("--repair")
            .assert()
            .success()
            .stdout(contains("repaired"));
        assert!(tables(&run) == tables(&whole), "{file}");
        assert_eq!(report(&run), report(&whole), "{file}");
    }
    copy(&run);
    flip(run.join("designs.csv"), 0.5);
    kinefront().arg("check").arg(&run).arg("--repair").assert().code(2);
    check(folder.path()).code(2).stderr(contains("holds no run"));
}
