#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../checks/study.rs"]
mod study;

fuzz_target!(|text: &str| study::check(text));
