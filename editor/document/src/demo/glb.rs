//! Writes the model as a binary glTF 2.0 file.

use super::mesh::{DemoMesh, DemoVertex};
use super::skeleton::{DemoBone, ROOT};
use super::takes::{DemoPath, DemoTake};
use super::texture::Picture;
use serde_json::{Value, json};

const FLOAT: u32 = 5126;
const BYTE: u32 = 5121;
const SHORT: u32 = 5123;
const VERTICES: u32 = 34962;
const INDICES: u32 = 34963;

/// Everything the file holds.
pub(super) struct Model {
    pub(super) bones: Vec<DemoBone>,
    /// One mesh per material: body, eyes, wings.
    pub(super) meshes: [DemoMesh; 3],
    pub(super) pictures: [Picture; 7],
    pub(super) takes: Vec<DemoTake>,
}

#[derive(Default)]
struct GlbWriter {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl GlbWriter {
    fn view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        let mut view = json!({"buffer": 0, "byteLength": bytes.len(), "byteOffset": self.bytes.len()});
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.views.push(view);
        self.bytes.extend_from_slice(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.len() - 1
    }

    fn accessor(&mut self, view: usize, component: u32, kind: &str, count: usize) -> usize {
        self.accessors.push(json!({
            "bufferView": view, "componentType": component, "count": count, "type": kind,
        }));
        self.accessors.len() - 1
    }

    /// Adds rows of floats in a buffer view of their own, and returns the index of their accessor.
    fn floats(&mut self, data: &[f32], kind: &str, target: Option<u32>) -> usize {
        let view = self.view(&little_endian(data), target);
        self.accessor(view, FLOAT, kind, data.len() / width(kind))
    }

    /// Records the smallest and largest value of each column of an accessor.
    fn bound(&mut self, accessor: usize, data: &[f32], width: usize) {
        let fold = |start: f32, pick: fn(f32, f32) -> f32| -> Vec<f32> {
            (0..width).map(|c| data.iter().skip(c).step_by(width).copied().fold(start, pick)).collect()
        };
        self.accessors[accessor]["min"] = json!(fold(f32::MAX, f32::min));
        self.accessors[accessor]["max"] = json!(fold(f32::MIN, f32::max));
    }

    fn primitive(&mut self, mesh: &DemoMesh, material: usize, tangents: bool) -> Value {
        let floats = |pick: &dyn Fn(&DemoVertex) -> Vec<f32>| -> Vec<f32> {
            mesh.vertices.iter().flat_map(pick).collect()
        };
        let count = mesh.vertices.len();
        let target = Some(VERTICES);
        let position = floats(&|v| v.position.to_array().to_vec());
        let normal = floats(&|v| v.normal.to_array().to_vec());
        let at = self.floats(&position, "VEC3", target);
        self.bound(at, &position, 3);
        let mut attributes = json!({
            "NORMAL": self.floats(&normal, "VEC3", target),
            "POSITION": at,
        });
        if tangents {
            let tangent = floats(&|v| v.tangent.to_array().to_vec());
            attributes["TANGENT"] = json!(self.floats(&tangent, "VEC4", target));
        }
        let uv: Vec<u8> = mesh
            .vertices
            .iter()
            .flat_map(|v| v.uv.to_array())
            .flat_map(|x| ((x.clamp(0.0, 1.0) * 65535.0 + 0.5) as u16).to_le_bytes())
            .collect();
        let joints: Vec<u8> = mesh.vertices.iter().flat_map(|v| v.bind.joints).collect();
        let weights: Vec<u8> = mesh.vertices.iter().flat_map(|v| v.bind.weights).collect();
        for (name, bytes, component, kind, whole) in [
            ("TEXCOORD_0", uv, SHORT, "VEC2", true),
            ("JOINTS_0", joints, BYTE, "VEC4", false),
            ("WEIGHTS_0", weights, BYTE, "VEC4", true),
        ] {
            let view = self.view(&bytes, target);
            let index = self.accessor(view, component, kind, count);
            if whole {
                self.accessors[index]["normalized"] = json!(true);
            }
            attributes[name] = json!(index);
        }
        let bytes: Vec<u8> = mesh.indices.iter().flat_map(|i| i.to_le_bytes()).collect();
        let view = self.view(&bytes, Some(INDICES));
        let indices = self.accessor(view, SHORT, "SCALAR", mesh.indices.len());
        json!({"attributes": attributes, "indices": indices, "material": material})
    }

    /// Adds key data and returns the index of its accessor. The data of all takes goes into one buffer view, `at`,
    /// which is filled last.
    fn keys(&mut self, all: &mut Vec<f32>, at: usize, data: &[f32], kind: &str) -> usize {
        let index = self.accessor(at, FLOAT, kind, data.len() / width(kind));
        self.accessors[index]["byteOffset"] = json!(all.len() * 4);
        all.extend_from_slice(data);
        index
    }

    fn animation(&mut self, take: &DemoTake, all: &mut Vec<f32>, at: usize) -> Value {
        // Tracks that share their key times share one accessor for them.
        let mut inputs: Vec<(&[f32], usize)> = Vec::new();
        let (mut channels, mut samplers) = (Vec::new(), Vec::new());
        for track in &take.tracks {
            let known = inputs.iter().find(|(times, _)| *times == track.times.as_slice());
            let input = match known {
                Some(&(_, index)) => index,
                None => {
                    let index = self.keys(all, at, &track.times, "SCALAR");
                    self.bound(index, &track.times, 1);
                    inputs.push((&track.times, index));
                    index
                }
            };
            let (path, kind) = match track.path {
                DemoPath::Rotation => ("rotation", "VEC4"),
                DemoPath::Translation => ("translation", "VEC3"),
            };
            let output = self.keys(all, at, &track.values, kind);
            channels.push(json!({
                "sampler": samplers.len(), "target": {"node": track.bone, "path": path},
            }));
            samplers.push(json!({
                "input": input,
                "interpolation": if track.cubic { "CUBICSPLINE" } else { "LINEAR" },
                "output": output,
            }));
        }
        json!({"channels": channels, "name": take.name, "samplers": samplers})
    }
}

/// Returns the number of floats in a row of an accessor of this kind.
fn width(kind: &str) -> usize {
    match kind {
        "SCALAR" => 1,
        "VEC3" => 3,
        "VEC4" => 4,
        _ => 16,
    }
}

fn little_endian(data: &[f32]) -> Vec<u8> {
    data.iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// Returns the bytes of the file.
pub(super) fn write(model: &Model) -> Vec<u8> {
    let mut out = GlbWriter::default();
    let primitives: Vec<Value> = (0..3).map(|i| out.primitive(&model.meshes[i], i, i < 2)).collect();
    let inverse: Vec<f32> =
        model.bones.iter().flat_map(|b| glam::Mat4::from_translation(-b.head).to_cols_array()).collect();
    let bind = out.floats(&inverse, "MAT4", None);
    let (mut keys, at) = (Vec::new(), out.views.len());
    // Reserves the index of the view for all keys; a view per track would make the JSON larger for nothing.
    out.views.push(Value::Null);
    let animations: Vec<Value> = model.takes.iter().map(|take| out.animation(take, &mut keys, at)).collect();
    out.view(&little_endian(&keys), None);
    out.views.swap_remove(at);
    let images: Vec<Value> = model
        .pictures
        .iter()
        .map(|p| json!({"bufferView": out.view(&p.bytes, None), "mimeType": p.mime, "name": p.name}))
        .collect();
    let mut nodes: Vec<Value> = Vec::new();
    for (i, bone) in model.bones.iter().enumerate() {
        let mut node = json!({"name": bone.name});
        let parent = bone.parent.map_or(glam::Vec3::ZERO, |p| model.bones[p].head);
        if bone.parent.is_some() {
            node["translation"] = json!((bone.head - parent).to_array());
        }
        let children: Vec<usize> =
            (0..model.bones.len()).filter(|&c| model.bones[c].parent == Some(i)).collect();
        if !children.is_empty() {
            node["children"] = json!(children);
        }
        nodes.push(node);
    }
    let joints: Vec<usize> = (0..nodes.len()).collect();
    nodes.push(json!({"mesh": 0, "name": "dragonfly", "skin": 0}));
    let textures: Vec<Value> = (0..images.len()).map(|i| json!({"sampler": 0, "source": i})).collect();
    let document = json!({
        "accessors": out.accessors,
        "animations": animations,
        "asset": {"generator": "Dragonfly", "version": "2.0"},
        "bufferViews": out.views,
        "buffers": [{"byteLength": out.bytes.len()}],
        "images": images,
        "materials": materials(),
        "meshes": [{"name": "dragonfly", "primitives": primitives}],
        "nodes": nodes,
        // Linear with mip levels; nothing repeats, and clamping keeps rims clean at small sizes.
        "samplers": [{"magFilter": 9729, "minFilter": 9987, "wrapS": 33071, "wrapT": 33071}],
        "scene": 0,
        "scenes": [{"name": "dragonfly", "nodes": [ROOT, joints.len()]}],
        "skins": [{"inverseBindMatrices": bind, "joints": joints, "name": "dragonfly", "skeleton": ROOT}],
        "textures": textures,
    });
    let mut text = String::new();
    write_sorted(&document, &mut text);
    assemble(text.into_bytes(), out.bytes)
}

fn materials() -> Value {
    json!([
        {
            "name": "body",
            "normalTexture": {"index": 1},
            "occlusionTexture": {"index": 2},
            "pbrMetallicRoughness": {
                "baseColorTexture": {"index": 0},
                "metallicRoughnessTexture": {"index": 2},
            },
        },
        {
            "name": "eyes",
            "normalTexture": {"index": 4, "scale": 0.4},
            "occlusionTexture": {"index": 5},
            "pbrMetallicRoughness": {
                "baseColorTexture": {"index": 3},
                "metallicRoughnessTexture": {"index": 5},
            },
        },
        {
            "alphaMode": "BLEND",
            "doubleSided": true,
            "name": "wings",
            "pbrMetallicRoughness": {
                "baseColorTexture": {"index": 6},
                "metallicFactor": 0.0,
                "roughnessFactor": 0.35,
            },
        },
    ])
}

/// Writes JSON with its keys in order, so that the bytes do not depend on how the map type of
/// the JSON library was configured.
fn write_sorted(value: &Value, out: &mut String) {
    match value {
        Value::Object(map) => {
            let mut keys: Vec<&String> = map.keys().collect();
            keys.sort();
            out.push('{');
            for (i, key) in keys.into_iter().enumerate() {
                if i > 0 {
                    out.push(',');
                }
                out.push_str(&Value::from(key.as_str()).to_string());
                out.push(':');
                write_sorted(&map[key], out);
            }
            out.push('}');
        }
        Value::Array(items) => {
            out.push('[');
            for (i, item) in items.iter().enumerate() {
                if i > 0 {
                    out.push(',');
                }
                write_sorted(item, out);
            }
            out.push(']');
        }
        plain => out.push_str(&plain.to_string()),
    }
}

/// Header, JSON chunk padded with spaces, binary chunk padded with zeros.
fn assemble(mut text: Vec<u8>, mut data: Vec<u8>) -> Vec<u8> {
    text.resize(text.len().next_multiple_of(4), b' ');
    data.resize(data.len().next_multiple_of(4), 0);
    let size = |n: usize| u32::try_from(n).expect("the model is far below four gigabytes").to_le_bytes();
    let mut file = Vec::with_capacity(28 + text.len() + data.len());
    file.extend(b"glTF");
    file.extend(2_u32.to_le_bytes());
    file.extend(size(28 + text.len() + data.len()));
    for (chunk, tag) in [(&text, b"JSON"), (&data, b"BIN\0")] {
        file.extend(size(chunk.len()));
        file.extend(tag);
        file.extend(chunk);
    }
    file
}
