//! Saving and reopening preserves every key of every take to the bit.

use crate::undo::{any_edit, same_take};
use dragonfly_anim::layers::LayerSettings;
use dragonfly_document::adapter::{ModelAdapter, TakeVersions};
use dragonfly_document::edit::BoneRef;
use dragonfly_kit::folder::{Folder, data};

use dragonfly_anim::data::{Channel, Interpolation, Skeleton, Take};
use dragonfly_document::history::Edited;
use dragonfly_document::{Cancel, Editable, Source};
use dragonfly_kit::random::{Random, seed};
use glam::Quat;
use std::path::{Path, PathBuf};

pub(crate) fn open(path: &Path) -> Editable {
    match Editable::open(&Source::File(path.to_owned()), &Cancel::default()) {
        Ok(editable) => editable,
        Err(error) => panic!("{}: {error}", path.display()),
    }
}

/// Copies the models of the repository into `folder`. Returns their paths.
fn models(folder: &Folder) -> Vec<PathBuf> {
    let mut models = Vec::new();
    for entry in std::fs::read_dir(data("gltf")).expect("models").flatten() {
        let (from, to) = (entry.path(), folder.join(&entry.file_name().to_string_lossy()));
        if from.is_file() && from.extension().is_some_and(|end| end == "glb" || end == "gltf") {
            std::fs::copy(&from, &to).expect("a copy");
            models.push(to);
        }
    }
    models.sort();
    models
}

/// Returns the take as a file stores it: without tracks that have no keys, and with bones numbered by their nodes. A
/// node that is no joint is a bone while something animates it, so deleting its last key changes the numbers of the
/// others.
fn with_keys(take: &Take, skeleton: &Skeleton) -> Take {
    let mut take = take.clone();
    for track in &mut take.tracks {
        let bone = skeleton.bones.get(track.bone as usize).expect("a bone");
        track.bone = bone.node.expect("a node of the file");
        of_one_key(&mut track.translation);
        of_one_key(&mut track.rotation);
        of_one_key(&mut track.scale);
        in_one_hemisphere(&mut track.rotation);
    }
    take.tracks.retain(|track| {
        !(track.translation.is_empty() && track.rotation.is_empty() && track.scale.is_empty())
    });
    take.morphs.retain(|morph| !morph.times.is_empty());
    for morph in &mut take.morphs {
        let targets = morph.targets as usize;
        if morph.times.len() == 1 && morph.interpolation == Interpolation::CubicSpline {
            morph.weights = morph.weights[targets..2 * targets].into();
            morph.interpolation = Interpolation::Linear;
        }
    }
    take
}

/// Replaces each rotation q by -q where that is nearer to the key before. Reading a file does the same, except for
/// splines.
fn in_one_hemisphere(channel: &mut Channel<Quat>) {
    if channel.interpolation != Interpolation::CubicSpline {
        let mut values = channel.values.to_vec();
        for at in 1..values.len() {
            if values[at].dot(values[at - 1]) < 0.0 {
                values[at] = -values[at];
            }
        }
        channel.values = values.into();
    }
}

/// Makes a channel with one key linear, without tangents: a spline has two keys at least (glTF 2.0, 3.11).
fn of_one_key<T: Copy>(channel: &mut Channel<T>) {
    if channel.len() == 1 && channel.interpolation == Interpolation::CubicSpline {
        channel.values = [channel.values[1]].into();
    }
    if channel.len() < 2 {
        channel.interpolation = Interpolation::Linear;
    }
}

#[test]
fn any_edits_saved_and_opened_again_give_the_same_takes() {
    let folder = Folder::new("save-and-open");
    let (first, mut saved_edits) = (seed(70), 0);
    for (place, path) in models(&folder).iter().enumerate() {
        let number = first + place as u64;
        let mut random = Random::new(number);
        let mut editable = open(path);
        let bones: Vec<BoneRef> =
            (0..editable.model.animation.skeleton.len() as u32).map(BoneRef::Index).collect();
        let mut edited = Edited::new(ModelAdapter::new(&editable.model.animation));
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        for round in 0..4 {
            for _ in 0..12 {
                let edit = any_edit(&mut random, edited.adapter().slots().len().max(1), &bones);
                saved_edits += usize::from(edited.apply(edit, None).is_ok());
            }
            let plan = editable.plan(edited.adapter()).unwrap_or_else(|error| panic!("{name}: {error}"));
            let written = editable.save(edited.adapter(), &plan, path);
            written.unwrap_or_else(|error| panic!("{name}, seed {number}: {error}"));
            let context = format!("{name}, seed {number}, round {round}");
            assert_opens_again(path, edited.adapter(), &context);
        }
    }
    assert!(saved_edits > 100, "only {saved_edits} edits could be done");
}

/// Returns a skeleton in which a root bone that was added has the node that the file has for it.
fn with_nodes_of(file: &Skeleton, skeleton: &Skeleton) -> Skeleton {
    let mut skeleton = skeleton.clone();
    for bone in skeleton.bones.iter_mut().filter(|bone| bone.node.is_none()) {
        let found = file.find(&bone.name).and_then(|found| file.bones[found as usize].node);
        // A bone above no bone of the file is none there, and has no keys.
        bone.node = found.or(Some(u32::MAX));
    }
    skeleton
}

/// Asserts that the saved file has the takes of `adapter`.
#[track_caller]
pub(crate) fn assert_opens_again(path: &Path, adapter: &ModelAdapter, context: &str) {
    let again = open(path);
    let skeleton = &with_nodes_of(&again.model.animation.skeleton, adapter.skeleton());
    let now: Vec<_> = adapter.results().collect();
    let then = &again.model.animation.takes;
    assert_eq!(now.len(), then.len(), "{context}: takes");
    let layers = ModelAdapter::new(&again.model.animation);
    for (now, then) in adapter.slots().iter().zip(layers.slots()) {
        assert_same_layers(now, then, &format!("{context}, take {:?}", now.original.name));
    }
    for (now, then) in now.into_iter().zip(then) {
        // A take that animates nothing is saved with one key that keeps a bone at rest.
        if now.keys() == 0 {
            assert_eq!(now.name, then.name, "{context}");
            continue;
        }
        let (now, then) = (with_keys(now, skeleton), with_keys(then, &again.model.animation.skeleton));
        let difference = || difference(&now, &then);
        assert!(same_take(&now, &then), "{context}, take {:?}: {}", now.name, difference());
    }
}

/// Asserts that a take has the same layers with the same keys, to the bit.
#[track_caller]
fn assert_same_layers(now: &TakeVersions, then: &TakeVersions, context: &str) {
    assert_eq!(now.layers().len(), then.layers().len(), "{context}: layers");
    for (now, then) in now.layers().iter().zip(then.layers()) {
        let mut settings = LayerSettings::clone(&now.settings);
        settings.bones.clone_from(&then.settings.bones);
        assert_eq!(settings, *then.settings, "{context}");
        let moved = |take: &Take| -> Vec<String> {
            let tracks = take.tracks.iter().filter(|track| !track.is_empty());
            tracks.map(|track| format!("{:?}", (&track.translation, &track.rotation, &track.scale))).collect()
        };
        assert_eq!(moved(&now.keys.result), moved(&then.keys.result), "{context}");
    }
}

/// Describes the first difference of two takes in one line.
fn difference(now: &Take, then: &Take) -> String {
    if now.name != then.name || (now.start, now.length) != (then.start, then.length) {
        let range = |take: &Take| format!("{:?} {}+{}", take.name, take.start, take.length);
        return format!("{} became {}", range(now), range(then));
    }
    let bones = |take: &Take| take.tracks.iter().map(|track| track.bone).collect::<Vec<_>>();
    if bones(now) != bones(then) {
        return format!("tracks of {:?} became {:?}", bones(now), bones(then));
    }
    for (a, b) in now.tracks.iter().zip(&then.tracks) {
        let keys = |track: &dragonfly_anim::data::Track| {
            [
                (track.translation.len(), track.translation.interpolation),
                (track.rotation.len(), track.rotation.interpolation),
                (track.scale.len(), track.scale.interpolation),
            ]
        };
        if keys(a) != keys(b) {
            return format!("bone {}: {:?} became {:?}", a.bone, keys(a), keys(b));
        }
        if format!("{a:?}") != format!("{b:?}") {
            let (a_text, b_text) = (format!("{a:?}"), format!("{b:?}"));
            let at = a_text.bytes().zip(b_text.bytes()).position(|(a, b)| a != b).unwrap_or(0);
            let part =
                |text: &str| text.get(at.saturating_sub(60)..(at + 60).min(text.len())).map(str::to_owned);
            return format!("bone {}: {:?} became {:?}", a.bone, part(&a_text), part(&b_text));
        }
    }
    "morph weights".to_owned()
}
