//! glTF 2.0, as JSON text with referenced files (`.gltf`) or in one binary container (`.glb`).
//!
//! Of the `gltf` crate only the document model is used, to parse the JSON text. Its checks, readers and file access
//! panic, hang or allocate gigabytes on small files, so this module has its own: `accessor` is the only module that
//! reads a buffer, `graph` the only one that walks the nodes.
//!
//! Reading order: `survey` and `document` (text → model), `buffer`, `meshopt`, `draco`, `accessor`, `graph`, `node`, `skin`, `mesh`,
//! `animation`, `scene`. [`check`] lists every rule.

mod accessor;
mod animation;
mod attribute;
mod avatar;
mod buffer;
pub mod check;
mod document;
mod draco;
mod extension;
mod extras;
mod glb;
mod graph;
mod image;
mod influence;
mod keys;
mod material;
mod mesh;
mod meshopt;
mod morph;
mod node;
mod pointer;
mod references;
pub mod save;
mod scene;
mod skin;
mod survey;
mod target_path;
mod triangles;
mod vrma;
mod walk;
mod whole;
pub mod write;

pub use super::image_kind::measure_image;
pub use extension::supports_extension;
pub use material::phong;

use super::{ExportError, Format, ImportContext, ImportError, Place, SavePlan, WriteSupport};
use crate::data::{AnimationData, ModelData};
use accessor::GltfDocument;
use std::collections::HashMap;
use std::sync::Arc;

/// glTF 2.0 in one binary container, `.glb`.
pub const GLB: Format = Format {
    name: "glb",
    title: "glTF 2.0, binary",
    extensions: &["glb", "vrm"],
    sniff: |bytes| bytes.starts_with(b"glTF") && !vrma::names_extension(bytes),
    read: read_glb,
    write: WriteSupport::Surgical(save::open),
    export: Some(export_glb),
};

/// Animations for persons in one binary container, `.vrma`.
pub const VRMA: Format = Format {
    name: "vrma",
    title: "VRM animation",
    extensions: &["vrma"],
    sniff: |bytes| bytes.starts_with(b"glTF") && vrma::names_extension(bytes),
    read: read_glb,
    write: WriteSupport::Surgical(save::open),
    export: Some(|model, name| Ok(vrma::write(model)?.named(name))),
};

/// glTF 2.0 as JSON text, `.gltf`.
pub const GLTF: Format = Format {
    name: "gltf",
    title: "glTF 2.0, text",
    extensions: &["gltf"],
    sniff: looks_like_json,
    read: read_gltf,
    write: WriteSupport::Surgical(save::open),
    export: Some(|model, name| Ok(write::gltf(model)?.named(name))),
};

fn looks_like_json(bytes: &[u8]) -> bool {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    text.iter().find(|byte| !byte.is_ascii_whitespace()) == Some(&b'{')
}

fn export_glb(model: &ModelData, name: &str) -> Result<SavePlan, ExportError> {
    if name.to_ascii_lowercase().ends_with(".vrm") {
        return Err(ExportError::new(VrmRefused));
    }
    Ok(write::glb(model)?.named(name))
}

/// A new VRM needs a license and other facts that no model here has.
#[derive(Debug, thiserror::Error)]
#[error("a new .vrm cannot be written, only edits of an opened one; write .glb, or .vrma for its animations")]
struct VrmRefused;

fn read_glb(bytes: &[u8], context: &ImportContext<'_>) -> Result<ModelData, ImportError> {
    let glb = glb::parse(bytes, context)?;
    read_document(glb.json, glb.json_at, glb.bin, bytes.len(), context)
}

fn read_gltf(bytes: &[u8], context: &ImportContext<'_>) -> Result<ModelData, ImportError> {
    read_document(bytes, 0, None, bytes.len(), context)
}

/// Reads the document whose JSON text starts at byte `json_at` of a file of `size` bytes.
fn read_document(
    json: &[u8],
    json_at: u64,
    bin: Option<&[u8]>,
    size: usize,
    context: &ImportContext<'_>,
) -> Result<ModelData, ImportError> {
    let (mut root, pointers) = document::parse(json, json_at, context)?;
    pointer::resolve(&mut root, &pointers);
    extension::check(&root, context)?;
    references::check(&root, context)?;
    let graph = graph::graph(&root, context)?;
    let fallbacks = meshopt::fallbacks(&root, context)?;
    let buffers = buffer::load(&root, bin, &fallbacks, context)?;
    let decoded = meshopt::decode(&root, &buffers, context)?;
    let bytes = size.saturating_add(buffers.iter().map(|buffer| buffer.bytes().len()).sum());
    let unpacked = HashMap::new();
    let mut document = GltfDocument { root: &root, buffers, decoded, unpacked, pointers, bytes, context };
    document.unpacked = draco::decode(&document)?;
    let document = document;

    let mut is_bone = context.filled(&Place::Pointer("/nodes".to_owned()), root.nodes.len(), false)?;
    skin::mark_joints(&document, &mut is_bone)?;
    animation::mark_animated(&document, &mut is_bone)?;
    let named = avatar::mark_bones(&root, &mut is_bone, context)?;
    let bones = scene::number_bones(&document, &graph, &mut is_bone)?;

    let locals = node::locals(&root, context)?;
    let globals = node::globals(&graph, &locals, context)?;
    let is_shown = scene::shown(&document, &graph)?;
    let shown_skins = scene::shown_skins(&document, &is_shown)?;
    let nodes = skin::SkinNodes { bones: &bones, globals: &globals, is_shown: &shown_skins };
    let skins = skin::skins(&document, &nodes)?;
    let skeleton = scene::skeleton(&document, &graph, &locals, &globals, &bones, &skins.skins)?;
    context.progress(0.3)?;

    let images = image::images(&document)?;
    let materials = material::materials(&root, &images.numbers, context)?;
    let meshes = mesh::meshes(&document, &scene::shown_meshes(&document, &is_shown)?)?;
    let parts = scene::SceneParts { meshes: &meshes, skins: &skins.numbers, is_shown: &is_shown };
    let stage = scene::stage(&document, &graph, &locals, skeleton, bones, &parts)?;
    let takes = animation::takes(&document, &stage)?;
    let avatar = avatar::avatar(&document, named, &stage)?;

    let scene = root.scene.and_then(|scene| root.scenes.get(scene.value())).or(root.scenes.first());
    Ok(ModelData {
        name: scene.and_then(|scene| scene.name.clone()).unwrap_or_default(),
        meshes: meshes.into_iter().map(|read| read.mesh).collect(),
        instances: stage.instances,
        skins: skins.skins,
        materials,
        images: images.images,
        animation: AnimationData {
            skeleton: Arc::new(stage.skeleton),
            takes: takes.into_iter().map(Arc::new).collect(),
        },
        avatar,
    })
}
