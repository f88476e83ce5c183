//! The model whose takes are wanted for the open one, as the document read it.

use dragonfly_document::{BoneMap, LoadedModel};
use std::sync::Arc;

/// The source, and the bone map that was read last.
#[derive(Debug, Default)]
pub struct RetargetSource {
    source: Option<Arc<LoadedModel>>,
    map: Option<Arc<BoneMap>>,
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

    pub(super) fn set_source(&mut self, source: Arc<LoadedModel>) {
        (self.source, self.map) = (Some(source), None);
    }

    pub(super) fn set_map(&mut self, map: BoneMap) {
        self.map = Some(Arc::new(map));
    }
}
