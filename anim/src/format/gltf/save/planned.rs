//! A planned save, and an edited take in it.

use super::animation::Draft;
use super::buffer::BufferTail;
use super::changes::Changes;
use super::channels::ChannelEdit;
use super::json::patch::TextPatch;
use super::source::SourceFile;
use crate::format::OutputFile;

/// A planned save: made by [`plan`](fn@super::plan), described by [`Plan::changes`], carried out by [`Plan::write`].
#[derive(Clone)]
pub struct Plan<'a> {
    pub(super) source: &'a SourceFile,
    pub(super) patches: Vec<TextPatch>,
    /// The replaced end of the binary chunk.
    pub(super) chunk: Option<BufferTail>,
    pub(super) beside: Option<OutputFile>,
    pub(super) changes: Changes,
}

impl Plan<'_> {
    /// Returns the description of the changes.
    pub fn changes(&self) -> &Changes {
        &self.changes
    }

    /// Returns the files to write, in the order in which to write them: referenced files first, the main file last.
    /// Exactly the opened bytes if nothing changes.
    pub fn write(&self) -> Vec<OutputFile> {
        let chunk = self.chunk.as_ref().map(|tail| (tail.from, tail.bytes.as_slice()));
        let bytes = if self.patches.is_empty() && chunk.is_none() {
            self.source.bytes.to_vec()
        } else {
            self.source.container.write(&self.source.bytes, &self.patches, chunk)
        };
        let file = OutputFile { name: self.source.name.clone(), bytes };
        self.beside.iter().cloned().chain([file]).collect()
    }
}

/// An edited take.
pub(super) struct TakeDraft {
    /// The animation that it replaces or is a copy of.
    pub(super) base: Option<usize>,
    /// Whether it is a copy of that animation.
    pub(super) is_copy: bool,
    pub(super) name: String,
    pub(super) edits: Vec<ChannelEdit>,
    pub(super) draft: Draft,
}
