//! What a journal's records come to: how much work is in it, how much of that is not in the file, who has it.

use super::owner::Owner;
use super::record::{Header, Opened, Saving, Tag};
use super::stamp::FileStamp;

/// The sum of a journal's records so far.
#[derive(Clone, Debug, Default)]
pub(super) struct State {
    /// Edits, and the snapshot as one.
    pub(super) work: u64,
    /// Of them, the last ones, which are not in the document's file.
    pub(super) unsaved: u64,
    /// What the file was when it last held what the journal says.
    pub(super) stamp: Option<FileStamp>,
    /// A save that was begun and of whose end nothing is said, and the work done before it.
    pub(super) saving: Option<(Saving, u64)>,
    /// Who took the journal last.
    pub(super) owner: Option<Owner>,
    /// That one let go of it.
    pub(super) closed: bool,
}

impl State {
    /// Of a journal without records.
    pub(super) fn new(header: &Header) -> Self {
        Self { stamp: header.stamp, ..Self::default() }
    }

    /// Adds a record; `false`, and nothing is changed, when its bytes are not understood.
    pub(super) fn add(&mut self, tag: Tag, bytes: &[u8]) -> bool {
        match tag {
            Tag::Snapshot | Tag::Edit => {
                self.work += 1;
                self.unsaved += 1;
            }
            Tag::Opened => match serde_json::from_slice::<Opened>(bytes) {
                Ok(owner) => {
                    self.owner = Some(owner);
                    self.closed = false;
                }
                Err(_) => return false,
            },
            Tag::Saving => match serde_json::from_slice::<Saving>(bytes) {
                Ok(saving) => self.saving = Some((saving, self.work)),
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

    /// The document was saved. What was done while it was being saved is not in the file; a save that was begun and made
    /// something else of it failed, and says nothing about this one.
    fn saved(&mut self, stamp: FileStamp) {
        let begun = self.saving.take().filter(|(saving, _)| saving.made(&stamp));
        let before = begun.map_or(self.work, |(_, work)| work);
        self.unsaved = self.work - before;
        self.stamp = Some(stamp);
    }

    /// The file is what a save, of whose end nothing is said, was to make of it: so it was saved.
    pub(super) fn settle(&mut self, stamp: FileStamp) -> bool {
        let settled = self.saving.is_some_and(|(saving, _)| saving.made(&stamp));
        if settled {
            self.saved(stamp);
        }
        settled
    }
}
