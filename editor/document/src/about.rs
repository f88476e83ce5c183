//! What an edit was done to, in the words of the model: for the list of the history.

use super::adapter::ModelAdapter;
use super::edit::{BonePose, BoneRef, Edit};
use crate::bones::MirrorPairs;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Longest name in a list, letters; a name may have any length.
const LONGEST: usize = 60;

/// Bone or number of bones, then the take: `head · Walk`. Empty where the edit names neither.
pub(super) fn about(adapter: &ModelAdapter, edit: &Edit) -> Arc<str> {
    let take = match edit {
        Edit::CreateTake { name, .. } => Some(name.clone()),
        Edit::RenameTake { take, name } => {
            // Both names, since one alone says little.
            let before = adapter.take(take).map(|slot| slot.original.name.clone());
            return before
                .map_or_else(|_| "".into(), |before| format!("{} → {}", short(&before), short(name)).into());
        }
        _ => edit.take().and_then(|take| adapter.take(take).ok()).map(|slot| slot.original.name.clone()),
    };
    let parts = [bones(adapter, edit), take.map(|take| short(&take))];
    parts.into_iter().flatten().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("  ·  ").into()
}

fn bones(adapter: &ModelAdapter, edit: &Edit) -> Option<String> {
    let indices: Vec<BoneRef>;
    let named: Vec<&BoneRef> = match edit {
        Edit::Set { poses, .. } | Edit::Offset { poses, .. } | Edit::Pend { poses, .. } => {
            poses.iter().map(|pose| &pose.bone).collect()
        }
        Edit::SetMany { at, .. } => {
            let all = at.iter().flat_map(|at| &at.poses).filter_map(|pose| adapter.bone(&pose.bone).ok());
            indices = all.collect::<BTreeSet<u32>>().into_iter().map(BoneRef::Index).collect();
            indices.iter().collect()
        }
        Edit::Paste { poses, mirrored, .. } => {
            indices = changed_by_paste(adapter, poses, *mirrored);
            indices.iter().collect()
        }
        Edit::KeyPending { bones, .. }
        | Edit::DropPending { bones, .. }
        | Edit::Reset { bones, .. }
        | Edit::AddKeys { bones, .. }
        | Edit::SetInterpolation { bones, .. } => bones.iter().collect(),
        Edit::SetTangents { bone, .. } => vec![bone],
        Edit::PasteKeys { channels, .. } => {
            let found: BTreeSet<u32> =
                channels.iter().filter_map(|channel| adapter.bone(&channel.bone).ok()).collect();
            indices = found.into_iter().map(BoneRef::Index).collect();
            indices.iter().collect()
        }
        Edit::DeleteKeys { keys, .. }
        | Edit::MoveKeys { keys, .. }
        | Edit::ScaleKeys { keys, .. }
        | Edit::DuplicateKeys { keys, .. }
        | Edit::SnapKeys { keys, .. } => keys.iter().flat_map(|set| &set.bones).collect(),
        _ => Vec::new(),
    };
    match named.as_slice() {
        [] => None,
        [one] => bone_name(adapter, one),
        several => {
            // One may be named more than once, with other channels or times.
            let apart: BTreeSet<u32> = several.iter().filter_map(|bone| adapter.bone(bone).ok()).collect();
            match apart.len() {
                1 => bone_name(adapter, several[0]),
                count => Some(format!("{count} bones")),
            }
        }
    }
}

fn bone_name(adapter: &ModelAdapter, bone: &BoneRef) -> Option<String> {
    let bone = adapter.bone(bone).ok()?;
    let name = adapter.skeleton().bones.get(bone as usize).map_or("", |bone| bone.name.as_str());
    Some(if name.is_empty() { format!("Bone {bone}") } else { short(name) })
}

/// The bones that get a pasted pose: with a mirrored one those on the other side. What this model lacks is passed over.
fn changed_by_paste(adapter: &ModelAdapter, poses: &[BonePose], mirrored: bool) -> Vec<BoneRef> {
    let pairs = mirrored.then(|| MirrorPairs::of(adapter.skeleton()));
    let found = poses.iter().filter_map(|pose| adapter.bone(&pose.bone).ok());
    let changed = found.filter_map(|bone| match &pairs {
        Some(pairs) => pairs.mirror_of(bone),
        None => Some(bone),
    });
    changed.map(BoneRef::Index).collect()
}

/// The begin of a name.
fn short(name: &str) -> String {
    match name.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &name[..end]),
        None => name.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edit::{EXAMPLES, TakeRef};
    use dragonfly_anim::data::{AnimationData, Bone, Skeleton, Take, Transform};
    use glam::Mat4;

    fn bone(name: &str) -> Bone {
        Bone {
            name: name.to_owned(),
            parent: None,
            rest: Transform::IDENTITY,
            rest_matrix: None,
            offset: Mat4::IDENTITY,
            node: None,
        }
    }

    fn take(name: &str) -> Arc<Take> {
        Arc::new(Take { name: name.to_owned(), ..Take::default() })
    }

    #[test]
    fn every_edit_says_what_it_was_done_to() {
        let long = "é".repeat(10_000);
        let skeleton = Skeleton { bones: vec![bone("b_Head_05"), bone(&long)] };
        let takes = vec![take("Survey"), take(&long)];
        let adapter = ModelAdapter::new(&AnimationData { skeleton: Arc::new(skeleton), takes });
        for example in EXAMPLES {
            let text = about(&adapter, &serde_json::from_str(example.json).expect("an edit"));
            assert!(text.chars().count() <= 2 * LONGEST + 8, "{text}");
        }
    }

    #[test]
    fn a_mirrored_pose_is_about_the_bones_that_it_changes() {
        let names = ["hips", "hand.L", "hand.R"];
        let skeleton = Skeleton { bones: names.into_iter().map(bone).collect() };
        let adapter =
            ModelAdapter::new(&AnimationData { skeleton: Arc::new(skeleton), takes: vec![take("Walk")] });
        let paste = |mirrored: bool, bones: &[&str]| {
            let pose = |name: &&str| {
                let bone = BoneRef::Name((*name).to_owned());
                BonePose { bone, translation: None, rotation: None, scale: None }
            };
            let poses = bones.iter().map(pose).collect();
            let edit = Edit::Paste {
                take: TakeRef::Index(0),
                time: 0.0,
                poses,
                mirrored,
                pending: false,
                unstep: false,
            };
            about(&adapter, &edit).to_string()
        };
        assert_eq!(paste(false, &["hand.L"]), "hand.L  ·  Walk");
        assert_eq!(paste(true, &["hand.L"]), "hand.R  ·  Walk");
        assert_eq!(paste(true, &["hips"]), "hips  ·  Walk");
        assert_eq!(paste(true, &["hand.R", "tail of another model"]), "hand.L  ·  Walk");
        assert_eq!(paste(false, &["hand.L", "hips"]), "2 bones  ·  Walk");
    }

    #[test]
    fn a_bone_that_is_named_more_than_once_is_one() {
        let skeleton = Skeleton { bones: ["hips", "hand.L"].into_iter().map(bone).collect() };
        let adapter =
            ModelAdapter::new(&AnimationData { skeleton: Arc::new(skeleton), takes: vec![take("Walk")] });
        let named = |keys: &str| {
            let json = format!(r#"{{"edit":"duplicate_keys","take":"Walk","by":1,"keys":[{keys}]}}"#);
            about(&adapter, &serde_json::from_str(&json).expect("an edit")).to_string()
        };
        let hips = r#"{"bones":["hips"],"at":[1]}"#;
        assert_eq!(named(&format!(r#"{hips},{{"bones":[0],"from":2}}"#)), "hips  ·  Walk");
        assert_eq!(named(&format!(r#"{hips},{{"bones":["hips","hand.L"],"from":2}}"#)), "2 bones  ·  Walk");
    }

    #[test]
    fn pasted_keys_are_about_the_bones_that_the_model_has_each_once() {
        let skeleton = Skeleton { bones: ["hips", "hand.L"].into_iter().map(bone).collect() };
        let adapter =
            ModelAdapter::new(&AnimationData { skeleton: Arc::new(skeleton), takes: vec![take("Walk")] });
        let channel = |bone: &str, property: &str, value: &str| {
            let keys = format!(r#"[{{"after":0,"value":{value}}}]"#);
            format!(r#"{{"bone":"{bone}","property":"{property}","interpolation":"linear","keys":{keys}}}"#)
        };
        let turn = |bone| channel(bone, "rotation", "[0,0,0,1]");
        let place = |bone| channel(bone, "translation", "[0,0,0]");
        let named = |channels: &[String]| {
            let json = format!(
                r#"{{"edit":"paste_keys","take":"Walk","time":0,"channels":[{}]}}"#,
                channels.join(",")
            );
            about(&adapter, &serde_json::from_str(&json).expect("an edit")).to_string()
        };
        let of_a_hand = [turn("hand.L"), turn("tail"), place("hand.L")];
        assert_eq!(named(&of_a_hand), "hand.L  ·  Walk");
        let of_both = [turn("hand.L"), turn("hips"), place("hand.L")];
        assert_eq!(named(&of_both), "2 bones  ·  Walk");
    }
}
