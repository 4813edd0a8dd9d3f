//! Reading and writing the files that the user selects.

use crate::AnyError;
use std::path::{Path, PathBuf};

mod dialog;
mod open;

pub use dialog::{Dialog, Purpose};
pub use open::{OpenError, Opened, open, run_folder_of};

use super::threads::Writing;
use super::{Phase, Session};
use kinefront_export::{ExportSubject, Format, export, front_to_parquet};
use kinefront_model::evaluation::GridChoice;
use kinefront_recording::{record_design, save_copy};
use kinefront_report::{Options, Report, Source};
use kinefront_scene::Field;
use kinefront_study::{Cell, Column, replace, table_bytes, write_whole};

/// Work on files that does not block the window; it returns a message for the user.
pub type Job = Box<dyn FnOnce() -> Result<String, AnyError> + Send>;

/// Handles the selected file; returns the work that remains to be done in the background, or `None` if there is none.
pub fn act(session: &mut Session, purpose: Purpose, path: PathBuf) -> Option<Job> {
    match purpose {
        Purpose::Open | Purpose::OpenFolder => session.open(&path),
        Purpose::OpenBeside => session.open_beside(&path),
        Purpose::SaveStudy => {
            let saved = session.editor_mut().save(&path);
            notify(session, saved.map(|()| format!("saved {}", path.display())));
        }
        Purpose::SaveFilter => {
            let text = session.document().filter.to_text();
            let saved = write_whole(&path, text.as_bytes()).map_err(AnyError::from);
            notify(session, saved.map(|()| format!("saved {}", path.display())));
        }
        Purpose::OpenFilter => match read_filter(&path) {
            Ok(filter) => session.edit(|document| document.filter = filter),
            Err(words) => session.notify_error(words),
        },
        Purpose::ExportFront => {
            let parquet = path.extension().is_some_and(|extension| extension == "parquet");
            let table = || -> Result<Vec<u8>, AnyError> {
                let table = front_table(session)?;
                Ok(if parquet { front_to_parquet(&table)? } else { table })
            };
            let written = table().and_then(|table| Ok(write_whole(&path, &table)?));
            notify(session, written.map(|()| format!("exported {}", path.display())));
        }
        Purpose::SaveRecording => return begun(save_recording(session, path), session),
        Purpose::RecordDesign => return begun(record(session, path), session),
        Purpose::ExportDesign(format) => return begun(export_design(session, format, path), session),
        Purpose::SaveRun => return begun(save_run(session, path), session),
        Purpose::Report => return begun(report(session, path), session),
        // The window takes the picture itself.
        Purpose::SavePicture => {}
    }
    None
}

/// Returns a job, or tells why there is none.
fn begun(job: Result<Job, &'static str>, session: &mut Session) -> Option<Job> {
    job.map_err(|words| session.notify_error(words)).ok()
}

fn notify(session: &mut Session, outcome: Result<String, AnyError>) {
    match outcome {
        Ok(words) => session.notify(words),
        Err(words) => session.notify_error(words),
    }
}

const NO_RUN: &str = "there is no run to save; an opened run is already on disk";
const NO_DESIGN: &str = "no design is selected";

fn save_recording(session: &Session, path: PathBuf) -> Result<Job, &'static str> {
    let folder = session.run_folder().ok_or(NO_RUN)?;
    let writing = session.writing();
    let study = session.prepared();
    let shown = session
        .known()
        .map(|known| known.evaluation.clone())
        .zip(session.selected_name());
    Ok(Box::new(move || {
        writing.iter().for_each(Writing::wait);
        let shown = shown
            .as_ref()
            .map(|(evaluation, name)| (study.model(), &**evaluation, name.as_str()));
        replace(&path, |part| {
            Ok::<_, AnyError>(save_copy(&folder.join("recording.rrd"), part, shown)?)
        })?;
        Ok(format!("saved {}", path.display()))
    }))
}

/// Exports the selected design at the pose that is shown.
fn export_design(session: &Session, format: Format, path: PathBuf) -> Result<Job, &'static str> {
    let known = session.known().cloned().ok_or(NO_DESIGN)?;
    let study = session.prepared();
    let pose = session.view().pose;
    Ok(Box::new(move || {
        // The export contains the values from the fine grid.
        let fine = if known.verified {
            (*known.evaluation).clone()
        } else {
            study.model().evaluate(&known.evaluation.design, GridChoice::Fine)
        };
        let subject = ExportSubject {
            study: &study,
            evaluation: &fine,
            pose,
        };
        let bytes = export(&subject, format)?;
        write_whole(&path, &bytes)?;
        let lost = format.lost().map(|lost| format!("; not in the file: {lost}"));
        Ok(format!("exported {}{}", path.display(), lost.unwrap_or_default()))
    }))
}

fn record(session: &Session, path: PathBuf) -> Result<Job, &'static str> {
    let (known, name) = session.known().cloned().zip(session.selected_name()).ok_or(NO_DESIGN)?;
    let study = session.prepared();
    let field = session.view().layers.heatmap.unwrap_or(Field::DEXTERITY);
    Ok(Box::new(move || {
        replace(&path, |part| {
            Ok::<_, AnyError>(record_design(part, &study, &known.evaluation, &name, Some(field))?)
        })?;
        Ok(format!("exported {}", path.display()))
    }))
}

/// Saves the run folder with a complete recording; `path` must not contain a run.
fn save_run(session: &Session, path: PathBuf) -> Result<Job, &'static str> {
    let folder = session.run_folder().ok_or(NO_RUN)?;
    let writing = session.writing();
    Ok(Box::new(move || {
        writing.iter().for_each(Writing::wait);
        let failed = |what: &Path, error: std::io::Error| format!("cannot write {}: {error}", what.display());
        std::fs::create_dir_all(&path).map_err(|error| failed(&path, error))?;
        let entries = std::fs::read_dir(&folder).map_err(|error| failed(&folder, error))?;
        let names: Vec<std::ffi::OsString> = entries.flatten().map(|entry| entry.file_name()).collect();
        if let Some(taken) = names.iter().find(|name| path.join(name).exists()) {
            let taken = path.join(taken);
            return Err(format!("{} already exists; choose another folder", taken.display()).into());
        }
        for name in names {
            let target = path.join(&name);
            if name == "recording.rrd" {
                save_copy(&folder.join(&name), &target, None)?;
            } else if !name.to_string_lossy().ends_with(".partial") {
                std::fs::copy(folder.join(&name), &target).map_err(|error| failed(&target, error))?;
            }
        }
        Ok(format!("saved the run to {}", path.display()))
    }))
}

/// Writes the report on the run in the window, without the report's own searches, which would take minutes.
fn report(session: &mut Session, path: PathBuf) -> Result<Job, &'static str> {
    let opened = match session.phase() {
        Phase::Opened(path) if path.is_dir() => Some(path.clone()),
        _ => None,
    };
    let folder = session.run_folder().or(opened);
    let folder = folder.ok_or("there is no run to report on; start a run or open a run folder")?;
    let writing = session.writing();
    session.notify("writing the report; this takes several seconds".to_owned());
    Ok(Box::new(move || {
        writing.iter().for_each(Writing::wait);
        let options = Options {
            command: "File › Create report, in the window".to_owned(),
            ..Options::default()
        };
        let make = || {
            let mut source = Source::read(&folder)?;
            // The window runs in a temporary folder whose name means nothing, so the report has the name of the study.
            source.name.clone_from(&source.study.name);
            Report::make(&[source], options, &mut |_| {})?.write(&path, false)
        };
        make().map_err(|error| error.to_string())?;
        Ok(format!("wrote {}", path.join("index.html").display()))
    }))
}

fn read_filter(path: &Path) -> Result<super::Filter, AnyError> {
    let text = std::fs::read_to_string(path).map_err(|error| format!("cannot read {}: {error}", path.display()))?;
    Ok(super::Filter::parse(&text)?)
}

/// Returns the front as a CSV table, which begins with the columns common to all tables of designs.
fn front_table(session: &Session) -> Result<Vec<u8>, AnyError> {
    use Column::{Certificate, CertifiedLower, CertifiedUpper, Note, ReferenceRadius, Starred, Verified};
    let proofs = [CertifiedLower, CertifiedUpper, Certificate];
    let columns = || {
        Column::common()
            .chain([ReferenceRadius, Verified, Starred, Note])
            .chain(proofs)
    };
    let document = session.document();
    let rows = session.front().iter().map(|entry| {
        let row = entry.to_table_row();
        let cell = |column| match column {
            Verified => Cell::Flag(entry.verified),
            Starred => Cell::Flag(document.stars.contains(&entry.id)),
            Note => Cell::Text(document.notes.get(&entry.id).cloned().unwrap_or_default().into()),
            column => column.cell(&row),
        };
        columns().map(cell).collect()
    });
    Ok(table_bytes(columns(), rows)?)
}
