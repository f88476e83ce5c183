//! Applies the edits of a journal again.

use super::adapter::{ModelAdapter, TakeId, TextFile, TextFiles};
use super::alike::alike;
use super::base;
use super::base_skeleton::BaseSkeleton;
use super::edit::VERSION;
use super::history::Edited;
use super::recorded::{EditsOrigin, Recorded, Snapshot, built_in_hash};
use super::shapes::ModelShapes;
use dragonfly_anim::data::{AnimationData, ModelData, Take};
use dragonfly_store::JournalEntry;
use std::collections::HashMap;
use std::sync::Arc;

/// A document with its history, restored from a journal.
#[derive(Debug)]
pub(super) struct Replayed {
    /// The takes with their history.
    pub(super) edited: Edited,
    /// The takes with which the history starts; those of the file where the journal has none.
    pub(super) base: Option<Arc<[Arc<Take>]>>,
    /// The takes and the texts at the last save, where the journal recorded one.
    at_save: Option<SavedContent>,
    /// The reason why later edits could not be applied; `None` where all were.
    pub(super) stopped: Option<String>,
}

/// What a save wrote.
#[derive(Clone, Debug)]
struct SavedContent {
    takes: Vec<(TakeId, Arc<Take>)>,
    texts: TextFiles,
}

impl Replayed {
    /// Returns whether the takes and the texts of the last save are those of the file, which are given.
    pub(super) fn is_of(&self, model: &ModelData, texts: &TextFiles) -> bool {
        let takes = &model.animation.takes;
        match &self.at_save {
            Some(SavedContent { takes: saved, texts: saved_texts }) => {
                are_same(saved_texts, texts)
                    && saved.len() == takes.len()
                    && saved
                        .iter()
                        .zip(takes)
                        .all(|((_, saved), take)| Arc::ptr_eq(saved, take) || alike(saved, take))
            }
            None => self.base.is_none(),
        }
    }

    /// Returns the index of each take in the file, if the file is the last save; `None` where the history has no save.
    pub(super) fn places(&self) -> Option<HashMap<TakeId, usize>> {
        let saved = self.at_save.as_ref().map(|saved| &*saved.takes);
        let saved = saved.or(self.base.as_ref().map(|_| &[][..]))?;
        Some(saved.iter().enumerate().map(|(place, (id, _))| (*id, place)).collect())
    }
}

/// Returns whether texts have the same names and contents. The main text may have another name: that of a file as which the document was saved since.
fn are_same(one: &TextFiles, other: &TextFiles) -> bool {
    let (one, other) = (one.list(), other.list());
    one.len() == other.len()
        && one.first().map(|file| &file.text) == other.first().map(|file| &file.text)
        && one.iter().skip(1).eq(other.iter().skip(1))
}

/// Applies all entries again, to the takes and texts in the journal or to those of the file, `model` and `texts`.
pub(super) fn replay(model: &ModelData, texts: &TextFiles, entries: &[JournalEntry]) -> Replayed {
    let mut replay = Replay {
        model,
        texts,
        replayed: Replayed {
            edited: Edited::new(ModelAdapter::of(model).with_texts(texts.clone())),
            base: None,
            at_save: None,
            stopped: None,
        },
    };
    for entry in entries {
        let done = match entry {
            JournalEntry::Snapshot(bytes) => replay.snapshot(bytes),
            JournalEntry::Edit(bytes) => replay.record(bytes),
            JournalEntry::Saved => {
                replay.saved();
                Ok(())
            }
        };
        if let Err(reason) = done {
            replay.replayed.stopped = Some(reason);
            break;
        }
    }
    replay.replayed.edited.end_gesture();
    replay.replayed
}

struct Replay<'a> {
    model: &'a ModelData,
    texts: &'a TextFiles,
    replayed: Replayed,
}

impl Replay<'_> {
    fn about(&self, about: &EditsOrigin) -> Result<(), String> {
        if about.version > VERSION {
            return Err(format!(
                "its edits are of version {}, made by a newer version of this program",
                about.version
            ));
        }
        if about.built_in.is_some_and(|hash| hash != built_in_hash()) {
            return Err("it was made with the built-in model of another version".to_owned());
        }
        Ok(())
    }

    fn record(&mut self, bytes: &[u8]) -> Result<(), String> {
        let recorded: Recorded<'_> = serde_json::from_slice(bytes).map_err(|error| error.to_string())?;
        let edited = &mut self.replayed.edited;
        match recorded {
            Recorded::Begin(about) => {
                edited.end_gesture();
                return self.about(&about);
            }
            Recorded::Edit { edit, gesture } => {
                edited.apply(edit.into_owned(), gesture).map_err(|error| error.to_string())?;
            }
            Recorded::Cancel { gesture } => {
                edited.cancel(gesture);
            }
            Recorded::GoTo { steps } => {
                edited.go_to(steps);
            }
        }
        Ok(())
    }

    fn snapshot(&mut self, bytes: &[u8]) -> Result<(), String> {
        let unknown = || "its snapshot cannot be read".to_owned();
        let (snapshot, base) = Snapshot::read(bytes).ok_or_else(unknown)?;
        self.about(&snapshot.about)?;
        let animation = &self.model.animation;
        let other = "its takes belong to another model";
        let of_file = || BaseSkeleton::of(&animation.skeleton);
        let roots = snapshot.skeleton.unwrap_or_else(of_file);
        let skeleton = roots.skeleton(self.model).ok_or(other)?;
        let takes = match base {
            Some(bytes) => base::read(bytes, skeleton.len()).ok_or(other)?,
            None if skeleton.len() == animation.skeleton.len() => animation.takes.clone(),
            None => return Err(other.to_owned()),
        };
        let instances = self.model.instances.len();
        if takes.iter().flat_map(|take| &take.morphs).any(|morph| morph.instance as usize >= instances) {
            return Err(other.to_owned());
        }
        self.replayed.base = base.map(|_| takes.clone().into());
        let edited = &mut self.replayed.edited;
        let adapter = ModelAdapter::new(&AnimationData { skeleton, takes });
        let texts = match &*snapshot.texts {
            [] => self.texts.clone(),
            texts => {
                let file = |(name, text): &(String, String)| TextFile {
                    name: name.as_str().into(),
                    text: text.as_str().into(),
                };
                texts.iter().map(file).collect()
            }
        };
        let adapter = adapter.with_shapes(ModelShapes::of(self.model)).with_texts(texts);
        *edited = Edited::started(adapter, roots);
        for edit in snapshot.steps {
            edited.apply(edit, None).map_err(|error| error.to_string())?;
        }
        edited.go_to(snapshot.done);
        edited.set_saved(snapshot.saved);
        let at_save = snapshot.saved.map(|saved| {
            let mut then = edited.clone();
            then.go_to(saved);
            SavedContent::of(&then)
        });
        self.replayed.at_save = at_save.filter(|_| base.is_some());
        Ok(())
    }

    fn saved(&mut self) {
        self.replayed.edited.mark_saved();
        self.replayed.at_save = Some(SavedContent::of(&self.replayed.edited));
    }
}

impl SavedContent {
    fn of(edited: &Edited) -> Self {
        let adapter = edited.adapter();
        let takes = adapter.slots().iter().map(|slot| (slot.id, Arc::clone(slot.shown()))).collect();
        Self { takes, texts: adapter.texts().clone() }
    }
}
