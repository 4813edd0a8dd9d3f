#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../checks/recording.rs"]
mod recording;

fuzz_target!(init: {
    let program = std::env::var_os("KINEFRONT").expect("KINEFRONT names the program");
    kinefront_recording::unpack_with(program.into());
}, |bytes: &[u8]| recording::check(bytes));
