//! The `kinefront` program.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::keep_going_at_limits();
    cli::run()
}
