//! What files are asked for, and the dialogs of the operating system, which do not block the window.

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, channel};

use kinefront_export::Format;

/// Purpose of a file selected in a dialog.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// A study, a table of a run folder or a recording to open.
    Open,
    /// A run folder to open.
    OpenFolder,
    /// A run folder to show beside the run in the window.
    OpenBeside,
    /// Destination of the study.
    SaveStudy,
    /// Destination of the session's recording.
    SaveRecording,
    /// Destination of the run folder.
    SaveRun,
    /// Destination folder of the report on the run.
    Report,
    /// Destination of the table of the front.
    ExportFront,
    /// Destination of the recording of the selected design.
    RecordDesign,
    /// Destination of the selected design in a format of other programs.
    ExportDesign(Format),
    /// Destination of a picture of the window.
    SavePicture,
    /// Destination of the filter.
    SaveFilter,
    /// A filter to read.
    OpenFilter,
}

impl Purpose {
    /// Returns the title of the dialog, the default file name, and the types of file.
    fn dialog(
        self,
    ) -> (
        &'static str,
        &'static str,
        &'static [(&'static str, &'static [&'static str])],
    ) {
        match self {
            Purpose::Open => (
                "Open a study, a run or a recording",
                "",
                &[("studies, recordings, tables", &["toml", "rrd", "csv"])],
            ),
            Purpose::OpenFolder => ("Open a run folder", "", &[]),
            Purpose::OpenBeside => ("Open a run folder to compare it with this run", "", &[]),
            Purpose::SaveStudy => ("Save the study", "study.toml", &[("study", &["toml"])]),
            Purpose::SaveRecording => ("Save the recording", "session.rrd", &[("recording", &["rrd"])]),
            Purpose::SaveRun => ("Save the run folder", "run", &[]),
            Purpose::Report => ("Folder for the report", "report", &[]),
            Purpose::ExportFront => (
                "Export the front",
                "front.csv",
                &[("CSV", &["csv"]), ("Parquet", &["parquet"])],
            ),
            Purpose::RecordDesign => ("Record the design", "design.rrd", &[("recording", &["rrd"])]),
            Purpose::ExportDesign(format) => ("Export the design", format.file(), &[]),
            Purpose::SavePicture => ("Save a picture", "kinefront.png", &[("picture", &["png"])]),
            Purpose::SaveFilter => ("Save the filter", "filter.toml", &[("filter", &["toml"])]),
            Purpose::OpenFilter => ("Open a filter", "", &[("filter", &["toml"])]),
        }
    }

    /// Returns the title of the dialog.
    pub fn title(self) -> &'static str {
        self.dialog().0
    }

    /// Returns the default file name.
    pub fn name(self) -> &'static str {
        self.dialog().1
    }

    fn is_saving(self) -> bool {
        !matches!(
            self,
            Purpose::Open | Purpose::OpenFolder | Purpose::OpenBeside | Purpose::OpenFilter
        )
    }
}

/// A dialog of the operating system, open on its own thread.
pub struct Dialog {
    purpose: Purpose,
    answer: Receiver<Option<PathBuf>>,
}

impl Dialog {
    /// Opens the dialog of the operating system.
    pub fn open(purpose: Purpose, wake: impl Fn() + Send + 'static) -> Self {
        let (sender, answer) = channel();
        let (title, name, kinds) = purpose.dialog();
        let mut dialog = rfd::FileDialog::new().set_title(title);
        for (kind, extensions) in kinds {
            dialog = dialog.add_filter(*kind, extensions);
        }
        std::thread::spawn(move || {
            let path = match purpose {
                Purpose::OpenFolder | Purpose::OpenBeside => dialog.pick_folder(),
                _ if purpose.is_saving() => dialog.set_file_name(name).save_file(),
                _ => dialog.pick_file(),
            };
            // The send fails only if the window is already closed.
            let _ = sender.send(path);
            wake();
        });
        Self { purpose, answer }
    }

    /// Returns the purpose and the selected path once the dialog is closed; the path is `None` if the user cancelled.
    pub fn choice(&self) -> Option<(Purpose, Option<PathBuf>)> {
        self.answer.try_recv().ok().map(|path| (self.purpose, path))
    }
}
