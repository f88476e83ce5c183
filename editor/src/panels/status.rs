//! Messages: the last one is shown at the bottom of the window, all of them on a click.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

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
    /// The number of messages and the moment when the newest one was shown first.
    shown: Option<(u64, Instant)>,
    /// The moment of the newest frame.
    now: Option<Instant>,
}

/// Time for which an information is shown.
const INFO_SHOWN: Duration = Duration::from_secs(6);
/// Time for which a warning is shown.
const WARNING_SHOWN: Duration = Duration::from_secs(20);
/// Time for which a warning or an error is also shown at the pointer.
const TOAST_SHOWN: Duration = Duration::from_secs(5);

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

    /// Adds a remark about a change, unless the last message is more detailed. Returns whether it was added.
    pub(super) fn remark(&mut self, text: impl Into<String>) -> bool {
        let is_added = !std::mem::take(&mut self.weighs_more);
        if is_added {
            self.say(MessageSeverity::Info, text);
        }
        is_added
    }

    /// Replaces the newest message by an information; does nothing if it is the same.
    pub(super) fn replace_last(&mut self, text: String) {
        if self.last().is_none_or(|last| last.text != text) {
            self.lines.pop_back();
            self.say(MessageSeverity::Info, text);
        }
    }

    /// Notes the moment of a frame, from which the time is counted for which a message is shown.
    pub(super) fn begin_frame(&mut self, now: Instant) {
        self.now = Some(now);
        if self.shown.is_none_or(|(said, _)| said != self.said) {
            self.shown = Some((self.said, now));
        }
    }

    /// Returns the newest message while it is shown: an error until the next message, others for some seconds.
    pub fn current(&self) -> Option<&StatusMessage> {
        self.last().filter(|_| self.shown_for() != Some(Duration::ZERO))
    }

    /// Returns the time after which the newest message is no longer shown; zero when it is not shown any more, `None` if it
    /// stays.
    pub(super) fn shown_for(&self) -> Option<Duration> {
        let limit = match self.last()?.level {
            MessageSeverity::Info => INFO_SHOWN,
            MessageSeverity::Warning => WARNING_SHOWN,
            MessageSeverity::Error => return None,
        };
        let (said, since) = self.shown?;
        let age = self.now?.saturating_duration_since(since);
        (said == self.said).then(|| limit.saturating_sub(age))
    }

    /// Returns the newest message while it is shown at the pointer, as a warning or an error is for some seconds, with its number.
    pub(super) fn toast(&self) -> Option<(u64, &StatusMessage)> {
        self.toast_left().filter(|left| !left.is_zero())?;
        Some((self.said, self.last()?))
    }

    /// Returns the time after which the newest message is no longer shown at the pointer; `None` if it is none to be shown there.
    pub(super) fn toast_left(&self) -> Option<Duration> {
        match self.last()?.level {
            MessageSeverity::Info => return None,
            MessageSeverity::Warning | MessageSeverity::Error => {}
        }
        let (said, since) = self.shown?;
        let age = self.now?.saturating_duration_since(since);
        (said == self.said).then(|| TOAST_SHOWN.saturating_sub(age))
    }

    /// Returns the time after which the display of messages changes; `None` where it stays as it is.
    pub(super) fn next_change(&self) -> Option<Duration> {
        let times = [self.shown_for(), self.toast_left()];
        times.into_iter().flatten().filter(|left| !left.is_zero()).min()
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
