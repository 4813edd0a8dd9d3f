//! Messages to the user.

use std::time::{Duration, Instant};

use super::Session;

/// A message to the user; an error is shown until it is dismissed.
#[derive(Debug, Clone, PartialEq)]
pub struct Notice {
    /// Text of the message.
    pub text: String,
    /// Whether the message reports an error.
    pub is_error: bool,
    /// Time at which the message was reported.
    pub since: Instant,
}

/// Time for which a message is shown that is not an error.
const GLANCE: Duration = Duration::from_secs(8);

impl Session {
    /// Returns the messages to the user, the oldest first.
    pub fn notices(&self) -> &[Notice] {
        &self.notices
    }

    /// Removes a message.
    pub fn dismiss(&mut self, index: usize) {
        self.notices.remove(index);
    }

    /// Removes all messages.
    pub fn dismiss_all(&mut self) {
        self.notices.clear();
    }

    /// Removes the messages that report no error.
    pub fn dismiss_news(&mut self) {
        self.notices.retain(|notice| notice.is_error);
    }

    /// Shows a message to the user.
    pub fn notify(&mut self, text: String) {
        self.put_notice(text, false);
    }

    /// Shows an error message to the user.
    pub fn notify_error(&mut self, error: impl std::fmt::Display) {
        self.put_notice(error.to_string(), true);
    }

    /// Removes the messages that report no error and have been shown long enough.
    pub(super) fn dismiss_seen(&mut self) {
        self.notices
            .retain(|notice| notice.is_error || notice.since.elapsed() < GLANCE);
    }

    fn put_notice(&mut self, text: String, is_error: bool) {
        // A message replaces an earlier one with the same text.
        self.notices.retain(|notice| notice.text != text);
        self.notices.push(Notice {
            text,
            is_error,
            since: Instant::now(),
        });
    }
}
