//! Runs that are paused, stepped, stopped, interrupted and abandoned at random moments.

use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::sync_channel;
use std::time::Duration;

use kinefront_recording::{Recorder, RunFiles};
use kinefront_study::{
    EndReason, Event, Inspection, ResumeOptions, Resumption, RunControl, RunWriter, Study, StudySearch, spawn_search,
};
use kinefront_testkit::repetitions;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

fn study() -> Study {
    let text = "name = \"tiny\"\n[grid.reference]\nphi_step_deg = 10\ndirections = 3\nray_steps = 6\nhalvings = 2\n\
                [grid.fine]\nphi_step_deg = 10\ndirections = 6\nray_steps = 10\nhalvings = 2\n\
                [optimizer]\nevaluations = 300\nthreads = 2\nseed = 3\nfront_designs = 8\n";
    Study::parse(text, "tiny").expect("a valid study")
}

/// Performs a search and its files while `operate` controls it; returns the reason why it ended, if it has a summary.
fn perform(writer: RunWriter, search: StudySearch, operate: impl FnOnce(&RunControl) + Send) -> Option<EndReason> {
    let control = Arc::new(RunControl::default());
    let recorder = Recorder::of_run(&writer, search.study()).expect("a recording");
    let (next, events) = sync_channel(4);
    let (listeners, files) =
        RunFiles::start(writer, recorder, next, Arc::clone(&control), |error| panic!("{error}")).expect("threads");
    let worker = spawn_search(search, Arc::clone(&control), listeners).expect("a thread");
    let mut outcome = None;
    std::thread::scope(|scope| {
        scope.spawn(|| operate(&control));
        for event in events {
            match &*event {
                Event::Finished(summary) => outcome = Some(summary.outcome),
                Event::Failed(message) => panic!("{message}"),
                _ => {}
            }
        }
    });
    worker.join().expect("the worker ends");
    assert!(files.join().is_empty());
    outcome
}

fn tables(run: &Path) -> [Vec<u8>; 3] {
    ["study.toml", "designs.csv", "front.csv"].map(|file| std::fs::read(run.join(file)).expect("a table"))
}

/// Pauses, resumes and steps a run at random moments, and then ends it in the way that the random seed tells.
fn disturb(control: &RunControl, seed: u64) {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    for _ in 0..6 {
        match random.next_u32() % 6 {
            0 => control.pause(),
            1 | 2 => control.resume(),
            3 => control.step(),
            _ => {}
        }
        std::thread::sleep(Duration::from_micros(u64::from(random.next_u32() % 4000)));
    }
    control.resume();
    std::thread::sleep(Duration::from_micros(u64::from(random.next_u32() % 80_000)));
    match seed % 4 {
        0 => control.interrupt(),
        1 => control.stop(),
        2 => control.abandon(),
        _ => {}
    }
}

/// Whatever is done to a run, its folder is sound, and the resumed run is the run to which nothing was done.
#[test]
fn a_run_survives_its_controls() {
    let folder = tempfile::tempdir().expect("a folder");
    let whole = folder.path().join("whole");
    let start = |path: &Path, record: bool| {
        let search = StudySearch::new(study(), None).expect("a search");
        (
            RunWriter::create(path, search.study(), record.then_some(1)).expect("a folder"),
            search,
        )
    };
    let (writer, search) = start(&whole, false);
    assert_eq!(perform(writer, search, |_| {}), Some(EndReason::Completed));
    let mut ended = [0; 4];
    for seed in 0..repetitions(12, 300) as u64 {
        let run = folder.path().join("run");
        let (writer, search) = start(&run, seed.is_multiple_of(20));
        let outcome = perform(writer, search, |control| disturb(control, seed));
        let place = match outcome {
            Some(EndReason::Completed) => 0,
            Some(EndReason::Stopped) => 1,
            Some(EndReason::Interrupted) => 2,
            None => 3,
            Some(other) => panic!("seed {seed}: {other:?}"),
        };
        ended[place] += 1;
        let inspection = Inspection::new(&run).expect("a run");
        assert!(inspection.findings.is_empty(), "seed {seed}: {:?}", inspection.findings);
        let resumption =
            Resumption::open(&run, &ResumeOptions::default()).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        if !resumption.is_complete() {
            let (writer, search) = resumption.start(None).expect("a folder");
            assert_eq!(
                perform(writer, search, |_| {}),
                Some(EndReason::Completed),
                "seed {seed}"
            );
        }
        assert!(tables(&run) == tables(&whole), "seed {seed}");
        std::fs::remove_dir_all(&run).expect("a folder");
    }
    println!("completed, stopped, interrupted, abandoned: {ended:?}");
    assert!(ended.iter().all(|&count| count > 0), "{ended:?}");
}
