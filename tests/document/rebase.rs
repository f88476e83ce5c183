//! Edits that were made for one version of a model mean the same in another version of it, whatever the order of its bones, takes and
//! meshes; what does not fit is listed.

use crate::undo::same_take;
use dragonfly_anim::data::{
    AnimationData, Bone, Mesh, MeshInstance, ModelData, MorphTarget, MorphTrack, Primitive, Skeleton, Take,
    Track, Transform,
};
use dragonfly_document::adapter::{ModelAdapter, TakeVersions};
use dragonfly_document::edit::{Arbitrary, BoneRef, EDITS, Edit, Misfit};
use dragonfly_document::{Rebase, Rebased};
use dragonfly_kit::random::{Random, seed};
use glam::{Mat4, Vec3};
use std::collections::BTreeSet;
use std::sync::Arc;

/// The bones of the old version, each with the name of its parent.
const OLD: [(&str, &str); 6] = [
    ("hips", ""),
    ("hand.L", ""),
    ("hand.R", ""),
    ("thigh.L", ""),
    ("shin.L", "thigh.L"),
    ("foot.L", "shin.L"),
];

/// The same bones in another order, with one more.
const NEW: [(&str, &str); 7] = [
    ("thigh.L", ""),
    ("hand.R", ""),
    ("shin.L", "thigh.L"),
    ("prop", "shin.L"),
    ("hips", ""),
    ("foot.L", "shin.L"),
    ("hand.L", ""),
];

/// Edits that make the takes of the file.
const FILE: [&str; 6] = [
    r#"{"edit":"create_take","name":"walk"}"#,
    r#"{"edit":"set","take":0,"time":0.5,"poses":[{"bone":"hips","translation":[0,1,0]},{"bone":"hand.L","rotation":[1,0,0,0]}]}"#,
    r#"{"edit":"set","take":0,"time":1,"poses":[{"bone":"hips","scale":[2,1,1]},{"bone":"hand.R","translation":[0,0,1]}]}"#,
    r#"{"edit":"set_interpolation","take":0,"bones":["hips"],"interpolation":"cubic_spline"}"#,
    r#"{"edit":"create_take","name":"run","copy":0}"#,
    r#"{"edit":"set","take":1,"time":1,"poses":[{"bone":"hips","translation":[0,2,1]}]}"#,
];

/// Edits that follow, so that the takes have layers, travel, contacts, shape keys and pending poses.
const EDITED: [&str; 11] = [
    r#"{"edit":"create_take","name":"third","copy":0,"at":2}"#,
    r#"{"edit":"remove_travel","take":1,"bone":0,"parts":["height"],"smooth":0.0}"#,
    r#"{"edit":"add_layer","take":0,"name":"up"}"#,
    r#"{"edit":"add_layer","take":0,"name":"pose","kind":"override","bones":[0,1,4]}"#,
    r#"{"edit":"set","take":{"take":0,"layer":0},"time":0.2,"poses":[{"bone":0,"translation":[0,3,0]}]}"#,
    r#"{"edit":"set","take":{"take":0,"layer":"pose"},"time":0.7,"poses":[{"bone":1,"rotation":[0,1,0,0]}]}"#,
    r#"{"edit":"key_layer_weight","take":{"take":0,"layer":1},"time":0.6,"weight":0.5}"#,
    r#"{"edit":"pend","take":0,"time":0.3,"poses":[{"bone":1,"translation":[0,2,0]}]}"#,
    r#"{"edit":"set_shapes","take":0,"time":0.3,"shapes":[{"shape":"smile","weight":1}]}"#,
    r#"{"edit":"set_shapes","take":0,"time":0.77,"shapes":[{"shape":"smile","weight":0}]}"#,
    r#"{"edit":"set_events","take":1,"events":[{"time":0.5,"name":"step"}]}"#,
];

fn edit(line: &str) -> Edit {
    serde_json::from_str(line).expect(line)
}

fn skeleton(bones: &[(&str, &str)]) -> Arc<Skeleton> {
    let bone = |(name, parent): &(&str, &str)| Bone {
        name: (*name).to_owned(),
        parent: bones.iter().position(|(other, _)| other == parent).map(|parent| parent as u32),
        rest: Transform { translation: Vec3::Y, ..Transform::IDENTITY },
        rest_matrix: None,
        offset: Mat4::IDENTITY,
        node: None,
    };
    Arc::new(Skeleton { bones: bones.iter().map(bone).collect() })
}

/// Returns a model with meshes of these names: `Face` has two shape keys, `Body` one, `Hair` none.
fn model(bones: &[(&str, &str)], meshes: &[&str], face: [&str; 2]) -> ModelData {
    let targets = |name: &str| -> Vec<&str> {
        match name {
            "Face" => face.to_vec(),
            "Body" => vec!["breathe"],
            _ => Vec::new(),
        }
    };
    let mesh = |name: &&str| {
        let target = |name: &str| MorphTarget { name: name.to_owned(), ..MorphTarget::default() };
        let morph_targets: Vec<_> = targets(name).into_iter().map(target).collect();
        let morph_weights = vec![0.0; morph_targets.len()];
        let primitives = vec![Primitive { morph_targets, ..Primitive::default() }];
        Mesh { name: (*name).to_owned(), primitives, morph_weights }
    };
    let instance = |(index, name): (usize, &&str)| MeshInstance {
        mesh: index as u32,
        node: None,
        skin: None,
        bone: None,
        to_bone: Mat4::IDENTITY,
        morph_weights: vec![0.0; targets(name).len()],
    };
    ModelData {
        animation: AnimationData { skeleton: skeleton(bones), takes: Vec::new() },
        meshes: meshes.iter().map(mesh).collect(),
        instances: meshes.iter().enumerate().map(instance).collect(),
        ..ModelData::default()
    }
}

/// Returns the old version of the model.
fn old() -> ModelData {
    let mut model = model(&OLD, &["Face", "Hair", "Body"], ["smile", "blink"]);
    let mut adapter = ModelAdapter::of(&model);
    for line in FILE {
        adapter.apply(&edit(line)).expect(line);
    }
    model.animation.takes = adapter.results().cloned().collect();
    model
}

/// Returns a new version with bones, takes, meshes and shape keys in another order, and one more of some. `rename` gives the bones other
/// names.
fn new(rename: &dyn Fn(&str) -> String) -> ModelData {
    let old = old();
    let mut model = model(&NEW, &["Hat", "Body", "Hair", "Face"], ["blink", "smile"]);
    let tracks = |take: &Take| -> Vec<Track> {
        let track = |(index, (name, _)): (usize, &(&str, &str))| {
            let own = old.animation.skeleton.find(name).map(|bone| take.tracks[bone as usize].clone());
            Track { bone: index as u32, ..own.unwrap_or_default() }
        };
        NEW.iter().enumerate().map(track).collect()
    };
    let mut takes: Vec<_> = old
        .animation
        .takes
        .iter()
        .rev()
        .map(|take| Arc::new(Take { tracks: tracks(take), ..Take::clone(take) }))
        .collect();
    takes.insert(1, Arc::new(Take { name: "another".to_owned(), ..Take::clone(&takes[0]) }));
    let mut skeleton = Skeleton::clone(&model.animation.skeleton);
    skeleton.bones.iter_mut().for_each(|bone| bone.name = rename(&bone.name));
    model.animation = AnimationData { skeleton: Arc::new(skeleton), takes };
    model
}

fn same_names(name: &str) -> String {
    name.to_owned()
}

/// Returns a take of the new version with bones, meshes and shape keys in the order of the old version, without bones that only the new
/// version has.
fn in_old_order(take: &Take, old: &Skeleton, new: &Skeleton, expected: &Take) -> Take {
    let track = |(index, bone): (usize, &Bone)| {
        let found = new.find(&bone.name).map(|bone| take.tracks[bone as usize].clone());
        // A renamed bone is not compared.
        let found = found.unwrap_or_else(|| expected.tracks[index].clone());
        Track { bone: index as u32, ..found }
    };
    let morph = |morph: &MorphTrack| match morph.instance {
        // The face, whose two shape keys have changed places.
        3 => {
            let weights: Vec<f32> = morph
                .weights
                .chunks(2)
                .flat_map(|pair| pair.iter().rev().copied().collect::<Vec<_>>())
                .collect();
            MorphTrack { instance: 0, weights: weights.into(), ..morph.clone() }
        }
        _ => MorphTrack { instance: 2, ..morph.clone() },
    };
    let mut morphs: Vec<_> = take.morphs.iter().map(morph).collect();
    morphs.sort_by_key(|morph| morph.instance);
    let tracks = old.bones.iter().enumerate().map(track).collect();
    Take { tracks, morphs, ..take.clone() }
}

/// Returns why the new version has not the motion of the old one in all takes and layers.
fn difference(old: &ModelAdapter, new: &ModelAdapter) -> Result<(), String> {
    if new.slots().len() != old.slots().len() + 1 {
        return Err(format!("{} takes", new.slots().len()));
    }
    for slot in old.slots() {
        let name = &slot.original.name;
        let found = new.slots().iter().find(|slot| slot.original.name == *name);
        let found = found.ok_or_else(|| format!("no take {name}"))?;
        let pairs = [(&**slot, &**found)].into_iter();
        let layers = slot.layers().iter().zip(found.layers());
        for (a, b) in pairs.chain(layers.clone().map(|(a, b)| (&*a.keys, &*b.keys))) {
            same_slot((old, a), (new, b)).map_err(|reason| format!("{name}: {reason}"))?;
        }
        if slot.layers().len() != found.layers().len() {
            return Err(format!("{name}: {} layers", found.layers().len()));
        }
        for (a, b) in layers {
            let [a, b] = [a, b]
                .map(|layer| (&layer.settings.name, layer.settings.weights.clone(), layer.settings.is_muted));
            if a != b {
                return Err(format!("{name}: layer {a:?} is {b:?}"));
            }
        }
    }
    Ok(())
}

fn same_slot(
    (old, a): (&ModelAdapter, &TakeVersions),
    (new, b): (&ModelAdapter, &TakeVersions),
) -> Result<(), String> {
    for (a, b) in [(&a.result, &b.result), (a.shown(), b.shown())] {
        let b = in_old_order(b, old.skeleton(), new.skeleton(), a);
        // The order of the meshes in a take means nothing, and a mesh that gets keys again is the last.
        let morphs = |take: &Take| {
            let mut morphs = take.morphs.clone();
            morphs.sort_by_key(|track| track.instance);
            morphs
        };
        if [a.start, a.length] != [b.start, b.length] || morphs(a) != morphs(&b) {
            return Err(format!(
                "{} {} {:?}\n{} {} {:?}",
                a.start, a.length, a.morphs, b.start, b.length, b.morphs
            ));
        }
        let part = |tracks: &[Track]| Take { tracks: tracks.to_vec(), ..Take::default() };
        for (a, b) in a.tracks.chunks(1).zip(b.tracks.chunks(1)) {
            if !same_take(&part(a), &part(b)) {
                return Err(format!("{a:?}\n{b:?}"));
            }
        }
    }
    let waiting = |adapter: &ModelAdapter, slot: &TakeVersions| -> Vec<String> {
        let name = |bone: u32| adapter.skeleton().bones[bone as usize].name.clone();
        let mut texts: Vec<_> = slot
            .pending()
            .iter()
            .flat_map(|at| {
                at.poses.iter().map(|pose| {
                    format!(
                        "{} {} {:?}",
                        at.time,
                        name(pose.bone),
                        dragonfly_document::edit::Property::ALL.map(|property| pose.get(property))
                    )
                })
            })
            .collect();
        texts.sort();
        texts
    };
    let [a, b] = [waiting(old, a), waiting(new, b)];
    if a == b { Ok(()) } else { Err(format!("pending {a:?}, not {b:?}")) }
}

/// Starts with the edits that follow the file.
fn started(new: &ModelData) -> Rebase {
    let mut rebase = Rebase::new(ModelAdapter::of(&old()), ModelAdapter::of(new));
    for line in EDITED {
        rebase.apply(0, &edit(line)).expect(line);
    }
    rebase
}

/// Returns the bones of the old version as edits name them, half of them by index.
fn references() -> Vec<BoneRef> {
    let name = |(name, _): &(&str, &str)| BoneRef::Name((*name).to_owned());
    OLD.iter().map(name).chain((0..OLD.len() as u32).map(BoneRef::Index)).collect()
}

#[test]
fn every_kind_of_edit_does_the_same_in_a_version_with_everything_in_another_order() {
    let (mut random, bones) = (Random::new(seed(70)), references());
    let new = new(&same_names);
    let start = started(&new);
    // A model has no text.
    for kind in EDITS.iter().filter(|kind| kind.name != "script") {
        let mut applied = 0;
        // A random tangent seldom has a key.
        for tried in 0..4_000 {
            if tried >= 120 && applied > 0 {
                break;
            }
            let edit = (kind.arbitrary)(&mut Arbitrary::new(&mut || random.bits(), 3, &bones));
            let mut rebase = start.clone();
            if rebase.apply(1, &edit).is_err() {
                continue;
            }
            let old = rebase.old().clone();
            let Rebased { edited, unfit } = rebase.finish();
            // A take or layer may be at its new place already.
            let is_there = |reason: &Misfit| reason.to_string().ends_with("is there already");
            if unfit.iter().any(|unfit| unfit.reasons.iter().all(is_there)) {
                continue;
            }
            assert!(unfit.is_empty(), "{edit:?}: {unfit:?}");
            // Noise depends on the index of the bone.
            if kind.name != "noise_keys"
                && let Err(reason) = difference(&old, edited.adapter())
            {
                panic!("{edit:?}\n{reason}");
            }
            applied += 1;
        }
        assert!(applied > 0, "no random {} could be applied", kind.name);
    }
}

/// Returns whether a bone has keys in any take.
fn has_keys(adapter: &ModelAdapter, bone: &str) -> bool {
    let bone = adapter.skeleton().find(bone).expect("a bone") as usize;
    adapter.results().any(|take| !take.tracks[bone].key_times().is_empty())
}

#[test]
fn a_sequence_of_random_edits_does_the_same_and_is_undone_step_by_step() {
    let (mut random, bones) = (Random::new(seed(71)), references());
    let new = new(&same_names);
    for _ in 0..20 {
        let mut rebase = started(&new);
        let mut tried = 0;
        for _ in 0..60 {
            let takes = rebase.old().slots().len();
            let edit = Arbitrary::new(&mut || random.bits(), takes, &bones).edit();
            if matches!(edit, Edit::NoiseKeys(_)) {
                continue;
            }
            let before = rebase.clone();
            tried += usize::from(rebase.apply(tried, &edit).is_ok());
            let Rebased { edited, unfit } = rebase.clone().finish();
            // Keys of the bone that only the new version has count when others are reduced.
            let is_other = matches!(edit, Edit::ReduceKeys(_)) && has_keys(edited.adapter(), "prop");
            if !unfit.is_empty() || is_other {
                rebase = before;
            } else if let Err(reason) = difference(rebase.old(), edited.adapter()) {
                let done: String = edited.steps().0.iter().map(|step| format!("{:?}\n", step.edit)).collect();
                panic!("{done}{edit:?}\n{reason}");
            }
        }
        let mut edited = rebase.finish().edited;
        assert_eq!(edited.unsaved_steps(), edited.steps().1);
        while edited.undo() {}
        let takes: Vec<_> = edited.adapter().results().cloned().collect();
        assert!(takes.iter().zip(&new.animation.takes).all(|(a, b)| same_take(a, b)) && takes.len() == 3);
    }
}

#[test]
fn exactly_the_edits_of_a_renamed_bone_are_listed_and_all_other_bones_move_as_before() {
    let mut random = Random::new(seed(72));
    let bones: Vec<BoneRef> = references().into_iter().take(OLD.len()).collect();
    let new = new(&|name| if name == "hand.R" { "hand.Right".to_owned() } else { name.to_owned() });
    let start = started(&new);
    assert_eq!(start.clone().finish().unfit, []);
    let (mut listed, mut in_part) = (BTreeSet::new(), 0);
    for kind in EDITS {
        // Pairs of sides are guessed from the names, which differ now, and noise depends on the index of the bone.
        if matches!(kind.name, "mirror_take" | "paste" | "noise_keys") {
            continue;
        }
        for _ in 0..120 {
            let edit = (kind.arbitrary)(&mut Arbitrary::new(&mut || random.bits(), 3, &bones));
            let is_of_bone = serde_json::to_string(&edit).expect("JSON").contains(r#""hand.R""#);
            let mut rebase = start.clone();
            if rebase.apply(7, &edit).is_err() {
                continue;
            }
            let old = rebase.old().clone();
            let Rebased { edited, unfit } = rebase.finish();
            let no_bone = Misfit::NoBone("hand.R".to_owned());
            let found = unfit.iter().find(|unfit| unfit.reasons.contains(&no_bone));
            assert_eq!(found.is_some(), is_of_bone, "{edit:?}: {unfit:?}");
            match found {
                Some(unfit) => {
                    assert_eq!((unfit.number, unfit.edit.is_empty()), (7, false));
                    listed.insert(kind.name);
                    in_part += usize::from(unfit.applied_in_part);
                }
                None if unfit.is_empty() => {
                    if let Err(reason) = difference(&old, edited.adapter()) {
                        panic!("{edit:?}\n{reason}");
                    }
                }
                None => {}
            }
        }
    }
    assert!(listed.len() >= 20 && in_part > 0, "{listed:?}, {in_part}");
}

/// Returns the texts of the edits that do not fit, after the edits of `lines` on a model with the takes `walk` and `run`.
fn unfit_of(new: &ModelData, lines: &[&str]) -> (Vec<String>, Rebased) {
    let mut rebase = started(new);
    for (number, line) in lines.iter().enumerate() {
        rebase.apply(number, &edit(line)).expect(line);
    }
    let done = rebase.finish();
    (done.unfit.iter().map(ToString::to_string).collect(), done)
}

#[test]
fn what_does_not_fit_is_listed_with_its_reason_and_later_edits_are_still_applied() {
    let mut changed = new(&|name| if name == "hand.R" { "hand".to_owned() } else { name.to_owned() });
    changed.animation.takes.retain(|take| take.name != "run");
    let mut rebase = Rebase::new(ModelAdapter::of(&old()), ModelAdapter::of(&changed));
    let cases = [
        (
            r#"{"edit":"set","take":"walk","time":0.5,"poses":[{"bone":"hand.R","translation":[1,0,0]}]}"#,
            r#"Move (hand.R, walk, at 0.5 s): the new version has no bone "hand.R""#,
        ),
        (
            r#"{"edit":"set","take":"walk","time":0.25,"poses":[{"bone":"hand.R","translation":[1,0,0]},{"bone":"hips","translation":[1,0,0]}]}"#,
            r#"Move (2 bones, walk, at 0.25 s), applied in part: the new version has no bone "hand.R""#,
        ),
        (
            r#"{"edit":"create_take","name":"slow","copy":"run"}"#,
            r#"Duplicate take (slow): the new version has no take "run""#,
        ),
        (
            r#"{"edit":"reverse_take","take":"slow"}"#,
            r#"Reverse take (slow): the new version has no take "slow""#,
        ),
        (
            r#"{"edit":"create_take","name":"another"}"#,
            r#"Create take (another): another take has the name "another""#,
        ),
        (
            r#"{"edit":"rename_take","take":"another","name":"mine"}"#,
            r#"Rename take (another → mine): the new version has no take "another""#,
        ),
        (r#"{"edit":"set","take":"walk","time":0.75,"poses":[{"bone":"hips","translation":[4,0,0]}]}"#, ""),
    ];
    for (number, (line, _)) in cases.iter().enumerate() {
        rebase.apply(number, &edit(line)).expect(line);
    }
    let done = rebase.finish();
    let texts: Vec<_> = done.unfit.iter().map(ToString::to_string).collect();
    let expected: Vec<_> = cases.iter().map(|(_, text)| *text).filter(|text| !text.is_empty()).collect();
    assert_eq!(texts, expected);
    assert_eq!(done.unfit.iter().map(|unfit| unfit.number).collect::<Vec<_>>(), [0, 1, 2, 3, 4, 5]);
    assert_eq!(done.edited.steps().1, 2, "the first in part, and the last");
}

#[test]
fn keys_that_another_program_removed_are_listed_by_time() {
    let mut changed = new(&same_names);
    let walk = changed.animation.takes.iter_mut().find(|take| take.name == "walk").expect("a take");
    let hips = changed.animation.skeleton.find("hips").expect("a bone");
    let channel = &mut Arc::make_mut(walk).tracks[hips as usize].scale;
    *channel =
        dragonfly_anim::data::Channel::new(vec![0.0], channel.values[..3].to_vec(), channel.interpolation);
    let (texts, _) = unfit_of(
        &changed,
        &[
            r#"{"edit":"move_keys","take":"walk","keys":[{"bones":["hips"],"properties":["translation","scale"],"at":[0.5,1]}],"by":0.1}"#,
        ],
    );
    assert_eq!(
        texts,
        [r#"Move keys (hips, walk), applied in part: "hips" has no scale key at 1 s in the new version"#]
    );
}

#[test]
fn events_that_another_program_added_stay() {
    let with_event = |name: &str, take: &str, mut model: ModelData| {
        let mut adapter = ModelAdapter::of(&model);
        let index = adapter.slots().iter().position(|slot| slot.original.name == take).expect("a take");
        let line = format!(r#"{{"edit":"set_events","take":{index},"events":[{name}]}}"#);
        adapter.apply(&edit(&line)).expect("events");
        model.animation.takes = adapter.results().cloned().collect();
        model
    };
    let (step, other) = (r#"{"time":0.25,"name":"step"}"#, r#"{"time":0.75,"name":"other"}"#);
    let old = with_event(step, "run", old());
    let new = with_event(&format!("{step},{other}"), "run", new(&same_names));
    let mut rebase = Rebase::new(ModelAdapter::of(&old), ModelAdapter::of(&new));
    let line = r#"{"edit":"set_events","take":"run","events":[{"time":0.5,"name":"jump"}]}"#;
    rebase.apply(0, &edit(line)).expect("events");
    let done = rebase.finish();
    let slot = done.edited.adapter().slots().iter().find(|slot| slot.original.name == "run").expect("a take");
    let events = dragonfly_document::adapter::stored_events(&slot.original.extras);
    let names: Vec<_> = events.iter().map(|event| event.name.as_str()).collect();
    assert_eq!((names, done.unfit.len()), (vec!["jump", "other"], 0));
}

#[test]
fn a_shape_key_that_is_gone_is_listed_and_the_others_are_set() {
    let mut changed = new(&same_names);
    for mesh in &mut changed.meshes {
        let targets = mesh.primitives.iter_mut().flat_map(|primitive| &mut primitive.morph_targets);
        targets.filter(|target| target.name == "blink").for_each(|target| target.name = "wink".to_owned());
    }
    let (texts, done) = unfit_of(
        &changed,
        &[
            r#"{"edit":"set_shapes","take":0,"time":0.5,"shapes":[{"mesh":0,"shape":"blink","weight":1},{"mesh":2,"shape":0,"weight":0.5}]}"#,
            r#"{"edit":"paste_keys","take":0,"time":0.5,"channels":[],"shapes":[{"mesh":0,"shapes":["blink","smile"],"interpolation":"linear","keys":[{"after":0,"weights":[0.25,0.75]}]}]}"#,
        ],
    );
    let reason = r#"the mesh "Face" has no shape key "blink" in the new version"#;
    assert_eq!(texts.len(), 2);
    assert!(texts.iter().all(|text| text.ends_with(&format!("applied in part: {reason}"))), "{texts:?}");
    let walk =
        done.edited.adapter().slots().iter().find(|slot| slot.original.name == "walk").expect("a take");
    let weights = |instance: u32| {
        let morph = walk.result.morphs.iter().find(|morph| morph.instance == instance).expect("keys");
        let at = morph.times.iter().position(|time| (time - 0.5).abs() < 1e-4).expect("a key");
        let count = morph.targets as usize;
        morph.weights[at * count..(at + 1) * count].to_vec()
    };
    assert_eq!(weights(3)[1], 0.75, "smile is the second now");
    assert_eq!(weights(1), [0.5]);
}
