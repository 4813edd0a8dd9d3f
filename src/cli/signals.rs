//! Signals that end a run: Ctrl-C (SIGINT), SIGTERM, and SIGHUP.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use kinefront_study::RunControl;

use super::{Failure, say};

/// Exit code of a run that was ended by a signal, as shells expect it of Ctrl-C.
pub const INTERRUPTED: u8 = 130;

/// Installs the handler of the signals: the first one interrupts the run, whose files are then completed within a second;
/// the second exits the program immediately. A signal that the caller ignores, as `nohup` does with SIGHUP, stays ignored.
pub fn interrupt_on_signals(control: &Arc<RunControl>, quiet: bool) -> Result<(), Failure> {
    let control = Arc::clone(control);
    let is_second = AtomicBool::new(false);
    at_end_signals(Box::new(move || {
        if is_second.swap(true, Ordering::SeqCst) {
            std::process::exit(INTERRUPTED.into());
        }
        control.interrupt();
        if !quiet {
            say("interrupted: completing the files (a second signal quits immediately)");
        }
    }))
    .map_err(Failure::runtime)
}

/// Makes a write beyond the limit of the size of a file fail like any other, instead of ending the program without a message.
#[cfg(unix)]
pub fn keep_going_at_limits() {
    // Without the handler, which does nothing, the program is as it was.
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default());
}

/// Elsewhere, there is no such signal.
#[cfg(not(unix))]
pub fn keep_going_at_limits() {}

/// Lets a program that runs out of memory end with `code`. The standard library prints that an allocation has failed and aborts, which
/// would otherwise end the program by a signal; its files are those of a run that was killed at that moment.
#[cfg(unix)]
pub fn end_without_memory(code: u8) {
    // Without the handler, the program is as it was.
    let _ = signal_hook::flag::register_conditional_shutdown(
        signal_hook::consts::SIGABRT,
        code.into(),
        Arc::new(AtomicBool::new(true)),
    );
}

/// Elsewhere, an allocation that fails ends the program without a signal.
#[cfg(not(unix))]
pub fn end_without_memory(_code: u8) {}

/// Calls `end` at each of these signals, on a thread of its own. A signal that the caller ignores, as `nohup` does with SIGHUP,
/// stays ignored.
///
/// # Errors
/// The I/O error if the handler cannot be installed.
#[cfg(unix)]
pub fn at_end_signals(end: Box<dyn Fn() + Send>) -> io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    let ignored = ignored_signals();
    let handled = [SIGINT, SIGTERM, SIGHUP]
        .into_iter()
        .filter(|signal| ignored & (1 << (signal - 1)) == 0);
    let mut signals = signal_hook::iterator::Signals::new(handled)?;
    std::thread::Builder::new()
        .name("kinefront-signals".to_owned())
        .spawn(move || signals.forever().for_each(|_| end()))?;
    Ok(())
}

/// Returns the set of the signals that this process ignores, as Linux states it; empty elsewhere.
#[cfg(unix)]
fn ignored_signals() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok())
        .unwrap_or(0)
}

/// Calls `end` at each of these signals, on a thread of its own.
///
/// # Errors
/// The I/O error if the handler cannot be installed.
#[cfg(not(unix))]
pub fn at_end_signals(end: Box<dyn Fn() + Send>) -> io::Result<()> {
    ctrlc::set_handler(end).map_err(io::Error::other)
}
