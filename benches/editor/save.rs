//! Time until an edit is answered while a large file is saved.

use dragonfly_document::edit::{BonePose, BoneRef, Edit, SetPose, TakeRef};
use dragonfly_document::{DocumentMessage, DocumentReply, SaveOrder};
use dragonfly_kit::document::test_document::TestDocument;
use dragonfly_kit::figures::FigureBench;
use dragonfly_kit::folder::Folder;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

const BONES: usize = 200;
const KEYS: usize = 30_000;

/// Writes a GLB with one take of 200 bones, each with rotations and translations of its own.
fn write_model(path: &Path) {
    let mut bytes: Vec<u8> = Vec::new();
    let (mut views, mut accessors) = (Vec::new(), Vec::new());
    let mut add = |values: &mut dyn Iterator<Item = f32>, kind: &str| {
        let begin = bytes.len();
        values.for_each(|value| bytes.extend(value.to_le_bytes()));
        views.push(json!({"buffer": 0, "byteOffset": begin, "byteLength": bytes.len() - begin}));
        accessors
            .push(json!({"bufferView": views.len() - 1, "componentType": 5126, "count": KEYS, "type": kind}));
        accessors.len() - 1
    };
    let times = add(&mut (0..KEYS).map(|key| key as f32 / 60.0), "SCALAR");
    let (mut samplers, mut channels, mut nodes) = (Vec::new(), Vec::new(), Vec::new());
    for bone in 0..BONES {
        let angle = |key: usize| (0.3 * (key as f32 * 0.01 + bone as f32).sin()).sin_cos();
        let rotations = add(
            &mut (0..KEYS).flat_map(|key| {
                let (sine, cosine) = angle(key);
                [0.0, 0.0, sine, cosine]
            }),
            "VEC4",
        );
        let places = add(&mut (0..KEYS).flat_map(|key| [key as f32 * 1e-4, 0.1, 0.0]), "VEC3");
        for (output, path) in [(rotations, "rotation"), (places, "translation")] {
            channels.push(json!({"sampler": samplers.len(), "target": {"node": bone, "path": path}}));
            samplers.push(json!({"input": times, "output": output}));
        }
        let children: Vec<usize> =
            [2 * bone + 1, 2 * bone + 2].into_iter().filter(|&child| child < BONES).collect();
        let mut node = json!({"name": format!("bone {bone}"), "translation": [0.0, 0.1, 0.0]});
        if !children.is_empty() {
            node["children"] = json!(children);
        }
        nodes.push(node);
    }
    accessors[times]["min"] = json!([0.0]);
    accessors[times]["max"] = json!([(KEYS - 1) as f32 / 60.0]);
    let document = json!({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": nodes,
        "buffers": [{"byteLength": bytes.len()}], "bufferViews": views, "accessors": accessors,
        "animations": [{"name": "long", "samplers": samplers, "channels": channels}],
    });
    fs::write(path, glb(&document, &bytes)).expect("a folder of this bench");
}

fn glb(document: &Value, bytes: &[u8]) -> Vec<u8> {
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let length = 12 + 8 + text.len() + 8 + bytes.len();
    let mut out = b"glTF".to_vec();
    let word = |out: &mut Vec<u8>, number: usize| out.extend((number as u32).to_le_bytes());
    word(&mut out, 2);
    word(&mut out, length);
    word(&mut out, text.len());
    out.extend(b"JSON");
    out.extend(text);
    word(&mut out, bytes.len());
    out.extend(b"BIN\0");
    out.extend(bytes);
    out
}

fn pose(angle: f32) -> Edit {
    let (sine, cosine) = (angle / 2.0).sin_cos();
    let pose = BonePose {
        bone: BoneRef::Index(7),
        translation: None,
        rotation: Some([0.0, 0.0, sine, cosine]),
        scale: None,
    };
    Edit::SetPose(SetPose { take: TakeRef::Index(0), time: 0.5, poses: vec![pose], unstep: false })
}

/// Sends one edit and returns the milliseconds until its view has arrived.
fn answered(document: &mut TestDocument, steps: usize) -> f64 {
    let begin = Instant::now();
    document.edit(pose(steps as f32 * 0.001));
    document.wait_for_view(|view| view.history.done == steps);
    milliseconds(begin.elapsed())
}

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

/// Sends an edit and waits for its view.
fn edit(document: &mut TestDocument, json: &str) -> f64 {
    let edit: Edit = serde_json::from_str(json).expect(json);
    let steps = document.view().history.done + 1;
    let begin = Instant::now();
    document.edit(edit);
    document.wait_for_view(|view| view.history.done == steps);
    milliseconds(begin.elapsed())
}

/// Saves, and returns the milliseconds until that is answered.
fn saved(document: &mut TestDocument) -> f64 {
    let begin = Instant::now();
    document.send(DocumentMessage::Save(SaveOrder::own(None)));
    while !document.has_reply(|reply| match reply {
        DocumentReply::NotSaved(_, reason) => panic!("{reason:?}"),
        reply => matches!(reply, DocumentReply::Saved(_)),
    }) {
        std::thread::park_timeout(Duration::from_millis(1));
    }
    milliseconds(begin.elapsed())
}

/// Measures edits and saves of keys of the take, and of the three keys of a layer over it, in turns.
fn layer(bench: &mut FigureBench, folder: &Folder, path: &Path) {
    let open = |name: &str| {
        let copy = folder.join(&format!("{name}.glb"));
        fs::copy(path, &copy).expect("a folder of this bench");
        let mut document = TestDocument::new(&folder.join(&format!("autosave-{name}")));
        document.open(&copy);
        document
    };
    let (mut plain, mut layered) = (open("plain"), open("layered"));
    edit(&mut layered, r#"{"edit":"add_layer","take":0,"name":"Turn"}"#);
    let key = |take: &str, time: f64, turn: usize| {
        let (sine, cosine) = (0.3 + turn as f64 * 0.01).sin_cos();
        format!(
            r#"{{"edit":"set","take":{take},"time":{time},"poses":[{{"bone":7,"rotation":[0,0,{sine},{cosine}]}}]}}"#
        )
    };
    let mut times = [(); 4].map(|()| Vec::new());
    for round in 0..6 {
        for (which, document, take) in [(0, &mut plain, "0"), (2, &mut layered, r#"{"take":0,"layer":0}"#)] {
            for time in [100.0, 250.0, 400.0] {
                times[which].push(edit(document, &key(take, time, round)));
            }
            times[which + 1].push(saved(document));
        }
    }
    for (times, (task, variant)) in times.iter().zip([
        ("three keys", "edit in the take"),
        ("three keys", "save of the take"),
        ("three keys", "edit in a layer"),
        ("three keys", "save with the layer"),
    ]) {
        bench.times(task, variant, times);
    }
}

/// Measures edits without a save, and during a save of the model.
pub(crate) fn all(bench: &mut FigureBench) {
    let folder = Folder::new("bench-save");
    let path = folder.join("long.glb");
    write_model(&path);
    let size = fs::metadata(&path).map_or(0, |file| file.len()) as f64;
    bench.value("file", "", "size", "bytes", size);
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    let mut steps = 0;
    let mut next = |document: &mut TestDocument| {
        steps += 1;
        answered(document, steps)
    };
    let quiet: Vec<f64> = (0..200).map(|_| next(&mut document)).collect();
    bench.times("edit", "without a save", &quiet);
    for variant in ["first save", "second save"] {
        let begin = Instant::now();
        document.send(DocumentMessage::Save(SaveOrder::own(None)));
        let mut during = Vec::new();
        while !document.has_reply(|reply| match reply {
            DocumentReply::NotSaved(_, reason) => panic!("{reason:?}"),
            reply => matches!(reply, DocumentReply::Saved(_)),
        }) {
            during.push(next(&mut document));
        }
        bench.value("save", variant, "time", "ms", milliseconds(begin.elapsed()));
        bench.times("edit", variant, &during);
    }
    drop(document);
    layer(bench, &folder, &path);
}
