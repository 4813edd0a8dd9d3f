#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../checks/run_folder.rs"]
mod run_folder;

fuzz_target!(|bytes: &[u8]| run_folder::check(bytes));
