//! original + changes = result: a model's takes as the user edits them (thesis §2.2.2, §3.2.10.1).
//!
//! A [`ModelAdapter`] has each take three times ([`TakeVersions`]). The *original* is what was read and is never altered; the
//! *changes* are relative to keys of the original; the *result* is shown and saved. Per channel:
//!
//! ```text
//! translation   result = original + change
//! rotation      result = normalize(change * original)       space of the parent
//! scale         result = original * change                  per component
//! ```
//!
//! A key without a change is the original exact to the bit, and a channel without changes shares its columns with the
//! original. An edit of the structure (keys and takes created, moved, deleted; a root bone added) applies to all three.
//!
//! [`ModelAdapter::apply`] turns an edit into a few operations (`op`), each of which has an inverse; `plan` has the
//! algorithms that edits share. The cost of an edit, in time and in the size of its inverse, is in proportion to what
//! it touches: a change of a key touches the column of its channel.

mod apply;
pub(crate) mod change;
mod check;
mod contact_record;
mod drag;
mod error;
mod event_record;
mod key_bytes;
pub(crate) mod kind;
mod layer_record;
mod limits;
mod name;
pub(crate) mod op;
mod pending;
pub(crate) mod plan;
mod record_bone;
pub(crate) mod slot;
mod texts;
mod times;

pub use apply::Inverse;
pub use change::KeyChange;
pub use check::BrokenInvariant;
pub use contact_record::{CONTACTS, MOST_CONTACTS, stored_contacts};
pub(crate) use drag::ValueDrag;
pub use error::EditError;
pub use event_record::{EVENTS, MOST_EVENTS, stored_events};
pub use key_bytes::KEY_BYTES;
pub use kind::ChannelNumbers;
pub(crate) use layer_record::{LAYERS, unused_layers};
pub use name::take_name;
pub use pending::{Pending, PendingAt, PendingPose, PendingShape};
pub use slot::{ChannelChanges, LayerVersions, TakeId, TakeVersions};
pub use texts::{TextEditError, TextFile, TextFiles};

use crate::ModelShapes;
use crate::edit::target::{BoneRef, TakeRef};
use dragonfly_anim::data::{AnimationData, ModelData, Skeleton, Take};
use std::sync::Arc;

/// The takes of a model in their three forms. A clone is cheap: large data is shared.
#[derive(Clone, Debug)]
pub struct ModelAdapter {
    skeleton: Arc<Skeleton>,
    shapes: ModelShapes,
    slots: Vec<Arc<TakeVersions>>,
    /// The texts of a scene or project; none for a model.
    texts: TextFiles,
    /// Number of the next created take.
    next: u32,
}

impl ModelAdapter {
    /// Returns the unchanged takes of a model without shape keys; see [`Self::with_shapes`].
    pub fn new(animation: &AnimationData) -> Self {
        let slots: Vec<_> = animation
            .takes
            .iter()
            .enumerate()
            .map(|(index, take)| {
                Arc::new(TakeVersions::unchanged(TakeId(index as u32), Some(index), Arc::clone(take)))
            })
            .collect();
        let skeleton = Arc::clone(&animation.skeleton);
        let (shapes, texts, next) = (ModelShapes::default(), TextFiles::default(), slots.len() as u32);
        let mut adapter = Self { skeleton, shapes, next, slots, texts };
        adapter.restore_layers();
        adapter
    }

    /// Returns the same takes, of a model with these shape keys.
    #[must_use]
    pub fn with_shapes(self, shapes: ModelShapes) -> Self {
        Self { shapes, ..self }
    }

    /// Returns the same with these texts.
    #[must_use]
    pub fn with_texts(self, texts: TextFiles) -> Self {
        Self { texts, ..self }
    }

    /// Returns the texts of a scene or project; none for a model.
    pub fn texts(&self) -> &TextFiles {
        &self.texts
    }

    /// Returns the unchanged takes of a model.
    pub fn of(model: &ModelData) -> Self {
        Self::new(&model.animation).with_shapes(ModelShapes::of(model))
    }

    /// The takes of a model as they were in another adapter.
    pub(crate) fn of_slots(skeleton: &Arc<Skeleton>, slots: &[Arc<TakeVersions>]) -> Self {
        let layers = slots.iter().flat_map(|slot| slot.layers()).map(|layer| layer.keys.id);
        let ids = slots.iter().map(|slot| slot.id).chain(layers);
        let next = ids.map(|id| id.0 + 1).max().unwrap_or_default();
        let (shapes, texts) = (ModelShapes::default(), TextFiles::default());
        Self { skeleton: Arc::clone(skeleton), shapes, slots: slots.to_vec(), texts, next }
    }

    /// Returns the skeleton. Edits add root bones to it, and change nothing else.
    pub fn skeleton(&self) -> &Arc<Skeleton> {
        &self.skeleton
    }

    /// Returns the shape keys of the model, which no edit adds or removes.
    pub fn shapes(&self) -> &ModelShapes {
        &self.shapes
    }

    /// Returns the takes in their order.
    pub fn slots(&self) -> &[Arc<TakeVersions>] {
        &self.slots
    }

    /// Returns the takes that are shown, in their order: the results with their layers.
    pub fn results(&self) -> impl Iterator<Item = &Arc<Take>> {
        self.slots.iter().map(|slot| slot.shown())
    }

    /// Returns the number of pending poses of all takes, which are in no key and in no saved file.
    pub fn pending_poses(&self) -> usize {
        self.slots.iter().map(|slot| slot.pending_poses()).sum()
    }

    /// Returns the take of a reference. A name that several takes share means the first of them.
    ///
    /// # Errors
    ///
    /// [`EditError::NoTake`].
    pub fn take(&self, take: &TakeRef) -> Result<&Arc<TakeVersions>, EditError> {
        let found = match take {
            TakeRef::Index(index) => self.slots.get(*index),
            TakeRef::Name(name) => self.slots.iter().find(|slot| slot.original.name == *name),
            TakeRef::Layer { layer, .. } => {
                let layers = self.base(take)?.layers();
                layer.find_in(layers).map(|index| &layers[index].keys)
            }
        };
        found.ok_or_else(|| EditError::NoTake(take.clone()))
    }

    /// Returns the take of a reference; that of a layer is the take below it.
    ///
    /// # Errors
    ///
    /// [`EditError::NoTake`].
    pub fn base(&self, take: &TakeRef) -> Result<&Arc<TakeVersions>, EditError> {
        match take {
            TakeRef::Index(_) | TakeRef::Name(_) => self.take(take),
            TakeRef::Layer { take, .. } => match **take {
                TakeRef::Index(_) | TakeRef::Name(_) => self.take(take),
                TakeRef::Layer { .. } => Err(EditError::NoTake(TakeRef::clone(take))),
            },
        }
    }

    /// Returns the name of a take, or of a layer and its take: `Walk, layer Arm up`.
    pub(crate) fn title(&self, take: &TakeRef) -> Option<String> {
        let base = self.base(take).ok()?;
        let (_, layer) = self.place_of(self.take(take).ok()?.id)?;
        let name = base.original.name.clone();
        match layer.and_then(|layer| base.layers().get(layer)) {
            Some(layer) => Some(format!("{name}, layer {}", layer.settings.name)),
            None => Some(name),
        }
    }

    /// Returns the index of a take in the list, and that of its layer where it is one.
    pub(crate) fn place_of(&self, take: TakeId) -> Option<(usize, Option<usize>)> {
        let own = self.slots.iter().position(|slot| slot.id == take).map(|index| (index, None));
        own.or_else(|| {
            let mut slots = self.slots.iter().enumerate();
            slots.find_map(|(index, slot)| {
                let layer = slot.layers().iter().position(|layer| layer.keys.id == take)?;
                Some((index, Some(layer)))
            })
        })
    }

    /// Returns the take or layer with this identifier.
    pub(crate) fn slot(&self, take: TakeId) -> Option<&Arc<TakeVersions>> {
        let (index, layer) = self.place_of(take)?;
        let slot = &self.slots[index];
        layer.map_or(Some(slot), |layer| slot.layers().get(layer).map(|layer| &layer.keys))
    }

    /// Returns the index of the bone of a reference.
    ///
    /// # Errors
    ///
    /// [`EditError::NoBone`].
    pub fn bone(&self, bone: &BoneRef) -> Result<u32, EditError> {
        bone.find_in(&self.skeleton).ok_or_else(|| EditError::NoBone(bone.clone()))
    }

    /// Returns an identifier that no take has had.
    pub(super) fn new_id(&mut self) -> TakeId {
        self.next += 1;
        TakeId(self.next - 1)
    }
}
