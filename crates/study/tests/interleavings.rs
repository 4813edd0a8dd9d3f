//! Every interleaving of a run with the threads that control it, by a model of the standard library's locks: none ends in a deadlock,
//! and none loses a request.
//!
//! The sources of the control are compiled again with the locks of the model.

#[path = "../src/control.rs"]
mod control;

/// The locks of the model.
mod sync {
    pub use loom::sync::{Condvar, Mutex, MutexGuard};
    pub use std::sync::PoisonError;
}

use control::RunControl;
use loom::sync::Arc;
use loom::sync::atomic::{AtomicUsize, Ordering};
use loom::thread;

/// Why a run ends, as its control states it.
#[derive(Debug, PartialEq, Eq)]
enum EndReason {
    Stopped,
    Interrupted,
}

/// A run of at most `budget` generations, which counts them.
fn run(control: &Arc<RunControl>, budget: usize) -> (thread::JoinHandle<()>, Arc<AtomicUsize>) {
    let generations = Arc::new(AtomicUsize::new(0));
    let (control, count) = (Arc::clone(control), Arc::clone(&generations));
    let run = thread::spawn(move || {
        while count.load(Ordering::SeqCst) < budget && control.go_on() {
            count.fetch_add(1, Ordering::SeqCst);
        }
    });
    (run, generations)
}

#[test]
fn a_paused_run_goes_on_when_it_is_resumed() {
    loom::model(|| {
        let control = Arc::new(RunControl::default());
        let (run, generations) = run(&control, 2);
        control.pause();
        control.resume();
        run.join().expect("the run ends");
        assert_eq!(generations.load(Ordering::SeqCst), 2);
    });
}

#[test]
fn a_paused_run_performs_as_many_generations_as_steps() {
    loom::model(|| {
        let control = Arc::new(RunControl::default());
        control.pause();
        let (run, generations) = run(&control, 3);
        control.step();
        control.step();
        while !(control.is_waiting() && generations.load(Ordering::SeqCst) == 2) {
            thread::yield_now();
        }
        control.stop();
        run.join().expect("the run ends");
        assert_eq!(generations.load(Ordering::SeqCst), 2);
        assert_eq!(control.end_reason(), EndReason::Stopped);
    });
}

/// Whatever another thread does to a run at the same time, a request to end it ends it.
#[test]
fn a_run_ends_whoever_pauses_it() {
    for interrupt in [false, true] {
        loom::model(move || {
            let control = Arc::new(RunControl::default());
            let (run, generations) = run(&control, 3);
            let other = Arc::clone(&control);
            let other = thread::spawn(move || other.pause());
            if interrupt {
                control.interrupt();
            } else {
                control.abandon();
            }
            run.join().expect("the run ends");
            other.join().expect("the other thread ends");
            assert!(generations.load(Ordering::SeqCst) <= 3 && control.is_abandoned());
            let expected = if interrupt {
                EndReason::Interrupted
            } else {
                EndReason::Stopped
            };
            assert_eq!(control.end_reason(), expected);
        });
    }
}
