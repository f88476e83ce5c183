//! The layer whose keys are shown and edited, and the take below it.

use super::PanelContext;
use crate::panels::digest::ShownKeys;
use dragonfly_anim::data::Take;
use dragonfly_document::adapter::{LayerVersions, TakeVersions};
use dragonfly_document::edit::{LayerRef, TakeRef};
use std::sync::Arc;

impl<'a> PanelContext<'a> {
    /// Returns the layers of the take that is shown, the lowest first.
    pub fn layers(&self) -> &'a [LayerVersions] {
        self.slot().map_or(&[], TakeVersions::layers)
    }

    /// Returns which keys are shown and edited.
    pub(in crate::panels) fn shown_keys(&self) -> ShownKeys {
        ShownKeys { take: self.playback.take, layer: self.layer_choice.chosen() }
    }

    /// Returns the index of the active layer; `None` where the take itself is edited.
    pub fn layer(&self) -> Option<usize> {
        self.shown_keys().layer_in(self.view?)
    }

    /// Returns the active layer, or the take that is shown, with original keys and changes: what edits of keys change.
    pub fn key_slot(&self) -> Option<&'a TakeVersions> {
        match self.layer() {
            Some(layer) => self.layers().get(layer).map(|layer| &*layer.keys),
            None => self.slot(),
        }
    }

    /// Returns the keys that are shown and edited: those of the active layer, or those of the take below its layers.
    pub fn shared_take(&self) -> Option<&'a Arc<Take>> {
        self.shown_keys().of(self.view?)
    }

    /// Returns the take that is shown, with all its layers.
    pub fn shown_take(&self) -> Option<&'a Arc<Take>> {
        self.view?.takes.get(self.playback.take?)
    }

    /// Returns the take that is shown, as edits name it: never a layer.
    pub fn shown_take_ref(&self) -> Option<TakeRef> {
        self.shown_take().and(self.playback.take).map(TakeRef::Index)
    }

    /// Returns a layer of the take that is shown, as edits name it.
    pub fn layer_ref(&self, layer: usize) -> Option<TakeRef> {
        let take = Box::new(self.shown_take_ref()?);
        Some(TakeRef::Layer { take, layer: LayerRef::Index(layer) })
    }

    /// Returns the active layer, or the take that is shown, as edits name it.
    pub fn take_ref(&self) -> Option<TakeRef> {
        match self.layer() {
            Some(layer) => self.layer_ref(layer),
            None => self.shown_take_ref(),
        }
    }
}
