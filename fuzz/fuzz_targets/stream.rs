#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../checks/stream.rs"]
mod stream;

fuzz_target!(|line: &str| stream::check(line));
