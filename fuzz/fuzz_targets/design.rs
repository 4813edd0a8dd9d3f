#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../checks/design.rs"]
mod design;

fuzz_target!(|text: &str| design::check(text));
