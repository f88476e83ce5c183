//! What the document publishes: immutable, shared, never locked.

use dragonfly_anim::bounds::Bounds;
use dragonfly_anim::data::ModelData;
use std::path::PathBuf;
use std::sync::Arc;

/// Pixels ready for the device, decoded once by the job that loaded the model.
#[derive(Clone, Debug, PartialEq)]
pub struct DecodedImage {
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// RGBA, 8 bits each, rows from the top, `width * height * 4` bytes.
    pub pixels: Vec<u8>,
}

/// A model as loaded, with everything that drawing needs.
#[derive(Debug)]
pub struct LoadedModel {
    /// File name without folder, or "Dragonfly" for the built-in model.
    pub title: String,
    /// `None` for the built-in model.
    pub path: Option<PathBuf>,
    /// "glb", "gltf".
    pub format: String,
    /// The data.
    pub model: Arc<ModelData>,
    /// How much room it takes at the begin of its first take, or in the rest pose when it has none.
    pub bounds: Bounds,
    /// One an image of the model; `None` where it could not be decoded (a warning says why).
    /// Shared, because several images of a file may name the same source.
    pub images: Vec<Option<Arc<DecodedImage>>>,
    /// What is not shown or was mended, one sentence each.
    pub warnings: Vec<String>,
}

/// The newest state of the document. Panels read it; nobody changes it.
#[derive(Clone, Debug)]
pub struct View {
    /// Grows with every change.
    pub generation: u64,
    /// The model.
    pub loaded: Arc<LoadedModel>,
}
