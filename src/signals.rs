//! Signals that ask the program to end: Ctrl-C (SIGINT), SIGTERM, and SIGHUP.

use std::io;

/// Calls `end` at each of these signals, on a thread of its own. A signal that the caller ignores, as `nohup` does with SIGHUP,
/// stays ignored.
///
/// # Errors
/// The I/O error if the handler cannot be installed.
#[cfg(unix)]
pub fn at_end_signals(end: impl Fn() + Send + 'static) -> io::Result<()> {
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
pub fn at_end_signals(end: impl Fn() + Send + 'static) -> io::Result<()> {
    ctrlc::set_handler(end).map_err(io::Error::other)
}
