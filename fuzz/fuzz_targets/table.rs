#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../checks/table.rs"]
mod table;

fuzz_target!(|bytes: &[u8]| table::check(bytes));
