//! Quiet lines: the last one is shown at the bottom of the window, all of them on a click.

use std::collections::VecDeque;

/// How much a line matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// Good to know.
    Info,
    /// Not quite right.
    Warning,
    /// Failed.
    Error,
}

/// One line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    /// How much it matters.
    pub level: Level,
    /// One sentence.
    pub text: String,
    /// How often it was said in a row.
    pub times: u32,
}

/// The newest lines, oldest first.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Status {
    lines: VecDeque<Line>,
    /// Lines said so far.
    said: u64,
    /// The last line says more than the next remark would.
    weighs_more: bool,
}

/// How many lines are kept.
const KEPT: usize = 200;

impl Status {
    /// Says `text`; the same again only counts.
    pub fn say(&mut self, level: Level, text: impl Into<String>) {
        let text = text.into();
        self.said += 1;
        match level {
            Level::Info => tracing::info!(target: "dragonfly::status", "{text}"),
            Level::Warning => tracing::info!(target: "dragonfly::status", level = "warning", "{text}"),
            Level::Error => tracing::warn!(target: "dragonfly::status", "{text}"),
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
        self.lines.push_back(Line { level, text, times: 1 });
    }

    /// How many lines were said so far.
    pub(super) fn said(&self) -> u64 {
        self.said
    }

    /// The line that was said last is of what is done now and says more than a remark about it would.
    pub(super) fn keep_last(&mut self, keep: bool) {
        self.weighs_more = keep;
    }

    /// Says what was done, unless the line that is there says more of it.
    pub(super) fn remark(&mut self, text: impl Into<String>) {
        if !std::mem::take(&mut self.weighs_more) {
            self.say(Level::Info, text);
        }
    }

    /// The newest line.
    pub fn last(&self) -> Option<&Line> {
        self.lines.back()
    }

    /// All lines, oldest first.
    pub fn lines(&self) -> impl DoubleEndedIterator<Item = &Line> {
        self.lines.iter()
    }
}
