//! A small valid glTF with every supported feature, made to be changed in one place.

use base64_of::base64;
use serde_json::{Value, json};

/// A document and its buffer.
#[derive(Clone)]
pub(crate) struct Fixture {
    pub(crate) json: Value,
    pub(crate) bin: Vec<u8>,
}

/// Numbers of the accessors of [`Fixture::new`] that tests change.
pub(crate) mod accessor {
    pub(crate) const POSITION: usize = 0;
    pub(crate) const NORMAL: usize = 1;
    pub(crate) const TANGENT: usize = 2;
    pub(crate) const COLOR: usize = 4;
    pub(crate) const JOINTS: usize = 5;
    pub(crate) const WEIGHTS: usize = 6;
    pub(crate) const INDICES: usize = 7;
    pub(crate) const OFFSETS: usize = 9;
    pub(crate) const TIMES: usize = 10;
    pub(crate) const TRANSLATIONS: usize = 11;
    pub(crate) const ROTATIONS: usize = 12;
    pub(crate) const MORPH_WEIGHTS: usize = 13;
    pub(crate) const SPARSE: usize = 14;
    pub(crate) const CUBIC: usize = 15;
}

impl Fixture {
    /// Four vertices, two joints, a skin, a morph target, a material with a texture, a take of five channels.
    pub(crate) fn new() -> Self {
        let mut fixture = Self { json: skeleton_of_json(), bin: Vec::new() };
        let floats =
            |numbers: &[f32]| numbers.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<u8>>();
        let half = std::f32::consts::FRAC_1_SQRT_2;
        let identity = glam::Mat4::IDENTITY.to_cols_array();
        let identities = [identity, identity].concat();
        fixture.accessor("VEC3", 5126, 4, &floats(&[0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.]));
        fixture.accessor("VEC3", 5126, 4, &floats(&[0., 0., 1.].repeat(4)));
        fixture.accessor("VEC4", 5126, 4, &floats(&[1., 0., 0., 1.].repeat(4)));
        fixture.accessor("VEC2", 5126, 4, &floats(&[0., 0., 1., 0., 1., 1., 0., 1.]));
        fixture.accessor("VEC4", 5126, 4, &floats(&[1., 0.5, 0.25, 1.].repeat(4)));
        fixture.accessor("VEC4", 5121, 4, &[0, 1, 0, 0].repeat(4));
        fixture.accessor("VEC4", 5126, 4, &floats(&[0.75, 0.25, 0., 0.].repeat(4)));
        fixture.accessor("SCALAR", 5123, 6, &[0u16, 1, 2, 0, 2, 3].map(u16::to_le_bytes).concat());
        fixture.accessor("VEC3", 5126, 4, &floats(&[0., 0., 0.5].repeat(4)));
        fixture.accessor("MAT4", 5126, 2, &floats(&identities));
        fixture.accessor("SCALAR", 5126, 3, &floats(&[0., 0.5, 1.]));
        fixture.accessor("VEC3", 5126, 3, &floats(&[0., 0., 0., 1., 0., 0., 1., 1., 0.]));
        fixture.accessor("VEC4", 5126, 3, &floats(&[0., 0., 0., 1., 0., 0., half, half, 0., 0., 1., 0.]));
        fixture.accessor("SCALAR", 5126, 3, &floats(&[0., 1., 0.5]));
        fixture.accessor("VEC3", 5126, 4, &[]);
        let sparse = fixture.view(&[1, 0, 2, 0, 0, 0, 0, 0]);
        let values = fixture.view(&floats(&[0., 0., 1., 0., 0., 2.]));
        fixture.json["accessors"][accessor::SPARSE] = json!({
            "componentType": 5126, "type": "VEC3", "count": 4,
            "sparse": {"count": 2, "indices": {"bufferView": sparse, "componentType": 5123},
                       "values": {"bufferView": values}}});
        fixture.accessor("VEC3", 5126, 9, &floats(&[1.; 27]));
        let png = fixture.view(&png(2, 2));
        fixture.json["images"][0]["bufferView"] = json!(png);
        fixture.json["buffers"][0]["byteLength"] = json!(fixture.bin.len());
        fixture
    }

    /// Appends bytes to the buffer and returns the number of their view.
    pub(crate) fn view(&mut self, bytes: &[u8]) -> usize {
        let view = json!({"buffer": 0, "byteOffset": self.bin.len(), "byteLength": bytes.len()});
        self.bin.extend_from_slice(bytes);
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        self.json["buffers"][0]["byteLength"] = json!(self.bin.len());
        push(&mut self.json["bufferViews"], view)
    }

    /// Appends an accessor with its own bytes and returns its number.
    pub(crate) fn accessor(&mut self, shape: &str, component: u32, count: usize, bytes: &[u8]) -> usize {
        let view = self.view(bytes);
        let accessor = json!({"bufferView": view, "componentType": component, "type": shape, "count": count});
        push(&mut self.json["accessors"], accessor)
    }

    /// Sets the value at a JSON pointer; adds missing members.
    pub(crate) fn set(&mut self, pointer: &str, value: Value) -> &mut Self {
        let mut at = &mut self.json;
        for part in pointer.split('/').skip(1) {
            at = match part.parse::<usize>() {
                Ok(index) => {
                    let list = at.as_array_mut().expect("a list");
                    if list.len() == index {
                        list.push(Value::Null);
                    }
                    &mut list[index]
                }
                Err(_) => &mut at[part],
            };
        }
        *at = value;
        self
    }

    /// Removes the value at a JSON pointer.
    pub(crate) fn remove(&mut self, pointer: &str) -> &mut Self {
        let (outer, name) = pointer.rsplit_once('/').unwrap();
        self.json.pointer_mut(outer).unwrap().as_object_mut().unwrap().remove(name).unwrap();
        self
    }

    /// Overwrites bytes of an accessor.
    pub(crate) fn patch(&mut self, accessor: usize, offset: usize, bytes: &[u8]) -> &mut Self {
        let view = self.json["accessors"][accessor]["bufferView"].as_u64().unwrap() as usize;
        let at = self.json["bufferViews"][view]["byteOffset"].as_u64().unwrap() as usize + offset;
        self.bin[at..at + bytes.len()].copy_from_slice(bytes);
        self
    }

    /// Overwrites one float of an accessor.
    pub(crate) fn float(&mut self, accessor: usize, index: usize, value: f32) -> &mut Self {
        self.patch(accessor, index * 4, &value.to_le_bytes())
    }

    /// Returns the fixture as a binary container.
    pub(crate) fn glb(&self) -> Vec<u8> {
        glb(self.json.to_string().as_bytes(), Some(&self.bin))
    }

    /// Returns the fixture as JSON with the buffer in it.
    pub(crate) fn gltf(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"][0]["uri"] =
            json!(format!("data:application/octet-stream;base64,{}", base64(&self.bin)));
        json.to_string().into_bytes()
    }

    /// Returns the fixture as JSON with the buffer in a file called `all.bin`.
    pub(crate) fn gltf_with_file(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"][0]["uri"] = json!("all.bin");
        json.to_string().into_bytes()
    }
}

/// Returns a container of the given chunks.
pub(crate) fn glb(json: &[u8], bin: Option<&[u8]>) -> Vec<u8> {
    let mut json = json.to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut file = chunk(b"JSON", &json);
    if let Some(bin) = bin {
        let mut bin = bin.to_vec();
        bin.resize(bin.len().next_multiple_of(4), 0);
        file.extend(chunk(b"BIN\0", &bin));
    }
    container(&file)
}

/// Returns a chunk: its length, its kind, its bytes.
pub(crate) fn chunk(kind: &[u8; 4], body: &[u8]) -> Vec<u8> {
    [&(body.len() as u32).to_le_bytes(), &kind[..], body].concat()
}

/// Returns a container: a header before the chunks.
pub(crate) fn container(chunks: &[u8]) -> Vec<u8> {
    [b"glTF", &2u32.to_le_bytes()[..], &(12 + chunks.len() as u32).to_le_bytes(), chunks].concat()
}

/// Returns the start of a PNG file of the given size, which is never decoded here.
pub(crate) fn png(width: u32, height: u32) -> Vec<u8> {
    let size = [width.to_be_bytes(), height.to_be_bytes()].concat();
    [b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", &size[..], b"\x08\x06\0\0\0\0\0\0\0\0\0\0"].concat()
}

fn push(list: &mut Value, value: Value) -> usize {
    let list = list.as_array_mut().unwrap();
    list.push(value);
    list.len() - 1
}

fn skeleton_of_json() -> Value {
    json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"name": "all", "nodes": [0, 3]}],
        "nodes": [
            {"name": "hip", "children": [1], "translation": [0, 1, 0]},
            {"name": "knee", "translation": [0, 1, 0], "rotation": [0, 0, 0, 1], "scale": [1, 1, 1], "children": [2]},
            {"name": "toe"},
            {"name": "body", "mesh": 0, "skin": 0, "weights": [0.25]}
        ],
        "meshes": [{"name": "square", "weights": [0], "extras": {"targetNames": ["up"]}, "primitives": [{
            "attributes": {"POSITION": 0, "NORMAL": 1, "TANGENT": 2, "TEXCOORD_0": 3, "COLOR_0": 4, "JOINTS_0": 5,
                           "WEIGHTS_0": 6},
            "indices": 7, "material": 0, "targets": [{"POSITION": 8, "NORMAL": 14}]}]}],
        "skins": [{"name": "skin", "joints": [0, 1], "inverseBindMatrices": 9}],
        "animations": [{
            "name": "wave",
            "samplers": [
                {"input": 10, "output": 11}, {"input": 10, "output": 12, "interpolation": "LINEAR"},
                {"input": 10, "output": 11, "interpolation": "STEP"}, {"input": 10, "output": 13},
                {"input": 10, "output": 15, "interpolation": "CUBICSPLINE"}],
            "channels": [
                {"sampler": 0, "target": {"node": 0, "path": "translation"}},
                {"sampler": 1, "target": {"node": 1, "path": "rotation"}},
                {"sampler": 2, "target": {"node": 1, "path": "translation"}},
                {"sampler": 3, "target": {"node": 3, "path": "weights"}},
                {"sampler": 4, "target": {"node": 1, "path": "scale"}}]}],
        "materials": [{
            "name": "skin", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0.5},
            "alphaMode": "MASK", "alphaCutoff": 0.5}],
        "textures": [{"source": 0, "sampler": 0}],
        "samplers": [{"magFilter": 9729, "minFilter": 9987, "wrapS": 33071, "wrapT": 10497}],
        "images": [{"name": "picture", "mimeType": "image/png"}],
        "buffers": [{"byteLength": 0}],
        "bufferViews": [],
        "accessors": []
    })
}

/// Base64 encoding, used by the tests in one place only.
mod base64_of {
    pub(crate) fn base64(bytes: &[u8]) -> String {
        const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        let mut text = String::new();
        for three in bytes.chunks(3) {
            let bits =
                three.iter().fold(0u32, |bits, &byte| bits << 8 | u32::from(byte)) << (8 * (3 - three.len()));
            for digit in 0..4 {
                let value = (bits >> (18 - 6 * digit)) as usize % 64;
                text.push(if digit <= three.len() { char::from(DIGITS[value]) } else { '=' });
            }
        }
        text
    }
}

#[test]
fn the_fixture_is_valid_in_each_form() {
    use crate::doors::MemoryFs;
    use dragonfly_anim::format::gltf::{GLB, GLTF};
    use dragonfly_anim::format::{ReadOptions, read};
    let fixture = Fixture::new();
    let door = MemoryFs::with(&[("all.bin", &fixture.bin)]);
    let read = |name, bytes: &[u8]| read(name, bytes, &door, &ReadOptions::default()).unwrap();
    let [binary, embedded, beside] = [
        read("a.glb", &fixture.glb()),
        read("a.gltf", &fixture.gltf()),
        read("a.gltf", &fixture.gltf_with_file()),
    ];
    assert_eq!(binary.warnings, []);
    assert_eq!(binary.model, embedded.model);
    assert_eq!(binary.model, beside.model);
    assert_eq!((binary.format, embedded.format), (GLB, GLTF));
    assert_eq!(door.asked(), ["all.bin"]);
    assert_eq!(crate::soundness::faults(&binary.model), [""; 0]);
    let model = binary.model;
    assert_eq!(
        model.animation.skeleton.bones.iter().map(|bone| bone.name.as_str()).collect::<Vec<_>>(),
        ["hip", "knee", "body"]
    );
    assert_eq!(model.meshes[0].primitives[0].morph_targets[0].name, "up");
    assert_eq!(model.instances[0].morph_weights, [0.25]);
    assert_eq!(model.animation.takes[0].morphs[0].instance, 0);
    assert_eq!((model.images[0].width, model.images[0].mime.as_str()), (2, "image/png"));
}
