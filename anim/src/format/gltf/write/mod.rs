//! Writes a whole glTF 2.0 file from any model: compact, and clean for the Khronos validator.
//!
//! Models that were read from glTF are saved by [`super::save`], which keeps the bytes of the file. This module is for
//! models of other formats, and for models that were made in code.
//!
//! Each bone is the node of the same index. A mesh is in the node of the bone that carries it where that is possible,
//! otherwise in a node of its own. Equal columns of key times are stored once. Images are stored in the file.
//!
//! What glTF cannot represent is in [`WholeFile::lost`]; the rules for keys are those of [`super::save`]. A bone with a
//! sheared matrix keeps it only where nothing animates the bone.
//!
//! ```
//! use dragonfly_anim::data::ModelData;
//! use dragonfly_anim::format::{NoFiles, ReadOptions, gltf, read};
//!
//! let model = ModelData { name: "empty".to_owned(), ..ModelData::default() };
//! let file = gltf::write::glb(&model)?;
//! let opened = read("empty.glb", &file.bytes, &NoFiles, &ReadOptions::default())?;
//! assert_eq!(opened.model.name, "empty");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Reading order: `bytes` (buffer views and accessors), `node` (the scene), `mesh`, `material`, `animation`.

mod animation;
mod bytes;
mod material;
mod mesh;
mod node;

use crate::data::ModelData;
use crate::format::gltf::save::SaveError;
use crate::format::losses::avatar_lost;
use crate::format::{ExportError, IMAGE_KINDS, Place, Warning, WholeFile};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use bytes::BinaryWriter;
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;

/// Code of the warnings about content that glTF cannot represent.
pub(super) const NOT_IN_GLTF: &str = "NOT_IN_GLTF";

/// Returns the model as the bytes of a `.glb`.
///
/// # Errors
///
/// Keys that no reader would accept (the rules of [`super::save`]), or more than 4 GiB.
pub fn glb(model: &ModelData) -> Result<WholeFile, ExportError> {
    let (root, binary, mut lost) = document(model)?;
    lost.extend(avatar_lost(model));
    let bytes = container(&root, binary)?;
    Ok(WholeFile { bytes, lost })
}

/// Returns a document and its buffer in a binary container.
pub(super) fn container(root: &Value, binary: Vec<u8>) -> Result<Vec<u8>, ExportError> {
    let mut text = serde_json::to_vec(root).map_err(ExportError::new)?;
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut binary = binary;
    binary.resize(binary.len().next_multiple_of(4), 0);
    let chunk_header = |length: usize| 8 + length;
    let body = if binary.is_empty() { 0 } else { chunk_header(binary.len()) };
    let length = 12 + chunk_header(text.len()) + body;
    if u32::try_from(length).is_err() {
        let limit = u64::from(u32::MAX);
        return Err(ExportError::new(SaveError::TooLarge { bytes: length as u64, limit }));
    }
    let mut bytes = Vec::with_capacity(length);
    bytes.extend(b"glTF");
    bytes.extend(2_u32.to_le_bytes());
    bytes.extend((length as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", &text), (b"BIN\0", &binary)] {
        if !chunk.is_empty() {
            bytes.extend((chunk.len() as u32).to_le_bytes());
            bytes.extend(kind);
            bytes.extend(chunk);
        }
    }
    Ok(bytes)
}

/// Returns the model as the text of a `.gltf` that contains its buffer and images.
///
/// # Errors
///
/// As for [`glb`].
pub fn gltf(model: &ModelData) -> Result<WholeFile, ExportError> {
    let (mut root, binary, mut lost) = document(model)?;
    lost.extend(avatar_lost(model));
    if !binary.is_empty() {
        let uri = format!("data:application/octet-stream;base64,{}", STANDARD.encode(&binary));
        root["buffers"][0]["uri"] = Value::String(uri);
    }
    let mut bytes = serde_json::to_vec_pretty(&root).map_err(ExportError::new)?;
    bytes.push(b'\n');
    Ok(WholeFile { bytes, lost })
}

/// State of a file that is being written.
struct GltfWriter<'a> {
    model: &'a ModelData,
    binary: BinaryWriter,
    extensions: BTreeSet<&'static str>,
    lost: Vec<Warning>,
}

impl GltfWriter<'_> {
    /// Records content that the file does not contain; `pointer` is the place in the model.
    fn lose(&mut self, pointer: String, text: impl Into<String>) {
        self.lost.push(Warning { place: Place::Pointer(pointer), code: NOT_IN_GLTF, text: text.into() });
    }
}

/// Returns the document, its buffer, and what is not in it.
pub(super) fn document(model: &ModelData) -> Result<(Value, Vec<u8>, Vec<Warning>), ExportError> {
    let mut writer =
        GltfWriter { model, binary: BinaryWriter::default(), extensions: BTreeSet::new(), lost: Vec::new() };
    let meshes = writer.meshes();
    let scene = writer.scene(&meshes.numbers);
    let skins = writer.skins();
    let materials = writer.materials();
    let animations = writer.animations(&scene.instance_nodes)?;

    let mut root = Map::new();
    root.insert("asset".to_owned(), json!({"version": "2.0", "generator": "Dragonfly"}));
    let used: Vec<&str> = writer.extensions.iter().copied().collect();
    // Such textures have no other image.
    let of_images = |name: &&str| IMAGE_KINDS.iter().any(|kind| kind.gltf_extension == Some(*name));
    let required: Vec<&str> = used.iter().copied().filter(of_images).collect();
    let (views, accessors, binary) = writer.binary.finish();
    let buffers = if binary.is_empty() { vec![] } else { vec![json!({"byteLength": binary.len()})] };
    let mut list = |name: &str, values: Vec<Value>| {
        // glTF forbids empty lists.
        if !values.is_empty() {
            root.insert(name.to_owned(), Value::Array(values));
        }
    };
    list("extensionsUsed", used.into_iter().map(Value::from).collect());
    list("extensionsRequired", required.into_iter().map(Value::from).collect());
    list("scenes", vec![scene.scene]);
    list("nodes", scene.nodes);
    list("meshes", meshes.values);
    list("skins", skins);
    list("materials", materials.materials);
    list("textures", materials.textures);
    list("samplers", materials.samplers);
    list("images", materials.images);
    list("animations", animations);
    list("accessors", accessors);
    list("bufferViews", views);
    list("buffers", buffers);
    root.insert("scene".to_owned(), json!(0));
    Ok((Value::Object(root), binary, writer.lost))
}

/// Returns a number of JSON with as few digits as give the same single-precision number again.
fn number(value: f32) -> Value {
    let short: f64 = value.to_string().parse().unwrap_or_default();
    Value::from(if short as f32 == value { short } else { f64::from(value) })
}

/// Returns numbers of JSON, see [`number`].
fn numbers(values: impl IntoIterator<Item = f32>) -> Value {
    values.into_iter().map(number).collect()
}

/// Inserts `name` unless it is empty.
fn named(object: &mut Map<String, Value>, name: &str) {
    if !name.is_empty() {
        object.insert("name".to_owned(), Value::from(name));
    }
}
