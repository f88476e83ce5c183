//! The document that the threads share: original + changes = result, in the types of `dragonfly-anim`.
//!
//! Every edit has a number, and writes it into all the data that it touches: into the scale of each key, where
//! `1 + n / 2²³` is exact and too little to be seen. So a reader of half an edit is found out ([`EditMark::is_torn`]), and one
//! of an old document as well ([`EditMark::number`]).

use dragonfly_anim::data::{Skeleton, Take, Track, Transform};
use glam::Vec3;
use std::sync::Arc;

/// So many numbers can be told apart in the data; they begin anew after that.
const STAMPS: u64 = 1 << 23;

/// One take, in its three forms, and which edit was its last.
#[derive(Clone, Debug, PartialEq)]
pub struct TakeEntry {
    /// As read; never altered, so whoever wants to may keep it outside of any lock.
    pub original: Arc<Take>,
    /// What was edited; the identity elsewhere.
    pub changes: Arc<Take>,
    /// What is shown.
    pub result: Arc<Take>,
    /// Number of the newest edit of this take; 0 before the first.
    pub number: u64,
    /// Where that edit was.
    pub place: KeyPlace,
    /// Number of the edit that replaced the whole take last.
    pub replaced: u64,
}

/// A key of a bone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct KeyPlace {
    /// Position in the skeleton.
    pub bone: u32,
    /// Position in the channels.
    pub key: u32,
}

/// All takes. A clone is shallow; what is shared is copied when it is edited, and only the channels that are.
#[derive(Clone, Debug, PartialEq)]
pub struct SharedDocument {
    /// The same for all takes; not edited here.
    pub skeleton: Arc<Skeleton>,
    /// At least one.
    pub takes: Vec<TakeEntry>,
}

/// What the person did.
#[derive(Clone, Debug)]
pub struct NumberedEdit {
    /// From 1, ascending.
    pub number: u64,
    /// Position in the document's takes.
    pub take: usize,
    /// What happens there.
    pub change: EditedData,
}

/// See [`NumberedEdit`].
#[derive(Clone, Debug)]
pub enum EditedData {
    /// Small: the change of one key.
    Key(KeyPlace, Transform),
    /// Large: all changes of the take.
    Take(Arc<Take>),
}

/// An edit with everything computed that needs nobody's lock. Cheap to clone.
#[derive(Clone, Debug)]
pub struct PreparedEdit {
    edit: NumberedEdit,
    result: Option<Arc<Take>>,
}

/// What is no longer needed: dropped by the caller, outside of its lock.
pub type Remains = Option<(Arc<Take>, Arc<Take>)>;

impl NumberedEdit {
    /// Computes what depends on the originals alone, which nobody alters.
    pub fn prepare(self, originals: &[Arc<Take>]) -> PreparedEdit {
        let result = match &self.change {
            EditedData::Key(..) => None,
            EditedData::Take(changes) => Some(Arc::new(compose_take(&originals[self.take], changes))),
        };
        PreparedEdit { edit: self, result }
    }
}

impl PreparedEdit {
    /// Number of the edit.
    pub fn number(&self) -> u64 {
        self.edit.number
    }
}

impl TakeEntry {
    /// `original`, and no changes: those of `nothing`, which has as many keys.
    pub fn new(original: Arc<Take>, nothing: Arc<Take>) -> Self {
        let result = Arc::clone(&original);
        Self { original, changes: nothing, result, number: 0, place: KeyPlace::default(), replaced: 0 }
    }

    /// Makes the edit. What nobody else has is changed where it lies, what others have too is copied before.
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

    /// What must be found in the result that belongs to this; `thorough` looks at all bones.
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

    /// A result that shares nothing with this one, except the times of the keys, which no edit here alters.
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
    /// Makes an edit of one of the takes.
    pub fn apply(&mut self, ready: PreparedEdit) -> Remains {
        self.takes[ready.edit.take].apply(ready)
    }

    /// The originals of all takes, which nobody alters.
    pub fn originals(&self) -> Vec<Arc<Take>> {
        self.takes.iter().map(|entry| Arc::clone(&entry.original)).collect()
    }

    /// Keys of the result, summed over channels.
    pub fn keys(&self) -> usize {
        self.takes.iter().map(|entry| entry.result.keys()).sum()
    }
}

/// What a reader saw of the changes, to be compared with what it saw of the result.
#[derive(Clone, Copy, Debug)]
pub struct EditMark {
    /// Of the newest edit that was seen.
    pub number: u64,
    place: KeyPlace,
    expected: Transform,
    replaced: Option<u64>,
    whole: bool,
}

impl EditMark {
    /// Is `result` not what the changes say, or do the changes not say what the head says?
    pub fn is_torn(&self, result: &Take) -> bool {
        let found = pose(result, self.place);
        let number = self.number % STAMPS;
        let right = found == self.expected && stamp(found.scale) == number;
        let first = |track: &Track, replaced| stamp(track.scale.values[0]) == replaced % STAMPS;
        let all = |replaced| result.tracks.iter().all(|track| first(track, replaced));
        !(right && self.whole && self.replaced.is_none_or(all))
    }
}

/// The scale that says `number`.
pub fn stamped(number: u64) -> Vec3 {
    Vec3::splat(1.0 + (number % STAMPS) as f32 / STAMPS as f32)
}

/// The number that a scale says; one that no number has where its parts do not agree.
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

/// An identity gives the original bit for bit.
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
    fn an_edit_copies_what_is_shared_and_nothing_else() {
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
            "nobody else had it"
        );
        assert_eq!(base.takes[0].number, 0);
    }

    #[test]
    fn half_an_edit_is_torn_and_a_whole_one_is_not() {
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
