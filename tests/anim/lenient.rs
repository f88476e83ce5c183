//! Files that break no rule are read, and what a file lacks matters only where something needs it.

use crate::doors::MemoryFs;
use crate::fixture::{Fixture, accessor};
use crate::save_edits::shift;
use crate::save_support::OpenedFile;
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::format::{ImportError, Imported, ReadOptions, Warning, read};
use dragonfly_kit::counting::peak;
use serde_json::{Value, json};
use std::sync::Arc;

fn imported(bytes: &[u8]) -> Result<Imported, ImportError> {
    read("a.gltf", bytes, &MemoryFs::default(), &ReadOptions::default())
}

fn codes(warnings: &[Warning]) -> Vec<&str> {
    warnings.iter().map(|warning| warning.code).collect()
}

/// Writes every whole number of the text as a fraction: `1` becomes `1.0`.
fn with_fractions(value: &Value) -> String {
    match value {
        Value::Number(number) if number.is_u64() => format!("{number}.0"),
        Value::Array(items) => {
            format!("[{}]", items.iter().map(with_fractions).collect::<Vec<_>>().join(","))
        }
        Value::Object(members) => {
            let member =
                |(name, value): (&String, &Value)| format!("{}:{}", json!(name), with_fractions(value));
            format!("{{{}}}", members.iter().map(member).collect::<Vec<_>>().join(","))
        }
        other => other.to_string(),
    }
}

#[test]
fn whole_numbers_may_be_written_with_a_fraction() {
    let fixture = Fixture::new();
    let json: Value = serde_json::from_slice(&fixture.gltf()).unwrap();
    let plain = imported(json.to_string().as_bytes()).unwrap();
    let text = with_fractions(&json);
    assert!(text.contains("\"mesh\":0.0") && text.contains("\"count\":4.0"));
    let read = imported(text.as_bytes()).unwrap();
    assert_eq!(read.model, plain.model);
    assert_eq!(read.warnings, plain.warnings);
    for number in ["5e-1", "0.5", "-1.0"] {
        let wrong = json.to_string().replacen("\"count\":4", &format!("\"count\":{number}"), 1);
        assert!(imported(wrong.as_bytes()).is_err(), "{number}");
    }
}

#[test]
fn a_file_with_fractions_is_saved_with_the_edits_and_keeps_the_rest() {
    let json: Value = serde_json::from_slice(&Fixture::new().gltf()).unwrap();
    let opened = OpenedFile::alone("a.gltf", with_fractions(&json).as_bytes());
    let mut takes = opened.takes();
    shift(&mut takes, 0);
    opened.saved(&takes, &MemoryFs::default());
}

#[test]
fn a_buffer_that_nothing_shown_needs_may_be_missing() {
    for buffer in [json!({"byteLength": 48}), json!({"byteLength": 48, "uri": "gone.bin"})] {
        let mut fixture = Fixture::new();
        fixture.json["buffers"].as_array_mut().unwrap().push(buffer.clone());
        let views = fixture.json["bufferViews"].as_array_mut().unwrap();
        views.push(json!({"buffer": 1, "byteOffset": 0, "byteLength": 48}));
        let view = views.len() - 1;
        let unneeded = imported(&fixture.glb()).unwrap();
        assert_eq!(unneeded.warnings.len(), 1, "{:?}", unneeded.warnings);

        let mut of_image = fixture.clone();
        of_image.set("/images/0/bufferView", json!(view));
        let of_image = imported(&of_image.glb()).unwrap();
        assert!(of_image.model.images[0].bytes.is_empty());
        assert!(codes(&of_image.warnings).contains(&"IMAGE_DATA_INVALID"), "{:?}", of_image.warnings);

        let mut of_mesh = fixture.clone();
        let accessors = of_mesh.json["accessors"].as_array_mut().unwrap();
        accessors.push(json!({"bufferView": view, "componentType": 5126, "type": "VEC3", "count": 4}));
        let positions = accessors.len() - 1;
        let mesh = json!({"name": "unused", "primitives": [{"attributes": {"POSITION": positions}}]});
        of_mesh.json["meshes"].as_array_mut().unwrap().push(mesh);
        let of_mesh = imported(&of_mesh.glb()).unwrap();
        assert_eq!(of_mesh.model.meshes.last().unwrap().name, "unused");
        assert_eq!(of_mesh.warnings.len(), 2, "{:?}", of_mesh.warnings);

        let mut of_skin = fixture.clone();
        let accessors = of_skin.json["accessors"].as_array_mut().unwrap();
        accessors.push(json!({"bufferView": view, "componentType": 5126, "type": "MAT4", "count": 1}));
        let matrices = accessors.len() - 1;
        let joint = of_skin.json["skins"][0]["joints"][0].clone();
        let skin = json!({"name": "unused", "joints": [joint], "inverseBindMatrices": matrices});
        of_skin.json["skins"].as_array_mut().unwrap().push(skin);
        let read = imported(&of_skin.glb()).unwrap();
        assert_eq!(read.warnings.len(), 2, "{:?}", read.warnings);
        let unused = read.model.skins.last().unwrap();
        assert_eq!((unused.name.as_str(), unused.offsets.len()), ("unused", 1));
        let evaluator = Evaluator::new(Arc::new(read.model.clone()));
        let at_rest = evaluator.to_root()[unused.bones[0] as usize] * unused.offsets[0];
        assert!(at_rest.abs_diff_eq(glam::Mat4::IDENTITY, 1e-5), "it deforms nothing at rest: {at_rest}");
        // The bones keep the matrices of the skin that is shown.
        assert_eq!(read.model.animation.skeleton, unneeded.model.animation.skeleton);
        let nodes = of_skin.json["nodes"].as_array_mut().unwrap();
        nodes.iter_mut().find(|node| node["skin"] == json!(0)).unwrap()["skin"] = json!(1);
        let error = imported(&of_skin.glb()).err().unwrap();
        assert!(error.to_string().contains(buffer["uri"].as_str().unwrap_or("/buffers/1")), "{error}");

        let mut needed = fixture.clone();
        needed.set(&format!("/accessors/{}/bufferView", accessor::POSITION), json!(view));
        let error = imported(&needed.glb()).err().unwrap();
        let name = buffer["uri"].as_str().unwrap_or("/buffers/1");
        assert!(error.to_string().contains(name), "{error}");
    }
}

#[test]
fn a_file_that_needs_a_later_version_is_refused() {
    let mut fixture = Fixture::new();
    for (least, is_read) in [("2.0", true), ("2.1", false), ("2.00", true), ("2.x", false), ("3.0", false)] {
        fixture.set("/asset/minVersion", json!(least));
        let read = imported(&fixture.glb());
        assert_eq!(read.is_ok(), is_read, "{least}");
        if let Err(error) = read {
            assert!(error.to_string().contains(least), "{error}");
        }
    }
}

#[test]
fn skins_that_are_the_same_are_read_once() {
    let mut fixture = Fixture::new();
    let alone = imported(&fixture.glb()).unwrap().model;
    let skin = fixture.json["skins"][0].clone();
    let skins = fixture.json["skins"].as_array_mut().unwrap();
    skins.extend([skin.clone(), skin.clone()]);
    let mut other = skin;
    other["name"] = json!("another");
    skins.push(other);
    let nodes = fixture.json["nodes"].as_array_mut().unwrap();
    let node = nodes.iter_mut().find(|node| node["skin"] == json!(0)).unwrap();
    node["skin"] = json!(2);
    let read = imported(&fixture.glb()).unwrap().model;
    assert_eq!(read.skins.len(), 2);
    assert_eq!((&read.skins[0], &read.instances), (&alone.skins[0], &alone.instances));
}

#[test]
fn thousands_of_skins_stay_within_the_memory_of_their_file() {
    for is_named in [false, true] {
        let mut fixture = Fixture::new();
        let joint = fixture.json["skins"][0]["joints"][0].clone();
        let skin = |number: usize| {
            let joints = vec![joint.clone(); 2_000];
            match is_named {
                true => json!({"joints": joints, "name": number.to_string()}),
                false => json!({"joints": joints}),
            }
        };
        let skins: Vec<Value> = (0..2_500).map(skin).collect();
        fixture.json["skins"].as_array_mut().unwrap().extend(skins);
        let bytes = fixture.glb();
        let promise = (256 << 20) + 32 * bytes.len() as u64;
        let (memory, bones) = peak(|| {
            let model = imported(&bytes).ok()?.model;
            Some(Evaluator::new(Arc::new(model)).to_root().len())
        });
        println!("{} bytes: {memory} of {promise}", bytes.len());
        assert!(memory <= promise, "{memory} of {promise}");
        assert!(is_named || (bones.is_some() && memory < promise / 2), "{memory} {bones:?}");
    }
}
