//! Any bytes are a recording or refused; what the decoder does to its process does not matter. `KINEFRONT` names the program.
#![no_main]

use std::io::Write;

use libfuzzer_sys::fuzz_target;

fuzz_target!(init: {
    let program = std::env::var_os("KINEFRONT").expect("KINEFRONT names the program");
    kinefront_recording::unpack_with(program.into());
}, |bytes: &[u8]| {
    let mut file = tempfile::NamedTempFile::new().expect("a file");
    file.write_all(bytes).expect("a recording");
    let _ = kinefront_recording::read_apart(file.path());
});
