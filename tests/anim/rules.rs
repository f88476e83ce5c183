//! Every rule of the importer has a file that breaks only this rule, and the error or warning contains the rule.

use crate::doors::MemoryFs;
use crate::fixture::{Fixture, accessor, chunk, container, glb, png};
use crate::soundness::{faults, faults_of_poses};
use dragonfly_anim::format::gltf::check::{CHECKS, Consequence};
use dragonfly_anim::format::{ReadOptions, read};
use serde_json::json;

/// How a file that breaks a rule is made.
enum Bad {
    /// By a change of the valid fixture.
    Edit(fn(&mut Fixture)),
    /// As bytes that do not come from the fixture.
    Raw(fn() -> Vec<u8>),
}

use Bad::{Edit, Raw};
use Consequence::{Refuse, Warn};

/// Rule, expected result, and a file that breaks it.
const BAD: &[(&str, Consequence, Bad)] = &[
    ("GLB_UNEXPECTED_END_OF_HEADER", Refuse, Raw(|| b"glTF\x02\0\0\0".to_vec())),
    ("GLB_INVALID_MAGIC", Refuse, Raw(|| b"PK\x03\x04 a zip archive".to_vec())),
    ("GLB_LENGTH_TOO_SMALL", Refuse, Raw(|| b"glTF\x02\0\0\0\x0b\0\0\0________".to_vec())),
    ("GLB_LENGTH_MISMATCH", Refuse, Raw(|| [b"glTF\x02\0\0\0\xff\0\0\0", &[0; 8][..]].concat())),
    ("GLB_LENGTH_MISMATCH", Warn, Raw(|| [Fixture::new().glb(), vec![0; 4]].concat())),
    ("GLB_UNEXPECTED_END_OF_CHUNK_HEADER", Refuse, Raw(|| container(&[1, 2, 3]))),
    ("GLB_UNEXPECTED_END_OF_CHUNK_HEADER", Refuse, Raw(|| container(&[]))),
    ("GLB_CHUNK_TOO_BIG", Refuse, Raw(|| container(b"\xff\0\0\0JSON{}  "))),
    ("GLB_UNEXPECTED_FIRST_CHUNK", Refuse, Raw(|| container(&chunk(b"BIN\0", &[0; 4])))),
    ("GLB_EMPTY_CHUNK", Refuse, Raw(|| container(&chunk(b"JSON", b"")))),
    (
        "GLB_CHUNK_LENGTH_UNALIGNED",
        Warn,
        Raw(|| container(&chunk(b"JSON", br#"{"asset":{"version":"2.0"}} "#[..27].as_ref()))),
    ),
    ("GLB_DUPLICATE_CHUNK", Warn, Raw(|| with_chunk(b"JSON"))),
    ("GLB_UNEXPECTED_BIN_CHUNK", Warn, Raw(|| with_chunk(b"BIN\0"))),
    ("GLB_UNKNOWN_CHUNK_TYPE", Warn, Raw(|| with_chunk(b"XYZ!"))),
    ("INVALID_JSON", Refuse, Raw(|| br#"{"asset":{"version":"2.0"},}"#.to_vec())),
    ("INVALID_JSON", Refuse, Raw(|| b"{\"asset\":\xff}".to_vec())),
    ("INVALID_JSON", Refuse, Raw(|| br#"{"asset":{"version":"2.0""#.to_vec())),
    ("TYPE_MISMATCH", Refuse, Edit(|f| _ = f.set("/nodes/0/children", json!("1")))),
    ("TYPE_MISMATCH", Refuse, Edit(|f| _ = f.set("/accessors/0/count", json!(-4)))),
    ("UNDEFINED_PROPERTY", Refuse, Edit(|f| _ = f.remove("/accessors/0/count"))),
    ("UNDEFINED_PROPERTY", Refuse, Edit(|f| _ = f.remove("/images/0/bufferView"))),
    ("DUPLICATE_PROPERTY", Refuse, Raw(|| br#"{"asset":{"version":"2.0","version":"2.0"}}"#.to_vec())),
    ("INVALID_INDEX", Refuse, Edit(|f| _ = f.set("/nodes/3/mesh", json!(4_294_967_296_u64)))),
    ("INVALID_INDEX", Refuse, Edit(|f| _ = f.set("/accessors/0/componentType", json!(4_294_972_422_u64)))),
    ("VALUE_NOT_IN_RANGE", Refuse, Edit(|f| _ = f.set("/nodes/0/scale", json!([1e39, 1, 1])))),
    ("VALUE_NOT_IN_RANGE", Refuse, Edit(|f| _ = f.set("/nodes/3/weights", json!([1e39])))),
    ("VALUE_NOT_IN_RANGE", Refuse, Edit(|f| _ = f.set("/materials/0/emissiveFactor", json!([0, 1e39, 0])))),
    ("VALUE_NOT_IN_LIST", Refuse, Edit(|f| _ = f.set("/accessors/0/type", json!("VEC5")))),
    ("VALUE_NOT_IN_LIST", Refuse, Edit(|f| _ = f.set("/meshes/0/primitives/0/mode", json!(7)))),
    (
        "VALUE_NOT_IN_LIST",
        Warn,
        Edit(|f| _ = f.set("/animations/0/samplers/0/interpolation", json!("CUBIC"))),
    ),
    ("VALUE_NOT_IN_LIST", Warn, Edit(|f| _ = f.set("/materials/0/alphaMode", json!("GLASS")))),
    ("UNRESOLVED_REFERENCE", Refuse, Edit(|f| _ = f.set("/nodes/3/mesh", json!(9)))),
    ("UNRESOLVED_REFERENCE", Refuse, Edit(|f| _ = f.set("/nodes/3/skin", json!(9)))),
    ("UNRESOLVED_REFERENCE", Refuse, Edit(|f| _ = f.set("/nodes/3/camera", json!(9)))),
    ("UNRESOLVED_REFERENCE", Refuse, Edit(|f| _ = f.set("/nodes/0/children", json!([99])))),
    ("UNRESOLVED_REFERENCE", Refuse, Edit(|f| _ = f.set("/scenes/0/nodes", json!([99])))),
    ("UNRESOLVED_REFERENCE", Warn, Edit(|f| _ = f.set("/scene", json!(9)))),
    ("UNRESOLVED_REFERENCE", Refuse, Edit(|f| _ = f.set("/skins/0/joints/1", json!(99)))),
    ("UNRESOLVED_REFERENCE", Refuse, Edit(|f| _ = f.set("/skins/0/inverseBindMatrices", json!(99)))),
    (
        "UNRESOLVED_REFERENCE",
        Refuse,
        Edit(|f| _ = f.set("/meshes/0/primitives/0/attributes/NORMAL", json!(99))),
    ),
    ("UNRESOLVED_REFERENCE", Refuse, Edit(|f| _ = f.set("/meshes/0/primitives/0/material", json!(99)))),
    (
        "UNRESOLVED_REFERENCE",
        Refuse,
        Edit(|f| _ = f.set("/meshes/0/primitives/0/targets/0/POSITION", json!(99))),
    ),
    ("UNRESOLVED_REFERENCE", Refuse, Edit(|f| _ = f.set("/accessors/0/bufferView", json!(99)))),
    (
        "UNRESOLVED_REFERENCE",
        Refuse,
        Edit(|f| _ = f.set("/accessors/14/sparse/values/bufferView", json!(99))),
    ),
    ("UNRESOLVED_REFERENCE", Refuse, Edit(|f| _ = f.set("/bufferViews/0/buffer", json!(99)))),
    ("UNRESOLVED_REFERENCE", Refuse, Edit(|f| _ = f.set("/textures/0/source", json!(99)))),
    ("UNRESOLVED_REFERENCE", Refuse, Edit(|f| _ = f.set("/textures/0/sampler", json!(99)))),
    ("UNRESOLVED_REFERENCE", Refuse, Edit(|f| _ = f.set("/images/0/bufferView", json!(99)))),
    ("UNRESOLVED_REFERENCE", Refuse, Edit(|f| _ = f.set("/animations/0/channels/0/sampler", json!(99)))),
    ("UNRESOLVED_REFERENCE", Refuse, Edit(|f| _ = f.set("/animations/0/channels/0/target/node", json!(99)))),
    ("UNRESOLVED_REFERENCE", Refuse, Edit(|f| _ = f.set("/animations/0/samplers/0/input", json!(99)))),
    (
        "UNRESOLVED_REFERENCE",
        Refuse,
        Edit(|f| {
            _ = f.set("/materials/0/pbrMetallicRoughness/baseColorTexture/index", json!(99));
        }),
    ),
    ("EMPTY_ENTITY", Refuse, Edit(|f| _ = f.set("/skins/0/joints", json!([])))),
    ("EMPTY_ENTITY", Warn, Edit(|f| _ = f.set("/animations/0/channels", json!([])))),
    ("EMPTY_ENTITY", Warn, Edit(|f| _ = f.set("/meshes/1", json!({"primitives": []})))),
    ("DUPLICATE_ELEMENTS", Warn, Edit(|f| _ = f.set("/skins/0/joints", json!([0, 0])))),
    ("UNSUPPORTED_EXTENSION", Warn, Edit(|f| _ = f.set("/extensionsUsed", json!(["EXT_unheard_of"])))),
    ("UNSUPPORTED_EXTENSION", Refuse, Edit(|f| _ = f.set("/extensionsRequired", json!(["EXT_unheard_of"])))),
    ("UNSUPPORTED_EXTENSION", Refuse, Edit(|f| _ = f.set("/asset/version", json!("1.0")))),
    ("UNSUPPORTED_EXTENSION", Refuse, Edit(|f| _ = f.set("/asset/minVersion", json!("3.0")))),
    (
        "DRACO_INVALID",
        Refuse,
        Edit(|f| {
            let object = json!({"bufferView": 0, "attributes": {"POSITION": 0}});
            f.set("/meshes/0/primitives/0/extensions", json!({"KHR_draco_mesh_compression": object}));
            f.remove("/accessors/0/bufferView");
        }),
    ),
    (
        "VRM_INVALID",
        Warn,
        Edit(|f| {
            let humanoid = json!({"humanBones": {"hips": {"node": 99}}});
            f.set("/extensions/VRMC_vrm", json!({"humanoid": humanoid}));
        }),
    ),
    (
        "MESHOPT_INVALID",
        Refuse,
        Edit(|f| {
            let object =
                json!({"buffer": 0, "byteLength": 1, "byteStride": 4, "count": 12, "mode": "ATTRIBUTES"});
            f.set("/bufferViews/0/extensions", json!({"EXT_meshopt_compression": object}));
        }),
    ),
    ("BUFFER_BYTE_LENGTH_MISMATCH", Refuse, Edit(|f| _ = f.set("/buffers/0/byteLength", json!(1_u64 << 40)))),
    ("BUFFER_GLB_CHUNK_TOO_BIG", Warn, Edit(|f| f.bin.extend([0; 8]))),
    ("BUFFER_MISSING_GLB_DATA", Warn, Edit(|f| _ = f.set("/buffers/1", json!({"byteLength": 4})))),
    (
        "BUFFER_MISSING_GLB_DATA",
        Refuse,
        Edit(|f| {
            f.set("/buffers/1", json!({"byteLength": 4})).set("/bufferViews/0/buffer", json!(1));
        }),
    ),
    ("INVALID_URI", Refuse, Edit(|f| _ = f.set("/buffers/0/uri", json!("../all.bin")))),
    ("INVALID_URI", Refuse, Edit(|f| _ = f.set("/buffers/0/uri", json!("data:;base64,!!!!")))),
    ("IO_ERROR", Refuse, Edit(|f| _ = f.set("/buffers/0/uri", json!("missing.bin")))),
    ("BUFFER_VIEW_TOO_LONG", Refuse, Edit(|f| _ = f.set("/bufferViews/0/byteLength", json!(1 << 20)))),
    ("BUFFER_VIEW_TOO_LONG", Refuse, Edit(|f| _ = f.set("/bufferViews/0/byteOffset", json!(u64::MAX)))),
    ("BUFFER_VIEW_INVALID_BYTE_STRIDE", Warn, Edit(|f| _ = f.set("/bufferViews/0/byteStride", json!(0)))),
    ("ACCESSOR_TOO_LONG", Refuse, Edit(|f| _ = f.set("/accessors/0/count", json!(5)))),
    ("ACCESSOR_TOO_LONG", Refuse, Edit(|f| _ = f.set("/accessors/0/count", json!(u64::MAX)))),
    ("ACCESSOR_TOO_LONG", Refuse, Edit(|f| _ = f.set("/accessors/0/byteOffset", json!(u64::MAX - 3)))),
    ("ACCESSOR_TOO_LONG", Refuse, Edit(|f| _ = f.set("/bufferViews/0/byteStride", json!(252)))),
    ("ACCESSOR_SMALL_BYTESTRIDE", Refuse, Edit(|f| _ = f.set("/bufferViews/0/byteStride", json!(4)))),
    (
        "ACCESSOR_OFFSET_ALIGNMENT",
        Warn,
        Edit(|f| {
            f.set("/accessors/10/byteOffset", json!(2)).set("/bufferViews/10/byteLength", json!(14));
            f.patch(accessor::TIMES, 2, &[0; 12]).patch(accessor::TIMES, 8, &1f32.to_le_bytes());
        }),
    ),
    ("ACCESSOR_NORMALIZED_INVALID", Warn, Edit(|f| _ = f.set("/accessors/0/normalized", json!(true)))),
    (
        "ACCESSOR_SPARSE_COUNT_OUT_OF_RANGE",
        Refuse,
        Edit(|f| _ = f.set("/accessors/14/sparse/count", json!(5))),
    ),
    ("ACCESSOR_SPARSE_INDEX_OOB", Refuse, Edit(|f| sparse_indices(f, [1, 4]))),
    ("ACCESSOR_SPARSE_INDICES_NON_INCREASING", Warn, Edit(|f| sparse_indices(f, [2, 2]))),
    ("ACCESSOR_INVALID_FLOAT", Refuse, Edit(|f| _ = f.float(accessor::POSITION, 4, f32::NAN))),
    ("ACCESSOR_INVALID_FLOAT", Refuse, Edit(|f| _ = f.float(accessor::NORMAL, 0, f32::INFINITY))),
    ("ACCESSOR_INVALID_FLOAT", Refuse, Edit(|f| _ = f.float(accessor::TIMES, 1, f32::NAN))),
    ("ACCESSOR_INVALID_FLOAT", Refuse, Edit(|f| _ = f.float(accessor::ROTATIONS, 1, f32::NAN))),
    ("ACCESSOR_INVALID_FLOAT", Refuse, Edit(|f| _ = f.float(accessor::OFFSETS, 1, f32::NAN))),
    (
        "MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT",
        Refuse,
        Edit(|f| {
            _ = f.set("/meshes/0/primitives/0/attributes/JOINTS_0", json!(accessor::WEIGHTS));
        }),
    ),
    (
        "MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT",
        Refuse,
        Edit(|f| {
            _ = f.set("/meshes/0/primitives/0/attributes/POSITION", json!(accessor::COLOR));
        }),
    ),
    ("MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT", Refuse, Edit(|f| _ = f.set("/accessors/1/count", json!(3)))),
    (
        "MESH_PRIMITIVE_INVALID_ATTRIBUTE",
        Warn,
        Edit(|f| {
            _ = f.set("/meshes/0/primitives/0/attributes/COLOUR_0", json!(accessor::COLOR));
        }),
    ),
    (
        "MESH_PRIMITIVE_NO_POSITION",
        Warn,
        Edit(|f| _ = f.remove("/meshes/0/primitives/0/attributes/POSITION")),
    ),
    (
        "MESH_PRIMITIVE_JOINTS_WEIGHTS_MISMATCH",
        Warn,
        Edit(|f| {
            _ = f.remove("/meshes/0/primitives/0/attributes/WEIGHTS_0");
        }),
    ),
    (
        "MESH_PRIMITIVE_INDICES_ACCESSOR_INVALID_FORMAT",
        Refuse,
        Edit(|f| {
            _ = f.set("/meshes/0/primitives/0/indices", json!(accessor::TIMES));
        }),
    ),
    ("ACCESSOR_INDEX_OOB", Refuse, Edit(|f| _ = f.patch(accessor::INDICES, 2, &[4, 0]))),
    ("ACCESSOR_INDEX_OOB", Refuse, Edit(|f| _ = f.patch(accessor::INDICES, 2, &[255, 255]))),
    ("MESH_PRIMITIVE_INCOMPATIBLE_MODE", Warn, Edit(|f| _ = f.set("/accessors/7/count", json!(5)))),
    ("MESH_PRIMITIVE_MODE_NOT_SHOWN", Warn, Edit(|f| _ = f.set("/meshes/0/primitives/0/mode", json!(1)))),
    (
        "MESH_PRIMITIVE_MORPH_TARGET_INVALID_ATTRIBUTE_COUNT",
        Refuse,
        Edit(|f| {
            _ = f.set("/accessors/8/count", json!(3));
        }),
    ),
    (
        "MESH_PRIMITIVES_UNEQUAL_TARGETS_COUNT",
        Warn,
        Edit(|f| {
            _ = f.set("/meshes/0/primitives/1", json!({"attributes": {"POSITION": 0}}));
        }),
    ),
    ("MESH_INVALID_WEIGHTS_COUNT", Warn, Edit(|f| _ = f.set("/meshes/0/weights", json!([0, 1])))),
    ("ACCESSOR_VECTOR3_NON_UNIT", Warn, Edit(|f| _ = f.float(accessor::NORMAL, 2, 2.0))),
    ("ACCESSOR_VECTOR3_NON_UNIT", Warn, Edit(|f| _ = f.float(accessor::TANGENT, 0, 0.0))),
    ("ACCESSOR_INVALID_SIGN", Warn, Edit(|f| _ = f.float(accessor::TANGENT, 3, 0.5))),
    ("ACCESSOR_NON_CLAMPED", Warn, Edit(|f| _ = f.float(accessor::COLOR, 1, 1.5))),
    ("ACCESSOR_WEIGHTS_NEGATIVE", Warn, Edit(|f| _ = f.float(accessor::WEIGHTS, 1, -0.25))),
    ("ACCESSOR_WEIGHTS_NON_NORMALIZED", Warn, Edit(|f| _ = f.float(accessor::WEIGHTS, 1, 0.5))),
    ("ACCESSOR_WEIGHTS_ZERO", Warn, Edit(|f| _ = f.patch(accessor::WEIGHTS, 16, &[0; 16]))),
    ("ACCESSOR_JOINTS_INDEX_DUPLICATE", Warn, Edit(|f| _ = f.patch(accessor::JOINTS, 0, &[1]))),
    ("ACCESSOR_JOINTS_INDEX_OOB", Refuse, Edit(|f| _ = f.patch(accessor::JOINTS, 1, &[2]))),
    ("HUGE_TRANSLATION", Warn, Edit(|f| _ = f.set("/nodes/0/translation", json!([2e12, 0, 0])))),
    ("HUGE_TRANSLATION", Warn, Edit(|f| _ = f.float(accessor::POSITION, 0, 2e12))),
    ("HUGE_TRANSLATION", Warn, Edit(|f| _ = f.float(accessor::TRANSLATIONS, 0, -2e12))),
    ("SKIN_IBM_INVALID_FORMAT", Refuse, Edit(|f| _ = f.set("/skins/0/inverseBindMatrices", json!(0)))),
    ("INVALID_IBM_ACCESSOR_COUNT", Refuse, Edit(|f| _ = f.set("/accessors/9/count", json!(1)))),
    ("ACCESSOR_INVALID_IBM", Warn, Edit(|f| _ = f.float(accessor::OFFSETS, 0, 0.0))),
    ("ACCESSOR_INVALID_IBM", Warn, Edit(|f| _ = f.float(accessor::OFFSETS, 15, 2.0))),
    ("NODE_LOOP", Refuse, Edit(|f| _ = f.set("/nodes/2/children", json!([2])))),
    (
        "NODE_LOOP",
        Refuse,
        Edit(|f| {
            f.set("/nodes/2/children", json!([0])).set("/scenes/0/nodes", json!([3]));
        }),
    ),
    ("NODE_PARENT_OVERRIDE", Refuse, Edit(|f| _ = f.set("/nodes/3/children", json!([2])))),
    (
        "NODE_MATRIX_TRS",
        Warn,
        Edit(|f| {
            _ = f.set("/nodes/0/matrix", json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]));
        }),
    ),
    (
        "NODE_MATRIX_NON_TRS",
        Warn,
        Edit(|f| {
            _ = f.set("/nodes/2/matrix", json!([1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]));
        }),
    ),
    (
        "NODE_MATRIX_NON_TRS",
        Warn,
        Edit(|f| {
            _ = f.set("/nodes/2/matrix", json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2]));
        }),
    ),
    ("ROTATION_NON_UNIT", Warn, Edit(|f| _ = f.set("/nodes/1/rotation", json!([0, 0, 0, 1.1])))),
    (
        "TRANSFORM_OVERFLOW",
        Refuse,
        Edit(|f| {
            f.set("/nodes/0/scale", json!([1e30, 1, 1])).set("/nodes/1/scale", json!([1e30, 1, 1]));
        }),
    ),
    (
        "NODE_SKIN_WITH_NON_SKINNED_MESH",
        Warn,
        Edit(|f| {
            f.remove("/meshes/0/primitives/0/attributes/JOINTS_0")
                .remove("/meshes/0/primitives/0/attributes/WEIGHTS_0");
        }),
    ),
    ("NODE_WEIGHTS_INVALID", Warn, Edit(|f| _ = f.set("/nodes/3/weights", json!([0, 1])))),
    ("SCENE_NON_ROOT_NODE", Warn, Edit(|f| _ = f.set("/scenes/0/nodes", json!([0, 1, 3])))),
    ("NODE_NOT_IN_SCENE", Warn, Edit(|f| _ = f.set("/scenes/0/nodes", json!([0])))),
    (
        "CAMERA_NOT_SHOWN",
        Warn,
        Edit(|f| {
            f.set("/cameras", json!([{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}]));
            f.set("/nodes/2/camera", json!(0));
        }),
    ),
    (
        "ANIMATION_SAMPLER_INPUT_ACCESSOR_INVALID_FORMAT",
        Refuse,
        Edit(|f| {
            _ = f.set("/animations/0/samplers/0/input", json!(accessor::INDICES));
        }),
    ),
    (
        "ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_FORMAT",
        Refuse,
        Edit(|f| {
            _ = f.set("/animations/0/samplers/0/output", json!(accessor::ROTATIONS));
        }),
    ),
    (
        "ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_COUNT",
        Refuse,
        Edit(|f| {
            _ = f.set("/animations/0/samplers/0/interpolation", json!("CUBICSPLINE"));
        }),
    ),
    ("ACCESSOR_ANIMATION_INPUT_NEGATIVE", Warn, Edit(|f| _ = f.float(accessor::TIMES, 0, -1.0))),
    ("ACCESSOR_ANIMATION_INPUT_NON_INCREASING", Warn, Edit(|f| _ = f.float(accessor::TIMES, 1, 1.0))),
    (
        "ACCESSOR_ANIMATION_SAMPLER_OUTPUT_NON_NORMALIZED_QUATERNION",
        Warn,
        Edit(|f| {
            _ = f.float(accessor::ROTATIONS, 3, 1.1);
        }),
    ),
    ("ANIMATION_TANGENT_NOT_FINITE", Warn, Edit(|f| _ = f.float(accessor::CUBIC, 0, f32::NAN))),
    (
        "ANIMATION_DUPLICATE_TARGETS",
        Warn,
        Edit(|f| {
            _ = f.set("/animations/0/channels/0/target/node", json!(1));
        }),
    ),
    (
        "ANIMATION_CHANNEL_TARGET_NODE_MATRIX",
        Warn,
        Edit(|f| {
            f.remove("/nodes/0/translation");
            f.set("/nodes/0/matrix", json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]));
        }),
    ),
    (
        "ANIMATION_CHANNEL_TARGET_NODE_WEIGHTS_NO_MORPHS",
        Warn,
        Edit(|f| {
            _ = f.set("/animations/0/channels/3/target/node", json!(2));
        }),
    ),
    (
        "ANIMATION_CHANNEL_TARGET_UNKNOWN",
        Warn,
        Edit(|f| {
            _ = f.set("/animations/0/channels/0/target", json!({"path": "pointer"}));
        }),
    ),
    (
        "ANIMATION_CHANNEL_TARGET_UNKNOWN",
        Warn,
        Edit(|f| {
            _ = f.remove("/animations/0/channels/0/target/node");
        }),
    ),
    (
        "IMAGE_DATA_INVALID",
        Warn,
        Edit(|f| {
            f.remove("/images/0/bufferView").set("/images/0/uri", json!("missing.png"));
        }),
    ),
    (
        "IMAGE_DATA_INVALID",
        Warn,
        Edit(|f| {
            let view = f.view(b"neither one nor the other");
            f.set("/images/0/bufferView", json!(view));
        }),
    ),
    (
        "IMAGE_TOO_LARGE",
        Warn,
        Edit(|f| {
            let view = f.view(&png(11_000, 11_000));
            f.set("/images/0/bufferView", json!(view));
        }),
    ),
    ("IMAGE_MIME_TYPE_INVALID", Warn, Edit(|f| _ = f.set("/images/0/mimeType", json!("image/jpeg")))),
    ("TEXTURE_NO_SOURCE", Warn, Edit(|f| _ = f.remove("/textures/0/source"))),
    (
        "TEXTURE_COORDINATES",
        Warn,
        Edit(|f| {
            _ = f.set("/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord", json!(2));
        }),
    ),
];

/// Returns the valid container with one more chunk.
fn with_chunk(kind: &[u8; 4]) -> Vec<u8> {
    container(&[&Fixture::new().glb()[12..], &chunk(kind, b"{}  ")].concat())
}

fn sparse_indices(fixture: &mut Fixture, indices: [u16; 2]) {
    let view =
        fixture.json["accessors"][accessor::SPARSE]["sparse"]["indices"]["bufferView"].as_u64().unwrap();
    let at = fixture.json["bufferViews"][view as usize]["byteOffset"].as_u64().unwrap() as usize;
    fixture.bin[at..at + 4].copy_from_slice(&indices.map(u16::to_le_bytes).concat());
}

/// Returns what is wrong with the result of a bad file; `None` if it contains `code` and is what `expected` requires.
fn complaint(code: &str, expected: Consequence, bytes: &[u8]) -> Option<String> {
    let name = if bytes.starts_with(b"{") { "bad.gltf" } else { "bad.glb" };
    match (read(name, bytes, &MemoryFs::default(), &ReadOptions::default()), expected) {
        (Err(error), Refuse) if error.code() == code => None,
        (Ok(imported), Warn) if imported.warnings.iter().any(|warning| warning.code == code) => {
            let mut faults = faults(&imported.model);
            faults.extend(faults_of_poses(imported.model));
            if faults.is_empty() { None } else { Some(format!("read, but {}", faults.join(", "))) }
        }
        (Err(error), _) => Some(format!("refused as {}: {error}", error.code())),
        (Ok(imported), _) => Some(format!("read with {:?}", imported.warnings)),
    }
}

#[test]
fn each_broken_rule_is_reported_with_its_code() {
    let mut complaints = Vec::new();
    for (number, (code, expected, bad)) in BAD.iter().enumerate() {
        let bytes = match bad {
            Raw(make) => make(),
            Edit(edit) => {
                let mut fixture = Fixture::new();
                edit(&mut fixture);
                glb(fixture.json.to_string().as_bytes(), Some(&fixture.bin))
            }
        };
        complaints.extend(complaint(code, *expected, &bytes).map(|c| format!("{number} {code}: {c}")));
    }
    println!("{} files that break {} rules", BAD.len(), CHECKS.len());
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn each_rule_has_a_file_that_breaks_it() {
    assert!(CHECKS.len() >= 60, "{}", CHECKS.len());
    for check in CHECKS {
        let answers: Vec<Consequence> =
            BAD.iter().filter(|bad| bad.0 == check.code).map(|bad| bad.1).collect();
        let needed: &[Consequence] = match check.answer {
            Refuse => &[Refuse],
            Warn => &[Warn],
            Consequence::Either => &[Refuse, Warn],
        };
        let all = needed.iter().all(|needed| answers.contains(needed));
        assert!(all && answers.iter().all(|answer| needed.contains(answer)), "{}: {answers:?}", check.code);
        assert!(!check.meaning.is_empty());
    }
    for (code, ..) in BAD {
        assert!(CHECKS.iter().any(|check| check.code == *code), "{code} is not a rule");
    }
}
