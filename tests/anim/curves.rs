//! Tables of curves have every key, and every number is read again as the same number.

use crate::support::{animation_data, bone};
use dragonfly_anim::data::{
    Channel, Interpolation, Mesh, MeshInstance, ModelData, MorphTarget, MorphTrack, Primitive, Take,
    TakeExtras, Track,
};
use dragonfly_anim::format::{CURVES_CSV, CURVES_JSON, Format, Formats, NoFiles, ReadOptions, TABLES};
use glam::{Mat4, Quat, Vec3};
use serde_json::Value;
use std::sync::Arc;

/// The name of a bone that has every character that divides a table.
const NAME: &str = "left,\n\"hand\"";

/// Returns two bones and a mesh with two shape keys, and keys of every kind with numbers that are hard to write.
fn model() -> ModelData {
    let hard = [0.1, -0.0, 1e-7, 16_777_217.0, -1.0 / 3.0, f32::MIN_POSITIVE];
    let vector = |at: usize| Vec3::new(hard[at % 6], hard[(at + 1) % 6], hard[(at + 2) % 6]);
    let turn = |at: usize| Quat::from_xyzw(hard[at % 6], hard[(at + 3) % 6], 0.7, -0.1);
    let mut tracks: Vec<Track> = (0..2).map(|bone| Track { bone, ..Track::default() }).collect();
    tracks[0].translation = Channel::new([0.0, 0.1, 7.0 / 3.0], [0, 1, 2].map(vector), Interpolation::Linear);
    tracks[0].scale = Channel::new([0.25], [vector(3)], Interpolation::Step);
    tracks[1].rotation = Channel::new([0.1, 0.3], [0, 1, 2, 3, 4, 5].map(turn), Interpolation::CubicSpline);
    let morphs = vec![MorphTrack {
        instance: 0,
        targets: 2,
        times: [0.0, 1.0].into(),
        weights: hard[..4].to_vec().into(),
        interpolation: Interpolation::Closest,
    }];
    let mut extras = TakeExtras::default();
    extras.set("events", Some("[]".into()));
    let take = Take { name: "a, b".to_owned(), start: 0.0, length: 7.0 / 3.0, tracks, morphs, extras };
    let target = |name: &str| MorphTarget { name: name.to_owned(), ..MorphTarget::default() };
    let morph_targets = vec![target("smile"), target("")];
    let primitive = Primitive { morph_targets, ..Primitive::default() };
    let mesh = Mesh { name: "face".to_owned(), primitives: vec![primitive], morph_weights: vec![0.0; 2] };
    ModelData {
        meshes: vec![mesh],
        instances: vec![MeshInstance {
            mesh: 0,
            node: None,
            skin: None,
            bone: None,
            to_bone: Mat4::IDENTITY,
            morph_weights: vec![0.0; 2],
        }],
        animation: animation_data(
            vec![bone("hips", None, Vec3::ZERO), bone(NAME, Some(0), Vec3::Y)],
            vec![take],
        ),
        ..ModelData::default()
    }
}

fn written(model: &ModelData, format: &Format) -> (String, Vec<String>) {
    let plan = format.export.unwrap()(model, "curves").unwrap();
    assert_eq!(plan.files.len(), 1);
    let lost = plan.lost.iter().map(ToString::to_string).collect();
    (String::from_utf8(plan.files[0].bytes.clone()).unwrap(), lost)
}

/// Splits a text into rows of fields, by the rules of RFC 4180.
fn table(text: &str) -> Vec<Vec<String>> {
    let (mut rows, mut row, mut field) = (Vec::new(), Vec::new(), String::new());
    let (mut characters, mut is_quoted) = (text.chars().peekable(), false);
    while let Some(character) = characters.next() {
        match (character, is_quoted) {
            ('"', true) if characters.peek() == Some(&'"') => field.extend(characters.next()),
            ('"', _) => is_quoted = !is_quoted,
            (',', false) => row.push(std::mem::take(&mut field)),
            ('\r', false) => {
                assert_eq!(characters.next(), Some('\n'));
                row.push(std::mem::take(&mut field));
                rows.push(std::mem::take(&mut row));
            }
            _ => field.push(character),
        }
    }
    assert!(field.is_empty() && row.is_empty(), "the last row ends");
    rows
}

/// A number of a key: object, its index and name, property, component, interpolation, and the bits of time, value and tangents.
type KeyNumber = (String, usize, String, String, String, String, [Option<u32>; 4]);

/// Returns the numbers of the model's only take, in the order of a table.
fn expected(model: &ModelData) -> Vec<KeyNumber> {
    let mut all = Vec::new();
    let mut add =
        |object: (&str, usize, &str), property: &str, names: &[&str], kind, times: &[f32], flat: &[f32]| {
            let parts = if kind == Interpolation::CubicSpline { 3 } else { 1 };
            let word = match kind {
                Interpolation::Step => "step",
                Interpolation::Linear => "linear",
                Interpolation::CubicSpline => "cubic",
                Interpolation::Closest => "closest",
            };
            for (key, time) in times.iter().enumerate() {
                for (at, name) in names.iter().enumerate() {
                    let number = |part: usize| flat[(key * parts + part) * names.len() + at].to_bits();
                    let numbers = match parts {
                        3 => [Some(time.to_bits()), Some(number(1)), Some(number(0)), Some(number(2))],
                        _ => [Some(time.to_bits()), Some(number(0)), None, None],
                    };
                    let texts = [object.2, property, name, word].map(str::to_owned);
                    let [name, property, component, word] = texts;
                    all.push((object.0.to_owned(), object.1, name, property, component, word, numbers));
                }
            }
        };
    let take = &model.animation.takes[0];
    for (index, (track, bone)) in take.tracks.iter().zip(&model.animation.skeleton.bones).enumerate() {
        let object = ("bone", index, bone.name.as_str());
        let flat = |channel: &Channel<Vec3>| -> Vec<f32> {
            channel.values.iter().flat_map(|value| value.to_array()).collect()
        };
        let (moved, scaled) = (&track.translation, &track.scale);
        let turned: Vec<f32> = track.rotation.values.iter().flat_map(|value| value.to_array()).collect();
        add(object, "translation", &["x", "y", "z"], moved.interpolation, &moved.times, &flat(moved));
        let rotation = &track.rotation;
        add(object, "rotation", &["x", "y", "z", "w"], rotation.interpolation, &rotation.times, &turned);
        add(object, "scale", &["x", "y", "z"], scaled.interpolation, &scaled.times, &flat(scaled));
    }
    let morph = &take.morphs[0];
    let object = ("mesh", 0, "face");
    add(object, "weights", &["smile", "1"], morph.interpolation, &morph.times, &morph.weights);
    all
}

#[test]
fn a_table_of_curves_has_every_number_of_every_key() {
    let model = model();
    let (text, lost) = written(&model, &CURVES_CSV);
    let rows = table(&text);
    let head = "take,object,index,name,property,component,time,value,interpolation,in_tangent,out_tangent";
    assert_eq!(rows[0].join(","), head);
    let number = |text: &String| (!text.is_empty()).then(|| text.parse::<f32>().unwrap().to_bits());
    let read: Vec<KeyNumber> = rows[1..]
        .iter()
        .map(|row| {
            assert_eq!((row.len(), row[0].as_str()), (11, "a, b"));
            let [object, name, property, component, word] = [1, 3, 4, 5, 8].map(|column| row[column].clone());
            let numbers = [6, 7, 9, 10].map(|column| number(&row[column]));
            (object, row[2].parse().unwrap(), name, property, component, word, numbers)
        })
        .collect();
    assert_eq!(read, expected(&model));
    assert_eq!(
        lost,
        [
            "/: only curves are stored: no rest poses, meshes, skins, materials and images",
            "/animation/takes/0/extras: layers, contacts and events are not stored",
        ]
    );
}

#[test]
fn a_tree_of_curves_has_the_same_numbers() {
    let model = model();
    let (text, _) = written(&model, &CURVES_JSON);
    let json: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(json["dragonfly_curves"], 1);
    let take = &json["takes"][0];
    assert_eq!((&take["name"], &take["start"]), (&Value::from("a, b"), &Value::from(0.0)));
    let mut read: Vec<KeyNumber> = Vec::new();
    let bits = |value: &Value| (value.as_f64().unwrap() as f32).to_bits();
    let mut add = |object: (&str, &Value), property: &str, names: &[&str], curve: &Value| {
        for (key, time) in curve["times"].as_array().unwrap().iter().enumerate() {
            for (at, name) in names.iter().enumerate() {
                let number = |list: &str| curve.get(list).map(|list| bits(&list[key][at]));
                let numbers =
                    [Some(bits(time)), number("values"), number("in_tangents"), number("out_tangents")];
                let own = |value: &Value| value.as_str().unwrap().to_owned();
                read.push((
                    object.0.to_owned(),
                    object.1["index"].as_u64().unwrap() as usize,
                    own(&object.1["name"]),
                    property.to_owned(),
                    (*name).to_owned(),
                    own(&curve["interpolation"]),
                    numbers,
                ));
            }
        }
    };
    for bone in take["bones"].as_array().unwrap() {
        for (property, names) in [
            ("translation", &["x", "y", "z"][..]),
            ("rotation", &["x", "y", "z", "w"]),
            ("scale", &["x", "y", "z"]),
        ] {
            if let Some(curve) = bone.get(property) {
                add(("bone", bone), property, names, curve);
            }
        }
    }
    let mesh = &take["meshes"][0];
    assert_eq!(mesh["shape_keys"], serde_json::json!(["smile", ""]));
    add(("mesh", mesh), "weights", &["smile", "1"], &mesh["weights"]);
    assert_eq!(read, expected(&model));
}

#[test]
fn tables_are_written_and_not_taken_for_models() {
    for format in TABLES {
        assert!(format.export.is_some() && !format.is_writable());
        let bytes = written(&model(), format).0.into_bytes();
        for name in ["curves.csv", "curves.json"] {
            assert!(
                Formats::builtin().read(name, &bytes, &NoFiles, &ReadOptions::default()).is_err(),
                "{name}"
            );
        }
        assert!(format.import(&bytes, &NoFiles, &ReadOptions::default()).is_err());
        let error = format.export.unwrap()(&ModelData::default(), "a").unwrap_err();
        assert!(error.to_string().contains("the model has no take"), "{error}");
        let mut unmoved = model();
        unmoved.animation.takes = vec![Arc::new(Take::default())];
        assert!(written(&unmoved, format).1.len() == 1);
    }
}
