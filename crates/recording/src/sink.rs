//! A file sink that reports write errors to its caller.
//!
//! The SDK's own file sink reports a full disk only in its log, and an error in writing the footer not at all. This
//! sink keeps the first error for the caller, and synchronises the file to disk at the end.

use std::fs::File;
use std::io;
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use rerun::external::re_build_info::CrateVersion;
use rerun::external::re_log_encoding::{Encoder, EncodingOptions};
use rerun::log::LogMsg;
use rerun::sink::{LogSink, SinkFlushError};

/// A recording file being written; clones share it.
#[derive(Clone)]
pub(super) struct RrdFile(Arc<Mutex<State>>);

struct State {
    encoder: Option<Encoder<File>>,
    file: File,
    error: Option<(io::ErrorKind, String)>,
}

impl RrdFile {
    /// Creates the file; an existing file is an error.
    pub(super) fn create(path: &Path) -> io::Result<Self> {
        let file = File::create_new(path)?;
        let encoder = Encoder::new_eager(
            CrateVersion::LOCAL,
            EncodingOptions::PROTOBUF_COMPRESSED,
            file.try_clone()?,
        )
        .map_err(io::Error::other)?;
        Ok(Self(Arc::new(Mutex::new(State {
            encoder: Some(encoder),
            file,
            error: None,
        }))))
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the first error so far.
    pub(super) fn check(&self) -> io::Result<()> {
        match &self.state().error {
            Some((kind, message)) => Err(io::Error::new(*kind, message.clone())),
            None => Ok(()),
        }
    }

    /// Writes the footer and synchronises the file. Must be called after the last message has been sent.
    pub(super) fn finish(&self) -> io::Result<()> {
        self.check()?;
        let mut state = self.state();
        if let Some(mut encoder) = state.encoder.take() {
            encoder
                .finish()
                .map_err(|error| io::Error::new(kind_of(&error), error.to_string()))?;
        }
        state.file.sync_all()
    }
}

impl LogSink for RrdFile {
    fn send(&self, message: LogMsg) {
        let mut state = self.state();
        let Some(encoder) = state.encoder.as_mut() else {
            return;
        };
        if let Err(error) = encoder.append(&message) {
            state.error = Some((kind_of(&error), error.to_string()));
            // Dropping the encoder would try to write a footer.
            if let Some(encoder) = state.encoder.take() {
                let _ = encoder.into_inner();
            }
        }
    }

    fn flush_blocking(&self, _: Duration) -> Result<(), SinkFlushError> {
        self.check().map_err(|error| SinkFlushError::failed(error.to_string()))
    }

    fn defers_finalization_to_shutdown(&self) -> bool {
        true
    }
}

/// Returns the kind of the I/O error that caused an error of the encoder.
fn kind_of(error: &(dyn std::error::Error + 'static)) -> io::ErrorKind {
    let mut cause = Some(error);
    while let Some(error) = cause {
        if let Some(error) = error.downcast_ref::<io::Error>() {
            return error.kind();
        }
        cause = error.source();
    }
    io::ErrorKind::Other
}
