//! Limits of an edited document: what an edit makes can be saved, and the saved file can be opened again.

use super::key_bytes::KEY_BYTES;
use super::slot::{TakeId, TakeVersions};
use super::{EditError, ModelAdapter};
use crate::edit::SAME_TIME;
use dragonfly_anim::limits::{CLIP_SECONDS, KEYS_PER_CHANNEL};

impl ModelAdapter {
    /// Returns the size of the keys of all takes in bytes.
    pub(crate) fn key_bytes(&self) -> u64 {
        let layers = self.slots.iter().flat_map(|slot| slot.layers()).map(|layer| layer.keys.key_bytes);
        self.slots.iter().map(|slot| slot.key_bytes).chain(layers).sum()
    }

    /// Checks that an edit, which changed the keys of the takes `touched`, can be saved. A document that was over a limit when it was
    /// opened may be edited as long as that does not take it further.
    pub(crate) fn within_limits(&self, before: &Self, touched: &[TakeId]) -> Result<(), EditError> {
        let bytes = self.key_bytes();
        if bytes > KEY_BYTES && bytes > before.key_bytes() {
            return Err(EditError::TooLarge { bytes });
        }
        for slot in touched.iter().filter_map(|take| self.slot(*take)) {
            times_within(slot, before.slot(slot.id).map(|old| &**old))?;
            let longest = slot.shown().tracks.iter().flat_map(|track| {
                [track.translation.times.len(), track.rotation.times.len(), track.scale.times.len()]
            });
            if let Some(keys) = longest.max().filter(|&keys| keys > KEYS_PER_CHANNEL) {
                return Err(EditError::TooManyKeys { keys });
            }
        }
        Ok(())
    }
}

/// Checks the times of the first and the last key. A take that was read with keys before 0 s may keep them.
fn times_within(slot: &TakeVersions, old: Option<&TakeVersions>) -> Result<(), EditError> {
    let Some((start, end)) = slot.original.range_of_keys() else { return Ok(()) };
    if end > CLIP_SECONDS {
        return Err(EditError::TooLate(end));
    }
    let earliest = match old.map_or(0.0, |old| old.original.start) {
        // Rounding may lead a little below the earliest time.
        below if below < 0.0 => (below - SAME_TIME).max(-CLIP_SECONDS),
        _ => 0.0,
    };
    if start < earliest { Err(EditError::BeforeZero(start)) } else { Ok(()) }
}
