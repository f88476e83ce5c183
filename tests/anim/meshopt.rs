//! Compressed buffer views: they decode to what meshoptimizer's own decoder computes, damaged ones are errors, and a save
//! keeps their bytes.

use crate::doors::data;
use crate::fixture::Fixture;
use crate::save_edits::shift;
use crate::save_support::{OpenedFile, bin_of};
use crate::soundness::faults;
use dragonfly_anim::data::ModelData;
use dragonfly_anim::format::gltf::save::MARK;
use dragonfly_anim::format::uri::DataUri;
use dragonfly_anim::format::{ImportError, NoFiles, ReadOptions, read};
use dragonfly_kit::mutate::Mutator;
use dragonfly_kit::random::seed;
use glam::Vec3;
use serde_json::{Value, json};

const EXTENSIONS: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// A view that meshoptimizer encoded, and the bytes that its decoder computes.
#[derive(Clone)]
struct Encoded {
    name: String,
    count: usize,
    stride: usize,
    mode: String,
    filter: String,
    encoded: Vec<u8>,
    decoded: Vec<u8>,
}

fn base64(text: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    DataUri::parse(&format!("data:;base64,{text}")).unwrap().unwrap().decode(&mut bytes).unwrap();
    bytes
}

fn stored() -> Vec<Encoded> {
    let text = std::fs::read(data().join("meshopt/encoded.json")).unwrap();
    let cases: Vec<Value> = serde_json::from_slice(&text).unwrap();
    let case = |case: &Value| {
        let text = |name: &str| case[name].as_str().unwrap().to_owned();
        Encoded {
            name: text("name"),
            count: case["count"].as_u64().unwrap() as usize,
            stride: case["stride"].as_u64().unwrap() as usize,
            mode: text("mode"),
            filter: text("filter"),
            encoded: base64(&text("encoded")),
            decoded: base64(&text("decoded")),
        }
    };
    cases.iter().map(case).collect()
}

impl Encoded {
    /// Returns a file with a take whose morph weights are the bytes of the view, each a key.
    fn file(&self, extension: &str) -> Fixture {
        let mut fixture = Fixture::new();
        let view = fixture.view(&self.encoded);
        let offset = fixture.json["bufferViews"][view]["byteOffset"].clone();
        let size = self.count * self.stride;
        let times: Vec<u8> = (0..size).flat_map(|key| (key as f32).to_le_bytes()).collect();
        let input = fixture.accessor("SCALAR", 5126, size, &times);
        let output = fixture.accessor("SCALAR", 5121, size, &[]);
        fixture.json["accessors"][output]["bufferView"] = json!(view);
        fixture.json["accessors"][output]["normalized"] = json!(true);
        fixture.set("/buffers/1", json!({"byteLength": size}));
        fixture.json["bufferViews"][view] = json!({
            "buffer": 1, "byteLength": size, "extensions": {extension: {
                "buffer": 0, "byteOffset": offset, "byteLength": self.encoded.len(), "byteStride": self.stride,
                "count": self.count, "mode": self.mode, "filter": self.filter}}});
        fixture.set("/extensionsUsed", json!([extension])).set("/extensionsRequired", json!([extension]));
        fixture.set("/animations/0/samplers/3", json!({"input": input, "output": output}));
        fixture
    }

    fn decode(&self, extension: &str) -> Result<Vec<u8>, ImportError> {
        let imported = read("a.glb", &self.file(extension).glb(), &NoFiles, &ReadOptions::default())?;
        assert_eq!(imported.warnings, [], "{}", self.name);
        let weights = &imported.model.animation.takes[0].morphs[0].weights;
        Ok(weights.iter().map(|weight| (weight * 255.0).round() as u8).collect())
    }
}

/// Returns the largest difference of two lists of numbers of `width` bytes.
fn difference(a: &[u8], b: &[u8], width: usize) -> i64 {
    assert_eq!(a.len(), b.len());
    let number = |bytes: &[u8]| match *bytes {
        [byte] => i64::from(byte as i8),
        [low, high] => i64::from(i16::from_le_bytes([low, high])),
        _ => panic!("numbers of one or two bytes"),
    };
    let difference = |(a, b)| {
        let difference: i64 = number(a) - number(b);
        // Unsigned numbers read as signed ones differ by all values at most.
        difference.abs().min((1 << (8 * width)) - difference.abs())
    };
    a.chunks(width).zip(b.chunks(width)).map(difference).max().unwrap()
}

#[test]
fn views_of_every_mode_and_filter_decode_as_meshoptimizer_decodes_them() {
    let cases = stored();
    assert!(cases.len() > 50);
    for case in &cases {
        for extension in EXTENSIONS {
            let decoded = case.decode(extension).unwrap_or_else(|error| panic!("{}: {error}", case.name));
            match case.filter.as_str() {
                "NONE" | "EXPONENTIAL" => assert!(decoded == case.decoded, "{}", case.name),
                // The extension allows a difference of one in the last place.
                _ => {
                    let width = if case.stride == 4 { 1 } else { 2 };
                    assert!(difference(&decoded, &case.decoded, width) <= 1, "{}", case.name);
                }
            }
        }
    }
    for (mode, filter) in [
        ("ATTRIBUTES", "OCTAHEDRAL"),
        ("ATTRIBUTES", "QUATERNION"),
        ("ATTRIBUTES", "EXPONENTIAL"),
        ("ATTRIBUTES", "COLOR"),
        ("TRIANGLES", "NONE"),
        ("INDICES", "NONE"),
    ] {
        assert!(cases.iter().any(|case| (&*case.mode, &*case.filter) == (mode, filter)), "{mode} {filter}");
    }
}

#[test]
fn compressed_data_that_is_cut_or_too_long_is_an_error_that_says_so() {
    for case in stored() {
        for cut in [1, case.encoded.len() / 2, case.encoded.len() - 1, case.encoded.len()] {
            let mut damaged = case.clone();
            damaged.encoded.truncate(case.encoded.len() - cut);
            let error = damaged.decode(EXTENSIONS[0]).unwrap_err();
            assert_eq!(error.code(), "MESHOPT_INVALID", "{} cut by {cut}: {error}", case.name);
            assert!(error.to_string().contains("/extensions/EXT_meshopt_compression"), "{error}");
        }
        let mut damaged = case.clone();
        let middle = case.encoded.len() / 2;
        damaged.encoded.splice(middle..middle, [0; 40]);
        // Zeros may be valid differences, but then bytes are left.
        assert!(damaged.decode(EXTENSIONS[1]).is_err(), "{}", case.name);
    }
}

#[test]
fn compressed_views_with_wrong_numbers_are_refused() {
    let case = &stored()[2];
    let fixture = case.file(EXTENSIONS[0]);
    let views = fixture.json["bufferViews"].as_array().unwrap();
    let number = views.iter().position(|view| view.get("extensions").is_some()).unwrap();
    let path = |name: &str| format!("/bufferViews/{number}/extensions/{}/{name}", EXTENSIONS[0]);
    for (name, value) in [
        ("buffer", json!(9)),
        ("buffer", json!(1)),
        ("byteOffset", json!(u64::MAX)),
        ("byteOffset", json!(1_u64 << 40)),
        ("byteLength", json!(u64::MAX)),
        ("byteLength", json!(-1)),
        ("byteStride", json!(0)),
        ("byteStride", json!(5)),
        ("byteStride", json!(260)),
        ("byteStride", json!(1_u64 << 63)),
        ("count", json!(0)),
        ("count", json!(u64::MAX)),
        ("count", json!("many")),
        ("mode", json!("TRIANGLES")),
        ("mode", json!("INDICES")),
        ("mode", json!("GUESS")),
        ("filter", json!("QUATERNION")),
        ("filter", json!("SEPIA")),
        ("filter", json!(3)),
    ] {
        let mut bad = fixture.clone();
        bad.set(&path(name), value.clone());
        assert!(read("a.glb", &bad.glb(), &NoFiles, &ReadOptions::default()).is_err(), "{name} {value}");
    }
    // A view of more memory than a file of this size may use.
    let mut bomb = fixture.clone();
    bomb.set(&path("count"), json!(1 << 28))
        .set(&format!("/bufferViews/{number}/byteLength"), json!(12_u64 << 28));
    let error = read("a.glb", &bomb.glb(), &NoFiles, &ReadOptions::default()).unwrap_err();
    assert!(matches!(error, ImportError::TooLarge { .. }), "{error}");
}

#[test]
fn no_damaged_compressed_view_panics() {
    let first = seed(8_801);
    println!("DRAGONFLY_SEED={first}");
    for case in stored() {
        let mut mutator = Mutator::new(first, &[b"\xff\xff\xff\xff\xff\xff", b"\0\0\0\0", b"\xf0\xfe\xff"]);
        for _ in 0..60 {
            let mut damaged = case.clone();
            damaged.encoded = mutator.mutant(std::slice::from_ref(&case.encoded));
            // Keep the version, so that most of them are decoded.
            if let Some(byte) = damaged.encoded.first_mut() {
                *byte = case.encoded[0];
            }
            if let Ok(imported) =
                read("a.glb", &damaged.file(EXTENSIONS[1]).glb(), &NoFiles, &ReadOptions::default())
            {
                assert_eq!(faults(&imported.model), [""; 0]);
            }
        }
    }
}

fn packed(name: &str) -> ModelData {
    OpenedFile::file(&data().join("meshopt").join(name)).0.model
}

/// Returns all positions, sorted, as meshoptimizer changes the order of vertices.
fn positions(model: &ModelData) -> Vec<Vec3> {
    let primitives = model.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let mut positions: Vec<Vec3> = primitives.flat_map(|it| it.vertices.positions.clone()).collect();
    positions.sort_by(|a, b| (a.x, a.y, a.z).partial_cmp(&(b.x, b.y, b.z)).unwrap());
    positions
}

#[test]
fn files_of_gltfpack_are_the_same_models_with_and_without_compression() {
    for name in ["SimpleSkin", "AnimatedMorphCube"] {
        let plain = packed(&format!("{name}_plain.glb"));
        for compressed in ["ext", "khr"].map(|kind| packed(&format!("{name}_{kind}.glb"))) {
            assert_eq!(positions(&plain), positions(&compressed), "{name}");
            assert_eq!(plain.animation.skeleton.len(), compressed.animation.skeleton.len());
            let takes = plain.animation.takes.iter().zip(&compressed.animation.takes);
            for (plain, compressed) in takes {
                assert_eq!(plain.keys(), compressed.keys());
                assert_eq!(plain.range_of_keys(), compressed.range_of_keys());
                for (a, b) in plain.tracks.iter().zip(&compressed.tracks) {
                    let pairs = a.rotation.values.iter().zip(b.rotation.values.iter());
                    pairs.for_each(|(a, b)| assert!(a.dot(*b).abs() > 0.999_999, "{a} {b}"));
                }
                for (a, b) in plain.morphs.iter().zip(&compressed.morphs) {
                    let pairs = a.weights.iter().zip(b.weights.iter());
                    pairs.for_each(|(a, b)| assert!((a - b).abs() < 0.005, "{a} {b}"));
                }
            }
        }
    }
}

#[test]
fn a_save_keeps_compressed_views_and_appends_edited_keys_uncompressed() {
    for name in ["SimpleSkin_ext.glb", "AnimatedMorphCube_khr.glb", "AnimatedMorphCube_ext.glb"] {
        let (opened, door) = OpenedFile::file(&data().join("meshopt").join(name));
        let before = opened.source.bytes();
        let mut takes = opened.takes();
        assert!(opened.saved(&takes, &door).bytes() == &before[..], "{name}: nothing was edited");
        match takes[0].take.morphs.is_empty() {
            false => shift(&mut takes, 0),
            true => {
                let take = std::sync::Arc::make_mut(&mut takes[0].take);
                let track = take.tracks.iter_mut().find(|track| !track.rotation.is_empty()).unwrap();
                let turned = track.rotation.values.iter().map(|q| *q * glam::Quat::from_rotation_x(0.1));
                track.rotation.values = turned.map(|q| q.normalize()).collect();
            }
        }
        // Compares all bytes but the announced ones, and the takes.
        let saved = opened.saved(&takes, &door);
        let (old, new) = (crate::save_support::json_of(before), saved.json());
        let views = old["bufferViews"].as_array().unwrap();
        assert_eq!(&new["bufferViews"].as_array().unwrap()[..views.len()], &views[..], "{name}");
        let added = &new["bufferViews"].as_array().unwrap()[views.len()..];
        assert!(!added.is_empty());
        for view in added {
            assert_eq!((&view["name"], &view["buffer"]), (&json!(MARK), &json!(0)));
            assert!(view.get("extensions").is_none());
        }
        assert!(bin_of(saved.bytes()).starts_with(&bin_of(before)), "{name}");
    }
}

#[test]
fn new_keys_are_not_appended_to_a_buffer_for_programs_without_the_extension() {
    let case = stored().into_iter().find(|case| case.name == "attributes v0 l2 37x12").unwrap();
    let mut fixture = case.file(EXTENSIONS[0]);
    fixture.set("/buffers/1/extensions", json!({EXTENSIONS[0]: {"fallback": true}}));
    // The first buffer is a file, so the fallback is the only data URI.
    let zeros = "A".repeat((case.count * case.stride).div_ceil(3) * 4);
    fixture.set("/buffers/1/uri", json!(format!("data:;base64,{zeros}")));
    let door = crate::doors::MemoryFs::with(&[("all.bin", &fixture.bin)]);
    let opened = OpenedFile::new("a.gltf", &fixture.gltf_with_file(), &door).unwrap();
    let mut takes = opened.takes();
    shift(&mut takes, 0);
    let saved = opened.saved(&takes, &door);
    let json = saved.json();
    assert_eq!(json["buffers"][1], fixture.json["buffers"][1]);
    let views = json["bufferViews"].as_array().unwrap();
    assert!(views.iter().filter(|view| view["name"] == MARK).all(|view| view["buffer"] == 2));
}
