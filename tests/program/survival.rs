//! Runs that are killed, interrupted and resumed: a resumed run is the run that was never stopped.

use std::fs::{self, File};
use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use predicates::str::contains;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

#[cfg(unix)]
use super::support::signal;
use super::support::{
    DESIGN, check, folder, optimize, program, read_rows, repetitions, report, resume, sample, says, short_study,
    small_run, small_study, start, tables, value, wait_for, words,
};

/// Killed at any moment of its start, search, verification or end, and resumed on any number of threads, a run leaves the
/// files of a run that was never stopped.
#[test]
fn a_run_that_is_killed_and_resumed_is_the_run_that_was_not() {
    let folder = folder();
    let study = small_study(folder.path());
    for (algorithm, seed) in [("front-de", 1), ("moga2", 2), ("nsga2", 3)] {
        let arguments = ["--algorithm", algorithm, "--threads", "2", "--evaluations", "400"];
        let whole = folder.join(format!("{algorithm}-whole"));
        let since = Instant::now();
        optimize(&study, &whole, &arguments);
        let duration = since.elapsed();
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        for kill in sample(0..67_u32, 2) {
            let run = folder.join(format!("{algorithm}-{kill}"));
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
    let question =
        "objectives = [{ minimize = \"mass_kg\" }]\nworkspace.region = { kind = \"disc\", radius_m = 0.6 }\n";
    let study = folder.write("small.toml", question.to_owned() + &kinefront_testkit::small_study(600));
    let (whole, run) = (folder.join("whole"), folder.join("run"));
    let told = optimize(&study, &whole, &["--evaluations", "500"]);
    assert_eq!(told["front_size"], 1, "{told}");
    optimize(&study, &run, &["--evaluations", "235"]);
    resume(&run, &["--evaluations", "500"]).success();
    assert!(tables(&run) == tables(&whole), "the extended run is another one");

    let designs = read_rows(&whole.join("designs.csv"));
    assert_eq!(designs.len(), 500);
    let feasible = designs.iter().filter(|row| row["feasible"] == "true");
    let least = feasible.map(|row| value(row, "mass_kg")).fold(f64::INFINITY, f64::min);
    let reported = value(&read_rows(&whole.join("front.csv"))[0], "mass_kg");
    assert!((0.99..1.1).contains(&(reported / least)), "{reported} after {least}");
}

/// A finished run can be extended as if the larger budget had been asked at once, though the smaller one cut its last
/// generation short.
#[test]
fn a_finished_run_can_be_extended() {
    let folder = folder();
    let study = small_study(folder.path());
    let (whole, run) = (folder.join("whole"), folder.join("run"));
    optimize(&study, &whole, &["--evaluations", "500"]);
    optimize(&study, &run, &["--evaluations", "310"]);
    let told = resume(&run, &["--evaluations", "300"]).code(2);
    told.stderr(says("already holds 310 evaluations"));
    let told = folder.run("optimize --resume run").success();
    told.stdout(contains("is complete: 310 evaluations"));
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
    let whole = folder.join("whole");
    optimize(&study, &whole, &["--evaluations", "2000"]);
    for name in ["-INT", "-TERM", "-HUP"] {
        let run = folder.join(format!("run{name}"));
        let mut child = start(&study, &run, &["--evaluations", "2000"]);
        wait_for(&run, 200);
        signal(&child, name);
        assert_eq!(child.wait().expect("an end").code(), Some(130), "{name}");
        assert_eq!(report(&run)["outcome"], "interrupted");
        check(&run).success();
        resume(&run, &[]).success();
        assert!(tables(&run) == tables(&whole), "{name}");
    }
    // At the start.
    for wait in [0, 15] {
        let run = folder.join(format!("early{wait}"));
        let mut child = start(&study, &run, &["--evaluations", "2000"]);
        std::thread::sleep(Duration::from_millis(wait));
        signal(&child, "-TERM");
        child.wait().expect("an end");
        if run.join("study.toml").exists() {
            resume(&run, &[]).success();
        } else {
            optimize(&study, &run, &["--evaluations", "2000"]);
        }
        assert!(tables(&run) == tables(&whole), "after {wait} ms");
    }
}

/// A signal that the caller ignores, as `nohup` does, stays ignored.
#[cfg(unix)]
#[test]
fn a_signal_that_is_ignored_ends_nothing() {
    let folder = folder();
    let study = small_study(folder.path());
    let run = folder.join("nohup");
    let script = format!(
        "trap '' HUP; exec '{}' optimize '{}' --evaluations 600 --quiet --no-recording --out '{}'",
        env!("CARGO_BIN_EXE_kinefront"),
        study.display(),
        run.display()
    );
    let started = Command::new("sh").args(["-c", &script]).spawn();
    let mut child = started.expect("a shell");
    wait_for(&run, 60);
    signal(&child, "-HUP");
    assert_eq!(child.wait().expect("an end").code(), Some(0));
    assert_eq!(report(&run)["outcome"], "completed");
}

/// What a run says never stops it: a reader that goes away, and a full device, are no reason to end.
#[cfg(target_os = "linux")]
#[test]
fn telling_never_stops_work() {
    let folder = folder();
    short_study(folder.path());
    let begin = |line: &str, stderr: Stdio| {
        let mut command = program();
        command.current_dir(folder.path()).args(words(line));
        command.stdout(Stdio::null()).stderr(stderr);
        command.spawn().expect("the program starts")
    };
    let mut child = begin("optimize small.toml --out run", Stdio::piped());
    let mut pipe = child.stderr.take().expect("a pipe");
    pipe.read_exact(&mut [0]).expect("a first word");
    drop(pipe);
    assert!(child.wait().expect("an end").success());
    assert_eq!(report(&folder.join("run"))["outcome"], "completed");

    let line = "optimize small.toml --evaluations 1000000 --out full";
    let mut child = begin(line, full_device().into());
    wait_for(&folder.join("full"), 100);
    signal(&child, "-INT");
    assert_eq!(child.wait().expect("an end").code(), Some(130));
    assert_eq!(report(&folder.join("full"))["outcome"], "interrupted");
}

#[cfg(target_os = "linux")]
fn full_device() -> File {
    File::options().write(true).open("/dev/full").expect("a full device")
}

/// What was asked for, however, must arrive.
#[cfg(target_os = "linux")]
#[test]
fn an_answer_that_is_lost_is_an_error() {
    let folder = folder();
    short_study(folder.path());
    for line in [
        "--help",
        "study show",
        &format!("evaluate --design '{DESIGN}' --json"),
        "optimize small.toml --quiet --json --out answer",
    ] {
        let mut command = program();
        command.current_dir(folder.path()).args(words(line));
        let status = command.stdout(full_device()).stderr(Stdio::null()).status();
        assert_eq!(status.expect("the program runs").code(), Some(1), "{line}");
    }
}

/// Of two runs in one folder one is refused, whichever is first.
#[test]
fn a_folder_is_taken_once() {
    let folder = folder();
    let study = small_study(folder.path());
    for round in 0..repetitions(4, 10) {
        let run = folder.join(format!("run{round}"));
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
        let written = fs::read_to_string(run.join("study.toml")).expect("a study");
        assert!(written.contains(&format!("seed = {}", seeds[winner])));
        check(&run).success();
    }
}

/// Runs that are told no folder each find their own, even at the same time.
#[test]
fn runs_without_a_folder_find_their_own() {
    let folder = folder();
    small_study(folder.path());
    let children = [(); 3].map(|()| {
        let mut command = program();
        command.current_dir(folder.path());
        command.args(words("optimize small.toml --evaluations 60 --quiet --no-recording"));
        command.spawn().expect("the program starts")
    });
    for mut child in children {
        assert!(child.wait().expect("an end").success());
    }
    for name in ["small-seed5", "small-seed5-2", "small-seed5-3"] {
        check(&folder.join("runs").join(name)).success();
    }
}

/// A run that is being written is neither resumed nor overwritten, and can be read.
#[test]
fn a_run_in_progress_is_left_alone() {
    let folder = folder();
    let study = small_study(folder.path());
    let run = folder.join("long");
    let mut child = start(&study, &run, &["--evaluations", "1000000", "--no-recording"]);
    wait_for(&run, 100);
    resume(&run, &[]).code(2).stderr(says("in use"));
    let told = folder.run("optimize small.toml --out long").code(2);
    told.stderr(says("already holds a run"));
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
    let all = small_run();
    let [tenth, none] = ["tenth", "none"].map(|name| folder.join(name));
    optimize(&study, &tenth, &["--record-every", "10"]);
    optimize(&study, &none, &["--no-recording"]);
    assert!(tables(&all) == tables(&tenth) && tables(&all) == tables(&none));
    assert!(!none.join("recording.rrd").exists());
    for run in [&all, &tenth, &none] {
        check(run).success();
    }
    let recorded = |run: &Path| {
        let read = kinefront_recording::read_apart(&run.join("recording.rrd"));
        read.expect("a recording").1.len()
    };
    assert_eq!([recorded(&all), recorded(&tenth)], [600, 60]);
    // A resumed run records as it did.
    resume(&tenth, &["--evaluations", "700"]).success();
    assert_eq!(recorded(&tenth), 90);
    check(&tenth).success();
    resume(&none, &["--evaluations", "700"]).success();
    assert!(!none.join("recording.rrd").exists());
}
