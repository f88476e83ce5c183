//! The document that the threads share: original + changes = result, in the types of `dragonfly-anim`.
//!
//! Every edit has a number, which it writes into all the data that it changes: into the scale of each key, where `1 + n
//! / 2²³` is exact and too small to be visible. So a reader of half an edit is detected ([`EditMark::is_torn`]), and so
//! is a reader of an old document ([`EditMark::number`]).

use dragonfly_anim::data::{Skeleton, Take, Track, Transform};
use glam::Vec3;
use std::sync::Arc;

/// Number of distinct edit numbers in the data; they repeat after that.
const STAMPS: u64 = 1 << 23;

/// One take in its three forms, and its last edit.
#[derive(Clone, Debug, PartialEq)]
pub struct TakeEntry {
    /// The take as it was read. Never changed, so it can be used outside of any lock.
    pub original: Arc<Take>,
    /// The edits; the identity where nothing was edited.
    pub changes: Arc<Take>,
    /// The take that is shown.
    pub result: Arc<Take>,
    /// Number of the newest edit of this take; 0 before the first.
    pub number: u64,
    /// Key of that edit.
    pub place: KeyPlace,
    /// Number of the last edit that replaced the whole take.
    pub replaced: u64,
}

/// A key of a bone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct KeyPlace {
    /// Index in the skeleton.
    pub bone: u32,
    /// Index of the key in the channels of the bone.
    pub key: u32,
}

/// All takes. A clone is shallow; an edit copies the shared channels that it changes, and no others.
#[derive(Clone, Debug, PartialEq)]
pub struct SharedDocument {
    /// Skeleton of all takes; never edited here.
    pub skeleton: Arc<Skeleton>,
    /// The takes, at least one.
    pub takes: Vec<TakeEntry>,
}

/// An edit of the user.
#[derive(Clone, Debug)]
pub struct NumberedEdit {
    /// Number of the edit: from 1, ascending.
    pub number: u64,
    /// Index of the take in the document.
    pub take: usize,
    /// The change of the take.
    pub change: EditedData,
}

/// The content of a [`NumberedEdit`].
#[derive(Clone, Debug)]
pub enum EditedData {
    /// A small edit: the change of one key.
    Key(KeyPlace, Transform),
    /// A large edit: all changes of the take.
    Take(Arc<Take>),
}

/// An edit with everything computed that can be computed without a lock. Cheap to clone.
#[derive(Clone, Debug)]
pub struct PreparedEdit {
    edit: NumberedEdit,
    result: Option<Arc<Take>>,
}

/// Replaced data. The caller drops it after releasing its lock, because that takes long.
pub type Remains = Option<(Arc<Take>, Arc<Take>)>;

impl NumberedEdit {
    /// Computes everything that depends on the originals alone, which are never changed.
    pub fn prepare(self, originals: &[Arc<Take>]) -> PreparedEdit {
        let result = match &self.change {
            EditedData::Key(..) => None,
            EditedData::Take(changes) => Some(Arc::new(compose_take(&originals[self.take], changes))),
        };
        PreparedEdit { edit: self, result }
    }
}

impl PreparedEdit {
    /// Returns the number of the edit.
    pub fn number(&self) -> u64 {
        self.edit.number
    }
}

impl TakeEntry {
    /// Returns an entry with `original` and without changes: `nothing` has identities for all keys.
    pub fn new(original: Arc<Take>, nothing: Arc<Take>) -> Self {
        let result = Arc::clone(&original);
        Self { original, changes: nothing, result, number: 0, place: KeyPlace::default(), replaced: 0 }
    }

    /// Applies the edit. Data that is not shared is changed in place; shared data is copied first.
    pub fn apply(&mut self, ready: PreparedEdit) -> Remains {
        let PreparedEdit { edit, result } = ready;
        let remains = match (edit.change, result) {
            (EditedData::Key(place, change), _) => {
                self.place = place;
                set(&mut self.changes, place, change);
                let pose = compose(pose(&self.original, place), change);
                set(&mut self.result, place, pose);
                None
            }
            (EditedData::Take(changes), Some(result)) => {
                (self.place, self.replaced) = (KeyPlace::default(), edit.number);
                let changes = std::mem::replace(&mut self.changes, changes);
                Some((changes, std::mem::replace(&mut self.result, result)))
            }
            (EditedData::Take(_), None) => unreachable!("it was prepared"),
        };
        self.number = edit.number;
        remains
    }

    /// Returns the mark that the result must contain; `thorough` checks all bones.
    pub fn mark(&self, thorough: bool) -> EditMark {
        let change = pose(&self.changes, self.place);
        let first = |track: &Track| stamp(track.scale.values[0]);
        let stamps = || self.changes.tracks.iter().map(first);
        EditMark {
            number: self.number,
            place: self.place,
            expected: compose(pose(&self.original, self.place), change),
            replaced: thorough.then_some(self.replaced),
            whole: !thorough || stamps().all(|stamp| stamp == self.replaced % STAMPS),
        }
    }

    /// Returns a copy of the result that shares nothing with it except the times of the keys, which are never edited
    /// here.
    pub fn copy_result(&self) -> Take {
        let mut take = (*self.result).clone();
        for track in &mut take.tracks {
            track.translation.values = Arc::from(&*track.translation.values);
            track.rotation.values = Arc::from(&*track.rotation.values);
            track.scale.values = Arc::from(&*track.scale.values);
        }
        take
    }
}

impl SharedDocument {
    /// Applies an edit to its take.
    pub fn apply(&mut self, ready: PreparedEdit) -> Remains {
        self.takes[ready.edit.take].apply(ready)
    }

    /// Returns the originals of all takes, which are never changed.
    pub fn originals(&self) -> Vec<Arc<Take>> {
        self.takes.iter().map(|entry| Arc::clone(&entry.original)).collect()
    }

    /// Returns the number of keys in the result, summed over channels.
    pub fn keys(&self) -> usize {
        self.takes.iter().map(|entry| entry.result.keys()).sum()
    }
}

/// The edits that a reader found in the changes, for a comparison with the result.
#[derive(Clone, Copy, Debug)]
pub struct EditMark {
    /// Number of the newest edit that was found.
    pub number: u64,
    place: KeyPlace,
    expected: Transform,
    replaced: Option<u64>,
    whole: bool,
}

impl EditMark {
    /// Returns whether `result` does not match the changes, or the changes do not match the head of the entry.
    pub fn is_torn(&self, result: &Take) -> bool {
        let found = pose(result, self.place);
        let number = self.number % STAMPS;
        let right = found == self.expected && stamp(found.scale) == number;
        let first = |track: &Track, replaced| stamp(track.scale.values[0]) == replaced % STAMPS;
        let all = |replaced| result.tracks.iter().all(|track| first(track, replaced));
        !(right && self.whole && self.replaced.is_none_or(all))
    }
}

/// Returns the scale that encodes `number`.
pub fn stamped(number: u64) -> Vec3 {
    Vec3::splat(1.0 + (number % STAMPS) as f32 / STAMPS as f32)
}

/// Returns the number that a scale encodes; an invalid one if its components differ.
fn stamp(scale: Vec3) -> u64 {
    if scale == Vec3::splat(scale.x) { ((scale.x - 1.0) * STAMPS as f32) as u64 } else { u64::MAX }
}

fn pose(take: &Take, place: KeyPlace) -> Transform {
    let (track, key) = (&take.tracks[place.bone as usize], place.key as usize);
    Transform {
        translation: track.translation.values[key],
        rotation: track.rotation.values[key],
        scale: track.scale.values[key],
    }
}

fn set(take: &mut Arc<Take>, place: KeyPlace, pose: Transform) {
    let (track, key) = (&mut Arc::make_mut(take).tracks[place.bone as usize], place.key as usize);
    Arc::make_mut(&mut track.translation.values)[key] = pose.translation;
    Arc::make_mut(&mut track.rotation.values)[key] = pose.rotation;
    Arc::make_mut(&mut track.scale.values)[key] = pose.scale;
}

/// Applies a change to a key. An identity returns the original bit for bit.
fn compose(original: Transform, change: Transform) -> Transform {
    let rotation = match change.rotation == glam::Quat::IDENTITY {
        true => original.rotation,
        false => (change.rotation * original.rotation).normalize(),
    };
    Transform {
        translation: original.translation + change.translation,
        rotation,
        scale: original.scale * change.scale,
    }
}

fn compose_take(original: &Take, changes: &Take) -> Take {
    let mut result = original.clone();
    let tracks = original.tracks.iter().zip(&changes.tracks).zip(&mut result.tracks).enumerate();
    for (bone, ((old, _), new)) in tracks {
        let place = |key| KeyPlace { bone: bone as u32, key: key as u32 };
        let poses: Vec<Transform> = (0..old.scale.len())
            .map(|key| compose(pose(original, place(key)), pose(changes, place(key))))
            .collect();
        new.translation.values = poses.iter().map(|pose| pose.translation).collect();
        new.rotation.values = poses.iter().map(|pose| pose.rotation).collect();
        new.scale.values = poses.iter().map(|pose| pose.scale).collect();
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graphical::model::ModelSize;

    fn key(number: u64) -> NumberedEdit {
        let pose = Transform { scale: stamped(number), translation: Vec3::X, ..Transform::IDENTITY };
        NumberedEdit { number, take: 0, change: EditedData::Key(KeyPlace { bone: 1, key: 2 }, pose) }
    }

    #[test]
    fn an_edit_copies_shared_channels_and_no_others() {
        let base = ModelSize::TINY.document();
        let mut edited = base.clone();
        let originals = base.originals();
        drop(edited.apply(key(1).prepare(&originals)));
        let (old, new) = (&base.takes[0].result.tracks, &edited.takes[0].result.tracks);
        assert!(Arc::ptr_eq(&old[0].rotation.values, &new[0].rotation.values));
        assert!(!Arc::ptr_eq(&old[1].rotation.values, &new[1].rotation.values));
        let place = Arc::as_ptr(&new[1].rotation.values);
        drop(edited.apply(key(2).prepare(&originals)));
        assert_eq!(
            Arc::as_ptr(&edited.takes[0].result.tracks[1].rotation.values),
            place,
            "the values are not shared, so they are changed in place"
        );
        assert_eq!(base.takes[0].number, 0);
    }

    #[test]
    fn half_of_an_edit_is_detected_and_a_whole_edit_is_accepted() {
        let mut document = ModelSize::TINY.document();
        let originals = document.originals();
        drop(document.apply(key(7).prepare(&originals)));
        for number in [8, 9, STAMPS - 1, STAMPS + 5] {
            let before = document.clone();
            drop(document.apply(key(number).prepare(&originals)));
            let (old, new) = (&before.takes[0], &document.takes[0]);
            assert!(!new.mark(true).is_torn(&new.result), "{number}");
            assert!(new.mark(true).is_torn(&old.result), "{number}");
            assert!(old.mark(false).is_torn(&new.result), "{number}");
        }
    }
}
