//! glTF 2.0, as JSON with files beside it (`.gltf`) or in one binary container (`.glb`).
//!
//! The JSON text becomes the `gltf` crate's document model and nothing more of that crate is used: its own checks,
//! readers and file access panic, hang or take gigabytes on small files. What stands between the model and the bytes
//! is here: `accessor` is the only module that looks into a buffer, `graph` the only one that walks the nodes.
//!
//! Reading order: `survey` and `document` (text → model), `buffer`, `accessor`, `graph`, `node`, `skin`, `mesh`,
//! `animation`, `scene`. [`check`] lists every rule.

mod accessor;
mod animation;
mod buffer;
pub mod check;
mod document;
mod extension;
mod glb;
mod graph;
mod image;
mod influence;
mod keys;
mod material;
mod mesh;
mod morph;
mod node;
mod references;
pub mod save;
mod scene;
mod skin;
mod survey;
mod triangles;
mod walk;

pub use extension::SUPPORTED;
pub use image::measure as measure_image;
pub use material::phong;

use super::{AssetFs, Format, ImportError, Place, guard::Guard};
use crate::data::{AnimationData, ModelData};
use accessor::Document;
use buffer::Store;
use std::sync::Arc;

/// Binary container.
pub const GLB: Format =
    Format { name: "glb", extensions: &["glb"], detect: |bytes| bytes.starts_with(b"glTF"), read: read_glb };

/// JSON text.
pub const GLTF: Format =
    Format { name: "gltf", extensions: &["gltf"], detect: looks_like_json, read: read_gltf };

fn looks_like_json(bytes: &[u8]) -> bool {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    text.iter().find(|byte| !byte.is_ascii_whitespace()) == Some(&b'{')
}

fn read_glb(bytes: &[u8], door: &dyn AssetFs, guard: &Guard<'_>) -> Result<ModelData, ImportError> {
    let glb = glb::parse(bytes, guard)?;
    read_document(glb.json, glb.json_at, glb.bin, bytes.len(), door, guard)
}

fn read_gltf(bytes: &[u8], door: &dyn AssetFs, guard: &Guard<'_>) -> Result<ModelData, ImportError> {
    read_document(bytes, 0, None, bytes.len(), door, guard)
}

/// `json` begins at byte `json_at` of a file of `size` bytes.
fn read_document(
    json: &[u8],
    json_at: u64,
    bin: Option<&[u8]>,
    size: usize,
    door: &dyn AssetFs,
    guard: &Guard<'_>,
) -> Result<ModelData, ImportError> {
    let root = document::parse(json, json_at, guard)?;
    extension::check(&root, guard)?;
    references::check(&root, guard)?;
    let graph = graph::graph(&root, guard)?;
    let store = Store::new(door, guard);
    let buffers = buffer::load(&root, bin, &store, guard)?;
    let bytes = size.saturating_add(buffers.iter().map(|buffer| buffer.bytes().len()).sum());
    let document = Document { root: &root, buffers, bytes, guard };

    let mut is_bone = guard.filled(&Place::Pointer("/nodes".to_owned()), root.nodes.len(), false)?;
    skin::mark_joints(&document, &mut is_bone)?;
    animation::mark_animated(&document, &mut is_bone)?;
    let bones = scene::number_bones(&document, &graph, &mut is_bone)?;

    let locals = node::locals(&root, guard)?;
    let globals = node::globals(&graph, &locals, guard)?;
    let skins = skin::skins(&document, &bones)?;
    let skeleton = scene::skeleton(&document, &graph, &locals, &globals, &bones, &skins)?;
    guard.progress(0.3)?;

    let images = image::images(&document, &store)?;
    let materials = material::materials(&root, &images.numbers, guard)?;
    let meshes = mesh::meshes(&document)?;
    let stage = scene::stage(&document, &graph, &locals, skeleton, bones, &meshes)?;
    let takes = animation::takes(&document, &stage)?;

    let scene = root.scene.and_then(|scene| root.scenes.get(scene.value())).or(root.scenes.first());
    Ok(ModelData {
        name: scene.and_then(|scene| scene.name.clone()).unwrap_or_default(),
        meshes: meshes.into_iter().map(|read| read.mesh).collect(),
        instances: stage.instances,
        skins,
        materials,
        images: images.images,
        animation: AnimationData {
            skeleton: Arc::new(stage.skeleton),
            takes: takes.into_iter().map(Arc::new).collect(),
        },
    })
}
