//! Streams of designs: a design per line on standard input, a JSON object per line on standard output.

use std::error::Error;
use std::io::{self, BufRead, Read};

use serde::Serialize;

use super::to_json;

/// Longest line \[bytes\]; a design takes about a hundred.
const LONGEST_LINE: u64 = 1 << 16;

/// A line as text, or what is wrong with it.
pub type InputLine = Result<String, String>;

/// Reads the next line; `None` at the end of the input.
pub fn next_line(mut input: impl BufRead) -> io::Result<Option<InputLine>> {
    let mut line = Vec::new();
    if (&mut input).take(LONGEST_LINE).read_until(b'\n', &mut line)? == 0 {
        return Ok(None);
    }
    if line.len() as u64 == LONGEST_LINE && !line.ends_with(b"\n") {
        input.skip_until(b'\n')?;
        return Ok(Some(Err(format!("the line is longer than {LONGEST_LINE} bytes"))));
    }
    Ok(Some(
        String::from_utf8(line).map_err(|_| "the line is not UTF-8".to_owned()),
    ))
}

/// Answers a line with what `evaluate` makes of it, or with an object that has the key `error` alone.
pub fn answer<T: Serialize, E: Error>(line: InputLine, evaluate: impl FnOnce(&str) -> Result<T, E>) -> String {
    line.and_then(|text| evaluate(&text).map_err(|error| error.to_string()))
        .and_then(|found| to_json(&found).map_err(|error| error.to_string()))
        .unwrap_or_else(|message| serde_json::json!({ "error": message }).to_string())
}
