//! Runs a study from a program, prints the front as it grows, and leaves a run folder.
//!
//! `cargo run --release -p kinefront-study --example run_study -- FOLDER`

use std::error::Error;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::sync_channel;

use kinefront_study::{Event, RunControl, RunFolder, RunWriter, Study, WriteError, spawn};

const STUDY: &str = r#"
name = "example"
architectures = ["3-PRR", "3-RPR"]

[requirements]
in_plane_force_n = 50.0

[optimizer]
evaluations = 300
"#;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("name a folder for the run")?);
    let study = Study::parse(STUDY, "example")?;
    let mut writer = RunWriter::create(&folder, &study, None)?;

    // Each listener has a channel and a thread of its own.
    let (to_writer, for_writer) = sync_channel::<Arc<Event>>(64);
    let (to_terminal, for_terminal) = sync_channel(64);
    let writing = std::thread::spawn(move || -> Result<(), WriteError> {
        for event in for_writer {
            writer.write(Some(&event))?;
            if let Event::Finished(summary) = &*event {
                writer.finish(summary)?;
                writer.conclude()?;
            }
        }
        Ok(())
    });
    let worker = spawn(study, Arc::new(RunControl::default()), vec![to_writer, to_terminal])?;
    for event in for_terminal {
        match &*event {
            Event::Generation(state) => {
                println!("{} evaluations: {} on the front", state.evaluations, state.front_size)
            }
            Event::Failed(message) => return Err(message.clone().into()),
            _ => {}
        }
    }
    worker.join().map_err(|_| "the worker thread panicked")?;
    writing.join().map_err(|_| "the writing thread panicked")??;

    let run = RunFolder::open(&folder)?;
    let front = run.front()?.ok_or("the run has no front")?;
    let lightest = front.rows.first().ok_or("the front is empty")?;
    println!(
        "{}: {:.1} kg, R_w {:.3} m",
        lightest.row.design,
        lightest.row.mass(),
        lightest.row.workspace_radius()
    );
    Ok(())
}
