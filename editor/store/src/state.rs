//! The state that a journal's records add up to: how much work it contains, how much of it is unsaved, and its owner.

use super::owner::JournalOwner;
use super::record::{JournalHeader, Saving, Tag};
use super::stamp::FileStamp;

/// Sum of a journal's records so far.
#[derive(Clone, Debug, Default)]
pub(super) struct JournalState {
    /// Number of edits; a snapshot counts as one.
    pub(super) work: u64,
    /// Number of edits at the end that are not in the document's file.
    pub(super) unsaved: u64,
    /// Stamp of the file when it last had the journal's state.
    pub(super) stamp: Option<FileStamp>,
    /// A save that was started without a record of its end, and the number of edits in it.
    pub(super) saving: Option<(Saving, u64)>,
    /// The process that opened the journal last.
    pub(super) owner: Option<JournalOwner>,
    /// Whether that process closed it.
    pub(super) closed: bool,
}

impl JournalState {
    /// State of a journal without records.
    pub(super) fn new(header: &JournalHeader) -> Self {
        Self { stamp: header.stamp, ..Self::default() }
    }

    /// Adds a record. Returns `false`, and changes nothing, when its bytes cannot be parsed.
    pub(super) fn add(&mut self, tag: Tag, bytes: &[u8]) -> bool {
        match tag {
            Tag::Snapshot | Tag::Edit => {
                self.work += 1;
                self.unsaved += 1;
            }
            Tag::Opened => match serde_json::from_slice::<JournalOwner>(bytes) {
                Ok(owner) => {
                    self.owner = Some(owner);
                    self.closed = false;
                }
                Err(_) => return false,
            },
            Tag::Saving => match serde_json::from_slice::<Saving>(bytes) {
                Ok(saving) => self.saving = Some((saving, self.work.saturating_sub(saving.newer))),
                Err(_) => return false,
            },
            Tag::Saved => match serde_json::from_slice::<FileStamp>(bytes) {
                Ok(stamp) => self.saved(stamp),
                Err(_) => return false,
            },
            Tag::Closed => self.closed = true,
        }
        true
    }

    /// Records that the document was saved. Edits made during the save are not in the file. If the save that was
    /// started last was to write another file than this one, it failed and does not count.
    fn saved(&mut self, stamp: FileStamp) {
        let begun = self.saving.take().filter(|(saving, _)| saving.file.is_none() || saving.made(&stamp));
        let before = begun.map_or(self.work, |(_, work)| work);
        self.unsaved = self.work - before;
        self.stamp = Some(stamp);
    }

    /// Counts a save without a recorded end as done if the file has the content that it was to write. Returns whether
    /// it does.
    pub(super) fn settle(&mut self, stamp: FileStamp) -> bool {
        let settled = self.saving.is_some_and(|(saving, _)| saving.made(&stamp));
        if settled {
            self.saved(stamp);
        }
        settled
    }
}
