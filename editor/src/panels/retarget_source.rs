//! The model whose takes are wanted for the open one, as the document read it.

use dragonfly_anim::data::BoneIndex;
use dragonfly_document::{BoneMap, ClipOrder, LoadedModel};
use std::sync::Arc;

/// The source, and the bone map that was read last.
#[derive(Debug, Default)]
pub struct RetargetSource {
    source: Option<Arc<LoadedModel>>,
    map: Option<Arc<BoneMap>>,
    /// The import for which files are chosen.
    order: Option<ClipOrder>,
    /// An empty list of pairs of bones, for the skeleton next to the model.
    unpaired: Arc<[Option<BoneIndex>]>,
}

impl RetargetSource {
    /// Returns the source.
    pub fn source(&self) -> Option<&Arc<LoadedModel>> {
        self.source.as_ref()
    }

    /// Returns the bone map that was read last for this source.
    pub fn map(&self) -> Option<&Arc<BoneMap>> {
        self.map.as_ref()
    }

    /// Returns no pairs of bones with the open model.
    pub fn unpaired(&self) -> &Arc<[Option<BoneIndex>]> {
        &self.unpaired
    }

    pub(super) fn set_source(&mut self, source: Arc<LoadedModel>) {
        (self.source, self.map) = (Some(source), None);
    }

    /// Keeps the order while the user chooses its files.
    pub(super) fn set_order(&mut self, order: ClipOrder) {
        self.order = Some(order);
    }

    /// Returns the order whose files were chosen.
    pub(super) fn take_order(&mut self) -> Option<ClipOrder> {
        self.order.take()
    }

    pub(super) fn set_map(&mut self, map: BoneMap) {
        self.map = Some(Arc::new(map));
    }
}
