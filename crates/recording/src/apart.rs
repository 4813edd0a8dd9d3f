//! Reads recordings in a process of its own: a damaged recording may make its decoder panic, abort, or take all memory.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use super::read::{ReadError, RecordedRun, foreign, read_run};
use kinefront_study::{
    Column, Row, Study, StudyError, TableError, TableFault, TableRow, read_table, table_bytes, write_whole,
};

/// The command of the program that unpacks a recording; it is not for people.
pub const UNPACK_COMMAND: &str = "unpack-recording";

/// Files that an unpacked recording consists of.
const STUDY: &str = "study.toml";
const DESIGNS: &str = "designs.csv";

/// Address space of the process \[KiB\] for what the program itself maps, most of it never touched.
const BASE_KIB: u64 = 1_000_000;

/// Address space for each byte of the recording; reading takes a third of it.
const PER_BYTE: u64 = 8;

/// Time after which a process that still reads is ended.
const PATIENCE: Duration = Duration::from_secs(120);

static PROGRAM: OnceLock<PathBuf> = OnceLock::new();

/// States the program that understands [`UNPACK_COMMAND`]. Without one, recordings are read in this process.
pub fn unpack_with(program: PathBuf) {
    // A second program would be the same one.
    let _ = PROGRAM.set(program);
}

/// Why a recorded run cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum RecordedRunError {
    /// The recording cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// Its study is invalid.
    #[error(transparent)]
    Study(#[from] Box<StudyError>),
    /// One of its designs is invalid.
    #[error(transparent)]
    Table(#[from] TableError),
    /// Its study or its designs cannot be written for the process that asked for them.
    #[error(transparent)]
    Write(#[from] kinefront_study::WriteError),
    /// The process that reads it cannot be used.
    #[error("cannot read {} in a separate process: {cause}", path.display())]
    Process {
        /// The recording.
        path: PathBuf,
        /// Cause of the error.
        cause: std::io::Error,
    },
}

/// Reads the study and the designs of a recorded run, numbered from 0, in a process of its own if there is a program for it.
///
/// # Errors
/// [`RecordedRunError`].
pub fn read_apart(path: &Path) -> Result<(Study, Vec<TableRow>), RecordedRunError> {
    let Some(program) = PROGRAM.get() else {
        return rows(path, &read_run(path)?);
    };
    let failed = |cause: std::io::Error| RecordedRunError::Process {
        path: path.to_owned(),
        cause,
    };
    let folder = tempfile::Builder::new()
        .prefix("kinefront-")
        .tempdir()
        .map_err(failed)?;
    let message = run_limited(program, path, folder.path()).map_err(failed)?;
    if let Some(message) = message {
        return Err(foreign(path, message).into());
    }
    let study = Study::read(&folder.path().join(STUDY)).map_err(Box::new)?;
    let contents = read_table(&folder.path().join(DESIGNS), &study)?;
    Ok((study, contents.rows))
}

/// Runs the program on a recording; returns what it said if it failed.
fn run_limited(program: &Path, recording: &Path, folder: &Path) -> std::io::Result<Option<String>> {
    let limit = BASE_KIB + PER_BYTE * std::fs::metadata(recording)?.len() / 1024;
    let mut command = if cfg!(unix) {
        let mut shell = Command::new("sh");
        let script = format!("ulimit -v {limit} 2>/dev/null; exec \"$0\" \"$@\"");
        shell.arg("-c").arg(script).arg(program);
        shell
    } else {
        Command::new(program)
    };
    let said = folder.join("error.txt");
    let mut child = command
        .arg(UNPACK_COMMAND)
        .arg(recording)
        .arg(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(std::fs::File::create(&said)?)
        .spawn()?;
    let since = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break status;
        }
        if since.elapsed() > PATIENCE {
            child.kill()?;
            child.wait()?;
            return Ok(Some(format!("it cannot be decoded within {} s", PATIENCE.as_secs())));
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    if status.success() {
        return Ok(None);
    }
    let said = std::fs::read_to_string(&said)?;
    Ok(Some(match status.code() {
        Some(2) => said.trim().to_owned(),
        _ => "it is damaged, so that its decoder fails".to_owned(),
    }))
}

/// Unpacks a recording into `study.toml` and `designs.csv` in a folder; the work of the other process.
///
/// # Errors
/// [`RecordedRunError`].
pub fn unpack(path: &Path, folder: &Path) -> Result<(), RecordedRunError> {
    let recorded = read_run(path)?;
    let (study, rows) = rows(path, &recorded)?;
    write_whole(&folder.join(STUDY), recorded.study.as_bytes())?;
    let cells = rows
        .iter()
        .map(|entry| Column::of_designs(&study).map(|column| column.cell(entry)).collect());
    let table = table_bytes(Column::of_designs(&study), cells).map_err(|error| foreign(path, error))?;
    write_whole(&folder.join(DESIGNS), &table)?;
    Ok(())
}

fn rows(path: &Path, recorded: &RecordedRun) -> Result<(Study, Vec<TableRow>), RecordedRunError> {
    let study = Study::parse(&recorded.study, &path.display().to_string()).map_err(Box::new)?;
    let rows = recorded.designs.iter().enumerate().map(|(index, record)| {
        let text = |column: Column| record.texts.get(&*column.name()).map(String::as_str);
        let number = |column: Column| record.numbers.get(&*column.name()).copied();
        let row = Row::read(&study, record.generation, text, number).map_err(|error| TableError {
            path: path.to_owned(),
            fault: TableFault::Design { index, error },
        })?;
        Ok(TableRow::new(index, row))
    });
    let rows = rows.collect::<Result<Vec<_>, TableError>>()?;
    Ok((study, rows))
}
