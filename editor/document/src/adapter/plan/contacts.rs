//! The contacts that are stored with a take, changed together with its keys.

use super::super::contact_record::{CONTACTS, MOST_CONTACTS, contacts_text, stored_contacts};
use super::super::op::Op;
use super::super::slot::TakeId;
use super::{EditError, Transaction};
use dragonfly_anim::contact::ContactTrack;

/// Returns the contacts that are stored with a take.
pub(crate) fn stored(work: &Transaction, take: TakeId) -> ContactTrack {
    stored_contacts(&work.slot(take).original.extras, work.skeleton())
}

/// Stores contacts with a take. Returns whether they are others than before.
pub(crate) fn store(work: &mut Transaction, take: TakeId, track: &ContactTrack) -> Result<bool, EditError> {
    if track.contacts().len() > MOST_CONTACTS {
        return Err(EditError::Nothing("a take has at most 10,000 contacts"));
    }
    let text = contacts_text(track, work.skeleton());
    if work.slot(take).original.extras.get(CONTACTS) == text.as_ref() {
        return Ok(false);
    }
    work.perform(Op::Extras(take, CONTACTS.to_owned(), text));
    Ok(true)
}

/// Replaces the contacts of a take that has some by those that `change` returns.
pub(crate) fn follow(
    work: &mut Transaction,
    take: TakeId,
    change: impl FnOnce(&ContactTrack) -> ContactTrack,
) -> Result<(), EditError> {
    let before = stored(work, take);
    if before.is_empty() {
        return Ok(());
    }
    let after = change(&before);
    if after != before {
        store(work, take, &after)?;
    }
    Ok(())
}
