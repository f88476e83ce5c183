//! Other programs check the saved files: the `gltf` crate always; the Khronos validator and three.js if they are
//! installed.
//!
//! The two need node, and a folder with `validate.mjs`, `ref_gltf.mjs` and their packages: that named by
//! `DRAGONFLY_EVALUATORS`.

use crate::doors::{MemoryFs, data};
use crate::fixture::{Fixture, accessor};
use crate::made::rotation;
use crate::save_edits::{moving_track, shift};
use crate::save_support::{OpenedFile, Over, ReopenedFile, json_of, take_mut};
use dragonfly_anim::data::{Channel, Interpolation, Track};
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::format::gltf::save::{MARK, compact};
use dragonfly_anim::format::{AssetFs, EditedTake, NoFiles, OutputFile};
use dragonfly_kit::random::Random;
use dragonfly_kit::skip;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::panic::catch_unwind;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;

/// Returns the result of the `gltf` crate's own check; `None` for files that make it panic.
fn crate_result(bytes: &[u8]) -> Option<Result<(), String>> {
    catch_unwind(|| gltf::Gltf::from_slice(bytes).map(|_| ()).map_err(|error| error.to_string())).ok()
}

/// Checks that the crate accepts or refuses both files.
#[track_caller]
pub(crate) fn crate_has_the_same_result(before: &[u8], after: &[u8], name: &str) {
    if let (Some(before), Some(after)) = (crate_result(before), crate_result(after)) {
        assert_eq!(before, after, "{name}");
    }
}

/// Returns edited files: name, bytes before the edit, bytes after it.
fn edited() -> Vec<(String, Vec<u8>, Vec<u8>)> {
    let fixture = Fixture::new();
    let folder = data().join("gltf");
    let read = |name: &str| std::fs::read(folder.join(name)).unwrap();
    let mut sources =
        vec![("Fixture.glb".to_owned(), fixture.glb()), ("Fixture.gltf".to_owned(), fixture.gltf())];
    for name in [
        "Fox.glb",
        "AnimatedMorphCube.glb",
        "InterpolationTest.glb",
        "AnimatedTriangle_embedded.gltf",
        "SimpleMorph_embedded.gltf",
        "SimpleSkin_embedded.gltf",
        "box_sparse.glb",
    ] {
        sources.push((name.to_owned(), read(name)));
    }
    for path in crate::doors::model_files()
        .iter()
        .filter(|path| path.extension().is_some_and(|ending| ending == "glb"))
    {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if sources.iter().all(|(known, _)| *known != name) {
            sources.push((name, std::fs::read(path).unwrap()));
        }
    }
    let mut files = Vec::new();
    for (name, bytes) in sources {
        let [saved, twice] = edited_twice(&OpenedFile::alone(&name, &bytes), &NoFiles);
        let compacted = compact(&twice.opened.source).unwrap().write().remove(0).bytes;
        for (what, after) in crate::root_bone::root_added_and_removed(&name, &bytes) {
            files.push((format!("{what}-{name}"), bytes.clone(), after));
        }
        files.push((format!("once-{name}"), bytes.clone(), saved.bytes().to_vec()));
        files.push((format!("twice-{name}"), bytes.clone(), twice.bytes().to_vec()));
        files.push((format!("compacted-{name}"), bytes, compacted));
    }
    files
}

/// Saves edits of a file, and again after some of them were removed.
pub(crate) fn edited_twice(opened: &OpenedFile, door: &dyn AssetFs) -> [ReopenedFile; 2] {
    let bones = opened.model.animation.skeleton.len();
    let mut takes = opened.takes();
    if !takes.is_empty() && takes[0].take.tracks.iter().any(|track| !track.translation.is_empty()) {
        shift(&mut takes, 0);
    }
    if bones > 0 {
        // The node of a skinned mesh is not supposed to be animated.
        let nodes = &opened.model.animation.skeleton.bones;
        let skinned = |bone: u32| {
            let mut skinned = opened.model.instances.iter().filter(|instance| instance.skin.is_some());
            skinned.any(|instance| instance.node == nodes[bone as usize].node)
        };
        let track = |bone| match skinned(bone) {
            true => Track { bone, ..Track::default() },
            false => Track { bone, ..moving_track() },
        };
        let tracks = (0..bones as u32).map(track).collect();
        takes.push(EditedTake { origin: None, take: Arc::new(crate::support::take(tracks)) });
    }
    for take in &mut takes {
        let take = Arc::make_mut(&mut take.take);
        if let Some(track) = take.tracks.first_mut() {
            let turns = [0.0, 0.1, 0.0, 0.2, 0.3, 0.1].map(glam::Quat::from_rotation_x);
            track.rotation = Channel::new([0.0, 1.0], turns, Interpolation::CubicSpline);
            if !track.translation.is_empty() {
                let places = [glam::Vec3::X, glam::Vec3::Z];
                track.translation = Channel::new([0.05, 0.95], places, Interpolation::Linear);
            }
            track.scale = Channel::new([0.1, 0.9], [glam::Vec3::ONE; 2], Interpolation::Linear);
        }
    }
    let saved = opened.saved(&takes, door);
    // Some of the edits are removed again, also key times that precede others.
    let mut takes = saved.opened.takes();
    if let Some(track) = takes.last_mut().and_then(|take| Arc::make_mut(&mut take.take).tracks.first_mut()) {
        track.translation = Channel::default();
    }
    let twice = saved.opened.saved(&takes, &Over::new(&saved.files, door));
    [saved, twice]
}

#[test]
fn the_gltf_crate_accepts_a_saved_file_if_it_accepted_the_original() {
    let mut judged = 0;
    for (name, before, after) in edited() {
        crate_has_the_same_result(&before, &after, &name);
        judged += usize::from(crate_result(&before) == Some(Ok(())));
    }
    println!("{judged} files judged");
    assert!(judged > 10);
}

/// A rule of a sampler in a file: the rule, and whether a sampler of a document breaks it.
type SamplerRule = (&'static str, fn(&Value, &Value) -> bool);

const SAMPLER_RULES: &[SamplerRule] = &[
    ("there are times and values", |sampler, json| {
        ["input", "output"].iter().any(|name| accessor_of(sampler, json, name).is_null())
    }),
    ("times are float scalars", |sampler, json| {
        let times = accessor_of(sampler, json, "input");
        times["componentType"] != 5126 || times["type"] != "SCALAR"
    }),
    ("times have a range", |sampler, json| {
        let times = accessor_of(sampler, json, "input");
        times["min"].is_null() || times["max"].is_null()
    }),
    ("there is a time, and two for a spline", |sampler, json| {
        let times = accessor_of(sampler, json, "input")["count"].as_u64().unwrap_or(0);
        times < if is_spline(sampler) { 2 } else { 1 }
    }),
    ("there is a value for each time, and two tangents for a spline", |sampler, json| {
        let [times, values] = ["input", "output"].map(|name| accessor_of(sampler, json, name));
        let each = times["count"].as_u64().unwrap_or(0) * if is_spline(sampler) { 3 } else { 1 };
        let values_present = values["count"].as_u64().unwrap_or(0);
        let is_multiple = each > 0 && values_present > 0 && values_present.is_multiple_of(each);
        !is_multiple || (values["type"] != "SCALAR" && values_present != each)
    }),
];

fn is_spline(sampler: &Value) -> bool {
    sampler["interpolation"] == "CUBICSPLINE"
}

fn accessor_of<'a>(sampler: &Value, json: &'a Value, name: &str) -> &'a Value {
    &json["accessors"][sampler[name].as_u64().map_or(usize::MAX, |index| index as usize)]
}

/// Returns how many samplers of a file break each rule.
fn unsound_samplers(bytes: &[u8]) -> BTreeMap<&'static str, usize> {
    let json = json_of(bytes);
    let list = |name: &str, of: &Value| of[name].as_array().cloned().unwrap_or_default();
    let mut found = BTreeMap::new();
    for sampler in list("animations", &json).iter().flat_map(|animation| list("samplers", animation)) {
        for (rule, breaks) in SAMPLER_RULES {
            *found.entry(*rule).or_default() += usize::from(breaks(&sampler, &json));
        }
    }
    found
}

#[track_caller]
fn no_more_unsound_samplers(before: &[u8], after: &[u8], name: &str) {
    let (before, after) = (unsound_samplers(before), unsound_samplers(after));
    for (rule, count) in &after {
        assert!(count <= before.get(rule).unwrap_or(&0), "{name}: {rule}: {before:?} {after:?}");
    }
}

#[test]
fn a_saved_or_compacted_file_has_no_more_unsound_samplers() {
    let mut planted = Fixture::new();
    planted.set(&format!("/accessors/{}/type", accessor::TIMES), json!("VEC2"));
    assert!(unsound_samplers(&planted.glb())["times are float scalars"] > 0);
    let files = edited();
    for (name, before, after) in &files {
        no_more_unsound_samplers(before, after, name);
    }
    assert!(files.len() > 30);
}

#[test]
fn compacting_gives_an_unused_sampler_only_accessors_that_fit_its_interpolation() {
    let mut fixture = Fixture::new();
    let mut ours = |shape: &str, numbers: &[f32], width: usize| {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        let number = fixture.accessor(shape, 5126, numbers.len() / width, &bytes);
        let view = fixture.json["accessors"][number]["bufferView"].as_u64().unwrap();
        fixture.json["accessors"][number]["name"] = json!(MARK);
        fixture.json["bufferViews"][view as usize]["name"] = json!(MARK);
        if shape == "SCALAR" {
            fixture.json["accessors"][number]["min"] = json!([numbers[0]]);
            fixture.json["accessors"][number]["max"] = json!([numbers[numbers.len() - 1]]);
        }
        number
    };
    let (three, spline) = (ours("SCALAR", &[0.0, 1.0, 2.0], 1), ours("VEC3", &[0.0; 27], 3));
    let (one, value) = (ours("SCALAR", &[0.0], 1), ours("VEC3", &[0.0; 3], 3));
    let animation = json!({
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
        "samplers": [
            {"input": one, "output": value},
            {"input": three, "output": spline, "interpolation": "CUBICSPLINE"},
        ],
    });
    fixture.set("/animations", json!([animation]));
    let before = fixture.glb();
    let opened = OpenedFile::alone("a.glb", &before);
    let after = compact(&opened.source).unwrap().write().remove(0).bytes;
    no_more_unsound_samplers(&before, &after, "a.glb");
}

/// Returns a file with its buffer in a second file, and the files that a save of it writes.
fn edited_with_buffer_file() -> (Vec<u8>, Vec<OutputFile>) {
    let fixture = Fixture::new();
    let door = MemoryFs::with(&[("all.bin", &fixture.bin)]);
    let before = fixture.gltf_with_file();
    let opened = OpenedFile::new("beside.gltf", &before, &door).unwrap();
    let mut takes = opened.takes();
    shift(&mut takes, 0);
    let saved = opened.saved(&takes, &door);
    assert_eq!(saved.files.len(), 2);
    (before, saved.files)
}

/// Returns the number of errors and warnings of the validator, by code, for each of the files.
pub(crate) fn issues(evaluators: &Path, files: &[PathBuf]) -> Vec<BTreeMap<String, usize>> {
    let output =
        Command::new("node").arg(evaluators.join("validate.mjs")).arg("--json").args(files).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let counts = |line: &str| {
        let report: Value = serde_json::from_str(line).unwrap_or_else(|_| panic!("{line}"));
        let mut counts = BTreeMap::new();
        for message in report["issues"]["messages"].as_array().unwrap() {
            if message["severity"].as_u64().unwrap() < 2 {
                *counts.entry(message["code"].as_str().unwrap().to_owned()).or_default() += 1;
            }
        }
        counts
    };
    let counts: Vec<_> = text.lines().map(counts).collect();
    assert_eq!(counts.len(), files.len());
    counts
}

#[test]
fn the_validator_finds_no_more_than_before() {
    let Some(evaluators) = skip::evaluators() else { return };
    let folder = std::env::temp_dir().join(format!("dragonfly-judges-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let mut files = edited();
    let mut paths = Vec::new();
    for (name, before, after) in &files {
        for (when, bytes) in [("before", before), ("after", after)] {
            let path = folder.join(format!("{when}-{name}"));
            std::fs::write(&path, bytes).unwrap();
            paths.push(path);
        }
    }
    let name = "beside.gltf".to_owned();
    let (before, files_beside) = edited_with_buffer_file();
    paths.push(folder.join("before-beside.gltf"));
    std::fs::write(&paths[paths.len() - 1], &before).unwrap();
    files.push((name, before, Vec::new()));
    for file in files_beside {
        std::fs::write(folder.join(&file.name), &file.bytes).unwrap();
    }
    std::fs::write(folder.join("all.bin"), &Fixture::new().bin).unwrap();
    paths.push(folder.join("beside.gltf"));
    let counts = issues(&evaluators, &paths);
    std::fs::remove_dir_all(&folder).unwrap();
    let mut complaints = Vec::new();
    for ((name, ..), counts) in files.iter().zip(counts.chunks(2)) {
        println!("{name}: before {:?}, after {:?}", counts[0], counts[1]);
        for (code, count) in &counts[1] {
            if *count > counts[0].get(code).copied().unwrap_or(0) {
                complaints.push(format!("{name}: {code}"));
            }
        }
    }
    println!("{} files judged", files.len());
    assert!(complaints.is_empty(), "{complaints:?}");
}

#[test]
fn three_js_plays_an_edited_clip_as_we_do() {
    let Some(evaluators) = skip::evaluators() else { return };
    let fox = OpenedFile::alone("Fox.glb", &std::fs::read(data().join("gltf/Fox.glb")).unwrap());
    let mut random = Random::new(5);
    let mut takes = fox.takes();
    for track in take_mut(&mut takes, 1).tracks.iter_mut().step_by(3) {
        let turns = [(); 4].map(|()| rotation(&mut random));
        track.rotation = Channel::new([0.0, 0.2, 0.45, 0.7], turns, Interpolation::Linear);
        track.scale =
            Channel::new([0.0, 0.5], [glam::Vec3::ONE, glam::Vec3::splat(1.25)], Interpolation::Step);
    }
    shift(&mut takes, 1);
    let plan = dragonfly_anim::format::gltf::save::plan(&fox.source, &fox.model, &takes).unwrap();
    let bytes = plan.write().remove(0).bytes;
    let path = std::env::temp_dir().join(format!("dragonfly-edited-{}.glb", std::process::id()));
    std::fs::write(&path, &bytes).unwrap();
    let output = Command::new("node")
        .arg(evaluators.join("ref_gltf.mjs"))
        .arg(&path)
        .args(["--clip", "1", "--samples", "9"])
        .output()
        .unwrap();
    std::fs::remove_file(&path).unwrap();
    let answer: Value = serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|_| panic!("{}", String::from_utf8_lossy(&output.stderr)));
    // The edited takes, not those that were read back.
    let mut model = fox.model.clone();
    model.animation.takes[1] = takes[1].take.clone();
    let model = Arc::new(model);
    let mut evaluator = Evaluator::new(Arc::clone(&model));
    let (mut numbers, mut worst) = (0, 0.0_f64);
    for sample in answer["clips"][0]["samples"].as_array().unwrap() {
        let time = sample["t"].as_f64().unwrap() as f32;
        evaluator.pose(Some(1), time);
        for (node, world) in sample["world"].as_object().unwrap() {
            let node: u32 = node.parse().unwrap();
            let bones = &model.animation.skeleton.bones;
            let Some(bone) = bones.iter().position(|bone| bone.node == Some(node)) else { continue };
            let expected: Vec<f64> = world.as_array().unwrap().iter().map(|n| n.as_f64().unwrap()).collect();
            let largest = expected.iter().copied().map(f64::abs).fold(1.0, f64::max);
            for (got, expected) in evaluator.to_root()[bone].to_cols_array().into_iter().zip(&expected) {
                worst = worst.max((f64::from(got) - expected).abs() / largest);
                numbers += 1;
            }
        }
    }
    println!("{numbers} numbers, worst {worst:e}");
    assert!(numbers > 1000 && worst < 1e-4, "{worst:e} of {numbers} numbers");
}
