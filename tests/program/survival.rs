//! Runs that are killed, interrupted and resumed: a resumed run is the run that was never stopped.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::Read;
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use predicates::str::contains;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

#[cfg(unix)]
use super::support::signal;
use super::support::{
    DESIGN, check, folder, kinefront, optimize, program, repetitions, report, resume, sample, small_study, start,
    tables, wait_for,
};

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
        for kill in sample(0..67_u32, 2) {
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

/// The lightest design for a prescribed region: the search converges to limits of the geometry, at which nothing holds on the fine
/// grid but what is sized there. A run that is extended ends like one that was longer from the start.
#[test]
fn a_search_for_the_lightest_design_reports_one_that_holds_on_the_fine_grid() {
    let folder = folder();
    let study = small_study(folder.path());
    let mut text = fs::read_to_string(&study).expect("a study");
    text.insert_str(
        0,
        "objectives = [{ minimize = \"mass_kg\" }]\nworkspace.region = { kind = \"disc\", radius_m = 0.6 }\n",
    );
    fs::write(&study, text).expect("a study");
    let (whole, run) = (folder.path().join("whole"), folder.path().join("run"));
    let told = optimize(&study, &whole, &["--evaluations", "500"]);
    assert_eq!(told["front_size"], 1, "{told}");
    optimize(&study, &run, &["--evaluations", "235"]);
    resume(&run, &["--evaluations", "500"]).success();
    assert!(tables(&run) == tables(&whole), "the extended run is another one");

    let cell = |file: &str, row: usize, column: &str| -> String {
        let text = fs::read_to_string(whole.join(file)).expect("a table");
        let lines: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
        let place = lines[0].iter().position(|name| *name == column).expect("a column");
        lines[row][place].to_owned()
    };
    let mass = |file: &str, row: usize| cell(file, row, "mass_kg").parse::<f64>().expect("a mass");
    let feasible = (1..=500).filter(|&row| cell("designs.csv", row, "feasible") == "true");
    let least = feasible
        .map(|row| mass("designs.csv", row))
        .fold(f64::INFINITY, f64::min);
    let reported = mass("front.csv", 1);
    assert!((0.99..1.1).contains(&(reported / least)), "{reported} after {least}");
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
        .stderr(contains("already holds 310 evaluations"));
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
    // A signal that the caller ignores, as `nohup` does, stays ignored.
    let run = folder.path().join("nohup");
    let script = format!(
        "trap '' HUP; exec '{}' optimize '{}' --evaluations 600 --quiet --no-recording --out '{}'",
        env!("CARGO_BIN_EXE_kinefront"),
        study.display(),
        run.display()
    );
    let mut child = std::process::Command::new("sh")
        .args(["-c", &script])
        .spawn()
        .expect("a shell");
    wait_for(&run, 60);
    signal(&child, "-HUP");
    assert_eq!(child.wait().expect("an end").code(), Some(0));
    assert_eq!(report(&run)["outcome"], "completed");
    // At the start.
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

/// Of two runs in one folder one is refused, whichever is first; runs without a folder each find their own.
#[test]
fn a_folder_is_taken_once() {
    let folder = folder();
    let study = small_study(folder.path());
    for round in 0..repetitions(4, 10) {
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
    check(&run).success().stdout(contains(
        "has not ended: another process is searching, or it can be resumed",
    ));
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
        kinefront_recording::read_apart(&run.join("recording.rrd"))
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
