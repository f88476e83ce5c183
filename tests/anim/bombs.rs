//! Small files that made other readers panic, hang, or allocate gigabytes: each gets a clear result with little memory.

use crate::doors::MemoryFs;
use crate::fixture::{Fixture, accessor, glb, png};
use crate::trial::{on_small_stack, time_for};
use dragonfly_anim::format::{ImportError, Place, ReadOptions, read};
use dragonfly_kit::counting::peak;
use serde_json::json;
use std::time::Instant;

/// Memory limit for all of them.
const MOST_MEMORY: u64 = 300 << 20;

/// A document with `members` in addition to the asset.
fn document(members: &str) -> Vec<u8> {
    format!(r#"{{"asset":{{"version":"2.0"}},{members}}}"#).into_bytes()
}

fn edited(edit: impl FnOnce(&mut Fixture)) -> Vec<u8> {
    let mut fixture = Fixture::new();
    edit(&mut fixture);
    glb(fixture.json.to_string().as_bytes(), Some(&fixture.bin))
}

/// Positions in an accessor that has no bytes of its own except for one sparse element.
fn sparse_of(count: u64) -> Vec<u8> {
    edited(|fixture| {
        fixture.set("/accessors/14/count", json!(count));
        fixture.set("/meshes/0/primitives", json!([{"attributes": {"POSITION": accessor::SPARSE}}]));
    })
}

fn chain(length: usize) -> String {
    let nodes: Vec<String> = (1..length).map(|child| format!(r#"{{"children":[{child}]}}"#)).collect();
    format!(r#""nodes":[{},{{}}]"#, nodes.join(","))
}

/// Files that must be refused: name, bytes, part of the message.
fn refused() -> Vec<(&'static str, Vec<u8>, &'static str)> {
    let format = |accessor: usize, component: u32| {
        edited(|fixture| _ = fixture.set(&format!("/accessors/{accessor}/componentType"), json!(component)))
    };
    let dag: Vec<String> = (1..31).map(|child| format!(r#"{{"children":[{child},{child}]}}"#)).collect();
    vec![
        (
            "accessor out of range",
            document(r#""meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]"#),
            "POSITION: the index 0 is out of range",
        ),
        ("image of nothing", document(r#""images":[{}]"#), "/images/0: an image needs"),
        (
            "image view too long",
            edited(|f| {
                let view = f.view(&png(1, 1));
                f.set(&format!("/bufferViews/{view}/byteLength"), json!(1 << 20))
                    .set("/images/0/bufferView", json!(view));
            }),
            "do not fit into a buffer",
        ),
        ("uri not UTF-8", document(r#""buffers":[{"uri":"%ff%fe.bin","byteLength":4}]"#), "not UTF-8"),
        ("container shorter than its header", b"glTF\x02\0\0\0\x04\0\0\0\0\0\0\0JSON".to_vec(), "byte 8"),
        (
            "four million nodes",
            document(&format!(r#""nodes":[{}{{}}]"#, "{},".repeat(3_999_999))),
            "/nodes: nodes: 1000001",
        ),
        (
            "a million materials",
            document(&format!(r#""materials":[{}{{}}]"#, "{},".repeat(999_999))),
            "bytes of memory needed",
        ),
        ("float indices", format(accessor::INDICES, 5126), "/accessors/7"),
        ("float joints", format(accessor::JOINTS, 5126), "JOINTS_0"),
        ("32-bit joints", format(accessor::JOINTS, 5125), "JOINTS_0"),
        ("32-bit weights", format(accessor::WEIGHTS, 5125), "WEIGHTS_0"),
        ("32-bit rotations", format(accessor::ROTATIONS, 5125), "/samplers/1/output"),
        ("32-bit morph weights", format(accessor::MORPH_WEIGHTS, 5125), "/samplers/3/output"),
        (
            "stride 4 for three floats",
            edited(|f| _ = f.set("/bufferViews/0/byteStride", json!(4))),
            "stride 4",
        ),
        (
            "stride 7 for three floats",
            edited(|f| _ = f.set("/bufferViews/0/byteStride", json!(7))),
            "stride 7",
        ),
        (
            "sparse values too few",
            edited(|f| _ = f.set("/accessors/14/sparse/count", json!(3))),
            "/accessors/14/sparse/values",
        ),
        ("sparse, 200 million", sparse_of(200_000_000), "/accessors/14/count"),
        ("sparse, 2^40", sparse_of(1 << 40), "/accessors/14/count"),
        ("own child", document(r#""nodes":[{"children":[0]}]"#), "its own child"),
        ("two-cycle", document(r#""nodes":[{"children":[1]},{"children":[0]}]"#), "own ancestor"),
        ("200,000 deep", document(&chain(200_000)), "levels of nodes: 513"),
        (
            "2^30 paths",
            document(&format!(r#""nodes":[{},{{}}]"#, dag.join(","))),
            "a child of node 0 already",
        ),
        ("count 2^62", edited(|f| _ = f.set("/accessors/0/count", json!(1_u64 << 62))), "do not fit"),
        ("count 2^64-1", edited(|f| _ = f.set("/accessors/0/count", json!(u64::MAX))), "do not fit"),
        (
            "view offset 2^64-1",
            edited(|f| _ = f.set("/bufferViews/0/byteOffset", json!(u64::MAX))),
            "do not fit into a buffer",
        ),
        ("count 0", edited(|f| _ = f.set("/accessors/0/count", json!(0))), "0 vertices"),
        (
            "uri leaves the folder",
            document(r#""buffers":[{"uri":"../../../etc/hostname","byteLength":4}]"#),
            "leaves the folder",
        ),
        (
            "uri leaves the folder, encoded",
            document(r#""buffers":[{"uri":"%2e%2e%2fhostname","byteLength":4}]"#),
            "may not be encoded",
        ),
        ("uri absolute", document(r#""buffers":[{"uri":"/etc/hostname","byteLength":4}]"#), "absolute"),
        (
            "uri with a scheme",
            document(r#""buffers":[{"uri":"file:///etc/hostname","byteLength":4}]"#),
            "schemes",
        ),
        ("uri of a device", document(r#""buffers":[{"uri":"/dev/zero","byteLength":4}]"#), "absolute"),
        (
            "JSON 100,000 deep",
            document(&format!(r#""extras":{}{}"#, "[".repeat(100_000), "]".repeat(100_000))),
            "levels of arrays and objects: 65",
        ),
        ("number 1e999", document(r#""nodes":[{"scale":[1e999,1,1]}]"#), "/nodes/0/scale/0"),
        (
            "buffer of 2^60",
            document(r#""buffers":[{"uri":"data:,","byteLength":1152921504606846976}]"#),
            "byteLength is 1152921504606846976",
        ),
        (
            "missing animation target",
            edited(|f| _ = f.set("/animations/0/channels/0/target/node", json!(77))),
            "the index 77 is out of range",
        ),
    ]
}

/// Files that may be read, with little memory: name, bytes, part of a warning.
fn read_in_spite() -> Vec<(&'static str, Vec<u8>, &'static str)> {
    let picture = png(2500, 2500);
    vec![
        ("image without type", edited(|f| _ = f.remove("/images/0/mimeType")), ""),
        (
            "60 images with one source",
            edited(|f| {
                let view = f.view(&picture);
                f.set("/images", json!(vec![json!({"bufferView": view, "mimeType": "image/png"}); 60]));
            }),
            "",
        ),
        (
            "4 images of 121 megapixels",
            edited(|f| {
                let view = f.view(&png(11_000, 11_000));
                f.set("/images", json!(vec![json!({"bufferView": view, "mimeType": "image/png"}); 4]));
            }),
            "too many",
        ),
    ]
}

/// A chain of nodes, and a mesh below each of its nodes, which must be traced to the root.
fn broom() -> Vec<u8> {
    let chain: Vec<String> = (1..500).map(|child| format!(r#"{{"children":[{child}]}}"#)).collect();
    let leaves: Vec<String> = (500..100_500).map(|leaf| leaf.to_string()).collect();
    let meshes = vec![r#"{"mesh":0}"#; 100_000].join(",");
    let nodes = format!(r#"{},{{"children":[{}]}},{meshes}"#, chain[..499].join(","), leaves.join(","));
    document(&format!(r#""meshes":[{{"primitives":[{{"attributes":{{}}}}]}}],"nodes":[{nodes}]"#))
}

/// A hundred sets of joints for each of many vertices.
fn many_joints() -> Vec<u8> {
    edited(|f| {
        let vertices = 16_000;
        let joints: Vec<u8> = (0..vertices * 4).flat_map(|number| (number as u16).to_le_bytes()).collect();
        let positions = f.accessor("VEC3", 5126, vertices, &vec![0; vertices * 12]);
        let joints = f.accessor("VEC4", 5123, vertices, &joints);
        let weights = f.accessor("VEC4", 5121, vertices, &vec![9; vertices * 4]);
        f.set(&format!("/accessors/{weights}/normalized"), json!(true));
        let mut attributes = json!({"POSITION": positions});
        for set in 0..100 {
            attributes[format!("JOINTS_{set}")] = json!(joints);
            attributes[format!("WEIGHTS_{set}")] = json!(weights);
        }
        f.set("/meshes/1", json!({"primitives": [{"attributes": attributes}]}));
    })
}

#[test]
fn work_is_linear_in_the_size_of_the_file() {
    assert_eq!(
        answer(broom()),
        Ok(vec!["/meshes/0/primitives/0: the primitive has no positions and stays empty".to_owned()])
    );
    assert!(answer(many_joints()).is_ok());
}

/// Returns the warnings of reading a file, with limits on memory and time, on a small stack.
fn answer(bytes: Vec<u8>) -> Result<Vec<String>, ImportError> {
    let run = move || {
        let size = bytes.len();
        let start = Instant::now();
        let door = MemoryFs::default();
        let (memory, result) = peak(|| read("bomb.gltf", &bytes, &door, &ReadOptions::default()));
        assert!(memory < MOST_MEMORY, "{memory} bytes");
        assert!(start.elapsed() < 2 * time_for(size), "{:?}", start.elapsed());
        assert_eq!(door.asked(), [""; 0]);
        result.map(|imported| {
            assert!(imported.model.images.len() <= 1, "one source is one image");
            imported.warnings.iter().map(ToString::to_string).collect()
        })
    };
    on_small_stack(run).join().unwrap_or_else(|_| panic!("panicked or exceeded a limit"))
}

#[test]
fn every_bomb_is_refused_with_a_place_and_a_reason() {
    let bombs = refused();
    assert!(bombs.len() >= 30);
    for (name, bytes, reason) in bombs {
        let error = answer(bytes).map(|warnings| panic!("{name}: read with {warnings:?}")).unwrap_err();
        let message = error.to_string();
        println!("{name}: {message}");
        assert!(message.contains(reason), "{name}: {message}");
        assert!(*error.place() != Place::File && message.len() < 400, "{name}: {message}");
    }
}

#[test]
fn images_above_the_limits_are_left_out() {
    for (name, bytes, reason) in read_in_spite() {
        let warnings = answer(bytes).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(warnings.is_empty(), reason.is_empty(), "{name}: {warnings:?}");
        assert!(warnings.iter().all(|warning| warning.contains(reason)), "{name}: {warnings:?}");
    }
}
