//! Messages: the last one is shown at the bottom of the window, all of them on a click.

use std::collections::VecDeque;

/// Severity of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MessageSeverity {
    /// Information.
    Info,
    /// Something unexpected.
    Warning,
    /// Something failed.
    Error,
}

/// A message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StatusMessage {
    /// Severity.
    pub level: MessageSeverity,
    /// The text, one sentence.
    pub text: String,
    /// Number of times that it was added in a row.
    pub times: u32,
}

/// The newest messages, oldest first.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Status {
    lines: VecDeque<StatusMessage>,
    /// Number of messages added so far.
    said: u64,
    /// Whether the last message is more important than a remark that follows it.
    weighs_more: bool,
}

/// Maximum number of messages that are kept.
const KEPT: usize = 200;

impl Status {
    /// Adds a message; a repeated one only increases its count.
    pub fn say(&mut self, level: MessageSeverity, text: impl Into<String>) {
        let text = text.into();
        self.said += 1;
        match level {
            MessageSeverity::Info => tracing::info!(target: "dragonfly::status", "{text}"),
            MessageSeverity::Warning => {
                tracing::info!(target: "dragonfly::status", level = "warning", "{text}")
            }
            MessageSeverity::Error => tracing::warn!(target: "dragonfly::status", "{text}"),
        }
        if let Some(last) = self.lines.back_mut()
            && last.text == text
            && last.level == level
        {
            last.times += 1;
            return;
        }
        if self.lines.len() == KEPT {
            self.lines.pop_front();
        }
        self.lines.push_back(StatusMessage { level, text, times: 1 });
    }

    /// Returns the number of messages added so far.
    pub(super) fn said(&self) -> u64 {
        self.said
    }

    /// Notes whether the last message is about the present change and more detailed than a remark about it would be.
    pub(super) fn keep_last(&mut self, keep: bool) {
        self.weighs_more = keep;
    }

    /// Adds a remark about a change, unless the last message is more detailed.
    pub(super) fn remark(&mut self, text: impl Into<String>) {
        if !std::mem::take(&mut self.weighs_more) {
            self.say(MessageSeverity::Info, text);
        }
    }

    /// Returns the newest message.
    pub fn last(&self) -> Option<&StatusMessage> {
        self.lines.back()
    }

    /// Returns all messages, oldest first.
    pub fn lines(&self) -> impl DoubleEndedIterator<Item = &StatusMessage> {
        self.lines.iter()
    }
}
