//! Any bytes are a recording or refused; what the decoder does to its process does not matter.

use std::io::Write;

pub fn check(bytes: &[u8]) {
    let mut file = tempfile::NamedTempFile::new().expect("a file");
    file.write_all(bytes).expect("a recording");
    let _ = kinefront_recording::read_apart(file.path());
}
