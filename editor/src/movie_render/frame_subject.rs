//! The subject of a movie.

use dragonfly_document::{LoadedModel, SceneView};
use std::sync::Arc;

/// The subject of a movie: a scene, or a take of a model.
#[derive(Clone, Debug)]
pub enum FrameSubject {
    /// A scene.
    Scene(Arc<SceneView>),
    /// A take of a model.
    Take {
        /// The model.
        loaded: Arc<LoadedModel>,
        /// Index of the take.
        take: usize,
    },
}
