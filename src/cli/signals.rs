//! Signals that end a run: Ctrl-C (SIGINT), SIGTERM, and SIGHUP.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use kinefront::signals::at_end_signals;
use kinefront::study::RunControl;

use super::{Failure, say};

/// Exit code of a run that was ended by a signal, as shells expect it of Ctrl-C.
pub const INTERRUPTED: u8 = 130;

/// Installs the handler of the signals: the first one interrupts the run, whose files are then completed within a second;
/// the second exits the program immediately. A signal that the caller ignores, as `nohup` does with SIGHUP, stays ignored.
pub fn interrupt_on_signals(control: &Arc<RunControl>, quiet: bool) -> Result<(), Failure> {
    let control = Arc::clone(control);
    let is_second = AtomicBool::new(false);
    at_end_signals(move || {
        if is_second.swap(true, Ordering::SeqCst) {
            std::process::exit(INTERRUPTED.into());
        }
        control.interrupt();
        if !quiet {
            say("interrupted: completing the files (a second signal quits immediately)");
        }
    })
    .map_err(Failure::runtime)
}
