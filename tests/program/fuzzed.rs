//! What the fuzz targets check (`fuzz/checks/`), on their corpus and on inputs that differ from it by a few bytes.

use std::fs;
use std::path::Path;

use kinefront_testkit::numbers;

use super::support::repetitions;

#[path = "../../fuzz/checks/design.rs"]
mod design;
#[path = "../../fuzz/checks/recording.rs"]
mod recording;
#[path = "../../fuzz/checks/run_folder.rs"]
mod run_folder;
#[path = "../../fuzz/checks/stream.rs"]
mod stream;
#[path = "../../fuzz/checks/study.rs"]
mod study;
#[path = "../../fuzz/checks/table.rs"]
mod table;

/// Calls a check with each file of a folder, and with `count` changed ones.
fn each_input(folder: &str, count: usize, check: impl Fn(&[u8])) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let entries = fs::read_dir(&folder).expect("a corpus");
    let mut paths: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
    paths.sort();
    let corpus: Vec<Vec<u8>> = paths.iter().map(|path| fs::read(path).expect("an input")).collect();
    assert!(corpus.len() >= 2, "{} has inputs", folder.display());
    corpus.iter().for_each(|input| check(input));
    let mut number = numbers(count as u64);
    for _ in 0..count {
        let from = &corpus[(number() * corpus.len() as f64) as usize];
        check(&changed(from, &mut number));
    }
}

/// Returns an input of which some bytes are replaced, removed or repeated.
fn changed(input: &[u8], number: &mut impl FnMut() -> f64) -> Vec<u8> {
    /// Bytes that mean something in one of the formats.
    const MEANINGFUL: &[u8] = b"0123456789.,-+eE=\"[]{}#\n\0 \xff";
    let mut bytes = input.to_vec();
    for _ in 0..1 + (number() * 4.0) as usize {
        let mut place = || (number() * bytes.len().max(1) as f64) as usize;
        let (from, to) = (place(), place());
        let way = (number() * 4.0) as usize;
        let byte = MEANINGFUL[(number() * MEANINGFUL.len() as f64) as usize];
        match way {
            0 if from < bytes.len() => bytes[from] = byte,
            1 => bytes.insert(from.min(bytes.len()), byte),
            2 => drop(bytes.drain(from.min(to)..from.max(to).min(from.min(to) + 8))),
            _ => {
                let part = bytes[from.min(to)..from.max(to)].to_vec();
                bytes.splice(from..from, part.into_iter().take(64));
            }
        }
    }
    bytes
}

fn as_text(check: impl Fn(&str)) -> impl Fn(&[u8]) {
    move |bytes: &[u8]| check(&String::from_utf8_lossy(bytes))
}

#[test]
fn changed_texts_are_read_or_refused() {
    let count = repetitions(1000, 20_000);
    each_input("fuzz/corpus/study", count, as_text(study::check));
    each_input("crates/study/assets/studies", count, as_text(study::check));
    each_input("fuzz/corpus/design", count, as_text(design::check));
    each_input("fuzz/corpus/stream", count, as_text(stream::check));
}

#[test]
fn changed_files_are_read_or_refused() {
    each_input("fuzz/corpus/table", repetitions(300, 20_000), table::check);
    each_input("fuzz/corpus/run_folder", repetitions(60, 2000), run_folder::check);
    kinefront_recording::unpack_with(env!("CARGO_BIN_EXE_kinefront").into());
    each_input("fuzz/corpus/recording", repetitions(20, 500), recording::check);
}
