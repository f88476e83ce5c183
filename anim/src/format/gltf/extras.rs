//! The data that this program keeps in the `extras` of an animation.

use crate::data::TakeExtras;
use crate::format::{ImportContext, ImportError, Place};
use serde_json::value::RawValue;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The member of `extras` whose members are the data of a take, see [`TakeExtras`].
pub(super) const EXTRAS_MEMBER: &str = "dragonfly";

/// Reads the data from the text of `extras`. What other programs keep there is left out.
pub(super) fn read(
    context: &ImportContext<'_>,
    place: &Place,
    extras: &str,
) -> Result<TakeExtras, ImportError> {
    let mut found = TakeExtras::default();
    let Some(texts) = texts(extras) else { return Ok(found) };
    for (name, text) in texts {
        context.charge(place, (name.len() + text.get().len()) as u64)?;
        found.set(&name, Some(Arc::from(text.get())));
    }
    Ok(found)
}

/// Returns the members of the data of this program; `None` where there are none or they are no object.
fn texts(extras: &str) -> Option<BTreeMap<String, &RawValue>> {
    let members: BTreeMap<String, &RawValue> = serde_json::from_str(extras).ok()?;
    serde_json::from_str(members.get(EXTRAS_MEMBER)?.get()).ok()
}
