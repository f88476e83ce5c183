//! Finds what earlier saves appended, so that its room can be reused.
//!
//! Each appended accessor has a buffer view of its own, and both are named [`MARK`](super::MARK). The name alone is not sufficient:
//! a pair counts as appended by us only if it has exactly the form that we write, and if nothing but animation samplers
//! refers to it, so that overwriting it changes nothing else. The length of the view is the available room; the
//! accessor may need less.

use super::document::SourceDocument;
use super::json::tree::{JsonKind, ValueId};
use super::mark::is_ours;
use std::collections::{BTreeMap, HashMap, HashSet};

/// An accessor and its view that an earlier save appended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SavedSlot {
    pub(super) accessor: usize,
    pub(super) view: usize,
    /// Offset in the buffer in bytes, a multiple of four.
    pub(super) offset: usize,
    /// Number of available bytes, a multiple of four.
    pub(super) room: usize,
}

/// Returns all slots in a buffer of `length` existing bytes, by accessor.
pub(super) fn slots(document: &SourceDocument<'_>, buffer: usize, length: usize) -> Vec<SavedSlot> {
    let marked: Vec<usize> = (0..document.accessors.len())
        .filter(|&accessor| is_ours(document.json, document.accessors[accessor]))
        .collect();
    if marked.is_empty() {
        return Vec::new();
    }
    let references = references(document);
    let alone = undisturbed(document, buffer, &references);
    let slot = |accessor: usize| {
        let (json, id) = (document.json, document.accessors[accessor]);
        let view = json.index_member(id, "bufferView")?;
        let view_id = *document.views.get(view)?;
        let (in_buffer, offset, room) = document.view_range(view)?;
        let plain = json.whole_member(id, "byteOffset").unwrap_or(0) == 0
            && json.whole_member(id, "componentType") == Some(5126)
            && ["sparse", "normalized", "extensions"].iter().all(|name| json.member(id, name).is_none())
            && ["byteStride", "target", "extensions"].iter().all(|name| json.member(view_id, name).is_none());
        let (offset, room) = (usize::try_from(offset).ok()?, usize::try_from(room).ok()?);
        let fits = in_buffer == buffer
            && offset % 4 == 0
            && room % 4 == 0
            && room > 0
            && offset.checked_add(room)? <= length;
        let ours = plain
            && fits
            && is_ours(json, view_id)
            && !references.accessors.contains(&accessor)
            && references.views.get(&view) == Some(&1)
            && alone.contains(&view);
        ours.then_some(SavedSlot { accessor, view, offset, room })
    };
    marked.into_iter().filter_map(slot).collect()
}

/// References from everything except animation samplers.
struct References {
    /// Accessors that something other than an animation sampler refers to.
    accessors: HashSet<usize>,
    /// Number of references to each view.
    views: HashMap<usize, usize>,
    /// Ranges of buffers that extensions refer to directly: buffer, start, end.
    ranges: Vec<(usize, u64, u64)>,
}

/// Members that contain the number of an accessor in meshes, skins and known extensions.
const ACCESSORS: &[&str] = &["indices", "inverseBindMatrices", "accessor", "input", "output"];

/// Collects the references in the whole text. The meaning of unknown extensions is guessed from the names of their
/// members; a reference too many is harmless, a missing one is not.
fn references(document: &SourceDocument<'_>) -> References {
    let json = document.json;
    let samplers: HashSet<ValueId> =
        document.animations.iter().flat_map(|a| a.samplers.iter().copied()).collect();
    let mut found = References { accessors: HashSet::new(), views: HashMap::new(), ranges: Vec::new() };
    let mut around: Vec<Around> = Vec::new();
    for id in 0..json.len() {
        while around.last().is_some_and(|outer| outer.end <= id) {
            around.pop();
        }
        let outer = around.last();
        let holds_accessors = outer.is_some_and(|outer| outer.holds_accessors);
        let in_sampler = outer.is_some_and(|outer| outer.is_sampler);
        let key = json.key(id);
        let key = key.as_deref().unwrap_or_default();
        match json.kind(id) {
            JsonKind::Object | JsonKind::Array => {
                found.ranges.extend(range_of(document, id));
                // `/accessors` itself is not a list of numbers.
                let is_list = around.len() > 1 && ["attributes", "targets", "accessors"].contains(&key);
                around.push(Around {
                    end: json.end(id),
                    holds_accessors: holds_accessors || is_list,
                    is_sampler: samplers.contains(&id),
                });
            }
            JsonKind::Number => {
                let number = json.whole(id).and_then(|number| usize::try_from(number).ok());
                match number {
                    Some(view) if key == "bufferView" => *found.views.entry(view).or_default() += 1,
                    Some(accessor) if holds_accessors || (ACCESSORS.contains(&key) && !in_sampler) => {
                        found.accessors.insert(accessor);
                    }
                    _ => {}
                }
            }
            _ => {}
        }
    }
    found
}

/// An array or object around a value.
struct Around {
    end: ValueId,
    /// Whether the numbers in it are accessors.
    holds_accessors: bool,
    /// Whether it is a sampler of an animation.
    is_sampler: bool,
}

/// Returns the range of a buffer that an object refers to, unless the object is a buffer view.
fn range_of(document: &SourceDocument<'_>, id: ValueId) -> Option<(usize, u64, u64)> {
    let json = document.json;
    let (buffer, length) = (json.index_member(id, "buffer")?, json.whole_member(id, "byteLength")?);
    let from = json.whole_member(id, "byteOffset").unwrap_or(0);
    document.views.binary_search(&id).is_err().then_some((buffer, from, from.saturating_add(length)))
}

/// Returns the views of a buffer that share no byte with another view or range.
fn undisturbed(document: &SourceDocument<'_>, buffer: usize, references: &References) -> HashSet<usize> {
    let views = (0..document.views.len()).filter_map(|view| {
        let (of, from, length) = document.view_range(view)?;
        (of == buffer).then_some((from, from.saturating_add(length), Some(view)))
    });
    let ranges = references.ranges.iter().filter(|range| range.0 == buffer).map(|r| (r.1, r.2, None));
    let mut pieces: Vec<(u64, u64, Option<usize>)> = views.chain(ranges).collect();
    pieces.sort_unstable();
    let mut alone = HashSet::new();
    let mut end = 0;
    for (number, &(from, to, view)) in pieces.iter().enumerate() {
        let next = pieces.get(number + 1).map_or(u64::MAX, |next| next.0);
        if from >= end && to <= next {
            alone.extend(view);
        }
        end = end.max(to);
    }
    alone
}

/// Returns whether anything but the slots uses bytes of a buffer from `start` on.
pub(super) fn others_past(
    document: &SourceDocument<'_>,
    buffer: usize,
    start: usize,
    slots: &[SavedSlot],
) -> bool {
    let own: HashSet<usize> = slots.iter().map(|slot| slot.view).collect();
    let past = |range: (usize, u64, u64)| range.0 == buffer && range.2 > start as u64;
    let views = (0..document.views.len()).filter(|view| !own.contains(view));
    let mut views = views.filter_map(|view| {
        let (buffer, from, length) = document.view_range(view)?;
        Some((buffer, from, from.saturating_add(length)))
    });
    views.any(past) || references(document).ranges.into_iter().any(past)
}

/// Room that a channel needs in the buffer.
#[derive(Clone, Copy, Debug)]
pub(super) struct RoomRequest {
    /// Number of bytes, a multiple of four.
    pub(super) size: usize,
    /// The accessor of the replaced keys.
    pub(super) before: Option<usize>,
}

/// Room granted to a channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Granted {
    /// The slot whose accessor and view are reused; `None` for new ones.
    pub(super) slot: Option<SavedSlot>,
    pub(super) offset: usize,
    pub(super) room: usize,
}

/// Finds room for every request: its previous slot if it fits; otherwise the smallest free slot that is large enough;
/// otherwise the last slot of the buffer, extended; otherwise new room at `end`, which moves along.
pub(super) fn grant(requests: &[RoomRequest], free: Vec<SavedSlot>, end: &mut usize) -> Vec<Granted> {
    let mut granted: Vec<Option<Granted>> = vec![None; requests.len()];
    let same = |slot: SavedSlot| Granted { slot: Some(slot), offset: slot.offset, room: slot.room };
    let mut last = free.iter().find(|slot| slot.offset + slot.room == *end).copied();
    let mut by_accessor: HashMap<usize, SavedSlot> =
        free.into_iter().map(|slot| (slot.accessor, slot)).collect();
    for (request, granted) in requests.iter().zip(&mut granted) {
        let Some(before) = request.before else { continue };
        if by_accessor.get(&before).is_some_and(|own| own.room >= request.size) {
            *granted = by_accessor.remove(&before).map(same);
        }
    }
    let mut by_room: BTreeMap<(usize, usize), SavedSlot> =
        by_accessor.into_values().map(|slot| ((slot.room, slot.offset), slot)).collect();
    for (request, granted) in requests.iter().zip(&mut granted).filter(|(_, granted)| granted.is_none()) {
        let fits = by_room.range((request.size, 0)..).next().map(|(key, _)| *key);
        let slot = fits.and_then(|fits| by_room.remove(&fits));
        *granted = Some(match slot {
            Some(slot) => same(slot),
            None => match last.take().and_then(|last| by_room.remove(&(last.room, last.offset))) {
                Some(slot) => {
                    *end = slot.offset + request.size;
                    Granted { slot: Some(slot), offset: slot.offset, room: request.size }
                }
                None => {
                    let offset = *end;
                    *end += request.size;
                    Granted { slot: None, offset, room: request.size }
                }
            },
        });
    }
    granted.into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slot(accessor: usize, offset: usize, room: usize) -> SavedSlot {
        SavedSlot { accessor, view: accessor, offset, room }
    }

    #[test]
    fn free_room_is_reused_before_the_buffer_grows() {
        let free = vec![slot(1, 100, 40), slot(2, 140, 12), slot(3, 152, 20)];
        let requests = [
            RoomRequest { size: 12, before: None },
            RoomRequest { size: 12, before: Some(1) },
            RoomRequest { size: 24, before: Some(2) },
            RoomRequest { size: 8, before: None },
        ];
        let mut end = 172;
        let granted = grant(&requests, free, &mut end);
        let slots: Vec<_> = granted.iter().map(|granted| granted.slot.map(|slot| slot.accessor)).collect();
        assert_eq!(slots, [Some(2), Some(1), Some(3), None]);
        assert_eq!((granted[2].offset, granted[2].room, end), (152, 24, 184));
    }
}
